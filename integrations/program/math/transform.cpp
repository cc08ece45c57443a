// SPDX-License-Identifier: MIT
#include "integrations/program/math/transform.h"

namespace mien::math {

Quaternion normalized(const Quaternion& q) {
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

Matrix matrix_of(const Transform& transform) {
  const auto [x, y, z, w] = transform.rotation;
  const double rotation[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
      {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
      {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  Matrix matrix;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) matrix.m[r][c] = rotation[r][c] * transform.scale[c];
    matrix.m[r][3] = transform.translation[r];
  }
  return matrix;
}

Transform operator*(const Transform& a, const Transform& b) {
  const Quaternion &p = a.rotation, &q = b.rotation;
  const Matrix m = matrix_of(a);
  Transform product;
  for (int r = 0; r < 3; ++r) {
    product.translation[r] = m.m[r][3];
    for (int c = 0; c < 3; ++c) product.translation[r] += m.m[r][c] * b.translation[c];
    product.scale[r] = a.scale[r] * b.scale[r];
  }
  product.rotation = {
      p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y, p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
      p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w, p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z};
  return product;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      product.m[r][c] = c == 3 ? a.m[r][3] : 0;
      for (int k = 0; k < 3; ++k) product.m[r][c] += a.m[r][k] * b.m[k][c];
    }
  }
  return product;
}

Matrix inverse(const Matrix& a) {
  const Vec3d rows[3] = {{a.m[0][0], a.m[0][1], a.m[0][2]},
                         {a.m[1][0], a.m[1][1], a.m[1][2]},
                         {a.m[2][0], a.m[2][1], a.m[2][2]}};
  const double determinant = dot(rows[0], cross(rows[1], rows[2]));
  Matrix result;
  if (!std::isnormal(determinant)) return result;
  for (int c = 0; c < 3; ++c) {
    const Vec3d column = cross(rows[(c + 1) % 3], rows[(c + 2) % 3]) * (1 / determinant);
    for (int r = 0; r < 3; ++r) result.m[r][c] = column[r];
  }
  for (int r = 0; r < 3; ++r) {
    result.m[r][3] = 0;
    for (int k = 0; k < 3; ++k) result.m[r][3] -= result.m[r][k] * a.m[k][3];
  }
  return result;
}

}  // namespace mien::math
