// SPDX-License-Identifier: MIT
// Joint values -> model and skin matrices.
#pragma once

#include "runtime/pose/skeleton.h"

namespace mien {

/// The joints of one character.
struct JointPose {
  Span<float> model;    // [joint] matrices
  Span<float> skin;     // [joint] model * inverse bind
  Span<float> locals;   // [joint] tx ty tz qx qy qz qw sx sy sz
  bool skewed = false;  // some scale is not uniform and positive: normals need more than the matrix
};

void place_joint_pose(const Skeleton& skeleton, Placer& placer, JointPose& pose);

/// `values` as the rig gives them; null for the neutral pose. Fills all of `pose`.
void pose_joints(const Skeleton& skeleton, const float* values, JointPose& pose);

}  // namespace mien
