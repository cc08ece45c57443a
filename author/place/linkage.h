// SPDX-License-Identifier: MIT
// Groups points on a line by average linkage: the two groups with the least mean distance over all
// pairs of their points merge, until one group is left.
//
// On a line the mean distance of two groups that do not overlap is the difference of their means.
// For groups in the order A, B, C the distance of A and C is no less than that of A and B, so a
// closest pair is always adjacent, and by induction groups stay intervals. A heap of adjacent pairs
// therefore gives exactly the partition of the general method, in O(n log n).
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"

namespace mien::author {

struct Merge {
  double distance;    // mean distance of the two groups
  uint32_t boundary;  // first point of the upper group, in the order of the values
};

struct Linkage {
  Span<uint32_t> order;  // points by value, of equal ones the first
  Span<Merge> merges;    // all of them, in their order: points - 1

  /// First places in `order` of the groups when `count` are left (1 <= count <= points), ascending.
  void group_starts(uint32_t count, uint32_t* out) const;
};

/// Weights: empty for 1 each. `values` is not empty. False if memory ran out.
bool link_on_line(Span<const double> values, Span<const double> weights, Arena& arena,
                  Arena& scratch, Linkage& out);

/// Average linkage on distances in space, to compare with. With more than kMaxLinked points, cells
/// of neighbors are linked, each as a point at its mean with their weight. `group` gets the number
/// of each point's group, those with the largest mean z first; boundaries of the merges mean
/// nothing. At least `groups` points. False if memory ran out.
bool link_in_space(Span<const Vec3> points, Span<const double> weights, uint32_t groups,
                   Arena& arena, Arena& scratch, Linkage& out, Span<uint8_t> group);
constexpr uint32_t kMaxLinked = 2048;

}  // namespace mien::author
