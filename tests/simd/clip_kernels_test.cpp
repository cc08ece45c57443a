// SPDX-License-Identifier: MIT
// The decoder of clips: every instruction set against a model that takes bit after bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "author/base/random.h"
#include "runtime/anim/clip_block.h"
#include "runtime/base/bits.h"
#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

constexpr uint32_t kBlockBytes = 4096;
constexpr size_t kGroupCounts[] = {1, 2, 7, 8, 9, 17};

float float_from(uint32_t bits) {
  float value;
  memcpy(&value, &bits, sizeof(value));
  return value;
}

/// Lanes within a run: some constant groups, widths from none to 32 bits.
std::vector<ClipLanes> random_groups(Random& random, size_t count) {
  std::vector<ClipLanes> groups(count);
  for (ClipLanes& group : groups) {
    memset(&group, 0, sizeof(group));
    group.turns = random.chance(0.2) ? 0 : 1;
    const bool curved = random.chance(0.5);
    for (uint32_t k = 0; k < kClipLanes; ++k) {
      group.bit[k] = static_cast<uint32_t>(random.below(kBlockBytes * 4));
      group.width[k] = static_cast<uint32_t>(random.below(33));
      group.mask[k] = static_cast<uint32_t>((uint64_t{1} << group.width[k]) - 1);
      group.last[k] = random.bits();
      group.linear[k] = random.chance(0.5) ? ~0u : 0;
      group.slope[k] = group.linear[k] & random.bits();
      group.present[k] = random.chance(0.8) ? ~0u : 0;
      group.unit[k] = 1;
      group.scale[k] = 1;
      if (!curved) continue;
      group.curved[0] = 1;
      group.order[k] = static_cast<int32_t>(random.below(4));
      group.linear[k] = group.order[k] >= 1 ? ~0u : 0;
      group.slope[k] = 0;
      if (random.chance(0.5)) group.unit[k] = 0;
      if (random.chance(0.5)) {  // values near each other: small changes
        group.last[k] = ordered_from_bits(bits_of(0.5f)) + static_cast<uint32_t>(random.below(99));
        group.width[k] = static_cast<uint32_t>(random.below(8));
        group.mask[k] = (1u << group.width[k]) - 1;
      }
      group.scale[k] = curve_scale(static_cast<uint32_t>(random.below(32)));
      group.number[k] = group.unit[k] == 0 || group.order[k] < 2
                            ? group.last[k]
                            : curve_number(group.last[k], group.scale[k]);
    }
  }
  return groups;
}

/// An integer as a float of at most 24 bits: the lower ones are cut off.
float float_from_number(int64_t number, float scale) {
  int64_t magnitude = number < 0 ? -number : number;
  for (int64_t bit = 1; magnitude >> 24 >= bit; bit *= 2) magnitude &= ~bit;
  const float value = static_cast<float>(magnitude & 0x7FFFFFFF) / scale;
  return number < 0 ? -value : value;
}

/// Orders 0 to 3, by differences of differences.
void continue_curve(uint32_t change, ClipLanes& group, uint32_t k) {
  const int32_t order = std::min(group.order[k], std::max(group.age[k], 1));
  group.last[k] += change;
  uint32_t number = group.last[k];
  const bool is_float = group.unit[k] != 0 && group.order[k] >= 2;
  if (is_float) {
    const double value = double{float_from(bits_from_ordered(number))} * group.scale[k];
    const double limit = 1 << 30;
    number = static_cast<uint32_t>(
        static_cast<int32_t>(std::isnan(value) ? limit : std::max(-limit, std::min(limit, value))));
  }
  const uint32_t difference = number - group.number[k], bend = difference - group.difference[k];
  uint32_t slope = group.order[k] >= 1 ? difference : 0;
  if (order >= 2) slope += bend;
  if (order >= 3) slope += bend - group.bend[k];
  group.slope[k] = slope;
  if (is_float) {
    const float next = float_from_number(static_cast<int32_t>(number + slope), group.scale[k]);
    group.slope[k] = ordered_from_bits(bits_of(next)) - group.last[k];
  }
  group.number[k] = number;
  group.difference[k] = difference;
  group.bend[k] = bend;
  group.age[k] = std::min(group.age[k] + 1, 3);
}

/// docs of runtime/anim/clip_block.h: residuals are zigzag coded, lowest bit first.
void decode_next(const std::vector<uint8_t>& block, ClipLanes& group) {
  if (group.turns == 0) return;
  for (uint32_t k = 0; k < kClipLanes; ++k) {
    uint64_t code = 0;
    for (uint32_t i = 0; i < group.width[k]; ++i) {
      const uint32_t at = group.bit[k] + i;
      code |= uint64_t{block[at / 8] >> (at % 8) & 1u} << i;
    }
    const auto half = static_cast<int64_t>(code / 2);
    const int64_t residual = code % 2 == 0 ? half : -half - 1;
    const auto change = static_cast<uint32_t>(int64_t{group.slope[k]} + residual);
    group.bit[k] += group.width[k];
    if (group.curved[0]) {
      if (group.present[k]) continue_curve(change, group, k);
      continue;
    }
    if (group.present[k]) group.last[k] += change;
    group.slope[k] = group.linear[k] ? change : 0;
  }
}

