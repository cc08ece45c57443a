// SPDX-License-Identifier: MIT
#include "integrations/program/render/visibility.h"

#include <cassert>

namespace mien::render {

using namespace math;

namespace {

// Corners are rounded to this part of a pixel. From there on edges are exact integers: triangles
// that share an edge share every sample of it between them, without gap or overlap.
constexpr int kSubpixels = 256;

// What leaves this border around the image is cut before it is rounded, so that integers hold it.
constexpr float kGuard = 2.0f * kMaxPixels;

constexpr int16_t kOne[1][2] = {{128, 128}};
// A square turned until its corners have rows and columns of their own.
constexpr int16_t kFour[4][2] = {{96, 32}, {224, 96}, {32, 160}, {160, 224}};
// Column i, row i with its four bits reversed: a Hammersley set.
constexpr int16_t kSixteen[16][2] = {
    {8, 8},    {24, 136},  {40, 72},  {56, 200},  {72, 40},  {88, 168},  {104, 104}, {120, 232},
    {136, 24}, {152, 152}, {168, 88}, {184, 216}, {200, 56}, {216, 184}, {232, 120}, {248, 248}};

struct Corner {
  int32_t x, y;  // in subpixels
  float depth;
};

int64_t area2(const Corner& a, const Corner& b, const Corner& c) {
  return int64_t{b.x - a.x} * (c.y - a.y) - int64_t{b.y - a.y} * (c.x - a.x);
}

/// Samples that lie on an edge belong to the triangle for which it is a top or left edge. With y
/// down and corners clockwise on the screen (positive area), those edges go right, or up.
bool owns_edge(const Corner& a, const Corner& b) { return a.y == b.y ? b.x > a.x : b.y < a.y; }

/// One edge as a function that is >= 0 at samples inside: at the first pixel, per step, and per
/// sample.
template <class Int>
struct Edge {
  Int start, step_x, step_y;
  Int at_sample[16];
  Int max;  // of at_sample

  void set(const Corner& a, const Corner& b, int32_t first_x, int32_t first_y,
           const SamplePattern& pattern) {
    const Int dx = b.x - a.x, dy = b.y - a.y;
    // Right of a step to the right is down: inside is where the cross product is positive.
    start = dx * Int(first_y - a.y) - dy * Int(first_x - a.x) - (owns_edge(a, b) ? 0 : 1);
    step_x = -dy * kSubpixels;
    step_y = dx * kSubpixels;
    for (int s = 0; s < pattern.count; ++s) {
      at_sample[s] = dx * pattern.places[s][1] - dy * pattern.places[s][0];
    }
    max = *std::max_element(at_sample, at_sample + pattern.count);
  }
};

struct PixelRange {
  int x0, y0, x1, y1;  // the last ones are not part of it
};

struct DepthPlane {
  float start, step_x, step_y, min, max;
  float at_sample[16];

