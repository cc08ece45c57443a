// SPDX-License-Identifier: MIT
// The joint stage: controls -> joint values (docs/rig-evaluation.md, 4.4 "Sums" and 4.5 "Order of
// the joint stage").
//
//     controls -> those that are not 0 -> sums, one accumulator tile at a time -> joint values
//     -> rotations -> twists and swings -> ML joints
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "runtime/base/bits.h"
#include "runtime/eval/changes.h"
#include "runtime/eval/instance_packet.h"
#include "runtime/eval/stages.h"
#include "simd/lanes.h"

namespace mien {
namespace {

/// Skips the part of a column that precedes the tile.
inline void skip(const ColumnPart& before, JointRun& run) {
  run.start.first_pair += 2 * before.pairs;
  run.start.pair_entry += before.pairs;
  run.start.first_single += before.singles;
  run.start.single_entry += before.singles;
  run.pair_count -= before.pairs;
  run.single_count -= before.singles;
}

/// Adds the columns from `first_column` to `end_column` whose controls are not 0, in order.
void add_columns(const Rig& rig, const Instance& instance, const JointTile& tile,
                 uint32_t first_column, size_t end_column) {
  constexpr uint32_t kMaxRuns = 256, kWords = 16;  // at a time
  const JointMatrix& joints = rig.joints;
  if (first_column >= end_column) return;
  JointRun runs[kMaxRuns];
  const bool fixed = joints.values.empty();
  const auto kernel = fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns;
  JointColumnsArgs args;
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.block_rows = joints.block_rows.data;
  args.runs = runs;
  args.sums = tile.sums - size_t{tile.first_block_row} * kJointBlockRows;
  args.portable = rig.portable;
  // Local copies, because the compiler must assume that writes to runs alias the rig.
  const JointColumn* const starts = joints.starts.data;
  const ColumnPart* const parts = joints.parts.data;
  const uint32_t* const column_of_control = joints.column_of_control.data;
  const size_t panel_ends = joints.panels.count;
  const uint32_t first_panel = tile.first_panel, end_panel = tile.end_panel;
  const uint32_t first_control = joints.columns[first_column];
  const uint32_t end_control = joints.columns[end_column - 1] + 1u;
  const float* const controls = instance.controls.data;
  JointRun* run = runs;
  const auto add_runs = [&] {
    args.run_count = static_cast<uint32_t>(run - runs);
    kernel(args);
    run = runs;
  };
  for (uint32_t first = first_control / 64 * 64; first < end_control; first += 64 * kWords) {
    uint64_t words[kWords];
    const uint32_t count = std::min(end_control - first, 64 * kWords);
    rig.kernels->nonzero({controls + first, words, count});
    if (first < first_control) words[0] &= ~uint64_t{0} << (first_control - first);
    for (uint32_t w = 0; w * 64 < count; ++w) {
      for (uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
        const uint32_t control = first + w * 64 + lowest_bit(bits);
        const uint32_t column = column_of_control[control];
        if (column == kNoColumn) continue;
        // The part of the column that lies in the panels of the tile.
        const ColumnPart* const part = parts + column * panel_ends;
        const ColumnPart end = part[end_panel];
        run->start = starts[column];
        run->pair_count = end.pairs;
        run->single_count = end.singles;
        run->input = controls[control];
        if (first_panel != 0) skip(part[first_panel], *run);
        if (++run == runs + kMaxRuns) add_runs();
      }
    }
  }
  add_runs();
}

/// Whether the strips, including their zeros, take less time than their columns: true from half of the
/// columns on.
bool sums_by_strips(const Rig& rig, const Instance& instance) {
  constexpr uint32_t kWords = 16;
  const JointMatrix& joints = rig.joints;
  if (joints.strips.empty()) return false;
  const uint32_t first_control = joints.columns[joints.first_strip_column];
  uint64_t mask = ~uint64_t{0} << first_control % 64;
  size_t active = 0;
  for (uint32_t first = first_control / 64 * 64; first < rig.control_count; first += 64 * kWords) {
    uint64_t words[kWords];
    const uint32_t count = std::min(rig.control_count - first, 64 * kWords);
    rig.kernels->nonzero({instance.controls.data + first, words, count});
    for (uint32_t w = 0; w * 64 < count; ++w, mask = ~uint64_t{0}) {
      active += bit_count(words[w] & mask);
    }
  }
  return 2 * active >= joints.columns.count - joints.first_strip_column;
}

/// Sums the strips that reach into the panels of the tile, after the columns that precede them. The tile
/// begins with block row 0, because a matrix with strips fits one tile.
void sum_by_strips(const Rig& rig, const Instance& instance, const JointTile& tile) {
  const JointMatrix& joints = rig.joints;
  const RowStrip* first = joints.strips.data;
  while (first[1].first_block_row <= joints.panels[tile.first_panel].first_block_row) ++first;
  const RowStrip* end = first;
  while (end->first_block_row < joints.panels[tile.end_panel].first_block_row) ++end;
  std::fill(tile.sums + size_t{first->first_block_row} * kJointBlockRows,
            tile.sums + size_t{end->first_block_row} * kJointBlockRows, 0.0f);
  add_columns(rig, instance, tile, 0, joints.first_strip_column);

  const bool fixed = joints.strip_values.empty();
  JointStripsArgs args;
  args.values =
      fixed ? static_cast<const void*>(joints.strip_fixed_values.data) : joints.strip_values.data;
  args.inputs = joints.strip_inputs.data;
  args.strips = first;
  args.controls = instance.controls.data;
  args.sums = tile.sums;
  args.strip_count = static_cast<uint32_t>(end - first);
  args.portable = rig.portable;
  (fixed ? rig.kernels->joint_strips_fixed : rig.kernels->joint_strips)(args);
}

/// Calls f(targets, their count, their rows as a constant) for the targets of a panel that a LOD writes; if
/// `panel` is the number of panels, for those of all panels.
template <class F>
void for_each_kind(const Rig& rig, uint32_t lod, uint32_t panel, F&& f) {
  const JointMatrix& joints = rig.joints;
  const uint16_t* at_lod =
      joints.targets_at_lod.data + size_t{panel} * kTargetKinds * rig.lod_count;
  const JointTarget* targets = joints.targets.data + joints.panels[panel].first_target;
  const auto each = [&](auto rows) {
    f(targets, at_lod[lod], rows);
    targets += at_lod[0];
    at_lod += rig.lod_count;
  };
  each(std::integral_constant<size_t, kTargetRows[0]>());
  each(std::integral_constant<size_t, kTargetRows[1]>());
  each(std::integral_constant<size_t, kTargetRows[2]>());
}

/// Whether the tile is written in the order of the joint values, which requires all panels of the LOD: in a
/// batch the joint values are not in the cache, and this order is the fastest.
bool in_order(const JointMatrix& joints, uint32_t lod, const JointTile& tile) {
  const bool whole = tile.first_panel == 0 && tile.end_panel == joints.panels_at_lod[lod];
  return whole && joints.fits_tile();
}

/// Writes targets of one group, or of all. (Arguments by value, because the compiler must assume that the
/// writes alias references, and would read those again each time.)
template <size_t kRows>
void write_targets(const JointTarget* targets, uint32_t count, const float* sums, float* out,
                   uint32_t only_group) {
  const JointTarget* const end = targets + count;
  if (only_group == kAllGroups) {
    for (; targets != end; ++targets) {
      memcpy(out + targets->output, sums + targets->packed_row, kRows * sizeof(float));
    }
    return;
  }
  for (; targets != end; ++targets) {
    if (targets->group != only_group) continue;
    memcpy(out + targets->output, sums + targets->packed_row, kRows * sizeof(float));
  }
}

/// Writes the rows of one group, or of all.
void write_tile(const Rig& rig, Instance& instance, uint32_t lod, const JointTile& tile,
                uint32_t only_group) {
  const JointMatrix& joints = rig.joints;
  float* out = instance.joints_and_angles.data;
  const auto write = [&](uint32_t panel, const float* sums) {
    for_each_kind(rig, lod, panel, [&](const JointTarget* targets, uint32_t count, auto rows) {
      write_targets<decltype(rows)::value>(targets, count, sums, out, only_group);
    });
  };
  if (in_order(joints, lod, tile)) return write(joints.panel_count(), tile.sums);
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
                 uint32_t first_column, uint32_t only_group, bool keep) {
  add_columns(rig, instance, tile, first_column, rig.joints.columns.count);
  const JointMatrix& joints = rig.joints;
  float* const sums = tile.of_panel(joints, tile.first_panel);
  float* const end = tile.of_panel(joints, tile.end_panel);
  const size_t first_row =
      size_t{joints.panels[tile.first_panel].first_block_row} * kJointBlockRows;
  if (keep) std::copy(sums, end, instance.changes->sums.data + first_row);
  const float* scales = joints.scales.empty() ? nullptr : joints.scales.data + first_row;
  rig.kernels->finish_sums(sums, scales, static_cast<size_t>(end - sums));
  write_tile(rig, instance, lod, tile, only_group);
}

void write_tile_together(const InstancePacket& packet, const JointTile& tile) {
  const JointMatrix& joints = packet.rig.joints;
  float* to[kBatchLanes];
  for (uint32_t k = 0; k < packet.count; ++k) to[k] = packet.instances[k]->joints_and_angles.data;
  const auto write = [&](uint32_t panel, size_t packed_row) {
    const float* const sums = tile.sums + packed_row * kBatchLanes;
    for_each_kind(packet.rig, packet.lod, panel,
                  [&](const JointTarget* targets, uint32_t count, auto rows) {
                    packet.rig.kernels->scatter_targets(
                        {sums, targets, to, count, static_cast<uint32_t>(rows()), packet.count});
                  });
  };
  if (in_order(joints, packet.lod, tile)) return write(joints.panel_count(), 0);
  for (uint32_t c = tile.first_panel; c < tile.end_panel; ++c) {
    write(c, size_t{joints.panels[c].first_block_row - tile.first_block_row} * kJointBlockRows);
  }
}

void evaluate_joint_rows(const Rig& rig, Instance& instance, uint32_t lod, Uses panels,
                         uint32_t only_group) {
  const JointMatrix& joints = rig.joints;
  const uint32_t panel_count = joints.panels_at_lod[lod];
  const auto wanted = [&](uint32_t panel) {
    return (panels >> panel_bit(joints, panel) & 1) != 0 &&
           (only_group == kAllGroups || holds_group(joints, panel, only_group));
  };
  const bool by_strips = sums_by_strips(rig, instance);
  // Each run of panels goes over all columns: a few extra panels cost less than another run.
  constexpr uint32_t kBridge = 4;
  // 32 KiB: with 8 KiB for the runs of columns, the largest stack use of evaluation.
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
    if (by_strips) {
      sum_by_strips(rig, instance, tile);
    } else {
      std::fill(tile.of_panel(joints, tile.first_panel), tile.of_panel(joints, c), 0.0f);
    }
    const auto columns = static_cast<uint32_t>(joints.columns.count);
    const bool keep = rig.changes && only_group == kAllGroups;
    finish_tile(rig, instance, lod, tile, by_strips ? columns : 0, only_group, keep);
  }
}

void begin_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  clear_ml_joints(rig, instance, lod);
}

