// SPDX-License-Identifier: MIT
// Vertices, triangles, and the faces that normals are recomputed from.
#include <algorithm>
#include <cmath>

#include "runtime/base/vector.h"
#include "runtime/load/compile/compile_deformer.h"
#include "simd/deform_kernels.h"

namespace mien {
namespace {

using dna::Array;
using dna::Mesh;

constexpr double kHardEdgeCosine = 0.8660254037844386;  // of 30 degrees

void store(Vec3 v, float* out) {
  out[0] = static_cast<float>(v.x);
  out[1] = static_cast<float>(v.y);
  out[2] = static_cast<float>(v.z);
}
Vec3 load(const float* from) { return {from[0], from[1], from[2]}; }

size_t faces_for(size_t corners) { return corners < 3 ? 0 : (corners - 1) / 2; }

/// Splits a polygon of the file into a fan of quads, the last of which may be a triangle, and calls
/// f(positions of its four corners).
template <class F>
void for_each_face(const Mesh& mesh, F&& f) {
  for (const dna::Face& face : mesh.faces) {
    const Array<uint32_t>& vertices = face.layout_indices;
    const auto position = [&](uint32_t i) { return mesh.layouts.positions[vertices[i]]; };
    for (uint32_t i = 1; i + 1 < vertices.count; i += 2) {
      const uint32_t last = std::min(i + 2, vertices.count - 1);
      const uint32_t corners[4] = {position(0), position(i), position(i + 1), position(last)};
      f(corners);
    }
  }
}

bool repeats(const uint32_t* corners, int i) {
  for (int k = 0; k < i; ++k) {
    if (corners[k] == corners[i]) return true;
  }
  return false;
}

/// True if the area vectors of the faces, as the file winds them, point into the mesh. The stored
/// normals decide; without them, the winding order and the axes of the file.
bool faces_point_inward(const MeshSource& source, const DeformMesh& mesh,
                        Span<const Vec3> directions) {
  double sum = 0;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const double along =
        dot(load(mesh.normals.data + size_t{v} * 3), directions[mesh.vertex_position_indices[v]]);
    if (std::isfinite(along)) sum += along;
  }
  if (sum != 0) return sum < 0;
  const bool clockwise = source.view.dsce.face_winding_order == 1;
  const dna::FileCoordinateSystem& axes = source.view.desc.coordinate_system;
  const uint32_t named[3] = {axes.x_axis, axes.y_axis, axes.z_axis};
  static constexpr uint32_t kRightUpFront[3] = {1, 2, 4};
  const Matrix3 axes_to_canonical = change_of_axes(named, kRightUpFront);
  const auto row = [&](int r) {
    return Vec3{axes_to_canonical.m[r][0], axes_to_canonical.m[r][1], axes_to_canonical.m[r][2]};
  };
  return (dot(cross(row(0), row(1)), row(2)) < 0) != clockwise;
}

void fill_vertices(const Mesh& source, DeformMesh& mesh) {
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    float* at = mesh.positions.data + size_t{p} * 3;
    at[0] = source.positions.xs[p];
    at[1] = source.positions.ys[p];
    at[2] = source.positions.zs[p];
  }
  const auto& uvs = source.texture_coordinates;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    mesh.vertex_position_indices[v] = source.layouts.positions[v];
    if (uvs.us.count != 0) {
      const uint32_t uv = source.layouts.texture_coordinates[v];
      mesh.texture_coordinates[size_t{v} * 2] = uvs.us[uv];
      mesh.texture_coordinates[size_t{v} * 2 + 1] = uvs.vs[uv];
    }
    if (source.normals.xs.count != 0) {
      const uint32_t n = source.layouts.normals[v];
      store(normalized(Vec3{source.normals.xs[n], source.normals.ys[n], source.normals.zs[n]}),
            mesh.normals.data + size_t{v} * 3);
    }
  }
  size_t corner = 0;
  for (const dna::Face& face : source.faces) {
    const Array<uint32_t>& vertices = face.layout_indices;
    for (uint32_t i = 2; i < vertices.count; ++i) {
      mesh.triangles[corner++] = vertices[0];
      mesh.triangles[corner++] = vertices[i - 1];
      mesh.triangles[corner++] = vertices[i];
    }
  }
}

/// Starts of a counting sort: turns the counts of list[i], in first[i + 1], into their start. Adding
/// 1 for each item written then leaves the end of list i, which is the start of list i + 1.
void starts_from_counts(const Span<uint32_t>& first) {
  uint32_t total = 0;
  for (size_t i = 1; i < first.count; ++i) {
    const uint32_t count = first[i];
    first[i] = total;
    total += count;
  }
}

