// SPDX-License-Identifier: MIT
// Joints of the library against those of the model.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "integrations/program/model/rotation_model.h"
#include "tests/support/layer_rig.h"

namespace mien {

inline std::vector<ModelJoint> joints_of(const LayerRig& rig, Span<const float> outputs,
                                         bool quaternion_outputs) {
  return model::joints_of(rig, outputs.data, outputs.count, quaternion_outputs);
}

/// Every joint: rotations within `radians`, the rest within `tolerance`.
inline testing::AssertionResult same_joints(const std::vector<ModelJoint>& mine,
                                            const std::vector<ModelJoint>& expected, double radians,
                                            double tolerance) {
  if (mine.size() != expected.size()) return testing::AssertionFailure() << "other joints";
  for (size_t j = 0; j < mine.size(); ++j) {
    const double turn = angle_between(mine[j].rotation, expected[j].rotation);
    if (!(turn <= radians)) {
      return testing::AssertionFailure() << "joint " << j << " is turned by " << turn << " rad";
    }
    for (int i = 0; i < 3; ++i) {
      const double t = std::fabs(mine[j].translation[i] - expected[j].translation[i]);
      const double s = std::fabs(mine[j].scale[i] - expected[j].scale[i]);
      if (!(t <= tolerance) || !(s <= tolerance)) {
        return testing::AssertionFailure() << "joint " << j << ", axis " << i
                                           << ": translation off by " << t << ", scale by " << s;
      }
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace mien
