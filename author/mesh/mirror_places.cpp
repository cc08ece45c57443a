// SPDX-License-Identifier: MIT
#include "author/mesh/mirror_places.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/mesh/point_tree.h"
#include "author/mesh/topology.h"

namespace mien::author {

namespace {

constexpr double kNear = 5e-4;    // of the diagonal: how far a mirror image may be from its partner
constexpr double kAsNear = 0.1;   // of that: what counts as equally near
constexpr double kPaired = 0.95;  // of the places of a symmetric mesh

/// The middle of the skin.
double middle_of(const AuthorMesh& mesh) {
  double low = 0, high = 0;
  bool any = false;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (!mesh.is_skin[v]) continue;
    const double x = mesh.positions[v].x;
    low = any && low < x ? low : x;
    high = any && high > x ? high : x;
    any = true;
  }
  return (low + high) / 2;
}

/// Of unit length, at the first vertex of each place.
void add_normals(const AuthorMesh& mesh, Span<const uint32_t> places, Span<Vec3> normals) {
  for (size_t t = 0; t < mesh.triangles.count; t += 3) {
    const uint32_t* c = &mesh.triangles[t];
    const Vec3 a = mesh.positions[c[0]];
    const Vec3 n = cross(mesh.positions[c[1]] - a, mesh.positions[c[2]] - a);
    for (size_t k = 0; k < 3; ++k) normals[places[c[k]]] = normals[places[c[k]]] + n;
  }
  for (Vec3& n : normals) n = normalized(n);
}

}  // namespace

bool find_mirror(const AuthorMesh& mesh, Span<const uint32_t> places, Arena& arena, Arena& scratch,
                 Span<uint32_t>& mirror) {
  Span<Vec3> points, normals;  // normals of all vertices
  Span<uint32_t> vertices, nearest;
  PointTree tree;
  if (!make(arena, places.count, mirror) || !make(scratch, places.count, points) ||
      !make(scratch, places.count, vertices) || !make(scratch, places.count, nearest) ||
      !make(scratch, places.count, normals)) {
    return false;
  }
  for (uint32_t& partner : mirror) partner = kNone;
  add_normals(mesh, places, normals);
  size_t count = 0;
  for (uint32_t v = 0; v < places.count; ++v) {
    if (places[v] != v) continue;
    points[count] = mesh.positions[v];
    vertices[count++] = v;
  }
  points.count = vertices.count = count;
  if (count == 0) {
    mirror = {};
    return true;
  }
  if (!tree.build(points, scratch)) return false;
  const double plane = middle_of(mesh);
  const double near = kNear * bounding_box(points).diagonal();
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 p = points[i];
    const Vec3 n = normals[vertices[i]], mirrored = {-n.x, n.y, n.z};
    // Where lips or shells touch, several are about equally near: the one that faces the same way.
    Near found[4];
    const uint32_t found_count = tree.nearest({2 * plane - p.x, p.y, p.z}, 4, found);
    double best = 0, farthest = near;
    nearest[i] = kNone;
    for (uint32_t k = 0; k < found_count; ++k) {
      const double distance = std::sqrt(found[k].squared_distance);
      if (distance > farthest) break;
      const double alike = dot(normals[vertices[found[k].point]], mirrored);
      if (!(alike > best)) continue;
      if (best == 0) farthest = std::min(near, distance + kAsNear * near);
      best = alike;
      nearest[i] = found[k].point;
    }
  }
  size_t paired = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t other = nearest[i];
    if (other == kNone || nearest[other] != i) continue;
    mirror[vertices[i]] = vertices[other];
    ++paired;
  }
  if (static_cast<double>(paired) < kPaired * static_cast<double>(count)) mirror = {};
  return true;
}

}  // namespace mien::author
