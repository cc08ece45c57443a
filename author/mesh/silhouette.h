// SPDX-License-Identifier: MIT
// The silhouette of a mesh, as an image of cells.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"

namespace mien::author {

class Silhouette {
 public:
  /// Of the triangles with these corners, three each, seen along `view`, a horizontal direction of length 1. There is
  /// at least one triangle. False if memory ran out.
  bool make(Span<const Vec3> positions, Span<const uint32_t> corners, Vec3 view, Arena& arena);

  /// Whether an edge is on the outline. It is one where the surface turns away from the view; `inner` is the third
  /// corner of a triangle beside it. So this tells it from edges in front of other parts of the surface.
  bool is_outline(Vec3 from, Vec3 to, Vec3 inner) const;

 private:
  Vec3 flat(Vec3 p) const;
  void cover(Vec3 a, Vec3 b, Vec3 c);

  Vec3 view_, right_, origin_;
  double cell_ = 1;
  Span<uint8_t> covered_;  // kCells rows from the bottom up, each from left to right
};

}  // namespace mien::author
