// SPDX-License-Identifier: MIT
// Rows of a mix, and the distances of its guards. Rows are 64-byte aligned, counts are multiples of 16. Every
// curve is computed alone and nothing is fused, so all instruction sets give the same bits.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace mien {

/// How a layer changes a curve of a mix: o is the value so far, x the value of the layer, a = weight * mask.
enum class BlendMode : uint8_t {
  kOverride,  // o + a (x - o)
  kAdd,       // o + a x
  kScreen,    // p = o within 0 ... 1: x >= 0: o + a x (1 - p), else o + a x p
  kMax,       // o + a max(0, x - o)
  kScale,     // o (1 + a (x - 1))
};

/// Blends `x` over `row`. `cover` is 1 for curves for which the source has a value, 0 for the others, and in
/// between during a transition from one to the other (x is then already multiplied by it); null: 1
/// everywhere. kAdd and kScreen do not need it, because x is 0 where it is 0.
///
/// A curve to which nothing is added keeps its bits, as with a = 0; with a = 1 and cover = 1, kOverride gives
/// the bits of x. Weights and masks are at most 1.
struct BlendArgs {
  const float *x, *cover, *mask;
  float* row;
  size_t count;
  float weight;
  BlendMode mode;
  float scale = 1;  // multiplies x; 1 if there is a cover
};
using BlendRowKernel = void(const BlendArgs& args);

/// cross_rows: out = from + s (to - from); the bits of `to` where they are equal or s is 1.
using CrossRowsKernel = void(const float* from, const float* to, float s, size_t count, float* out);

/// Coefficients of one Quintic (runtime/mix/fade.h) per curve.
struct QuinticRows {
  float *c0, *c1, *c2, *rate;
};
/// add_quintics: to = from + offset at u
using AddQuinticsKernel = void(const QuinticRows& quintics, float u, size_t count,
                               const float* from, float* to);

/// limit_row: clamps to the limits. NaN becomes the lower limit; -0 within the limits is kept.
using LimitRowKernel = void(const float* lower, const float* upper, size_t count, float* row);

/// The distances of eight guards as functions of a row (runtime/mix/guard.h): the rest of each guard,
/// then its gain for each place of the row, then for each product of two places.
constexpr uint32_t kGuardVector = 8;
struct GuardGains {
  const float* gains;        // [1 + place_count + product_count][kGuardVector], 64-byte aligned
  const uint16_t* products;  // [product] its two places
  uint32_t place_count, product_count;  // multiples of 4
};
/// guard_distances: out[g] = rest of guard g + sum of gain * row[place] + sum of gain * (row[a] * row[b]); four
/// partial sums, each of every fourth place and product. `out` is 64-byte aligned.
using GuardDistancesKernel = void(const GuardGains& guards, const float* row, float* out);

}  // namespace mien
