// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions from angles, joints represented by quaternions, twists and swings
// (docs/rig-evaluation.md, 4.6 to 4.8, 7).
#include "runtime/base/bits.h"
#include "runtime/eval/instance_packet.h"
#include "runtime/eval/stages.h"
#include "simd/lanes.h"

namespace mien {
namespace {

// One character: lanes are joints -----------------------------------------------------------------

/// Writes a lane of a block to its joint, in the form of the rig's outputs.
void write_rotation(const Rig& rig, Instance& instance, uint32_t joint, const float* lane) {
  float* out = instance.joints.data + size_t{joint} * rig.joint_attributes + 3;
  out[0] = lane[0];
  out[1] = lane[kBlockLanes];
  out[2] = lane[2 * kBlockLanes];
  if (rig.quaternion_outputs) out[3] = lane[3 * kBlockLanes];
}

/// Computes the turns of some blocks.
void turn_blocks(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first, uint32_t count) {
  const RotationTable& table = rig.rotations;
  const size_t first_of_lod = size_t{lod} * table.block_count() + first;
  QuaternionJointArgs args;
  args.halves = rig.half_storage;
  args.values = args.halves ? static_cast<const void*>(table.halves.data) : table.values.data;
  args.columns = table.columns.data;
  args.first_steps = table.first_steps.data + first;
  args.step_counts = table.steps_at_lod.data + first_of_lod;
  args.lane_steps = table.lane_steps_at_lod.data + first_of_lod * kBlockLanes;
  args.controls = instance.controls.data;
  args.rotations = instance.rotations.data + size_t{first} * 4 * kBlockLanes;
  args.block_count = count;
  rig.kernels->quaternion_joints(args);
  if (!rig.quaternion_outputs) {
    rig.kernels->angles_from_quaternions(
        {euler_form(rig.rotation), args.rotations, args.rotations, count * kBlockLanes});
  }
}

/// Computes twists and swings of some blocks.
void twist_blocks(const Rig& rig, Instance& instance, uint32_t first, uint32_t count) {
  const TwistSwingTable& table = rig.twist_swing;
  float* rotations = instance.rotations.data + size_t{first} * 4 * kBlockLanes;
  rig.kernels->twist_swing({table.inputs.data + size_t{first} * 4 * kBlockLanes,
                            table.lanes.data + size_t{first} * kTwistSwingRows * kBlockLanes,
                            instance.controls.data, rotations, count});
  if (!rig.quaternion_outputs) {
    rig.kernels->angles_from_quaternions(
        {euler_form(rig.rotation), rotations, rotations, count * kBlockLanes});
  }
}

/// Computes and writes outputs of the first `blocks` blocks, all of them or some:
/// compute(first block, count).
template <class F>
void write_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t blocks, bool all,
                     const Span<RotationOutput>& outputs, F&& compute) {
  if (all && blocks != 0) compute(0, blocks);
  uint32_t computed = blocks;
  for (const RotationOutput& output : outputs) {
    if ((output.lods >> lod & 1) == 0) continue;
    const uint32_t block = output.lane / kBlockLanes;
    if (block >= blocks) continue;
    if (!all && block != computed) compute(block, 1);
    computed = block;
    write_rotation(
        rig, instance, output.joint,
        instance.rotations.data + size_t{block} * 4 * kBlockLanes + output.lane % kBlockLanes);
  }
}

/// Rotation rows with quaternion outputs: their angles become quaternions, sixteen at a time.
class AngleBlock {
 public:
  AngleBlock(const Rig& rig, Instance& instance) : rig_(rig), instance_(instance) {}

  void add(uint32_t joint) {
    const float* angles =
        instance_.joints_and_angles.data + rig_.joint_value_count() + size_t{joint} * 3;
    for (uint32_t k = 0; k < 3; ++k) rows_[k * kBlockLanes + count_] = angles[k];
    joints_[count_++] = static_cast<uint16_t>(joint);
    if (count_ == kBlockLanes) flush();
  }
  void flush() {
    if (count_ == 0) return;
    rig_.kernels->quaternions_from_angles({euler_form(rig_.rotation), rows_, rows_, count_});
    for (uint32_t i = 0; i < count_; ++i) write_rotation(rig_, instance_, joints_[i], rows_ + i);
    count_ = 0;
  }

