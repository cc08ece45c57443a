// SPDX-License-Identifier: MIT
// Rows of a mix: every instruction set against the formulas in double, and bit for bit against the
// others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "author/base/random.h"
#include "runtime/mix/fade.h"
#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

constexpr size_t kCurves = 48;
constexpr BlendMode kModes[] = {BlendMode::kOverride, BlendMode::kAdd, BlendMode::kScreen,
                                BlendMode::kMax, BlendMode::kScale};

struct alignas(64) Row {
  float of[kCurves] = {};

  explicit Row(float value = 0) { std::fill(of, of + kCurves, value); }
  Row(Random& random, double low, double high) {
    for (float& v : of) v = static_cast<float>(random.between(low, high));
  }
  bool same_bits(const Row& other) const { return memcmp(of, other.of, sizeof(of)) == 0; }
};

/// Calls `run(kernels, row)` on every instruction set; the rows have to be the same.
template <class Run>
Row on_all(const Row& row, const Run& run) {
  Row first;
  const KernelTable* reference = nullptr;
  for (const KernelTable* kernels : present_kernels()) {
    Row own = row;
    run(*kernels, own);
    if (!reference) {
      reference = kernels;
      first = own;
    }
    EXPECT_TRUE(own.same_bits(first)) << kernels->name << ", " << reference->name;
  }
  return first;
}

double model(BlendMode mode, double o, double x, double a) {
  const double p = std::min(1.0, std::max(0.0, o));
  switch (mode) {
    case BlendMode::kOverride: return o + a * (x - o);
    case BlendMode::kAdd: return o + a * x;
    case BlendMode::kScreen: return x >= 0 ? o + a * x * (1 - p) : o + a * x * p;
    case BlendMode::kMax: return o + a * std::max(0.0, x - o);
    case BlendMode::kScale: return o * (1 + a * (x - 1));
  }
  return 0;
}

Row blended(BlendMode mode, const Row& o, const Row& x, const Row* cover, const Row& mask,
            float weight) {
  return on_all(o, [&](const KernelTable& kernels, Row& row) {
    kernels.blend_row({x.of, cover ? cover->of : nullptr, mask.of, row.of, kCurves, weight, mode});
  });
}

TEST(BlendRow, FollowsTheFormulaOfEachMode) {
  Random random = Random::from_seed(3, 0);
  for (BlendMode mode : kModes) {
    for (int round = 0; round < 200; ++round) {
      const Row o(random, -1, 2), x(random, -1, 2), mask(random, 0, 1), cover(1);
      const auto weight = static_cast<float>(random.real());
      const Row covered = blended(mode, o, x, &cover, mask, weight);
      EXPECT_TRUE(blended(mode, o, x, nullptr, mask, weight).same_bits(covered));
      for (size_t i = 0; i < kCurves; ++i) {
        const double a = double{weight} * mask.of[i];
        EXPECT_NEAR(covered.of[i], model(mode, o.of[i], x.of[i], a), 2e-6);
      }
    }
  }
}

TEST(BlendRow, CoverOfHalfHasHalfTheWeight) {
  for (BlendMode mode : {BlendMode::kOverride, BlendMode::kScale}) {
    const Row cover(0.5f), mask(1);
    const Row row = blended(mode, Row(0.8f), Row(0.5f * 0.25f), &cover, mask, 1);
    EXPECT_NEAR(row.of[0], model(mode, 0.8, 0.25, 0.5), 1e-6);
  }
}

TEST(BlendRow, KeepsBitsWhereNothingIsAddedAndTakesThemWhereAllIs) {
  Random random = Random::from_seed(4, 0);
  Row o(random, -1, 2), x(random, -1, 2);
  o.of[0] = x.of[1] = -0.0f;
  const Row none(0), all(1);
  for (BlendMode mode : kModes) {
    EXPECT_TRUE(blended(mode, o, x, nullptr, none, 1).same_bits(o));
    EXPECT_TRUE(blended(mode, o, x, nullptr, all, 0).same_bits(o));
  }
  EXPECT_TRUE(blended(BlendMode::kOverride, o, x, &all, all, 1).same_bits(x));
  EXPECT_TRUE(blended(BlendMode::kOverride, o, none, &none, all, 1).same_bits(o)) << "not covered";
}

