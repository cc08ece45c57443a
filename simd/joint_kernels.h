// SPDX-License-Identifier: MIT
// The joint matrix times controls: by columns, by strips of rows, or for many characters at once.
// Kernels ..._fixed take 16-bit integers, the others floats.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// Rows per block of a joint matrix.
constexpr uint32_t kJointBlockRows = 8;
/// Block rows are numbered in multiples of this, which makes addresses cheap to compute.
constexpr uint32_t kBlockRowUnit = 4;
/// Mask for the number of an even block row: the other bits of a pair's number are ignored.
constexpr uint32_t kPairBlockRows = 0x10000 - 2 * kBlockRowUnit;

/// Where a column of a joint matrix begins: in its blocks, and in `block_rows`.
struct JointColumn {
  uint32_t first_pair, pair_entry, first_single, single_entry;
};

/// The part of a column that is multiplied by its input.
struct JointRun {
  JointColumn start;
  uint32_t pair_count, single_count;
  float input;
};

/// Columns of a joint matrix times their inputs, added to sums. A column is a run of blocks of 8
/// values, each of which belongs to a block row of 8 sums. Blocks of block rows 2i and 2i + 1 are a
/// pair; pairs come first, then blocks without their other half:
///
///     values  pair 0: r0 ... r15 | pair 1: r0 ... r15 | ... | block: r0 ... r7 | ...
///     block rows  the even block row of each pair | the block row of each block
///
/// Pairs and single blocks are aligned to their size; no block row occurs twice in a run. For all runs in
/// order:
///
///     sums[8 * (block row / kBlockRowUnit) + r] += values(r) * input
///
/// Sums may begin with those of a later block row; `sums` is where block row 0 would be.
struct JointColumnsArgs {
  const void* values;  // float, or int16_t
  const uint16_t* block_rows;
  const JointRun* runs;
  float* sums;  // 64-byte aligned
  uint32_t run_count;
  bool portable;  // products are rounded before they are added, on every instruction set
};
using JointColumnsKernel = void(const JointColumnsArgs& args);

/// At most kMaxStripBlockRows neighboring block rows of a joint matrix, and the inputs for which one of them
/// has a block. A strip ends where the next one begins; the array has one more at the end.
struct RowStrip {
  uint32_t first_block_row;
  uint32_t first_block, first_input;
};
constexpr uint32_t kMaxStripBlockRows = 6;

/// Columns added as joint_columns does, strip by strip: for the inputs i of the strip that block row b belongs
/// to, in order,
///
///     sums[8 * b + r] += values(i, b, r) * controls[inputs[i]]
///
///     values  strip 0: | input 0: b0 r0 ... r7, b1 r0 ... r7, ... | input 1: ... | ... | strip 1: ...
///
/// Strips of an even number of block rows begin with an even block.
struct JointStripsArgs {
  const void* values;  // float, or int16_t; 64-byte aligned
  const uint16_t* inputs;
  const RowStrip* strips;  // one more at the end
  const float* controls;
  float* sums;  // where block row 0 is; 64-byte aligned
  uint32_t strip_count;
  bool portable;  // as above
};
using JointStripsKernel = void(const JointStripsArgs& args);

/// A block of a joint matrix, and the number of its input.
struct InputBlock {
  uint32_t block;
  uint32_t input;
};

/// The sums of one block for many characters: for lanes k < lane_count (those up to the next
/// multiple of batch_step are written as well), for i in order:
///
///     sums[k * stride + r] += values(blocks[i].block, r) * inputs[32 * blocks[i].input + k]
///
/// starting from 0, with the same operations and bits as joint_columns. Or, if nothing else is to be added,
/// finished as by finish_sums and in lanes: sums[32 * r + k].
struct JointBatchArgs {
  const void* values;  // as for joint_columns
  const InputBlock* blocks;
  const float* inputs;  // 64-byte aligned
  float* sums;          // 64-byte aligned
  size_t stride;        // a multiple of 8
  const float* scales;  // [row], or null
  bool finish;          // apply the scales, if any, and write lanes
  uint32_t block_count;
  uint32_t lane_count;
  bool portable;  // as above
};
using JointBatchKernel = void(const JointBatchArgs& args);
/// joint_batch reads the numbers of this many blocks past the last one, to prefetch them.
constexpr uint32_t kBatchAhead = 16;

/// finish_sums: sums[i] = sums[i] * scales[i] (unless scales is null), saturated, plus 0; count is a multiple
/// of 16, both are 64-byte aligned.
using FinishSumsKernel = void(float* sums, const float* scales, size_t count);

/// A run of rows: neighboring packed rows that are also neighbors in the output.
constexpr uint32_t kMaxRunRows = 8;

/// Some runs of rows, finished as by finish_sums and written: for each run i in `runs` and its rows r,
///
///     to[outputs[i] + r] = finished sums[rows[i] + r]
///
/// but without saturation. Runs of n rows are in words first_words[n - 1] to first_words[n] - 1.
struct FinishRunsArgs {
  const float* sums;            // [packed row], 64-byte aligned
  const float* scales;          // [packed row], 64-byte aligned, or null
  const uint64_t* runs;         // bit i % 64 of word i / 64
  const uint32_t* rows;         // [run] its first packed row
  const uint16_t* outputs;      // [run] where the first row goes
  const uint32_t* first_words;  // [kMaxRunRows + 1]
  float* to;
};
using FinishRunsKernel = void(const FinishRunsArgs& args);

/// Where to write the sums of six, three or one neighboring packed rows that are also neighbors in the
/// output.
struct JointTarget {
  uint16_t packed_row;
  uint16_t output;  // joint value
  uint16_t group;   // joint group that the rows are from
};

/// to[k][target.output + r] = sums[32 * (target.packed_row + r) + k] for all targets, r < rows and
/// k < lane_count. Where targets overlap, the last one counts.
struct ScatterTargetsArgs {
  const float* sums;  // 64-byte aligned
  const JointTarget* targets;
  float* const* to;
  uint32_t count;
  uint32_t rows;  // 6, 3 or 1
  uint32_t lane_count;
};
using ScatterTargetsKernel = void(const ScatterTargetsArgs& args);

}  // namespace mien
