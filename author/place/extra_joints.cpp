// SPDX-License-Identifier: MIT
#include "author/place/extra_joints.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/mesh/eigenvectors.h"
#include "author/mesh/topology.h"

namespace mien::author {

namespace {

/// Solves a x = b in place by elimination with the largest pivot; false if `a` is singular.
template <int N>
bool solve(double (&a)[N][N + 1]) {
  for (int i = 0; i < N; ++i) {
    int pivot = i;
    for (int r = i + 1; r < N; ++r) {
      if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
    }
    if (!(std::abs(a[pivot][i]) > 1e-12)) return false;
    for (int c = 0; c <= N; ++c) std::swap(a[i][c], a[pivot][c]);
    for (int r = 0; r < N; ++r) {
      const double factor = r == i ? 0 : a[r][i] / a[i][i];
      for (int c = i; c <= N && factor != 0; ++c) a[r][c] -= factor * a[i][c];
    }
  }
  for (int i = 0; i < N; ++i) a[i][N] /= a[i][i];
  return true;
}

Vec3 mean_of(Span<const Vec3> points) {
  Vec3 sum;
  for (const Vec3& p : points) sum = sum + p;
  return sum * (1.0 / static_cast<double>(points.count));
}

}  // namespace

bool fit_sphere(Span<const Vec3> points, Sphere& out) {
  if (points.count < 8) return false;
  const Vec3 mean = mean_of(points);
  const double scale = bounding_box(points).diagonal();
  if (!(scale > 0)) return false;
  // |p|^2 = 2 c p + (r^2 - |c|^2), in units of the box about the mean.
  double a[4][5] = {};
  for (const Vec3& point : points) {
    const Vec3 p = (point - mean) * (1 / scale);
    const double row[5] = {2 * p.x, 2 * p.y, 2 * p.z, 1, dot(p, p)};
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 5; ++k) a[i][k] += row[i] * row[k] / static_cast<double>(points.count);
    }
  }
  if (!solve(a)) return false;
  const Vec3 center = {a[0][4], a[1][4], a[2][4]};
  const double square = a[3][4] + dot(center, center);
  if (!(square > 0)) return false;
  out.radius = std::sqrt(square) * scale;
  out.center = mean + center * scale;
  double sum = 0;
  for (const Vec3& p : points) {
    const double off = length(p - out.center) - out.radius;
    sum += off * off;
  }
  out.error = std::sqrt(sum / static_cast<double>(points.count));
  return true;
}

