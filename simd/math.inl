// SPDX-License-Identifier: MIT
// Elementary functions, for lanes. Nothing is fused, so every instruction set gives the same bits. V is a Vec
// or a VecPair.
//
// | function              | for                | off by at most                                   |
// |-----------------------|--------------------|--------------------------------------------------|
// | nearest               | |v| up to 2^22     | 0; ties to even                                  |
// | round_to_whole(v, p)  | |v| up to 126      | 0: a nearest whole number n, and p = 2^n         |
// | power_of_two          | whole -126 ... 127 | 0                                                |
// | power_of_two_or_zero  | up to 126          | 2.5e-7 of its value; 0 up to -126                |
// | exp_of_negative       | up to 0            | 2e-7 of its value; 0 below -87                   |
// | quick_rotation_angle  | any                | 4e-8, before rounding                            |
// | bounded_sine, _cosine | -pi/2 ... pi/2     | next terms of the series: below 7e-10            |
// | sine_cosine           | finite             | 2 ulp                                            |
// | arc_tangent(y, x)     | finite             | 2 ulp                                            |
// | arc_cosine            | -1 ... 1           | 2 ulp; 0 beyond                                  |
// | reciprocal_root       | above 0            | 1.5 ulp                                          |

#pragma once

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// Rounding ----------------------------------------------------------------------------------------

// The lowest bits of v plus this are the exponent bits of 2^v.
constexpr float kPowerRounder = kRounder + 127.0f;

template <class V>
inline V nearest(V v) {
  const V rounder = Make<V>::of(kRounder);
  return (nearest_whole(v) + rounder) - rounder;  // 0, not -0
}
template <class V>
inline V round_to_whole(V v, V& power) {
  const V rounder = Make<V>::of(kPowerRounder), sum = nearest_whole(v) + rounder;
  power = shift_bits<23>(sum);
  return sum - rounder;
}
template <class V>
inline V power_of_two(V n) {
  return shift_bits<23>(n + Make<V>::of(kPowerRounder));
}

// Exponentials ------------------------------------------------------------------------------------

// NaN gives 0. The polynomial for -1/2 ... 1/2 is within 1e-7 and gives 1 for 0.
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

// Cody-Waite reduction to |r| <= ln(2)/2, then the series to the seventh power (its next term is below 6e-9
// there), in two independent halves.
template <class V>
inline V exp_of_negative(V x) {
  using M = Make<V>;
  const V bounded = at_least(x, M::of(-87.0f));
  const V n = nearest(bounded * M::of(1.44269504f));
  const V r = (bounded - n * M::of(0.693359375f)) + n * M::of(2.12194440e-4f);
  const V r2 = r * r;
  const V low = (M::of(1.0f / 6) * r + M::of(0.5f)) * r2 + (r + M::of(1.0f));
  const V high = (M::of(1.0f / 5040) * r + M::of(1.0f / 720)) * r2 +
                 (M::of(1.0f / 120) * r + M::of(1.0f / 24));
  const V p = high * (r2 * r2) + low;
  return select(less(x, M::of(-87.0f)), M::of(0.0f), p * power_of_two(n));
}

// Angles ------------------------------------------------------------------------------------------

// The angle of a rotation whose quaternion has this real part, of either sign: 2 acos |w|, 0 where |w| is 1
// or more. sqrt(1 - |w|) times a polynomial (Abramowitz and Stegun 4.4.46), whose coefficients are doubled
// for the factor 2. (With acos(2 w^2 - 1) small angles would lose digits, and large ones need a reflection.)
template <class V>
inline V quick_rotation_angle(V w) {
  using M = Make<V>;
  const V a = at_most_or_nan(absolute(w), M::of(1.0f));
  const V a2 = a * a;
  const V low = (M::of(2 * -0.0501743046f) * a + M::of(2 * 0.0889789874f)) * a2 +
                (M::of(2 * -0.2145988016f) * a + M::of(2 * 1.5707963050f));
  const V high = (M::of(2 * -0.0012624911f) * a + M::of(2 * 0.0066700901f)) * a2 +
                 (M::of(2 * -0.0170881256f) * a + M::of(2 * 0.0308918810f));
  return (high * (a2 * a2) + low) * square_root(M::of(1.0f) - a);
}

/// Horner's scheme: ((p x + term) x + term) ... (Compilers would not unroll a loop over an array.)
template <class V, class... Terms>
inline V polynomial(V x, V p, Terms... terms) {
  ((p = p * x + Make<V>::of(terms)), ...);
  return p;
}

