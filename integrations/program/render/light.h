// SPDX-License-Identifier: MIT
// The studio: a large warm key light from the upper left, a cool fill, rims from behind, a soft sky, and what the ground
// throws back. It moves with the camera.
#pragma once

#include "integrations/program/render/occlusion.h"
#include "integrations/program/render/scene.h"

namespace mien::render {

constexpr int kRimCount = 2;

/// Towards the key light and towards a rim light, in view space.
math::Vec3 key_direction();
math::Vec3 rim_direction(int rim);

/// What of the light of lamps arrives, 0..1 each.
struct Arriving {
  float key = 1;
  float rims[kRimCount] = {1, 1};
};

/// Whether a rim light can be seen on the fragment at all.
bool has_rim(const Fragment& fragment, int rim);

/// Linear color of a fragment that is `openness` open to the sky.
math::Vec3 light(const Fragment& fragment, float openness, const Arriving& arriving);

/// A soft shoulder instead of a cut above 1.
math::Vec3 tone(math::Vec3 linear);

}  // namespace mien::render