 private:
  const Rig& rig_;
  Instance& instance_;
  uint32_t count_ = 0;
  uint16_t joints_[kBlockLanes];
  alignas(kBlockAlignment) float rows_[4 * kBlockLanes] = {};
};

}  // namespace

EulerForm euler_form(const RotationConvention& convention) {
  EulerForm form;
  form.parity = convention.parity;
  for (int i = 0; i < 3; ++i) {
    form.axes[i] = convention.axes[i];
    form.to_radians[i] = convention.signs[i] * convention.to_radians;
    form.from_radians[i] = convention.signs[i] / convention.to_radians;
  }
  return form;
}

namespace {

/// Turns of neighboring groups.
void turn_groups(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_group,
                 uint32_t group_count) {
  const RotationTable& table = rig.rotations;
  const GroupRotations &first = table.groups[first_group],
                       &last = table.groups[first_group + group_count - 1];
  // Those of a group are in order of their lanes.
  write_rotations(
      rig, instance, lod, table.blocks_at_lod[lod], group_count == table.groups.count,
      table.turns.slice(first.first_turn, last.first_turn + last.turn_count - first.first_turn),
      [&](uint32_t block, uint32_t count) { turn_blocks(rig, instance, lod, block, count); });
}

/// Angles of neighboring groups, if outputs are quaternions.
void convert_angles(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_group,
                    uint32_t group_count) {
  const RotationTable& table = rig.rotations;
  if (table.angle_joints.empty()) return;
  AngleBlock block(rig, instance);
  for (uint32_t group = first_group; group < first_group + group_count; ++group) {
    const GroupRotations& rotations = table.groups[group];
    const uint32_t rows = rig.joints.group_rows_at_lod[size_t{group} * rig.lod_count + lod];
    for (const AngleJoint& joint :
         table.angle_joints.slice(rotations.first_angle_joint, rotations.angle_joint_count)) {
      if (joint.first_row >= rows) break;  // they are in order of it
      block.add(joint.joint);
    }
  }
  block.flush();
}

}  // namespace

void evaluate_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_group,
                        uint32_t group_count) {
  if (group_count == 0) return;
  turn_groups(rig, instance, lod, first_group, group_count);
  convert_angles(rig, instance, lod, first_group, group_count);
}

void apply_twists_and_swings(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_setup,
                             uint32_t setup_count) {
  const TwistSwingTable& table = rig.twist_swing;
  if (setup_count == 0) return;
  const TwistSwing &first = table.setups[first_setup],
                   &last = table.setups[first_setup + setup_count - 1];
  write_rotations(
      rig, instance, lod, table.blocks_at_lod[lod], setup_count == table.setups.count,
      table.outputs.slice(first.first_output,
                          last.first_output + last.output_count - first.first_output),
      [&](uint32_t block, uint32_t count) { twist_blocks(rig, instance, block, count); });
}

// Many characters: they are lanes -----------------------------------------------------------------