TEST(NextSamplesKernel, TakesTheResidualOfEachLane) {
  Random random = Random::from_seed(31, 0);
  std::vector<uint8_t> block(kBlockBytes);
  for (uint8_t& byte : block) byte = static_cast<uint8_t>(random.below(256));
  for (const size_t count : kGroupCounts) {
    const std::vector<ClipLanes> start = random_groups(random, count + 1);
    for (const KernelTable* kernels : present_kernels()) {
      std::vector<ClipLanes> found = start, expected = start;
      for (int step = 0; step < 8; ++step) {
        kernels->next_samples(block.data(), found.data(), count);  // the last group is left alone
        for (size_t g = 0; g < count; ++g) decode_next(block, expected[g]);
        for (size_t g = 0; g <= count; ++g) {
          EXPECT_EQ(memcmp(&found[g], &expected[g], sizeof(ClipLanes)), 0)
              << kernels->name << ": group " << g << " of " << count << ", step " << step;
        }
      }
    }
  }
}

/// Lanes with a value: of a grid, or a float whose lowest bits are 0; or none.
ClipLanes lanes_with_values(Random& random, float* values) {
  ClipLanes group;
  memset(&group, 0, sizeof(group));
  for (uint32_t k = 0; k < kClipLanes; ++k) {
    group.scale[k] = 1;
    const auto shift = static_cast<uint32_t>(random.below(24));
    const uint32_t number = random.bits() >> shift << shift;
    if (random.chance(0.5)) {
      group.scale[k] = kGridScales[random.below(16)];
      const auto step = static_cast<int32_t>(random.bits()) >> random.below(32);
      group.last[k] = static_cast<uint32_t>(step);
      values[k] = static_cast<float>(step) / group.scale[k];
    } else {
      // Of an exponent below that of infinity.
      const uint32_t finite = number & ~(1u << 30);
      group.unit[k] = 1u << shift;
      group.last[k] = ordered_from_bits(finite) >> shift;
      values[k] = float_from(finite);
    }
    group.present[k] = random.chance(0.8) ? ~0u : 0;
    if (!group.present[k]) values[k] = 0;
  }
  return group;
}

TEST(SampleValuesKernel, GivesTheBitsThatWereCoded) {
  Random random = Random::from_seed(32, 0);
  for (const size_t count : kGroupCounts) {
    for (int round = 0; round < 50; ++round) {
      std::vector<ClipLanes> groups(count);
      std::vector<float> expected(count * kClipLanes);
      for (size_t g = 0; g < count; ++g) {
        groups[g] = lanes_with_values(random, expected.data() + g * kClipLanes);
      }
      for (const KernelTable* kernels : present_kernels()) {
        std::vector<float> row(count * kClipLanes + 1, 12345.0f);
        EXPECT_TRUE(kernels->sample_values(groups.data(), count, row.data())) << kernels->name;
        for (size_t i = 0; i < expected.size(); ++i) {
          EXPECT_EQ(bits_of(row[i]), bits_of(expected[i])) << kernels->name << ": " << expected[i];
        }
        EXPECT_EQ(row.back(), 12345.0f);
      }
    }
  }
}

TEST(SampleValuesKernel, TellsOfValuesThatAreNotFinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr size_t kGroups = 3;
  for (const float bad : {kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()}) {
    for (uint32_t lane = 0; lane < kGroups * kClipLanes; ++lane) {
      Random random = Random::from_seed(33, lane);
      std::vector<ClipLanes> groups(kGroups);
      std::vector<float> expected(kGroups * kClipLanes);
      for (size_t g = 0; g < kGroups; ++g) {
        groups[g] = lanes_with_values(random, expected.data() + g * kClipLanes);
      }
      ClipLanes& group = groups[lane / kClipLanes];
      const uint32_t k = lane % kClipLanes;
      group.unit[k] = 1;
      group.last[k] = ordered_from_bits(bits_of(bad));
      expected[lane] = 0;
      for (const bool present : {true, false}) {  // what is not there cannot be wrong
        group.present[k] = present ? ~0u : 0;
        for (const KernelTable* kernels : present_kernels()) {
          std::vector<float> row(expected.size());
          EXPECT_EQ(kernels->sample_values(groups.data(), kGroups, row.data()), !present)
              << kernels->name << ": lane " << lane << ", " << bad;
          EXPECT_EQ(memcmp(row.data(), expected.data(), row.size() * sizeof(float)), 0)
              << kernels->name << ": lane " << lane << ", " << bad;
        }
      }
    }
  }
}

}  // namespace
}  // namespace mien
