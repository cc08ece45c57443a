// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions out of angles, joints represented by quaternions, twists and
// swings (docs/rig-evaluation.md, 4.6 to 4.8, 7).
#include "runtime/eval/stages.h"

namespace mien {
namespace {

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

void evaluate_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_group,
                        uint32_t group_count) {
  const RotationTable& table = rig.rotations;
  if (group_count == 0) return;
  const GroupRotations &first = table.groups[first_group],
                       &last = table.groups[first_group + group_count - 1];
  // Those of a group are in order of their lanes.
  write_rotations(
      rig, instance, lod, table.blocks_at_lod[lod], group_count == table.groups.count,
      table.turns.slice(first.first_turn, last.first_turn + last.turn_count - first.first_turn),
      [&](uint32_t block, uint32_t count) { turn_blocks(rig, instance, lod, block, count); });
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

}  // namespace mien
