// SPDX-License-Identifier: MIT
// Runs before an instruction set is chosen, so it is built with baseline flags and never includes xsimd.
// MIEN_BUILT_<ISA> comes from simd/CMakeLists.txt.
//
// Our own table, not xsimd::dispatch():
// - A rig keeps the table it was made for, so a kernel is one indirect call, and two rigs with
//   different instruction sets can exist side by side. xsimd decides at each call, for the process.
// - The caller, MIEN_ISA and the tests can ask for any table; xsimd takes the best of a list.
// - The scalar table does without xsimd: it is the reference of the tests, and runs on other
//   processors.
// - Functors of xsimd are templates on the instruction set that all objects must see. Here no two
//   objects share an inline function of xsimd (tests/check_isa_objects.py).
#include <stdlib.h>
#include <string.h>

#include "simd/cpu_features.h"
#include "simd/kernels.h"

namespace mien {

namespace scalar {
extern const KernelTable kTable;
}
namespace sse2 {
extern const KernelTable kTable;
}
namespace avx2 {
extern const KernelTable kTable;
}
namespace avx512 {
extern const KernelTable kTable;
}
namespace neon {
extern const KernelTable kTable;
}

namespace {

constexpr Isa kBestFirst[] = {Isa::kAvx512, Isa::kAvx2, Isa::kNeon, Isa::kSse2};

const KernelTable* kernels_for(Isa isa, [[maybe_unused]] const CpuFeatures& cpu) {
  switch (isa) {
#if defined(MIEN_BUILT_SCALAR)
    case Isa::kScalar: return &scalar::kTable;
#endif
#if defined(MIEN_BUILT_SSE2)
    case Isa::kSse2: return cpu.sse2 ? &sse2::kTable : nullptr;
#endif
#if defined(MIEN_BUILT_AVX2)
    case Isa::kAvx2: return cpu.avx2 ? &avx2::kTable : nullptr;
#endif
#if defined(MIEN_BUILT_AVX512)
    case Isa::kAvx512: return cpu.avx512 ? &avx512::kTable : nullptr;
#endif
#if defined(MIEN_BUILT_NEON)
    case Isa::kNeon: return cpu.neon ? &neon::kTable : nullptr;
#endif
    default: return nullptr;
  }
}

}  // namespace

// Features are queried once per process: under a hypervisor each query takes microseconds, as much as the
// rest of opening a baked rig.
const KernelTable* kernels_for(Isa isa) {
  static const CpuFeatures cpu = detect_cpu_features();
  if (isa != Isa::kBest) return kernels_for(isa, cpu);
  for (Isa better : kBestFirst) {
    if (const KernelTable* kernels = kernels_for(better, cpu)) return kernels;
  }
  return kernels_for(Isa::kScalar, cpu);
}

const KernelTable* kernels_from_environment() {
  const char* wanted = getenv("MIEN_ISA");
  if (!wanted || !*wanted) return kernels_for(Isa::kBest);
  for (uint32_t i = 0; i < kIsaCount; ++i) {
    const Isa named = static_cast<Isa>(i);
    if (strcmp(wanted, isa_name(named)) == 0) return kernels_for(named);
  }
  return nullptr;
}

const char* isa_name(Isa isa) {
  static constexpr const char* kNames[kIsaCount] = {"best", "scalar", "sse2",
                                                    "avx2", "avx512", "neon"};
  const uint32_t number = static_cast<uint32_t>(isa);
  return number < kIsaCount ? kNames[number] : "unknown";
}

}  // namespace mien
