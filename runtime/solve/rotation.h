// SPDX-License-Identifier: MIT
// Rotations of solvers: unit quaternions in double precision. Only + - * / and square roots, which
// IEEE 754 rounds in one way, so that a stack gives the same bits everywhere.
#pragma once

#include "runtime/base/vector.h"

namespace mien::solve {

struct Rotation {
  double x = 0, y = 0, z = 0, w = 1;
};

/// Turns by b first.
inline Rotation operator*(const Rotation& a, const Rotation& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
inline Rotation inverse(const Rotation& q) { return {-q.x, -q.y, -q.z, q.w}; }

/// Unit length; the identity if there is no direction.
inline Rotation unit(const Rotation& q) {
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(square > 0) || !std::isfinite(square)) return {};
  const double s = 1 / std::sqrt(square);
  return {q.x * s, q.y * s, q.z * s, q.w * s};
}

inline Vec3 turn(const Rotation& q, Vec3 v) {
  const Vec3 axis = {q.x, q.y, q.z}, t = cross(axis, v) * 2;
  return v + t * q.w + cross(axis, t);
}

/// The shortest one from a to b, both of unit length.
inline Rotation between(Vec3 a, Vec3 b) {
  const double w = 1 + dot(a, b);
  if (w > 1e-12) {
    const Vec3 axis = cross(a, b);
    return unit({axis.x, axis.y, axis.z, w});
  }
  // Opposite: half a turn about anything across.
  const Vec3 side = std::fabs(a.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 axis = normalized(cross(a, side));
  return {axis.x, axis.y, axis.z, 0};
}

/// A fraction 0 ... 1 of a rotation, by the shorter way, within 1e-7 radians; found by repeated halving.
inline Rotation part_of(Rotation q, double share) {
  if (share >= 1) return q;
  if (!(share > 0)) return {};
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  Rotation part;
  for (int i = 0; i < 8; ++i) {
    q = unit({q.x, q.y, q.z, q.w + 1});
    share *= 2;
    if (share < 1) continue;
    share -= 1;
    part = part * q;
  }
  return part * unit({q.x * share, q.y * share, q.z * share, 1 + (q.w - 1) * share});
}

/// The twist of a rotation about a unit axis: rotation = swing * twist.
inline Rotation twist_of(const Rotation& q, Vec3 axis) {
  const double along = q.x * axis.x + q.y * axis.y + q.z * axis.z;
  return unit({axis.x * along, axis.y * along, axis.z * along, q.w});
}

/// From a matrix of four columns of four, without its scale.
inline Rotation rotation_of(const float* m) {
  const Vec3 x = normalized(Vec3{m[0], m[1], m[2]}), y = normalized(Vec3{m[4], m[5], m[6]});
  const Vec3 z = normalized(cross(x, y)), y2 = cross(z, x);
  const double trace = x.x + y2.y + z.z;
  if (trace > 0) return unit({y2.z - z.y, z.x - x.z, x.y - y2.x, 1 + trace});
  if (x.x >= y2.y && x.x >= z.z) {
    return unit({1 + x.x - y2.y - z.z, x.y + y2.x, z.x + x.z, y2.z - z.y});
  }
  if (y2.y >= z.z) return unit({x.y + y2.x, 1 + y2.y - x.x - z.z, y2.z + z.y, z.x - x.z});
  return unit({z.x + x.z, y2.z + z.y, 1 + z.z - x.x - y2.y, x.y - y2.x});
}

}  // namespace mien::solve
