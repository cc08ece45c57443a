// SPDX-License-Identifier: MIT
#include "author/document/warp.h"

#include <algorithm>
#include <cmath>

#include "author/fit/procrustes.h"

namespace mien::author {

namespace {

constexpr uint32_t kNearest = 96;  // points that decide on a motion

/// The determinant of a symmetric 4x4 matrix by its 2x2 minors, and the longest column of its adjugate, which is
/// an eigenvector if the determinant is 0. Returns the square of its length.
double longest_adjugate(const double (&a)[4][4], double& determinant, double (&out)[4]) {
  const double s0 = a[0][0] * a[1][1] - a[1][0] * a[0][1],
               s1 = a[0][0] * a[1][2] - a[1][0] * a[0][2],
               s2 = a[0][0] * a[1][3] - a[1][0] * a[0][3],
               s3 = a[0][1] * a[1][2] - a[1][1] * a[0][2],
               s4 = a[0][1] * a[1][3] - a[1][1] * a[0][3],
               s5 = a[0][2] * a[1][3] - a[1][2] * a[0][3],
               c5 = a[2][2] * a[3][3] - a[3][2] * a[2][3],
               c4 = a[2][1] * a[3][3] - a[3][1] * a[2][3],
               c3 = a[2][1] * a[3][2] - a[3][1] * a[2][2],
               c2 = a[2][0] * a[3][3] - a[3][0] * a[2][3],
               c1 = a[2][0] * a[3][2] - a[3][0] * a[2][2],
               c0 = a[2][0] * a[3][1] - a[3][0] * a[2][1];
  determinant = s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
  const double columns[4][4] = {
      {a[1][1] * c5 - a[1][2] * c4 + a[1][3] * c3, -a[1][0] * c5 + a[1][2] * c2 - a[1][3] * c1,
       a[1][0] * c4 - a[1][1] * c2 + a[1][3] * c0, -a[1][0] * c3 + a[1][1] * c1 - a[1][2] * c0},
      {-a[0][1] * c5 + a[0][2] * c4 - a[0][3] * c3, a[0][0] * c5 - a[0][2] * c2 + a[0][3] * c1,
       -a[0][0] * c4 + a[0][1] * c2 - a[0][3] * c0, a[0][0] * c3 - a[0][1] * c1 + a[0][2] * c0},
      {a[3][1] * s5 - a[3][2] * s4 + a[3][3] * s3, -a[3][0] * s5 + a[3][2] * s2 - a[3][3] * s1,
       a[3][0] * s4 - a[3][1] * s2 + a[3][3] * s0, -a[3][0] * s3 + a[3][1] * s1 - a[3][2] * s0},
      {-a[2][1] * s5 + a[2][2] * s4 - a[2][3] * s3, a[2][0] * s5 - a[2][2] * s2 + a[2][3] * s1,
       -a[2][0] * s4 + a[2][1] * s2 - a[2][3] * s0, a[2][0] * s3 - a[2][1] * s1 + a[2][2] * s0}};
  double longest = -1;
  for (const double(&column)[4] : columns) {
    double squares = 0;
    for (double value : column) squares += value * value;
    if (!(squares > longest)) continue;
    longest = squares;
    std::copy(column, column + 4, out);
  }
  return longest;
}

/// closest_rotation() where it is well defined, in a tenth of the time: the largest eigenvalue of the quadratic
/// form by Newton's method from above, `bound`, which is near it for points that move much alike.
void rotation_of(const Vec3 map[3], double bound, Vec3 rows[3]) {
  const Vec3 &a = map[0], &b = map[1], &c = map[2];
  double form[4][4] = {{a.x + b.y + c.z, c.y - b.z, a.z - c.x, b.x - a.y},
                       {c.y - b.z, a.x - b.y - c.z, a.y + b.x, a.z + c.x},
                       {a.z - c.x, a.y + b.x, b.y - a.x - c.z, b.z + c.y},
                       {b.x - a.y, a.z + c.x, b.z + c.y, c.z - a.x - b.y}};
  double q[4], constant = 0;
  longest_adjugate(form, constant, q);
  const double square = -2 * (dot(a, a) + dot(b, b) + dot(c, c));
  const double linear = -8 * dot(a, cross(b, c));
  double value = bound;
  for (int i = 0; i < 20; ++i) {  // value^4 + square * value^2 + linear * value + constant
    const double squared = value * value;
    const double slope = 4 * squared * value + 2 * square * value + linear;
    const double height = (squared + square) * squared + linear * value + constant;
    const double step = height / slope;
    if (!(std::abs(step) > 1e-15 * bound)) break;
    value -= step;
  }
  for (int k = 0; k < 4; ++k) form[k][k] -= value;
  double unused = 0;
  const double squares = longest_adjugate(form, unused, q);
  const double cube = bound * bound * bound;
  if (!(squares > 1e-12 * cube * cube)) return closest_rotation(map, 1, rows);
  const double by = (q[0] < 0 ? -1 : 1) / std::sqrt(squares);
  const double w = q[0] * by, x = q[1] * by, y = q[2] * by, z = q[3] * by;
  rows[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)};
  rows[1] = {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)};
  rows[2] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
}

bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// Squared distance between two boxes.
double squares_between(const Box& a, const Box& b) {
  const auto gap = [](double low, double high, double other_low, double other_high) {
    return std::max(std::max(other_low - high, low - other_high), 0.0);
  };
  const Vec3 gaps = {gap(a.low.x, a.high.x, b.low.x, b.high.x),
                     gap(a.low.y, a.high.y, b.low.y, b.high.y),
                     gap(a.low.z, a.high.z, b.low.z, b.high.z)};
  return dot(gaps, gaps);
}

}  // namespace

