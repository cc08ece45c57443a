// SPDX-License-Identifier: MIT
// What keeps light out: hollows (of the sky), and whatever stands before a lamp.
#pragma once

#include <vector>

#include "integrations/program/render/scene.h"
#include "integrations/program/render/visibility.h"

namespace mien::render {

/// The nearest surface of each pixel.
struct PixelLayer {
  int width = 0, height = 0;
  std::vector<float> distance;  // from the viewer's plane; 0 where nothing is
  std::vector<math::Vec3> normal, smooth, color;
  std::vector<float> roughness, bend;

  size_t index(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
};

/// How open each pixel is to the sky, 0..1, from the layer alone: how much of what lies within
/// `radius` rises above its tangent plane. What is near counts most.
std::vector<float> find_openness(const PixelLayer& layer, const Lens& lens, float radius);

/// Evens out what pixels of a tile found in different directions: means over as many pixels as a tile is wide,
/// along rows and columns. Those further apart than `depth` are left out.
void even_out(const PixelLayer& layer, std::vector<float>& values, float depth);

/// Which of the directions of a tile a pixel probes in.
inline int turn_of(int x, int y) { return y % 4 * 4 + x % 4; }

/// What a lamp far away sees. Shadows are the softer the farther they fall (Fernando 2005, "Percentage-closer soft
/// shadows").
class ShadowMap {
 public:
  /// `to_light` is in view space, as everything; `softness` is the tangent of half the angle that the lamp takes up.
  ShadowMap(const Scene& scene, math::Vec3 to_light, int size, float softness);

  /// Share of the lamp that a place gets, 0..1. It is probed in some directions of a tile only.
  float light_at(math::Vec3 place, math::Vec3 normal, int turn) const;

 private:
  float depth_at(float x, float y) const;

  math::Vec3 right_, up_, back_;
  Lens lens_;
  float softness_;
  float texel_ = 0;       // in units of the scene
  float depth_zero_ = 0;  // keeps depths positive
  float search_ = 0;      // texels: how wide a shadow's border may be
  int size_;
  std::vector<float> depths_;
};

}  // namespace mien::render
