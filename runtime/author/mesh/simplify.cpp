// SPDX-License-Identifier: MIT
#include "runtime/author/mesh/simplify.h"

#include <algorithm>

#include "runtime/author/dna_making.h"
#include "runtime/author/mesh/edge_collapse.h"
#include "runtime/author/mesh/surface_tree.h"

namespace mien::author {

namespace {

constexpr uint32_t kLeastTriangles = 8;  // of a component; smaller ones stay as they are

/// The expressions that move most of what those before them leave at rest.
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

/// What `collapse` has left, as a mesh.
class Extraction {
 public:
  Extraction(const AuthorMesh& whole, const EdgeCollapse& collapse, Arena& arena, Arena& scratch)
      : whole_(whole), left_(collapse), arena_(arena), scratch_(scratch) {}

  bool make(LodMesh& out) {
    return number_vertices(out) && take_vertices(out) && take_faces(out.vertices, out.mesh);
  }

 private:
  /// A part of which no face has a triangle, as all of them lie on lines.
  bool is_odd(const Part& part) const {
    return left_.first_triangle(part.first_face) ==
           left_.first_triangle(part.first_face + part.face_count);
  }

  bool number_vertices(LodMesh& out) {
    if (!author::make(scratch_, whole_.positions.count, numbers_)) return false;
    for (const Part& part : whole_.parts) {
      const uint32_t first = part.first_face, end = first + part.face_count;
      for (uint32_t t = left_.first_triangle(first); t < left_.first_triangle(end); ++t) {
        if (!left_.is_alive(t)) continue;
        for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) numbers_[left_.vertex(c)] = 1;
        ++faces_;
        corners_ += 3;
      }
      if (!is_odd(part)) continue;
      const uint32_t from = whole_.face_starts[first], to = whole_.face_starts[end];
      for (uint32_t c = from; c < to; ++c) numbers_[whole_.corners[c]] = 1;
      faces_ += part.face_count;
      corners_ += to - from;
    }
    uint32_t count = 0;
    for (const uint32_t used : numbers_) count += used;
    Span<uint32_t> vertices;
    if (!author::make(arena_, count, vertices)) return false;
    count = 0;
    for (uint32_t v = 0; v < numbers_.count; ++v) {
      if (numbers_[v] == 0) continue;
      vertices[count] = v;
      numbers_[v] = count++;
    }
    out.vertices = vertices;
    return true;
  }

  bool take_vertices(LodMesh& out) {
    const size_t n = out.vertices.count;
    Span<Vec3> positions;
    Span<uint32_t> welded, component, first;
    Span<uint8_t> is_skin;
    if (!author::make(arena_, n, positions) || !author::make(arena_, n, welded) ||
        !author::make(arena_, n, component) || !author::make(arena_, n, is_skin) ||
        !author::make(scratch_, whole_.positions.count, first)) {
      return false;
    }
    for (uint32_t& v : first) v = kNone;
    for (uint32_t v = 0; v < n; ++v) {
      const uint32_t from = out.vertices[v];
      positions[v] = whole_.positions[from];
      component[v] = whole_.component[from];
      is_skin[v] = whole_.is_skin[from];
      uint32_t& place = first[whole_.welded[from]];
      if (place == kNone) place = v;
      welded[v] = place;
    }
    out.mesh = whole_;
    out.mesh.shapes = {};
    out.mesh.positions = positions;
    out.mesh.welded = welded;
    out.mesh.component = component;
    out.mesh.is_skin = is_skin;
    return true;
  }

  bool take_faces(Span<const uint32_t> vertices, AuthorMesh& out) {
    Span<uint32_t> starts, corners, uvs, triangles;
    Span<Part> parts;
    if (!author::make(arena_, faces_ + 1, starts) || !author::make(arena_, corners_, corners) ||
        !author::make(arena_, whole_.corner_uvs.empty() ? 0 : corners_, uvs) ||
        !author::make(arena_, 3 * size_t{left_.triangle_count()}, triangles) ||
        !author::make(arena_, whole_.parts.count, parts)) {
      return false;
    }
    size_t face = 0, corner = 0, in_triangles = 0;
    const auto add = [&](uint32_t vertex, uint32_t source) {
      if (!uvs.empty()) uvs[corner] = whole_.corner_uvs[source];
      corners[corner++] = numbers_[vertex];
    };
    for (size_t p = 0; p < parts.count; ++p) {
      const Part& from = whole_.parts[p];
      Part& part = parts[p];
      part.name = from.name;
      part.first_face = static_cast<uint32_t>(face);
      const uint32_t first = from.first_face, end = first + from.face_count;
      for (uint32_t t = left_.first_triangle(first); t < left_.first_triangle(end); ++t) {
        if (!left_.is_alive(t)) continue;
        for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
          add(left_.vertex(c), left_.source_corner(c));
          triangles[in_triangles++] = corners[corner - 1];
        }
        starts[++face] = static_cast<uint32_t>(corner);
      }
      for (uint32_t f = first; f < end && is_odd(from); ++f) {
        for (uint32_t c = whole_.face_starts[f]; c < whole_.face_starts[f + 1]; ++c) {
          add(whole_.corners[c], c);
        }
        starts[++face] = static_cast<uint32_t>(corner);
      }
      part.face_count = static_cast<uint32_t>(face) - part.first_face;
      part.first_vertex = number_from(vertices, from.first_vertex);
      part.vertex_count =
          number_from(vertices, from.first_vertex + from.vertex_count) - part.first_vertex;
    }
    out.face_starts = starts;
    out.corners = corners;
    out.corner_uvs = uvs;
    out.triangles = triangles;
    out.parts = parts;
    return true;
  }

  static uint32_t number_from(Span<const uint32_t> vertices, uint32_t vertex) {
    return static_cast<uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                                 vertices.begin());
  }

  const AuthorMesh& whole_;
  const EdgeCollapse& left_;
  Arena& arena_;
  Arena& scratch_;
  Span<uint32_t> numbers_;  // per vertex of the whole mesh; of those that stay
  uint32_t faces_ = 0, corners_ = 0;
};

/// False if memory ran out.
bool measure_distances(const AuthorMesh& whole, LodMesh& lod, const Allocator& allocator) {
  Arena scratch(allocator);
  Span<uint8_t> is_kept;
  SurfaceTree tree;
  if (lod.mesh.triangles.empty()) return true;
  if (!make(scratch, whole.positions.count, is_kept) ||
      !tree.build(lod.mesh.positions, lod.mesh.triangles, scratch)) {
    return false;
  }
  for (const uint32_t v : lod.vertices) is_kept[whole.welded[v]] = 1;
  double squares = 0;
  size_t places = 0;
  for (uint32_t v = 0; v < whole.positions.count; ++v) {
    if (whole.welded[v] != v) continue;
    ++places;
    if (is_kept[v]) continue;
    const double distance = tree.distance(whole.positions[v]);
    squares += distance * distance;
    lod.max = std::max(lod.max, distance);
  }
  lod.rms = std::sqrt(squares / static_cast<double>(places));
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
    Extraction extraction(mesh, left, arena, for_lod);
    if (!extraction.make(out[l]) || !measure_distances(mesh, out[l], allocator)) return false;
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
