// SPDX-License-Identifier: MIT
// Dual numbers: a value and its derivatives by N variables. The stages that compute rotations are repeated
// with them in double precision, which gives small matrices of derivatives.
#pragma once

#include <cmath>

namespace mien {

template <int N>
struct Dual {
  double value = 0;
  double by[N] = {};

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: constants are duals
  static Dual variable(double value, int index) {
    Dual d(value);
    d.by[index] = 1;
    return d;
  }
};

/// f(value) with the derivative `slope`.
template <int N>
Dual<N> chain(const Dual<N>& a, double value, double slope) {
  Dual<N> r(value);
  for (int i = 0; i < N; ++i) r.by[i] = slope * a.by[i];
  return r;
}
template <int N>
Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
  Dual<N> r(a.value + b.value);
  for (int i = 0; i < N; ++i) r.by[i] = a.by[i] + b.by[i];
  return r;
}
template <int N>
Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
  Dual<N> r(a.value - b.value);
  for (int i = 0; i < N; ++i) r.by[i] = a.by[i] - b.by[i];
  return r;
}
template <int N>
Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
  Dual<N> r(a.value * b.value);
  for (int i = 0; i < N; ++i) r.by[i] = a.by[i] * b.value + a.value * b.by[i];
  return r;
}
template <int N>
Dual<N> operator*(double a, const Dual<N>& b) {
  return chain(b, a * b.value, a);
}
template <int N>
Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
  const double inverse = 1 / b.value, value = a.value * inverse;
  Dual<N> r(value);
  for (int i = 0; i < N; ++i) r.by[i] = (a.by[i] - value * b.by[i]) * inverse;
  return r;
}
/// The derivative at 0 counts as 0.
template <int N>
Dual<N> square_root(const Dual<N>& a) {
  const double root = std::sqrt(a.value);
  return chain(a, root, root > 0 ? 0.5 / root : 0);
}
template <int N>
Dual<N> sine(const Dual<N>& a) {
  return chain(a, std::sin(a.value), std::cos(a.value));
}
template <int N>
Dual<N> cosine(const Dual<N>& a) {
  return chain(a, std::cos(a.value), -std::sin(a.value));
}
template <int N>
Dual<N> arc_cosine(const Dual<N>& a) {
  const double rest = 1 - a.value * a.value;
  return chain(a, std::acos(a.value), rest > 0 ? -1 / std::sqrt(rest) : 0);
}
template <int N>
Dual<N> arc_tangent(const Dual<N>& y, const Dual<N>& x) {
  const double squared = x.value * x.value + y.value * y.value;
  Dual<N> r(std::atan2(y.value, x.value));
  for (int i = 0; i < N && squared > 0; ++i) {
    r.by[i] = (x.value * y.by[i] - y.value * x.by[i]) / squared;
  }
  return r;
}

template <int N>
struct DualQuaternion {
  Dual<N> x, y, z, w = 1.0;
};
/// a * b turns by b first.
template <int N>
DualQuaternion<N> operator*(const DualQuaternion<N>& a, const DualQuaternion<N>& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <int N>
Dual<N> squared_length(const DualQuaternion<N>& q) {
  return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
}
/// Unit; the identity if there is no direction.
template <int N>
DualQuaternion<N> made_unit(const DualQuaternion<N>& q) {
  const Dual<N> squared = squared_length(q);
  if (!(squared.value > 1e-36)) return {};
  const Dual<N> scale = Dual<N>(1.0) / square_root(squared);
  return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}

}  // namespace mien