// Taylor series.
template <class V>
inline V bounded_sine(V x) {
  const V xx = x * x;
  const V p = polynomial(xx, Make<V>::of(1.60590438e-10f), -2.50521084e-8f, 2.75573192e-6f,
                         -1.98412698e-4f, 8.33333333e-3f, -1.66666667e-1f);
  return (p * xx) * x + x;
}
template <class V>
inline V bounded_cosine(V x) {
  return polynomial(x * x, Make<V>::of(-1.14707456e-11f), 2.08767570e-9f, -2.75573192e-7f,
                    2.48015873e-5f, -1.38888889e-3f, 4.16666667e-2f, -0.5f, 1.0f);
}

// Full range --------------------------------------------------------------------------------------

constexpr float kPi = 3.14159274f, kHalfPi = 1.57079637f;
constexpr float kPiRest = -2.78275342e-8f;  // (pi - kPi) / kPi

/// x = n * pi/2 + rest, where |rest| is at most pi/4; `bits` has n in its low bits. For x too large to be
/// reduced in floats: with the bits of 2/pi that matter, in integers (Payne and Hanek).
inline void reduce_large_angle(float x, float& rest, float& bits) {
  // 2/pi, after 32 zero bits of its integer part.
  static constexpr uint32_t kTwoOverPi[] = {0,          0xA2F9836E, 0x4E441529, 0xFC2757D1,
                                            0xF534DDC0, 0xDB629599, 0x3C439041, 0xFE5163AB};
  const uint32_t exponent = bits_of(x) >> 23 & 0xFF;
  bits = kRounder;
  rest = x - x;
  if (exponent == 0xFF) return;  // infinite or NaN
  // |x| = fraction * 2^shift. Bits of 2/pi before the 96 used contribute multiples of 4, bits after them less
  // than 2^-70.
  const uint64_t fraction = (bits_of(x) & 0x7FFFFF) | 0x800000;
  const uint32_t first = exponent - 150 + 30, word = first / 32, bit = first % 32;
  const auto part = [&](uint32_t i) {
    const uint64_t two = uint64_t{kTwoOverPi[word + i]} << 32 | kTwoOverPi[word + i + 1];
    return two >> (32 - bit) & 0xFFFFFFFF;
  };
  const uint64_t low = fraction * part(2), middle = fraction * part(1) + (low >> 32);
  const uint64_t high = fraction * part(0) + (middle >> 32);
  const uint64_t quarters = high << 32 | (middle & 0xFFFFFFFF);  // in units of 2^-62
  const uint64_t n = (quarters + (uint64_t{1} << 61)) >> 62;
  const auto left = static_cast<int64_t>(quarters - (n << 62));
  const float turn = static_cast<float>(static_cast<double>(left) * (0x1p-62 * 1.5707963267948966));
  const bool negative = x < 0;
  rest = negative ? -turn : turn;
  bits = kRounder + static_cast<float>(negative ? -static_cast<int>(n) : static_cast<int>(n));
}

// Cody-Waite reduction to |r| <= pi/4: the first two parts of pi/2 have sixteen bits and n at most eight, so
// their products are exact; the rounding error of the second difference is added at the end. Then minimax
// polynomials, within 4e-9.
template <class V>
[[gnu::always_inline]] inline void sine_cosine(V x, V& sine, V& cosine) {
  using M = Make<V>;
  constexpr float kMaxAngle = 256;
  V sum = nearest_whole(x * M::of(0.636619747f)) + M::of(kRounder);
  const V n = sum - M::of(kRounder), second = n * M::of(-0x1.2aeep-18f);
  const V first = x - n * M::of(0x1.922p+0f), rest = first - second;
  V r = rest + (((first - rest) - second) - n * M::of(-0x1.e973dcp-35f));
  if (__builtin_expect(any(less(M::of(kMaxAngle), absolute(x))), false)) {
    constexpr size_t kCount = sizeof(V) / sizeof(float);
    alignas(64) float angles[kCount], rests[kCount], sums[kCount];
    store(angles, x);
    store(rests, r);
    store(sums, sum);
    for (size_t i = 0; i < kCount; ++i) {
      if (__builtin_fabsf(angles[i]) > kMaxAngle) reduce_large_angle(angles[i], rests[i], sums[i]);
    }
    r = M::from(rests);
    sum = M::from(sums);
  }
  // Up to 2^-14 the sine is r, and the cosine 1. From 2^-31 on powers would be subnormal, which takes
  // processors a hundred cycles. NaN stays NaN.
  const V bounded = at_least(M::of(0x1p-14f), absolute(r)), r2 = bounded * bounded;
  const V s = r + (r * r2) * (M::of(-0.166666552f) +
                              r2 * (M::of(0.00833218824f) + r2 * M::of(-0.000195180954f)));
  const V c = (M::of(1.0f) - r2 * M::of(0.5f)) +
              (r2 * r2) * (M::of(0.0416666456f) +
                           r2 * (M::of(-0.00138873095f) + r2 * M::of(2.44323273e-05f)));
  // By n modulo 4: s c, c -s, -s -c, -c s.
  const V odd = shift_bits<31>(sum), upper = shift_bits<30>(sum);
  const auto swapped = less(with_sign(M::of(1.0f), odd), M::of(0.0f));
  sine = flip_sign(select(swapped, c, s), upper);
  cosine = flip_sign(flip_sign(select(swapped, s, c), upper), odd);
}

