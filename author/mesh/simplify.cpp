// SPDX-License-Identifier: MIT
#include "author/mesh/simplify.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/mesh/edge_collapse.h"

namespace mien::author {

namespace {

constexpr uint32_t kLeastTriangles = 8;  // of a component; smaller ones stay as they are

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

/// What is left of `mesh`. Parts without a triangle, because all their faces are degenerate, stay
/// as they are.
bool take_triangles(const AuthorMesh& mesh, const EdgeCollapse& left, Arena& arena,
                    LodTriangles& out) {
  Span<uint32_t> corners, uvs, starts;
  const size_t most = 3 * size_t{left.triangle_count()};
  if (!make(arena, most, corners) || !make(arena, mesh.corner_uvs.empty() ? 0 : most, uvs) ||
      !make(arena, mesh.parts.count + 1, starts)) {
    return false;
  }
  uint32_t count = 0;
  for (size_t p = 0; p < mesh.parts.count; ++p) {
    const Part& part = mesh.parts[p];
    const uint32_t end = left.first_triangle(part.first_face + part.face_count);
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
  out.keeps_empty_parts = true;
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
  if (!choose_poses(mesh, options.max_poses, scratch, poses) ||
      !left.make(mesh, poses, scratch, allocator) || !make(scratch, mesh.component_count, whole) ||
      !make(scratch, mesh.component_count, floors)) {
    return false;
  }
  for (size_t c = 0; c < whole.count; ++c) whole[c] = left.component_counts()[c];
  const double all = left.triangle_count();
  double share = 1;
  for (size_t l = 1; l < out.count; ++l) {
    share *= options.share;
    for (size_t c = 0; c < whole.count; ++c) {
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