namespace {

/// Computes and writes the outputs of the first `blocks` blocks, as many at a time as fit the scratch memory:
/// compute(first lane, count).
template <class F>
void write_rotations_together(const InstancePacket& packet, uint32_t blocks,
                              const Span<RotationOutput>& outputs, const Span<uint32_t>& order,
                              F&& compute) {
  const Rig& rig = packet.rig;
  float* const rotations = packet.scratch->rotations.data;
  const uint32_t lanes = static_cast<uint32_t>(align_up(packet.count, kBlockLanes));
  float* rows[kBatchLanes];
  for (uint32_t k = 0; k < packet.count; ++k) rows[k] = packet.instances[k]->joints.data;
  for (size_t begin = 0, end; begin < order.count; begin = end) {
    const uint32_t first = outputs[order[begin]].lane, block = first / kBlockLanes;
    if (block >= blocks) break;
    for (end = begin + 1; end < order.count; ++end) {
      if (outputs[order[end]].lane / kBlockLanes != block) break;
    }
    const uint32_t count = outputs[order[end - 1]].lane - first + 1;
    compute(first, count);
    if (!rig.quaternion_outputs) {
      rig.kernels->angles_from_quaternions(
          {euler_form(rig.rotation), rotations, rotations, count * lanes});
    }
    for (size_t i = begin; i < end; ++i) {
      const RotationOutput& output = outputs[order[i]];
      if ((output.lods >> packet.lod & 1) == 0) continue;
      rig.kernels->scatter_rotation(rotations + size_t{output.lane - first} * 4 * lanes,
                                    packet.count, size_t{output.joint} * rig.joint_attributes + 3,
                                    rig.quaternion_outputs, rows);
    }
  }
}

void turn_together(const InstancePacket& packet) {
  const Rig& rig = packet.rig;
  const RotationTable& table = rig.rotations;
  const size_t first_of_lod = size_t{packet.lod} * table.block_count();
  QuaternionBatchArgs args;
  args.halves = rig.half_storage;
  args.values = args.halves ? static_cast<const void*>(table.halves.data) : table.values.data;
  args.columns = table.columns.data;
  args.first_steps = table.first_steps.data;
  args.step_counts = table.steps_at_lod.data + first_of_lod;
  args.lane_steps = table.lane_steps_at_lod.data + first_of_lod * kBlockLanes;
  args.controls = packet.scratch->controls.data;
  args.rotations = packet.scratch->rotations.data;
  args.lane_count = packet.count;
  write_rotations_together(packet, table.blocks_at_lod[packet.lod], table.turns,
                           packet.tables->lane_order.turns, [&](uint32_t first, uint32_t count) {
                             args.first = first;
                             args.count = count;
                             rig.kernels->quaternion_batch(args);
                           });
}

void twist_together(const InstancePacket& packet) {
  const TwistSwingTable& table = packet.rig.twist_swing;
  write_rotations_together(
      packet, table.blocks_at_lod[packet.lod], table.outputs, packet.tables->lane_order.twists,
      [&](uint32_t first, uint32_t count) {
        packet.rig.kernels->twist_swing_batch(
            {table.inputs.data, table.lanes.data, packet.scratch->controls.data,
             packet.scratch->rotations.data, first, count, packet.count});
      });
}

}  // namespace

void turn_joints(const InstancePacket& packet) {
  const Rig& rig = packet.rig;
  const uint32_t groups = rig.joints.group_count;
  if (groups == 0) return;
  const bool together = fills_lanes(packet) && !packet.tables->lane_order.turns.empty();
  if (together) turn_together(packet);
  for (uint32_t i = 0; i < packet.count; ++i) {
    if (!together) turn_groups(rig, *packet.instances[i], packet.lod, 0, groups);
    convert_angles(rig, *packet.instances[i], packet.lod, 0, groups);
  }
}

void turn_changed_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  const uint32_t groups = rig.joints.group_count;
  if (groups == 0) return;
  turn_groups(rig, instance, lod, 0, groups);
  // Angles overwrite the turns of the same joints.
  if (!rig.rotations.turns.empty()) return convert_angles(rig, instance, lod, 0, groups);
  AngleBlock block(rig, instance);
  const Span<uint64_t>& turned = instance.changes->turned;
  for (uint32_t w = 0; w < turned.count; ++w) {
    for (uint64_t bits = turned[w]; bits != 0; bits &= bits - 1) {
      block.add(w * 64 + lowest_bit(bits));
    }
  }
  block.flush();
}

void twist_joints(const InstancePacket& packet) {
  if (fills_lanes(packet) && !packet.tables->lane_order.twists.empty())
    return twist_together(packet);
  const auto setups = static_cast<uint32_t>(packet.rig.twist_swing.setups.count);
  for (uint32_t i = 0; i < packet.count; ++i) {
    apply_twists_and_swings(packet.rig, *packet.instances[i], packet.lod, 0, setups);
  }
}

}  // namespace mien
