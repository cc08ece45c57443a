// SPDX-License-Identifier: MIT
// Textures of the teeth and gums of the generated head. u is 1/2 between the incisors and goes along the arch to both
// sides; v is below 1/2 for the upper jaw; in each half come the gum and then teeth from their necks to their edges, as
// author/generate/head/teeth.cpp has it.
#pragma once

#include "integrations/program/render/image.h"

namespace mien::render {

struct TeethMaps {
  Image base_color;  // sRGB
  Image normal;      // tangent space, green towards larger v; of half the size
  Image roughness;   // gray, of half the size
};

/// Width and height are even. The same numbers everywhere. Throws std::bad_alloc.
TeethMaps make_teeth_maps(int width, int height);

}  // namespace mien::render
