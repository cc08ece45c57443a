// SPDX-License-Identifier: MIT
// The joint matrix forward and transposed. It does not depend on values; columns whose control does not move
// are left out.
#include "runtime/derive/derive_stages.h"
#include "simd/derivative_kernels.h"

namespace mien {
namespace {

constexpr uint32_t kMaxRuns = 256;  // at a time

/// The joint values of a LOD, in the order in which they are written: f(packed row, joint value).
template <class F>
void for_each_row(const Rig& rig, uint32_t lod, F&& f) {
  const JointMatrix& joints = rig.joints;
  for (uint32_t panel = 0; panel < joints.panels_at_lod[lod]; ++panel) {
    const uint16_t* at_lod =
        joints.targets_at_lod.data + size_t{panel} * kTargetKinds * rig.lod_count;
    const JointTarget* targets = joints.targets.data + joints.panels[panel].first_target;
    const size_t first_row = size_t{joints.panels[panel].first_block_row} * kJointBlockRows;
    for (const uint32_t rows : kTargetRows) {
      for (uint32_t i = 0; i < at_lod[lod]; ++i) {
        for (uint32_t r = 0; r < rows; ++r) {
          f(first_row + targets[i].packed_row + r, size_t{targets[i].output} + r);
        }
      }
      targets += at_lod[0];
      at_lod += rig.lod_count;
    }
  }
}

const void* values_of(const JointMatrix& joints) {
  return joints.values.empty() ? static_cast<const void*>(joints.fixed_values.data)
                               : joints.values.data;
}
const float* scales_of(const JointMatrix& joints) {
  return joints.scales.empty() ? nullptr : joints.scales.data;
}

uint32_t block_rows_at(const Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  return joints.panels[joints.panels_at_lod[d.lod]].first_block_row;
}

/// Runs of columns in the LOD's panels, passed on when there are kMaxRuns: f(runs, count, columns).
struct RunList {
  const JointMatrix& joints;
  uint32_t panels;
  uint32_t count = 0;
  JointRun runs[kMaxRuns];
  uint32_t columns[kMaxRuns];

