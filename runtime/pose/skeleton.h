// SPDX-License-Identifier: MIT
// Joints as poses need them: parents before children, the neutral pose, its model matrices and
// their inverses. Placed in the block of whoever owns it, then immutable.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/rig/rig.h"

namespace mien {

/// Numbers of MIEN_COMPOSE_... in mien.h.
enum class Compose : uint32_t { kProduct = 0, kEulerAdd = 1 };

constexpr size_t kMatrixFloats = 16;  // four columns; the last row is 0 0 0 1

struct Skeleton {
  const KernelTable* kernels = nullptr;
  uint32_t joint_count = 0;
  uint32_t joint_attributes = kFileAttributes;  // 9, or 10 with quaternions
  Compose compose = Compose::kProduct;
  RotationConvention rotation;

  Span<uint16_t> order;      // joints, parents before children; order[i] has lane i
  Span<uint16_t> parents;    // [joint]; a root is its own
  Span<float> neutral;       // blocks of lanes: kNeutralRows as simd/kernels.h draws them
  Span<float> added_angles;  // [lane] about x y z, in the file's unit: what Euler angles add up to
  Span<float> bind;          // [joint] model matrix in neutral
  Span<float> inverse_bind;  // [joint]

  uint32_t value_count() const { return joint_count * joint_attributes; }
  uint32_t block_count() const { return (joint_count + kBlockLanes - 1) / kBlockLanes; }
  bool quaternions() const { return joint_attributes != kFileAttributes; }
};

}  // namespace mien
