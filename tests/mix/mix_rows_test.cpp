// SPDX-License-Identifier: MIT
#include "runtime/mix/mix_rows.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <vector>

#include "author/base/random.h"

namespace mien {
namespace {

constexpr size_t kRowCurves = 48;

/// With the zeros, ones and equal values at which formulas have ends.
struct alignas(64) SomeRow {
  float of[kRowCurves];
  SomeRow(Random& random, float low, float high) {
    for (float& v : of) {
      const uint32_t end = random.below(6);
      v = end == 0   ? 0.0f
          : end == 1 ? -0.0f
          : end == 2 ? 1.0f
                     : static_cast<float>(random.between(double{low}, double{high}));
    }
  }
};

TEST(BlendCurves, HasTheBitsOfWholeRows) {
  Random random = Random::from_seed(8, 0);
  std::vector<uint16_t> curves(kRowCurves);
  std::iota(curves.begin(), curves.end(), uint16_t{0});
  const KernelTable& kernels = *kernels_for(Isa::kBest);
  for (uint32_t mode = 0; mode < kBlendModes; ++mode) {
    for (int round = 0; round < 200; ++round) {
      const SomeRow x(random, -1, 2), mask(random, 0, 1), before(random, -1, 2);
      const float weight = round % 3 == 0 ? 1.0f : static_cast<float>(random.real());
      SomeRow whole = before, listed = before;
      kernels.blend_row(
          {x.of, nullptr, mask.of, whole.of, kRowCurves, weight, static_cast<BlendMode>(mode)});
      blend_curves(static_cast<BlendMode>(mode), {curves.data(), kRowCurves}, x.of, mask.of, weight,
                   listed.of);
      EXPECT_EQ(memcmp(whole.of, listed.of, sizeof(whole.of)), 0) << "mode " << mode;
    }
  }
}

TEST(BlendCurves, LeavesOtherCurvesAloneAndNeedsNoMask) {
  float row[4] = {0.25f, 0.5f, 0.75f, 1};
  const uint16_t curves[] = {3, 1};
  const float values[] = {0, 1};
  blend_curves(BlendMode::kOverride, {curves, 2}, values, nullptr, 0.5f, row);
  const float expected[4] = {0.25f, 0.75f, 0.75f, 0.5f};
  EXPECT_EQ(memcmp(row, expected, sizeof(row)), 0);
  blend_curves(BlendMode::kOverride, {curves, 2}, values, nullptr, 0, row);
  EXPECT_EQ(memcmp(row, expected, sizeof(row)), 0);
}

}  // namespace
}  // namespace mien
