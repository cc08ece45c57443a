// SPDX-License-Identifier: MIT
// Vectors, rotations and matrices of the exporter, in doubles: its arithmetic should be exact to
// the last digit of the 32-bit floats that it writes.
#pragma once

#include <array>

namespace mien::gltf {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(const Vec3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// `v` at length 1, or `otherwise` if it has no direction.
Vec3 normalized(const Vec3& v, const Vec3& otherwise);

/// x, y, z, w
using Quaternion = std::array<double, 4>;

Quaternion normalized(const Quaternion& q);
/// `b` turns first.
Quaternion operator*(const Quaternion& a, const Quaternion& b);

/// Scale first, then rotation, then translation.
struct Transform {
  Vec3 translation = {0, 0, 0};
  Quaternion rotation = {0, 0, 0, 1};
  Vec3 scale = {1, 1, 1};
};

/// Three rows of an affine matrix for column vectors; the fourth is 0 0 0 1.
struct Matrix {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

Matrix matrix_of(const Transform& transform);
/// `b` is applied first.
Matrix operator*(const Matrix& a, const Matrix& b);
/// The identity if there is none.
Matrix inverse(const Matrix& a);

}  // namespace mien::gltf
