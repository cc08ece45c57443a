// SPDX-License-Identifier: MIT
// Noise in space for textures: the same bits everywhere, because it takes no sine and no power.
#pragma once

#include "integrations/program/math/vector.h"

namespace mien::render {

inline float eased(float t) { return t * t * (3 - 2 * t); }
inline float eased(float from, float to, float x) {
  return eased(math::saturate((x - from) / (to - from)));
}

/// Smooth noise, -1 ... 1, one wave per unit.
float noise(math::Vec3 p);

/// Round spots at random places, one in each cell of size 1 at most: 1 in the middle of one, 0 outside of `radius`.
/// `share` of the cells have one.
float spots(math::Vec3 p, float radius, float share);

}  // namespace mien::render
