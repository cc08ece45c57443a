// SPDX-License-Identifier: MIT
#include "integrations/program/render/marks.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/render/label.h"
#include "integrations/program/render/visibility.h"

namespace mien::render {

using namespace math;

namespace {

constexpr Color kRim = {24, 26, 29};

/// Fills what lies within `distance(x, y)` < 0, in pixels, with a rim of `rim` around it.
template <class Distance>
void fill_shape(Image& image, float left, float top, float right, float bottom, float rim,
                Color color, const Distance& distance) {
  const int x0 = std::max(int(left - rim - 1), 0), y0 = std::max(int(top - rim - 1), 0);
  const int x1 = std::min(int(right + rim + 2), image.width);
  const int y1 = std::min(int(bottom + rim + 2), image.height);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      const float d = distance(float(x) + 0.5f, float(y) + 0.5f);
      const float outer = saturate(0.5f + rim - d), inner = saturate(0.5f - d);
      if (outer <= 0) continue;
      image.blend(x, y, kRim, outer);
      image.blend(x, y, color, inner);
    }
  }
}

/// Larger values would not fit an int.
bool is_drawable(Spot spot) {
  return spot.seen && std::fabs(spot.x) < 1e6f && std::fabs(spot.y) < 1e6f;
}

}  // namespace

Spot find_spot(const Camera& camera, Size size, Vec3 point) {
  const Lens lens = make_lens(camera, size.width, size.height);
  const Vec3 p = camera.to_view(point);
  if (!(-p.z > lens.near)) return {};
  return {lens.center_x + p.x / -p.z * lens.focal, lens.center_y - p.y / -p.z * lens.focal, true};
}

void draw_dot(Image& image, Spot at, float radius, Color color) {
  if (!is_drawable(at)) return;
  fill_shape(image, at.x - radius, at.y - radius, at.x + radius, at.y + radius,
             std::max(radius * 0.25f, 0.8f), color,
             [&](float x, float y) { return std::hypot(x - at.x, y - at.y) - radius; });
}

void draw_bone(Image& image, Spot from, Spot to, Color color) {
  if (!is_drawable(from) || !is_drawable(to)) return;
  const float dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  const float half = std::clamp(length * 0.09f, 3.0f, 10.0f);
  if (length > 2 * half) {
    // Along the bone from 0 to 1, the half width rises to `half` at a fifth and falls to nothing.
    const auto distance = [&](float x, float y) {
      const float along = ((x - from.x) * dx + (y - from.y) * dy) / (length * length);
      const float aside = std::fabs((x - from.x) * dy - (y - from.y) * dx) / length;
      const float width = along < 0.2f ? along / 0.2f : (1 - along) / 0.8f;
      return aside - half * width;
    };
    fill_shape(image, std::min(from.x, to.x) - half, std::min(from.y, to.y) - half,
               std::max(from.x, to.x) + half, std::max(from.y, to.y) + half, 1.2f, color, distance);
  }
  draw_dot(image, from, half * 0.75f, color);
}

void draw_legend(Image& image, const std::vector<LegendLine>& lines, float size, Color ink) {
  float y = size * 0.6f;
  for (const LegendLine& line : lines) {
    const int box = int(size * 0.8f);
    image.fill(int(size * 0.6f), int(y), box, box, line.color);
    draw_text(image, size * 0.9f + float(box), y + size * 0.75f, line.text, size, ink);
    y += size * 1.35f;
  }
}

}  // namespace mien::render
