// SPDX-License-Identifier: MIT
#include "author/mesh/silhouette.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/mesh/topology.h"

namespace mien::author {

namespace {

constexpr int kCells = 256;    // along each side of the image
constexpr double kBeside = 2;  // cells from the edge to the place that must be empty

}  // namespace

bool Silhouette::make(Span<const Vec3> positions, Span<const uint32_t> corners, Vec3 view,
                      Arena& arena) {
  if (!author::make(arena, size_t{kCells} * kCells, covered_)) return false;
  view_ = view;
  right_ = cross({0, 1, 0}, view);
  const Box box = bounding_box(positions);
  // The image is as wide as the diagonal, so the mesh is in it from every side.
  cell_ = box.diagonal() / kCells;
  if (!(cell_ > 0)) cell_ = 1;
  origin_ = (box.low + box.high) * 0.5;
  for (size_t c = 0; c < corners.count; c += 3) {
    cover(flat(positions[corners[c]]), flat(positions[corners[c + 1]]),
          flat(positions[corners[c + 2]]));
  }
  return true;
}

/// In cells.
Vec3 Silhouette::flat(Vec3 p) const {
  p = (p - origin_) * (1 / cell_);
  return {dot(p, right_) + kCells / 2, p.y + kCells / 2, 0};
}

/// Cells whose middle is in the triangle.
void Silhouette::cover(Vec3 a, Vec3 b, Vec3 c) {
  const auto first = [](double x) { return std::clamp(static_cast<int>(x - 0.5), 0, kCells - 1); };
  const auto last = [](double x) { return std::clamp(static_cast<int>(x + 0.5), 0, kCells - 1); };
  const int x_end = last(std::max({a.x, b.x, c.x})), y_end = last(std::max({a.y, b.y, c.y}));
  for (int y = first(std::min({a.y, b.y, c.y})); y <= y_end; ++y) {
    for (int x = first(std::min({a.x, b.x, c.x})); x <= x_end; ++x) {
      const Vec3 at = {x + 0.5, y + 0.5, 0};
      const double ab = cross(b - a, at - a).z, bc = cross(c - b, at - b).z;
      const double ca = cross(a - c, at - c).z;
      if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) {
        covered_[static_cast<size_t>(y * kCells + x)] = 1;
      }
    }
  }
}

bool Silhouette::is_outline(Vec3 from, Vec3 to, Vec3 inner) const {
  const Vec3 a = flat(from), along = flat(to) - a, inward = flat(inner) - a;
  Vec3 out = normalized(Vec3{along.y, -along.x, 0});
  if (dot(out, inward) > 0) out = out * -1;
  const Vec3 at = a + along * 0.5 + out * kBeside;
  const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
  if (x < 0 || y < 0 || x >= kCells || y >= kCells) return true;
  return !covered_[static_cast<size_t>(y * kCells + x)];
}

}  // namespace mien::author
