// SPDX-License-Identifier: MIT
// Textures of the eyes of the generated head: iris, limbus and white, and the normals of a cornea. Distance from their
// middle is the angle from the pupil, as author/generate/head/parts.cpp has it. The other eye has 1 - u.
#pragma once

#include "integrations/program/render/image.h"

namespace mien::render {

struct EyeMaps {
  Image base_color;  // sRGB
  Image normal;      // tangent space, green towards larger v
};

/// `iris` is its color (sRGB) in plain light. Base colors are of this size, normals of half of it. The same
/// numbers everywhere. Throws std::bad_alloc.
EyeMaps make_eye_maps(Color iris, int size);

}  // namespace mien::render
