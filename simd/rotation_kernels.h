// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions, Euler angles, twists and swings.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// Rotations of quaternion joints, in blocks of 16, one lane each. The steps of block b
/// begin with step first_steps[b]:
///
///     values    step 0: x0..x15 y0..y15 z0..z15 w0..w15 | step 1: ...
///     columns   step 0: c0..c15 | step 1: ...
///
/// For each lane: the product, over its steps in order, of the quaternion of the step blended with
/// the identity by controls[column]; later steps turn last. All w are >= 0. A lane has the first
/// lane_steps[16 * b + lane] of the step_counts[b] steps of its block. Controls count as up to 1e7 of
/// either sign. Writes rotations[64 * b + 16 * k + lane] for k = x, y, z, w. Nothing is fused.
struct QuaternionJointArgs {
  const void* values;  // floats or halves, 64-byte aligned
  const uint16_t* columns;
  const uint32_t* first_steps;
  const uint32_t* step_counts;
  const float* lane_steps;  // whole numbers; 64-byte aligned
  const float* controls;
  float* rotations;  // 64-byte aligned
  uint32_t block_count;
  bool halves;
};
using QuaternionJointsKernel = void(const QuaternionJointArgs& args);

/// The same for joints (lanes) `first` and on for many characters, with the same bits: controls of
/// character k are controls[32 * c + k]. For k < lane_count:
///
///     rotations   joint: characters 0..15: x0..x15 y z w | characters 16..31, if there are any | next joint
struct QuaternionBatchArgs {
  const void* values;  // as above; so are the others unless noted
  const uint16_t* columns;
  const uint32_t* first_steps;
  const uint32_t* step_counts;
  const float* lane_steps;
  const float* controls;  // 64-byte aligned
  float* rotations;
  uint32_t first, count;  // joints
  uint32_t lane_count;    // characters
  bool halves;
};
using QuaternionBatchKernel = void(const QuaternionBatchArgs& args);

/// Euler angles as files have them (docs/rig-evaluation.md, 4.6 "Euler angles and quaternions").
struct EulerForm {
  uint8_t axes[3];        // first, second, third axis to turn about
  float parity;           // of `axes` as a permutation: 1 or -1
  float to_radians[3];    // of the angles about x y z, with their signs
  float from_radians[3];  // likewise
};

/// Rotations from one form to the other, in blocks of 16, one lane each; `from` may be `to`:
///
///     quaternions   block 0: x0..x15 y0..y15 z0..z15 w0..w15 | block 1: ...
///     angles        block 0: x0..x15 y0..y15 z0..z15 *       | block 1: ...
///
/// Quaternions need not be unit: those of length 1e-9 ... 1e9 have the angles of the unit one, 0 those of the
/// identity. Angles are any finite ones. Nothing is fused: every instruction set gives the same bits. Arrays
/// are 64-byte aligned.
struct EulerArgs {
  EulerForm form;
  const float* from;
  float* to;
  uint32_t count;  // rotations; the rest of the last vector is computed, too
};
/// angles_from_quaternions, quaternions_from_angles
using EulerKernel = void(const EulerArgs& args);

/// Twists and swings (docs/rig-evaluation.md, 7 "Twist and swing"), in blocks of 16 outputs, one lane
/// each, 64-byte aligned:
///
///     inputs      block 0: controls of x y z w | block 1: ...
///     lanes       block 0: ux uy uz, blend, swing | block 1: ...
///     rotations   block 0: x y z w | block 1: ...
///
/// (ux uy uz) selects the axis of the twist: 1 there, or -1 for its inverse, else 0. `swing` is 1 for the
/// outputs of a swing, where the twist is inverted, else 0. Inputs are used as they are, unless their length
/// is beyond 1e-9 ... 1e9: then they are normalized, and the outputs are unit. 0 is the identity. Nothing is
/// fused, as above.
struct TwistSwingArgs {
  const uint16_t* inputs;
  const float* lanes;
  const float* controls;
  float* rotations;
  uint32_t block_count;
};
using TwistSwingKernel = void(const TwistSwingArgs& args);
constexpr uint32_t kTwistSwingRows = 5;

/// The same for outputs `first` and on for many characters, with controls and rotations as
/// QuaternionBatchArgs has them.
struct TwistSwingBatchArgs {
  const uint16_t* inputs;
  const float* lanes;
  const float* controls;
  float* rotations;
  uint32_t first, count;  // outputs
  uint32_t lane_count;    // characters
};
using TwistSwingBatchKernel = void(const TwistSwingBatchArgs& args);

/// scatter_rotation: rows[k][first ...] = the rotation of character k, in blocks of characters as
/// QuaternionBatchArgs has them: four numbers, or three angles.
using ScatterRotationKernel = void(const float* rotation, uint32_t lane_count, size_t first,
                                   bool quaternions, float* const* rows);

}  // namespace mien
