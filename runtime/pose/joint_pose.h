// SPDX-License-Identifier: MIT
// Joint values -> local transforms -> model and skin matrices.
#pragma once

#include "runtime/pose/skeleton.h"

namespace mien {

constexpr size_t kLocalTransformFloats = 10;  // tx ty tz qx qy qz qw sx sy sz

/// The joints of one character.
struct JointPose {
  Span<float> model;    // [joint] matrices
  Span<float> skin;     // [joint] model * inverse bind
  Span<float> deltas;   // blocks of lanes: kDeltaRows, as simd/kernels.h draws them
  Span<float> locals;   // blocks of lanes: kLocalRows
  Span<uint8_t> still;  // [lane] no delta at all
  bool skewed = false;  // some scale is not uniform and positive: normals need more than the matrix
};

void place_joint_pose(const Skeleton& skeleton, Placer& placer, JointPose& pose);

/// `values` as the rig gives them; null for the neutral pose. Fills all of `pose`.
void pose_joints(const Skeleton& skeleton, const float* values, JointPose& pose);

/// kLocalTransformFloats for each joint.
void write_local_transforms(const Skeleton& skeleton, const JointPose& pose, float* out);

}  // namespace mien
