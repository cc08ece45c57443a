// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/place/linkage.h"

namespace mien::author {

namespace {

/// Points that are linked as one: order[first] ... order[first + count - 1].
struct Cell {
  uint32_t first, count;
};

double part(Vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// Halves the cells along their longest sides until there are kMaxLinked.
uint32_t make_cells(Span<const Vec3> points, Span<uint32_t> order, Span<Cell> cells) {
  uint32_t count = 1;
  cells[0] = {0, static_cast<uint32_t>(points.count)};
  for (uint32_t halved = 1; halved < cells.count; halved = count) {
    for (uint32_t c = 0; c < halved && count < cells.count; ++c) {
      const Cell cell = cells[c];
      if (cell.count < 2) continue;
      uint32_t* begin = order.data + cell.first;
      Vec3 low = points[begin[0]], high = low;
      for (uint32_t i = 1; i < cell.count; ++i) {
        const Vec3 p = points[begin[i]];
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
      const Vec3 size = high - low;
      const int axis = size.z >= size.y && size.z >= size.x ? 2 : size.y >= size.x ? 1 : 0;
      const uint32_t half = cell.count / 2;
      std::nth_element(begin, begin + half, begin + cell.count, [&](uint32_t a, uint32_t b) {
        const double x = part(points[a], axis), y = part(points[b], axis);
        return x != y ? x < y : a < b;
      });
      cells[c] = {cell.first, half};
      cells[count++] = {cell.first + half, cell.count - half};
    }
    if (count == halved) break;
  }
  return count;
}

struct Node {
  Vec3 mean;
  double weight = 0;
  uint32_t parent = 0;  // in a forest of merged nodes
  bool active = true;
};

struct NodeMerge {
  double distance;
  uint32_t into, from;
};

/// Average linkage by chains of nearest neighbors. A pair of nodes that are nearest to each other
/// stays one whatever else merges, so pairs may merge in any order.
void link_nodes(Span<Node> nodes, Span<double> distances, Span<uint32_t> chain,
                Span<NodeMerge> merges) {
  const uint32_t n = static_cast<uint32_t>(nodes.count);
  const auto distance = [&](uint32_t a, uint32_t b) -> double& {
    return distances[size_t{a} * n + b];
  };
  uint32_t length = 0, merged = 0, first = 0;
  while (merged + 1 < n) {
    if (length == 0) {
      while (!nodes[first].active) ++first;
      chain[length++] = first;
    }
    const uint32_t top = chain[length - 1];
    uint32_t next = length > 1 ? chain[length - 2] : n;
    double best = length > 1 ? distance(top, next) : std::numeric_limits<double>::infinity();
    for (uint32_t i = 0; i < n; ++i) {
      if (i == top || !nodes[i].active || !(distance(top, i) < best)) continue;
      best = distance(top, i);
      next = i;
    }
    if (length < 2 || next != chain[length - 2]) {
      chain[length++] = next;
      continue;
    }
    length -= 2;
    const uint32_t into = std::min(top, next), from = std::max(top, next);
    merges[merged++] = {best, into, from};
    const double a = nodes[into].weight, b = nodes[from].weight;
    for (uint32_t i = 0; i < n; ++i) {
      if (!nodes[i].active || i == into || i == from) continue;
      const double mean = (a * distance(into, i) + b * distance(from, i)) / (a + b);
      distance(into, i) = mean;
      distance(i, into) = mean;
    }
    nodes[into].weight = a + b;
    nodes[from].active = false;
  }
  std::stable_sort(merges.begin(), merges.end(),
                   [](const NodeMerge& x, const NodeMerge& y) { return x.distance < y.distance; });
}

}  // namespace

bool link_in_space(Span<const Vec3> points, Span<const double> weights, uint32_t groups,
                   Arena& arena, Arena& scratch, Linkage& out, Span<uint8_t> group) {
  const uint32_t n = static_cast<uint32_t>(points.count);
  Span<Cell> cells;
  if (!make(arena, n, out.order) || !make(scratch, std::min(n, kMaxLinked), cells)) return false;
  for (uint32_t i = 0; i < n; ++i) out.order[i] = i;
  const uint32_t count = make_cells(points, out.order, cells);
  Span<Node> nodes;
  Span<double> distances;
  Span<uint32_t> chain;
  Span<NodeMerge> merges;
  if (!make(scratch, count, nodes) || !make(scratch, size_t{count} * count, distances) ||
      !make(scratch, count, chain) || !make(scratch, count - 1, merges) ||
      !make(arena, count - 1, out.merges)) {
    return false;
  }
  for (uint32_t c = 0; c < count; ++c) {
    Node& node = nodes[c];
    node = Node();
    for (uint32_t i = 0; i < cells[c].count; ++i) {
      const uint32_t point = out.order[cells[c].first + i];
      const double weight = weights.empty() ? 1 : weights[point];
      node.mean = node.mean + points[point] * weight;
      node.weight += weight;
    }
    node.mean = node.mean * (1 / node.weight);
    node.parent = c;
  }
  for (uint32_t a = 0; a < count; ++a) {
    for (uint32_t b = 0; b < count; ++b) {
      distances[size_t{a} * count + b] = length(nodes[a].mean - nodes[b].mean);
    }
  }
  link_nodes(nodes, distances, chain, merges);
  for (uint32_t m = 0; m < merges.count; ++m) out.merges[m] = {merges[m].distance, 0};

  // The remaining groups are those that the merges made.
  const auto root_of = [&](uint32_t node) {
    while (nodes[node].parent != node) node = nodes[node].parent;
    return node;
  };
  for (uint32_t m = 0; m + groups < count; ++m) {
    nodes[root_of(merges[m].from)].parent = root_of(merges[m].into);
  }
  struct Depth {
    double sum = 0;
    uint32_t root = 0, points = 0;
  };
  Span<Depth> depths;
  if (!make(scratch, count, depths)) return false;
  for (uint32_t c = 0; c < count; ++c) {
    Depth& depth = depths[root_of(c)];
    depth.root = root_of(c);
    for (uint32_t i = 0; i < cells[c].count; ++i) {
      depth.sum += points[out.order[cells[c].first + i]].z;
      ++depth.points;
    }
  }
  uint32_t used = 0;
  for (uint32_t c = 0; c < count; ++c) {
    if (depths[c].points > 0) depths[used++] = depths[c];
  }
  std::sort(depths.begin(), depths.begin() + used, [](const Depth& a, const Depth& b) {
    const double x = a.sum / a.points, y = b.sum / b.points;
    return x != y ? x > y : a.root < b.root;
  });
  for (uint32_t c = 0; c < count; ++c) {
    uint8_t number = 0;
    while (depths[number].root != root_of(c)) ++number;
    for (uint32_t i = 0; i < cells[c].count; ++i) group[out.order[cells[c].first + i]] = number;
  }
  return true;
}

}  // namespace mien::author
