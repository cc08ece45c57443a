// SPDX-License-Identifier: MIT
// Neutral tangents from positions, normals and texture coordinates: docs/deformation.md,
// 4 "Tangents".
#include <algorithm>
#include <cmath>

#include "runtime/base/vector.h"
#include "runtime/load/compile/compile_deformer.h"
#include "simd/deform_kernels.h"

namespace mien {
namespace {

/// Tangents of the triangles around a vertex, weighted by their angles. [0]: those where v grows
/// along cross(normal, tangent); [1]: the mirrored ones.
struct TangentSums {
  Vec3 sums[2];
  double angles[2] = {0, 0};
};

Vec3 load_tangent(const float* from) { return {from[0], from[1], from[2]}; }

/// `v` without its part along the unit vector `n`, normalized.
Vec3 project(Vec3 v, Vec3 n) { return normalized(v - n * dot(n, v)); }

/// Arc cosine within 3e-8 (Abramowitz and Stegun, 4.4.46). Not that of the C library, whose last bits
/// differ between systems: compiled deformers are the same everywhere.
double arc_cosine(double x) {
  static constexpr double kTerms[] = {-0.0012624911, 0.0066700901, -0.0170881256, 0.0308918810,
                                      -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050};
  const double magnitude = std::min(std::fabs(x), 1.0);
  double sum = 0;
  for (double term : kTerms) sum = sum * magnitude + term;
  const double angle = std::sqrt(1 - magnitude) * sum;
  return x < 0 ? 3.14159265358979323846 - angle : angle;
}

/// A unit vector perpendicular to the unit vector n; x if n is zero. Kernels use the same formula
/// (Duff et al., "Building an Orthonormal Basis, Revisited").
Vec3 perpendicular(Vec3 n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1 / (sign + n.z);
  return {1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

/// Adds the tangent of one triangle to its three vertices.
void add_triangle(const dna::Mesh& source, const DeformMesh& mesh, const uint32_t* triangle,
                  bool inward, Span<TangentSums> vertices) {
  Vec3 p[3];
  double u[3], v[3];
  for (int k = 0; k < 3; ++k) {
    p[k] =
        load_tangent(mesh.positions.data + size_t{mesh.vertex_position_indices[triangle[k]]} * 3);
    float uv[2];
    read_coordinates(source, triangle[k], uv);
    u[k] = uv[0];
    v[k] = uv[1];
  }
  const double u1 = u[1] - u[0], v1 = v[1] - v[0], u2 = u[2] - u[0], v2 = v[2] - v[0];
  const double area = u1 * v2 - v1 * u2;
  const Vec3 edge1 = p[1] - p[0], edge2 = p[2] - p[0];
  if (!(std::fabs(area) > 0) || is_zero(cross(edge1, edge2))) return;  // degenerate; or NaN
  // The direction in which u grows and v does not change.
  const Vec3 direction = (edge1 * v2 - edge2 * v1) * (area > 0 ? 1 : -1);
  const int mirrored = (area < 0) != inward;
  for (int k = 0; k < 3; ++k) {
    const Vec3 n = load_tangent(mesh.normals.data + size_t{triangle[k]} * 3);
    const Vec3 tangent = project(direction, n);
    const Vec3 to_next = project(p[(k + 1) % 3] - p[k], n);
    const Vec3 to_previous = project(p[(k + 2) % 3] - p[k], n);
    const double angle = arc_cosine(dot(to_next, to_previous));
    TangentSums& vertex = vertices[triangle[k]];
    vertex.sums[mirrored] = vertex.sums[mirrored] + tangent * angle;
    vertex.angles[mirrored] += is_zero(tangent) ? 0 : angle;
  }
}

}  // namespace

Status fill_tangents(const MeshSource& source, bool inward, DeformMesh& mesh) {
  const Span<TangentSums> vertices = source.scratch.array<TangentSums>(mesh.vertex_count);
  if (mesh.vertex_count != 0 && !vertices.data) return source.no_memory();
  for_each_triangle(source.mesh, [&](const uint32_t* triangle) {
    add_triangle(source.mesh, mesh, triangle, inward, vertices);
  });
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const TangentSums& vertex = vertices[v];
    const int mirrored = vertex.angles[1] > vertex.angles[0];
    Vec3 tangent = normalized(vertex.sums[mirrored]);
    const bool has_direction = !is_zero(tangent);
    if (!has_direction) tangent = perpendicular(load_tangent(mesh.normals.data + size_t{v} * 3));
    float* out = mesh.tangents.data + size_t{v} * 4;
    out[0] = static_cast<float>(tangent.x);
    out[1] = static_cast<float>(tangent.y);
    out[2] = static_cast<float>(tangent.z);
    out[3] = has_direction && mirrored ? -1.0f : 1.0f;
  }
  return Status::kOk;
}

}  // namespace mien
