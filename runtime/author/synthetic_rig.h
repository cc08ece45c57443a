// SPDX-License-Identifier: MIT
// Generated face rigs of any size, for tests, benchmarks and those who have no rig at hand.
//
// The preset decides all sizes, the seed all numbers; the same pair gives the same bytes wherever
// doubles are those of IEEE 754. The rigs behave like produced ones: controls move neighbouring
// regions of a head, correctives live where their members overlap, and LODs drop joints from the
// finest on.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/dna/dna_view.h"

namespace mien {

enum class SyntheticPreset : uint32_t { kTiny = 0, kSmall = 1, kMedium = 2, kLarge = 3 };

/// A 2.8 file with all layers loaded; RBF, twist and swing, and learned behaviour are empty. Its
/// arrays and lists lie in `arena`. Returns false if memory ran out; `out` is then empty and the
/// arena holds what had been made.
bool make_synthetic_rig(SyntheticPreset preset, uint64_t seed, Arena& arena, dna::DnaView& out);

}  // namespace mien
