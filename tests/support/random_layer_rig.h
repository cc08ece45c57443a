// SPDX-License-Identifier: MIT
#pragma once

#include "tests/support/layer_rig.h"

namespace mien {

/// A rig with some of every layer that drives controls and rotations. If `wild`, its numbers are of
/// any size, down to subnormal and up to the largest, and what they mean need make no sense: radii
/// of 0, targets that are no rotations, blends far beyond 1. If `tangled`, networks and poses read and
/// write any control: raw ones, correctives, their own, each other's; and not all run at each LOD.
LayerRig random_layer_rig(Random& random, bool wild, bool tangled = false);

/// Any finite float, all sizes equally likely; 0, 1 and the extremes often.
float wild_float(Random& random);

}  // namespace mien
