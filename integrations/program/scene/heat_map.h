// SPDX-License-Identifier: MIT
// An image of what a control moves.
#pragma once

#include <string>

#include "integrations/program/render/sheet.h"
#include "integrations/program/scene/influence.h"

namespace mien::cli {

/// The color of a share of the largest movement, 0 to 1: gray where there is none. Small shares get more
/// than theirs of the scale, which goes by their square root.
render::Color heat_color(float share);

struct HeatMapOptions {
  render::RenderOptions render;  // of one of the two images; its scale is set here
  render::Camera camera;
};

/// Two images side by side: the neutral shape, colored by how far each position moves, and the shape
/// with the control set. A legend below them explains the colors. The scene has to be in the pose
/// of the control, as find_influence() leaves it.
render::Image draw_heat_map(const PosedScene& scene, const Influence& influence,
                            const HeatMapOptions& options);

}  // namespace mien::cli
