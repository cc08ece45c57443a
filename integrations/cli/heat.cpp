// SPDX-License-Identifier: MIT
#include "integrations/cli/heat.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integrations/picture/label.h"

namespace mien::cli {

namespace {

using picture::Color;
using picture::Image;
using picture::Vec3;

struct Stop {
  float at;
  Color color;
};

// Clay where nothing moves, then warmer and at last darker, so that the order shows without
// colors.
constexpr Stop kStops[] = {{0.00f, {168, 170, 172}}, {0.04f, {176, 172, 160}},
                           {0.20f, {240, 205, 96}},  {0.45f, {240, 128, 40}},
                           {0.72f, {205, 40, 44}},   {1.00f, {112, 8, 74}}};

/// Small movements get more of the scale than they have.
float spread(float share) { return std::sqrt(picture::saturate(share)); }

Color heat_colour(float share) {
  const float t = spread(share);
  size_t i = 1;
  while (i + 1 < std::size(kStops) && kStops[i].at < t) ++i;
  const Stop &a = kStops[i - 1], &b = kStops[i];
  return picture::to_srgb(
      mix(to_linear(a.color), to_linear(b.color), picture::saturate((t - a.at) / (b.at - a.at))));
}

std::string amount(float value, const std::string& unit) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g ", static_cast<double>(value));
  return text + unit;
}

/// The scale of the colors, with what they mean.
void draw_legend(Image& image, int y, int height, float most, const std::string& unit, bool dark) {
  const Color ink = dark ? Color{214, 216, 218} : Color{40, 42, 46};
  const float size = std::clamp(static_cast<float>(height) * 0.36f, 9.0f, 20.0f);
  const int left = Sheet::kGap + static_cast<int>(size), right = image.width - left;
  const int bar = static_cast<int>(size * 0.7f), top = y + static_cast<int>(size * 0.3f);
  for (int x = left; x < right; ++x) {
    // Along the bar the colors are even; what they stand for is not.
    const float t = static_cast<float>(x - left) / static_cast<float>(right - left - 1);
    image.fill(x, top, 1, bar, heat_colour(t * t));
  }
  if (most == 0) {
    picture::draw_text(image, static_cast<float>(left),
                       static_cast<float>(top + bar) + size * 1.15f, "nothing moves", size, ink);
    return;
  }
  for (const float share : {0.0f, 0.1f, 0.25f, 0.5f, 1.0f}) {
    const std::string text = share == 0 ? "0" : amount(most * share, unit);
    const float width = picture::text_width(text, size);
    const float middle =
        static_cast<float>(left) + spread(share) * static_cast<float>(right - left);
    const float x =
        std::clamp(middle - width / 2, static_cast<float>(left), static_cast<float>(right) - width);
    picture::draw_text(image, x, static_cast<float>(top + bar) + size * 1.15f, text, size, ink);
  }
}

/// The shape at rest, colored. `colors` has the arrays that the surfaces point into.
std::vector<picture::Surface> heated(const Influence& influence,
                                     std::vector<picture::Surface> surfaces,
                                     std::vector<std::vector<uint8_t>>& colors) {
  const float most = influence.most();
  for (size_t m = 0; m < surfaces.size(); ++m) {
    const MeshMotion& motion = influence.meshes[m];
    std::vector<uint8_t> painted;
    for (const float distance : motion.distances) {
      const Color color = heat_colour(most > 0 ? distance / most : 0);
      painted.insert(painted.end(), {color.r, color.g, color.b});
    }
    colors.push_back(std::move(painted));
    surfaces[m].colors = colors.back().data();
    surfaces[m].positions = motion.mesh->neutral.positions.data;
    surfaces[m].normals = motion.mesh->neutral.normals.data;
    surfaces[m].material.softness = 0.1f;
    surfaces[m].material.roughness = 0.6f;
  }
  return surfaces;
}

}  // namespace

Image draw_heat(Subject& subject, const Influence& influence, const PictureOptions& options) {
  const Size size = parse_size(options.size, {480, 480});
  picture::RenderOptions render = parse_render_options(options, size);
  render.scale = length(subject.neutral_box().size());
  const picture::Camera camera = aim(subject, options.target, parse_camera(options.camera), size);
  const std::vector<picture::Surface> posed = subject.surfaces();
  std::vector<std::vector<uint8_t>> colors;
  colors.reserve(posed.size());  // surfaces point into them

  Sheet sheet(2, 2, size, render.backdrop, true);
  const std::string name(short_name(influence.control.name));
  sheet.add(picture::render(heated(influence, posed, colors), camera, render),
            "where " + name + " moves");
  sheet.add(picture::render(posed, camera, render), name + " = " + amount(influence.value, ""));

  const Image& tiles = sheet.image();
  const int legend = std::clamp(size.height / 10, 24, 56);
  const bool dark = render.backdrop.edge.g < 128;
  Image image(tiles.width, tiles.height + legend, tiles.at(0, 0));
  image.paste(tiles, 0, 0);
  draw_legend(image, tiles.height, legend, influence.most(), subject.unit(), dark);
  return image;
}

}  // namespace mien::cli
