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
/// f(its four vertices). A triangle repeats its last one.
template <class F>
void for_each_quad(const Mesh& mesh, F&& f) {
  for (const dna::Face& face : mesh.faces) {
    const Array<uint32_t>& vertices = face.layout_indices;
    for (uint32_t i = 1; i + 1 < vertices.count; i += 2) {
      const uint32_t last = std::min(i + 2, vertices.count - 1);
      const uint32_t corners[4] = {vertices[0], vertices[i], vertices[i + 1], vertices[last]};
      f(corners, last - i + 2);
    }
  }
}

/// The same with positions in place of vertices.
template <class F>
void for_each_face(const Mesh& mesh, F&& f) {
  for_each_quad(mesh, [&](const uint32_t* vertices, uint32_t) {
    uint32_t corners[4];
    for (int k = 0; k < 4; ++k) corners[k] = mesh.layouts.positions[vertices[k]];
    f(corners);
  });
}

/// Calls f(vertex) for each corner of the quads whose vertex does not follow from its position.
template <class F>
void for_each_listed_corner(const Mesh& mesh, const MeshPlan& plan, F&& f) {
  for_each_quad(mesh, [&](const uint32_t* vertices, uint32_t count) {
    for (uint32_t k = 0; k < count; ++k) {
      if (plan.vertex_counts[mesh.layouts.positions[vertices[k]]] != 1) f(vertices[k]);
    }
  });
}

/// Whether DeformMesh::triangles can be left out: no quad looks like a triangle.
bool triangles_follow(const Mesh& mesh) {
  bool follow = true;
  for_each_quad(mesh, [&](const uint32_t* vertices, uint32_t count) {
    const Array<uint32_t>& positions = mesh.layouts.positions;
    follow = follow && (count == 3 || positions[vertices[2]] != positions[vertices[3]]);
  });
  return follow;
}

bool repeats(const uint32_t* corners, int i) {
  for (int k = 0; k < i; ++k) {
    if (corners[k] == corners[i]) return true;
  }
  return false;
}

/// The stored normal of a vertex, as the deformer has it; zero if there is none.
Vec3 stored_normal(const Mesh& source, uint32_t v) {
  if (source.normals.xs.count == 0) return {};
  const uint32_t n = source.layouts.normals[v];
  float rounded[3];
  store(normalized(Vec3{source.normals.xs[n], source.normals.ys[n], source.normals.zs[n]}),
        rounded);
  return load(rounded);
}

/// True if the area vectors of the faces, as the file winds them, point into the mesh. The stored
/// normals decide; without them, the winding order and the axes of the file.
bool faces_point_inward(const MeshSource& source, Span<const Vec3> directions) {
  const Mesh& mesh = source.mesh;
  double sum = 0;
  for (uint32_t v = 0; v < mesh.layouts.positions.count; ++v) {
    const double along = dot(stored_normal(mesh, v), directions[mesh.layouts.positions[v]]);
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

/// Numbers of coordinates, from their least value in steps of 1/65535 of their range.
constexpr double kCoordinateSteps = 65535;

bool are_finite(const dna::TextureCoordinates& uvs) {
  for (uint32_t i = 0; i < uvs.us.count; ++i) {
    if (!std::isfinite(uvs.us[i]) || !std::isfinite(uvs.vs[i])) return false;
  }
  return true;
}

void fix_coordinates(const Mesh& source, DeformMesh& mesh) {
  double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
  float uv[2];
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    read_coordinates(source, v, uv);
    for (int k = 0; k < 2; ++k) {
      least[k] = std::min(least[k], double{uv[k]});
      most[k] = std::max(most[k], double{uv[k]});
    }
  }
  for (int k = 0; k < 2; ++k) {
    mesh.texture_coordinates[k] = static_cast<float>(least[k]);
    mesh.texture_coordinates[2 + k] = static_cast<float>((most[k] - least[k]) / kCoordinateSteps);
  }
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    read_coordinates(source, v, uv);
    for (int k = 0; k < 2; ++k) {
      const double range = most[k] - least[k];
      const double steps = range > 0 ? (uv[k] - least[k]) / range * kCoordinateSteps : 0;
      mesh.fixed_coordinates[size_t{v} * 2 + k] = static_cast<uint16_t>(std::lround(steps));
    }
  }
}

