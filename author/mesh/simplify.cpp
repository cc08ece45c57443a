// SPDX-License-Identifier: MIT
#include "author/mesh/simplify.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/mesh/edge_collapse.h"
#include "author/mesh/topology.h"

namespace mien::author {

namespace {

constexpr uint32_t kLeastTriangles = 8;  // of a component; smaller ones stay as they are
// The fewest triangles of a small component; with fewer it is removed, because fragments of teeth and
// lashes look worse than none. Those below kSmall count as that large, or lashes would be removed at LOD 1.
constexpr uint32_t kLeastOfSmall = 12, kSmall = 128;
constexpr double kLargeObject = 0.4;  // of the diagonal of the skin
constexpr double kRound = 0.05;       // of its radius: how far a ball is from one

/// Chooses expressions one by one: each moves most of what the earlier ones leave at rest.
bool choose_poses(const AuthorMesh& mesh, uint32_t most, Arena& arena, Span<Shape>& out) {
  Span<float> covered;  // per vertex: the longest displacement so far, squared
  Span<uint8_t> used;
  const size_t wanted = std::min<size_t>(most, mesh.shapes.count);
  if (!make(arena, wanted, out) || !make(arena, mesh.positions.count, covered) ||
      !make(arena, mesh.shapes.count, used)) {
    return false;
  }
  const auto squares = [](Vec3f d) { return d.x * d.x + d.y * d.y + d.z * d.z; };
  size_t count = 0;
  while (count < wanted) {
    double largest = 0;
    size_t best = mesh.shapes.count;
    for (size_t s = 0; s < mesh.shapes.count; ++s) {
      const Shape& shape = mesh.shapes[s];
      double sum = 0;
      for (const uint32_t v : shape.moving) {
        sum += std::max(0.0, double{squares(shape.displacements[v])} - double{covered[v]});
      }
      if (used[s] || !(sum > largest)) continue;
      largest = sum;
      best = s;
    }
    if (best == mesh.shapes.count) break;
    used[best] = 1;
    out[count++] = mesh.shapes[best];
    for (const uint32_t v : mesh.shapes[best].moving) {
      covered[v] = std::max(covered[v], squares(mesh.shapes[best].displacements[v]));
    }
  }
  out.count = count;
  return true;
}

/// The remaining part of `mesh`. Parts without a triangle, because all their faces are degenerate, stay as
/// they are.
bool take_triangles(const AuthorMesh& mesh, const EdgeCollapse& left, Arena& arena,
                    LodTriangles& out) {
  Span<uint32_t> corners, uvs, starts;
  Span<uint8_t> whole;
  const size_t most = 3 * size_t{left.triangle_count()};
  if (!make(arena, most, corners) || !make(arena, mesh.corner_uvs.empty() ? 0 : most, uvs) ||
      !make(arena, mesh.parts.count + 1, starts) || !make(arena, mesh.parts.count, whole)) {
    return false;
  }
  uint32_t count = 0;
  for (size_t p = 0; p < mesh.parts.count; ++p) {
    const Part& part = mesh.parts[p];
    const uint32_t end = left.first_triangle(part.first_face + part.face_count);
    whole[p] = end == left.first_triangle(part.first_face);
    for (uint32_t t = left.first_triangle(part.first_face); t < end; ++t) {
      if (!left.is_alive(t)) continue;
      for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
        if (!uvs.empty()) uvs[count] = mesh.corner_uvs[left.source_corner(c)];
        corners[count++] = left.vertex(c);
      }
    }
    starts[p + 1] = count;
  }
  out.corners = corners;
  out.corner_uvs = uvs;
  out.starts = starts;
  out.whole_parts = whole;
  return true;
}

/// Solves the 4 equations of the columns 0 to 3 for column 4. False if they do not determine it.
bool solve(double (&m)[4][5]) {
  for (size_t i = 0; i < 4; ++i) {
    size_t pivot = i;
    for (size_t r = i + 1; r < 4; ++r) {
      if (std::fabs(m[r][i]) > std::fabs(m[pivot][i])) pivot = r;
    }
    if (!(std::fabs(m[pivot][i]) > 1e-12)) return false;
    std::swap(m[i], m[pivot]);
    for (size_t r = 0; r < 4; ++r) {
      const double factor = r == i ? 0 : m[r][i] / m[i][i];
      for (size_t c = i; c < 5 && r != i; ++c) m[r][c] -= factor * m[i][c];
    }
  }
  for (size_t i = 0; i < 4; ++i) m[i][4] /= m[i][i];
  return true;
}

/// Whether the vertices of a component lie on a sphere, or much of one, as those of eyes do: by the sphere of
/// least squares (I. D. Coope, "Circle fitting by linear and nonlinear least squares", 1993).
bool is_ball(const AuthorMesh& mesh, uint32_t component) {
  Vec3 low = {INFINITY, INFINITY, INFINITY}, high = low * -1;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (mesh.component[v] != component) continue;
    const Vec3 p = mesh.positions[v];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 middle = (low + high) * 0.5, size = high - low;
  const double scale = std::max({size.x, size.y, size.z}) / 2;
  if (!(scale > 0)) return false;
  double m[4][5] = {};
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (mesh.component[v] != component) continue;
    const Vec3 p = (mesh.positions[v] - middle) * (1 / scale);
    const double row[5] = {2 * p.x, 2 * p.y, 2 * p.z, 1, dot(p, p)};
    for (size_t r = 0; r < 4; ++r) {
      for (size_t c = 0; c < 5; ++c) m[r][c] += row[r] * row[c];
    }
  }
  if (!solve(m)) return false;
  const Vec3 center = {m[0][4], m[1][4], m[2][4]};
  const double radius = std::sqrt(std::max(0.0, m[3][4] + dot(center, center)));
  // A patch of a large sphere is flat.
  if (!(radius > 0.5) || radius > 1.5) return false;
  double squares = 0;
  size_t count = 0;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (mesh.component[v] != component) continue;
    const double off = length((mesh.positions[v] - middle) * (1 / scale) - center) - radius;
    squares += off * off;
    ++count;
  }
  return std::sqrt(squares / static_cast<double>(count)) < kRound * radius;
}

