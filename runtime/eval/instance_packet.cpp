// SPDX-License-Identifier: MIT
#include "runtime/eval/instance_packet.h"

#include <algorithm>

#include "runtime/eval/changes.h"
#include "runtime/eval/stages.h"
#include "simd/lanes.h"

namespace mien {
namespace {

/// The number of lanes that are not zero.
uint32_t count_users(const float* lanes) {
  uint32_t users = 0;
  for (uint32_t i = 0; i < kBatchLanes; ++i) users += lanes[i] != 0.0f;
  return users;
}

/// The columns before `column_end` are summed for all instances at once: none, those of raw controls, or all.
/// Some instance uses `blocks` of their `all` blocks.
struct SharedColumns {
  uint32_t column_end = 0;
  size_t blocks = 0, all = 0;
};

/// Sharing a block costs an entry in a list, and a multiplication in all lanes, whether an instance uses it
/// or not. Otherwise each instance that uses it loads it. Sums run over the columns in order, so sharing can
/// stop at one place only: after the raw controls, which many instances use, and before the correctives,
/// which few use.
SharedColumns find_shared_columns(const InstancePacket& packet) {
  const JointMatrix& joints = packet.rig.joints;
  const uint32_t panels = joints.panels_at_lod[packet.lod];
  const uint32_t step = packet.rig.kernels->batch_step;
  const int64_t passes = (packet.count + step - 1) / step;
  SharedColumns shared, best;
  int64_t saved = -kPassCost * passes * joints.panels[panels].first_block_row, most = 0;
  for (uint32_t k = 0; k < joints.columns.count;) {
    const float* lanes = packet.scratch->controls.data + size_t{joints.columns[k]} * kBatchLanes;
    const int64_t users = count_users(lanes);
    packet.scratch->users[k] = static_cast<uint8_t>(users);
    const uint32_t blocks = joints.blocks_before(k, panels);
    shared.column_end = ++k;
    shared.all += blocks;
    if (users != 0) {
      shared.blocks += blocks;
      saved += blocks * (users * kFetchedCost - kListedCost - kPassCost * passes);
    }
    if (k != packet.tables->block_list.raw_columns && k != joints.columns.count) continue;
    if (saved <= most) continue;
    most = saved;
    best = shared;
  }
  return best;
}

/// Lists the blocks of shared columns that are used; fills `ends` and `blocks` of the scratch.
void list_shared_columns(const InstancePacket& packet, const SharedColumns& shared) {
  const JointMatrix& joints = packet.rig.joints;
  const uint32_t panels = joints.panels_at_lod[packet.lod];
  const Span<uint32_t>& starts = packet.tables->block_list.starts;
  uint32_t* ends = packet.scratch->ends.data;
  std::copy(starts.begin(), starts.end() - 1, ends);
  InputBlock* blocks = packet.scratch->blocks.data;
  for (uint32_t k = 0; k < shared.column_end; ++k) {
    if (packet.scratch->users[k] == 0) continue;
    const uint32_t control = joints.columns[k];
    joints.for_each_block(k, panels, [&](uint32_t block, uint32_t block_row) {
      blocks[ends[block_row]++] = {block, control};
    });
  }
}

/// Sums the shared columns for all instances, a tile at a time, and then adds the other columns, if any, for
/// each instance.
void evaluate_shared_rows(const InstancePacket& packet, const SharedColumns& shared) {
  const JointMatrix& joints = packet.rig.joints;
  const BlockList& list = packet.tables->block_list;
  const uint32_t panel_end = joints.panels_at_lod[packet.lod];
  // Unused blocks are summed as well, unless a list without them is much shorter.
  const bool listed = shared.blocks < shared.all / 2;
  if (listed) list_shared_columns(packet, shared);
  const InputBlock* blocks = listed ? packet.scratch->blocks.data : list.blocks.data;
  const uint32_t* ends = list.starts.data + 1;
  if (shared.column_end == list.raw_columns) ends = list.raw_ends.data;
  if (listed) ends = packet.scratch->ends.data;

  const bool fixed = joints.values.empty();
  const auto sum_block_row =
      fixed ? packet.rig.kernels->joint_batch_fixed : packet.rig.kernels->joint_batch;
  JointBatchArgs args = {};
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.inputs = packet.scratch->controls.data;
  args.lane_count = packet.count;
  args.portable = packet.rig.portable;
  args.finish = shared.column_end == joints.columns.count;
  const float* const scales = joints.scales.empty() ? nullptr : joints.scales.data;
  for (uint32_t c = 0; c < panel_end;) {
    const uint32_t tile_end = joints.tile_end(c);
    const uint32_t first = joints.panels[c].first_block_row;
    JointTile tile = {first, c, std::min(tile_end, panel_end), nullptr};
    c = tile.end_panel;
    const uint32_t end = joints.panels[c].first_block_row;
    args.sums = packet.scratch->sums.data;
    args.stride = size_t{joints.panels[tile_end].first_block_row - first} * kJointBlockRows;
    for (uint32_t b = first; b < end; ++b) {
      const uint32_t start = list.starts[b];
      args.blocks = blocks + start;
      args.block_count = ends[b] - start;
      if (scales) args.scales = scales + size_t{b} * kJointBlockRows;
      sum_block_row(args);
      args.sums += args.finish ? kJointBlockRows * kBatchLanes : kJointBlockRows;
    }
    if (args.finish) {
      tile.sums = packet.scratch->sums.data;
      write_tile_together(packet, tile);
      continue;
    }
    for (uint32_t i = 0; i < packet.count; ++i) {
      tile.sums = packet.scratch->sums.data + i * args.stride;
      finish_tile(packet.rig, *packet.instances[i], packet.lod, tile, shared.column_end, kAllGroups,
                  false);
    }
  }
}

}  // namespace

// Unused lanes are 0.
void gather_controls(const InstancePacket& packet, uint32_t first, uint32_t end) {
  const float* from[kBatchLanes];
  for (uint32_t i = 0; i < packet.count; ++i) from[i] = packet.instances[i]->controls.data + first;
  packet.rig.kernels->gather_lanes(from, packet.count, end - first,
                                   packet.scratch->controls.data + size_t{first} * kBatchLanes);
}

void evaluate_psds_together(const InstancePacket& packet) {
  const PsdTable& psds = packet.rig.psds;
  const uint32_t count = packet.rig.psd_count ? psds.count_at_lod[packet.lod] : 0;
  uint32_t* changed = packet.scratch->changed.data;
  packet.rig.kernels->psd_batch({psds.outputs.data, psds.weights.data, psds.first_input.data,
                                 psds.inputs.data, packet.scratch->controls.data, changed, count});
  Uses uses[kBatchLanes] = {};
  const uint32_t all = ~uint32_t{0} >> (kBatchLanes - packet.count);
  for (uint32_t e = 0; e < count; ++e) {
    const size_t output = psds.outputs[e];
    const float* lanes = packet.scratch->controls.data + output * kBatchLanes;
    for (uint32_t i = 0, bits = changed[e] & all; bits != 0; ++i, bits >>= 1) {
      if ((bits & 1) == 0) continue;
      packet.instances[i]->controls[output] = lanes[i];
      uses[i] |= packet.rig.control_uses[output];
    }
  }
  for (uint32_t i = 0; i < packet.count; ++i) {
    note_written_psds(*packet.instances[i], uses[i]);
    if (packet.rig.changes) mark_all_psds(packet.rig, *packet.instances[i]);
  }
}

void evaluate_joints_together(const InstancePacket& packet) {
  for (uint32_t i = 0; i < packet.count; ++i) {
    begin_joints(packet.rig, *packet.instances[i], packet.lod);
  }
  const SharedColumns shared = find_shared_columns(packet);
  if (shared.column_end != 0) {
    evaluate_shared_rows(packet, shared);
    for (uint32_t i = 0; i < packet.count; ++i) drop_sums(*packet.instances[i]);
  } else {
    for (uint32_t i = 0; i < packet.count; ++i) {
      evaluate_stale_rows(packet.rig, *packet.instances[i], packet.lod);
    }
  }
  finish_joints(packet);
}

}  // namespace mien
