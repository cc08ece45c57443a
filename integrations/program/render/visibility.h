// SPDX-License-Identifier: MIT
// Which triangle is seen where: triangles in view space -> depth and number of the nearest one at
// every sample of every pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "integrations/program/math/vector.h"
#include "integrations/program/render/camera.h"

namespace mien::render {

/// From view space (x right, y up, z towards the viewer) to pixels (x right, y down).
struct Lens {
  bool perspective = true;  // else parallel, as light from far away
  float focal = 1;          // pixels per unit, at distance 1 if perspective
  float center_x = 0, center_y = 0;
  float near = 1e-3f;  // of a perspective: what is nearer than this is cut off

  /// Larger is nearer: 1 / distance, or z. Linear across the picture of a triangle in both cases.
  float depth_of(math::Vec3 p) const { return perspective ? 1 / -p.z : p.z; }
};

/// Of a picture of that size.
Lens make_lens(const Camera& camera, int width, int height);

/// Where the samples lie within a pixel, in 1/256 of its width.
struct SamplePattern {
  int count;
  const int16_t (*places)[2];
};

/// 1 (the center), 4 or 16 samples; of 4 and 16, no two share a row or a column, so that edges
/// that are nearly horizontal or vertical come out as smooth as others.
SamplePattern sample_pattern(int count);

/// What one sample sees; both are 0 where nothing is.
struct Seen {
  float depth = 0;
  uint32_t triangle = 0;
};

/// Sample `s` of pixel (x, y) is entry (y * width + x) * samples + s.
struct Visibility {
  int width = 0, height = 0, samples = 0;
  std::vector<Seen> seen;

  const Seen& at(int x, int y, int sample) const {
    return seen[(size_t(y) * size_t(width) + size_t(x)) * size_t(samples) + size_t(sample)];
  }

  /// Everything empty.
  void reset(int new_width, int new_height, int new_samples);
};

constexpr int kMaxPixels = 8192;  // along one side

/// Triangles of `positions`, numbered from `first_number` on. Corner k of triangle t is
/// position `positions_of[corners[3 * t + k]]`, or `corners[3 * t + k]` if `positions_of` is null.
/// Both sides show. Of equal depths the triangle drawn first stays. Triangles that are not finite,
/// or name a position that is not there, are left out.
struct TriangleList {
  const math::Vec3* positions;  // in view space
  size_t position_count;
  const uint32_t* positions_of;
  size_t vertex_count;
  const uint32_t* corners;
  size_t count;
  uint32_t first_number;

  /// Numbers of the positions at its corners. False if one is not there.
  bool corner_indices(size_t triangle, size_t (&out)[3]) const;
  bool corner_positions(size_t triangle, math::Vec3 (&out)[3]) const;
};

/// How much of a triangle hides what is behind it at a place of the picture, 0 to 1.
using Coverage = std::function<float(uint32_t number, float x, float y)>;

/// With `coverage`, a triangle is drawn to that share of the samples around a place; each triangle takes others, so
/// that layers add up.
void draw(const TriangleList& triangles, const Lens& lens, Visibility& out,
          const Coverage& coverage = nullptr);

}  // namespace mien::render
