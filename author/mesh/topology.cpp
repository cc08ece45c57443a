// SPDX-License-Identifier: MIT
#include "author/mesh/topology.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"

namespace mien::author {

Box bounding_box(Span<const Vec3> points) {
  Box box = {points[0], points[0]};
  for (const Vec3& p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

int compare_displacements(Span<const Shape> shapes, uint32_t a, uint32_t b, double tolerance) {
  for (const Shape& shape : shapes) {
    const Vec3f p = shape.displacements[a], q = shape.displacements[b];
    const double apart[] = {double{p.x} - q.x, double{p.y} - q.y, double{p.z} - q.z};
    for (double d : apart) {
      if (std::abs(d) > tolerance) return d < 0 ? -1 : 1;
    }
  }
  return 0;
}

bool weld(Span<const Vec3> positions, Span<const Shape> shapes, Arena& arena, Arena& scratch,
          Span<uint32_t>& out) {
  struct Cell {
    int64_t x, y, z;
    uint32_t vertex;

    bool same_place(const Cell& other) const {
      return x == other.x && y == other.y && z == other.z;
    }
    bool operator<(const Cell& other) const {
      if (x != other.x) return x < other.x;
      if (y != other.y) return y < other.y;
      return z != other.z ? z < other.z : vertex < other.vertex;
    }
  };
  Span<Cell> cells;
  if (!make(arena, positions.count, out) || !make(scratch, positions.count, cells)) return false;
  if (positions.empty()) return true;
  const Box box = bounding_box(positions);
  const double diagonal = box.diagonal();
  const double scale = diagonal > 0 ? 1e6 / diagonal : 0;
  for (uint32_t i = 0; i < cells.count; ++i) {
    const Vec3 p = (positions[i] - box.low) * scale;
    cells[i] = {static_cast<int64_t>(std::floor(p.x + 0.5)),
                static_cast<int64_t>(std::floor(p.y + 0.5)),
                static_cast<int64_t>(std::floor(p.z + 0.5)), i};
  }
  std::sort(cells.begin(), cells.end());
  const double tolerance = 1e-6 * diagonal;
  for (uint32_t i = 0, first = 0; i < cells.count; ++i) {
    const uint32_t v = cells[i].vertex;
    if (i == 0 || !cells[i].same_place(cells[i - 1])) first = i;
    // The first earlier vertex at the same position that moves in the same way.
    out[v] = v;
    constexpr uint32_t kMaxParts = 64;  // bounds the work for any number of copies
    for (uint32_t k = first, parts = 0; k < i && parts < kMaxParts; ++k) {
      const uint32_t other = cells[k].vertex;
      if (out[other] != other) continue;
      ++parts;
      if (compare_displacements(shapes, other, v, tolerance) != 0) continue;
      out[v] = other;
      break;
    }
  }
  return true;
}

namespace {

uint32_t find_root(Span<uint32_t> parents, uint32_t v) {
  while (parents[v] != v) v = parents[v] = parents[parents[v]];
  return v;
}

}  // namespace

bool find_components(Span<const uint32_t> triangles, Span<const uint32_t> welded, Arena& arena,
                     Arena& scratch, Span<uint32_t>& out, uint32_t& out_count) {
  Span<uint32_t> parents;
  if (!make(arena, welded.count, out) || !make(scratch, welded.count, parents)) return false;
  for (uint32_t v = 0; v < welded.count; ++v) parents[v] = welded[v];
  const auto join = [&](uint32_t a, uint32_t b) {
    a = find_root(parents, a);
    b = find_root(parents, b);
    if (a != b) parents[std::max(a, b)] = std::min(a, b);
  };
  for (size_t t = 0; t + 2 < triangles.count; t += 3) {
    join(triangles[t], triangles[t + 1]);
    join(triangles[t], triangles[t + 2]);
  }
  out_count = 0;
  for (uint32_t v = 0; v < welded.count; ++v) {
    const uint32_t root = find_root(parents, v);  // the lowest vertex of its component
    out[v] = root == v ? out_count++ : out[root];
  }
  return true;
}

bool make_surface_graph(const AuthorMesh& mesh, Arena& arena, Arena& scratch, SurfaceGraph& out) {
  const size_t n = mesh.positions.count;
  // For small faces, every pair of corners: the diagonal must not depend on the first corner.
  constexpr uint32_t kAllPairs = 6;
  size_t capacity = 0;
  for (size_t f = 0; f + 1 < mesh.face_starts.count; ++f) {
    const size_t size = mesh.face_starts[f + 1] - mesh.face_starts[f];
    capacity += size <= kAllPairs ? size * (size - 1) : size * 2;
  }
  Span<uint64_t> edges;
  if (!make(scratch, capacity, edges)) return false;
  size_t count = 0;
  const auto add = [&](uint32_t from, uint32_t to) {
    const uint64_t a = mesh.welded[from], b = mesh.welded[to];
    if (a == b) return;
    edges[count++] = a << 32 | b;
    edges[count++] = b << 32 | a;
  };
  for (size_t f = 0; f + 1 < mesh.face_starts.count; ++f) {
    const uint32_t* corners = mesh.corners.data + mesh.face_starts[f];
    const uint32_t size = mesh.face_starts[f + 1] - mesh.face_starts[f];
    for (uint32_t i = 0; i < size; ++i) {
      if (size > kAllPairs) add(corners[i], corners[(i + 1) % size]);
      for (uint32_t k = i + 1; k < size && size <= kAllPairs; ++k) add(corners[i], corners[k]);
    }
  }
  std::sort(edges.data, edges.data + count);
  count = static_cast<size_t>(std::unique(edges.data, edges.data + count) - edges.data);
  if (!make(arena, n + 1, out.starts) || !make(arena, count, out.neighbors) ||
      !make(arena, count, out.lengths)) {
    return false;
  }
  for (size_t i = 0; i < count; ++i) {
    const uint32_t a = static_cast<uint32_t>(edges[i] >> 32), b = static_cast<uint32_t>(edges[i]);
    ++out.starts[a + 1];
    out.neighbors[i] = b;
    out.lengths[i] = length(mesh.positions[a] - mesh.positions[b]);
  }
  for (size_t v = 0; v < n; ++v) out.starts[v + 1] += out.starts[v];
  return true;
}

void vertex_areas(const AuthorMesh& mesh, Span<double> out) {
  for (double& area : out) area = 0;
  for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
    const uint32_t* corner = mesh.triangles.data + t;
    const Vec3 a = mesh.positions[corner[0]];
    const double area =
        length(cross(mesh.positions[corner[1]] - a, mesh.positions[corner[2]] - a)) / 6;
    for (int k = 0; k < 3; ++k) out[mesh.welded[corner[k]]] += area;
  }
}

bool StepHeap::push(Step step) {
  if (count_ == steps_.count) {
    const Span<Step> larger = arena_->array<Step>(count_ * 2 + 4096);
    if (larger.empty()) return false;
    for (size_t i = 0; i < count_; ++i) larger[i] = steps_[i];
    steps_ = larger;
  }
  steps_[count_++] = step;
  std::push_heap(steps_.data, steps_.data + count_,
                 [](const Step& a, const Step& b) { return b < a; });
  return true;
}

Step StepHeap::pop() {
  std::pop_heap(steps_.data, steps_.data + count_,
                [](const Step& a, const Step& b) { return b < a; });
  return steps_[--count_];
}

bool surface_distances(const AuthorMesh& mesh, const SurfaceGraph& graph,
                       Span<const uint32_t> sources, Arena& scratch, Span<double> out) {
  for (double& distance : out) distance = std::numeric_limits<double>::infinity();
  StepHeap heap(scratch);
  for (uint32_t source : sources) {
    const uint32_t v = mesh.welded[source];
    if (out[v] == 0) continue;
    out[v] = 0;
    if (!heap.push({0, v, 0, 0})) return false;
  }
  while (!heap.empty()) {
    const Step step = heap.pop();
    if (step.distance > out[step.vertex]) continue;
    for (uint32_t e = graph.starts[step.vertex]; e < graph.starts[step.vertex + 1]; ++e) {
      const double distance = step.distance + graph.lengths[e];
      const uint32_t to = graph.neighbors[e];
      if (!(distance < out[to])) continue;
      out[to] = distance;
      if (!heap.push({distance, to, 0, distance})) return false;
    }
  }
  for (uint32_t v = 0; v < out.count; ++v) out[v] = out[mesh.welded[v]];
  return true;
}

}  // namespace mien::author
