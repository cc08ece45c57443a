// SPDX-License-Identifier: MIT
#include "runtime/pose/joint_pose.h"

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

constexpr float kUniformScale = 1e-4f;
constexpr float kHalfTurn = 3.14159265f;

float* lane(const Span<float>& rows, uint32_t row_count, uint32_t i) {
  return rows.data + size_t{i / kBlockLanes} * row_count * kBlockLanes + i % kBlockLanes;
}

bool is_skewed(const float* scale) {
  return !(std::fabs(scale[0] - scale[1]) <= kUniformScale &&
           std::fabs(scale[0] - scale[2]) <= kUniformScale && scale[0] > -1);
}

/// Half of an angle of the file, in radians; whole turns are dropped while they can be told
/// exactly.
float half_angle(const RotationConvention& rotation, float angle, int axis) {
  const float half_turn = kHalfTurn / rotation.to_radians;
  if (!(std::fabs(angle) <= half_turn)) {
    angle = rotation.to_radians == 1
                ? static_cast<float>(std::remainder(static_cast<double>(angle), 6.283185307179586))
                : std::remainder(angle, 360.0f);
  }
  return angle * rotation.signs[axis] * rotation.to_radians * 0.5f;
}

/// Spreads joint values over lanes.
void spread_euler(const Skeleton& skeleton, const float* values, JointPose& pose) {
  const bool add = skeleton.compose == Compose::kEulerAdd;
  for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
    const float* from = values + size_t{skeleton.order[i]} * kFileAttributes;
    float* to = lane(pose.deltas, kDeltaRows, i);
    bool still = true;
    for (uint32_t a = 0; a < kFileAttributes; ++a) still &= from[a] == 0;
    pose.still[i] = still;
    pose.skewed |= is_skewed(from + 6);
    const float* added = skeleton.added_angles.data + size_t{i} * 3;
    for (int k = 0; k < 3; ++k) {
      to[k * int{kBlockLanes}] = from[k];
      const float angle = add ? added[k] + from[3 + k] : from[3 + k];
      to[(3 + k) * int{kBlockLanes}] = half_angle(skeleton.rotation, angle, k);
      to[(7 + k) * int{kBlockLanes}] = from[6 + k];
    }
  }
}

void spread_quaternions(const Skeleton& skeleton, const float* values, JointPose& pose) {
  constexpr uint32_t kAttributes = kFileAttributes + 1;
  for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
    const float* from = values + size_t{skeleton.order[i]} * kAttributes;
    float* to = lane(pose.deltas, kDeltaRows, i);
    bool still = true;
    for (uint32_t a = 0; a < kAttributes; ++a) {
      to[a * kBlockLanes] = from[a];
      still &= a == 6 || from[a] == 0;  // w may be anything: only its sign would be left
    }
    pose.still[i] = still;
    pose.skewed |= is_skewed(from + 7);
  }
}

void clear_deltas(const Skeleton& skeleton, JointPose& pose) {
  std::fill(pose.deltas.begin(), pose.deltas.end(), 0.0f);
  if (skeleton.compose == Compose::kEulerAdd) {
    for (uint32_t i = 0; i < skeleton.joint_count; ++i) {
      for (int k = 0; k < 3; ++k) {
        lane(pose.deltas, kDeltaRows, i)[(3 + k) * int{kBlockLanes}] = half_angle(
            skeleton.rotation, skeleton.added_angles[size_t{i} * 3 + static_cast<size_t>(k)], k);
      }
    }
  }
  std::fill(pose.still.begin(), pose.still.end(), uint8_t{1});
}

}  // namespace

void place_joint_pose(const Skeleton& skeleton, Placer& placer, JointPose& pose) {
  const size_t count = skeleton.joint_count;
  const size_t lanes = size_t{skeleton.block_count()} * kBlockLanes;
  pose.model = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  pose.skin = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  pose.deltas = placer.array<float>(lanes * kDeltaRows, kBlockAlignment);
  pose.locals = placer.array<float>(lanes * kLocalRows, kBlockAlignment);
  pose.still = placer.array<uint8_t>(lanes);
}

void pose_joints(const Skeleton& skeleton, const float* values, JointPose& pose) {
  pose.skewed = false;
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
  tree.still = pose.still.data;
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
