// SPDX-License-Identifier: MIT
// The procedural head as layers of a DNA file. Each of these fills its part of `out` and returns
// false if memory ran out.
#pragma once

#include "author/generate/head/fit.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::head {

struct Head {
  const Form& form;
  const Shapes& shapes;
  const Skeleton& skeleton;
  JointDeltas deltas;
};

/// Control names, GUI table, correctives, animated maps.
bool fill_controls(const Head& head, Arena& arena, dna::DnaView& out);
/// Joint names, hierarchy, neutral pose, joint groups.
bool fill_joints(const Head& head, Arena& arena, Arena& scratch, dna::DnaView& out);
/// Meshes, blend shape channels, and the metadata with colors after `metadata_used` entries. `skin` is the part
/// kHead, `displacements` are those of its vertices.
bool fill_meshes(const Head& head, const PartLods& skin, Displacements& displacements, Arena& arena,
                 const Allocator& allocator, size_t metadata_used, dna::DnaView& out);

/// Meshes: every part at every LOD, with the parts of a LOD in sequence.
constexpr uint32_t kMeshCount = kPartCount * kLodCount;
/// LODs with blend shapes of the whole face; the others have only those of the edges of the lips.
constexpr uint32_t kShapeLods = 2;

}  // namespace mien::head
