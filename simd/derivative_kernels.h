// SPDX-License-Identifier: MIT
// Products with transposed matrices, for derivatives in reverse (runtime/derive).
#pragma once

#include <stdint.h>

#include "simd/joint_kernels.h"

namespace mien {

/// Gradients that joint_transposed multiplies together.
constexpr uint32_t kTransposedLanes = 8;

/// The transposed joint matrix: for each run, with the block rows of JointColumnsArgs, and each lane k of
/// `lane_count`, which is 1 or kTransposedLanes,
///
///     outputs[run * lane_count + k] = sum over its blocks of values(r) * row r of the block row in lane k
///
///     rows  block rows 0, 1: | lane 0: r0 ... r15 | lane 1: r0 ... r15 | ... | block rows 2, 3: ... | ...
///
/// There are 16 sums: of each row of the even and of the odd block rows, in the order of the blocks; those of
/// pairs first. Each eight are added up in halves, then odd to even. So lanes have the bits of single gradients.
/// The inputs of the runs are not used. With one lane, neighboring runs should have about as many pairs and single
/// blocks, which are then multiplied at the same time.
struct JointTransposedArgs {
  const void* values;  // float, or int16_t
  const uint16_t* block_rows;
  const JointRun* runs;
  const float* rows;  // where block row 0 is; 64-byte aligned
  float* outputs;
  uint32_t run_count;
  uint32_t lane_count;
  bool portable;  // products are rounded before they are added, on every instruction set
};
using JointTransposedKernel = void(const JointTransposedArgs& args);

/// The transposed skinning of positions with the same number of influences, at least one. With the gradient g
/// of a position, gradients[3 * position_indices[i] ...], its position p before skinning, and each of its
/// influences:
///
///     matrices[12 * joint + 4 * r ...] += weight * g[r] * (p, 1)      r = 0, 1, 2
///
/// and, unless out_positions is null,
///
///     out_positions[4 * i ...] = sum of weight * (linear part of the skin matrix)^T g
///
/// Reads one float past each gradient.
struct SkinTransposedArgs {
  const float* positions;  // x y z * of each
  const float* weights;    // `influences` for each position; joints likewise
  const uint16_t* joints;
  const uint16_t* position_indices;
  const float* gradients;
  const float* skins;  // skin matrices by joint, 64-byte aligned
  float* matrices;     // rows of x y z 1
  float* out_positions;
  uint32_t count;
  uint32_t influences;
};
using SkinTransposedKernel = void(const SkinTransposedArgs& args);

}  // namespace mien
