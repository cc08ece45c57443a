// SPDX-License-Identifier: MIT
// Vectors of three numbers: points, directions, linear colors. Floats for images, doubles for
// exported files, whose numbers should be exact to the last digit of a float.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace mien::math {

template <class T>
struct Vector3 {
  T x = 0, y = 0, z = 0;

  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

using Vec3 = Vector3<float>;
using Vec3d = Vector3<double>;

template <class T>
Vector3<T> operator+(Vector3<T> a, Vector3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vector3<T> operator-(Vector3<T> a, Vector3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vector3<T> operator-(Vector3<T> a) {
  return {-a.x, -a.y, -a.z};
}
/// By component.
template <class T>
Vector3<T> operator*(Vector3<T> a, Vector3<T> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Vec3 operator*(Vec3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec3d operator*(Vec3d a, double s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T>
Vector3<T>& operator+=(Vector3<T>& a, Vector3<T> b) {
  return a = a + b;
}
template <class T>
bool operator==(Vector3<T> a, Vector3<T> b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
template <class T>
bool operator!=(Vector3<T> a, Vector3<T> b) {
  return !(a == b);
}

template <class T>
T dot(Vector3<T> a, Vector3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vector3<T> cross(Vector3<T> a, Vector3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vector3<T> a) {
  return std::sqrt(dot(a, a));
}
/// `a` at length 1, or `fallback` if it has no direction.
template <class T>
Vector3<T> normalized(Vector3<T> a, Vector3<T> fallback) {
  const T l = length(a);
  return l > 0 && std::isfinite(l) ? a * (1 / l) : fallback;
}
template <class T>
bool is_finite(Vector3<T> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

inline Vec3 mix(Vec3 a, Vec3 b, float t) { return a + (b - a) * t; }
inline float saturate(float x) { return std::min(std::max(x, 0.0f), 1.0f); }
/// Element `index` of an array x y z x y z ...
inline Vec3 load3(const float* values, std::size_t index) {
  return {values[3 * index], values[3 * index + 1], values[3 * index + 2]};
}

/// An axis-aligned box, empty at first. Ignores points that are not finite.
template <class T>
struct Box3 {
  Vector3<T> min = {INFINITY, INFINITY, INFINITY}, max = {-INFINITY, -INFINITY, -INFINITY};

  void add(Vector3<T> p) {
    if (!is_finite(p)) return;
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  bool empty() const { return !(min.x <= max.x); }
  Vector3<T> center() const { return min * T(0.5) + max * T(0.5); }
  Vector3<T> size() const { return max - min; }
};

using Box = Box3<float>;
using Boxd = Box3<double>;

}  // namespace mien::math
