// SPDX-License-Identifier: MIT
#include "runtime/pose/joint_pose.h"

#include <cmath>
#include <cstring>

namespace mien {
namespace {

constexpr size_t kLocalFloats = 10;

void multiply(const float* a, const float* b, float* out) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      float sum = c == 3 ? a[12 + r] : 0.0f;
      for (int k = 0; k < 3; ++k) sum = sum + a[k * 4 + r] * b[c * 4 + k];
      out[c * 4 + r] = sum;
    }
  }
  out[3] = out[7] = out[11] = 0;
  out[15] = 1;
}

}  // namespace

void place_joint_pose(const Skeleton& skeleton, Placer& placer, JointPose& pose) {
  const size_t count = skeleton.joint_count;
  pose.model = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  pose.skin = placer.array<float>(count * kMatrixFloats, kBlockAlignment);
  pose.locals = placer.array<float>(count * kLocalFloats, kBlockAlignment);
}

void pose_joints(const Skeleton& skeleton, const float* values, JointPose& pose) {
  const uint32_t attributes = skeleton.joint_attributes;
  pose.skewed = false;
  for (uint16_t j : skeleton.order) {
    const float* neutral = skeleton.neutral.data + size_t{j} * attributes;
    float none[10] = {};
    const float* delta = values ? values + size_t{j} * attributes : none;
    Quaternion q;
    bool still = true;
    for (uint32_t a = 0; a < attributes; ++a) {
      still = still && (delta[a] == 0 || (attributes == 10 && a == 6));
    }
    if (skeleton.quaternions()) {
      q = Quaternion{neutral[3], neutral[4], neutral[5], neutral[6]} *
          normalized({delta[3], delta[4], delta[5], delta[6]});
    } else if (skeleton.compose == Compose::kEulerAdd) {
      const float sum[3] = {neutral[3] + delta[3], neutral[4] + delta[4], neutral[5] + delta[5]};
      q = quaternion_from_euler(skeleton.rotation, sum);
    } else {
      q = quaternion_from_euler(skeleton.rotation, neutral + 3) *
          quaternion_from_euler(skeleton.rotation, delta + 3);
    }
    q = normalized(q);
    const float* scale = delta + attributes - 3;
    if (!(std::fabs(scale[0] - scale[1]) <= 1e-4f && std::fabs(scale[0] - scale[2]) <= 1e-4f &&
          scale[0] > -1)) {
      pose.skewed = true;
    }
    float* local = pose.locals.data + j * kLocalFloats;
    for (int i = 0; i < 3; ++i) local[i] = neutral[i] + delta[i];
    local[3] = q.x;
    local[4] = q.y;
    local[5] = q.z;
    local[6] = q.w;
    for (int i = 0; i < 3; ++i) local[7 + i] = 1.0f + scale[i];

    const Matrix3 turn = matrix_from_quaternion(q);
    float matrix[kMatrixFloats] = {};
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        matrix[c * 4 + r] = static_cast<float>(turn.m[c][r]) * local[7 + c];
      }
      matrix[12 + c] = local[c];
    }
    matrix[15] = 1;
    float* model = pose.model.data + j * kMatrixFloats;
    float* skin = pose.skin.data + j * kMatrixFloats;
    const uint16_t parent = skeleton.parents[j];
    if (parent == j) {
      memcpy(model, matrix, sizeof(matrix));
    } else {
      multiply(pose.model.data + parent * kMatrixFloats, matrix, model);
    }
    if (!still) {
      multiply(model, skeleton.inverse_bind.data + j * kMatrixFloats, skin);
    } else if (parent != j) {
      // Exactly the motion of the parent: what does not move rounds nowhere.
      memcpy(skin, pose.skin.data + parent * kMatrixFloats, sizeof(matrix));
    } else {
      memset(skin, 0, sizeof(matrix));
      skin[0] = skin[5] = skin[10] = skin[15] = 1;
    }
  }
}

}  // namespace mien