RigidMotion fit_rigid(Span<const Vec3> from, Span<const Vec3> to) {
  const Vec3 p = mean_of(from), q = mean_of(to);
  double s[3][3] = {};
  for (size_t i = 0; i < from.count; ++i) {
    const Vec3 a = from[i] - p, b = to[i] - q;
    const double av[3] = {a.x, a.y, a.z}, bv[3] = {b.x, b.y, b.z};
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) s[r][c] += av[r] * bv[c];
    }
  }
  double n[4][4] = {
      {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
      {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
      {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
      {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}};
  double vectors[4][4];
  diagonalize(n, vectors);
  int largest = 0;
  for (int k = 1; k < 4; ++k) {
    if (n[k][k] > n[largest][largest]) largest = k;
  }
  const double w = vectors[0][largest], x = vectors[1][largest], y = vectors[2][largest],
               z = vectors[3][largest];
  RigidMotion motion = {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                         {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                         {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}},
                        {},
                        0};
  const auto& r = motion.rotation;
  motion.shift = q - Vec3{dot({r[0][0], r[0][1], r[0][2]}, p), dot({r[1][0], r[1][1], r[1][2]}, p),
                          dot({r[2][0], r[2][1], r[2][2]}, p)};
  const double sine = std::sqrt(x * x + y * y + z * z);
  motion.angle = 2 * exact_atan2(sine, std::abs(w)) * (180 / kPi);
  return motion;
}

bool find_eyes(const AuthorMesh& mesh, double plane, bool symmetric, Arena& scratch,
               Eye (&eyes)[kMaxEyes], uint32_t& count, Span<uint32_t> eye_of_component) {
  // Parts of the diagonal of the skin: an eyeball of 2.4 cm, a head of 35 cm; and of its radius.
  constexpr double kSmallest = 0.012, kLargest = 0.12, kRound = 0.06, kWhole = 1.2;
  const size_t n = mesh.positions.count;
  count = 0;
  for (uint32_t& eye : eye_of_component) eye = kNone;
  Span<Vec3> points;
  Span<uint32_t> ends, members;
  if (!make(scratch, n, points) || !make(scratch, n, members) ||
      !make(scratch, mesh.component_count + 1, ends)) {
    return false;
  }
  for (uint32_t v = 0; v < n; ++v) ++ends[mesh.component[v] + 1];
  for (uint32_t c = 0; c < mesh.component_count; ++c) ends[c + 1] += ends[c];
  // ends[c] is the start of component c, and its end once its members are filled in.
  for (uint32_t v = 0; v < n; ++v) members[ends[mesh.component[v]]++] = v;
  for (uint32_t c = 0, from = 0; c < mesh.component_count; from = ends[c++]) {
    size_t used = 0;
    for (uint32_t i = from; i < ends[c]; ++i) {
      if (mesh.welded[members[i]] == members[i]) points[used++] = mesh.positions[members[i]];
    }
    if (mesh.is_skin[members[from]]) continue;
    Sphere sphere;
    if (!fit_sphere(points.first(used), sphere)) continue;
    const Vec3 size = bounding_box(points.first(used)).size();
    if (sphere.radius < kSmallest * mesh.diagonal / 2 ||
        sphere.radius > kLargest * mesh.diagonal / 2 || sphere.error > kRound * sphere.radius ||
        std::min(size.x, size.y) < kWhole * sphere.radius) {
      continue;
    }
    uint32_t eye = 0;
    while (eye < count && length(eyes[eye].center - sphere.center) > eyes[eye].radius / 2) ++eye;
    if (eye == kMaxEyes) continue;
    if (eye == count) {
      const double off = sphere.center.x - plane;
      const int side = std::abs(off) < sphere.radius / 2 ? 0 : off > 0 ? 1 : -1;
      eyes[count++] = {sphere.center, sphere.radius, side};
    }
    eye_of_component[c] = eye;
  }
  // Left and right as mirror images, if they nearly are.
  for (uint32_t a = 0; a < count && symmetric; ++a) {
    for (uint32_t b = a + 1; b < count; ++b) {
      const Vec3 p = eyes[a].center, q = eyes[b].center;
      const Vec3 mirrored = {2 * plane - q.x, q.y, q.z};
      if (eyes[a].side * eyes[b].side != -1 || length(p - mirrored) > eyes[a].radius / 2) continue;
      const Vec3 mean = (p + mirrored) * 0.5;
      eyes[a].center = mean;
      eyes[b].center = {2 * plane - mean.x, mean.y, mean.z};
    }
  }
  return true;
}

// Jaw
// ----------------------------------------------------------------------------------------------

namespace {

/// Letters of the name in lower case, without separators.
uint32_t letters_of(Name name, char (&out)[256]) {
  uint32_t count = 0;
  for (char c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c >= 'a' && c <= 'z' && count < sizeof(out) - 1) out[count++] = c;
  }
  out[count] = 0;
  return count;
}

}  // namespace

uint32_t jaw_open_shape(const AuthorMesh& mesh) {
  // The simplest name is taken: jawOpen before mouthOpen before jawOpenWide.
  constexpr const char* kNames[] = {"jawopen", "jawdrop", "openjaw", "mouthopen", "openmouth"};
  for (const char* wanted : kNames) {
    for (int exact = 1; exact >= 0; --exact) {
      for (uint32_t s = 0; s < mesh.shapes.count; ++s) {
        char letters[256];
        letters_of(mesh.shapes[s].name, letters);
        if (exact ? strcmp(letters, wanted) == 0 : strstr(letters, wanted) != nullptr) return s;
      }
    }
  }
  return kNone;
}

bool find_jaw(const AuthorMesh& mesh, double plane, Arena& scratch, Jaw& out) {
  constexpr size_t kChin = 200;
  constexpr double kLeastAngle = 2, kLeastMotion = 0.005;  // degrees; part of the diagonal
  out = Jaw();
  out.shape = jaw_open_shape(mesh);
  if (out.shape == kNone) return true;
  const Shape& shape = mesh.shapes[out.shape];
  struct Moved {
    double motion;
    uint32_t vertex;
  };
  Span<Moved> moved;
  if (!make(scratch, shape.moving.count, moved)) return false;
  size_t count = 0;
  for (uint32_t v : shape.moving) {
    if (!mesh.is_skin[v] || mesh.welded[v] != v) continue;
    const Vec3f d = shape.displacements[v];
    moved[count++] = {length({d.x, d.y, d.z}), v};
  }
  // Equal motions are ordered by position, not by index, which depends on the file.
  std::sort(moved.data, moved.data + count, [&](const Moved& a, const Moved& b) {
    if (a.motion != b.motion) return a.motion > b.motion;
    const Vec3 p = mesh.positions[a.vertex], q = mesh.positions[b.vertex];
    if (p.y != q.y) return p.y < q.y;
    return p.z != q.z ? p.z < q.z : p.x < q.x;
  });
  count = std::min(count, kChin);
  if (count < 8) return true;
  Span<Vec3> from, to;
  if (!make(scratch, count, from) || !make(scratch, count, to)) return false;
  for (size_t i = 0; i < count; ++i) {
    const Vec3f d = shape.displacements[moved[i].vertex];
    from[i] = mesh.positions[moved[i].vertex];
    to[i] = from[i] + Vec3{d.x, d.y, d.z};
    out.chin_motion += moved[i].motion / static_cast<double>(count);
  }
  const RigidMotion motion = fit_rigid(from, to);
  out.angle = motion.angle;
  if (motion.angle < kLeastAngle || out.chin_motion < kLeastMotion * mesh.diagonal) return true;

  // The point of the plane that moves least: (R - I) p + shift, in y and z.
  double normal[2][3] = {};
  const auto& r = motion.rotation;
  const double rest[3] = {motion.shift.x + (r[0][0] - 1) * plane, motion.shift.y + r[1][0] * plane,
                          motion.shift.z + r[2][0] * plane};
  for (int i = 0; i < 3; ++i) {
    const double row[2] = {r[i][1] - (i == 1), r[i][2] - (i == 2)};
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) normal[a][b] += row[a] * row[b];
      normal[a][2] -= row[a] * rest[i];
    }
  }
  if (!solve(normal)) return true;
  out.position = {plane, normal[0][2], normal[1][2]};
  // If the axis is far from the head, the shape does not turn a jaw.
  Vec3 center;
  for (const Vec3& p : from) center = center + p * (1.0 / static_cast<double>(count));
  out.found = length(out.position - center) < 0.75 * mesh.diagonal;
  return true;
}

}  // namespace mien::author
