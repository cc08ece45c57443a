// SPDX-License-Identifier: MIT
#include "runtime/eval/statistics.h"

namespace mien {

RigStatistics rig_statistics(const Rig& rig, uint32_t lod) {
  RigStatistics out;
  if (rig.psd_count) out.psd_count = rig.psds.count_at_lod[lod];
  out.joint_count = static_cast<uint32_t>(rig.lod_joints.at(lod).count);
  out.blend_shape_count = rig.channels.count_at_lod[lod];
  out.animated_map_row_count = rig.map_rows_at_lod[lod];
  out.rbf_solver_count = static_cast<uint32_t>(rig.rbf.lod_solvers.at(lod).count);
  const JointMatrix& joints = rig.joints;
  const uint32_t panels = joints.panels_at_lod[lod];
  for (size_t k = 0; k < joints.columns.count; ++k) {
    out.joint_entry_count += uint64_t{joints.blocks_before(k, panels)} * kJointBlockRows;
    out.joint_byte_count += joints.bytes_before(k, panels);
  }
  for (size_t g = 0; g < joints.group_count; ++g) {
    out.joint_row_count += joints.group_rows_at_lod[g * rig.lod_count + lod];
  }
  for (const RotationOutput& turn : rig.rotations.turns) {
    out.quaternion_joint_count += turn.lods >> lod & 1;
  }
  return out;
}

InstanceStatistics instance_statistics(const Instance& instance) {
  InstanceStatistics out;
  for (float control : instance.controls) out.active_control_count += control != 0.0f;
  const JointMatrix& joints = instance.rig->joints;
  const uint32_t panels = instance.rig->lod_count ? joints.panels_at_lod[instance.lod] : 0;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    if (instance.controls[joints.columns[k]] == 0.0f) continue;
    const uint32_t blocks = joints.blocks_before(k, panels);
    out.joint_column_count += blocks != 0;
    out.joint_entry_count += uint64_t{blocks} * kJointBlockRows;
    out.joint_byte_count += joints.bytes_before(k, panels);
  }
  return out;
}

}  // namespace mien
