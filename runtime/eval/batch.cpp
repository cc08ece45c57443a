// SPDX-License-Identifier: MIT
#include "runtime/eval/batch.h"

#include <algorithm>
#include <cstring>

#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

// Making, measuring -------------------------------------------------------------------------------

uint32_t block_row_count(const JointMatrix& joints) {
  return joints.panels[joints.panel_count()].first_block_row;
}

/// Packets that `capacity` instances fall into at worst: any LOD may leave one that is not full.
size_t max_packets(const Rig& rig, uint32_t capacity) {
  return std::min<size_t>(capacity, size_t{capacity} / kBatchLanes + rig.lod_count);
}

void place_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, Placer& placer, Batch& batch) {
  const JointMatrix& joints = rig.joints;
  size_t block_count = kBatchAhead;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    block_count += joints.blocks_before(k, joints.panel_count());
  }
  placer.array<Batch>(1);
  batch.starts = placer.array<uint32_t>(size_t{block_row_count(joints)} + 1);
  batch.middles = placer.array<uint32_t>(block_row_count(joints));
  batch.blocks = placer.array<BatchBlock>(block_count);
  batch.order = placer.array<Instance*>(capacity);
  batch.lods = placer.array<uint32_t>(capacity);
  batch.first_of_packet = placer.array<uint32_t>(max_packets(rig, capacity) + 1);
  batch.tasks = placer.array<PacketScratch>(std::min<size_t>(tasks, max_packets(rig, capacity)));
  const size_t tile_block_rows = std::min(block_row_count(joints), kMaxTileBlockRows);
  for (size_t i = 0; i < batch.tasks.count; ++i) {
    PacketScratch scratch;
    scratch.controls =
        placer.array<float>(size_t{rig.control_count} * kBatchLanes, kBlockAlignment);
    scratch.changed = placer.array<uint32_t>(rig.psds.outputs.count);
    scratch.users = placer.array<uint8_t>(joints.columns.count);
    scratch.sums =
        placer.array<float>(tile_block_rows * kJointBlockRows * kBatchLanes, kBlockAlignment);
    scratch.ends = placer.array<uint32_t>(block_row_count(joints));
    scratch.blocks = placer.array<BatchBlock>(block_count);
    if (!placer.measuring()) batch.tasks[i] = scratch;
  }
}

/// All blocks by block row; of one block in order of their columns.
void list_blocks(const JointMatrix& joints, Batch& batch) {
  const uint32_t block_rows = block_row_count(joints), panels = joints.panel_count();
  uint32_t* starts = batch.starts.data;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    joints.for_each_block(k, panels,
                          [&](uint32_t, uint32_t block_row) { ++starts[block_row + 1]; });
  }
  for (uint32_t b = 0; b < block_rows; ++b) starts[b + 1] += starts[b];
  // Filling moves each start to that of the next block row: back again afterwards.
  for (size_t k = 0; k < joints.columns.count; ++k) {
    const uint32_t control = joints.columns[k];
    if (control < batch.rig->raw_count) {
      ++batch.raw_columns;
    } else if (k == batch.raw_columns) {
      std::copy(starts, starts + block_rows, batch.middles.data);
    }
    joints.for_each_block(k, panels, [&](uint32_t block, uint32_t block_row) {
      batch.blocks[starts[block_row]++] = {block, control};
    });
  }
  if (batch.raw_columns == joints.columns.count) {
    std::copy(starts, starts + block_rows, batch.middles.data);
  }
  for (uint32_t b = block_rows; b > 0; --b) starts[b] = starts[b - 1];
  starts[0] = 0;
}

// A packet
// -----------------------------------------------------------------------------------------

/// Up to 32 instances at one LOD.
struct InstancePacket {
  const Batch& batch;
  const Rig& rig;
  const PacketScratch& scratch;
  Instance* const* instances;
  uint32_t count;
  uint32_t lod;
};

/// Controls side by side, 0 in the lanes of nobody.
void gather_controls(const InstancePacket& packet) {
  const float* from[kBatchLanes];
  for (uint32_t i = 0; i < packet.count; ++i) from[i] = packet.instances[i]->controls.data;
  float* lanes = packet.scratch.controls.data;
  for (size_t c = 0; c < packet.rig.control_count; ++c, lanes += kBatchLanes) {
    for (uint32_t i = 0; i < packet.count; ++i) lanes[i] = from[i][c];
    for (uint32_t i = packet.count; i < kBatchLanes; ++i) lanes[i] = 0.0f;
  }
}

