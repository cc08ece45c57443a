// SPDX-License-Identifier: MIT
// A number and its derivative along one direction. The model computes with it as with double, and then has exact
// derivatives beside its results. Where a function has none, they are those that docs/derivatives.md, 1 names.
#pragma once

#include <cmath>

namespace mien::model {

struct Dual {
  double value = 0, slope = 0;

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: constants are duals
  Dual(double at, double by) : value(at), slope(by) {}

  Dual& operator+=(const Dual& b) { return *this = {value + b.value, slope + b.slope}; }
  Dual& operator-=(const Dual& b) { return *this = {value - b.value, slope - b.slope}; }
  Dual& operator*=(const Dual& b) {
    return *this = {value * b.value, slope * b.value + value * b.slope};
  }
  Dual& operator/=(const Dual& b) {
    const double quotient = value / b.value;
    return *this = {quotient, (slope - quotient * b.slope) / b.value};
  }
};

inline Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
inline Dual operator+(Dual a, const Dual& b) { return a += b; }
inline Dual operator-(Dual a, const Dual& b) { return a -= b; }
inline Dual operator*(Dual a, const Dual& b) { return a *= b; }
inline Dual operator/(Dual a, const Dual& b) { return a /= b; }
inline bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
inline bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
inline bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
inline bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

inline double value_of(double v) { return v; }
inline double value_of(const Dual& v) { return v.value; }

// Beside the functions of <cmath>, which double takes.
using std::acos;
using std::asin;
using std::atan2;
using std::cos;
using std::exp;
using std::pow;
using std::sin;
using std::sqrt;
using std::tanh;

inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.value);
  return {root, root > 0 ? a.slope / (2 * root) : 0};
}
inline Dual sin(const Dual& a) { return {std::sin(a.value), std::cos(a.value) * a.slope}; }
inline Dual cos(const Dual& a) { return {std::cos(a.value), -std::sin(a.value) * a.slope}; }
inline Dual asin(const Dual& a) {
  const double rest = 1 - a.value * a.value;
  return {std::asin(a.value), rest > 0 ? a.slope / std::sqrt(rest) : 0};
}
inline Dual acos(const Dual& a) { return {std::acos(a.value), -asin(a).slope}; }
inline Dual atan2(const Dual& y, const Dual& x) {
  const double squared = x.value * x.value + y.value * y.value;
  return {std::atan2(y.value, x.value),
          squared > 0 ? (x.value * y.slope - y.value * x.slope) / squared : 0};
}
inline Dual exp(const Dual& a) {
  const double power = std::exp(a.value);
  return {power, power * a.slope};
}
inline Dual tanh(const Dual& a) {
  const double t = std::tanh(a.value);
  return {t, (1 - t * t) * a.slope};
}
inline Dual pow(const Dual& a, int n) {
  return {std::pow(a.value, n), n * std::pow(a.value, n - 1) * a.slope};
}

/// Into the interval at both ends. NaN counts as 0.
template <class T>
T clamp01(const T& v) {
  return v > 1 ? T(1) : v >= 0 ? v : T(0);
}

/// 0 unless beyond a threshold, and the derivative as without one.
inline double beyond(double v, double threshold) { return v > threshold ? v : 0; }
inline Dual beyond(const Dual& v, double threshold) {
  return {beyond(v.value, threshold), v.slope};
}

}  // namespace mien::model
