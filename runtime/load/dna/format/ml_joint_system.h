// SPDX-License-Identifier: MIT
// The coordinate system of the joint values that networks compute, if it is not that of the rig
// (docs/rig-evaluation.md, 8.6 "ML joints"). The rig compiler and conversion both need it.
#pragma once

#include "runtime/base/coordinate_system.h"
#include "runtime/load/dna/format/dna_schema.h"

namespace mien::dna {

/// Parameter keys of mlbJoints: three axes, three rotation signs and the rotation sequence.
constexpr uint16_t kMlFirstSystemKey = 3, kMlLastSystemKey = 9, kMlSystemKeyCount = 7;
/// Mien's own key: 0 if scales keep their signs, 1 if only their magnitudes count. Without it
/// magnitudes count where the two systems differ, as in the results that files are made for.
constexpr uint16_t kMlScaleKey = 0x8000;

struct MlJointSystem {
  CoordinateSystem system;  // axes, signs and sequence: the rig's unless all keys state another
  bool stated = false;
  bool differs = false;  // from the rig's
  bool scale_magnitude = false;
};

MlJointSystem ml_joint_system(const MlJoints& joints, const CoordinateSystem& rig);

/// True if axes, rotation signs and sequence are the same.
bool same_axes_and_angles(const CoordinateSystem& a, const CoordinateSystem& b);

}  // namespace mien::dna
