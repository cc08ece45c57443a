// SPDX-License-Identifier: MIT
#pragma once

namespace mien {

/// What the CPU has and the operating system lets programs use, by instruction set of kernels.h.
/// Each covers every compiler flag its kernels are built with (simd/CMakeLists.txt).
struct CpuFeatures {
  bool sse2;
  bool avx2;    // AVX2, FMA, F16C
  bool avx512;  // F, CD, DQ, BW, VL, and all of avx2
  bool neon;
};

/// Asks the CPU anew at each call: microseconds, so not for the hot path.
CpuFeatures detect_cpu_features();

}  // namespace mien
