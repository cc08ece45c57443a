// SPDX-License-Identifier: MIT
// Removes small entries of the joint matrix, and measures the effect.
#pragma once

#include "author/document/document.h"
#include "author/document/pose_difference.h"

namespace mien::author {

struct JointPruning {
  float translation = 0, rotation = 0,
        scale = 0;  // entries up to these become 0, in the units of the file
};

struct PrunedJoints {
  uint64_t entries = 0, removed = 0;  // that were not 0; that became 0
  PoseDifference worst;
};

/// Sets small entries to 0 and removes columns and rows of joint groups that have no others. Measures how
/// far that moves the positions of LOD 0, over all poses of ControlPoses.
Status prune_joint_matrix(Document& document, const JointPruning& pruning, PrunedJoints& out,
                          Error& error);

}  // namespace mien::author
