// SPDX-License-Identifier: MIT
#include "author/mesh/lod_mesh.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/mesh/surface_tree.h"

namespace mien::author {

namespace {

class Extraction {
 public:
  Extraction(const AuthorMesh& whole, const LodTriangles& triangles, Arena& arena, Arena& scratch)
      : whole_(whole), triangles_(triangles), arena_(arena), scratch_(scratch) {}

  bool make(LodMesh& out) {
    return number_vertices(out) && take_vertices(out) && take_faces(out.vertices, out.mesh);
  }

 private:
  bool is_whole(size_t part) const {
    return !triangles_.whole_parts.empty() && triangles_.whole_parts[part] != 0;
  }
  /// Corners of a part of LOD 0.
  uint32_t first_corner(size_t part) const {
    return whole_.face_starts[whole_.parts[part].first_face];
  }
  uint32_t end_corner(size_t part) const {
    return whole_.face_starts[whole_.parts[part].first_face + whole_.parts[part].face_count];
  }

  bool number_vertices(LodMesh& out) {
    if (!author::make(scratch_, whole_.positions.count, numbers_)) return false;
    faces_ = triangles_.corners.count / 3;
    corners_ = triangles_.corners.count;
    for (const uint32_t v : triangles_.corners) numbers_[v] = 1;
    for (size_t p = 0; p < whole_.parts.count; ++p) {
      if (!is_whole(p)) continue;
      for (uint32_t c = first_corner(p); c < end_corner(p); ++c) numbers_[whole_.corners[c]] = 1;
      faces_ += whole_.parts[p].face_count;
      corners_ += end_corner(p) - first_corner(p);
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
        !author::make(arena_, triangles_.corners.count, triangles) ||
        !author::make(arena_, whole_.parts.count, parts)) {
      return false;
    }
    size_t face = 0, corner = 0;
    const auto add = [&](uint32_t vertex, Span<const uint32_t> from_uvs, uint32_t at) {
      if (!uvs.empty()) uvs[corner] = from_uvs[at];
      corners[corner++] = numbers_[vertex];
    };
    for (size_t p = 0; p < parts.count; ++p) {
      const Part& from = whole_.parts[p];
      Part& part = parts[p];
      part.name = from.name;
      part.first_face = static_cast<uint32_t>(face);
      for (uint32_t c = triangles_.starts[p]; c < triangles_.starts[p + 1]; ++c) {
        add(triangles_.corners[c], triangles_.corner_uvs, c);
        triangles[c] = corners[corner - 1];
        if (c % 3 == 2) starts[++face] = static_cast<uint32_t>(corner);
      }
      for (uint32_t f = 0; f < from.face_count && is_whole(p); ++f) {
        const uint32_t* bounds = &whole_.face_starts[from.first_face + f];
        for (uint32_t c = bounds[0]; c < bounds[1]; ++c) {
          add(whole_.corners[c], whole_.corner_uvs, c);
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
  const LodTriangles& triangles_;
  Arena& arena_;
  Arena& scratch_;
  Span<uint32_t> numbers_;  // per vertex of the whole mesh; per remaining vertex
  size_t faces_ = 0, corners_ = 0;
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

bool make_lod_mesh(const AuthorMesh& whole, const LodTriangles& triangles, Arena& arena,
                   const Allocator& allocator, LodMesh& out) {
  Arena scratch(allocator);
  Extraction extraction(whole, triangles, arena, scratch);
  return extraction.make(out) && measure_distances(whole, out, allocator);
}

}  // namespace mien::author