  void set(const Corner& a, const Corner& b, const Corner& c, int64_t area, int32_t first_x,
           int32_t first_y, const SamplePattern& pattern) {
    const double ab = double(b.depth) - a.depth, ac = double(c.depth) - a.depth;
    const double share = 1 / double(area);
    const double gx = (ab * (c.y - a.y) - ac * (b.y - a.y)) * share;
    const double gy = (ac * (b.x - a.x) - ab * (c.x - a.x)) * share;
    start = float(a.depth + gx * (first_x - a.x) + gy * (first_y - a.y));
    step_x = float(gx * kSubpixels);
    step_y = float(gy * kSubpixels);
    for (int s = 0; s < pattern.count; ++s) {
      at_sample[s] = float(gx * pattern.places[s][0] + gy * pattern.places[s][1]);
    }
    // The plane of a sliver is steep: rounding must not carry a sample past the corners.
    min = std::min({a.depth, b.depth, c.depth});
    max = std::max({a.depth, b.depth, c.depth});
  }
};

/// Whether a sample shows a triangle of that coverage.
bool shows(float coverage, uint32_t number, uint32_t sample, uint32_t count) {
  const uint32_t order = (sample * 5 + (number * 2654435761u >> 16)) % count;
  return coverage * float(count) >= float(order) + 0.5f;
}

template <class Int>
void fill(const Corner (&t)[3], int64_t area, const PixelRange& range, const SamplePattern& pattern,
          uint32_t number, const Coverage& coverage, Visibility& out) {
  const int32_t first_x = range.x0 * kSubpixels, first_y = range.y0 * kSubpixels;
  Edge<Int> e0, e1, e2;
  e0.set(t[0], t[1], first_x, first_y, pattern);
  e1.set(t[1], t[2], first_x, first_y, pattern);
  e2.set(t[2], t[0], first_x, first_y, pattern);
  DepthPlane plane;
  plane.set(t[0], t[1], t[2], area, first_x, first_y, pattern);

  Int r0 = e0.start, r1 = e1.start, r2 = e2.start;
  for (int y = range.y0; y < range.y1; ++y) {
    const float row_depth = plane.start + plane.step_y * float(y - range.y0);
    const size_t first = (size_t(y) * size_t(out.width) + size_t(range.x0)) * size_t(pattern.count);
    Seen* seen = out.seen.data() + first;
    Int p0 = r0, p1 = r1, p2 = r2;
    for (int x = range.x0; x < range.x1;
         ++x, p0 += e0.step_x, p1 += e1.step_x, p2 += e2.step_x, seen += pattern.count) {
      // Most pixels of the box around a small triangle are outside of it.
      if (((p0 + e0.max) | (p1 + e1.max) | (p2 + e2.max)) < 0) continue;
      const float pixel_depth = row_depth + plane.step_x * float(x - range.x0);
      for (int s = 0; s < pattern.count; ++s) {
        const Int outside =
            (p0 + e0.at_sample[s]) | (p1 + e1.at_sample[s]) | (p2 + e2.at_sample[s]);
        if (outside < 0) continue;
        const float d = std::min(std::max(pixel_depth + plane.at_sample[s], plane.min), plane.max);
        if (!(d > seen[s].depth)) continue;
        if (coverage) {
          const float px = float(x) + float(pattern.places[s][0]) / kSubpixels;
          const float py = float(y) + float(pattern.places[s][1]) / kSubpixels;
          const float share = coverage(number, px, py);
          if (!shows(share, number, uint32_t(s), uint32_t(pattern.count))) continue;
        }
        seen[s] = {d, number};
      }
    }
    r0 += e0.step_y;
    r1 += e1.step_y;
    r2 += e2.step_y;
  }
}

/// A triangle whose corners lie within the guard border.
void draw_corners(Corner a, Corner b, Corner c, uint32_t number, const SamplePattern& pattern,
                  const Coverage& coverage, Visibility& out) {
  int64_t area = area2(a, b, c);
  if (area == 0) return;
  if (area < 0) {
    std::swap(b, c);
    area = -area;
  }
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
  // Floor of the first and the last subpixel, as pixels.
  const PixelRange range = {std::max(left >> 8, 0), std::max(top >> 8, 0),
                            std::min((right >> 8) + 1, out.width),
                            std::min((bottom >> 8) + 1, out.height)};
  if (range.x0 >= range.x1 || range.y0 >= range.y1) return;

  const Corner corners[3] = {a, b, c};
  // The functions of edges stay below twice the square of the extent.
  const bool small = right - left < 96 * kSubpixels && bottom - top < 96 * kSubpixels;
  small ? fill<int32_t>(corners, area, range, pattern, number, coverage, out)
        : fill<int64_t>(corners, area, range, pattern, number, coverage, out);
}

/// A polygon in view space that planes are cutting off. Five planes add at most five corners.
struct Polygon {
  Vec3 corners[8];
  int count = 0;

  /// Keeps the side where `inside(corner)` is positive; it is linear.
  template <class Inside>
  void cut(Inside inside) {
    Polygon kept;
    for (int i = 0; i < count; ++i) {
      const Vec3 a = corners[i], b = corners[(i + 1) % count];
      const float da = inside(a), db = inside(b);
      if (da >= 0) kept.corners[kept.count++] = a;
      if ((da >= 0) != (db >= 0)) kept.corners[kept.count++] = mix(a, b, da / (da - db));
    }
    *this = kept;
  }
};

class Drawing {
 public:
  Drawing(const TriangleList& triangles, const Lens& lens, const Coverage& coverage,
          Visibility& out)
      : triangles_(triangles), lens_(lens), pattern_(sample_pattern(out.samples)),
        coverage_(coverage), out_(out), projected_(triangles.position_count) {
    for (size_t i = 0; i < projected_.size(); ++i) {
      const Vec3 p = triangles.positions[i];
      projected_[i].good = is_finite(p) && project(p, projected_[i].corner);
    }
  }

