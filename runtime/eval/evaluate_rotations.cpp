// SPDX-License-Identifier: MIT
// Rotations of joints: quaternions out of angles, joints represented by quaternions, twists and
// swings (docs/rig-evaluation.md, 4.6 to 4.8, 7).
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

void quaternion_joints(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group,
                       const Span<QuaternionJoint>& joints) {
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
  args.block_count = static_cast<uint32_t>((joints.count + kBlockLanes - 1) / kBlockLanes);
  rig.kernels->quaternion_joints(args);
  for (uint32_t j = 0; j < joints.count; ++j) {
    const float* lane = args.rotations + j / kBlockLanes * 4 * kBlockLanes + j % kBlockLanes;
    write_rotation(rig, instance, joints[j].joint,
                   {lane[0], lane[kBlockLanes], lane[2 * kBlockLanes], lane[3 * kBlockLanes]});
  }
}

Quaternion conjugate(const Quaternion& q) { return {-q.x, -q.y, -q.z, q.w}; }

/// The turn about an axis alone, unit; identity if there is none.
Quaternion twist_about(const Quaternion& q, uint32_t axis) {
  const float about[3] = {q.x, q.y, q.z};
  float part[3] = {};
  part[axis] = about[axis];
  return normalized({part[0], part[1], part[2], q.w});
}

Quaternion inverse(const Quaternion& q) {
  const float squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(squared > 0)) return {};
  const Quaternion c = conjugate(q);
  return {c.x / squared, c.y / squared, c.z / squared, c.w / squared};
}

/// Inputs need not be unit, but squares of what is far from it would overflow, or vanish.
Quaternion bounded(const Quaternion& q) {
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  if ((length > 1e-9 && length < 1e9) || !(length > 0)) return q;
  return {static_cast<float>(x / length), static_cast<float>(y / length),
          static_cast<float>(z / length), static_cast<float>(w / length)};
}

}  // namespace

void write_rotation(const Rig& rig, Instance& instance, uint32_t joint, const Quaternion& q) {
  float* out = instance.joints.data + size_t{joint} * rig.joint_attributes + 3;
  if (!rig.quaternion_outputs) return euler_from_quaternion(rig.rotation, q, out);
  out[0] = q.x;
  out[1] = q.y;
  out[2] = q.z;
  out[3] = q.w;
}

void evaluate_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group) {
  const RotationTable& table = rig.rotations;
  const GroupRotations& rotations = table.groups[group];
  const uint32_t rows = rig.joints.group_rows_at_lod[size_t{group} * rig.lod_count + lod];

  Span<QuaternionJoint> joints =
      table.angle_joints.slice(rotations.first_angle_joint, rotations.angle_joint_count);
  for (const QuaternionJoint& turned : joints.first(reached(joints, rows))) {
    const float* angles =
        instance.joints_and_angles.data + rig.joint_value_count() + size_t{turned.joint} * 3;
    write_rotation(rig, instance, turned.joint, quaternion_from_euler(rig.rotation, angles));
  }

  joints = table.quaternion_joints.slice(rotations.first_quaternion_joint,
                                         rotations.quaternion_joint_count);
  joints = joints.first(reached(joints, rows));
  if (!joints.empty()) quaternion_joints(rig, instance, lod, group, joints);
}

void apply_twist_swing(const Rig& rig, Instance& instance, uint32_t lod, const TwistSwing& setup) {
  const TwistSwingTable& table = rig.twist_swing;
  const float* c = instance.controls.data;
  const Quaternion q =
      bounded({c[setup.inputs[0]], c[setup.inputs[1]], c[setup.inputs[2]], c[setup.inputs[3]]});
  Quaternion twist = twist_about(q, setup.axis);
  if (setup.has_swing) {
    twist = conjugate(twist);  // unit, so this is its inverse
    const Quaternion swing = inverse(q * twist);
    for (const TwistSwingOutput& out : table.outputs.slice(setup.first_swing, setup.swing_count)) {
      if (!(out.lods >> lod & 1)) continue;
      write_rotation(rig, instance, out.joint, twist * slerp_to_identity(swing, out.blend));
    }
  }
  for (const TwistSwingOutput& out : table.outputs.slice(setup.first_twist, setup.twist_count)) {
    if (!(out.lods >> lod & 1)) continue;
    write_rotation(rig, instance, out.joint, slerp_to_identity(twist, out.blend));
  }
}

}  // namespace mien