TEST(CrossRows, GoesStraightAndEndsExactly) {
  Random random = Random::from_seed(5, 0);
  const Row from(random, -1, 2), to(random, -1, 2);
  for (float s : {0.0f, 0.3f, 1.0f}) {
    const Row out = on_all(Row(), [&](const KernelTable& kernels, Row& row) {
      kernels.cross_rows(from.of, to.of, s, kCurves, row.of);
    });
    for (size_t i = 0; i < kCurves; ++i) {
      EXPECT_NEAR(out.of[i], from.of[i] + double{s} * (double{to.of[i]} - from.of[i]), 1e-6);
    }
    EXPECT_EQ(out.same_bits(to), s == 1);
  }
}

TEST(AddQuintics, HasTheBitsOfAFade) {
  Random random = Random::from_seed(6, 0);
  for (float u : {0.0f, 0.2f, 0.7f, 0.999f, 1.0f, 3.0f}) {
    Row c0, c1, c2, rate, expected(random, 0, 1);
    const Row row = expected;
    for (size_t i = 0; i < kCurves; ++i) {
      const Quintic q = quintic_from(static_cast<float>(random.between(-1, 1)),
                                     static_cast<float>(random.between(-8, 8)));
      c0.of[i] = q.c0, c1.of[i] = q.c1, c2.of[i] = q.c2, rate.of[i] = q.rate;
      expected.of[i] += quintic_at(q, u);
    }
    const QuinticRows quintics = {c0.of, c1.of, c2.of, rate.of};
    EXPECT_TRUE(on_all(row, [&](const KernelTable& kernels, Row& out) {
                  kernels.add_quintics(quintics, u, kCurves, row.of, out.of);
                }).same_bits(expected));
  }
}

TEST(LimitRow, HoldsWhateverComesAndKeepsZerosSigns) {
  Random random = Random::from_seed(7, 0);
  Row row(random, -3, 3);
  row.of[0] = -0.0f;
  row.of[1] = std::numeric_limits<float>::quiet_NaN();
  row.of[2] = std::numeric_limits<float>::infinity();
  row.of[3] = -std::numeric_limits<float>::infinity();
  const Row lower(0), upper(1);
  const Row out = on_all(row, [&](const KernelTable& kernels, Row& own) {
    kernels.limit_row(lower.of, upper.of, kCurves, own.of);
  });
  EXPECT_TRUE(std::signbit(out.of[0]));
  EXPECT_EQ(out.of[1], 0);
  EXPECT_EQ(out.of[2], 1);
  EXPECT_EQ(out.of[3], 0);
  for (size_t i = 4; i < kCurves; ++i) {
    EXPECT_EQ(out.of[i], std::min(1.0f, std::max(0.0f, row.of[i])));
  }
}

// Distances of guards ------------------------------------------------------------------------------

TEST(GuardDistances, AreRestPlacesAndProductsOnEveryInstructionSet) {
  constexpr uint32_t kProducts = 8, kTerms = 1 + kCurves + kProducts;
  Random random = Random::from_seed(6, 0);
  alignas(64) float gains[kTerms * kGuardVector];
  for (float& gain : gains) gain = static_cast<float>(random.between(-8, 8));
  uint16_t products[2 * kProducts];
  for (uint16_t& place : products) place = static_cast<uint16_t>(random.below(kCurves));
  const Row row(random, 0, 1);
  for (uint32_t product_count : {0u, 4u, kProducts}) {
    for (uint32_t place_count : {0u, 8u, uint32_t{kCurves}}) {
      // Those of products come after those of places.
      const GuardGains guards = {gains, products, place_count, product_count};
      const Row out = on_all(Row(), [&](const KernelTable& kernels, Row& own) {
        kernels.guard_distances(guards, row.of, own.of);
      });
      for (size_t g = 0; g < kGuardVector; ++g) {
        const float* gain = gains + g;
        double sum = double{*gain};
        for (uint32_t i = 0; i < place_count; ++i) {
          sum += double{*(gain += kGuardVector)} * double{row.of[i]};
        }
        for (uint32_t p = 0; p < product_count; ++p) {
          const double product =
              double{row.of[products[2 * p]]} * double{row.of[products[2 * p + 1]]};
          sum += double{*(gain += kGuardVector)} * product;
        }
        EXPECT_NEAR(double{out.of[g]}, sum, 1e-4)
            << g << ": " << place_count << ", " << product_count;
      }
      for (size_t i = kGuardVector; i < kCurves; ++i)
        EXPECT_EQ(out.of[i], 0) << "beyond the guards";
    }
  }
}

}  // namespace
}  // namespace mien
