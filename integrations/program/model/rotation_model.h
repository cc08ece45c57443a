// SPDX-License-Identifier: MIT
// Joints of a LayerRig in double precision (docs/rig-evaluation.md, 4.3 to 4.8, 7, 8.6), from the
// formulas alone.
#pragma once

#include <array>
#include <vector>

#include "integrations/program/model/layer_rig.h"

namespace mien::model {

/// x y z w. a * b turns by b first.
template <class T>
struct QuaternionOf {
  T x = 0, y = 0, z = 0, w = 1;
};
using ModelQuaternion = QuaternionOf<double>;
template <class T>
QuaternionOf<T> operator*(const QuaternionOf<T>& a, const QuaternionOf<T>& b);
/// The identity if all parts are 0.
template <class T>
QuaternionOf<T> unit(const QuaternionOf<T>& q);

/// Sequence 0 ... 5 as the format numbers them, signs of the angles about x y z, and their unit.
struct ModelConvention {
  uint32_t sequence = 0;
  std::array<int, 3> signs = {1, 1, 1};
  bool degrees = true;
};
ModelConvention convention_of(const LayerRig& rig);

template <class T = double>
QuaternionOf<T> model_quaternion(const ModelConvention& convention, const std::array<T, 3>& angles);
/// Away from the poles.
template <class T>
std::array<T, 3> model_angles(const ModelConvention& convention, const QuaternionOf<T>& q);

/// Radians of the turn that leads from one rotation to the other. Neither need be unit.
double angle_between(const ModelQuaternion& a, const ModelQuaternion& b);

template <class T>
struct JointOf {
  std::array<T, 3> translation = {}, scale = {};
  QuaternionOf<T> rotation;  // what the angles, or the quaternion, of the output mean
};
using ModelJoint = JointOf<double>;

/// All joints at a LOD, from all controls.
template <class T>
std::vector<JointOf<T>> model_joints(const LayerRig& rig, const std::vector<T>& controls,
                                     uint32_t lod, bool quaternion_outputs);

/// Joint values of the library, 9 or 10 floats for each joint, as the model sees them.
std::vector<ModelJoint> joints_of(const LayerRig& rig, const float* outputs, size_t count,
                                  bool quaternion_outputs);

}  // namespace mien::model
