// SPDX-License-Identifier: MIT
#include "runtime/eval/batch.h"

#include <algorithm>

#include "simd/lanes.h"
#include "simd/rbf_kernels.h"

namespace mien {
namespace {

uint32_t block_row_count(const JointMatrix& joints) {
  return joints.panels[joints.panel_count()].first_block_row;
}

/// Smaller packets gain little.
constexpr uint32_t kMinPacketLanes = 8;

/// Packets for instances of one LOD: as few as possible, but an equal share for each task.
uint32_t packets_for(uint32_t instances, uint32_t tasks) {
  const uint32_t fewest = (instances + kBatchLanes - 1) / kBatchLanes;
  const uint64_t even = (uint64_t{fewest} + tasks - 1) / tasks * tasks;
  const uint32_t most = std::max(fewest, instances / kMinPacketLanes);
  return static_cast<uint32_t>(std::min<uint64_t>(even, most));
}

/// The most packets that `capacity` instances make: packets_for() adds less than 1 to the instances of
/// each LOD / kBatchLanes, and then less than `tasks`; and never exceeds 1 + instances / kMinPacketLanes.
size_t max_packets(const Rig& rig, uint32_t capacity, uint32_t tasks) {
  const size_t by_tasks = capacity / kBatchLanes + size_t{rig.lod_count} * tasks;
  const size_t by_lanes = size_t{capacity} / kMinPacketLanes + rig.lod_count;
  return std::min({size_t{capacity}, by_tasks, by_lanes});
}

/// Inputs or padded outputs of the widest layer. (The scratch of an instance also has room for gathered
/// inputs that no layer takes, and may be much larger.)
size_t widest_layer(const Rig& rig) {
  size_t widest = 0;
  for (const NetworkLayer& layer : rig.ml.layers) {
    widest =
        std::max({widest, align_up(layer.output_count, kBlockLanes), size_t{layer.input_count}});
  }
  return widest;
}

void place_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, Placer& placer, Batch& batch) {
  const JointMatrix& joints = rig.joints;
  size_t block_count = kBatchAhead;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    block_count += joints.blocks_before(k, joints.panel_count());
  }
  batch.tables.block_list.starts = placer.array<uint32_t>(size_t{block_row_count(joints)} + 1);
  batch.tables.block_list.raw_ends = placer.array<uint32_t>(block_row_count(joints));
  batch.tables.block_list.blocks = placer.array<InputBlock>(block_count);
  batch.tables.lane_order.turns = placer.array<uint32_t>(rig.rotations.turns.count);
  batch.tables.lane_order.twists = placer.array<uint32_t>(rig.twist_swing.outputs.count);
  batch.tables.ml_values = placer.array<float>(rig.ml.halves.count, kBlockAlignment);
  batch.order = placer.array<Instance*>(capacity);
  batch.lods = placer.array<uint32_t>(capacity);
  batch.first_of_packet = placer.array<uint32_t>(max_packets(rig, capacity, tasks) + 1);
  batch.tasks =
      placer.array<PacketScratch>(std::min<size_t>(tasks, max_packets(rig, capacity, tasks)));
  const size_t layer_width = widest_layer(rig);
  const size_t tile_block_rows = std::min(block_row_count(joints), kMaxTileBlockRows);
  uint32_t max_poses = 0;
  for (const RbfSolverPlan& plan : rig.rbf.plans) {
    max_poses = std::max(max_poses, plan.pose_count);
  }
  for (size_t i = 0; i < batch.tasks.count; ++i) {
    PacketScratch scratch;
    scratch.controls =
        placer.array<float>(size_t{rig.control_count} * kBatchLanes, kBlockAlignment);
    scratch.changed = placer.array<uint32_t>(rig.psds.outputs.count);
    scratch.users = placer.array<uint8_t>(joints.columns.count);
    scratch.sums =
        placer.array<float>(tile_block_rows * kJointBlockRows * kBatchLanes, kBlockAlignment);
    scratch.ends = placer.array<uint32_t>(block_row_count(joints));
    scratch.blocks = placer.array<InputBlock>(block_count);
    for (Span<float>& layer : scratch.ml_layers) {
      layer = placer.array<float>(layer_width * kBatchLanes, kBlockAlignment);
    }
    // If solvers read what others write, the rig solves them one by one.
    const size_t lanes = rig.rbf.independent ? kBatchLanes : 0;
    scratch.rbf_rotations = placer.array<float>(rig.rbf.rotations.count * lanes, kBlockAlignment);
    for (Span<float>& weights : scratch.rbf_weights) {
      weights = placer.array<float>(max_poses * lanes, kBlockAlignment);
    }
    const bool turns = rig.rotations.turns.count + rig.twist_swing.outputs.count != 0;
    scratch.rotations =
        placer.array<float>(turns ? kBlockLanes * 4 * kBatchLanes : 0, kBlockAlignment);
    if (!placer.measuring()) batch.tasks[i] = scratch;
  }
}

