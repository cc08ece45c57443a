// SPDX-License-Identifier: MIT
#pragma once

#include <stdint.h>

namespace mien {

/// Features that the CPU has and the operating system lets programs use, by instruction set (Isa). Each
/// covers every compiler flag its kernels are built with (simd/CMakeLists.txt).
struct CpuFeatures {
  bool sse2;
  bool avx2;    // AVX2, FMA, F16C
  bool avx512;  // F, CD, DQ, BW, VL, and all of avx2
  bool neon;
};

/// What an x86-64 CPU and the operating system report.
struct X86Registers {
  uint32_t last_leaf;  // of CPUID
  uint32_t leaf1_ecx;
  uint32_t leaf7_ebx;
  uint32_t xcr0;  // registers that the system saves; 0 if it has not enabled XSAVE
};
CpuFeatures features_of(const X86Registers& registers);

/// Queries the CPU at each call, which takes microseconds: not for the hot path.
CpuFeatures detect_cpu_features();

}  // namespace mien