/// Components that are removed as a whole when too few triangles would be left: all but the skin, the
/// largest and balls.
bool find_small_components(const AuthorMesh& mesh, Span<const uint32_t> whole, Arena& scratch,
                           Span<uint8_t>& out) {
  if (!make(scratch, whole.count, out)) return false;
  const size_t largest =
      static_cast<size_t>(std::max_element(whole.begin(), whole.end()) - whole.begin());
  for (uint32_t c = 0; c < whole.count; ++c) out[c] = whole[c] > 0 && c != largest;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (mesh.is_skin[v]) out[mesh.component[v]] = 0;
  }
  // Hair is small components too, but not a small object.
  for (const Part& part : mesh.parts) {
    if (part.vertex_count == 0) continue;
    const uint32_t end = part.first_vertex + part.vertex_count;
    const double size =
        bounding_box(mesh.positions.slice(part.first_vertex, part.vertex_count)).diagonal();
    bool may_go = size <= kLargeObject * mesh.diagonal;
    for (uint32_t v = part.first_vertex; v < end; ++v) may_go = may_go || mesh.is_skin[v];
    for (uint32_t v = part.first_vertex; v < end && !may_go; ++v) out[mesh.component[v]] = 0;
  }
  // Looking at balls takes the square of the number of components: of many, only the large ones may be eyes.
  constexpr size_t kMostLookedAt = 256;
  size_t looked_at = 0;
  for (uint32_t c = 0; c < whole.count; ++c) {
    if (!out[c] || whole[c] < kLeastTriangles || looked_at == kMostLookedAt) continue;
    ++looked_at;
    out[c] = !is_ball(mesh, c);
  }
  return true;
}

}  // namespace

bool make_lod_meshes(const AuthorMesh& mesh, const SimplifyOptions& options, Arena& arena,
                     const Allocator& allocator, Span<LodMesh>& out) {
  if (!make(arena, options.lods, out)) return false;
  for (LodMesh& lod : out) lod.mesh = mesh;
  if (options.lods < 2 || !(options.share < 1)) return true;
  Arena scratch(allocator);
  EdgeCollapse left;
  Span<Shape> poses;
  Span<uint32_t> whole, floors;
  Span<uint8_t> is_small;
  if (!choose_poses(mesh, options.max_poses, scratch, poses) ||
      !left.make(mesh, poses, CollapseGuards(), scratch, allocator) ||
      !make(scratch, mesh.component_count, whole) || !make(scratch, mesh.component_count, floors)) {
    return false;
  }
  for (size_t c = 0; c < whole.count; ++c) whole[c] = left.component_counts()[c];
  if (!find_small_components(mesh, whole, scratch, is_small)) return false;
  const double all = left.triangle_count();
  double share = 1;
  for (size_t l = 1; l < out.count; ++l) {
    share *= options.share;
    for (uint32_t c = 0; c < whole.count; ++c) {
      if (is_small[c] && share * std::max(whole[c], kSmall) < kLeastOfSmall)
        left.remove_component(c);
      floors[c] = std::max(kLeastTriangles, static_cast<uint32_t>(share * whole[c]));
    }
    left.reduce(static_cast<uint32_t>(all * share + 0.5), floors);
    Arena for_lod(allocator);
    LodTriangles triangles;
    if (!take_triangles(mesh, left, for_lod, triangles) ||
        !make_lod_mesh(mesh, triangles, arena, allocator, out[l])) {
      return false;
    }
  }
  return true;
}

bool take_shapes(Span<const Shape> shapes, Span<const uint32_t> vertices, Arena& arena,
                 Span<const Shape>& out) {
  Span<Shape> taken;
  if (!make(arena, shapes.count, taken)) return false;
  for (size_t s = 0; s < taken.count; ++s) {
    Span<Vec3f> displacements;
    if (!make(arena, vertices.count, displacements)) return false;
    uint32_t count = 0;
    for (size_t v = 0; v < vertices.count; ++v) {
      const Vec3f d = shapes[s].displacements[vertices[v]];
      displacements[v] = d;
      count += d.x != 0 || d.y != 0 || d.z != 0;
    }
    Span<uint32_t> moving;
    if (!make(arena, count, moving)) return false;
    count = 0;
    for (uint32_t v = 0; v < vertices.count; ++v) {
      const Vec3f d = displacements[v];
      if (d.x != 0 || d.y != 0 || d.z != 0) moving[count++] = v;
    }
    taken[s] = shapes[s];
    taken[s].displacements = displacements;
    taken[s].moving = moving;
  }
  out = taken;
  return true;
}

}  // namespace mien::author
