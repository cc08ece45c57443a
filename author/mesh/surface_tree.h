// SPDX-License-Identifier: MIT
// Distances to a surface of triangles, by a tree of boxes.
#pragma once

#include "author/mesh/topology.h"

namespace mien::author {

/// A place on a triangle.
struct SurfacePoint {
  uint32_t triangle = 0;
  double weights[3] = {1, 0, 0};  // of its corners; they sum to 1
  double distance = 0;
};

class SurfaceTree {
 public:
  /// Keeps both; `triangles` has three numbers of `points` each and is not empty. False if memory
  /// ran out.
  bool build(Span<const Vec3> points, Span<const uint32_t> triangles, Arena& arena);

  double distance(Vec3 at) const;
  SurfacePoint nearest(Vec3 at) const;

 private:
  struct Node {
    Box box;
    uint32_t first = 0, count = 0;  // of order_; count is 0 where there are children
    uint32_t child = 0;             // the first; the other comes after it
  };
  void split(uint32_t node, uint32_t first, uint32_t count);
  struct Best {
    double squares;
    uint32_t triangle;
  };
  void search(uint32_t node, Vec3 at, Best& best) const;

  Span<const Vec3> points_;
  Span<const uint32_t> triangles_;
  Span<uint32_t> order_;
  Span<Node> nodes_;
  uint32_t used_ = 0;
};

}  // namespace mien::author
