// SPDX-License-Identifier: MIT
// ML joints, the last step of the joint stage (docs/rig-evaluation.md, 8.6 "ML joints"): controls that
// the ML stage has written are added to joint values.
#include <algorithm>

#include "runtime/eval/stages.h"
#include "simd/kernels.h"
#include "simd/lanes.h"

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

namespace {

/// Converts sixteen ML rotations to the form in which they are added: quaternions to quaternions, angles to
/// angles.
class MlRotationBlock {
 public:
  MlRotationBlock(const Rig& rig, Instance& instance)
      : rig_(rig), instance_(instance),
        converts_(rig.ml.quaternion_rotations != rig.quaternion_outputs) {}

  void add(const MlJoint& joint) {
    const float* x = instance_.controls.data + joint.rotation_control;
    float part[4] = {x[0], x[1], x[2], 0};
    if (rig_.ml.quaternion_rotations) {
      const Quaternion q = normalized({x[0], x[1], x[2], x[3]});
      part[0] = q.x;
      part[1] = q.y;
      part[2] = q.z;
      part[3] = q.w;
    }
    for (uint32_t k = 0; k < 4; ++k) rows_[k * kBlockLanes + count_] = part[k];
    joints_[count_++] = joint.joint;
    if (count_ == kBlockLanes) flush();
  }
  void flush() {
    if (count_ == 0) return;
    if (converts_) {
      const auto kernel = rig_.quaternion_outputs ? rig_.kernels->quaternions_from_angles
                                                  : rig_.kernels->angles_from_quaternions;
      kernel({euler_form(rig_.rotation), rows_, rows_, count_});
    }
    for (uint32_t i = 0; i < count_; ++i) {
      const float* lane = rows_ + i;
      const float v[4] = {lane[0], lane[kBlockLanes], lane[2 * kBlockLanes], lane[3 * kBlockLanes]};
      float* out = instance_.joints.data + size_t{joints_[i]} * rig_.joint_attributes + 3;
      if (rig_.quaternion_outputs) {
        const Quaternion q =
            Quaternion{v[0], v[1], v[2], v[3]} * Quaternion{out[0], out[1], out[2], out[3]};
        out[0] = q.x;
        out[1] = q.y;
        out[2] = q.z;
        out[3] = q.w;
      } else {
        for (int k = 0; k < 3; ++k) out[k] = saturated(out[k] + v[k]);
      }
    }
    count_ = 0;
  }

 private:
  const Rig& rig_;
  Instance& instance_;
  const bool converts_;
  uint32_t count_ = 0;
  alignas(kBlockAlignment) float rows_[4 * kBlockLanes] = {};
  uint16_t joints_[kBlockLanes];
};

}  // namespace

void add_ml_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  if (rig.ml.joints.empty()) return;
  MlRotationBlock rotations(rig, instance);
  for (const MlJoint& joint : rig.ml.joints) {
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
    if (joint.rotation_control != kNoControl) rotations.add(joint);
  }
  rotations.flush();
}

}  // namespace mien