bool Warp::build(Span<const Vec3> before, Span<const Vec3> after, Arena& arena) {
  constexpr size_t kBlock = 32;
  before_ = before;
  after_ = after;
  moved_ = arena.array<Box>(before.count / kBlock + 1);
  if (moved_.empty() || !tree_.build(before, arena)) return false;
  size_t blocks = 0;
  for (size_t first = 0; first < before.count; first += kBlock) {
    bool any = false;
    for (size_t i = first; i < std::min(first + kBlock, before.count); ++i) {
      const uint32_t point = tree_.order()[i];
      if (same(before[point], after[point])) continue;
      if (!any) moved_[blocks] = {before[point], before[point]};
      add(moved_[blocks], before[point]);
      any = true;
    }
    blocks += any;
  }
  mostly_moves_ = blocks > moved_.count / 2;
  moved_ = moved_.first(blocks);
  return true;
}

bool Warp::stays(Vec3 place, WarpHint& hint) const {
  if (moved_.empty()) return true;
  // Where most move, looking costs more than it saves.
  if (before_.count < kNearest || mostly_moves_) return false;
  uint32_t from = 0, to = 0;
  tree_.range_of(place, kNearest, from, to);
  Box bounds = hint.bounds;
  if (from != hint.from || to != hint.to) {
    bounds = {before_[tree_.order()[from]], before_[tree_.order()[from]]};
    for (uint32_t i = from; i < to; ++i) add(bounds, before_[tree_.order()[i]]);
  }
  Box all = bounds;
  add(all, place);
  const bool inside = same(all.low, bounds.low) && same(all.high, bounds.high);
  if (inside && from == hint.from && to == hint.to) return hint.stays;
  // The nearest points are no farther than these.
  const Vec3 size = all.high - all.low;
  const double reach = dot(size, size) * (1 + 1e-12);
  bool stays = true;
  for (const Box& moved : moved_) {
    if (squares_between(moved, all) <= reach) stays = false;
  }
  if (inside) {
    hint.from = from;
    hint.to = to;
    hint.bounds = bounds;
    hint.stays = stays;
  }
  return stays;
}

Similarity Warp::at(Vec3 place, WarpHint& hint) const {
  const uint32_t wanted = static_cast<uint32_t>(std::min<size_t>(kNearest, before_.count));
  constexpr uint32_t kCapacity = 8 * kNearest;
  Near near[kCapacity];
  uint32_t count = 0;
  const double distance = length(place - hint.place);
  if (distance <= hint.radius) {
    // The ball around this place that holds the one around the place before.
    const double radius = (hint.radius + distance) * (1 + 1e-12);
    count = tree_.within(place, radius * radius, kCapacity, near);
  }
  if (count < wanted || count > kCapacity) {
    count = tree_.nearest(place, wanted, near);
    const double radius = near[count - 1].squared_distance;
    count = tree_.within(place, radius, kCapacity, near);  // in the order of the tree
    // Where hundreds are in one place, any of them will do.
    if (count > kCapacity) count = tree_.nearest(place, wanted, near);
  }
  if (count > wanted) {
    Near order[kCapacity];
    std::copy(near, near + count, order);
    std::nth_element(order, order + wanted - 1, order + count);
    const Near last = order[wanted - 1];
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
      if (!(last < near[i])) near[kept++] = near[i];
    }
    count = kept;
  }
  bool still = true;
  double squared_radius = 0;
  for (uint32_t i = 0; i < count; ++i) {
    squared_radius = std::max(squared_radius, near[i].squared_distance);
    still = still && same(before_[near[i].point], after_[near[i].point]);
  }
  hint.place = place;
  hint.radius = std::sqrt(squared_radius);
  Similarity out;
  if (still) return out;

  // Falls to 0 at the farthest one; one that is at the place itself nearly decides alone.
  const double radius = squared_radius * 1.0001 + 1e-300;
  const double softening = radius * 1e-4;
  double weights[kNearest], sum = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const double fall = 1 - near[i].squared_distance / radius;
    weights[i] = std::max(fall * fall, 1e-6) / (near[i].squared_distance + softening);
    sum += weights[i];
  }
  for (uint32_t i = 0; i < count; ++i) {
    out.from = out.from + before_[near[i].point] * (weights[i] / sum);
    out.to = out.to + after_[near[i].point] * (weights[i] / sum);
  }
  Vec3 map[3];  // sum of y x^T: its closest rotation turns x to y
  double old_size = 0, new_size = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 x = before_[near[i].point] - out.from, y = after_[near[i].point] - out.to;
    map[0] = map[0] + x * (weights[i] * y.x);
    map[1] = map[1] + x * (weights[i] * y.y);
    map[2] = map[2] + x * (weights[i] * y.z);
    old_size += weights[i] * dot(x, x);
    new_size += weights[i] * dot(y, y);
  }
  Vec3 rows[3];
  rotation_of(map, std::sqrt(old_size * new_size), rows);
  for (int r = 0; r < 3; ++r) {
    out.turn.m[0][r] = rows[r].x;
    out.turn.m[1][r] = rows[r].y;
    out.turn.m[2][r] = rows[r].z;
  }
  if (old_size > 0 && new_size > 0) out.scale = std::sqrt(new_size / old_size);
  return out;
}

}  // namespace mien::author