/// As evaluate_psds() does for one.
void evaluate_psds(const InstancePacket& packet) {
  const PsdTable& psds = packet.rig.psds;
  const uint32_t count = packet.rig.psd_count ? psds.count_at_lod[packet.lod] : 0;
  uint32_t* changed = packet.scratch.changed.data;
  packet.rig.kernels->psd_batch({psds.outputs.data, psds.weights.data, psds.first_input.data,
                                 psds.inputs.data, packet.scratch.controls.data, changed, count});
  uint64_t marks[kBatchLanes] = {};
  const uint32_t all = ~uint32_t{0} >> (kBatchLanes - packet.count);
  uint32_t any = 0;
  for (uint32_t e = 0; e < count; ++e) {
    const size_t output = psds.outputs[e];
    const float* lanes = packet.scratch.controls.data + output * kBatchLanes;
    any |= changed[e];
    for (uint32_t i = 0, bits = changed[e] & all; bits != 0; ++i, bits >>= 1) {
      if ((bits & 1) == 0) continue;
      packet.instances[i]->controls[output] = lanes[i];
      marks[i] |= packet.rig.joints.control_panels[output];
    }
  }
  for (uint32_t i = 0; i < packet.count; ++i) {
    note_changed_psds(*packet.instances[i], marks[i], any >> i & 1);
  }
}

/// Lanes that are not zero.
uint32_t count_users(const float* lanes) {
  uint32_t bits[kBatchLanes], users = 0;
  memcpy(bits, lanes, sizeof(bits));
  for (uint32_t i = 0; i < kBatchLanes; ++i) users += bits[i] << 1 != 0;
  return users;
}

/// The columns before `column_end` are summed for all at once: none, those of raw controls, or all.
/// Those that somebody uses have `blocks` of the `all` blocks there are.
struct SharedColumns {
  uint32_t column_end = 0;
  size_t blocks = 0, all = 0;
};

/// SharedColumns a block costs a place in a list, and all lanes whoever uses it; apart it is
/// fetched by everybody who uses it. Columns stay in order, so the ways part once: where controls
/// that many move end, and correctives begin that few reach. Fifths of a cycle, as measured on a
/// production head.
SharedColumns find_shared_columns(const InstancePacket& packet) {
  constexpr int64_t kListed = 12, kPass = 45, kFetched = 12;
  const JointMatrix& joints = packet.rig.joints;
  const uint32_t panels = joints.panels_at_lod[packet.lod];
  const uint32_t step = packet.rig.kernels->batch_step;
  const int64_t passes = (packet.count + step - 1) / step;
  SharedColumns together, best;
  int64_t saved = -kPass * passes * joints.panels[panels].first_block_row, most = 0;
  for (uint32_t k = 0; k < joints.columns.count;) {
    const float* lanes = packet.scratch.controls.data + size_t{joints.columns[k]} * kBatchLanes;
    const int64_t users = count_users(lanes);
    packet.scratch.users[k] = static_cast<uint8_t>(users);
    const uint32_t blocks = joints.blocks_before(k, panels);
    together.column_end = ++k;
    together.all += blocks;
    if (users != 0) {
      together.blocks += blocks;
      saved += blocks * (users * kFetched - kListed - kPass * passes);
    }
    if (k != packet.batch.raw_columns && k != joints.columns.count) continue;
    if (saved <= most) continue;
    most = saved;
    best = together;
  }
  return best;
}

/// Where the blocks of each block row end that are summed together.
void list_shared_columns(const InstancePacket& packet, const SharedColumns& together) {
  const JointMatrix& joints = packet.rig.joints;
  const uint32_t panels = joints.panels_at_lod[packet.lod];
  const Batch& batch = packet.batch;
  uint32_t* ends = packet.scratch.ends.data;
  std::copy(batch.starts.data, batch.starts.data + block_row_count(joints), ends);
  BatchBlock* blocks = packet.scratch.blocks.data;
  for (uint32_t k = 0; k < together.column_end; ++k) {
    if (packet.scratch.users[k] == 0) continue;
    const uint32_t control = joints.columns[k];
    joints.for_each_block(k, panels, [&](uint32_t block, uint32_t block_row) {
      blocks[ends[block_row]++] = {block, control};
    });
  }
}

void evaluate_rows(const InstancePacket& packet, const SharedColumns& together) {
  const JointMatrix& joints = packet.rig.joints;
  const uint32_t panel_end = joints.panels_at_lod[packet.lod];
  // Blocks that nobody uses are summed as well, unless a list without them is shorter by much.
  const bool listed = together.blocks < together.all / 2;
  if (listed) list_shared_columns(packet, together);
  const BatchBlock* blocks = listed ? packet.scratch.blocks.data : packet.batch.blocks.data;
  const uint32_t* ends = packet.batch.starts.data + 1;
  if (together.column_end == packet.batch.raw_columns) ends = packet.batch.middles.data;
  if (listed) ends = packet.scratch.ends.data;

  const bool fixed = joints.values.empty();
  const auto sum_block_row =
      fixed ? packet.rig.kernels->joint_batch_fixed : packet.rig.kernels->joint_batch;
  JointBatchArgs args;
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.inputs = packet.scratch.controls.data;
  args.lane_count = packet.count;
  args.portable = packet.rig.portable;
  for (uint32_t c = 0; c < panel_end;) {
    const uint32_t tile_end = joints.tile_end(c);
    const uint32_t first = joints.panels[c].first_block_row;
    JointTile tile = {first, c, std::min(tile_end, panel_end), nullptr};
    c = tile.end_panel;
    const uint32_t end = joints.panels[c].first_block_row;
    args.sums = packet.scratch.sums.data;
    args.stride = size_t{joints.panels[tile_end].first_block_row - first} * kJointBlockRows;
    for (uint32_t b = first; b < end; ++b) {
      const uint32_t start = packet.batch.starts[b];
      args.blocks = blocks + start;
      args.block_count = ends[b] - start;
      sum_block_row(args);
      args.sums += kJointBlockRows;
    }
    for (uint32_t i = 0; i < packet.count; ++i) {
      tile.sums = packet.scratch.sums.data + i * args.stride;
      finish_tile(packet.rig, *packet.instances[i], packet.lod, tile, together.column_end,
                  kAllGroups);
    }
  }
}

