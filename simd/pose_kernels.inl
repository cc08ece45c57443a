// SPDX-License-Identifier: MIT
// Joint values -> local transforms -> model and skin matrices. Nothing is fused here, so that all
// instruction sets give the same matrices: small differences would grow down the hierarchy.

#pragma once

#include "simd/math.inl"
#include "simd/pose_kernels.h"
#include "simd/quad.inl"
#include "simd/rotation_kernels.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

/// The product of the rotations about three axes, given their half angles.
inline VecQuaternion from_half_angles(const float* half_angles, const uint8_t* axes) {
  Vec q[4] = {broadcast(0.0f), broadcast(0.0f), broadcast(0.0f), broadcast(1.0f)};
  for (int i = 0; i < 3; ++i) {
    const Vec half = load(half_angles + axes[i] * kBlockLanes);
    turn_about(axes[i], bounded_sine(half), bounded_cosine(half), q);
  }
  return {q[0], q[1], q[2], q[3]};
}

/// Normalized; the identity for a quaternion without direction.
inline VecQuaternion unit(const VecQuaternion& q) {
  const Vec zero = broadcast(0.0f), one = broadcast(1.0f);
  const Vec squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  const Vec scale = divide(one, square_root(squared));
  const auto part = [&](Vec value, Vec otherwise) {
    const Vec bounded = select(less(squared, broadcast(3.4e38f)), value * scale, otherwise);
    return select(less(broadcast(1e-36f), squared), bounded, otherwise);
  };
  return {part(q.x, zero), part(q.y, zero), part(q.z, zero), part(q.w, one)};
}

void joint_locals(const JointLocalArgs& args) {
  const Vec one = broadcast(1.0f);
  for (size_t block = 0; block < args.block_count; ++block) {
    for (size_t lane = 0; lane < kBlockLanes; lane += kWidth) {
      const float* neutral = args.neutral + block * kNeutralRows * kBlockLanes + lane;
      const float* delta = args.deltas + block * kDeltaRows * kBlockLanes + lane;
      float* out = args.locals + block * kLocalRows * kBlockLanes + lane;
      const float* rotation = delta + 3 * kBlockLanes;
      const VecQuaternion own = args.quaternions ? unit(load_quaternion(rotation))
                                                 : from_half_angles(rotation, args.axes);
      const VecQuaternion q = unit(multiply(load_quaternion(neutral + 3 * kBlockLanes), own));

      const Vec x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
      const Vec xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
      const Vec xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
      const Vec wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
      const Vec axes[3][3] = {{one - (yy + zz), xy + wz, xz - wy},
                              {xy - wz, one - (xx + zz), yz + wx},
                              {xz + wy, yz - wx, one - (xx + yy)}};
      for (size_t c = 0; c < 3; ++c) {
        const Vec scale = one + load(delta + (7 + c) * kBlockLanes);
        for (size_t r = 0; r < 3; ++r) store(out + (3 * c + r) * kBlockLanes, axes[c][r] * scale);
        store(out + (9 + c) * kBlockLanes,
              load(neutral + c * kBlockLanes) + load(delta + c * kBlockLanes));
      }
      store(out + 12 * kBlockLanes, q.x);
      store(out + 13 * kBlockLanes, q.y);
      store(out + 14 * kBlockLanes, q.z);
      store(out + 15 * kBlockLanes, q.w);
    }
  }
}

struct Columns {
  Quad x, y, z, origin;
};
inline Columns load_columns(const float* from) {
  return {load4(from), load4(from + 4), load4(from + 8), load4(from + 12)};
}
inline void store_columns(float* to, const Columns& m) {
  store4(to, m.x);
  store4(to + 4, m.y);
  store4(to + 8, m.z);
  store4(to + 12, m.origin);
}

/// The linear part of m times a column whose three floats are `stride` apart.
inline Quad transform(const Columns& m, const float* column, size_t stride) {
  return m.x * broadcast4(column[0]) + m.y * broadcast4(column[stride]) +
         m.z * broadcast4(column[2 * stride]);
}

/// m times a matrix whose four columns are `column` floats apart, its three rows `row` floats.
inline Columns product(const Columns& m, const float* of, size_t column, size_t row) {
  return {transform(m, of, row), transform(m, of + column, row), transform(m, of + 2 * column, row),
          transform(m, of + 3 * column, row) + m.origin};
}

void joint_tree(const JointTreeArgs& args) {
  alignas(16) static constexpr float kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0,
                                                      0, 0, 1, 0, 0, 0, 0, 1};
  for (size_t i = 0; i < args.joint_count; ++i) {
    const size_t joint = args.order[i], parent = args.parents[joint];
    const bool root = parent == joint;
    const float* local = args.locals + i / kBlockLanes * kLocalRows * kBlockLanes + i % kBlockLanes;
    const Columns parent_model = load_columns(root ? kIdentity : args.model + parent * 16);
    const Columns model = product(parent_model, local, 3 * kBlockLanes, kBlockLanes);
    store_columns(args.model + joint * 16, model);
    const Columns skin = !args.has_no_delta[i]
                             ? product(model, args.inverse_bind + joint * 16, 4, 1)
                         : root ? load_columns(kIdentity)
                                : load_columns(args.skin + parent * 16);
    store_columns(args.skin + joint * 16, skin);
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
