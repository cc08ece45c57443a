// SPDX-License-Identifier: MIT
// Where the tongue is at dental sounds: between the teeth, not in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "integrations/program/tests/speech/spoken_head.h"

namespace mien::speech {
namespace {

/// Deeper than this the surface of the tongue does not yield to a tooth.
constexpr double kYields = 0.3;  // mm

SpokenTake take_of(const std::vector<std::string>& labels, double seconds_each) {
  Utterance utterance;
  double time = 0.2;
  for (const std::string& label : labels) {
    utterance.phonemes.push_back({label, time, time + seconds_each});
    time += seconds_each;
  }
  utterance.seconds = time + 0.3;
  return make_take(std::move(utterance), Alphabet::kIpa, 60, 100, "a word");
}

std::vector<std::vector<std::string>> words() {
  return {{"θ", "ɪ", "ŋ", "k"}, {"ð", "ɪ", "s"},      {"b", "æ", "θ"},      {"ʌ", "ð", "ə"},
          {"θ", "ɔ", "t"},      {"m", "ʌ", "ð", "ə"}, {"t", "iː", "θ"},     {"ð", "iː"},
          {"m", "aʊ", "θ"},     {"θ", "ɹ", "uː"},     {"f", "ɪ", "f", "θ"}, {"s", "iː", "ð"}};
}

TEST(Tongue, IsNotPiercedByTeethInAnyFrameOfDentalSounds) {
  double lower = 0, upper = 0, least_out = 1e9;
  for (const std::vector<std::string>& word : words()) {
    for (const double seconds : {0.05, 0.09, 0.16}) {
      const SpokenTake take = take_of(word, seconds);
      std::string name;
      for (const std::string& label : word) name += label;
      double out = -1e9;
      for (size_t f = 0; f < take.curves.frame_count; ++f) {
        const PiercedTongue pierced = spoken_head().pierced(take, f);
        EXPECT_LT(pierced.by_lower, kYields) << name << " at " << take.curves.time(f);
        EXPECT_LT(pierced.by_upper, kYields) << name << " at " << take.curves.time(f);
        lower = std::max(lower, pierced.by_lower);
        upper = std::max(upper, pierced.by_upper);
        out = std::max(out, spoken_head().tongue_over_teeth(take, f));
      }
      // It is seen there: beyond the edges of the lower incisors.
      if (seconds > 0.06) {
        EXPECT_GT(out, 1) << name;
        least_out = std::min(least_out, out);
      }
    }
  }
  std::printf("tongue at dental sounds: %.2f mm in lower teeth, %.2f in upper ones, %.1f mm out\n",
              lower, upper, least_out);
}

TEST(Tongue, ComesOutBetweenTheTeethOfSeveralPersons) {
  for (const uint64_t seed : {0, 1, 2, 3, 4, 5}) {
    SpokenHead head(seed);
    double lower = 0, upper = 0;
    for (const float jaw : {0.0f, 0.2f}) {
      for (int step = 0; step <= 25; ++step) {
        const float out = static_cast<float>(step) / 25;
        const PiercedTongue pierced = head.pierced({{"tongueOut", out}, {"jawOpen", jaw}});
        EXPECT_LT(pierced.by_lower, kYields) << seed << ": " << out << " jaw " << jaw;
        EXPECT_LT(pierced.by_upper, kYields) << seed << ": " << out << " jaw " << jaw;
        lower = std::max(lower, pierced.by_lower);
        upper = std::max(upper, pierced.by_upper);
      }
    }
    std::printf("seed %d: %.2f mm in lower teeth, %.2f in upper ones\n", static_cast<int>(seed),
                lower, upper);
    EXPECT_LT(head.tongue_over_teeth({}), 0);
    EXPECT_GT(head.tongue_over_teeth({{"tongueOut", 1}}), 15);
  }
}

}  // namespace
}  // namespace mien::speech
