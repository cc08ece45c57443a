// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "runtime/base/bits.h"
#include "runtime/load/compile/joint_blocks.h"
#include "simd/compile_kernels.h"
#include "simd/kernels.h"

namespace mien {
namespace {

/// Prefetches a place of a column: there are too many columns for the processor to do it.
void expect(const void* to) {
#if defined(__GNUC__)
  __builtin_prefetch(to, 1);
#else
  (void)to;
#endif
}

/// Up to 64 columns of some rows, as the rows would stand alone in their block row.
void read_columns(const KernelTable& kernels, const PlannedRows& rows, const FileRows& file,
                  uint32_t from, uint32_t count, float* const* blocks) {
  static constexpr uint8_t kZeros[kWordBits * sizeof(float)] = {};
  BlockRowsArgs args;
  std::fill(args.rows, args.rows + kJointBlockRows, kZeros);
  for (uint32_t k = 0; k < file.count; ++k)
    args.rows[rows.first_in_block + k] = file.value(k, from);
  args.blocks = blocks;
  args.count = count;
  kernels.read_block_rows(args);
}

/// Adds rows to a block that others have begun. Rows of others get 0, which leaves them as they are.
/// Through a copy, so that the compiler vectorizes.
void add_rows(const float* from, float* block) {
  float sums[kJointBlockRows];
  for (uint32_t r = 0; r < kJointBlockRows; ++r) {
    // Both are finite, so the sum may be infinite, but not NaN.
    const float sum = block[r] + from[r];
    const float least = sum > -kLargestFloat ? sum : -kLargestFloat;
    sums[r] = least < kLargestFloat ? least : kLargestFloat;
  }
  memcpy(block, sums, sizeof(sums));
}

void add_rows(const int16_t* from, int16_t* block) {
  int16_t sums[kJointBlockRows];
  for (uint32_t r = 0; r < kJointBlockRows; ++r) {
    sums[r] = static_cast<int16_t>(std::clamp(block[r] + from[r], -32767, 32767));
  }
  memcpy(block, sums, sizeof(sums));
}

/// Where a panel begins in the columns.
void fill_parts(uint32_t panel, const JointPlan& plan, JointMatrix& joints) {
  ColumnPart* part = joints.parts.data + panel;
  for (size_t k = 0; k < joints.columns.count; ++k, part += joints.panels.count) {
    const PlannedColumn& column = plan.columns[joints.columns[k]];
    *part = {static_cast<uint16_t>(column.next[1].entry - joints.starts[k].pair_entry),
             static_cast<uint16_t>(column.next[0].entry - joints.starts[k].single_entry)};
  }
}

/// Places for the blocks of block rows b and b + 1. Blocks that rows do not fill alone begin with
/// zeros.
void place_blocks(const JointPlan& plan, uint32_t b, JointMatrix& joints) {
  bool whole[] = {true, true};
  for (uint32_t i = plan.first_rows[b]; i < plan.first_rows[b + 2]; ++i) {
    const PlannedRows& rows = plan.rows[i];
    whole[rows.block_row % 2] = whole[rows.block_row % 2] && rows.whole;
  }
  const bool zeros = !joints.values.empty() && !(whole[0] && whole[1]);
  // Local copies, because the compiler must assume that the writes alias `plan`.
  PlannedColumn* const columns = plan.columns.data;
  uint32_t* const places = plan.places.data;
  uint16_t* const block_rows = joints.block_rows.data;
  float* const values = joints.values.data;
  const BlockHalves* const end = plan.halves.data + plan.first_halves[b / 2 + 1];
  for (const BlockHalves* at = plan.halves.data + plan.first_halves[b / 2]; at != end; ++at) {
    const size_t control = at->control, is_pair = at->is_pair;
    const uint32_t is_second = at->is_second;
    PlannedColumn::Next& next = columns[control].next[is_pair];
    const uint32_t entry = next.entry, block = next.block;
    next.entry = entry + 1;
    next.block = block + 1 + static_cast<uint32_t>(is_pair);
    block_rows[entry] = static_cast<uint16_t>((b + is_second) * kBlockRowUnit);
    places[control] = block - is_second;
    if (!zeros) continue;
    for (uint32_t half = is_second; half < is_second + 1 + is_pair; ++half) {
      if (whole[half]) continue;
      float* const zero = values + size_t{block - is_second + half} * kJointBlockRows;
      std::fill(zero, zero + kJointBlockRows, 0.0f);
    }
  }
}

/// Where the blocks of up to 64 columns go.
struct BlockPlaces {
  const uint16_t* inputs;
  const uint32_t* places;
  uint32_t half;

