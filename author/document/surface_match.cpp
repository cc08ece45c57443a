// SPDX-License-Identifier: MIT
#include "author/document/surface_match.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/mesh/surface_tree.h"

namespace mien::author {

bool positions_of(const dna::Mesh& mesh, Arena& arena, Span<Vec3>& out) {
  if (!make(arena, mesh.positions.xs.count, out)) return false;
  for (uint32_t v = 0; v < out.count; ++v) out[v] = vector_of(mesh.positions, v);
  return true;
}

bool match_by_number(size_t positions, Arena& arena, SurfaceMatch& out) {
  if (!make(arena, positions, out.places)) return false;
  for (uint32_t v = 0; v < out.places.count; ++v) out.places[v] = {{v, v, v}, {1, 0, 0}, 0};
  out.by_number = true;
  return true;
}

bool can_match(const dna::Mesh& mesh, Match match) {
  if (match == Match::kUv && mesh.texture_coordinates.us.count == 0) return false;
  for (const dna::Face& face : mesh.faces) {
    if (face.layout_indices.count >= 3) return mesh.positions.xs.count != 0;
  }
  return false;
}

namespace {

/// Corners of the triangles of all faces: numbers of layouts.
bool triangles_of(const dna::Mesh& mesh, Arena& arena, Span<uint32_t>& out) {
  size_t count = 0;
  for (const dna::Face& face : mesh.faces)
    count += face.layout_indices.count >= 3 ? face.layout_indices.count - 2 : 0;
  if (!make(arena, count * 3, out)) return false;
  size_t next = 0;
  for (const dna::Face& face : mesh.faces) {
    for (uint32_t c = 2; c < face.layout_indices.count; ++c) {
      out[next++] = face.layout_indices[0];
      out[next++] = face.layout_indices[c - 1];
      out[next++] = face.layout_indices[c];
    }
  }
  return true;
}

Vec3 texture_place(const dna::Mesh& mesh, uint32_t layout) {
  const uint32_t uv = mesh.layouts.texture_coordinates[layout];
  return {double{mesh.texture_coordinates.us[uv]}, double{mesh.texture_coordinates.vs[uv]}, 0};
}

/// Of layouts, and for each position the first of them; kNoLayout where no face has it.
constexpr uint32_t kNoLayout = ~uint32_t{0};
bool first_layouts(const dna::Mesh& mesh, Arena& arena, Span<uint32_t>& out) {
  if (!make(arena, mesh.positions.xs.count, out)) return false;
  std::fill(out.begin(), out.end(), kNoLayout);
  for (uint32_t k = mesh.layouts.positions.count; k-- > 0;) out[mesh.layouts.positions[k]] = k;
  return true;
}

}  // namespace

bool match_surfaces(Span<const Vec3> of_positions, const dna::Mesh& of,
                    Span<const Vec3> on_positions, const dna::Mesh& on, Match match, Arena& arena,
                    SurfaceMatch& out) {
  Span<uint32_t> triangles, layouts;
  Span<Vec3> points;
  const uint32_t layout_count = on.layouts.positions.count;
  if (!triangles_of(on, arena, triangles) || !make(arena, layout_count, points) ||
      !first_layouts(of, arena, layouts) || !make(arena, of_positions.count, out.places)) {
    return false;
  }
  for (uint32_t k = 0; k < layout_count; ++k) {
    points[k] = match == Match::kUv ? texture_place(on, k) : on_positions[on.layouts.positions[k]];
  }
  SurfaceTree tree;
  if (!tree.build(points, triangles, arena)) return false;
  for (uint32_t v = 0; v < of_positions.count; ++v) {
    Vec3 at = of_positions[v];
    if (match == Match::kUv) at = layouts[v] == kNoLayout ? Vec3{} : texture_place(of, layouts[v]);
    const SurfacePoint found = tree.nearest(at);
    SurfaceMatch::Place& place = out.places[v];
    for (uint32_t k = 0; k < 3; ++k) {
      place.positions[k] = on.layouts.positions[triangles[3 * size_t{found.triangle} + k]];
      place.weights[k] = found.weights[k];
    }
    place.distance = found.distance;
  }
  return true;
}

}  // namespace mien::author
