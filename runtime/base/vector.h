// SPDX-License-Identifier: MIT
// Vectors of three doubles, for compiling and authoring. Kernels have vectors of their own.
#pragma once

#include <cmath>

namespace mien {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }

inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared_distance(Vec3 a, Vec3 b) {
  const Vec3 d = a - b;
  return dot(d, d);
}
inline double length(Vec3 v) { return std::sqrt(dot(v, v)); }
inline bool is_zero(Vec3 v) { return v.x == 0 && v.y == 0 && v.z == 0; }

/// Unit length; `v` is not zero.
inline Vec3 unit(Vec3 v) { return v * (1 / length(v)); }
/// Unit length; zero if `v` is zero or not finite.
inline Vec3 normalized(Vec3 v) {
  const double size = length(v);
  if (!(size > 0) || !std::isfinite(size)) return {};
  return {v.x / size, v.y / size, v.z / size};
}

}  // namespace mien
