// SPDX-License-Identifier: MIT
#include "integrations/program/io/fingerprint.h"

#include <gtest/gtest.h>
#include <mien.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace mien::cli {
namespace {

using Data = std::vector<unsigned char>;

constexpr size_t kBlockBytes = Fingerprint::kStripeBytes * Fingerprint::kBlockStripes;

Data random_data(size_t size) {
  std::mt19937 random;
  Data data(size);
  for (unsigned char& byte : data) byte = static_cast<unsigned char>(random() >> 8);
  return data;
}

std::string fingerprint_of(const Data& data) {
  Fingerprint fingerprint;
  fingerprint.add(data.data(), data.size());
  return fingerprint.text();
}

uint64_t stirred(uint64_t bits) {
  bits = (bits ^ bits >> 32) * 0x9e3779b97f4a7c15;
  bits = (bits ^ bits >> 29) * 0x9e3779b97f4a7c15;
  return bits ^ bits >> 32;
}

/// From the definition, a word at a time.
std::string plain_fingerprint(Data data) {
  uint64_t lanes[8] = {0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0,
                       0x082efa98ec4e6c89, 0x452821e638d01377, 0xbe5466cf34e90c6c,
                       0xc0ac29b7c97c50dd, 0x3f84d5b5b5470917};
  const uint64_t size = data.size();
  data.resize((size / Fingerprint::kStripeBytes + 1) * Fingerprint::kStripeBytes);
  const auto word = [&](size_t at) {
    return data[at] | uint32_t{data[at + 1]} << 8 | uint32_t{data[at + 2]} << 16 |
           uint32_t{data[at + 3]} << 24;
  };
  const auto key = [](uint64_t index) {
    return static_cast<uint32_t>(stirred((index + 1) * 0x9e3779b97f4a7c15));
  };
  // A block that ends with the last stripe is followed by an empty one.
  for (size_t block = 0; block <= data.size(); block += kBlockBytes) {
    uint64_t sums[8] = {};
    for (size_t at = block; at < std::min(block + kBlockBytes, data.size()); at += 8) {
      const size_t stripe = (at - block) / Fingerprint::kStripeBytes;
      const size_t pair = (at % Fingerprint::kStripeBytes) / 8;
      const uint64_t index = Fingerprint::kStripeBytes / 4 * stripe + 2 * pair;
      sums[pair / 4 * 2 + pair % 2] +=
          uint64_t{word(at) + key(index)} * (word(at + 4) + key(index + 1));
    }
    for (size_t lane = 0; lane < 8; ++lane) {
      const uint64_t bits = (lanes[lane] ^ sums[lane]) * 0x9e3779b97f4a7c15;
      lanes[lane] = bits ^ bits >> 29;
    }
  }
  uint64_t bits = size;
  for (const uint64_t lane : lanes) bits = stirred(bits ^ lane);
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx", static_cast<unsigned long long>(bits));
  return digits;
}

TEST(Fingerprint, IsWhatItsDefinitionGives) {
  const Data data = random_data(3 * kBlockBytes + 77);
  for (const size_t size :
       {size_t{0}, size_t{1}, size_t{7}, size_t{127}, size_t{128}, size_t{129}, kBlockBytes - 1,
        kBlockBytes, kBlockBytes + 1, 2 * kBlockBytes, data.size()}) {
    const Data part(data.begin(), data.begin() + static_cast<ptrdiff_t>(size));
    EXPECT_EQ(fingerprint_of(part), plain_fingerprint(part)) << size << " bytes";
    Fingerprint without_avx2(false);
    without_avx2.add(part.data(), part.size());
    EXPECT_EQ(without_avx2.text(), plain_fingerprint(part)) << size << " bytes";
  }
}

TEST(Fingerprint, DoesNotDependOnHowBytesAreSplit) {
  const Data data = random_data(2 * kBlockBytes + 33);
  const std::string whole = fingerprint_of(data);
  for (const size_t step : {1, 4, 31, 128, 1000, 5000}) {
    Fingerprint fingerprint;
    for (size_t at = 0; at < data.size(); at += step) {
      fingerprint.add(data.data() + at, std::min(step, data.size() - at));
    }
    EXPECT_EQ(fingerprint.text(), whole) << "in steps of " << step;
  }
}

TEST(Fingerprint, ChangesWithEveryBit) {
  Data data = random_data(kBlockBytes + 200);
  std::set<std::string> seen = {fingerprint_of(data)};
  for (size_t bit = 0; bit < 8 * data.size(); ++bit) {
    data[bit / 8] ^= 1 << bit % 8;
    EXPECT_TRUE(seen.insert(fingerprint_of(data)).second) << "bit " << bit;
    data[bit / 8] ^= 1 << bit % 8;
  }
}

TEST(Fingerprint, ChangesWithOrderSignsAndLength) {
  const Data data = random_data(2 * kBlockBytes);
  std::set<std::string> seen = {fingerprint_of(data)};
  for (size_t unit = 4; unit <= kBlockBytes;
       unit *= 2) {  // words to blocks, exchanged with the next
    for (size_t at = 0; at + 2 * unit <= data.size(); at += unit) {
      Data changed = data;
      std::swap_ranges(changed.begin() + static_cast<ptrdiff_t>(at),
                       changed.begin() + static_cast<ptrdiff_t>(at + unit),
                       changed.begin() + static_cast<ptrdiff_t>(at + unit));
      EXPECT_TRUE(seen.insert(fingerprint_of(changed)).second) << unit << " bytes at " << at;
    }
  }
  for (size_t distance = 4; distance < kBlockBytes; distance += 4) {  // signs of two floats
    Data changed = data;
    changed[3] ^= 0x80;
    changed[3 + distance] ^= 0x80;
    EXPECT_TRUE(seen.insert(fingerprint_of(changed)).second) << "signs " << distance << " apart";
  }
  for (size_t size = 0; size < 300; ++size) {  // zeros, too, are counted
    EXPECT_TRUE(seen.insert(fingerprint_of(Data(size))).second) << size << " zeros";
  }
}

TEST(Fingerprint, FindsTheFirstFloatThatIsNotFinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> numbers(1100, 0.5f);
  const bool has_avx2 = mien_isa_available(MIEN_ISA_AVX2) != 0;
  for (const size_t before : {0, 3, 12}) {  // bytes, so that floats lie anywhere in stripes
    for (const float bad : {kInfinity, -kInfinity, std::nanf("")}) {
      for (size_t at = 0; at < numbers.size(); ++at) {
        Fingerprint fingerprint(has_avx2 && at % 2 == 0);
        fingerprint.add("text before the numbers", before);
        numbers[at] = bad;
        EXPECT_EQ(fingerprint.add_floats(numbers.data(), numbers.size()), at);
        numbers[at] = 0.5f;
      }
    }
  }
  // The sum of these is not finite, though they are.
  std::fill(numbers.begin(), numbers.end(), std::numeric_limits<float>::max());
  EXPECT_EQ(Fingerprint().add_floats(numbers.data(), numbers.size()), numbers.size());
  EXPECT_EQ(Fingerprint().add_floats(nullptr, 0), 0u);
}

TEST(Fingerprint, OfFloatsIsThatOfTheirBytes) {
  std::mt19937 random;
  std::vector<float> numbers(3000);
  for (float& number : numbers) number = static_cast<float>(random()) * 0x1p-32f;
  Fingerprint floats, bytes;
  for (size_t at = 0; at < numbers.size(); at += 250) {
    EXPECT_EQ(floats.add_floats(&numbers[at], 250), 250u);
  }
  bytes.add(numbers.data(), 4 * numbers.size());
  EXPECT_EQ(floats.text(), bytes.text());
}

}  // namespace
}  // namespace mien::cli
