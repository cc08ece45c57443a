// SPDX-License-Identifier: MIT
#include <cmath>

#include "runtime/base/bits.h"
#include "runtime/compile/joint_blocks.h"

namespace mien {
namespace {

/// std::nearbyint() without a call: numbers near 1.5 * 2^23 are whole, so adding it rounds.
float nearest_whole(float value) {
  constexpr float kRounder = 12582912.0f;
  return std::fabs(value) < 0x1p22f ? (value + kRounder) - kRounder : std::nearbyint(value);
}

int16_t add_fixed(int16_t to, float value, float scale) {
  if (!(scale > 0.0f)) return 0;
  const float steps = static_cast<float>(to) + nearest_whole(value / scale);
  return static_cast<int16_t>(steps >= 32767.0f ? 32767.0f
                                                : (steps > -32767.0f ? steps : -32767.0f));
}

/// Prefetches the next place of a column: there are too many columns for the processor to do it.
void expect(const void* to) {
#if defined(__GNUC__)
  __builtin_prefetch(to, 1);
#else
  (void)to;
#endif
}

/// Blocks of up to 64 columns, as all their rows would stand alone in their block row.
struct BlockTile {
  alignas(kBlockAlignment) float blocks[kWordBits * kJointBlockRows];

  void read(const KernelTable& kernels, const PlannedRows& rows, const FileRows& file,
            uint32_t from, uint32_t count) {
    static constexpr uint8_t kZeros[kWordBits * sizeof(float)] = {};
    BlockRowsArgs args;
    std::fill(args.rows, args.rows + kJointBlockRows, kZeros);
    for (uint32_t k = 0; k < file.count; ++k) {
      args.rows[rows.first_in_block + k] = file.value(k, from);
    }
    args.blocks = blocks;
    args.count = count;
    kernels.read_block_rows(args);
  }
};

/// Adds the rows to a block that others have begun.
void add_rows(const PlannedRows& rows, const float* from, float* block) {
  const uint32_t end = rows.first_in_block + rows.row_count;
  for (uint32_t r = rows.first_in_block; r < end; ++r) {
    // Both are finite, so the sum may be infinite, but not NaN.
    block[r] = std::clamp(block[r] + from[r], -kLargestFloat, kLargestFloat);
  }
}

void add_fixed_rows(const PlannedRows& rows, const float* from, const float* scales,
                    int16_t* block) {
  const uint32_t end = rows.first_in_block + rows.row_count;
  for (uint32_t r = rows.first_in_block; r < end; ++r) {
    block[r] = add_fixed(block[r], from[r], scales[r]);
  }
}

/// The first of the rows that is not zero reaches farthest.
void mark_reach(const PlannedRows& rows, const FileRows& file, uint32_t column,
                uint8_t& control_reach) {
  for (uint32_t k = 0; k < file.count && rows.reaches[k] > control_reach; ++k) {
    if (magnitude_bits(file.value(k, column)) != 0) control_reach = rows.reaches[k];
  }
}

/// Where a panel begins in the columns.
void fill_parts(uint32_t panel, const JointPlan& plan, JointMatrix& joints) {
  ColumnPart* part = joints.parts.data + panel;
  for (size_t k = 0; k < joints.columns.count; ++k, part += joints.panels.count) {
    const PlannedColumn& column = plan.columns[joints.columns[k]];
    *part = {static_cast<uint16_t>(column.entries[1] - joints.starts[k].pair_entry),
             static_cast<uint16_t>(column.entries[0] - joints.starts[k].single_entry)};
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
  // In names of their own: for all the compiler knows, what is written could lie in `plan`.
  PlannedColumn* const columns = plan.columns.data;
  uint32_t* const places = plan.places.data;
  uint16_t* const block_rows = joints.block_rows.data;
  const BlockHalves* const end = plan.halves.data + plan.first_halves[b / 2 + 1];
  for (const BlockHalves* at = plan.halves.data + plan.first_halves[b / 2]; at != end; ++at) {
    PlannedColumn& column = columns[at->control];
    const uint32_t pair = at->halves == kBothHalves, missing = at->halves == 2;
    block_rows[column.entries[pair]++] = static_cast<uint16_t>((b + missing) * kBlockRowUnit);
    const uint32_t place = column.blocks[pair] - missing;
    places[at->control] = place;
    column.blocks[pair] += 1 + pair;
    if (!zeros) continue;
    for (uint32_t half = 0; half < 2; ++half) {
      if (whole[half] || !(at->halves >> half & 1)) continue;
      float* const block = joints.values.data + size_t{place + half} * kJointBlockRows;
      std::fill(block, block + kJointBlockRows, 0.0f);
    }
  }
}

/// Calls put(place, block) for the blocks of some rows, whose first word in plan.blocks is `word`.
/// Returns that of the next rows.
template <class Put>
const uint64_t* read_blocks(const dna::DnaView& view, const JointPlan& plan,
                            const PlannedRows& rows, const uint64_t* word,
                            const Span<uint8_t>& reach, const KernelTable& kernels, Put&& put) {
  const dna::JointGroup& group = view.bhvr.joints.groups[rows.group];
  const dna::Array<uint16_t> inputs = group.input_indices;
  const FileRows file(group, rows);
  const uint32_t* const places = plan.places.data;
  const uint32_t half = rows.block_row % 2;
  const uint8_t farthest = rows.reach();
  BlockTile tile;
  for (uint32_t from = 0; from < inputs.count; from += kWordBits) {
    tile.read(kernels, rows, file, from, std::min(inputs.count - from, kWordBits));
    for (uint64_t bits = *word++; bits != 0; bits &= bits - 1) {
      const uint32_t c = lowest_bit(bits), control = inputs[from + c];
      if (farthest > reach[control]) mark_reach(rows, file, from + c, reach[control]);
      put(size_t{places[control] + half}, tile.blocks + size_t{c} * kJointBlockRows);
    }
  }
  return word;
}

const uint64_t* fill_rows(const dna::DnaView& view, const JointPlan& plan, const PlannedRows& rows,
                          const uint64_t* word, const Span<uint8_t>& reach, const Rig& rig) {
  const KernelTable& kernels = *rig.kernels;
  float* const values = rig.joints.values.data;
  if (rig.half_storage) {
    const float* scales = rig.joints.scales.data + size_t{rows.block_row} * kJointBlockRows;
    int16_t* const fixed = rig.joints.fixed_values.data;
    return read_blocks(view, plan, rows, word, reach, kernels,
                       [=, &rows](size_t place, const float* block) {
                         int16_t* const to = fixed + place * kJointBlockRows;
                         expect(to + 2 * kJointBlockRows);
                         add_fixed_rows(rows, block, scales, to);
                       });
  }
  if (!rows.whole) {
    return read_blocks(view, plan, rows, word, reach, kernels,
                       [=, &rows](size_t place, const float* block) {
                         add_rows(rows, block, values + place * kJointBlockRows);
                       });
  }
  return read_blocks(view, plan, rows, word, reach, kernels, [=](size_t place, const float* block) {
    float* const to = values + place * kJointBlockRows;
    expect(to + 2 * kJointBlockRows);
    memcpy(to, block, kJointBlockRows * sizeof(float));
  });
}

}  // namespace

void fill_joint_blocks(const dna::DnaView& view, const JointPlan& plan, Span<uint8_t> reach,
                       Rig& rig) {
  JointMatrix& joints = rig.joints;
  const uint64_t* word = plan.blocks.data;
  uint32_t panel = 0;
  for (uint32_t b = 0; b < plan.block_row_count(); b += 2) {
    if (joints.panels[panel].first_block_row == b) fill_parts(panel++, plan, joints);
    place_blocks(plan, b, joints);
    for (uint32_t i = plan.first_rows[b]; i < plan.first_rows[b + 2]; ++i) {
      word = fill_rows(view, plan, plan.rows[i], word, reach, rig);
    }
  }
  fill_parts(panel, plan, joints);
}

}  // namespace mien