// The smaller divided by the larger magnitude, and a minimax polynomial within 2e-8. `steep` tells whether y
// is the larger one.
template <class V, class Lanes>
[[gnu::always_inline]] inline V arc_tangent_of_octant(V ay, V ax, Lanes& steep) {
  using M = Make<V>;
  steep = less(ax, ay);
  const V low = select(steep, ax, ay), high = select(steep, ay, ax);
  const V a = divide(low, high + keep(less(high, M::of(0x1p-149f)), M::of(1.0f)));
  // Up to 2^-14 the series is a. From 2^-16 on its powers would be subnormal, which takes processors a
  // hundred cycles.
  const V bounded = at_least(a, M::of(0x1p-14f)), u = bounded * bounded, u2 = u * u;
  const V even = (M::of(0.00291873305f) * u + M::of(-0.0163611509f)) * u2 +
                 (M::of(0.0432025157f) * u + M::of(-0.0755155608f));
  const V rest = (M::of(0.106657512f) * u + M::of(-0.14211002f)) * u2 +
                 (M::of(0.199937671f) * u + M::of(-0.333331525f));
  return a + (a * u) * (even * (u2 * u2) + rest);
}

// The angle of (x, y), -pi ... pi, with the signs of zeros as in C: the angle within the octant, plus the
// offset of the octant. NaN if both are infinite.
template <class V>
[[gnu::always_inline]] inline V arc_tangent(V y, V x) {
  using M = Make<V>;
  const V zero = M::of(0.0f), one = M::of(1.0f);
  auto steep = less(zero, zero);
  const V signed_t = flip_sign(arc_tangent_of_octant(absolute(y), absolute(x), steep), x);
  const V base = select(steep, M::of(kHalfPi), keep(less(with_sign(one, x), zero), M::of(kPi)));
  const V added = select(steep, zero - signed_t, signed_t);
  return with_sign(base + (added + base * M::of(kPiRest)), y);
}

// The same for x >= 0.
template <class V>
[[gnu::always_inline]] inline V arc_tangent_of_right_half(V y, V x) {
  using M = Make<V>;
  auto steep = less(x, x);
  const V t = arc_tangent_of_octant(absolute(y), x, steep);
  const V base = keep(steep, M::of(kHalfPi)), added = select(steep, M::of(0.0f) - t, t);
  return with_sign(base + (added + base * M::of(kPiRest)), y);
}

// From the arc sine z + z^3 p(z^2) for z up to 1/2, within 5e-9: pi/2 - asin(x), and for larger x twice the
// arc sine of sqrt((1 - x) / 2).
template <class V>
[[gnu::always_inline]] inline V arc_cosine(V x) {
  using M = Make<V>;
  const V half = M::of(0.5f), a = at_most_or_nan(absolute(x), M::of(1.0f));
  const auto large = less(half, a);
  const V u = select(large, (M::of(1.0f) - a) * half, a * a), z = select(large, square_root(u), a);
  const V u2 = u * u;
  const V p = (M::of(0.0421583876f) * u2 + (M::of(0.0241847429f) * u + M::of(0.0454691537f))) * u2 +
              (M::of(0.0749530941f) * u + M::of(0.166667521f));
  const V sine = z + (z * u) * p;
  const V angle = select(large, sine + sine, (M::of(kHalfPi) - sine) + M::of(kHalfPi * kPiRest));
  const V reflected = (M::of(kPi) - angle) + M::of(kPi * kPiRest);
  return select(less(x, M::of(0.0f)), reflected, angle);
}

template <class V>
inline V reciprocal_root(V v) {
  return divide(Make<V>::of(1.0f), square_root(v));
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
