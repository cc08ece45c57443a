// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions out of angles, joints represented by quaternions, twists and
// swings (docs/rig-evaluation.md, 4.6 to 4.8, 7).
#include <algorithm>
#include <cmath>

#include "runtime/eval/stages.h"

namespace mien {
namespace {

/// Joints of a list whose first row a LOD reaches: they are in order of it.
uint32_t reached(const Span<QuaternionJoint>& joints, uint32_t rows) {
  uint32_t count = 0;
  while (count < joints.count && joints[count].first_row < rows) ++count;
  return count;
}

/// Writes rotations of joints in the form of the rig's outputs, sixteen at a time.
class RotationWriter {
 public:
  RotationWriter(const Rig& rig, Instance& instance)
      : rig_(rig), instance_(instance), form_(euler_form(rig.rotation)) {}

  /// A lane of quaternions.
  void add(uint32_t joint, const float* lane) {
    for (uint32_t k = 0; k < 4; ++k) {
      rotations_[k * kBlockLanes + count_] = lane[k * kBlockLanes];
    }
    joints_[count_++] = static_cast<uint16_t>(joint);
    if (count_ == kBlockLanes) flush();
  }
  void flush() {
    if (count_ == 0) return;
    if (!rig_.quaternion_outputs) {
      rig_.kernels->angles_from_quaternions({form_, rotations_, rotations_, count_});
    }
    for (uint32_t i = 0; i < count_; ++i) {
      float* out = instance_.joints.data + size_t{joints_[i]} * rig_.joint_attributes + 3;
      const float* lane = rotations_ + i;
      out[0] = lane[0];
      out[1] = lane[kBlockLanes];
      out[2] = lane[2 * kBlockLanes];
      if (rig_.quaternion_outputs) out[3] = lane[3 * kBlockLanes];
    }
    count_ = 0;
  }

 private:
  const Rig& rig_;
  Instance& instance_;
  const EulerForm form_;
  uint32_t count_ = 0;
  uint16_t joints_[kBlockLanes];
  alignas(kBlockAlignment) float rotations_[4 * kBlockLanes] = {};
};

void quaternion_joints(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group,
                       const Span<QuaternionJoint>& joints, RotationWriter& writer) {
  const RotationTable& table = rig.rotations;
  const GroupRotations& rotations = table.groups[group];
  QuaternionJointArgs args;
  args.halves = rig.half_storage;
  if (args.halves) {
    args.values = table.halves.data + rotations.first_value;
  } else {
    args.values = table.values.data + rotations.first_value;
  }
  args.columns = table.columns.data + rotations.first_column;
  args.controls = instance.controls.data;
  args.rotations = instance.rotations.data;
  args.column_count = table.columns_at_lod[size_t{group} * rig.lod_count + lod];
  args.column_stride = rotations.column_count;
  args.joint_count = static_cast<uint32_t>(joints.count);
  rig.kernels->quaternion_joints(args);
  for (uint32_t j = 0; j < joints.count; ++j) {
    writer.add(joints[j].joint,
               args.rotations + j / kBlockLanes * 4 * kBlockLanes + j % kBlockLanes);
  }
}

/// Rotation rows with quaternion outputs: their angles become quaternions.
void angle_joints(const Rig& rig, Instance& instance, const Span<QuaternionJoint>& joints,
                  RotationWriter& writer) {
  const float* all_angles = instance.joints_and_angles.data + rig.joint_value_count();
  const EulerForm form = euler_form(rig.rotation);
  alignas(kBlockAlignment) float block[4 * kBlockLanes] = {};
  for (uint32_t first = 0; first < joints.count; first += kBlockLanes) {
    const uint32_t count = std::min(static_cast<uint32_t>(joints.count) - first, kBlockLanes);
    for (uint32_t j = 0; j < count; ++j) {
      const float* angles = all_angles + size_t{joints[first + j].joint} * 3;
      for (uint32_t k = 0; k < 3; ++k) block[k * kBlockLanes + j] = angles[k];
    }
    rig.kernels->quaternions_from_angles({form, block, block, count});
    for (uint32_t j = 0; j < count; ++j) writer.add(joints[first + j].joint, block + j);
  }
}

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
  TwistSwingBlock(const Rig& rig, Instance& instance) : rig_(rig), writer_(rig, instance) {}

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
    for (uint32_t i = 0; i < count_; ++i) writer_.add(joints_[i], rotations_ + i);
    count_ = 0;
    writer_.flush();
  }

 private:
  const Rig& rig_;
  RotationWriter writer_;
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
  if (table.angle_joints.empty() && table.quaternion_joints.empty()) return;
  RotationWriter writer(rig, instance);
  for (uint32_t group = first_group; group < first_group + group_count; ++group) {
    const GroupRotations& rotations = table.groups[group];
    const uint32_t rows = rig.joints.group_rows_at_lod[size_t{group} * rig.lod_count + lod];
    Span<QuaternionJoint> joints =
        table.angle_joints.slice(rotations.first_angle_joint, rotations.angle_joint_count);
    joints = joints.first(reached(joints, rows));
    if (!joints.empty()) angle_joints(rig, instance, joints, writer);
    joints = table.quaternion_joints.slice(rotations.first_quaternion_joint,
                                           rotations.quaternion_joint_count);
    joints = joints.first(reached(joints, rows));
    if (!joints.empty()) quaternion_joints(rig, instance, lod, group, joints, writer);
  }
  writer.flush();
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
