// SPDX-License-Identifier: MIT
// Marks on top of an image, where things lie that surfaces hide: dots and bones.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/render/camera.h"
#include "integrations/program/render/image.h"

namespace mien::render {

/// Pixels, from the upper left corner.
struct Spot {
  float x = 0, y = 0;
  bool seen = false;  // in front of the viewer
};

/// Where a point is in an image of that size.
Spot find_spot(const Camera& camera, Size size, math::Vec3 point);

/// A disc with a dark rim.
void draw_dot(Image& image, Spot at, float radius, Color color);

/// A bone, thick where it begins: as octahedra are drawn. A dot if it has no length.
void draw_bone(Image& image, Spot from, Spot to, Color color);

/// What colors mean, one line for each, in the upper left corner.
struct LegendLine {
  Color color;
  std::string text;
};
void draw_legend(Image& image, const std::vector<LegendLine>& lines, float size, Color ink);

}  // namespace mien::render