  explicit RunList(const Derivatives& d)
      : joints(d.rig->joints), panels(joints.panels_at_lod[d.lod]) {}
  template <class F>
  void add(uint32_t column, float input, F&& f) {
    const ColumnPart& part = joints.part(column, panels);
    if ((part.pairs | part.singles) == 0) return;
    runs[count] = {joints.starts[column], part.pairs, part.singles, input};
    columns[count++] = column;
    if (count == kMaxRuns) pass(f);
  }
  template <class F>
  void pass(F&& f) {
    if (count != 0) f(runs, count, columns);
    count = 0;
  }
};

// Forward -----------------------------------------------------------------------------------------

/// Joint values of one direction: lane `lane` of `lanes`.
void push_one(Derivatives& d, uint32_t lane, uint32_t lanes) {
  const Rig& rig = *d.rig;
  const JointMatrix& joints = rig.joints;
  const size_t rows = size_t{block_rows_at(d)} * kJointBlockRows;
  float* const sums = d.packed_rows.data;
  std::fill(sums, sums + rows, 0.0f);
  JointColumnsArgs args;
  args.values = values_of(joints);
  args.block_rows = joints.block_rows.data;
  args.sums = sums;
  args.portable = rig.portable;
  const auto multiply = [&](const JointRun* runs, uint32_t count, const uint32_t*) {
    args.runs = runs;
    args.run_count = count;
    const bool fixed = joints.values.empty();
    (fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns)(args);
  };
  RunList list(d);
  for (uint32_t c = 0; c < joints.columns.count; ++c) {
    const float input = d.controls[size_t{joints.columns[c]} * lanes + lane];
    if (input != 0.0f) list.add(c, input, multiply);
  }
  list.pass(multiply);
  rig.kernels->finish_sums(sums, scales_of(joints), rows);
  for (size_t row = 0; row < rows; ++row) {
    if (d.row_values[row] != kNoValue)
      d.joints[size_t{d.row_values[row]} * lanes + lane] = sums[row];
  }
}

/// Finds which columns some direction moves. Returns whether it pays to multiply the directions together, which
/// reads a block once but multiplies it in all lanes.
bool find_moved_columns(Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  const uint32_t panels = joints.panels_at_lod[d.lod];
  const uint32_t step = d.rig->kernels->batch_step;
  const int64_t passes = (d.lane_count + step - 1) / step;
  int64_t saved = -kPassCost * passes * block_rows_at(d);
  for (uint32_t c = 0; c < joints.columns.count; ++c) {
    const float* lanes = d.controls.data + size_t{joints.columns[c]} * kBatchLanes;
    int32_t users = 0;  // lanes past lane_count are 0
    for (uint32_t k = 0; k < kBatchLanes; ++k) users += lanes[k] != 0.0f;
    const uint8_t is_moved = users != 0;
    d.blocks_listed &= d.moved_columns[c] == is_moved;
    d.moved_columns[c] = is_moved;
    if (!is_moved) continue;
    saved +=
        joints.blocks_before(c, panels) * (users * kFetchedCost - kListedCost - kPassCost * passes);
  }
  return saved > 0;
}

/// Lists the blocks of moved columns by block row. The list is kept: products often move the same controls.
void list_blocks(Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  const uint32_t panels = joints.panels_at_lod[d.lod];
  std::copy(d.block_starts.begin(), d.block_starts.end() - 1, d.block_ends.begin());
  for (uint32_t c = 0; c < joints.columns.count; ++c) {
    if (!d.moved_columns[c]) continue;
    const uint32_t control = joints.columns[c];
    joints.for_each_block(c, panels, [&](uint32_t block, uint32_t block_row) {
      d.blocks[d.block_ends[block_row]++] = {block, control};
    });
  }
  d.blocks_listed = true;
}

/// Joint values of all directions: block row by block row.
void push_together(Derivatives& d) {
  const Rig& rig = *d.rig;
  const JointMatrix& joints = rig.joints;
  if (!d.blocks_listed) list_blocks(d);
  alignas(64) float sums[kJointBlockRows * kBatchLanes] = {};
  JointBatchArgs args = {};
  args.values = values_of(joints);
  args.inputs = d.controls.data;
  args.sums = sums;
  args.finish = true;
  args.lane_count = d.lane_count;
  args.portable = rig.portable;
  const auto kernel =
      joints.values.empty() ? rig.kernels->joint_batch_fixed : rig.kernels->joint_batch;
  for (uint32_t b = 0; b < block_rows_at(d); ++b) {
    args.blocks = d.blocks.data + d.block_starts[b];
    args.block_count = d.block_ends[b] - d.block_starts[b];
    const size_t first_row = size_t{b} * kJointBlockRows;
    if (scales_of(joints)) args.scales = scales_of(joints) + first_row;
    kernel(args);
    for (size_t r = 0; r < kJointBlockRows; ++r) {
      const size_t value = d.row_values[first_row + r];
      if (value == kNoValue) continue;
      float* const to = d.joints.data + value * kBatchLanes;
      for (size_t k = 0; k < kBatchLanes; ++k) to[k] = sums[r * kBatchLanes + k];
    }
  }
}

// Reverse -----------------------------------------------------------------------------------------

/// Gradients of joint values -> of packed rows, in the unit of the stored values: `count` lanes from lane
/// `first` on, 1 or kTransposedLanes of them, in the layout of JointTransposedArgs.
template <uint32_t L>
void take_rows(const Derivatives& d, uint32_t first, uint32_t count) {
  constexpr size_t kRows = 2 * kJointBlockRows;
  const JointMatrix& joints = d.rig->joints;
  const size_t rows = align_up(size_t{block_rows_at(d)} * kJointBlockRows, kRows);
  const float* const scales = scales_of(joints);
  float* to = d.packed_rows.data;
  if (count == 1) {
    for (size_t row = 0; row < rows; ++row) {
      const size_t value = d.row_values[row];
      to[row] =
          value == kNoValue ? 0.0f : d.joints[value * L + first] * (scales ? scales[row] : 1.0f);
    }
    return;
  }
  float pair[kRows * kBatchLanes];
  for (size_t row = 0; row < rows; row += kRows, to += kRows * kTransposedLanes) {
    for (size_t r = 0; r < kRows; ++r) {
      const size_t value = d.row_values[row + r];
      float* const lanes = pair + r * kBatchLanes;
      if (value == kNoValue) {
        std::fill(lanes, lanes + kTransposedLanes, 0.0f);
        continue;
      }
      const float* const from = d.joints.data + value * L + first;
      const float scale = scales ? scales[row + r] : 1.0f;
      for (size_t k = 0; k < kTransposedLanes; ++k) lanes[k] = from[k] * scale;
    }
    float* of_lane[kTransposedLanes];
    for (size_t k = 0; k < kTransposedLanes; ++k) of_lane[k] = to + k * kRows;
    d.rig->kernels->scatter_lanes(pair, kRows, kTransposedLanes, of_lane, 0);
  }
}

/// Adds to the gradients of controls: raw ones, and others that move with some control before them.
template <uint32_t L>
void pull_some(Derivatives& d, uint32_t first, uint32_t count) {
  const Rig& rig = *d.rig;
  const JointMatrix& joints = rig.joints;
  take_rows<L>(d, first, count);
  float sums[kMaxRuns * kTransposedLanes];
  JointTransposedArgs args;
  args.values = values_of(joints);
  args.block_rows = joints.block_rows.data;
  args.rows = d.packed_rows.data;
  args.outputs = sums;
  args.lane_count = count;
  args.portable = rig.portable;
  const auto multiply = [&](const JointRun* runs, uint32_t run_count, const uint32_t* columns) {
    args.runs = runs;
    args.run_count = run_count;
    const bool fixed = joints.values.empty();
    (fixed ? rig.kernels->joint_transposed_fixed : rig.kernels->joint_transposed)(args);
    for (uint32_t i = 0; i < run_count; ++i) {
      float* const to = d.controls.data + size_t{joints.columns[columns[i]]} * L + first;
      for (uint32_t k = 0; k < count; ++k) to[k] += sums[i * count + k];
    }
  };
  RunList list(d);
  for (const uint32_t c : d.columns_by_length) {
    if (d.all_move || d.moving[joints.columns[c]]) list.add(c, 0.0f, multiply);
  }
  list.pass(multiply);
}

}  // namespace

void find_value_rows(const Rig& rig, uint32_t lod, const Span<uint32_t>& value_rows) {
  std::fill(value_rows.begin(), value_rows.end(), kNoRow);
  for_each_row(rig, lod,
               [&](size_t row, size_t value) { value_rows[value] = static_cast<uint32_t>(row); });
}

void find_joint_rows(Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  const uint32_t panels = joints.panels_at_lod[d.lod];
  find_value_rows(*d.rig, d.lod, d.value_rows);
  std::fill(d.row_values.begin(), d.row_values.end(), kNoValue);
  for (size_t value = 0; value < d.value_rows.count; ++value) {
    if (d.value_rows[value] == kNoRow) continue;
    d.row_values[d.value_rows[value]] = static_cast<uint32_t>(value);
  }
  for (uint32_t c = 0; c < d.columns_by_length.count; ++c) d.columns_by_length[c] = c;
  std::sort(d.columns_by_length.begin(), d.columns_by_length.end(), [&](uint32_t a, uint32_t b) {
    const ColumnPart &of_a = joints.part(a, panels), &of_b = joints.part(b, panels);
    // Single blocks that are not shared cost more than pairs.
    const uint32_t singles_of_a = of_a.singles / 4u, singles_of_b = of_b.singles / 4u;
    if (singles_of_a != singles_of_b) return singles_of_a < singles_of_b;
    if (of_a.pairs != of_b.pairs) return of_a.pairs < of_b.pairs;
    return of_a.singles != of_b.singles ? of_a.singles < of_b.singles : a < b;
  });
  d.blocks_listed = false;
}

void count_blocks(Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  std::fill(d.block_starts.begin(), d.block_starts.end(), 0u);
  for (uint32_t c = 0; c < joints.columns.count; ++c) {
    joints.for_each_block(c, joints.panel_count(),
                          [&](uint32_t, uint32_t block_row) { ++d.block_starts[block_row + 1]; });
  }
  for (size_t b = 1; b < d.block_starts.count; ++b) d.block_starts[b] += d.block_starts[b - 1];
}

template <uint32_t L>
void push_joint_rows(Derivatives& d) {
  const size_t values = d.value_rows.count;
  if constexpr (L == 1) {
    std::fill(d.joints.data, d.joints.data + values, 0.0f);
    push_one(d, 0, 1);
    return;
  }
  for (size_t value = 0; value < values; ++value) {
    size_t end = value;
    while (end < values && d.value_rows[end] == kNoRow) ++end;
    std::fill(d.joints.data + value * L, d.joints.data + end * L, 0.0f);
    value = end;
  }
  if (find_moved_columns(d)) {
    push_together(d);
  } else {
    for (uint32_t k = 0; k < d.lane_count; ++k) push_one(d, k, L);
  }
}

template <uint32_t L>
void pull_joint_rows(Derivatives& d) {
  for (uint32_t k = 0; k < d.lane_count;) {
    // Two gradients one by one are faster than kTransposedLanes.
    const uint32_t count = d.lane_count - k > 2 ? kTransposedLanes : 1;
    pull_some<L>(d, k, count);
    k += count;
  }
}

template void push_joint_rows<1>(Derivatives&);
template void push_joint_rows<kBatchLanes>(Derivatives&);
template void pull_joint_rows<1>(Derivatives&);
template void pull_joint_rows<kBatchLanes>(Derivatives&);

}  // namespace mien