  void add(size_t triangle) {
    size_t at[3];
    if (!triangles_.corner_indices(triangle, at)) return;
    const Projected &a = projected_[at[0]], &b = projected_[at[1]], &c = projected_[at[2]];
    const uint32_t number = triangles_.first_number + uint32_t(triangle);
    if (a.good && b.good && c.good) {
      draw_corners(a.corner, b.corner, c.corner, number, pattern_, coverage_, out_);
      return;
    }
    const Vec3* p = triangles_.positions;
    const Vec3 view[3] = {p[at[0]], p[at[1]], p[at[2]]};
    if (is_finite(view[0]) && is_finite(view[1]) && is_finite(view[2])) cut_and_add(view, number);
  }

 private:
  struct Projected {
    Corner corner;
    bool good;
  };

  /// False if it lies before the near plane or past the guard border.
  bool project(Vec3 p, Corner& out) const {
    float scale = lens_.focal;
    if (lens_.perspective) {
      if (!(p.z <= -lens_.near)) return false;
      scale /= -p.z;
    }
    const float x = p.x * scale, y = p.y * scale;
    if (!(std::fabs(x) <= kGuard && std::fabs(y) <= kGuard)) return false;
    out = {int32_t(std::lrint((lens_.center_x + x) * kSubpixels)),
           int32_t(std::lrint((lens_.center_y - y) * kSubpixels)), lens_.depth_of(p)};
    return std::isfinite(out.depth);
  }

  void cut_and_add(const Vec3 (&view)[3], uint32_t number) {
    Polygon polygon;
    for (const Vec3& corner : view) polygon.corners[polygon.count++] = corner;
    // A little inside of what project() takes, whatever the rounding of the cut.
    const float near = lens_.near * 1.001f, slope = kGuard * 0.999f / lens_.focal;
    const bool perspective = lens_.perspective;
    const auto reach = [&](Vec3 p) { return slope * (perspective ? -p.z : 1.0f); };
    if (perspective) polygon.cut([&](Vec3 p) { return -p.z - near; });
    polygon.cut([&](Vec3 p) { return reach(p) - p.x; });
    polygon.cut([&](Vec3 p) { return reach(p) + p.x; });
    polygon.cut([&](Vec3 p) { return reach(p) - p.y; });
    polygon.cut([&](Vec3 p) { return reach(p) + p.y; });

    Corner corners[8];
    for (int i = 0; i < polygon.count; ++i) {
      if (!project(polygon.corners[i], corners[i])) return;  // numbers too large to cut
    }
    for (int i = 2; i < polygon.count; ++i) {
      draw_corners(corners[0], corners[i - 1], corners[i], number, pattern_, coverage_, out_);
    }
  }

  const TriangleList& triangles_;
  const Lens& lens_;
  SamplePattern pattern_;
  const Coverage& coverage_;
  Visibility& out_;
  std::vector<Projected> projected_;  // of each position: most are corners of six triangles
};

}  // namespace

Lens make_lens(const Camera& camera, int width, int height) {
  Lens lens;
  lens.center_x = float(width) / 2;
  lens.center_y = float(height) / 2;
  lens.focal =
      float(std::min(width, height)) / 2 / std::tan(camera.field_of_view * 0.008726646259971648f);
  lens.near = std::max(camera.distance * 0.01f, 1e-12f);
  return lens;
}

SamplePattern sample_pattern(int count) {
  switch (count) {
    case 4: return {4, kFour};
    case 16: return {16, kSixteen};
    default: return {1, kOne};
  }
}

void Visibility::reset(int new_width, int new_height, int new_samples) {
  assert(new_width > 0 && new_height > 0 && new_width <= kMaxPixels && new_height <= kMaxPixels);
  width = new_width;
  height = new_height;
  samples = sample_pattern(new_samples).count;
  const size_t count = size_t(width) * size_t(height) * size_t(samples);
  seen.assign(count, Seen{});
}

bool TriangleList::corner_indices(size_t triangle, size_t (&out)[3]) const {
  for (size_t k = 0; k < 3; ++k) {
    size_t at = corners[3 * triangle + k];
    if (positions_of) {
      if (at >= vertex_count) return false;
      at = positions_of[at];
    }
    if (at >= position_count) return false;
    out[k] = at;
  }
  return true;
}

bool TriangleList::corner_positions(size_t triangle, Vec3 (&out)[3]) const {
  size_t at[3];
  if (!corner_indices(triangle, at)) return false;
  for (size_t k = 0; k < 3; ++k) out[k] = positions[at[k]];
  return true;
}

void draw(const TriangleList& triangles, const Lens& lens, Visibility& out,
          const Coverage& coverage) {
  Drawing drawing(triangles, lens, coverage, out);
  for (size_t t = 0; t < triangles.count; ++t) drawing.add(t);
}

}  // namespace mien::render
