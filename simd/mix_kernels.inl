// SPDX-License-Identifier: MIT
// Rows of a mix: blending a layer, crossing clips, transitions, limits; distances of guards.

#pragma once

#include "simd/mix_kernels.h"
#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

/// Values of the source.
struct Plain {
  const float* x;
  Vec operator()(size_t i) const { return load(x + i); }
};
struct Scaled {
  const float* x;
  Vec scale;
  Vec operator()(size_t i) const { return scale * load(x + i); }
};

/// The cover of the source, or 1 everywhere without a load.
struct Covered {
  const float* cover;
  Vec operator()(size_t i) const {
    return at_most(at_least(load(cover + i), broadcast(0.0f)), broadcast(1.0f));
  }
};
struct Whole {
  Vec operator()(size_t) const { return broadcast(1.0f); }
};

/// What a mode adds to a curve: a function of o, x, c and a.
struct BlendOverride {
  Vec operator()(Vec o, Vec x, Vec c, Vec a) const { return a * (x - c * o); }
};
struct BlendAdd {
  Vec operator()(Vec, Vec x, Vec, Vec a) const { return a * x; }
};
struct BlendScreen {
  Vec operator()(Vec o, Vec x, Vec, Vec a) const {
    const Vec p = at_most(at_least(o, broadcast(0.0f)), broadcast(1.0f));
    return a * x * select(less(x, broadcast(0.0f)), p, broadcast(1.0f) - p);
  }
};
struct BlendMax {
  Vec operator()(Vec o, Vec x, Vec c, Vec a) const {
    return a * at_least(x - c * o, broadcast(0.0f));
  }
};
struct BlendScale {
  Vec operator()(Vec o, Vec x, Vec c, Vec a) const { return a * (x - c) * o; }
};

template <bool kReplaces, class Added, class Values, class Cover>
void blend_lanes(const BlendArgs& args, Added added, Values values, Cover cover) {
  const Vec weight = broadcast(args.weight), zero = broadcast(0.0f), one = broadcast(1.0f);
  // Local copies, because the compiler must assume that the writes alias the arguments.
  const float* const mask = args.mask;
  float* const row = args.row;
  const size_t count = args.count;
  for (size_t i = 0; i < count; i += kWidth) {
    const Vec o = load(row + i), x = values(i), c = cover(i);
    const Vec a = weight * load(mask + i);
    const Vec more = added(o, x, c, a);
    // -0 + 0 would be 0.
    Vec mixed = select(equal(more, zero), o, o + more);
    if (kReplaces) mixed = select(equal(a * c, one), x, mixed);
    store(row + i, mixed);
  }
}

template <bool kReplaces, class Added>
void blend_covered(const BlendArgs& args, Added added) {
  const Plain values = {args.x};
  if (args.cover) return blend_lanes<kReplaces>(args, added, values, Covered{args.cover});
  if (args.scale == 1.0f) return blend_lanes<kReplaces>(args, added, values, Whole{});
  blend_lanes<kReplaces>(args, added, Scaled{args.x, broadcast(args.scale)}, Whole{});
}

template <class Added>
void blend_whole(const BlendArgs& args, Added added) {
  if (args.scale == 1.0f) return blend_lanes<false>(args, added, Plain{args.x}, Whole{});
  blend_lanes<false>(args, added, Scaled{args.x, broadcast(args.scale)}, Whole{});
}

void blend_row(const BlendArgs& args) {
  switch (args.mode) {
    case BlendMode::kOverride:
      // With a smaller weight no value is replaced.
      if (args.weight < 1.0f) return blend_covered<false>(args, BlendOverride{});
      return blend_covered<true>(args, BlendOverride{});
    case BlendMode::kAdd: return blend_whole(args, BlendAdd{});
    case BlendMode::kScreen: return blend_whole(args, BlendScreen{});
    case BlendMode::kMax: return blend_covered<false>(args, BlendMax{});
    case BlendMode::kScale: return blend_covered<false>(args, BlendScale{});
  }
}

void cross_rows(const float* from, const float* to, float s, size_t count, float* out) {
  const Vec share = broadcast(s), zero = broadcast(0.0f);
  for (size_t i = 0; i < count; i += kWidth) {
    const Vec a = load(from + i), b = load(to + i), way = b - a;
    const Vec mixed = a + share * way;
    store(out + i, select(equal(way, zero), b, s == 1.0f ? b : mixed));
  }
}

void add_quintics(const QuinticRows& quintics, float u, size_t count, const float* from,
                  float* to) {
  const Vec at = broadcast(u), zero = broadcast(0.0f), one = broadcast(1.0f);
  for (size_t i = 0; i < count; i += kWidth) {
    const Vec c0 = load(quintics.c0 + i), v = at_most(at * load(quintics.rate + i), one);
    const Vec w = one - v;
    const Vec inner = c0 + v * (load(quintics.c1 + i) + v * load(quintics.c2 + i));
    const Vec offset = w * w * w * inner;
    // Near the end rounding could give an offset the wrong sign: 0 instead.
    store(to + i, load(from + i) + select(less(offset * c0, zero), zero, offset));
  }
}

void limit_row(const float* lower, const float* upper, size_t count, float* row) {
  for (size_t i = 0; i < count; i += kWidth) {
    const Vec v = load(row + i);
    const Vec limited = at_most(at_least(v, load(lower + i)), load(upper + i));
    store(row + i, select(equal(v, limited), v, limited));
  }
}

/// The distances of all guards at once, in independent partial sums.
constexpr size_t kGuardVecs = kGuardVector / kBlockWidth;
struct GuardSums {
  BlockVec of[4][kGuardVecs];

  void add(size_t sum, const float* gains, float factor) {
    const BlockVec x = broadcast_block(factor);
    for (size_t v = 0; v < kGuardVecs; ++v) {
      of[sum][v] = of[sum][v] + x * load_block(gains + v * kBlockWidth);
    }
  }
};

void guard_distances(const GuardGains& guards, const float* row, float* out) {
  GuardSums sums;
  for (size_t v = 0; v < kGuardVecs; ++v) {
    sums.of[0][v] = load_block(guards.gains + v * kBlockWidth);
    for (size_t sum = 1; sum < 4; ++sum) sums.of[sum][v] = broadcast_block(0.0f);
  }
  const float* gains = guards.gains + kGuardVector;
  for (size_t i = 0; i < guards.place_count; i += 4, gains += 4 * kGuardVector) {
    sums.add(0, gains, row[i]);
    sums.add(1, gains + kGuardVector, row[i + 1]);
    sums.add(2, gains + 2 * kGuardVector, row[i + 2]);
    sums.add(3, gains + 3 * kGuardVector, row[i + 3]);
  }
  const uint16_t* at = guards.products;
  for (size_t i = 0; i < guards.product_count; i += 4, at += 8, gains += 4 * kGuardVector) {
    sums.add(0, gains, row[at[0]] * row[at[1]]);
    sums.add(1, gains + kGuardVector, row[at[2]] * row[at[3]]);
    sums.add(2, gains + 2 * kGuardVector, row[at[4]] * row[at[5]]);
    sums.add(3, gains + 3 * kGuardVector, row[at[6]] * row[at[7]]);
  }
  for (size_t v = 0; v < kGuardVecs; ++v) {
    store_block(out + v * kBlockWidth,
                (sums.of[0][v] + sums.of[1][v]) + (sums.of[2][v] + sums.of[3][v]));
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
