// SPDX-License-Identifier: MIT
#include "runtime/pose/joint_pose.h"

#include <algorithm>
#include <cmath>

#include "simd/kernels.h"
#include "simd/pose_kernels.h"

namespace mien {
namespace {

constexpr float kUniformScaleTolerance = 1e-4f;
constexpr float kPi = 3.14159265f;

float* lane(const Span<float>& rows, uint32_t row_count, uint32_t i) {
  return rows.data + size_t{i / kBlockLanes} * row_count * kBlockLanes + i % kBlockLanes;
}

/// True if a scale delta is not uniform, or mirrors. NaN counts as not uniform.
bool is_non_uniform(const float* scale) {
  return !(std::fabs(scale[0] - scale[1]) <= kUniformScaleTolerance &&
           std::fabs(scale[0] - scale[2]) <= kUniformScaleTolerance && scale[0] > -1);
}

/// Half of an angle given in the file's unit, in radians. Reduced to one turn before it is
/// converted, because the remainder is exact in the file's unit.
float half_angle(const RotationConvention& rotation, float angle, int axis) {
  const float half_turn = kPi / rotation.to_radians;
  if (!(std::fabs(angle) <= half_turn)) {
    angle = rotation.to_radians == 1
                ? static_cast<float>(std::remainder(static_cast<double>(angle), 6.283185307179586))
                : std::remainder(angle, 360.0f);
  }
  return angle * rotation.signs[axis] * rotation.to_radians * 0.5f;
}

/// Writes the joint values of the file's order into lanes: translation, half angles, scale.
void spread_euler(const Skeleton& skeleton, const float* values, JointPose& pose) {
  const bool add = skeleton.compose == Compose::kEulerAdd;
  for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
    const float* from = values + size_t{skeleton.order[i]} * kFileAttributes;
    float* to = lane(pose.deltas, kDeltaRows, i);
    bool zero = true;
    for (uint32_t a = 0; a < kFileAttributes; ++a) zero &= from[a] == 0;
    pose.has_no_delta[i] = zero;
    pose.non_uniform_scale |= is_non_uniform(from + 6);
    const float* neutral = skeleton.neutral_angles.data + size_t{i} * 3;
    for (int k = 0; k < 3; ++k) {
      to[k * int{kBlockLanes}] = from[k];
      const float angle = add ? neutral[k] + from[3 + k] : from[3 + k];
      to[(3 + k) * int{kBlockLanes}] = half_angle(skeleton.rotation, angle, k);
      to[(7 + k) * int{kBlockLanes}] = from[6 + k];
    }
  }
}

/// The same for joint values with quaternions: translation, quaternion, scale.
void spread_quaternions(const Skeleton& skeleton, const float* values, JointPose& pose) {
  constexpr uint32_t kAttributes = kFileAttributes + 1;
  for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
    const float* from = values + size_t{skeleton.order[i]} * kAttributes;
    float* to = lane(pose.deltas, kDeltaRows, i);
    bool zero = true;
    for (uint32_t a = 0; a < kAttributes; ++a) {
      to[a * kBlockLanes] = from[a];
      zero &= a == 6 || from[a] == 0;  // (0, 0, 0, w) is the identity for any w
    }
    pose.has_no_delta[i] = zero;
    pose.non_uniform_scale |= is_non_uniform(from + 7);
  }
}

/// The neutral pose. With Compose::kEulerAdd the lanes still hold the neutral angles.
void clear_deltas(const Skeleton& skeleton, JointPose& pose) {
  std::fill(pose.deltas.begin(), pose.deltas.end(), 0.0f);
  if (skeleton.compose == Compose::kEulerAdd) {
    for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
      for (int k = 0; k < 3; ++k) {
        lane(pose.deltas, kDeltaRows, i)[(3 + k) * int{kBlockLanes}] = half_angle(
            skeleton.rotation, skeleton.neutral_angles[size_t{i} * 3 + static_cast<size_t>(k)], k);
      }
    }
  }
  std::fill(pose.has_no_delta.begin(), pose.has_no_delta.end(), uint8_t{1});
}

}  // namespace

void place_joint_pose(const Skeleton& skeleton, Placer& placer, JointPose& pose) {
  const size_t count = skeleton.joint_count;
  const size_t lanes = size_t{skeleton.block_count()} * kBlockLanes;
  pose.model = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  pose.skin = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  pose.deltas = placer.array<float>(lanes * kDeltaRows, kBlockAlignment);
  pose.locals = placer.array<float>(lanes * kLocalRows, kBlockAlignment);
  pose.has_no_delta = placer.array<uint8_t>(lanes);
}

void pose_joints(const Skeleton& skeleton, const float* values, JointPose& pose) {
  pose.non_uniform_scale = false;
  if (!values) {
    clear_deltas(skeleton, pose);
  } else if (skeleton.quaternions()) {
    spread_quaternions(skeleton, values, pose);
  } else {
    spread_euler(skeleton, values, pose);
  }

  JointLocalArgs locals;
  locals.neutral = skeleton.neutral.data;
  locals.deltas = pose.deltas.data;
  locals.locals = pose.locals.data;
  locals.block_count = skeleton.block_count();
  std::copy(skeleton.rotation.axes, skeleton.rotation.axes + 3, locals.axes);
  locals.quaternions = skeleton.quaternions();
  skeleton.kernels->joint_locals(locals);

  JointTreeArgs tree;
  tree.order = skeleton.order.data;
  tree.parents = skeleton.parents.data;
  tree.locals = pose.locals.data;
  tree.has_no_delta = pose.has_no_delta.data;
  tree.inverse_bind = skeleton.inverse_bind.data;
  tree.model = pose.model.data;
  tree.skin = pose.skin.data;
  tree.joint_count = skeleton.joint_count;
  skeleton.kernels->joint_tree(tree);
}

void write_local_transforms(const Skeleton& skeleton, const JointPose& pose, float* out) {
  for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
    const float* local = lane(pose.locals, kLocalRows, i);
    const float* delta = lane(pose.deltas, kDeltaRows, i);
    float* to = out + size_t{skeleton.order[i]} * kLocalTransformFloats;
    for (uint32_t k = 0; k < 3; ++k) to[k] = local[(9 + k) * kBlockLanes];
    for (uint32_t k = 0; k < 4; ++k) to[3 + k] = local[(12 + k) * kBlockLanes];
    for (uint32_t k = 0; k < 3; ++k) to[7 + k] = 1.0f + delta[(7 + k) * kBlockLanes];
  }
}

}  // namespace mien
