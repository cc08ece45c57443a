// SPDX-License-Identifier: MIT
// Rig -> skeleton: the order of joints, the neutral pose in lanes, bind matrices and their inverses.
#include <algorithm>

#include "runtime/load/compile/compile_deformer.h"
#include "simd/lanes.h"
#include "simd/pose_kernels.h"

namespace mien {
namespace {

/// Sets `order`: file order, except that parents which the file lists later come first.
Status sort_joints(Skeleton& skeleton, Arena& scratch, Error& error) {
  const uint32_t count = skeleton.joint_count;
  const Span<uint8_t> done = scratch.array<uint8_t>(count);
  const Span<uint16_t> chain = scratch.array<uint16_t>(count);  // a joint and its ancestors
  if (count != 0 && (!done.data || !chain.data)) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to sort %u joints", count);
  }
  uint32_t sorted = 0;
  for (uint32_t j = 0; j < count; ++j) {
    uint32_t at = j, depth = 0;
    while (!done[at]) {
      if (depth == count) {
        return fail(error, Status::kDnaValue, kNoOffset,
                    "joint %u is its own ancestor: the chain of its parents never ends", j);
      }
      chain[depth++] = static_cast<uint16_t>(at);
      if (skeleton.parents[at] == at) break;
      at = skeleton.parents[at];
    }
    while (depth != 0) {
      skeleton.order[sorted++] = chain[--depth];
      done[chain[depth]] = 1;
    }
  }
  return Status::kOk;
}

/// A rigid transform, for row vectors: v * rotation + origin.
struct Frame {
  Matrix3 rotation;
  double origin[3];
};

Quaternion neutral_rotation(const Rig& rig, uint32_t joint) {
  const float* values = rig.neutral_joints.data + size_t{joint} * rig.joint_attributes;
  if (rig.quaternion_outputs) return {values[3], values[4], values[5], values[6]};
  return quaternion_from_euler(rig.rotation, values + 3);
}

Frame neutral_frame(const Rig& rig, uint32_t joint) {
  const float* values = rig.neutral_joints.data + size_t{joint} * rig.joint_attributes;
  return {matrix_from_quaternion(neutral_rotation(rig, joint)), {values[0], values[1], values[2]}};
}

/// `child` is relative to `parent`.
Frame to_model(const Frame& child, const Frame& parent) {
  Frame model = {child.rotation * parent.rotation, {}};
  for (int c = 0; c < 3; ++c) {
    model.origin[c] = parent.origin[c];
    for (int k = 0; k < 3; ++k) model.origin[c] += child.origin[k] * parent.rotation.m[k][c];
  }
  return model;
}

Frame inverse(const Frame& frame) {
  Frame result = {transposed(frame.rotation), {}};
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < 3; ++k) result.origin[c] -= frame.origin[k] * frame.rotation.m[c][k];
  }
  return result;
}

/// As a matrix for column vectors, column by column: the rows of the frame.
void store(const Frame& frame, float* columns) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) columns[r * 4 + c] = static_cast<float>(frame.rotation.m[r][c]);
    columns[12 + r] = static_cast<float>(frame.origin[r]);
  }
  columns[15] = 1;
}

void fill_neutral(const Rig& rig, Skeleton& skeleton) {
  // Lanes past the last joint hold the identity; nothing reads their results.
  for (uint32_t i = 0; i < skeleton.block_count() * kBlockLanes; ++i) {
    float* lane =
        skeleton.neutral.data + i / kBlockLanes * kNeutralRows * kBlockLanes + i % kBlockLanes;
    lane[6 * kBlockLanes] = 1;
    if (i >= skeleton.joint_count) continue;
    const uint32_t joint = skeleton.order[i];
    const float* values = rig.neutral_joints.data + size_t{joint} * rig.joint_attributes;
    for (int k = 0; k < 3; ++k) lane[k * kBlockLanes] = values[k];
    if (skeleton.compose == Compose::kEulerAdd) {
      std::copy(values + 3, values + 6, skeleton.neutral_angles.data + size_t{i} * 3);
      continue;
    }
    const Quaternion q = neutral_rotation(rig, joint);
    lane[3 * kBlockLanes] = q.x;
    lane[4 * kBlockLanes] = q.y;
    lane[5 * kBlockLanes] = q.z;
    lane[6 * kBlockLanes] = q.w;
  }
}

}  // namespace

void place_skeleton(const Rig& rig, Placer& placer, Skeleton& skeleton) {
  const size_t count = rig.joint_count;
  skeleton.joint_count = rig.joint_count;
  skeleton.joint_attributes = rig.joint_attributes;
  skeleton.rotation = rig.rotation;
  skeleton.order = placer.array<uint16_t>(count);
  skeleton.parents = placer.array<uint16_t>(count);
  skeleton.neutral = placer.array<float>(
      size_t{skeleton.block_count()} * kNeutralRows * kBlockLanes, kBlockAlignment);
  skeleton.neutral_angles = placer.array<float>(count * 3);
  skeleton.bind = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  skeleton.inverse_bind = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
}

Status fill_skeleton(const Rig& rig, const KernelTable* kernels, Compose compose, Arena& scratch,
                     Skeleton& skeleton, Error& error) {
  skeleton.kernels = kernels;
  skeleton.compose = compose;
  std::copy(rig.joint_parents.begin(), rig.joint_parents.end(), skeleton.parents.begin());
  const Status status = sort_joints(skeleton, scratch, error);
  if (status != Status::kOk) return status;
  fill_neutral(rig, skeleton);

  // In double, so that matrix * inverse is the identity far from the origin too.
  const Span<Frame> frames = scratch.array<Frame>(skeleton.joint_count);
  if (!frames.data && skeleton.joint_count != 0) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for %u joints", skeleton.joint_count);
  }
  for (uint16_t j : skeleton.order) {
    const Frame local = neutral_frame(rig, j);
    const uint16_t parent = skeleton.parents[j];
    frames[j] = parent == j ? local : to_model(local, frames[parent]);
    store(frames[j], skeleton.bind.data + j * kMatrixFloats);
    store(inverse(frames[j]), skeleton.inverse_bind.data + j * kMatrixFloats);
  }
  return Status::kOk;
}

}  // namespace mien
