// SPDX-License-Identifier: MIT
// Joint values -> local transforms -> model and skin matrices.
#pragma once

#include "runtime/pose/skeleton.h"

namespace mien {

constexpr size_t kLocalTransformFloats = 10;  // tx ty tz qx qy qz qw sx sy sz

/// The joint transforms of one character. A joint has the lane of its place in Skeleton::order.
struct JointPose {
  Span<float> model;               // [joint] model matrix
  Span<float> skin;                // [joint] model matrix * inverse bind matrix
  Span<float> deltas;              // kDeltaRows rows of lanes per block: JointLocalArgs
  Span<float> locals;              // kLocalRows rows of lanes per block: JointLocalArgs
  Span<uint8_t> has_no_delta;      // [lane] all deltas of the joint are zero
  bool non_uniform_scale = false;  // of any joint, or mirrored: normals need the cofactor matrix
};

void place_joint_pose(const Skeleton& skeleton, Placer& placer, JointPose& pose);

/// Joint values -> all of `pose`. `values` has Skeleton::value_count() floats, in the order of the
/// rig's outputs; null means the neutral pose. docs/deformation.md, 1 "Joint transforms".
void pose_joints(const Skeleton& skeleton, const float* values, JointPose& pose);

/// Writes kLocalTransformFloats floats per joint, relative to the parent.
void write_local_transforms(const Skeleton& skeleton, const JointPose& pose, float* out);

}  // namespace mien
