// SPDX-License-Identifier: MIT
#include "runtime/load/dna/format/ml_joint_system.h"

#include <algorithm>

namespace mien::dna {

bool same_axes_and_angles(const CoordinateSystem& a, const CoordinateSystem& b) {
  return std::equal(a.axes, a.axes + 3, b.axes) &&
         std::equal(a.rotation_signs, a.rotation_signs + 3, b.rotation_signs) &&
         a.rotation_sequence == b.rotation_sequence;
}

MlJointSystem ml_joint_system(const MlJoints& joints, const CoordinateSystem& rig) {
  CoordinateSystem own = rig;
  uint32_t seen = 0;
  bool scale_stated = false, magnitude = false;
  for (uint32_t i = 0; i < joints.parameter_keys.count && i < joints.parameter_values.count; ++i) {
    const uint16_t key = joints.parameter_keys[i], value = joints.parameter_values[i];
    if (key == kMlScaleKey) {
      scale_stated = true;
      magnitude = value == 1;
    }
    if (key < kMlFirstSystemKey || key > kMlLastSystemKey) continue;
    seen |= 1u << (key - kMlFirstSystemKey);
    if (key < 6) {
      own.axes[key - 3] = value;
    } else if (key < 9) {
      own.rotation_signs[key - 6] = value == 1 ? 1 : -1;
    } else {
      own.rotation_sequence = value;
    }
  }
  MlJointSystem result;
  result.stated = seen == (1u << kMlSystemKeyCount) - 1;
  result.system = result.stated ? own : rig;
  result.differs = result.stated && spans_space(own.axes) && spans_space(rig.axes) &&
                   !same_axes_and_angles(own, rig);
  result.scale_magnitude = scale_stated ? magnitude : result.differs;
  return result;
}

}  // namespace mien::dna