/// Lists all blocks by block row, each in order of its columns, with controls as inputs.
void fill_block_list(const Rig& rig, BlockList& list) {
  const JointMatrix& joints = rig.joints;
  const uint32_t panels = joints.panel_count();
  Span<uint32_t>& first = list.starts;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    joints.for_each_block(k, panels, [&](uint32_t, uint32_t block_row) { ++first[block_row + 1]; });
  }
  const size_t block_rows = first.count - 1;
  for (size_t b = 0; b < block_rows; ++b) first[b + 1] += first[b];
  // Filling moves each start to that of the next block row; the starts are moved back afterwards.
  for (size_t k = 0; k < joints.columns.count; ++k) {
    const uint32_t control = joints.columns[k];
    joints.for_each_block(k, panels, [&](uint32_t block, uint32_t block_row) {
      list.blocks[first[block_row]++] = {block, control};
    });
  }
  for (size_t b = block_rows; b > 0; --b) first[b] = first[b - 1];
  first[0] = 0;
  for (const uint16_t control : joints.columns) list.raw_columns += control < rig.raw_count;
  for (size_t b = 0; b < list.raw_ends.count; ++b) {
    uint32_t& end = list.raw_ends[b] = list.starts[b];
    while (end < list.starts[b + 1] && list.blocks[end].input < rig.raw_count) ++end;
  }
}

void order_lanes(const Span<RotationOutput>& outputs, Span<uint32_t>& order) {
  for (uint32_t i = 0; i < order.count; ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return outputs[a].joint < outputs[b].joint; });
  for (size_t i = 1; i < order.count; ++i) {
    if (outputs[order[i - 1]].joint == outputs[order[i]].joint) order.count = 0;  // has two
  }
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const uint32_t of_a = outputs[a].lane, of_b = outputs[b].lane;
    return of_a != of_b ? of_a < of_b : a < b;
  });
}

}  // namespace

size_t batch_size(const Rig& rig, uint32_t capacity, uint32_t tasks) {
  return block_bytes<Batch>(
      [&](Placer& placer, Batch& batch) { place_batch(rig, capacity, tasks, placer, batch); });
}

Batch* create_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, const Allocator& allocator) {
  auto* const batch = create_object<Batch>(allocator, [&](Placer& placer, Batch& placed) {
    place_batch(rig, capacity, tasks, placer, placed);
  });
  if (!batch) return nullptr;
  batch->capacity = capacity;
  batch->rig = share(rig);

  BatchTables& tables = batch->tables;
  fill_block_list(rig, tables.block_list);
  if (rig.half_storage) {
    // The outputs of layers fill whole blocks.
    const size_t values = rig.ml.halves.count / kBlockLanes * kBlockLanes;
    rig.kernels->floats_from_halves(rig.ml.halves.data, values, tables.ml_values.data);
  } else {
    tables.ml_values = rig.ml.values;
  }
  order_lanes(rig.rotations.turns, tables.lane_order.turns);
  order_lanes(rig.twist_swing.outputs, tables.lane_order.twists);
  return batch;
}

void evaluate_batch(Batch& batch, Instance* const* instances, const uint32_t* lods, uint32_t count,
                    uint32_t stages, const ParallelFor& parallel) {
  // Sorted by LOD, in the order given, then cut into packets.
  uint32_t begin[kMaxLods + 1] = {};
  for (uint32_t i = 0; i < count; ++i) ++begin[lods[i] + 1];
  batch.packet_count = 0;
  const uint32_t tasks = parallel.run ? static_cast<uint32_t>(batch.tasks.count) : 1;
  for (uint32_t l = 0; l < batch.rig->lod_count; ++l) {
    const uint32_t of_lod = begin[l + 1];
    const uint32_t packets = packets_for(of_lod, tasks);
    for (uint64_t k = 0; k < packets; ++k) {
      batch.first_of_packet[batch.packet_count++] =
          begin[l] + static_cast<uint32_t>(k * of_lod / packets);
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

  // Task t of n runs packets t, t + n, t + 2n, ...: tasks share no mutable data.
  const auto task = [](void* context, uint32_t index) {
    const Batch& b = *static_cast<const Batch*>(context);
    for (uint32_t c = index; c < b.packet_count; c += b.task_count) {
      const uint32_t first = b.first_of_packet[c], end = b.first_of_packet[c + 1];
      evaluate_packet(InstancePacket::of_batch(*b.rig, b.lods[first], b.order.data + first,
                                               end - first, b.tables, b.tasks[index]),
                      b.stages);
    }
  };
  run_tasks(parallel, batch.task_count, task, &batch);
}

}  // namespace mien
