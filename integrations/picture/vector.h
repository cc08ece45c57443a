// SPDX-License-Identifier: MIT
// Three numbers: a place, a direction or a linear color.
#pragma once

#include <algorithm>
#include <cmath>

namespace mien::picture {

struct Vec3 {
  float x = 0, y = 0, z = 0;
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }

inline float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
/// `otherwise` if there is no direction in it.
inline Vec3 normalized(Vec3 a, Vec3 otherwise) {
  const float l = length(a);
  return l > 0 && std::isfinite(l) ? a * (1 / l) : otherwise;
}
inline Vec3 mix(Vec3 a, Vec3 b, float t) { return a + (b - a) * t; }
inline float saturate(float x) { return std::min(std::max(x, 0.0f), 1.0f); }
inline bool is_finite(Vec3 a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
inline Vec3 load3(const float* values, size_t index) {
  return {values[3 * index], values[3 * index + 1], values[3 * index + 2]};
}

/// An axis-aligned box, empty at first. Ignores what is not finite.
struct Box {
  Vec3 least = {INFINITY, INFINITY, INFINITY}, most = {-INFINITY, -INFINITY, -INFINITY};

  void add(Vec3 p) {
    if (!is_finite(p)) return;
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  bool empty() const { return !(least.x <= most.x); }
  Vec3 center() const { return least * 0.5f + most * 0.5f; }
  Vec3 size() const { return most - least; }
};

}  // namespace mien::picture
