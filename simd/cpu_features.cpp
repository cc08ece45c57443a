// SPDX-License-Identifier: MIT
#include "simd/cpu_features.h"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace mien {

namespace {

constexpr uint32_t bit(uint32_t number) { return uint32_t{1} << number; }
constexpr bool has_all(uint32_t bits, uint32_t wanted) { return (bits & wanted) == wanted; }

// CPUID leaf 1, register ECX. AVX2 code may use all the older sets, because compilers assume them.
constexpr uint32_t kLeaf1Xsave = bit(26) | bit(27);  // XSAVE, enabled by the system
constexpr uint32_t kLeaf1Avx2 = bit(0) | bit(9) | bit(19) | bit(20) | bit(23) |  // SSE3 to POPCNT
                                bit(28) | bit(12) | bit(29);                     // AVX, FMA, F16C
// CPUID leaf 7, register EBX.
constexpr uint32_t kLeaf7Avx2 = bit(5);
constexpr uint32_t kLeaf7Avx512 = bit(16) | bit(17) | bit(28) | bit(30) | bit(31);  // F DQ CD BW VL

// XCR0: which registers the system saves when it switches threads. Wide registers that it does not save may
// be lost at any time, whatever CPUID says.
constexpr uint32_t kXcr0Avx = bit(1) | bit(2);                         // XMM, YMM
constexpr uint32_t kXcr0Avx512 = kXcr0Avx | bit(5) | bit(6) | bit(7);  // masks, ZMM, ZMM16-31

}  // namespace

CpuFeatures features_of(const X86Registers& registers) {
  CpuFeatures features = {};
  features.sse2 = true;  // part of x86-64
  if (registers.last_leaf < 7 || !has_all(registers.leaf1_ecx, kLeaf1Xsave | kLeaf1Avx2)) {
    return features;
  }
  features.avx2 = has_all(registers.leaf7_ebx, kLeaf7Avx2) && has_all(registers.xcr0, kXcr0Avx);
  features.avx512 = features.avx2 && has_all(registers.leaf7_ebx, kLeaf7Avx512) &&
                    has_all(registers.xcr0, kXcr0Avx512);
  return features;
}

#if defined(__x86_64__)

CpuFeatures detect_cpu_features() {
  X86Registers registers = {};
  uint32_t eax, ebx, ecx, edx;
  registers.last_leaf = __get_cpuid_max(0, nullptr);
  if (registers.last_leaf < 7) return features_of(registers);
  __cpuid(1, eax, ebx, ecx, edx);
  registers.leaf1_ecx = ecx;
  __cpuid_count(7, 0, eax, ebx, ecx, edx);
  registers.leaf7_ebx = ebx;
  if (has_all(registers.leaf1_ecx, kLeaf1Xsave)) {
    // _xgetbv would need -mxsave.
    __asm__ volatile("xgetbv" : "=a"(registers.xcr0), "=d"(edx) : "c"(0));
  }
  return features_of(registers);
}

#else

CpuFeatures detect_cpu_features() {
  CpuFeatures features = {};
#if defined(__aarch64__)
  features.neon = true;  // part of AArch64
#elif defined(__EMSCRIPTEN__)
  features.sse2 = true;  // a module with vectors does not load where they are missing
#endif
  return features;
}

#endif

}  // namespace mien
