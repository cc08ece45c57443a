// SPDX-License-Identifier: MIT
// A triangle mesh, and a tree that finds its position nearest to a point.
//
//     | MienFitSurface | positions | normals | triangles | triangles around positions | tree |
#pragma once

#include "capi/include/mien_solve.h"
#include "runtime/base/allocator.h"
#include "runtime/base/span.h"

constexpr uint32_t kFitSurfaceTag = 0x6D53'5246;

struct MienFitSurface {
  uint32_t tag = 0;
  mien::Allocator allocator;
  size_t block_size = 0;
  mien::Span<float> positions;                // [position][3]
  mien::Span<float> normals;                  // [position][3], unit length, outward
  mien::Span<uint32_t> triangles;             // [triangle][3]; positions in one place are one
  mien::Span<uint32_t> first_around, around;  // triangles of each position
  mien::Span<uint8_t> borders;                // [position] an edge of one triangle ends there
  // The tree: the middle of a range splits it by the coordinate of its axis; each half likewise.
  mien::Span<uint32_t> order;  // positions that triangles have
  mien::Span<uint8_t> axes;    // [place in `order`]
  mien::Span<float> boxes;     // [middle of a range][low, high position, low, high normal][3]
};

namespace mien {

struct SurfacePoint {
  double position[3], normal[3];
  bool border = false;
};

/// The place nearest to a point whose normal is within 60 degrees of `normal`; of any normal if that is 0.
/// False if there is none nearer than `reach`.
bool find_nearest(const MienFitSurface& surface, const double* point, const double* normal,
                  double reach, SurfacePoint& out);

/// Twice the signed volume between triangles and their mean: above 0 if they are wound outward.
double signed_volume(const float* positions, const uint32_t* triangles, size_t triangle_count);

}  // namespace mien
