// SPDX-License-Identifier: MIT
// The studio: a warm key light from the upper left, a cool fill, rims from behind, and a soft sky.
// It moves with the camera.
#pragma once

#include "integrations/cli/render/occlusion.h"
#include "integrations/cli/render/scene.h"

namespace mien::render {

/// Towards the key light, in view space.
math::Vec3 key_direction();

/// Linear color of a fragment that is `openness` open to the sky and gets `key` of the key light.
math::Vec3 light(const Fragment& fragment, float openness, float key);

/// A soft shoulder instead of a cut above 1.
math::Vec3 tone(math::Vec3 linear);

}  // namespace mien::render
