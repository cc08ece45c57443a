// SPDX-License-Identifier: MIT
// The joint matrix forward and transposed. It does not depend on values; columns whose control does not move
// are left out.
#include "runtime/derive/derive_stages.h"

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

/// Calls f(first run, run count, first column) for runs of the columns of the LOD's panels whose control
/// `wanted`.
template <class W, class F>
void for_each_runs(const Rig& rig, uint32_t lod, W&& wanted, F&& f) {
  const JointMatrix& joints = rig.joints;
  JointRun runs[kMaxRuns];
  uint32_t columns[kMaxRuns], count = 0;
  for (uint32_t c = 0; c < joints.columns.count; ++c) {
    const ColumnPart& part = joints.part(c, joints.panels_at_lod[lod]);
    const float input = wanted(c);
    if (input == 0.0f || (part.pairs | part.singles) == 0) continue;
    runs[count] = {joints.starts[c], part.pairs, part.singles, input};
    columns[count++] = c;
    if (count == kMaxRuns) {
      f(runs, count, columns);
      count = 0;
    }
  }
  if (count != 0) f(runs, count, columns);
}

const void* values_of(const JointMatrix& joints) {
  return joints.values.empty() ? static_cast<const void*>(joints.fixed_values.data)
                               : joints.values.data;
}

uint32_t block_rows_at(const Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  return joints.panels[joints.panels_at_lod[d.lod]].first_block_row;
}

/// Packed rows = columns times one direction of the controls.
void sum_columns(Derivatives& d, const float* controls) {
  const Rig& rig = *d.rig;
  const JointMatrix& joints = rig.joints;
  const size_t rows = size_t{block_rows_at(d)} * kJointBlockRows;
  std::fill(d.packed_rows.data, d.packed_rows.data + rows, 0.0f);
  const bool fixed = joints.values.empty();
  JointColumnsArgs args;
  args.values = values_of(joints);
  args.block_rows = joints.block_rows.data;
  args.sums = d.packed_rows.data;
  args.portable = rig.portable;
  for_each_runs(
      rig, d.lod, [&](uint32_t c) { return controls[joints.columns[c]]; },
      [&](const JointRun* runs, uint32_t count, const uint32_t*) {
        args.runs = runs;
        args.run_count = count;
        (fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns)(args);
      });
  rig.kernels->finish_sums(d.packed_rows.data, joints.scales.empty() ? nullptr : joints.scales.data,
                           rows);
}

/// Gradients of joint values, lane `lane` of `lanes` -> of packed rows, in the unit of the stored values.
void take_rows(Derivatives& d, uint32_t lane, uint32_t lanes) {
  const JointMatrix& joints = d.rig->joints;
  const size_t rows = size_t{block_rows_at(d)} * kJointBlockRows;
  std::fill(d.packed_rows.data, d.packed_rows.data + rows, 0.0f);
  for (size_t value = 0; value < d.value_rows.count; ++value) {
    const uint32_t row = d.value_rows[value];
    if (row == kNoRow) continue;
    const float scale = joints.scales.empty() ? 1.0f : joints.scales[row];
    d.packed_rows[row] = d.joints[value * lanes + lane] * scale;
  }
}

/// Controls whose gradient matters: raw ones, and others that move with some control before them.
void mark_columns(Derivatives& d) {
  const JointMatrix& joints = d.rig->joints;
  for (size_t c = 0; c < joints.columns.count; ++c) {
    d.active_columns[c] = d.all_move || d.moving[joints.columns[c]];
  }
}

void sum_transposed(Derivatives& d, uint32_t lane, uint32_t lanes) {
  const Rig& rig = *d.rig;
  const JointMatrix& joints = rig.joints;
  const bool fixed = joints.values.empty();
  float sums[kMaxRuns];
  JointTransposedArgs args;
  args.values = values_of(joints);
  args.block_rows = joints.block_rows.data;
  args.rows = d.packed_rows.data;
  args.outputs = sums;
  args.portable = rig.portable;
  for_each_runs(
      rig, d.lod, [&](uint32_t c) { return d.active_columns[c] ? 1.0f : 0.0f; },
      [&](const JointRun* runs, uint32_t count, const uint32_t* columns) {
        args.runs = runs;
        args.run_count = count;
        (fixed ? rig.kernels->joint_transposed_fixed : rig.kernels->joint_transposed)(args);
        for (uint32_t i = 0; i < count; ++i) {
          d.controls[size_t{joints.columns[columns[i]]} * lanes + lane] += sums[i];
        }
      });
}

}  // namespace

void find_value_rows(const Rig& rig, uint32_t lod, const Span<uint32_t>& value_rows) {
  std::fill(value_rows.begin(), value_rows.end(), kNoRow);
  for_each_row(rig, lod,
               [&](size_t row, size_t value) { value_rows[value] = static_cast<uint32_t>(row); });
}

template <uint32_t L>
void push_joint_rows(Derivatives& d) {
  const Rig& rig = *d.rig;
  const size_t angles = rig.quaternion_outputs ? size_t{rig.joint_count} * 3 : 0;
  std::fill(d.joints.data, d.joints.data + (rig.joint_value_count() + angles) * L, 0.0f);
  // One direction after the other: a column of zeros is left out, which pays more than lanes do.
  for (uint32_t k = 0; k < d.lane_count; ++k) {
    for (size_t c = 0; c < d.column_lane.count; ++c) d.column_lane[c] = d.controls[c * L + k];
    sum_columns(d, d.column_lane.data);
    for (size_t value = 0; value < d.value_rows.count; ++value) {
      if (d.value_rows[value] == kNoRow) continue;
      d.joints[value * L + k] = d.packed_rows[d.value_rows[value]];
    }
  }
}

template <uint32_t L>
void pull_joint_rows(Derivatives& d) {
  mark_columns(d);
  for (uint32_t k = 0; k < d.lane_count; ++k) {
    take_rows(d, k, L);
    sum_transposed(d, k, L);
  }
}

template void push_joint_rows<1>(Derivatives&);
template void push_joint_rows<kBatchLanes>(Derivatives&);
template void pull_joint_rows<1>(Derivatives&);
template void pull_joint_rows<kBatchLanes>(Derivatives&);

}  // namespace mien
