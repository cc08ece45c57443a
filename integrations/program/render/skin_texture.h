// SPDX-License-Identifier: MIT
// Textures of skin, made from a mesh with colors: its own colors, to which pores, creases and blotches are added in
// space, so that they have the same size everywhere and no seam.
#pragma once

#include <vector>

#include "integrations/program/render/image.h"
#include "integrations/program/render/render.h"

namespace mien::render {

/// An ellipse of the texture and its mirror image, where skin differs: fading from its middle outwards.
struct SkinZone {
  float u, v, half_u, half_v;
  float oil;    // less rough by so much
  float pores;  // larger pores; less than 0: smaller ones
};

/// Where in the texture other materials are. Coordinates as in Surface.
struct SkinLayout {
  std::vector<SkinZone> zones;
  // From here on, away from u = 1/2 and upwards, skin is under hair or seldom seen: it gets no pores.
  float plain_u = 0.5f, plain_v = 1;
  // Eyes are above and below the open slit between the lids, whose rims are wet, in this box and its mirror image.
  float lids_low_u = 0, lids_low_v = 0, lids_high_u = 0, lids_high_v = 0;
  float cloth_below = 0;  // v below which a shirt is
  float collar = 0;       // how far from there, in v, colors of vertices blend skin and shirt
  float hem = 0;          // cm: thickness of the shirt
  // Lips, and the inside of the mouth, are what is redder than the skin at `skin`, in the box from `lips_low` to `lips_high`.
  float skin_u = 0, skin_v = 0;
  float lips_low_u = 0, lips_low_v = 0, lips_high_u = 0, lips_high_v = 0;
  // Freckles are in this box, so many of 1 spots.
  float freckles_low_v = 0, freckles_high_v = 0, freckles = 0;
};

struct SkinMaps {
  Image base_color;  // sRGB
  Image normal;      // tangent space, green towards larger v
  Image roughness;   // gray, of half the size
};

/// `surface` has colors and texture coordinates; lengths are centimeters. Triangles that take up far more of the
/// texture than of the surface are left out. Width and height are even. The same numbers for the same mesh. Throws std::bad_alloc.
SkinMaps make_skin_maps(const Surface& surface, const SkinLayout& layout, int width, int height);

/// Papillae of the tongue of the generated head. u is 1/2 along the middle below, 0 and 1 along the middle above; v goes
/// from the root to the tip.
Image make_tongue_normals(int width, int height);

}  // namespace mien::render
