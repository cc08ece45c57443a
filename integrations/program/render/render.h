// SPDX-License-Identifier: MIT
// Surfaces, a camera and the light of a small studio -> a picture. One thread, no randomness: the
// same scene gives the same picture.
//
//     positions -> visibility (depth and triangle per sample)
//               -> pixel layer (place and normal per pixel) -> occlusion
//     light's view -> shadow map                                        \ -> light -> picture
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "integrations/program/math/vector.h"
#include "integrations/program/render/camera.h"
#include "integrations/program/render/image.h"

namespace mien::render {

class Texture;

/// How a surface takes light.
struct Material {
  Color color = {205, 170, 150};
  float softness = 0.35f;   // how far light reaches around into shadow, as in skin
  float roughness = 0.45f;  // 0.05 is wet, 0.6 chalk
  float reflectance = 0.03f;
  float alpha = 1;  // how much of what is behind it the surface hides
};

/// The clear front of an eye, before an iris that the color texture shows around its middle, as it is seen from the
/// front.
struct Cornea {
  float depth =
      0;           // from the apex to the plane of the iris, in radii of the iris; 0: there is none
  float iris = 0;  // radius of the iris in the texture
};

/// Triangles as a deformer gives them. The arrays stay the caller's.
struct Surface {
  const float* positions = nullptr;  // x y z each
  size_t position_count = 0;
  const float* normals = nullptr;  // x y z of each vertex; null: made from the triangles
  const uint32_t* vertex_position_indices = nullptr;  // null: vertex i is position i
  size_t vertex_count = 0;
  const uint32_t* triangles = nullptr;  // three vertices each
  size_t triangle_count = 0;
  const uint8_t* colors = nullptr;  // sRGB of each position; null: the color of the material
  // Bit k of a triangle: a wireframe leaves out the edge from corner k to the next. Null: it has
  // all.
  const uint8_t* inner_edges = nullptr;
  // u v of each vertex, (0, 0) at the lower left of the image; null: no textures.
  const float* texture_coordinates = nullptr;
  // Each may be null. The color (sRGB) and its alpha are multiplied by those of the material, the roughness, which is
  // green, takes the place of the material's; normals are tangent space, green towards larger v.
  const Texture *color_texture = nullptr, *normal_texture = nullptr, *roughness_texture = nullptr;
  Material material;
  Cornea cornea;
};

struct Backdrop {
  Color center = {92, 97, 104};
  Color edge = {38, 41, 46};
};

struct RenderOptions {
  int width = 640, height = 640;
  int samples = 4;  // per pixel: 1, 4 or 16
  bool wireframe = false;
  Backdrop backdrop;
  // Size of the subject, which hollows and the softness of shadows are measured by; 0: that of the
  // box around all surfaces.
  float scale = 0;
  std::function<void(double share)> progress;  // called now and then while an image is made
};

/// Surfaces hide what is behind them at a share of the samples of a pixel, their alpha: with one sample, where it is
/// at least half. Corners that are not finite, degenerate triangles and indices past the end are left out. Width
/// and height are 1 to 8192. Throws std::bad_alloc.
Image render_image(const std::vector<Surface>& surfaces, const Camera& camera,
                   const RenderOptions& options);

}  // namespace mien::render