  uint32_t at(uint32_t c) const { return places[inputs[c]] + half; }
};

/// Reads the blocks of some rows, up to 64 columns at a time, to `blocks`; the first of their words in
/// plan.blocks is `word`. Returns that of the next rows.
/// Calls before(column count, bits, places), which may still change `blocks`, and after(bits, places),
/// with a bit for each column that has a block.
template <class Before, class After>
const uint64_t* read_blocks(const KernelTable& kernels, const JointPlan& plan,
                            const PlannedRows& rows, const FileRows& file, const uint64_t* word,
                            float* const* blocks, Before&& before, After&& after) {
  const Span<uint16_t> inputs = plan.groups[rows.group].inputs;
  const auto columns = static_cast<uint32_t>(inputs.count);
  for (uint32_t from = 0; from < columns; from += kWordBits) {
    const uint64_t bits = *word++;
    const BlockPlaces places = {inputs.data + from, plan.places.data, rows.block_row % 2};
    const uint32_t count = std::min(columns - from, kWordBits);
    before(count, bits, places);
    read_columns(kernels, rows, file, from, count, blocks);
    after(bits, places);
  }
  return word;
}

/// Rows that fill their block row alone: the kernel writes their blocks where they belong.
const uint64_t* move_rows(const KernelTable& kernels, const JointPlan& plan,
                          const PlannedRows& rows, const FileRows& file, const uint64_t* word,
                          float* values) {
  alignas(kBlockAlignment) float unused[kJointBlockRows];
  float* blocks[kWordBits];
  return read_blocks(
      kernels, plan, rows, file, word, blocks,
      [&](uint32_t count, uint64_t bits, const BlockPlaces& places) {
        std::fill(blocks, blocks + count, static_cast<float*>(unused));
        for (; bits != 0; bits &= bits - 1) {
          const uint32_t c = lowest_bit(bits);
          blocks[c] = values + size_t{places.at(c)} * kJointBlockRows;
          expect(blocks[c]);
        }
      },
      [](uint64_t, const BlockPlaces&) {});
}

/// Reads blocks to a tile and adds them to those of the rig, which others may have begun. Calls
/// change(tile) between the two.
template <class T, class Change>
const uint64_t* merge_rows(const KernelTable& kernels, const JointPlan& plan,
                           const PlannedRows& rows, const FileRows& file, const uint64_t* word,
                           T* values, Change&& change) {
  alignas(kBlockAlignment) float tile[kWordBits * kJointBlockRows] = {};
  float* blocks[kWordBits];
  for (uint32_t c = 0; c < kWordBits; ++c) blocks[c] = tile + size_t{c} * kJointBlockRows;
  return read_blocks(
      kernels, plan, rows, file, word, blocks, [](uint32_t, uint64_t, const BlockPlaces&) {},
      [&](uint64_t bits, const BlockPlaces& places) {
        const T* const from = change(tile);
        for (; bits != 0; bits &= bits - 1) {
          const uint32_t c = lowest_bit(bits);
          add_rows(from + size_t{c} * kJointBlockRows,
                   values + size_t{places.at(c)} * kJointBlockRows);
        }
      });
}

const uint64_t* fill_rows(const dna::DnaView& view, const JointPlan& plan, const PlannedRows& rows,
                          const uint64_t* word, const Rig& rig) {
  const FileRows file(view.bhvr.joints.groups[rows.group], rows);
  const KernelTable& kernels = *rig.kernels;
  const JointMatrix& joints = rig.joints;
  if (rig.half_storage) {
    const float* scales = joints.scales.data + size_t{rows.block_row} * kJointBlockRows;
    alignas(kBlockAlignment) int16_t fixed[kWordBits * kJointBlockRows];
    return merge_rows(kernels, plan, rows, file, word, joints.fixed_values.data,
                      [&](const float* tile) {
                        kernels.fix_blocks(tile, scales, kWordBits, fixed);
                        return fixed;
                      });
  }
  if (rows.whole) return move_rows(kernels, plan, rows, file, word, joints.values.data);
  return merge_rows(kernels, plan, rows, file, word, joints.values.data,
                    [](const float* tile) { return tile; });
}

}  // namespace

void fill_joint_blocks(const dna::DnaView& view, const JointPlan& plan, Rig& rig) {
  JointMatrix& joints = rig.joints;
  const uint64_t* word = plan.blocks.data;
  uint32_t panel = 0;
  for (uint32_t b = 0; b < plan.block_row_count(); b += 2) {
    if (joints.panels[panel].first_block_row == b) fill_parts(panel++, plan, joints);
    place_blocks(plan, b, joints);
    for (uint32_t i = plan.first_rows[b]; i < plan.first_rows[b + 2]; ++i) {
      word = fill_rows(view, plan, plan.rows[i], word, rig);
    }
  }
  fill_parts(panel, plan, joints);
}

}  // namespace mien
