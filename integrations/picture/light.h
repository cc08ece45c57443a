// SPDX-License-Identifier: MIT
// The studio: a warm key light from the upper left, a cool fill, rims from behind, and a soft sky.
// It moves with the camera.
#pragma once

#include "integrations/picture/occlusion.h"
#include "integrations/picture/scene.h"

namespace mien::picture {

/// Towards the key light, in view space.
Vec3 key_direction();

/// Linear color of a fragment that is `openness` open to the sky and gets `key` of the key light.
Vec3 light(const Fragment& fragment, float openness, float key);

/// A soft shoulder instead of a cut above 1.
Vec3 tone(Vec3 linear);

}  // namespace mien::picture
