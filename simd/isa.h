// SPDX-License-Identifier: MIT
// Instruction sets, and which one to use.
#pragma once

#include <stdint.h>

namespace mien {

/// Numbers of MIEN_ISA_... in mien.h.
enum class Isa : uint32_t { kBest = 0, kScalar = 1, kSse2 = 2, kAvx2 = 3, kAvx512 = 4, kNeon = 5 };
constexpr uint32_t kIsaCount = 6;

struct KernelTable;  // simd/kernels.h

/// The table of an instruction set; null if this build or this CPU lacks it. kBest gives the best
/// present, and never null.
const KernelTable* kernels_for(Isa isa);

/// The table that the environment variable MIEN_ISA names, by isa_name(); the best if it is unset or
/// empty. Null if the name is unknown or this CPU or build lacks it.
const KernelTable* kernels_from_environment();

/// "avx2" for Isa::kAvx2; "unknown" for numbers that are none.
const char* isa_name(Isa isa);

}  // namespace mien
