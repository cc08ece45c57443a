// SPDX-License-Identifier: MIT
// The kernel table: one per instruction set, all with the same meaning. Arrays in, arrays out;
// nothing here knows of rigs or files. Declarations and plain structs only: this header is included
// by files compiled for different instruction sets.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace mien {

/// Numbers of MIEN_ISA_... in mien.h.
enum class Isa : uint32_t { kBest = 0, kScalar = 1, kSse2 = 2, kAvx2 = 3, kAvx512 = 4, kNeon = 5 };
constexpr uint32_t kIsaCount = 6;

/// Rows per block of a dense layer and of other arrays in lanes, the same for every instruction
/// set.
constexpr uint32_t kBlockRows = 16;

/// Rows per piece of a joint matrix.
constexpr uint32_t kPieceRows = 8;
/// Blocks are named by multiples of this, which are addresses with the least work.
constexpr uint32_t kBlockUnit = 4;

/// Columns of a joint matrix times their inputs, added to sums. A column is a run of pieces of 8
/// values, each of which belongs to a block of 8 sums:
///
///     values  piece 0: r0 ... r7 | piece 1: r0 ... r7 | ...      (aligned to the size of a piece)
///     blocks  where each piece is added; those of a column differ
///
/// For i in order, with k = columns[i], for p in order from first_pieces[k] + begins[k * stride] to
/// first_pieces[k] + ends[k * stride]:
///
///     sums[8 * (blocks[p] / kBlockUnit - first_block) + r] += values(p, r) * inputs[i]
struct JointColumnsArgs {
  const void* values;  // float, or int16_t
  const uint16_t* blocks;
  const uint32_t* first_pieces;
  const uint16_t* begins;
  const uint16_t* ends;
  const uint16_t* columns;
  const float* inputs;
  float* sums;  // 64-byte aligned
  size_t stride;
  uint32_t column_count;
  uint32_t first_block;
};

/// One dense layer of a neural network: outputs[r] = f(sum over c of values(r, c) * inputs[c] +
/// bias), in blocks of 16 rows. Within a block the 16 values of a column are adjacent:
///
///     values   block 0: c0 r0..r15 | c1 r0..r15 | ... ; block 1: ...
///
/// Activation f: 0 itself, 1 max(0, v), 2 v or
/// alpha * v below 0, 3 tanh, 4 1 / (1 + e^-v); tanh and the last are within 3e-7. What overflows
/// saturates.
struct DenseLayerArgs {
  const float* values;  // 64-byte aligned
  const float* biases;  // 16 * block_count, 64-byte aligned
  const float* inputs;
  float* outputs;  // 16 * block_count, 64-byte aligned
  float alpha;
  uint32_t column_count;
  uint32_t block_count;
  uint8_t function;
};

/// Joints represented by quaternions, in blocks of 16 joints, one lane each:
///
///     values   block 0: c0 x0..x15 y0..y15 z0..z15 w0..w15 | c1 ... ; block 1: ...
///
/// For each joint: the product, over the columns in order, of the quaternion of the column blended
/// with the identity by the column's control; later columns turn last. All w are >= 0. Writes
/// rotations[4 * 16 * b + 16 * k + j] for k = x, y, z, w.
struct JointTurnArgs {
  const float* values;
  const uint16_t* columns;
  const float* controls;
  float* rotations;
  uint32_t column_count;   // to evaluate
  uint32_t column_stride;  // columns stored per block
  uint32_t block_count;
};

/// Distances of an input to the poses of an RBF solver, and the weights that follow from them.
///
///     targets   [input][pose], pose_count a multiple of 16, 64-byte aligned
///
/// Distance: Euclidean, or the root of the summed squares of the angles between quaternions of four
/// inputs each. Weight of x = distance * scale, by function: 0, 1 exp(-x); 2, 3, 4 max(0, 1 - x^n)
/// with n = 1, 3, 5. What is not a number becomes 0. Not fused: every instruction set gives the
/// same bits.
struct RbfWeightArgs {
  const float* targets;
  const float* inputs;
  float* weights;
  uint32_t input_count;
  uint32_t pose_count;
  float scale;
  uint8_t function;
  bool angular;
};

struct KernelTable {
  Isa isa;
  const char* name;
  void (*joint_columns)(const JointColumnsArgs& args);        // of floats
  void (*joint_columns_fixed)(const JointColumnsArgs& args);  // of 16-bit integers
  /// sums[i] = sums[i] * scales[i] (unless scales is null), saturated; count is a multiple of 8.
  void (*finish_sums)(float* sums, const float* scales, size_t count);
  void (*dense_layer)(const DenseLayerArgs& args);
  void (*joint_turns)(const JointTurnArgs& args);
  void (*rbf_weights)(const RbfWeightArgs& args);
};

/// The table of an instruction set; null if this build or this CPU lacks it. kBest gives the best
/// present, and never null.
const KernelTable* kernels_for(Isa isa);

/// kernels_for(isa), but kBest looks at the environment variable MIEN_ISA first (empty counts as
/// unset). Null if the one asked for, by argument or by environment, is not to be had.
const KernelTable* choose_kernels(Isa isa);

/// "avx2" for Isa::kAvx2; "unknown" for numbers that are none.
const char* isa_name(Isa isa);

}  // namespace mien
