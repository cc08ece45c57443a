// SPDX-License-Identifier: MIT
// How small clips are, on generated curves with the statistics of real material (clip_curves.h).
// Ratios are float32 values of the same channels against the whole file, names included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/made_clip.h"

namespace mien {
namespace {

constexpr uint32_t kMinute = 3600;  // frames
constexpr uint64_t kSeed = 1;

double ratio(const Curves& curves, uint32_t snap = kNoSnap) {
  return static_cast<double>(curves.raw_bytes()) /
         static_cast<double>(ClipInput(curves, snap).build().size());
}

/// Ten takes, geometric mean.
double capture_ratio(uint32_t snap) {
  double product = 1;
  for (uint64_t seed = 1; seed <= 10; ++seed) product *= ratio(phone_capture(seed, kMinute), snap);
  return std::pow(product, 0.1);
}

#define EXPECT_RATIO(gate, value)                                           \
  do {                                                                      \
    const double measured = (value);                                        \
    EXPECT_GE(measured, gate) << #value;                                    \
    printf("%7.2f  (at least %.1f)  %s\n", measured, double(gate), #value); \
  } while (false)

TEST(ClipSize, Lossless) {
  EXPECT_RATIO(30, ratio(authored_keys(kSeed, kMinute)));
  EXPECT_RATIO(28, ratio(clean_solve(kSeed, kMinute)));
  EXPECT_RATIO(7, ratio(noisy_solve(kSeed, kMinute)));
  EXPECT_RATIO(3.9, ratio(dense_noise(kSeed, kMinute)));
  EXPECT_RATIO(2.4, capture_ratio(kNoSnap));
}

TEST(ClipSize, LosslessOfSourcesWithFewDigits) {
  EXPECT_RATIO(10, ratio(rounded_to(phone_capture(kSeed, kMinute), 1000)));
  EXPECT_RATIO(10, ratio(rounded_to(phone_capture(kSeed, kMinute), 1024)));
  EXPECT_RATIO(10, ratio(rounded_to(clean_solve(kSeed, kMinute), 10000)));
  EXPECT_RATIO(7, ratio(rounded_to_half(noisy_solve(kSeed, kMinute))));
  EXPECT_RATIO(7, ratio(rounded_to_half(dense_noise(kSeed, kMinute))));
  // Captures in finer steps compress less. Steps of 1e-4 are 4.88 times as fine as 2^-11, which costs up
  // to 2.29 bits more for each sample that is not 0: 3.64 bits per sample (a ratio of 8.8) instead of
  // 2.50 (12.8). Linear prediction alone gives at most 8.3 and 11.5, even if each residual takes no more
  // than its entropy and widths, masks and first samples take no space.
  EXPECT_RATIO(8.5, ratio(rounded_to(phone_capture(kSeed, kMinute), 10000)));
  EXPECT_RATIO(5.5, ratio(rounded_to_half(phone_capture(kSeed, kMinute))));
}

TEST(ClipSize, Snapped) {
  EXPECT_RATIO(66, ratio(authored_keys(kSeed, kMinute), kDefaultSnap));
  EXPECT_RATIO(66, ratio(clean_solve(kSeed, kMinute), kDefaultSnap));
  EXPECT_RATIO(20, ratio(noisy_solve(kSeed, kMinute), kDefaultSnap));
  EXPECT_RATIO(14, ratio(dense_noise(kSeed, kMinute), kDefaultSnap));
  EXPECT_RATIO(10, capture_ratio(kDefaultSnap));
}

/// Bytes if each channel that changes had one number of bits for all its frames, enough for its
/// range at a precision of +-5e-4, and nothing else took room: less than any such format needs.
double one_precision_bytes(const Curves& curves) {
  double bits = 0;
  for (uint32_t c = 0; c < curves.channels; ++c) {
    float low = curves.at(0, c), high = low;
    for (uint32_t f = 0; f < curves.frames; ++f) {
      low = std::min(low, curves.at(f, c));
      high = std::max(high, curves.at(f, c));
    }
    if (high > low) bits += curves.frames * std::ceil(std::log2((high - low) / 1e-3 + 1));
  }
  return bits / 8;
}

TEST(ClipSize, SnappedIsSmallerThanOnePrecisionForEachChannel) {
  const auto share = [](const Curves& curves) {
    return one_precision_bytes(curves) /
           static_cast<double>(ClipInput(curves, kDefaultSnap).build().size());
  };
  EXPECT_RATIO(6, share(authored_keys(kSeed, kMinute)));
  EXPECT_RATIO(6, share(clean_solve(kSeed, kMinute)));
  EXPECT_RATIO(4, share(noisy_solve(kSeed, kMinute)));
  EXPECT_RATIO(1.6, share(dense_noise(kSeed, kMinute)));
  EXPECT_RATIO(2, share(phone_capture(kSeed, kMinute)));
}

// What the material is like --------------------------------------------------------------------------

struct Statistics {
  double nonzero = 0;            // share of samples
  uint32_t median = 0, max = 0;  // channels that are not zero, by frame
  uint32_t random_bits = 0;      // median of the bits that change between frames, without zeros
};

Statistics statistics(const Curves& curves) {
  Statistics result;
  std::vector<uint32_t> counts, bits;
  for (uint32_t f = 0; f < curves.frames; ++f) {
    uint32_t count = 0;
    for (uint32_t c = 0; c < curves.channels; ++c) {
      count += curves.at(f, c) != 0;
      if (f == 0 || curves.at(f - 1, c) == 0 || curves.at(f, c) == 0) continue;
      const auto difference = std::abs(double(ordered_from_bits(bits_of(curves.at(f, c)))) -
                                       ordered_from_bits(bits_of(curves.at(f - 1, c))));
      if (difference > 0) bits.push_back(static_cast<uint32_t>(std::log2(difference)));
    }
    counts.push_back(count);
    result.nonzero += count;
  }
  result.nonzero /= static_cast<double>(curves.values.size());
  std::sort(counts.begin(), counts.end());
  std::sort(bits.begin(), bits.end());
  result.median = counts[counts.size() / 2];
  result.max = counts.back();
  result.random_bits = bits[bits.size() / 2];
  return result;
}

TEST(ClipCurves, HaveTheStatisticsOfRealMaterial) {
  for (const Curves& curves : {authored_keys(kSeed, kMinute), clean_solve(kSeed, kMinute)}) {
    const Statistics s = statistics(curves);
    EXPECT_GE(s.median, 16u);
    EXPECT_LE(s.median, 18u);
    EXPECT_LE(s.max, 62u);
  }
  const Statistics solve = statistics(noisy_solve(kSeed, kMinute));
  EXPECT_GE(solve.median, 35u) << "a solver leaves more controls away from zero";
  EXPECT_LE(solve.max, 66u);
  EXPECT_GE(statistics(dense_noise(kSeed, kMinute)).median, 101u);
  double nonzero = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    const Statistics capture = statistics(phone_capture(seed, kMinute));
    nonzero += capture.nonzero / 10;
    EXPECT_NEAR(capture.nonzero, 0.5, 0.06);
    EXPECT_GE(capture.random_bits, 19u);
    EXPECT_LE(capture.random_bits, 21u);
  }
  EXPECT_NEAR(nonzero, 0.5, 0.02);
}

}  // namespace
}  // namespace mien