void fill_vertices(const Mesh& source, DeformMesh& mesh) {
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    float* at = mesh.positions.data + size_t{p} * 3;
    at[0] = source.positions.xs[p];
    at[1] = source.positions.ys[p];
    at[2] = source.positions.zs[p];
  }
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    mesh.vertex_position_indices[v] = source.layouts.positions[v];
    store(stored_normal(source, v), mesh.normals.data + size_t{v} * 3);
  }
  if (mesh.fixed_coordinates.empty()) {
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
      read_coordinates(source, v, mesh.texture_coordinates.data + size_t{v} * 2);
    }
  } else {
    fix_coordinates(source, mesh);
  }
}

void fill_triangles(const Mesh& source, const MeshPlan& plan, DeformMesh& mesh) {
  size_t corner = 0;
  if (plan.triangles_follow) {
    for_each_listed_corner(source, plan,
                           [&](uint32_t vertex) { mesh.corner_vertices.set(corner++, vertex); });
    return;
  }
  for_each_triangle(source, [&](const uint32_t* vertices) {
    std::copy(vertices, vertices + 3, mesh.triangles.data + corner);
    corner += 3;
  });
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
void fill_faces(const Mesh& source, const MeshPlan& plan, DeformMesh& mesh) {
  size_t face = 0;
  for_each_face(source, [&](const uint32_t* corners) {
    for (int k = 0; k < 4; ++k) mesh.faces.set(face * 4 + k, corners[k]);
    ++face;
  });
  const Span<uint32_t>& first = mesh.first_adjacent_face;
  const auto for_each_corner = [&](auto&& f) {
    for (uint32_t i = 0; i < mesh.face_count(); ++i) {
      uint32_t corners[4];
      for (size_t k = 0; k < 4; ++k) corners[k] = mesh.faces[size_t{i} * 4 + k];
      for (int k = 0; k < 4; ++k) {
        if (!repeats(corners, k)) f(first[size_t{plan.sorted_indices[corners[k]]} + 1], i);
      }
    }
  };
  for_each_corner([](uint32_t& count, uint32_t) { ++count; });
  starts_from_counts(first);
  for_each_corner([&](uint32_t& next, uint32_t i) { mesh.adjacent_faces.set(next++, i); });
}

/// The vertices of each position.
void fill_vertex_lists(const MeshPlan& plan, DeformMesh& mesh) {
  const auto next = [&](uint32_t v) -> uint32_t& {
    return mesh.first_vertex[size_t{plan.sorted_indices[mesh.vertex_position_indices[v]]} + 1];
  };
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) ++next(v);
  starts_from_counts(mesh.first_vertex);
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) mesh.vertices[next(v)++] = v;
}

Vec3 area_vector(const Mesh& mesh, const uint32_t* corners) {
  const auto at = [&](int i) {
    const uint32_t p = corners[i];
    return Vec3{mesh.positions.xs[p], mesh.positions.ys[p], mesh.positions.zs[p]};
  };
  return cross(at(2) - at(0), at(3) - at(1));
}

/// Whether a vertex lies on a hard edge. Without a stored normal it gets the recomputed one.
bool is_hard(Vec3 stored, Vec3 recomputed) {
  if (is_zero(stored)) {
    float rounded[3];
    store(recomputed, rounded);
    stored = load(rounded);
  }
  return dot(stored, recomputed) < kHardEdgeCosine;
}

}  // namespace

Status plan_surface(const MeshSource& source, MeshPlan& plan) {
  for (const dna::Face& face : source.mesh.faces) {
    const size_t corners = face.layout_indices.count;
    plan.face_count += faces_for(corners);
    plan.triangle_count += corners < 3 ? 0 : corners - 2;
  }
  const Mesh& mesh = source.mesh;
  const uint32_t positions = mesh.positions.xs.count;
  plan.fixed_coordinates = source.options.half_storage && are_finite(mesh.texture_coordinates);
  plan.triangles_follow = source.options.half_storage && triangles_follow(mesh);
  if (plan.triangles_follow) {
    plan.vertex_counts = source.scratch.array<uint8_t>(positions);
    if (positions != 0 && !plan.vertex_counts.data) return source.no_memory();
    for (uint32_t v = 0; v < mesh.layouts.positions.count; ++v) {
      uint8_t& count = plan.vertex_counts[mesh.layouts.positions[v]];
      count = static_cast<uint8_t>(std::min(count + 1, 2));
    }
    for_each_listed_corner(mesh, plan, [&](uint32_t) { ++plan.corner_count; });
  }
  plan.directions = source.scratch.array<Vec3>(positions);
  plan.hard = source.scratch.array<uint8_t>(positions);
  if (positions != 0 && (!plan.directions.data || !plan.hard.data)) return source.no_memory();
  for_each_face(mesh, [&](const uint32_t* corners) {
    const Vec3 area = area_vector(mesh, corners);
    for (int k = 0; k < 4; ++k) {
      if (repeats(corners, k)) continue;
      plan.directions[corners[k]] = plan.directions[corners[k]] + area;
    }
  });
  for (Vec3& direction : plan.directions) direction = normalized(direction);
  plan.inward = faces_point_inward(source, plan.directions);
  if (plan.inward) {
    for (Vec3& direction : plan.directions) direction = Vec3{} - direction;
  }
  for (uint32_t v = 0; v < mesh.layouts.positions.count; ++v) {
    const uint32_t p = mesh.layouts.positions[v];
    if (plan.hard[p] != 0 || !is_hard(stored_normal(mesh, v), plan.directions[p])) continue;
    plan.hard[p] = 1;
    ++plan.hard_count;
  }
  return Status::kOk;
}

