// SPDX-License-Identifier: MIT
// Surfaces as the stages of one picture see them: in view space, numbered through, nothing missing.
#pragma once

#include <vector>

#include "integrations/program/render/cornea.h"
#include "integrations/program/render/render.h"
#include "integrations/program/render/visibility.h"

namespace mien::render {

struct PlacedSurface {
  Surface surface;
  std::vector<math::Vec3> places;       // positions in view space
  std::vector<math::Vec3> own_normals;  // of each position, in model space, if the surface has none
  std::vector<math::Vec3> colors;       // linear, of each position; empty: one for all
  std::vector<float> bends;             // of each position, as in Fragment; empty: 0
  IrisPlane iris;
  math::Vec3 color;
  float facing;  // 1 or -1: times the winding's normal it is on the side of the normals
  uint32_t first_number;

  bool hides_all() const;  // its alpha is 1 everywhere
  TriangleList triangles() const;
  math::Vec3 normal(size_t vertex) const;
};

/// One place of a surface, in view space.
struct Fragment {
  const PlacedSurface* on;
  uint32_t triangle;
  math::Vec3 place, normal, to_eye, color;
  float roughness;
  math::Vec3 smooth;  // the normal without that of a texture
  float bend;  // curvature of the surface, in 1 / mm if a head with a bust is as large as the scene
};

class Scene {
 public:
  /// `pixel` is the size of a pixel at a distance of 1; `scale` as in RenderOptions.
  Scene(const std::vector<Surface>& surfaces, const Camera& camera, float pixel, float scale = 0);

  const std::vector<PlacedSurface>& surfaces() const { return surfaces_; }
  /// Triangles are numbered from 1 on.
  const PlacedSurface& surface_of(uint32_t number) const;
  /// Where the line of sight along `ray` (z is -1) meets the plane of a triangle.
  Fragment fragment(uint32_t number, math::Vec3 ray) const;
  /// The alpha where a ray meets the plane of a triangle.
  float alpha(uint32_t number, math::Vec3 origin, math::Vec3 ray) const;

  float scale() const {
    return scale_;
  }  // of the options, or the diagonal of the box around everything

 private:
  Camera camera_;
  float pixel_;
  std::vector<PlacedSurface> surfaces_;
  float scale_ = 1;
};

}  // namespace mien::render
