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

Vec3 mean_of(Span<const Vec3> points, Span<const double> weights = {}) {
  Vec3 sum;
  double all = 0;
  for (size_t i = 0; i < points.count; ++i) {
    const double weight = weights.empty() ? 1 : weights[i];
    sum = sum + points[i] * weight;
    all += weight;
  }
  return sum * (1 / all);
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

RigidMotion fit_rigid(Span<const Vec3> from, Span<const Vec3> to, Span<const double> weights) {
  const Vec3 p = mean_of(from, weights), q = mean_of(to, weights);
  double s[3][3] = {};
  for (size_t i = 0; i < from.count; ++i) {
    const Vec3 a = (from[i] - p) * (weights.empty() ? 1 : weights[i]), b = to[i] - q;
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
      eyes[count++] = {sphere.center, sphere.radius, side, sphere.error};
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

bool is_called(Name name, const char* part) {
  char letters[256];
  letters_of(name, letters);
  return strstr(letters, part) != nullptr;
}

}  // namespace

bool find_tongue(const AuthorMesh& mesh, Arena& scratch, Tongue& out) {
  constexpr double kLeastMotion = 0.005;  // part of the diagonal
  out = Tongue();
  const size_t n = mesh.positions.count, components = mesh.component_count;
  Span<double> most;
  Span<uint8_t> named;
  if (!make(scratch, components, most) || !make(scratch, components, named)) return false;
  for (const Part& part : mesh.parts) {
    if (!is_called(part.name, "tongue")) continue;
    for (uint32_t v = part.first_vertex; v < part.first_vertex + part.vertex_count; ++v) {
      named[mesh.component[v]] = 1;
    }
  }
  for (const Shape& shape : mesh.shapes) {
    if (!is_called(shape.name, "tongue")) continue;
    for (const uint32_t v : shape.moving) {
      const Vec3f d = shape.displacements[v];
      double& motion = most[mesh.component[v]];
      motion = std::max(motion, length({d.x, d.y, d.z}));
    }
  }
  const double least = kLeastMotion * mesh.diagonal;
  for (uint32_t v = 0; v < n; ++v) {
    const uint32_t c = mesh.component[v];
    if (mesh.is_skin[v] || !(named[c] || most[c] > least)) continue;
    const bool is_better = out.component == kNone || named[c] > named[out.component] ||
                           (named[c] == named[out.component] && most[c] > most[out.component]);
    if (is_better) out.component = c;
  }
  if (out.component == kNone) return true;
  // From the root to the tip, which points to the front.
  double front = 0, back = 0;
  bool first = true;
  for (uint32_t v = 0; v < n; ++v) {
    if (mesh.component[v] != out.component) continue;
    const double z = mesh.positions[v].z;
    front = first ? z : std::max(front, z);
    back = first ? z : std::min(back, z);
    first = false;
  }
  double counts[Tongue::kJoints] = {};
  for (uint32_t v = 0; v < n; ++v) {
    if (mesh.component[v] != out.component || mesh.welded[v] != v) continue;
    const double along = front > back ? (mesh.positions[v].z - back) / (front - back) : 0;
    const int slice = std::min(Tongue::kJoints - 1, static_cast<int>(along * Tongue::kJoints));
    out.joints[slice] = out.joints[slice] + mesh.positions[v];
    counts[slice] += 1;
  }
  for (int i = 0; i < Tongue::kJoints; ++i) {
    if (!(counts[i] > 0)) {
      out.component = kNone;
      return true;
    }
    out.joints[i] = out.joints[i] * (1 / counts[i]);
  }
  return true;
}

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
  constexpr size_t kChin = 200, kTeeth = 20;
  constexpr double kPart = 0.5, kAgreed = 0.02;  // of the chin's motion
  constexpr int kRounds = 30;
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
  size_t count = 0, skin = 0;
  for (uint32_t v : shape.moving) {
    if (mesh.welded[v] != v) continue;
    const Vec3f d = shape.displacements[v];
    moved[count++] = {length({d.x, d.y, d.z}), v};
    skin += mesh.is_skin[v];
  }
  // Equal motions are ordered by position, not by index, which depends on the file.
  std::sort(moved.data, moved.data + count, [&](const Moved& a, const Moved& b) {
    if (a.motion != b.motion) return a.motion > b.motion;
    const Vec3 p = mesh.positions[a.vertex], q = mesh.positions[b.vertex];
    if (p.y != q.y) return p.y < q.y;
    return p.z != q.z ? p.z < q.z : p.x < q.x;
  });
  if (skin < 8) return true;
  // The chin: the skin that moves most, but for a tenth of it at most.
  const size_t chin = std::min(kChin, std::max<size_t>(skin / 10, 8));
  for (size_t i = 0, used = 0; i < count && used < chin; ++i) {
    if (!mesh.is_skin[moved[i].vertex]) continue;
    out.chin_motion += moved[i].motion / static_cast<double>(chin);
    ++used;
  }
  // Vertices outside the skin that move at least half as far are the lower teeth and what they carry.
  // Without any, the chin is used.
  const double least = kPart * out.chin_motion;
  size_t teeth = 0;
  for (size_t i = 0; i < count && moved[i].motion >= least; ++i) {
    teeth += !mesh.is_skin[moved[i].vertex];
  }
  const bool has_teeth = teeth >= kTeeth;
  out.by_teeth = has_teeth;
  const size_t all = has_teeth ? teeth : chin;
  Span<Vec3> from, to;
  Span<double> weights;
  if (!make(scratch, all, from) || !make(scratch, all, to) || !make(scratch, all, weights)) {
    return false;
  }
  for (size_t i = 0, used = 0; used < all; ++i) {
    if (bool{mesh.is_skin[moved[i].vertex] != 0} == has_teeth) continue;
    const Vec3f d = shape.displacements[moved[i].vertex];
    from[used] = mesh.positions[moved[i].vertex];
    to[used] = from[used] + Vec3{d.x, d.y, d.z};
    ++used;
  }
  RigidMotion motion = fit_rigid(from, to);
  // Not all of it is rigid, such as a tongue: vertices are weighted by the inverse of their residuals.
  for (int round = 0; round < kRounds && has_teeth; ++round) {
    for (size_t i = 0; i < all; ++i) {
      weights[i] = 1 / (length(to[i] - motion(from[i])) + kAgreed * out.chin_motion);
    }
    motion = fit_rigid(from, to, weights);
  }
  out.angle = motion.angle;
  out.motion = motion;
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
  for (const Vec3& p : from) center = center + p * (1.0 / static_cast<double>(all));
  out.found = length(out.position - center) < 0.75 * mesh.diagonal;
  return true;
}

}  // namespace mien::author