void place_surface(const MeshPlan& plan, const DeformOptions& options, Placer& placer,
                   DeformMesh& mesh) {
  const size_t positions = mesh.position_count, vertices = mesh.vertex_count;
  const size_t alignment = mesh.array_alignment();
  mesh.positions = placer.array<float>(positions * 3 + 1, alignment);
  mesh.normals = placer.array<float>(vertices * 3 + 1, alignment);
  mesh.tangents = placer.array<float>(options.tangents ? vertices * 4 : 0, alignment);
  const bool fixed = plan.fixed_coordinates && vertices != 0;
  mesh.texture_coordinates = placer.array<float>(fixed ? 4 : vertices * 2, alignment);
  mesh.fixed_coordinates = placer.array<uint16_t>(fixed ? vertices * 2 : 0, alignment);
  mesh.vertex_position_indices = placer.array<uint32_t>(vertices, alignment);
  mesh.triangles =
      placer.array<uint32_t>(plan.triangles_follow ? 0 : plan.triangle_count * 3, alignment);
  place_indices(plan.corner_count, vertices, placer, mesh.corner_vertices, alignment);
  place_indices(plan.face_count * 4, positions, placer, mesh.faces, alignment);
  mesh.first_adjacent_face = placer.array<uint32_t>(positions + 1, alignment);
  place_indices(plan.face_count * 4, plan.face_count, placer, mesh.adjacent_faces, alignment);
  mesh.first_vertex = placer.array<uint32_t>(positions + 1, alignment);
  mesh.vertices = placer.array<uint32_t>(vertices, alignment);
  mesh.sorted_normals = placer.array<float>(options.half_storage ? 0 : vertices * 4, alignment);
  mesh.hard_positions = placer.array<uint32_t>(plan.hard_count, alignment);
  mesh.neutral_directions = placer.array<float>(plan.hard_count * 4, alignment);
}

Status fill_surface(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
  fill_vertices(source.mesh, mesh);
  fill_triangles(source.mesh, plan, mesh);
  fill_faces(source.mesh, plan, mesh);
  fill_vertex_lists(plan, mesh);

  mesh.turned_faces = plan.inward;
  if (plan.inward) {
    for (size_t f = 0; f < mesh.face_count(); ++f) {
      const uint32_t second = mesh.faces[f * 4 + 1];
      mesh.faces.set(f * 4 + 1, mesh.faces[f * 4 + 3]);
      mesh.faces.set(f * 4 + 3, second);
    }
  }
  size_t hard = 0;
  for (uint32_t i = 0; i < mesh.position_count; ++i) {
    const uint32_t p = mesh.position_of(i);
    if (plan.hard[p] == 0) continue;
    mesh.hard_positions[hard] = i;
    store(plan.directions[p], mesh.neutral_directions.data + hard++ * 4);
  }
  for (size_t i = 0; i < mesh.vertices.count; ++i) {
    uint32_t& vertex = mesh.vertices[i];
    const Vec3 recomputed = plan.directions[mesh.vertex_position_indices[vertex]];
    float* stored = mesh.normals.data + size_t{vertex} * 3;
    if (is_zero(load(stored))) store(recomputed, stored);
    if (!mesh.sorted_normals.empty()) {
      std::copy(stored, stored + 3, mesh.sorted_normals.data + i * 4);
    }
    if (is_hard(load(stored), recomputed)) vertex |= kHardEdge;
  }
  return source.options.tangents ? fill_tangents(source, plan.inward, mesh) : Status::kOk;
}

}  // namespace mien
