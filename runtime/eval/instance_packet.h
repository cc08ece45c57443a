// SPDX-License-Identifier: MIT
// Instances of one LOD that are evaluated together: 1 in a single evaluation, up to 32 in a batch.
// Both run the same stages in the same order. In a batch, networks, RBF solvers, correctives, the joint
// matrix and rotations are computed for the whole packet where that is faster. The bits are the same.
//
//     each instance:       what changed
//     the packet:          ML: networks that many instances run, in lanes from control to control
//     the packet:          RBF solvers that do not read each other's results, in lanes
//     the packet (batch):  PSD; of the joint matrix the columns that many instances use; rotations
//     each instance:       the rest of PSD, joints, blend shapes, animated maps
#pragma once

#include "runtime/eval/instance.h"
#include "simd/joint_kernels.h"
#include "simd/kernels.h"

namespace mien {

/// All blocks of the joint matrix by block row, each block row in order of its columns.
struct BlockList {
  Span<uint32_t> starts;     // [block row] into blocks, one more at the end
  Span<uint32_t> raw_ends;   // [block row] into blocks: where the columns of raw controls end
  Span<InputBlock> blocks;   // kBatchAhead more at the end
  uint32_t raw_columns = 0;  // columns of raw controls
};

/// The order of rotations that were compiled into lanes: indices into RotationTable::turns and
/// TwistSwingTable::outputs. Empty if a table has two entries for one joint, because then the order of the
/// table matters.
struct LaneOrder {
  Span<uint32_t> turns, twists;
};

/// Tables that the packets of a batch read: made once from the rig.
struct BatchTables {
  BlockList block_list;
  LaneOrder lane_order;
  Span<float> ml_values;  // weights of networks, as floats also if the rig stores halves
};

/// Scratch memory of a packet.
struct PacketScratch {
  Span<float> controls;        // [control][32]
  Span<uint32_t> changed;      // [corrective] one bit per instance
  Span<uint8_t> users;         // [column] how many instances use it
  Span<float> sums;            // [32][packed row of a tile]
  Span<uint32_t> ends;         // [block row] into blocks
  Span<InputBlock> blocks;     // of used columns; those of a block row begin at BlockList::starts
  Span<float> ml_layers[2];    // [input or output][32] of the widest network layer
  Span<float> rbf_rotations;   // layout: RbfBatchArgs
  Span<float> rbf_weights[2];  // layout: RbfBatchArgs
  Span<float> rotations;       // of kBlockLanes joints; layout: QuaternionBatchArgs
};

struct InstancePacket {
  const Rig& rig;
  uint32_t lod;
  Instance* const* instances;  // distinct
  uint32_t count;              // up to kBatchLanes
  // Null in a single evaluation.
  const BatchTables* tables;
  const PacketScratch* scratch;

  static InstancePacket of_one(const Rig& rig, uint32_t lod, Instance* const* instance) {
    return {rig, lod, instance, 1, nullptr, nullptr};
  }
  static InstancePacket of_batch(const Rig& rig, uint32_t lod, Instance* const* instances,
                                 uint32_t count, const BatchTables& tables,
                                 const PacketScratch& scratch) {
    return {rig, lod, instances, count, &tables, &scratch};
  }
};

/// Whether kernels with one lane per instance are worth it: an empty lane costs as much as a full one.
inline bool fills_lanes(const InstancePacket& packet) {
  return packet.scratch && packet.count > 1 && 2 * packet.count >= packet.rig.kernels->batch_step;
}

/// Runs the pipeline. `stages` as for evaluate().
void evaluate_packet(const InstancePacket& packet, uint32_t stages);

/// Fetches controls `first` ... `end` - 1 into the lanes of the scratch memory.
void gather_controls(const InstancePacket& packet, uint32_t first, uint32_t end);
/// The controls that evaluate_rbf() left out, if it returned true for the same instances.
void gather_after_rbf(const InstancePacket& packet);

// For the pipeline: the PSD stage and the joint stage of all instances of a packet. All controls have to be
// in the lanes of the scratch memory.
void evaluate_psds_together(const InstancePacket& packet);
void evaluate_joints_together(const InstancePacket& packet);

}  // namespace mien
