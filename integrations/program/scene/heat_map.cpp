// SPDX-License-Identifier: MIT
#include "integrations/program/scene/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integrations/program/render/label.h"

namespace mien::cli {

namespace {

using math::saturate;
using render::Color;
using render::Image;

struct Stop {
  float at;
  Color color;
};

// Gray where nothing moves, then warmer and finally darker, so that the order can be read without
// color vision.
constexpr Stop kStops[] = {{0.00f, {168, 170, 172}}, {0.04f, {176, 172, 160}},
                           {0.20f, {240, 205, 96}},  {0.45f, {240, 128, 40}},
                           {0.72f, {205, 40, 44}},   {1.00f, {112, 8, 74}}};

/// Position on the legend, 0..1. Small movements get more of it than their share.
float legend_position(float share) { return std::sqrt(saturate(share)); }

std::string amount(float value, const std::string& unit) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g ", static_cast<double>(value));
  return text + unit;
}

void draw_legend(Image& image, int y, int height, float max_distance, const std::string& unit,
                 Color ink) {
  const float size = std::clamp(static_cast<float>(height) * 0.36f, 9.0f, 20.0f);
  const int left = render::SheetLayout::kGap + static_cast<int>(size), right = image.width - left;
  const int bar = static_cast<int>(size * 0.7f), top = y + static_cast<int>(size * 0.3f);
  const float baseline = static_cast<float>(top + bar) + size * 1.15f;
  for (int x = left; x < right; ++x) {
    // The inverse of legend_position(): colors change evenly along the bar.
    const float t = static_cast<float>(x - left) / static_cast<float>(right - left - 1);
    image.fill(x, top, 1, bar, heat_color(t * t));
  }
  if (max_distance == 0) {
    draw_text(image, static_cast<float>(left), baseline, "nothing moves", size, ink);
    return;
  }
  for (const float share : {0.0f, 0.1f, 0.25f, 0.5f, 1.0f}) {
    const std::string text = share == 0 ? "0" : amount(max_distance * share, unit);
    const float width = render::text_width(text, size);
    const float middle =
        static_cast<float>(left) + legend_position(share) * static_cast<float>(right - left);
    const float x =
        std::clamp(middle - width / 2, static_cast<float>(left), static_cast<float>(right) - width);
    draw_text(image, x, baseline, text, size, ink);
  }
}

/// The neutral shape in the colors of the heat map. The surfaces point into `colors`.
std::vector<render::Surface> heat_surfaces(const Influence& influence,
                                           std::vector<render::Surface> surfaces,
                                           std::vector<std::vector<uint8_t>>& colors) {
  const float max_distance = influence.max_distance();
  colors.resize(surfaces.size());
  for (size_t m = 0; m < surfaces.size(); ++m) {
    const MeshMotion& motion = influence.meshes[m];
    for (const float distance : motion.distances) {
      const Color color = heat_color(max_distance > 0 ? distance / max_distance : 0);
      colors[m].insert(colors[m].end(), {color.r, color.g, color.b});
    }
    surfaces[m].colors = colors[m].data();
    surfaces[m].positions = motion.mesh->neutral.positions.data;
    surfaces[m].normals = motion.mesh->neutral.normals.data;
    surfaces[m].material.softness = 0.1f;
    surfaces[m].material.roughness = 0.6f;
  }
  return surfaces;
}

}  // namespace

Color heat_color(float share) {
  const float t = legend_position(share);
  size_t i = 1;
  while (i + 1 < std::size(kStops) && kStops[i].at < t) ++i;
  const Stop &a = kStops[i - 1], &b = kStops[i];
  return render::to_srgb(
      mix(to_linear(a.color), to_linear(b.color), saturate((t - a.at) / (b.at - a.at))));
}

Image draw_heat_map(const PosedScene& scene, const Influence& influence,
                    const HeatMapOptions& options) {
  render::RenderOptions render = options.render;
  render.scale = length(scene.neutral_box().size());
  const std::vector<render::Surface> posed = scene.surfaces();
  std::vector<std::vector<uint8_t>> colors;

  const render::Size size = {render.width, render.height};
  render::Sheet sheet({2, 2, size, true}, render.backdrop);
  const std::string name(short_name(influence.control.name));
  sheet.add(render_image(heat_surfaces(influence, posed, colors), options.camera, render),
            "where " + name + " moves");
  sheet.add(render_image(posed, options.camera, render),
            name + " = " + amount(influence.value, ""));

  const Image& tiles = sheet.image();
  const int legend = std::clamp(size.height / 10, 24, 56);
  Image image(tiles.width, tiles.height + legend, tiles.at(0, 0));
  image.paste(tiles, 0, 0);
  draw_legend(image, tiles.height, legend, influence.max_distance(), scene.unit(),
              render::page_colors(render.backdrop).text);
  return image;
}

}  // namespace mien::cli
