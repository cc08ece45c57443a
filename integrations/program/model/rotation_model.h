// SPDX-License-Identifier: MIT
// Joints of a LayerRig in double precision (docs/rig-evaluation.md, 4.3 to 4.8, 7, 8.6), from the
// formulas alone.
#pragma once

#include <array>
#include <vector>

#include "integrations/program/model/layer_rig.h"

namespace mien::model {

/// x y z w. a * b turns by b first.
struct ModelQuaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
ModelQuaternion operator*(const ModelQuaternion& a, const ModelQuaternion& b);
ModelQuaternion unit(const ModelQuaternion& q);

/// Sequence 0 ... 5 as the format numbers them, signs of the angles about x y z, and their unit.
struct ModelConvention {
  uint32_t sequence = 0;
  std::array<int, 3> signs = {1, 1, 1};
  bool degrees = true;
};
ModelConvention convention_of(const LayerRig& rig);

ModelQuaternion model_quaternion(const ModelConvention& convention,
                                 const std::array<double, 3>& angles);
/// Away from the poles.
std::array<double, 3> model_angles(const ModelConvention& convention, const ModelQuaternion& q);

/// Radians of the turn that leads from one rotation to the other. Neither need be unit.
double angle_between(const ModelQuaternion& a, const ModelQuaternion& b);

struct ModelJoint {
  std::array<double, 3> translation = {}, scale = {};
  ModelQuaternion rotation;  // what the angles, or the quaternion, of the output mean
};

/// All joints at a LOD, from all controls.
std::vector<ModelJoint> model_joints(const LayerRig& rig, const std::vector<double>& controls,
                                     uint32_t lod, bool quaternion_outputs);

/// Joint values of the library, 9 or 10 floats for each joint, as the model sees them.
std::vector<ModelJoint> joints_of(const LayerRig& rig, const float* outputs, size_t count,
                                  bool quaternion_outputs);

}  // namespace mien::model