void evaluate_packet(const InstancePacket& packet, uint32_t stages) {
  const auto each = [](const InstancePacket& those, auto&& f) {
    for (uint32_t i = 0; i < those.count; ++i) f(*those.instances[i]);
  };
  each(packet, [&](Instance& instance) {
    begin_evaluation(packet.rig, instance, packet.lod);
    evaluate_stages(packet.rig, instance, packet.lod, stages & (kStageMl | kStageRbf));
  });

  // Those that do not change have nothing to do with the others. Whoever is to have new correctives
  // may turn out to need new joints.
  Instance* changed[kBatchLanes];
  InstancePacket those = {packet.batch, packet.rig, packet.scratch, changed, 0, packet.lod};
  each(packet, [&](Instance& instance) {
    const bool stale = (instance.stale_stages & (kStagePsd | kStageJoints)) != 0;
    if (stale && (stages & kStageJoints)) changed[those.count++] = &instance;
  });
  if (those.count > 1) {
    gather_controls(those);
    if (stages & kStagePsd) evaluate_psds(those);
    const SharedColumns together = find_shared_columns(those);
    if (together.column_end != 0) {
      each(those, [&](Instance& i) { begin_joints(packet.rig, i, packet.lod); });
      evaluate_rows(those, together);
      each(those, [&](Instance& i) { finish_joints(packet.rig, i, packet.lod); });
    }
  }
  each(packet, [&](Instance& i) { evaluate_stages(packet.rig, i, packet.lod, stages); });
}

}  // namespace

// Batches -----------------------------------------------------------------------------------------

size_t batch_size(const Rig& rig, uint32_t capacity, uint32_t tasks) {
  Batch batch;
  Placer placer(nullptr);
  place_batch(rig, capacity, tasks, placer, batch);
  return placer.size();
}

Batch* create_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, const Allocator& allocator) {
  const size_t size = batch_size(rig, capacity, tasks);
  void* block = allocator.get(size, kBlockAlignment);
  if (!block) return nullptr;
  Batch placed;
  Placer placer(block);
  place_batch(rig, capacity, tasks, placer, placed);
  Batch* batch = new (block) Batch(placed);
  batch->capacity = capacity;
  batch->rig = &rig;
  batch->allocator = allocator;
  batch->block_size = size;
  rig.owners.fetch_add(1, std::memory_order_relaxed);

  list_blocks(rig.joints, *batch);
  return batch;
}

void destroy_batch(Batch* batch) {
  const Rig* rig = batch->rig;
  const Allocator allocator = batch->allocator;
  const size_t size = batch->block_size;
  batch->tag = 0;
  allocator.put(batch, size, kBlockAlignment);
  release_rig(rig);
}

void evaluate_batch(Batch& batch, Instance* const* instances, const uint32_t* lods, uint32_t count,
                    uint32_t stages, const ParallelFor& parallel) {
  // By LOD, in the order given, in packets.
  uint32_t begin[kMaxLods + 1] = {};
  for (uint32_t i = 0; i < count; ++i) ++begin[lods[i] + 1];
  batch.packet_count = 0;
  for (uint32_t l = 0; l < batch.rig->lod_count; ++l) {
    const uint32_t of_lod = begin[l + 1];
    for (uint32_t i = 0; i < of_lod; i += kBatchLanes) {
      batch.first_of_packet[batch.packet_count++] = begin[l] + i;
    }
    begin[l + 1] += begin[l];
  }
  batch.first_of_packet[batch.packet_count] = count;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t at = begin[lods[i]]++;
    batch.order[at] = instances[i];
    batch.lods[at] = lods[i];
  }
  batch.stages = stages;
  batch.task_count = std::min(batch.packet_count, static_cast<uint32_t>(batch.tasks.count));

  // Each task takes every so manieth packet: nobody has to ask who is free.
  const auto task = [](void* context, uint32_t index) {
    const Batch& b = *static_cast<const Batch*>(context);
    for (uint32_t c = index; c < b.packet_count; c += b.task_count) {
      const uint32_t first = b.first_of_packet[c], end = b.first_of_packet[c + 1];
      evaluate_packet({b, *b.rig, b.tasks[index], b.order.data + first, end - first, b.lods[first]},
                      b.stages);
    }
  };
  run_tasks(parallel, batch.task_count, task, &batch);
}

}  // namespace mien
