// SPDX-License-Identifier: MIT
// Nearest points by a k-d tree. Of equally distant points the one with the lowest index counts, so
// answers do not depend on how the tree was built.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"

namespace mien::author {

struct Near {
  double squared_distance;
  uint32_t point;

  bool operator<(const Near& other) const {
    return squared_distance != other.squared_distance ? squared_distance < other.squared_distance
                                                      : point < other.point;
  }
};

class PointTree {
 public:
  /// Keeps `points`. False if memory ran out.
  bool build(Span<const Vec3> points, Arena& arena);

  /// `points` is not empty.
  Near nearest(Vec3 at) const;
  /// Up to `wanted` points, the nearest first; returns how many.
  uint32_t nearest(Vec3 at, uint32_t wanted, Near* out) const;

  /// All points whose squared distance is at most this, in the order of the tree, which does not depend on
  /// `at`. Returns how many there are; `out` gets the first `capacity`.
  uint32_t within(Vec3 at, double squared_distance, uint32_t capacity, Near* out) const;

  /// Numbers of points in the order of the tree: near each other, for the most part.
  Span<const uint32_t> order() const { return order_; }
  /// The smallest part of order() with at least `least` points, or all of it, into which the splits of the tree
  /// put a place. It has less than 2 * least + 2 points, if there are as many.
  void range_of(Vec3 at, uint32_t least, uint32_t& from, uint32_t& to) const;

 private:
  struct Query;
  struct Ball;
  void search(Query& query, uint32_t from, uint32_t to) const;
  void collect(Ball& ball, uint32_t from, uint32_t to) const;

  Span<const Vec3> points_;
  Span<Vec3> sorted_;     // the points in this order
  Span<uint32_t> order_;  // each range: its middle splits it, along the axis in splits_
  Span<uint8_t> splits_;
};

}  // namespace mien::author
