// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/surface.h"

#include <algorithm>
#include <cmath>

namespace mien::gltf {

namespace {

using math::Vec3d;

/// Weights of the corners at the point of a triangle that is nearest to p: inside, or on an edge.
void nearest_weights(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p,
                     double (&weights)[3]) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double bb = dot(ab, ab), cc = dot(ac, ac), bc = dot(ab, ac);
  const double pb = dot(ap, ab), pc = dot(ap, ac), area = bb * cc - bc * bc;
  if (area > 0) {
    const double v = (cc * pb - bc * pc) / area, w = (bb * pc - bc * pb) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      weights[0] = 1 - v - w, weights[1] = v, weights[2] = w;
      return;
    }
  }
  const Vec3d corners[3] = {a, b, c};
  double best = HUGE_VAL;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vec3d edge = corners[j] - corners[i];
    const double squared = dot(edge, edge);
    const double t = squared > 0 ? std::clamp(dot(p - corners[i], edge) / squared, 0.0, 1.0) : 0.0;
    const Vec3d off = corners[i] + edge * t - p;
    if (dot(off, off) >= best) continue;
    best = dot(off, off);
    weights[0] = weights[1] = weights[2] = 0;
    weights[i] = 1 - t;
    weights[j] = t;
  }
}

constexpr int64_t kCells = 128;  // along the longest side

}  // namespace

Surface::Surface(std::vector<Vec3d> positions, std::vector<uint32_t> triangles)
    : positions_(std::move(positions)), triangles_(std::move(triangles)) {
  for (const Vec3d& p : positions_) box_.add(p);
  const Vec3d size = box_.size();
  size_ = std::max({size.x, size.y, size.z, 1e-9}) / kCells;
  for (uint32_t t = 0; t < triangles_.size() / 3; ++t) {
    math::Boxd around;
    for (size_t k = 0; k < 3; ++k) around.add(positions_[triangles_[size_t{3} * t + k]]);
    int64_t from[3], to[3];
    const Vec3d center = around.center(), half = around.size() * 0.5;
    for (int i = 0; i < 3; ++i) {
      const double start = box_.center()[i] - size[i] / 2;
      from[i] = static_cast<int64_t>(std::floor((center[i] - half[i] - start) / size_));
      to[i] = static_cast<int64_t>(std::floor((center[i] + half[i] - start) / size_));
    }
    for (int64_t x = from[0]; x <= to[0]; ++x) {
      for (int64_t y = from[1]; y <= to[1]; ++y) {
        for (int64_t z = from[2]; z <= to[2]; ++z) cells_[cell_of(x, y, z)].push_back(t);
      }
    }
  }
}

uint64_t Surface::cell_of(int64_t x, int64_t y, int64_t z) const {
  return static_cast<uint64_t>((x + 1) * 1000000 + (y + 1) * 1000 + (z + 1));
}

void Surface::see(uint32_t triangle, const Vec3d& point, SurfacePoint& best) const {
  const uint32_t* corners = &triangles_[size_t{3} * triangle];
  const Vec3d a = positions_[corners[0]], b = positions_[corners[1]], c = positions_[corners[2]];
  SurfacePoint found{triangle, {}, 0};
  nearest_weights(a, b, c, point, found.weights);
  found.distance =
      length(a * found.weights[0] + b * found.weights[1] + c * found.weights[2] - point);
  if (found.distance < best.distance) best = found;
}

SurfacePoint Surface::nearest(const Vec3d& point) const {
  SurfacePoint best;
  best.distance = HUGE_VAL;
  const Vec3d start = box_.center() - box_.size() * 0.5;
  int64_t cell[3];
  for (int i = 0; i < 3; ++i) {
    const double at = std::floor((point[i] - start[i]) / size_);
    cell[i] = static_cast<int64_t>(std::clamp(at, -1.0, double(kCells) + 1));
  }
  const bool inside = [&] {
    for (int i = 0; i < 3; ++i) {
      if (point[i] < start[i] - size_ || point[i] > start[i] + box_.size()[i] + size_) return false;
    }
    return true;
  }();
  // Shells of cells around it; outside of the box distances to cells are not those of their numbers.
  for (int64_t shell = 0; inside && shell <= kCells; ++shell) {
    for (int64_t x = -shell; x <= shell; ++x) {
      for (int64_t y = -shell; y <= shell; ++y) {
        for (int64_t z = -shell; z <= shell; ++z) {
          if (std::max({std::abs(x), std::abs(y), std::abs(z)}) != shell) continue;
          const int64_t at[3] = {cell[0] + x, cell[1] + y, cell[2] + z};
          if (std::min({at[0], at[1], at[2]}) < 0 || std::max({at[0], at[1], at[2]}) > kCells) {
            continue;
          }
          const auto found = cells_.find(cell_of(at[0], at[1], at[2]));
          if (found == cells_.end()) continue;
          for (const uint32_t t : found->second) see(t, point, best);
        }
      }
    }
    if (best.distance <= double(shell) * size_) return best;
    if (shell == 16 && best.distance == HUGE_VAL) break;  // far away: all triangles are as quick
  }
  for (uint32_t t = 0; t < triangles_.size() / 3; ++t) see(t, point, best);
  return best;
}

}  // namespace mien::gltf
