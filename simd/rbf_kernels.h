// SPDX-License-Identifier: MIT
// RBF solvers, for one character or many.
#pragma once

#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// An RBF solver. Its poses are lanes, in blocks of 16:
///
///     targets    [input][lane]: NaN in the padding of the last block; without inputs one row of 0
///     inverses   if interpolative: blocks of 16 poses, [column][lane], a column for each pose;
///                0 for what fills the last block
///
/// Distance: Euclidean, or the root of the summed squares of the angles between rotations: of 4
/// inputs each, or of the 3 or 2 numbers that the swing or the twist of one has
/// (RbfArgs::rotations), in the order of the axes in RbfArgs. Weight of a distance d, by function:
///
///     0, 1       2^(d * scale)
///     2, 3, 4    max(0, 1 - (d * scale)^n) with n = 1, 3, 5
///
/// NaN has weight 0. If interpolative, the inverse times the weights, clamped to 0..1.
/// Then all are divided by their sum, if that exceeds 1 or always.
struct RbfSolverPlan {
  uint64_t first_target, first_inverse;
  uint32_t first_input, input_count;  // whole angles; into inputs, or the lane of rotations
  uint32_t first_lane, pose_count;
  uint32_t first_control;  // results go to controls from here on, or kNoFirstControl
  float scale, threshold;
  uint8_t function;
  uint8_t angle_inputs;  // 0: Euclidean; else 4, 3 or 2
  bool interpolative, always_normalize;
};

constexpr uint32_t kNoFirstControl = ~uint32_t{0};

/// The solvers of a list. Writes results[first_lane + pose] = factor * the pose's weight times its
/// scale, where that exceeds the threshold, else 0. Nothing is fused: every instruction set gives
/// the same bits. Solvers and inputs may lie anywhere, the rest is 64-byte aligned.
///
/// First all rotations of these blocks are split, in blocks of 16 lanes, into a, b, c, w, where a is the
/// axis of the twist, and b and c are the next two axes. A swing becomes 0, b, c, w; a twist a, 0, 0, w.
struct RbfArgs {
  const RbfSolverPlan* solvers;
  const uint16_t* list;
  uint32_t count;
  const float* inputs;
  float* rotations;                   // [block][4][lane]
  const float* swings;                // [block][lane]: 1 for a swing, 0 for a twist
  uint32_t first_block, block_count;  // of rotations
  const float* targets;
  const float* inverses;
  const float* pose_scales;   // [lane], at most 1e9, so that nothing overflows
  const float* pose_factors;  // [lane], the same
  float* weights;             // [lane]: scratch
  float* results;             // [lane]
  float* controls;
};
using RbfSolversKernel = void(const RbfArgs& args);

/// The same for many characters, one lane each, with the same bits. Controls of lane k are
/// controls[32 * c + k]; results of a solver go to rows[k] + first_control and to the lanes of its
/// controls, or to results[k] + first_lane. For lanes k < lane_count; up to 32 are computed.
struct RbfBatchArgs {
  const RbfSolverPlan* solvers;
  const uint16_t* list;
  uint32_t count;
  const uint16_t* inputs;           // control that an input reads
  const uint16_t* rotation_inputs;  // [block][4][lane]: the same of rotations
  const float* swings;              // [block][lane]
  const float* targets;
  const float* inverses;
  const float* pose_scales;
  const float* pose_factors;
  float* controls;    // 64-byte aligned, and so are the next three
  float* rotations;   // [block][lane][4][32]: scratch
  float* weights[2];  // [pose of the largest solver][32]: scratch
  float* const* rows;
  float* const* results;
  uint32_t block_count;
  uint32_t lane_count;
};
using RbfBatchKernel = void(const RbfBatchArgs& args);

}  // namespace mien
