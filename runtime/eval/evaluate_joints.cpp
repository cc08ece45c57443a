// SPDX-License-Identifier: MIT
// Joint groups: controls -> joint values (docs/rig-evaluation.md, 4.4 "Sums").
//
//     controls  ->  those that are not zero  ->  sums, a tile of panels at a time  ->  joint values
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "runtime/base/bits.h"
#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

/// What a column has for a tile.
JointRun run_of(const JointMatrix& joints, const JointTile& tile, uint32_t column, float input) {
  const ColumnPart* parts = joints.parts.data + size_t{column} * joints.panels.count;
  const ColumnPart from = parts[tile.first_panel], to = parts[tile.end_panel];
  const uint32_t pairs = parts[joints.panel_count()].pairs;
  const uint32_t block = joints.first_block[column], entry = joints.first_entry[column];
  return {block + 2 * from.pairs,
          entry + from.pairs,
          static_cast<uint32_t>(to.pairs - from.pairs),
          block + 2 * pairs + from.singles,
          entry + pairs + from.singles,
          static_cast<uint32_t>(to.singles - from.singles),
          input};
}

/// Adds the columns from `first_column` on whose controls are not 0, in order.
void add_columns(const Rig& rig, const Instance& instance, const JointTile& tile,
                 uint32_t first_column) {
  constexpr uint32_t kMaxRuns = 256, kWords = 16;  // at a time
  const JointMatrix& joints = rig.joints;
  if (first_column >= joints.columns.count) return;
  JointRun runs[kMaxRuns];
  const bool fixed = joints.values.empty();
  const auto kernel = fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns;
  JointColumnsArgs args;
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.block_rows = joints.block_rows.data;
  args.runs = runs;
  args.sums = tile.sums - size_t{tile.first_block_row} * kJointBlockRows;
  args.run_count = 0;
  args.portable = rig.portable;
  const uint32_t first_control = joints.columns[first_column];
  const float* controls = instance.controls.data;
  for (uint32_t first = first_control / 64 * 64; first < rig.control_count; first += 64 * kWords) {
    uint64_t words[kWords];
    const uint32_t count = std::min(rig.control_count - first, 64 * kWords);
    rig.kernels->nonzero({controls + first, words, count});
    if (first < first_control) words[0] &= ~uint64_t{0} << (first_control - first);
    for (uint32_t w = 0; w * 64 < count; ++w) {
      for (uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
        const uint32_t control = first + w * 64 + lowest_bit(bits);
        const uint32_t column = joints.column_of_control[control];
        if (column == kNoColumn) continue;
        runs[args.run_count++] = run_of(joints, tile, column, controls[control]);
        if (args.run_count < kMaxRuns) continue;
        kernel(args);
        args.run_count = 0;
      }
    }
  }
  kernel(args);
}

/// Calls f(target, number of rows as a constant) for what a LOD writes of a panel, or, with the
/// number behind the last panel, of all of them.
template <class F>
void for_each_target(const Rig& rig, uint32_t lod, uint32_t panel, F&& f) {
  const JointMatrix& joints = rig.joints;
  const uint16_t* at_lod =
      joints.targets_at_lod.data + size_t{panel} * kTargetKinds * rig.lod_count;
  const JointTarget* targets = joints.targets.data + joints.panels[panel].first_target;
  const auto each = [&](auto rows) {
    for (uint32_t t = 0; t < at_lod[lod]; ++t) f(targets[t], rows);
    targets += at_lod[0];
    at_lod += rig.lod_count;
  };
  each(std::integral_constant<size_t, kTargetRows[0]>());
  each(std::integral_constant<size_t, kTargetRows[1]>());
  each(std::integral_constant<size_t, kTargetRows[2]>());
}

/// Rows of one group only, or of all. What a LOD has as a whole is written in order of the joint
/// values, which memory likes best: in a packet they are far away.
void write_tile(const Rig& rig, Instance& instance, uint32_t lod, const JointTile& tile,
                uint32_t only_group) {
  const JointMatrix& joints = rig.joints;
  float* out = instance.joints_and_angles.data;
  const auto write = [&](uint32_t panel, const float* sums) {
    const auto copy = [out, sums](const JointTarget& target, auto rows) {
      memcpy(out + target.output, sums + target.slot, rows() * sizeof(float));
    };
    if (only_group == kAllGroups) return for_each_target(rig, lod, panel, copy);
    for_each_target(rig, lod, panel, [&](const JointTarget& target, auto rows) {
      if (target.group == only_group) copy(target, rows);
    });
  };
  const bool whole = tile.first_panel == 0 && tile.end_panel == joints.panels_at_lod[lod];
  if (whole && joints.fits_tile()) return write(joints.panel_count(), tile.sums);
  for (uint32_t c = tile.first_panel; c < tile.end_panel; ++c) {
    write(c, tile.of_panel(joints, c));
  }
}

bool holds_group(const JointMatrix& joints, uint32_t panel, uint32_t group) {
  const uint32_t end = joints.panels[panel + 1].first_target;
  for (uint32_t t = joints.panels[panel].first_target; t < end; ++t) {
    if (joints.targets[t].group == group) return true;
  }
  return false;
}

}  // namespace

void finish_tile(const Rig& rig, Instance& instance, uint32_t lod, const JointTile& tile,
                 uint32_t first_column, uint32_t only_group) {
  add_columns(rig, instance, tile, first_column);
  const JointMatrix& joints = rig.joints;
  float* const sums = tile.of_panel(joints, tile.first_panel);
  float* const end = tile.of_panel(joints, tile.end_panel);
  const size_t first_slot =
      size_t{joints.panels[tile.first_panel].first_block_row} * kJointBlockRows;
  const float* scales = joints.scales.empty() ? nullptr : joints.scales.data + first_slot;
  rig.kernels->finish_sums(sums, scales, static_cast<size_t>(end - sums));
  write_tile(rig, instance, lod, tile, only_group);
}

void evaluate_joint_rows(const Rig& rig, Instance& instance, uint32_t lod, uint64_t marks,
                         uint32_t only_group) {
  const JointMatrix& joints = rig.joints;
  const uint32_t panel_count = joints.panels_at_lod[lod];
  const auto wanted = [&](uint32_t panel) {
    return (marks >> (panel >> joints.panel_shift) & 1) != 0 &&
           (only_group == kAllGroups || holds_group(joints, panel, only_group));
  };
  // To begin anew with every column costs more than some panels that need not be.
  constexpr uint32_t kBridge = 4;
  // The most stack that evaluation takes, beside 8 KiB for the columns.
  alignas(kBlockAlignment) float sums[kMaxTileBlockRows * kJointBlockRows];
  JointTile tile = {0, 0, 0, sums};
  for (uint32_t c = 0; c < panel_count;) {
    if (!joints.in_tile(tile.first_block_row, c))
      tile.first_block_row = joints.panels[c].first_block_row;
    if (!wanted(c)) {
      ++c;
      continue;
    }
    tile.first_panel = c++;
    for (uint32_t n = c; n < panel_count && n < c + kBridge; ++n) {
      if (!joints.in_tile(tile.first_block_row, n)) break;
      if (wanted(n)) c = n + 1;
    }
    tile.end_panel = c;
    std::fill(tile.of_panel(joints, tile.first_panel), tile.of_panel(joints, c), 0.0f);
    finish_tile(rig, instance, lod, tile, 0, only_group);
  }
}

}  // namespace mien