void evaluate_stale_rows(const Rig& rig, Instance& instance, uint32_t lod) {
  // ML joints must not be added twice to the same rows. Where rows of several panels write the same
  // value, the last one has to write last.
  const bool all = !rig.ml.joints.empty() || rig.joints.contested;
  const Uses stale = rig.changes ? panels_to_sum(rig, instance) : instance.stale & kAllPanels;
  const Uses panels = all ? kAllPanels : stale;
  evaluate_joint_rows(rig, instance, lod, panels, kAllGroups);
  if (rig.changes) note_sums(rig, instance, panels);
}

void finish_joints(const InstancePacket& packet) {
  turn_joints(packet);
  twist_joints(packet);
  for (uint32_t i = 0; i < packet.count; ++i) {
    Instance& instance = *packet.instances[i];
    add_ml_joints(packet.rig, instance, packet.lod);
    instance.stale &= ~(Uses{kStageJoints} | kAllPanels);
  }
}

void finish_changed_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  turn_changed_joints(rig, instance, lod);
  Instance* const one = &instance;
  twist_joints(InstancePacket::of_one(rig, lod, &one));
  add_ml_joints(rig, instance, lod);
  instance.stale &= ~(Uses{kStageJoints} | kAllPanels);
}

void evaluate_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  begin_joints(rig, instance, lod);
  if (rig.changes && add_changed_columns(rig, instance, lod))
    return finish_changed_joints(rig, instance, lod);
  evaluate_stale_rows(rig, instance, lod);
  Instance* const one = &instance;
  finish_joints(InstancePacket::of_one(rig, lod, &one));
}

}  // namespace mien
