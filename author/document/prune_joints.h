// SPDX-License-Identifier: MIT
// Removes small entries of the joint matrix, and measures the effect.
#pragma once

#include "author/document/document.h"

namespace mien::author {

struct JointPruning {
  float translation = 0, rotation = 0,
        scale = 0;  // entries up to these become 0, in the units of the file
};

/// The largest distance between positions of two documents whose controls act differently.
struct PoseDifference {
  double distance = 0;   // in the unit of the file
  uint32_t control = 0;  // of the pose: a raw control, or a corrective
  uint32_t mesh = 0, position = 0;
};

struct PrunedJoints {
  uint64_t entries = 0, removed = 0;  // that were not 0; that became 0
  PoseDifference worst;
};

/// Sets small entries to 0 and removes columns and rows of joint groups that have no others. Measures how
/// far that moves the positions of LOD 0, over all poses of ControlPoses.
Status prune_joint_matrix(Document& document, const JointPruning& pruning, PrunedJoints& out,
                          Error& error);

/// The worst position over all poses in which a control with changed[control] != 0 is not 0. Both views have
/// the same definition and meshes.
Status measure_difference(const dna::DnaView& before, const dna::DnaView& after,
                          Span<const uint8_t> changed, const Allocator& allocator,
                          PoseDifference& out, Error& error);

}  // namespace mien::author
