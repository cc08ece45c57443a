// SPDX-License-Identifier: MIT
// Elementary functions that use only operations that IEEE 754 rounds in one way (+ - * / and the square
// root): those of the C library differ in the last bit from system to system, and a generated file has to be
// the same everywhere. Accurate to some 1e-15.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace mien::author {

constexpr double kPi = 3.14159265358979323846;

inline double clamp01(double t) { return t < 0 ? 0 : t > 1 ? 1 : t; }
inline double mix(double a, double b, double t) { return a + (b - a) * t; }
inline double smooth_step(double from, double to, double x) {
  const double t = clamp01((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

/// number * 2^power, where the result is not subnormal.
inline double scaled(double number, int power) {
  if (power < -1022 || power > 1023) return std::ldexp(number, power);
  const uint64_t bits = static_cast<uint64_t>(power + 1023) << 52;
  double two;
  std::memcpy(&two, &bits, sizeof(two));
  return number * two;
}

/// e^x; 0 for very small x.
inline double exact_exp(double x) {
  if (x < -700) return 0;
  const double k = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - k * 0.693147180369123816490) - k * 1.90821492927058770002e-10;
  double sum = 1;
  for (int i = 14; i > 0; --i) sum = 1 + sum * r / i;
  return scaled(sum, static_cast<int>(k));
}

/// Natural logarithm of a positive number.
inline double exact_log(double x) {
  int k = 0;
  double m = std::frexp(x, &k);  // 0.5 <= m < 1
  if (m < 0.70710678118654752) {
    m *= 2;
    --k;
  }
  const double s = (m - 1) / (m + 1), s2 = s * s;
  double sum = 0;
  for (int i = 23; i > 0; i -= 2) sum = sum * s2 + 1.0 / i;
  return 2 * s * sum + k * 0.69314718055994530942;
}

/// base^power for base >= 0.
inline double exact_pow(double base, double power) {
  if (base <= 0) return 0;
  return base == 1 ? 1 : exact_exp(power * exact_log(base));
}

struct SineCosine {
  double sine, cosine;
};

inline SineCosine exact_sine_cosine(double x) {
  if (x == 0) return {x, 1};
  const double k = std::floor(x * (2 / kPi) + 0.5);
  const double r = (x - k * 1.57079632673412561417) - k * 6.07710050650619224932e-11, r2 = r * r;
  double s = 1, c = 1;
  for (int i = 18; i > 1; i -= 2) {
    s = 1 - s * r2 / (i * (i + 1));
    c = 1 - c * r2 / (i * (i - 1));
  }
  s *= r;
  switch (static_cast<int>(k - 4 * std::floor(k / 4))) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

inline double exact_sine(double x) { return exact_sine_cosine(x).sine; }
inline double exact_cosine(double x) { return exact_sine_cosine(x).cosine; }

/// Angle of the point (x, y), -pi ... pi.
inline double exact_atan2(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y);
  if (ax == 0 && ay == 0) return 0;
  double t = ax > ay ? ay / ax : ax / ay;
  // Halved twice, so that the series is short.
  for (int i = 0; i < 2; ++i) t = t / (1 + std::sqrt(1 + t * t));
  const double t2 = t * t;
  double sum = 0;
  for (int i = 23; i > 0; i -= 2) sum = 1.0 / i - sum * t2;
  double angle = 4 * t * sum;
  if (ax <= ay) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace mien::author
