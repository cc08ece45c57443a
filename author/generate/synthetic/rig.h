// SPDX-License-Identifier: MIT
// Generated face rigs of any size, for tests, benchmarks and first steps without a rig of one's own.
//
// The preset determines all sizes, the seed all numbers; the same pair gives the same bytes wherever doubles
// are those of IEEE 754. The rigs have the structure of production rigs. Heads: controls move neighboring
// regions of a head, correctives are where their members overlap, and LODs drop the finest joints first. The
// body: RBF solvers compare rotations of joints with poses, whose controls move corrective joints; other
// joints twist and swing with them.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien {

enum class SyntheticPreset : uint32_t {
  kTiny = 0,
  kSmall = 1,
  kMedium = 2,
  kLarge = 3,
  kBody = 4,
  // With the counts, versions and names of exported characters.
  kMetaHumanHead = 6,
  kMetaHumanBody = 7,
  kArchetype = 8,  // the same head without blend shapes
};

/// A file with all layers loaded; of version 2.8, but for kMetaHumanHead and kArchetype (2.5) and
/// kMetaHumanBody (2.7). Heads have no twists and swings; those of characters have one RBF solver, the others
/// none. Networks are included if `learned`, which must be false for the last three presets. Its arrays and
/// lists are in `arena`. Returns false if memory ran out; `out` is then empty, and the arena keeps its
/// allocations.
bool make_synthetic_rig(SyntheticPreset preset, uint64_t seed, Arena& arena, dna::DnaView& out,
                        bool learned = false);

}  // namespace mien
