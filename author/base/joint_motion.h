// SPDX-License-Identifier: MIT
// How joints move points: deltas as in the joint matrix, and the maps that they result in where all neutral
// rotations are zero.
#pragma once

#include <cstddef>
#include <cstdint>

#include "author/base/exact_math.h"
#include "runtime/base/span.h"
#include "runtime/base/vector.h"

namespace mien::author {

/// Delta of a joint at full value: centimeters, degrees.
struct JointDelta {
  float translation[3] = {};
  float rotation[3] = {};

  bool is_zero() const {
    for (int k = 0; k < 3; ++k) {
      if (translation[k] != 0 || rotation[k] != 0) return false;
    }
    return true;
  }
};

/// Rows of all shapes: [shape * joint count + joint].
struct JointDeltas {
  Span<JointDelta> items;
  uint32_t joint_count = 0;

  JointDelta& at(uint32_t shape, uint32_t joint) const {
    return items[size_t{shape} * joint_count + joint];
  }
};

/// x -> linear * x + shift, rows of `linear`.
struct Affine {
  Vec3 rows[3];
  Vec3 shift;

  static Affine identity() { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}}; }
  bool operator==(const Affine& o) const {
    const auto same = [](Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
    return same(shift, o.shift) && same(rows[0], o.rows[0]) && same(rows[1], o.rows[1]) &&
           same(rows[2], o.rows[2]);
  }
  bool is_identity() const { return *this == identity(); }
  Vec3 turn(Vec3 v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  Vec3 operator()(Vec3 p) const { return turn(p) + shift; }
};

/// a after b.
inline Affine operator*(const Affine& a, const Affine& b) {
  Affine out;
  for (int r = 0; r < 3; ++r) {
    out.rows[r] = b.rows[0] * a.rows[r].x + b.rows[1] * a.rows[r].y + b.rows[2] * a.rows[r].z;
  }
  out.shift = a(b.shift);
  return out;
}

/// The inverse of a rigid motion.
inline Affine inverse(const Affine& a) {
  Affine out;
  out.rows[0] = {a.rows[0].x, a.rows[1].x, a.rows[2].x};
  out.rows[1] = {a.rows[0].y, a.rows[1].y, a.rows[2].y};
  out.rows[2] = {a.rows[0].z, a.rows[1].z, a.rows[2].z};
  out.shift = -out.turn(a.shift);
  return out;
}

/// Turns about x, then y, then z (degrees), about `center`, then shifts.
inline Affine motion(const double angles[3], Vec3 center, Vec3 shift) {
  const auto [sx, cx] = exact_sine_cosine(angles[0] * kPi / 180);
  const auto [sy, cy] = exact_sine_cosine(angles[1] * kPi / 180);
  const auto [sz, cz] = exact_sine_cosine(angles[2] * kPi / 180);
  Affine out;
  out.rows[0] = {cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx};
  out.rows[1] = {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx};
  out.rows[2] = {-sy, cy * sx, cy * cx};
  out.shift = center + shift - out.turn(center);
  return out;
}

/// Influences of one vertex.
struct Influences {
  const uint16_t* joints;
  const float* weights;
  uint32_t count;
};

inline Vec3 skin(const Affine* pose, const Influences& influences, Vec3 p) {
  Vec3 out;
  for (uint32_t i = 0; i < influences.count; ++i) {
    out = out + pose[influences.joints[i]](p) * static_cast<double>(influences.weights[i]);
  }
  return out;
}

/// The offset to add to `p` before skinning so that it ends at `target`; the plain difference where the
/// blended rotations nearly cancel each other.
inline Vec3 residual(const Affine* pose, const Influences& influences, Vec3 p, Vec3 target) {
  const Vec3 r = target - skin(pose, influences, p);
  // Blend shapes are added before skinning, so this inverts its linear part, by Cramer's rule.
  Vec3 m[3];
  for (uint32_t i = 0; i < influences.count; ++i) {
    for (int k = 0; k < 3; ++k) {
      m[k] = m[k] + pose[influences.joints[i]].rows[k] * static_cast<double>(influences.weights[i]);
    }
  }
  const Vec3 c0 = cross(m[1], m[2]), c1 = cross(m[2], m[0]), c2 = cross(m[0], m[1]);
  const double determinant = dot(m[0], c0);
  if (std::abs(determinant) < 0.05) return r;
  return (c0 * r.x + c1 * r.y + c2 * r.z) * (1 / determinant);
}

}  // namespace mien::author