/// The faces, and those adjacent to each position.
void fill_faces(const Mesh& source, DeformMesh& mesh) {
  size_t face = 0;
  for_each_face(source, [&](const uint32_t* corners) {
    std::copy(corners, corners + 4, mesh.faces.data + face++ * 4);
  });
  const Span<uint32_t>& first = mesh.first_adjacent_face;
  const auto for_each_corner = [&](auto&& f) {
    for (uint32_t i = 0; i < mesh.face_count(); ++i) {
      const uint32_t* corners = mesh.faces.data + size_t{i} * 4;
      for (int k = 0; k < 4; ++k) {
        if (!repeats(corners, k)) f(first[size_t{mesh.sorted_indices[corners[k]]} + 1], i);
      }
    }
  };
  for_each_corner([](uint32_t& count, uint32_t) { ++count; });
  starts_from_counts(first);
  for_each_corner([&](uint32_t& next, uint32_t i) { mesh.adjacent_faces[next++] = i; });
}

/// The vertices of each position.
void fill_vertex_lists(DeformMesh& mesh) {
  const auto next = [&](uint32_t v) -> uint32_t& {
    return mesh.first_vertex[size_t{mesh.sorted_indices[mesh.vertex_position_indices[v]]} + 1];
  };
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) ++next(v);
  starts_from_counts(mesh.first_vertex);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) mesh.vertices[next(v)++] = v;
}

Vec3 area_vector(const DeformMesh& mesh, const uint32_t* corners) {
  const auto at = [&](int i) { return load(mesh.positions.data + size_t{corners[i]} * 3); };
  return cross(at(2) - at(0), at(3) - at(1));
}

}  // namespace

void plan_surface(const MeshSource& source, MeshPlan& plan) {
  for (const dna::Face& face : source.mesh.faces) {
    const size_t corners = face.layout_indices.count;
    plan.face_count += faces_for(corners);
    plan.triangle_count += corners < 3 ? 0 : corners - 2;
  }
}

void place_surface(const MeshPlan& plan, bool tangents, Placer& placer, DeformMesh& mesh) {
  const size_t positions = mesh.position_count, vertices = mesh.vertex_count;
  const size_t alignment = mesh.array_alignment();
  mesh.positions = placer.array<float>(positions * 3 + 1, alignment);
  mesh.normals = placer.array<float>(vertices * 3 + 1, alignment);
  mesh.tangents = placer.array<float>(tangents ? vertices * 4 : 0, alignment);
  mesh.texture_coordinates = placer.array<float>(vertices * 2, alignment);
  mesh.vertex_position_indices = placer.array<uint32_t>(vertices, alignment);
  mesh.triangles = placer.array<uint32_t>(plan.triangle_count * 3, alignment);
  mesh.faces = placer.array<uint32_t>(plan.face_count * 4, alignment);
  mesh.first_adjacent_face = placer.array<uint32_t>(positions + 1, alignment);
  mesh.adjacent_faces = placer.array<uint32_t>(plan.face_count * 4, alignment);
  mesh.first_vertex = placer.array<uint32_t>(positions + 1, alignment);
  mesh.vertices = placer.array<uint32_t>(vertices, alignment);
  mesh.sorted_normals = placer.array<float>(vertices * 4, alignment);
  mesh.sorted_tangents = placer.array<float>(tangents ? vertices * 4 : 0, alignment);
  mesh.neutral_directions = placer.array<float>(positions * 4, alignment);
}

Status fill_surface(const MeshSource& source, DeformMesh& mesh) {
  const Span<Vec3> directions = source.scratch.array<Vec3>(mesh.position_count);
  if (mesh.position_count != 0 && !directions.data) return source.no_memory();
  fill_vertices(source.mesh, mesh);
  fill_faces(source.mesh, mesh);
  fill_vertex_lists(mesh);

  for (uint32_t f = 0; f < mesh.face_count(); ++f) {
    const uint32_t* corners = mesh.faces.data + size_t{f} * 4;
    const Vec3 area = area_vector(mesh, corners);
    for (int k = 0; k < 4; ++k) {
      if (repeats(corners, k)) continue;
      directions[corners[k]] = directions[corners[k]] + area;
    }
  }
  for (Vec3& direction : directions) direction = normalized(direction);
  const bool inward = faces_point_inward(source, mesh, directions);
  if (inward) {
    for (Vec3& direction : directions) direction = Vec3{} - direction;
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
      std::swap(mesh.faces[size_t{f} * 4 + 1], mesh.faces[size_t{f} * 4 + 3]);
    }
  }
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    store(directions[p], mesh.neutral_directions.data + size_t{mesh.sorted_indices[p]} * 4);
  }
  for (size_t i = 0; i < mesh.vertices.count; ++i) {
    uint32_t& vertex = mesh.vertices[i];
    const Vec3 recomputed = directions[mesh.vertex_position_indices[vertex]];
    float* stored = mesh.normals.data + size_t{vertex} * 3;
    if (is_zero(load(stored))) store(recomputed, stored);
    std::copy(stored, stored + 3, mesh.sorted_normals.data + i * 4);
    if (dot(load(stored), recomputed) < kHardEdgeCosine) vertex |= kHardEdge;
  }
  return source.options.tangents ? fill_tangents(source, inward, mesh) : Status::kOk;
}

}  // namespace mien
