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
  std::vector<float> roughness;

  size_t index(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
};

/// How open each pixel is to the sky, 0..1, from the layer alone: how much of what lies within
/// `radius` rises above its tangent plane.
std::vector<float> find_openness(const PixelLayer& layer, const Lens& lens, float radius);

/// What a lamp far away sees.
class ShadowMap {
 public:
  /// `to_light` is in view space, as everything.
  ShadowMap(const Scene& scene, math::Vec3 to_light, int size);

  /// Share of the lamp that a place gets, 0..1, with soft borders.
  float light_at(math::Vec3 place, math::Vec3 normal) const;

 private:
  math::Vec3 right_, up_, back_;
  Lens lens_;
  float texel_ = 0;       // in units of the scene
  float depth_zero_ = 0;  // keeps depths positive
  Visibility map_;
};

}  // namespace mien::render
