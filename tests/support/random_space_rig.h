// SPDX-License-Identifier: MIT
// Random rigs of everything that has a place or a direction: joints moved by rows, by quaternion
// rows, twists, swings and networks, in any coordinate system; and all that reads the rotations
// which are their inputs.
#pragma once

#include "author/base/random.h"
#include "runtime/base/coordinate_system.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

struct SpaceRigOptions {
  bool euler_rows = true;  // else all joints that rows turn are represented by quaternions
  bool networks = true;
};

/// A 2.8 file in a system of its own. Its raw controls: eight plain ones, then three quaternions
/// .qx .qy .qz .qw. It passes all checks, and every system can be had of it.
DnaView random_space_rig(Random& random, const SpaceRigOptions& options, Arena& arena);

/// Axes, units, sequence, signs, winding, all equally likely.
CoordinateSystem random_system(Random& random);

constexpr uint32_t kSpaceRigPlainControls = 8;
constexpr uint32_t kSpaceRigQuaternions = 3;

}  // namespace mien::dna
