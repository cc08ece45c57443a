// SPDX-License-Identifier: MIT
// The joint hierarchy of a rig, sorted parents first, with its neutral pose and bind matrices. Part
// of the deformer's block of memory; immutable once filled.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/rig/rig.h"
#include "simd/isa.h"
#include "simd/lanes.h"

namespace mien {

/// Same numbers as MIEN_COMPOSE_... in mien.h.
enum class Compose : uint32_t { kProduct = 0, kEulerAdd = 1 };

constexpr size_t kMatrixFloats = 16;  // four columns of four; the last row is 0 0 0 1

struct Skeleton {
  const KernelTable* kernels = nullptr;
  uint32_t joint_count = 0;
  uint32_t joint_attributes = kFileAttributes;  // 9, or 10 with quaternions
  Compose compose = Compose::kProduct;
  RotationConvention rotation;

  Span<uint16_t> order;        // joints, parents before children; order[i] has lane i
  Span<uint16_t> parents;      // [joint]; a root is its own parent
  Span<float> neutral;         // kNeutralRows rows of lanes per block: JointLocalArgs
  Span<float> neutral_angles;  // [lane] x y z in the file's unit; only for Compose::kEulerAdd
  Span<float> bind;            // [joint] model matrix of the neutral pose
  Span<float> inverse_bind;    // [joint]

  uint32_t value_count() const { return joint_count * joint_attributes; }
  uint32_t block_count() const { return (joint_count + kBlockLanes - 1) / kBlockLanes; }
  bool quaternions() const { return joint_attributes != kFileAttributes; }
};

}  // namespace mien
