// SPDX-License-Identifier: MIT
// Joints represented by quaternions.

#pragma once

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

struct VecQuaternion {
  Vec x, y, z, w;
};

inline VecQuaternion load_quaternion(const float* at) {
  return {load(at), load(at + kBlockLanes), load(at + 2 * kBlockLanes), load(at + 3 * kBlockLanes)};
}
inline VecQuaternion load_quaternion(const uint16_t* at) {
  return {load_half(at), load_half(at + kBlockLanes), load_half(at + 2 * kBlockLanes),
          load_half(at + 3 * kBlockLanes)};
}

// The blend is made unit by a true root and division: estimates would bend the joints.
inline VecQuaternion blend_with_identity(const VecQuaternion& q, float weight) {
  const Vec t = broadcast(weight);
  const VecQuaternion b = {t * q.x, t * q.y, t * q.z, t * q.w + broadcast(1.0f - weight)};
  const Vec length = square_root(b.x * b.x + b.y * b.y + b.z * b.z + b.w * b.w);
  const Vec scale = divide(broadcast(1.0f), length);
  return {b.x * scale, b.y * scale, b.z * scale, b.w * scale};
}

inline VecQuaternion multiply(const VecQuaternion& a, const VecQuaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// Controls this large turn no joint any further. Up to 2^24, 1 - weight is exact, so that the
// identity blended with itself never vanishes.
inline float bounded(float weight) {
  constexpr float kLargest = 1e7f;
  return weight > kLargest ? kLargest : weight < -kLargest ? -kLargest : weight;
}

template <class Value>
void turn(const Value* all_values, const QuaternionJointArgs& args) {
  constexpr size_t kColumnFloats = 4 * kBlockLanes;
  for (size_t block = 0; block < args.block_count; ++block) {
    const Value* values = all_values + block * args.column_stride * kColumnFloats;
    for (size_t lane = 0; lane < kBlockLanes; lane += kWidth) {
      VecQuaternion product = {broadcast(0.0f), broadcast(0.0f), broadcast(0.0f), broadcast(1.0f)};
      for (size_t c = 0; c < args.column_count; ++c) {
        const float weight = bounded(args.controls[args.columns[c]]);
        if (weight == 0.0f) continue;  // the identity
        const VecQuaternion q = load_quaternion(values + c * kColumnFloats + lane);
        product = multiply(blend_with_identity(q, weight), product);
      }
      float* out = args.rotations + block * kColumnFloats + lane;
      store(out, product.x);
      store(out + kBlockLanes, product.y);
      store(out + 2 * kBlockLanes, product.z);
      store(out + 3 * kBlockLanes, product.w);
    }
  }
}

void quaternion_joints(const QuaternionJointArgs& args) {
  if (args.halves) {
    turn(static_cast<const uint16_t*>(args.values), args);
  } else {
    turn(static_cast<const float*>(args.values), args);
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
