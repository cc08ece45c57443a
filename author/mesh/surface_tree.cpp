// SPDX-License-Identifier: MIT
#include "author/mesh/surface_tree.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"

namespace mien::author {

namespace {

constexpr uint32_t kLeafFaces = 4;

double part(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

double squares_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 along = b - a;
  const double size = dot(along, along);
  const double t = size > 0 ? std::min(std::max(dot(p - a, along) / size, 0.0), 1.0) : 0;
  const Vec3 d = p - a - along * t;
  return dot(d, d);
}

double squares_to_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = cross(b - a, c - a);
  const bool is_above = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                        dot(cross(a - c, p - c), n) >= 0;
  if (is_above && !is_zero(n)) {
    const double height = dot(p - a, n);
    return height * height / dot(n, n);
  }
  return std::min(
      {squares_to_segment(p, a, b), squares_to_segment(p, b, c), squares_to_segment(p, c, a)});
}

double squares_to_box(Vec3 p, const Box& box) {
  double squares = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = std::max({part(box.low, i) - part(p, i), part(p, i) - part(box.high, i), 0.0});
    squares += d * d;
  }
  return squares;
}

}  // namespace

bool SurfaceTree::build(Span<const Vec3> points, Span<const uint32_t> triangles, Arena& arena) {
  points_ = points;
  triangles_ = triangles;
  const size_t count = triangles.count / 3;
  if (!make(arena, count, order_) || !make(arena, 2 * count, nodes_)) return false;
  for (uint32_t t = 0; t < count; ++t) order_[t] = t;
  used_ = 1;
  split(0, 0, static_cast<uint32_t>(count));
  return true;
}

void SurfaceTree::split(uint32_t node, uint32_t first, uint32_t count) {
  Box box = {points_[triangles_[3 * order_[first]]], points_[triangles_[3 * order_[first]]]};
  for (uint32_t i = first; i < first + count; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = points_[triangles_[3 * order_[i] + static_cast<uint32_t>(k)]];
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
  }
  nodes_[node].box = box;
  nodes_[node].first = first;
  if (count <= kLeafFaces) {
    nodes_[node].count = count;
    return;
  }
  const Vec3 size = box.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto center = [&](uint32_t t) {
    return part(points_[triangles_[3 * t]], axis) + part(points_[triangles_[3 * t + 1]], axis) +
           part(points_[triangles_[3 * t + 2]], axis);
  };
  const uint32_t half = count / 2;
  std::nth_element(order_.data + first, order_.data + first + half, order_.data + first + count,
                   [&](uint32_t a, uint32_t b) {
                     const double x = center(a), y = center(b);
                     return x != y ? x < y : a < b;
                   });
  const uint32_t child = used_;
  used_ += 2;
  nodes_[node].child = child;
  split(child, first, half);
  split(child + 1, first + half, count - half);
}

void SurfaceTree::search(uint32_t node, Vec3 at, Best& best) const {
  const Node& n = nodes_[node];
  for (uint32_t i = n.first; i < n.first + n.count; ++i) {
    const uint32_t* c = &triangles_[3 * order_[i]];
    const double squares = squares_to_triangle(at, points_[c[0]], points_[c[1]], points_[c[2]]);
    if (squares < best.squares) best = {squares, order_[i]};
  }
  if (n.count > 0) return;
  double near = squares_to_box(at, nodes_[n.child].box);
  double far = squares_to_box(at, nodes_[n.child + 1].box);
  uint32_t first = n.child, second = n.child + 1;
  if (far < near) {
    std::swap(near, far);
    std::swap(first, second);
  }
  if (near < best.squares) search(first, at, best);
  if (far < best.squares) search(second, at, best);
}

double SurfaceTree::distance(Vec3 at) const {
  Best best{std::numeric_limits<double>::infinity(), 0};
  search(0, at, best);
  return std::sqrt(best.squares);
}

SurfacePoint SurfaceTree::nearest(Vec3 at) const {
  Best best{std::numeric_limits<double>::infinity(), 0};
  search(0, at, best);
  SurfacePoint out;
  out.triangle = best.triangle;
  out.distance = std::sqrt(best.squares);
  const uint32_t* c = &triangles_[3 * best.triangle];
  const Vec3 corners[3] = {points_[c[0]], points_[c[1]], points_[c[2]]};
  // Inside: shares of the area. Else the nearest place on an edge.
  const Vec3 n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double area = dot(n, n);
  double least = std::numeric_limits<double>::infinity();
  if (area > 0) {
    double shares[3];
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = corners[(k + 1) % 3], b = corners[(k + 2) % 3];
      shares[k] = dot(cross(b - a, at - a), n) / area;
    }
    if (shares[0] >= 0 && shares[1] >= 0 && shares[2] >= 0) {
      std::copy(shares, shares + 3, out.weights);
      return out;
    }
  }
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Vec3 edge = corners[next] - corners[k];
    const double squares = dot(edge, edge);
    double t = squares > 0 ? dot(at - corners[k], edge) / squares : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    const Vec3 gap = at - (corners[k] + edge * t);
    if (!(dot(gap, gap) < least)) continue;
    least = dot(gap, gap);
    out.weights[0] = out.weights[1] = out.weights[2] = 0;
    out.weights[k] = 1 - t;
    out.weights[next] = t;
  }
  return out;
}

}  // namespace mien::author
