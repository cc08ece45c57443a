// SPDX-License-Identifier: MIT
// Rotations, transforms and affine matrices, in doubles.
#pragma once

#include "integrations/program/math/vector.h"

namespace mien::math {

struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};

inline bool operator==(const Quaternion& a, const Quaternion& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}
inline bool operator!=(const Quaternion& a, const Quaternion& b) { return !(a == b); }

/// The identity if `q` is zero or not finite.
Quaternion normalized(const Quaternion& q);

/// Scale first, then rotation, then translation.
struct Transform {
  Vec3d translation;
  Quaternion rotation;
  Vec3d scale = {1, 1, 1};
};

/// `b` is applied first. Exact if the scale of `a` is the same along all axes.
Transform operator*(const Transform& a, const Transform& b);

/// Three rows of an affine matrix for column vectors; the fourth is 0 0 0 1.
struct Matrix {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

Matrix matrix_of(const Transform& transform);
/// `b` is applied first.
Matrix operator*(const Matrix& a, const Matrix& b);
/// The identity if `a` has no inverse.
Matrix inverse(const Matrix& a);

}  // namespace mien::math
