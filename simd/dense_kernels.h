// SPDX-License-Identifier: MIT
// Dense layers of neural networks, for one character or many.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// gather_inputs: inputs of a layer: to[i] = from[at[i]] for i < count; up to the next multiple of 16 may be
/// written.
using GatherInputsKernel = void(const float* from, const uint16_t* at, size_t count, float* to);

/// floats_from_halves: count is a multiple of 16, both are 64-byte aligned.
using FloatsFromHalvesKernel = void(const uint16_t* from, size_t count, float* to);

/// One dense layer of a neural network: outputs[r] = f(sum over c of values(r, c) * inputs[c] +
/// bias), in blocks of 16 rows. Within a block the 16 values of a column are adjacent:
///
///     values   block 0: c0 r0..r15 | c1 r0..r15 | ... ; block 1: ...
///
/// Even and odd columns are summed separately, then added: twice the number of sums hides the latency of
/// additions. Activation f: 0 itself, 1 max(0, v), 2 v or alpha * v below 0, 3 tanh, 4 1 / (1 + e^-v); the
/// errors of the last two are within 3e-7. Values that overflow saturate. Rows past row_count, up to the next
/// multiple of 16, may be written.
struct DenseLayerArgs {
  const void* values;   // floats or halves, 64-byte aligned
  const float* biases;  // one for each row, in whole blocks, 64-byte aligned
  const float* inputs;
  float* outputs;  // as biases
  float alpha;
  uint32_t column_count;
  uint32_t row_count;
  uint8_t function;
  bool halves;
  bool portable;  // products are rounded before they are added, on every instruction set
  /// Many inputs may be 0: they are found and skipped, which changes no bit of a result but the sign of a
  /// zero. Inputs are then 64-byte aligned and read in whole blocks.
  bool sparse;
};
using DenseLayerKernel = void(const DenseLayerArgs& args);

/// The same layer for many characters, one lane each, with the same bits:
///
///     inputs     [column][32]
///     outputs    [row][32]
///
/// For lanes k < lane_count; those up to the next multiple of batch_step are computed as well. Rows past
/// row_count, up to the next multiple of 16, may be written.
struct DenseBatchArgs {
  const float* values;  // as for dense_layer, but never halves
  const float* biases;  // as for dense_layer
  const float* inputs;  // 64-byte aligned, and so are the following
  float* outputs;
  float alpha;
  uint32_t column_count;
  uint32_t row_count;
  uint32_t lane_count;
  uint8_t function;
  bool portable;
};
using DenseBatchKernel = void(const DenseBatchArgs& args);

}  // namespace mien
