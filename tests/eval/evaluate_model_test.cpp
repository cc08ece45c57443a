// SPDX-License-Identifier: MIT
// Random rigs against the formulas of docs/rig-evaluation.md in double precision
// (integrations/program/model/plain_rig.h). The rules one by one: evaluate_test.cpp, evaluate_controls_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/plain_rig.h"

namespace mien {
namespace {

constexpr double kUlp = 1.0 / (1 << 23);

// A sum of n products in float, in any order, is within n units of the last place of the sum of
// their absolute values; factors that are correctives bring a few more.
constexpr double kMaxUlps = 64;

/// Compares each value with the model's; `scales` says what the units of the last place are of.
void expect_close(const char* what, Span<const float> mine, const std::vector<double>& expected,
                  const std::vector<double>& scales) {
  ASSERT_EQ(mine.count, expected.size());
  for (size_t i = 0; i < mine.count; ++i) {
    EXPECT_LE(std::fabs(mine[i] - expected[i]), kMaxUlps * kUlp * std::fabs(scales[i]))
        << what << " " << i << ": " << mine[i] << ", expected " << expected[i];
  }
}

TEST(RandomRigs, FollowTheModel) {
  const std::vector<uint32_t> isas = present_isas();
  Random random = Random::from_seed(2, 1);
  for (uint32_t round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const PlainRig plain = random_rig(random);
    Character character(make_rig(plain, isas[round % isas.size()]));
    for (int frame = 0; frame < 6; ++frame) {
      const uint32_t lod = random.below(plain.lod_count);
      SCOPED_TRACE(lod);
      std::vector<float> raw;
      for (uint16_t i = 0; i < plain.raw_count; ++i) {
        raw.push_back(static_cast<float>(random.below(25)) / 8 - 1);
      }
      std::copy(raw.begin(), raw.end(), character.raw.begin());
      character.evaluate(lod);
      const PlainResults expected = evaluate_plain(plain, raw, lod);
      expect_close("control", character.controls, expected.controls, expected.controls);
      expect_close("joint value", character.joints, expected.joints, expected.joint_products);
      expect_close("channel", character.channels, expected.channels, expected.channels);
      const std::vector<double> ones(expected.maps.size(), 1.0);
      expect_close("map", character.maps, expected.maps, ones);
    }
  }
}

// The rigs above are worth comparing: they have some of everything.
TEST(RandomRigs, HaveSomeOfEverything) {
  Random random = Random::from_seed(2, 1);
  size_t chains = 0, rewritten = 0, unneeded = 0, active_maps = 0, coarser = 0;
  for (int round = 0; round < 300; ++round) {
    const PlainRig plain = random_rig(random);
    for (const PlainPsd& triple : plain.psds) chains += triple.column >= plain.raw_count;
    for (const PlainGroup& group : plain.groups) {
      std::vector<uint16_t> outputs = group.outputs;
      std::sort(outputs.begin(), outputs.end());
      rewritten += std::adjacent_find(outputs.begin(), outputs.end()) != outputs.end();
      coarser += group.lods.back() > 0 && group.lods.back() < group.lods.front();
    }
    for (uint8_t needed : needed_psds(plain, 0)) unneeded += !needed;
    const PlainResults results =
        evaluate_plain(plain, std::vector<float>(plain.raw_count, 0.5f), 0);
    for (double value : results.maps) active_maps += value > 0 && value < 1;
  }
  for (size_t count : {chains, rewritten, unneeded, active_maps, coarser}) EXPECT_GT(count, 50u);
}

}  // namespace
}  // namespace mien
