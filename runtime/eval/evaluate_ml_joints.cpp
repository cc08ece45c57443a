// SPDX-License-Identifier: MIT
// ML joints, the last step of the joint stage (docs/rig-evaluation.md, 8.6 "ML joints"): controls that
// the ML stage has written are added to joint values.
#include <algorithm>

#include "runtime/eval/stages.h"

namespace mien {
namespace {

bool is_active(const MlJoint& joint, uint32_t lod) { return joint.lods >> lod & 1; }

}  // namespace

void clear_ml_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  for (const MlJoint& joint : rig.ml.joints) {
    if (!is_active(joint, lod)) continue;
    float* out = instance.joints.data + size_t{joint.joint} * rig.joint_attributes;
    std::fill(out, out + rig.joint_attributes, 0.0f);
    if (rig.quaternion_outputs) out[6] = 1.0f;
  }
}

void add_ml_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  const MlTable& ml = rig.ml;
  for (const MlJoint& joint : ml.joints) {
    if (!is_active(joint, lod)) continue;
    float* out = instance.joints.data + size_t{joint.joint} * rig.joint_attributes;
    float* scale = out + rig.joint_attributes - 3;
    for (int i = 0; i < 3; ++i) {
      if (joint.translation[i] != kNoControl) {
        out[i] = saturated(out[i] + instance.controls[joint.translation[i]]);
      }
      if (joint.scale[i] != kNoControl) {
        scale[i] = saturated(scale[i] + instance.controls[joint.scale[i]]);
      }
    }
    if (joint.rotation_control == kNoControl) continue;
    const float* x = instance.controls.data + joint.rotation_control;
    const Quaternion q = ml.quaternion_rotations ? normalized({x[0], x[1], x[2], x[3]})
                                                 : quaternion_from_euler(rig.rotation, x);
    if (rig.quaternion_outputs) {
      write_rotation(rig, instance, joint.joint, q * Quaternion{out[3], out[4], out[5], out[6]});
    } else {
      float angles[3] = {x[0], x[1], x[2]};
      if (ml.quaternion_rotations) euler_from_quaternion(rig.rotation, q, angles);
      for (int i = 0; i < 3; ++i) out[3 + i] = saturated(out[3 + i] + angles[i]);
    }
  }
}

}  // namespace mien
