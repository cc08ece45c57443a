// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions out of angles, joints represented by quaternions, twists and
// swings (docs/rig-evaluation.md, 4.6 to 4.8, 7).
#include <algorithm>
#include <cmath>

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

/// Computes and writes the turns of one group, or of all.
void turn_joints(const Rig& rig, Instance& instance, uint32_t lod,
                 const Span<RotationOutput>& turns) {
  const RotationTable& table = rig.rotations;
  const uint32_t blocks = table.blocks_at_lod[lod];
  const bool all = turns.count == table.turns.count;
  if (all && blocks != 0) turn_blocks(rig, instance, lod, 0, blocks);
  uint32_t turned = blocks;
  for (const RotationOutput& turn : turns) {
    if ((turn.lods >> lod & 1) == 0) continue;
    const uint32_t block = turn.lane / kBlockLanes;
    if (block >= blocks) continue;
    // Those of a group are in order of their lanes.
    if (!all && block != turned) turn_blocks(rig, instance, lod, block, 1);
    turned = block;
    write_rotation(
        rig, instance, turn.joint,
        instance.rotations.data + size_t{block} * 4 * kBlockLanes + turn.lane % kBlockLanes);
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

/// Inputs need not be unit, but squares of what is far from it would overflow, or vanish.
Quaternion bounded(const Quaternion& q) {
  const float squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (squared > 1e-18f && squared < 1e18f) return q;
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  if ((length > 1e-9 && length < 1e9) || !(length > 0)) return q;
  return {static_cast<float>(x / length), static_cast<float>(y / length),
          static_cast<float>(z / length), static_cast<float>(w / length)};
}

/// Outputs of twists and swings, sixteen at a time. They read controls alone, so their order counts
/// only where two of them write the same joint.
class TwistSwingBlock {
 public:
  TwistSwingBlock(const Rig& rig, Instance& instance) : rig_(rig), instance_(instance) {}

  void add(const Quaternion& q, uint32_t axis, bool inverted, const TwistSwingOutput& out,
           bool swing) {
    float* lane = inputs_ + count_;
    lane[0] = q.x;
    lane[kBlockLanes] = q.y;
    lane[2 * kBlockLanes] = q.z;
    lane[3 * kBlockLanes] = q.w;
    for (uint32_t k = 0; k < 3; ++k) lane[(4 + k) * kBlockLanes] = 0;
    lane[(4 + axis) * kBlockLanes] = inverted ? -1.0f : 1.0f;
    lane[7 * kBlockLanes] = out.blend;
    lane[8 * kBlockLanes] = swing ? 1.0f : 0.0f;
    joints_[count_++] = out.joint;
    if (count_ == kBlockLanes) flush();
  }
  void flush() {
    if (count_ == 0) return;
    rig_.kernels->twist_swing({inputs_, rotations_, count_});
    if (!rig_.quaternion_outputs) {
      rig_.kernels->angles_from_quaternions(
          {euler_form(rig_.rotation), rotations_, rotations_, count_});
    }
    for (uint32_t i = 0; i < count_; ++i) {
      write_rotation(rig_, instance_, joints_[i], rotations_ + i);
    }
    count_ = 0;
  }

 private:
  const Rig& rig_;
  Instance& instance_;
  uint32_t count_ = 0;
  alignas(kBlockAlignment) float inputs_[kTwistSwingRows * kBlockLanes] = {};
  alignas(kBlockAlignment) float rotations_[4 * kBlockLanes];
  uint16_t joints_[kBlockLanes];
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
  turn_joints(
      rig, instance, lod,
      table.turns.slice(first.first_turn, last.first_turn + last.turn_count - first.first_turn));
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

void apply_twists_and_swings(const Rig& rig, Instance& instance, uint32_t lod,
                             const Span<TwistSwing>& setups) {
  if (setups.empty()) return;
  const TwistSwingTable& table = rig.twist_swing;
  const float* c = instance.controls.data;
  TwistSwingBlock block(rig, instance);
  for (const TwistSwing& setup : setups) {
    const Quaternion q =
        bounded({c[setup.inputs[0]], c[setup.inputs[1]], c[setup.inputs[2]], c[setup.inputs[3]]});
    const auto add = [&](uint32_t first, uint32_t count, bool swing) {
      for (const TwistSwingOutput& out : table.outputs.slice(first, count)) {
        if (out.lods >> lod & 1) block.add(q, setup.axis, setup.has_swing, out, swing);
      }
    };
    add(setup.first_swing, setup.swing_count, true);
    add(setup.first_twist, setup.twist_count, false);
  }
  block.flush();
}

}  // namespace mien
