// SPDX-License-Identifier: MIT
// Functions of numbers, for lanes. Nothing is fused, so every instruction set gives the same bits.
// V is a Vec or a VecPair.
//
// | function              | for                | off by at most                                   |
// |-----------------------|--------------------|--------------------------------------------------|
// | nearest               | |v| up to 2^22     | 0; ties to even                                  |
// | round_to_whole(v, p)  | |v| up to 126      | 0: a nearest whole number n, and p = 2^n         |
// | power_of_two          | whole -126 ... 127 | 0                                                |
// | power_of_two_or_zero  | up to 126          | 2e-7 of its value; 0 up to -126                  |
// | exp_of_negative       | up to 0            | 2e-7 of its value; 0 below -87                   |
// | arc_cosine            | -1 ... 1           | 2e-8, before rounding; 0 above 1                 |
// | bounded_sine, _cosine | -pi/2 ... pi/2     | next terms of the series: below 7e-10            |

#pragma once

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// Rounding ----------------------------------------------------------------------------------------

// Floats near 1.5 * 2^23 are whole numbers: adding it rounds to the nearest, ties to even, and the
// lowest bits of the sum are those of the number, in two's complement.
constexpr float kRounder = 12582912.0f;
// With 127 they are those of the exponent of its power of two.
constexpr float kPowerRounder = kRounder + 127.0f;

template <class V>
inline V nearest(V v) {
  const V rounder = Make<V>::of(kRounder);
  return (v + rounder) - rounder;
}
template <class V>
inline V round_to_whole(V v, V& power) {
  const V rounder = Make<V>::of(kPowerRounder), sum = v + rounder;
  power = low_bits_to_exponent(sum);
  return sum - rounder;
}
template <class V>
inline V power_of_two(V n) {
  return low_bits_to_exponent(n + Make<V>::of(kPowerRounder));
}

// Exponentials ------------------------------------------------------------------------------------

// What is not a number gives 0. The polynomial for -1/2 ... 1/2 is within 1e-7 and gives 1 for 0.
template <class V>
inline V power_of_two_or_zero(V y) {
  using M = Make<V>;
  V power;
  const V f = y - round_to_whole(y, power);
  const V f2 = f * f;
  const V high = (M::of(0.0013264739f) * f + M::of(0.00967151672f)) * f2 +
                 (M::of(0.0555073358f) * f + M::of(0.240222424f));
  const V p = high * f2 + (M::of(0.693147004f) * f + M::of(1.0f));
  return keep(less(M::of(-126.0f), y), p * power);
}

// Cody-Waite reduction to |r| <= ln(2)/2, then the series to the seventh power (its next term is below
// 6e-9 there), in halves that do not wait for each other.
inline Vec exp_of_negative(Vec x) {
  const Vec bounded = at_least(x, broadcast(-87.0f));
  const Vec n = nearest(bounded * broadcast(1.44269504f));
  const Vec r = (bounded - n * broadcast(0.693359375f)) + n * broadcast(2.12194440e-4f);
  const Vec r2 = r * r;
  const Vec low = (broadcast(1.0f / 6) * r + broadcast(0.5f)) * r2 + (r + broadcast(1.0f));
  const Vec high = (broadcast(1.0f / 5040) * r + broadcast(1.0f / 720)) * r2 +
                   (broadcast(1.0f / 120) * r + broadcast(1.0f / 24));
  const Vec p = high * (r2 * r2) + low;
  return select(less(x, broadcast(-87.0f)), broadcast(0.0f), p * power_of_two(n));
}

// Angles ------------------------------------------------------------------------------------------

// sqrt(1 - |x|) times a polynomial (Abramowitz and Stegun 4.4.46), reflected for negative x.
template <class V>
inline V arc_cosine(V x) {
  using M = Make<V>;
  const V a = at_most_or_nan(absolute(x), M::of(1.0f));
  const V a2 = a * a;
  const V low = (M::of(-0.0501743046f) * a + M::of(0.0889789874f)) * a2 +
                (M::of(-0.2145988016f) * a + M::of(1.5707963050f));
  const V high = (M::of(-0.0012624911f) * a + M::of(0.0066700901f)) * a2 +
                 (M::of(-0.0170881256f) * a + M::of(0.0308918810f));
  const V angle = (high * (a2 * a2) + low) * square_root(M::of(1.0f) - a);
  return select(less(x, M::of(0.0f)), M::of(3.14159265f) - angle, angle);
}

// Taylor series.
inline Vec bounded_sine(Vec x) {
  const Vec xx = x * x;
  const float terms[] = {-2.50521084e-8f, 2.75573192e-6f, -1.98412698e-4f, 8.33333333e-3f,
                         -1.66666667e-1f};
  Vec p = broadcast(1.60590438e-10f);
  for (float term : terms) p = p * xx + broadcast(term);
  return (p * xx) * x + x;
}
inline Vec bounded_cosine(Vec x) {
  const Vec xx = x * x;
  const float terms[] = {2.08767570e-9f,  -2.75573192e-7f, 2.48015873e-5f,
                         -1.38888889e-3f, 4.16666667e-2f,  -0.5f};
  Vec p = broadcast(-1.14707456e-11f);
  for (float term : terms) p = p * xx + broadcast(term);
  return p * xx + broadcast(1.0f);
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
