// SPDX-License-Identifier: MIT
#include "runtime/base/transform.h"

#include <cmath>

namespace mien {

Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

RotationConvention rotation_convention(uint32_t sequence, const int32_t signs[3], uint32_t unit) {
  static constexpr uint8_t kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                          {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  RotationConvention convention;
  for (int i = 0; i < 3; ++i) {
    convention.axes[i] = kAxes[sequence][i];
    convention.signs[i] = static_cast<float>(signs[i]);
  }
  const bool even = sequence == 0 || sequence == 3 || sequence == 4;
  convention.parity = even ? 1.0f : -1.0f;
  convention.to_radians = unit == 0 ? 0.017453292519943295f : 1.0f;
  return convention;
}

Quaternion quaternion_from_euler(const RotationConvention& convention, const float angles[3]) {
  Quaternion q;
  for (uint8_t axis : convention.axes) {
    const float half = angles[axis] * convention.signs[axis] * convention.to_radians * 0.5f;
    float turn[4] = {0, 0, 0, std::cos(half)};
    turn[axis] = std::sin(half);
    q = Quaternion{turn[0], turn[1], turn[2], turn[3]} * q;
  }
  return q;
}

Matrix3 matrix_from_euler(const RotationConvention& convention, const float angles[3]) {
  Matrix3 matrix = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const double unit = convention.to_radians == 1 ? 1.0 : 0.017453292519943295;
  for (const uint8_t axis : convention.axes) {
    const double angle = static_cast<double>(angles[axis] * convention.signs[axis]) * unit;
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    Matrix3 turn = {};
    turn.m[axis][axis] = 1;
    turn.m[j][j] = turn.m[k][k] = std::cos(angle);
    turn.m[j][k] = std::sin(angle);
    turn.m[k][j] = -std::sin(angle);
    matrix = matrix * turn;
  }
  return matrix;
}

// In double: near the poles both arguments of two of the arc tangents are small, and noise in them
// would be noise in the angles.
Matrix3 matrix_from_quaternion(const Quaternion& q) {
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  const double length = x * x + y * y + z * z + w * w;
  const double s = length > 0 ? 2 / length : 0;
  return {{{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
           {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
           {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}}};
}

void euler_from_matrix(const RotationConvention& convention, const Matrix3& matrix,
                       float angles[3]) {
  const auto& m = matrix.m;
  const int a = convention.axes[0], b = convention.axes[1], c = convention.axes[2];
  const double p = convention.parity;
  constexpr double kPole = 1e-7;
  const auto angle = [](double sine, double cosine) {
    return std::atan2(static_cast<float>(sine), static_cast<float>(cosine));
  };
  float turns[3];
  const double cosine = std::sqrt(m[a][a] * m[a][a] + m[a][b] * m[a][b]);
  turns[b] = angle(-p * m[a][c], cosine);
  if (cosine > kPole) {
    turns[a] = angle(p * m[b][c], m[c][c]);
    turns[c] = angle(p * m[a][b], m[a][a]);
  } else {
    turns[a] = 0;
    turns[c] = angle(-p * m[b][a], m[b][b]);
  }
  for (int i = 0; i < 3; ++i) angles[i] = turns[i] * convention.signs[i] / convention.to_radians;
}

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 product = {};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) product.m[r][c] += a.m[r][k] * b.m[k][c];
    }
  }
  return product;
}

Matrix3 transposed(const Matrix3& a) {
  Matrix3 t;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) t.m[r][c] = a.m[c][r];
  }
  return t;
}

Matrix3 change_of_axes(const uint32_t from[3], const uint32_t to[3]) {
  static constexpr double kDirections[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                               {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Matrix3 source, target;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      source.m[i][k] = kDirections[from[i]][k];
      target.m[i][k] = kDirections[to[i]][k];
    }
  }
  return source * transposed(target);
}

Quaternion normalized(const Quaternion& q) {
  const float length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {q.x / length, q.y / length, q.z / length, q.w / length};
}

Quaternion rotation_part(const Quaternion& q, uint32_t axis, bool swing) {
  const float about[3] = {q.x, q.y, q.z};
  const float length = std::sqrt(about[axis] * about[axis] + q.w * q.w);
  if (!swing) {
    float twist[3] = {};
    twist[axis] = about[axis] / length;
    return {twist[0], twist[1], twist[2], q.w / length};
  }
  const float n = -length;
  switch (axis) {
    case 0: return {0, (q.w * q.y - q.x * q.z) / n, (q.w * q.z + q.x * q.y) / n, n};
    case 1: return {(q.w * q.x + q.y * q.z) / n, 0, (q.w * q.z - q.y * q.x) / n, n};
    default: return {(q.w * q.x - q.z * q.y) / n, (q.w * q.y + q.z * q.x) / n, 0, n};
  }
}

}  // namespace mien
