// SPDX-License-Identifier: MIT
// Joint values -> local transforms -> model and skin matrices.
#pragma once

#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// Local transforms of joints, in blocks of 16 joints, one lane each:
///
///     neutral   block 0: tx0..tx15 ty tz qx qy qz qw | block 1: ...
///     deltas    block 0: tx0..tx15 ty tz, rotation, sx sy sz | block 1: ...
///               rotation: the half angles about x y z in radians, at most a quarter turn, or
///               qx qy qz qw, of any length; zero is the identity
///     locals    block 0: x axis (xyz), y axis, z axis, translation, qx qy qz qw | block 1: ...
///
/// Translation: neutral + delta. Rotation: neutral * delta, normalized. The axes are those of the
/// rotation, scaled by 1 + delta. Nothing is fused: all instruction sets give the same bits. All
/// arrays are 64-byte aligned.
struct JointLocalArgs {
  const float* neutral;
  const float* deltas;
  float* locals;
  uint32_t block_count;
  uint8_t axes[3];   // of the first, second and third rotation
  bool quaternions;  // in the deltas
};
using JointLocalsKernel = void(const JointLocalArgs& args);
constexpr uint32_t kNeutralRows = 7, kDeltaRows = 10, kLocalRows = 16;

/// Local transforms -> model and skin matrices, parents before children; joint order[i] has lane i.
/// A joint without a delta copies the skin matrix of its parent, a root takes the identity, so that the
/// vertices of a neutral pose keep their bits. A matrix is four columns of four floats, 64-byte aligned; its
/// last row is 0 0 0 1. Nothing is fused, as above.
struct JointTreeArgs {
  const uint16_t* order;
  const uint16_t* parents;  // [joint]; a root is its own parent
  const float* locals;
  const uint8_t* has_no_delta;  // [lane]
  const float* inverse_bind;
  float* model;
  float* skin;
  uint32_t joint_count;
};
using JointTreeKernel = void(const JointTreeArgs& args);

}  // namespace mien
