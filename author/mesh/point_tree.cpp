// SPDX-License-Identifier: MIT
#include "author/mesh/point_tree.h"

#include <algorithm>

namespace mien::author {

namespace {

double along(Vec3 p, uint32_t axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

constexpr uint32_t kLeafPoints = 8;

}  // namespace

struct PointTree::Query {
  Vec3 at;
  uint32_t wanted;
  uint32_t found;
  Near* out;  // sorted

  void offer(Near near) {
    if (found == wanted && !(near < out[found - 1])) return;
    uint32_t at_slot = found < wanted ? found++ : found - 1;
    for (; at_slot > 0 && near < out[at_slot - 1]; --at_slot) out[at_slot] = out[at_slot - 1];
    out[at_slot] = near;
  }
};

bool PointTree::build(Span<const Vec3> points, Arena& arena) {
  points_ = points;
  order_ = arena.array<uint32_t>(points.count);
  splits_ = arena.array<uint8_t>(points.count);
  sorted_ = arena.unwritten_array<Vec3>(points.count);
  if (sorted_.count != points.count) return false;
  if (order_.count != points.count || splits_.count != points.count) return false;
  for (uint32_t i = 0; i < order_.count; ++i) order_[i] = i;
  struct Range {
    uint32_t from, to;
  } stack[64];
  uint32_t depth = 0;
  stack[depth++] = {0, static_cast<uint32_t>(points.count)};
  while (depth > 0) {
    const Range range = stack[--depth];
    if (range.to - range.from <= kLeafPoints) continue;
    Vec3 low = points[order_[range.from]], high = low;
    for (uint32_t i = range.from; i < range.to; ++i) {
      const Vec3 p = points[order_[i]];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3 size = high - low;
    const uint32_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = range.from + (range.to - range.from) / 2;
    std::nth_element(order_.data + range.from, order_.data + middle, order_.data + range.to,
                     [&](uint32_t a, uint32_t b) {
                       const double pa = along(points[a], axis), pb = along(points[b], axis);
                       return pa != pb ? pa < pb : a < b;
                     });
    splits_[middle] = static_cast<uint8_t>(axis);
    // The halves are equal, so at most 64 ranges wait at a time.
    stack[depth++] = {range.from, middle};
    stack[depth++] = {middle + 1, range.to};
  }
  for (uint32_t i = 0; i < order_.count; ++i) sorted_[i] = points[order_[i]];
  return true;
}

void PointTree::search(Query& query, uint32_t from, uint32_t to) const {
  const auto look_at = [&](uint32_t slot) {
    const Vec3 d = sorted_[slot] - query.at;
    query.offer({dot(d, d), order_[slot]});
  };
  if (to - from <= kLeafPoints) {
    for (uint32_t i = from; i < to; ++i) look_at(i);
    return;
  }
  const uint32_t middle = from + (to - from) / 2;
  const uint32_t axis = splits_[middle];
  const double offset = along(query.at, axis) - along(sorted_[middle], axis);
  look_at(middle);
  const bool below = offset < 0;
  if (below) {
    search(query, from, middle);
  } else {
    search(query, middle + 1, to);
  }
  // Also search on equal distance: that point may have a lower index.
  if (query.found < query.wanted ||
      offset * offset <= query.out[query.found - 1].squared_distance) {
    if (below) {
      search(query, middle + 1, to);
    } else {
      search(query, from, middle);
    }
  }
}

struct PointTree::Ball {
  Vec3 at;
  double squared_distance;
  uint32_t found, capacity;
  Near* out;
};

void PointTree::collect(Ball& ball, uint32_t from, uint32_t to) const {
  const auto look_at = [&](uint32_t slot) {
    const Vec3 d = sorted_[slot] - ball.at;
    const double squares = dot(d, d);
    if (!(squares <= ball.squared_distance)) return;
    if (ball.found < ball.capacity) ball.out[ball.found] = {squares, order_[slot]};
    ++ball.found;
  };
  if (to - from <= kLeafPoints) {
    for (uint32_t i = from; i < to; ++i) look_at(i);
    return;
  }
  const uint32_t middle = from + (to - from) / 2;
  const uint32_t axis = splits_[middle];
  const double offset = along(ball.at, axis) - along(sorted_[middle], axis);
  const bool across = offset * offset <= ball.squared_distance;
  if (offset <= 0 || across) collect(ball, from, middle);
  look_at(middle);
  if (offset >= 0 || across) collect(ball, middle + 1, to);
}

uint32_t PointTree::within(Vec3 at, double squared_distance, uint32_t capacity, Near* out) const {
  Ball ball = {at, squared_distance, 0, capacity, out};
  collect(ball, 0, static_cast<uint32_t>(points_.count));
  return ball.found;
}

void PointTree::range_of(Vec3 at, uint32_t least, uint32_t& from, uint32_t& to) const {
  from = 0;
  to = static_cast<uint32_t>(points_.count);
  while (to - from > kLeafPoints) {
    const uint32_t middle = from + (to - from) / 2;
    const uint32_t axis = splits_[middle];
    const bool below = along(at, axis) < along(sorted_[middle], axis);
    const uint32_t inner_from = below ? from : middle + 1, inner_to = below ? middle : to;
    if (inner_to - inner_from < least) return;
    from = inner_from;
    to = inner_to;
  }
}

Near PointTree::nearest(Vec3 at) const {
  Near out = {0, 0};
  nearest(at, 1, &out);
  return out;
}

uint32_t PointTree::nearest(Vec3 at, uint32_t wanted, Near* out) const {
  Query query = {at, wanted, 0, out};
  search(query, 0, static_cast<uint32_t>(points_.count));
  return query.found;
}

}  // namespace mien::author
