// SPDX-License-Identifier: MIT
// Instruction sets, and the choice of one.
#pragma once

#include <stdint.h>

namespace mien {

/// The values of MIEN_ISA_... in mien.h.
enum class Isa : uint32_t { kBest = 0, kScalar = 1, kSse2 = 2, kAvx2 = 3, kAvx512 = 4, kNeon = 5 };
constexpr uint32_t kIsaCount = 6;

struct KernelTable;  // simd/kernels.h

/// The table of an instruction set; null if this build or this CPU lacks it. For kBest, the best available,
/// which is never null.
const KernelTable* kernels_for(Isa isa);

/// The table that the environment variable MIEN_ISA names, by isa_name(); the best if it is unset or
/// empty. Null if the name is unknown or this CPU or build lacks it.
const KernelTable* kernels_from_environment();

/// "avx2" for Isa::kAvx2; "unknown" for other numbers.
const char* isa_name(Isa isa);

}  // namespace mien
