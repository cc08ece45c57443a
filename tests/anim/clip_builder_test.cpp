// SPDX-License-Identifier: MIT
// Building: what goes in comes out, bit for bit or within half a step; wrong input is refused with
// its place.
#include "runtime/anim/clip_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "author/base/random.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/made_clip.h"

namespace mien {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();
constexpr float kDenormal = std::numeric_limits<float>::denorm_min();

Allocator allocator_of(CountingAllocator& counter) {
  const MienAllocator allocator = counter.get();
  return {allocator.user, allocator.allocate, allocator.release};
}

struct Material {
  const char* name;
  Curves (*make)();
};
void PrintTo(const Material& material, std::ostream* out) { *out << material.name; }
std::string material_name(const testing::TestParamInfo<Material>& info) { return info.param.name; }

/// Floats of any bits but those that are not finite.
Curves any_floats() {
  Random random = Random::from_seed(1, 1);
  Curves curves(7, 333);
  for (float& value : curves.values) {
    do value = float_of(random.bits());
    while (!std::isfinite(value));
  }
  return curves;
}

/// Zeros of both signs, and others, in runs of random lengths.
Curves runs_of_zeros() {
  Random random = Random::from_seed(2, 1);
  Curves curves(50, 300);
  for (uint32_t c = 0; c < curves.channels; ++c) {
    const uint32_t longest = 1 + random.below(40);
    float value = 0;
    for (uint32_t f = 0, left = 0; f < curves.frames; ++f) {
      if (left == 0) {
        left = 1 + random.below(longest);
        const float values[] = {0, 0, -0.0f, static_cast<float>(random.real()), 0.5f};
        value = values[random.below(c % 2 == 0 ? 5 : 3)];
      }
      --left;
      curves.at(f, c) = value == 0 ? value : value + static_cast<float>(f) * 1e-5f;
    }
  }
  return curves;
}

const Material kMaterials[] = {
    {"AuthoredKeys", [] { return authored_keys(7, 500); }},
    {"CleanSolve", [] { return clean_solve(7, 500); }},
    {"NoisySolve", [] { return noisy_solve(7, 500); }},
    {"DenseNoise", [] { return dense_noise(7, 300); }},
    {"PhoneCapture", [] { return phone_capture(7, 500); }},
    {"ThreeDecimals", [] { return rounded_to(phone_capture(7, 500), 1000); }},
    {"TenBits", [] { return rounded_to(phone_capture(7, 500), 1024); }},
    {"Halves", [] { return rounded_to_half(phone_capture(7, 500)); }},
    {"AnyFloats", any_floats},
    {"RunsOfZeros", runs_of_zeros},
    {"Denormals",
     [] {
       return one_channel({0, kDenormal, -kDenormal, 3 * kDenormal, 1e-40f, -0.0f, 1e-45f});
     }},
    {"AlternatingExtremes",
     [] {
       return one_channel({kMax, -kMax, kMax, -kMax, 0, kMax, -0.0f, -kMax, kDenormal});
     }},
    {"SignedZeros",
     [] {
       return one_channel({0, -0.0f, -0.0f, 0, 0, -0.0f});
     }},
    {"NegativeNumbers",
     [] {
       return one_channel({-1, -0.5f, -0.25f, 0, 0.25f, -1e-3f, -3e6f});
     }},
    {"LargeIntegers",
     [] {
       return one_channel({0, 3999999, -3999999, 4000000, 16777216});
     }},
    {"OneFrame", [] { return one_channel({0.3f}); }},
    {"TwoFrames",
     [] {
       return one_channel({0.3f, 0.1f});
     }},
    {"OneBlock",
     [] {
       Curves curves(1, 64);
       for (uint32_t f = 0; f < 64; ++f) curves.at(f, 0) = std::sqrt(static_cast<float>(f));
       return curves;
     }},
    {"OneBlockAndAFrame",
     [] {
       Curves curves(1, 65);
       for (uint32_t f = 0; f < 65; ++f) curves.at(f, 0) = std::sqrt(static_cast<float>(f));
       return curves;
     }},
};

class RoundTrip : public testing::TestWithParam<Material> {};

TEST_P(RoundTrip, GivesBackEveryBit) {
  const Curves curves = GetParam().make();
  EXPECT_TRUE(same_bits(decoded(MadeClip(ClipInput(curves)).clip), curves));
}

TEST_P(RoundTrip, OfSnappedValuesIsWithinHalfAStep) {
  const Curves curves = GetParam().make();
  for (uint32_t snap : {9u, 11u, 16u}) {
    const MadeClip made(ClipInput(curves, snap));
    const Curves snapped = decoded(made.clip);
    const double step = std::ldexp(1, -static_cast<int>(snap));
    for (size_t i = 0; i < curves.values.size(); ++i) {
      const double off = double{snapped.values[i]} - curves.values[i];
      ASSERT_LE(std::abs(off), step / 2) << curves.values[i];
      if (curves.values[i] == 0 || curves.values[i] == 1) {
        ASSERT_EQ(off, 0);
      }
    }
    // Snapping what was snapped changes nothing, and so does building it without.
    EXPECT_EQ(ClipInput(snapped, snap).build(), made.bytes);
    EXPECT_TRUE(same_bits(decoded(MadeClip(ClipInput(snapped)).clip), snapped));
  }
}

INSTANTIATE_TEST_SUITE_P(All, RoundTrip, testing::ValuesIn(kMaterials), material_name);

// The format, and the same bits everywhere: other compilers and machines build this very file.
TEST(ClipBuilder, BuildsTheSameBytesEverywhere) {
  ClipInput input(clean_solve(1, 200));
  input.events = {{1000, "a", 0.5f}};
  const std::vector<uint8_t> bytes = input.build();
  EXPECT_EQ(bytes.size(), 16488u);
  EXPECT_EQ(load_little_endian<uint32_t>(bytes.data() + kAtChecksum), 2227854733u);
  input.snaps.assign(kFaceControls, kDefaultSnap);
  const std::vector<uint8_t> snapped = input.build();
  EXPECT_EQ(snapped.size(), 11688u);
  EXPECT_EQ(load_little_endian<uint32_t>(snapped.data() + kAtChecksum), 1427392829u);
}

TEST(ClipBuilder, ReadsFramesApart) {
  const Curves curves = phone_capture(2, 100);
  Curves wide(kCaptureChannels + 5, 100);
  for (uint32_t f = 0; f < 100; ++f) {
    for (uint32_t c = 0; c < wide.channels; ++c) {
      wide.at(f, c) =
          c < kCaptureChannels ? curves.at(f, c) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  ClipInput input(curves);
  const std::vector<uint8_t> expected = input.build();
  input.curves.values = wide.values;
  ClipDesc desc = input.desc();
  desc.frame_stride = wide.channels;
  ClipBytes made;
  Error error;
  ASSERT_EQ(build_clip(desc, default_allocator(), {}, made, error), Status::kOk) << error.message;
  EXPECT_EQ(std::vector<uint8_t>(made.bytes, made.bytes + made.size), expected);
  release_clip(made);
}

TEST(ClipBuilder, SnapsTheChannelsThatItIsToldTo) {
  const Curves curves = phone_capture(2, 100);
  ClipInput input(curves);
  input.snaps[60] = 9;
  input.snaps[59] = 16;
  const MadeClip made(input);
  EXPECT_TRUE(made.clip.has(kClipSnapped));
  EXPECT_EQ(made.clip.snap, 9u) << "the coarsest step";
  const Curves out = decoded(made.clip);
  bool changed = false;
  for (uint32_t f = 0; f < 100; ++f) {
    for (uint32_t c = 0; c < 59; ++c) ASSERT_EQ(out.at(f, c), curves.at(f, c));
    EXPECT_EQ(out.at(f, 60), snapped_value(curves.at(f, 60), 9));
    changed |= out.at(f, 60) != curves.at(f, 60);
  }
  EXPECT_TRUE(changed);
}

TEST(ClipBuilder, SnappedChannelsThatNoLongerChangeAreConstant) {
  const MadeClip made(ClipInput(one_channel({0.5001f, 0.4999f, 0.5f}), 9));
  EXPECT_EQ(made.clip.changing_count, 0u);
  EXPECT_EQ(made.clip.rest(0), 0.5f);
}

TEST(SnappedValue, RoundsToTheNearestAndLeavesWhatIsBeyondTheGrid) {
  EXPECT_EQ(snapped_value(0.5f / 2048, 11), 1.0f / 2048);
  EXPECT_EQ(snapped_value(-0.6f / 2048, 11), -1.0f / 2048);
  EXPECT_EQ(bits_of(snapped_value(-0.0f, 11)), 0u);
  EXPECT_EQ(bits_of(snapped_value(-0.4f / 2048, 11)), 0u);
  EXPECT_EQ(snapped_value(180.00001f, 11), 180.0f);
  EXPECT_EQ(snapped_value(12345.678f, 11), 12345.678f);
  EXPECT_EQ(snapped_value(kMax, 9), kMax);
}

TEST(ClipBuilder, ReportsHowChannelsWereStored) {
  Curves curves(5, 130);
  Random random = Random::from_seed(1, 1);
  for (uint32_t f = 0; f < 130; ++f) {
    curves.at(f, 0) = 0.5f;                                           // never changes
    curves.at(f, 1) = f < 64 ? 0.0f : 0.75f;                          // zero, then constant
    curves.at(f, 2) = static_cast<float>(random.below(100)) / 100;    // a grid
    curves.at(f, 3) = static_cast<float>(random.real());              // floats
    curves.at(f, 4) = static_cast<float>(random.between(-0.1, 0.1));  // floats, to be snapped
  }
  ClipInput input(curves);
  input.snaps[4] = 10;
  std::vector<ChannelReport> reports;
  const std::vector<uint8_t> bytes = input.build(&reports);
  const auto expect_blocks = [&](uint32_t c, uint32_t zero, uint32_t constant, uint32_t grid,
                                 uint32_t floats) {
    EXPECT_EQ(reports[c].blocks[kBlockZero], zero) << c;
    EXPECT_EQ(reports[c].blocks[kBlockConstant], constant) << c;
    EXPECT_EQ(reports[c].blocks[kBlockGrid], grid) << c;
    EXPECT_EQ(reports[c].blocks[kBlockFloat], floats) << c;
  };
  expect_blocks(0, 0, 0, 0, 0);
  expect_blocks(1, 1, 2, 0, 0);
  expect_blocks(2, 0, 0, 3, 0);
  expect_blocks(3, 0, 0, 0, 3);
  expect_blocks(4, 0, 0, 3, 0);
  EXPECT_EQ(reports[0].bits, 0u);
  EXPECT_EQ(reports[1].bits, 2u + 34u + 34u);
  EXPECT_GT(reports[3].bits, 130u * 20);
  EXPECT_LT(reports[2].bits, 130u * 9);
  EXPECT_EQ(reports[3].max_error, 0);
  EXPECT_GT(reports[4].max_error, 0);
  EXPECT_LE(reports[4].max_error, 0.5f / 1024);
  uint64_t bits = 0;
  for (const ChannelReport& report : reports) bits += report.bits;
  const MadeClip made(bytes);
  EXPECT_LE(bits / 8, made.bytes.size() - made.clip.at.blocks);
}

TEST(ClipBuilder, StoresHalfOfTheFramesWhereTheOthersAreMeans) {
  Curves curves = rounded_to(phone_capture(5, 201), 1024);
  for (uint32_t f = 1; f < 201; f += 2) {
    for (uint32_t c = 0; c < curves.channels; ++c) {
      curves.at(f, c) = 0.5f * curves.at(f - 1, c) + 0.5f * curves.at(f + 1, c);
    }
  }
  const MadeClip half((ClipInput(curves)));
  EXPECT_TRUE(half.clip.has(kClipHalfRate));
  EXPECT_EQ(half.clip.frame_count, 201u);
  EXPECT_EQ(half.clip.block_count(), 2u);
  EXPECT_TRUE(same_bits(decoded(half.clip), curves));

  Curves other = curves;
  other.at(77, 3) = std::nextafter(other.at(77, 3), 1.0f);
  const MadeClip whole((ClipInput(other)));
  EXPECT_FALSE(whole.clip.has(kClipHalfRate)) << "one bit is reason enough";
  EXPECT_TRUE(same_bits(decoded(whole.clip), other));

  Curves even = curves;
  even.frames = 200;
  even.values.resize(size_t{200} * even.channels);
  EXPECT_FALSE(MadeClip(ClipInput(even)).clip.has(kClipHalfRate)) << "the last has one neighbor";
}

// Wrong input --------------------------------------------------------------------------------------

struct Refused {
  Status status;
  std::string message;
};

Refused refused(const ClipDesc& desc, Span<ChannelReport> reports = {}) {
  CountingAllocator counter;
  ClipBytes made = {{}, reinterpret_cast<uint8_t*>(&counter), 1};  // to be overwritten
  Error error;
  const Status status = build_clip(desc, allocator_of(counter), reports, made, error);
  EXPECT_EQ(made.bytes, nullptr);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  return {status, error.message};
}

void expect_refused(Status status, const char* part, const ClipDesc& desc) {
  const Refused got = refused(desc);
  EXPECT_EQ(got.status, status) << got.message;
  EXPECT_NE(got.message.find(part), std::string::npos) << got.message;
}

TEST(ClipBuilderRefuses, NumbersThatAreNotFiniteWithTheirPlace) {
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity()}) {
    for (uint32_t snap : {kNoSnap, kDefaultSnap}) {
      ClipInput input(phone_capture(1, 20), snap);
      input.curves.at(17, 3) = bad;
      input.curves.at(18, 1) = bad;
      expect_refused(Status::kClipValue, "frame 17, channel 3 (\"CTRL_expressions.control3\")",
                     input.desc());
    }
  }
}

TEST(ClipBuilderRefuses, NamesThatAreEmptyOrThereTwice) {
  ClipInput input(phone_capture(1, 20));
  input.names[5] = input.names[40];
  expect_refused(Status::kName, "CTRL_expressions.control40", input.desc());
  input.names[5] = "";
  expect_refused(Status::kName, "5", input.desc());
}

TEST(ClipBuilderRefuses, MoreChangingChannelsThanTheFormatNumbers) {
  Curves curves(kMaxChangingChannels + 1, 3);
  for (uint32_t c = 0; c < curves.channels; ++c) curves.at(1, c) = static_cast<float>(c + 1);
  ClipInput input(curves);
  expect_refused(Status::kClipLimit, "513", input.desc());
  for (uint32_t f = 0; f < 3; ++f) curves.at(f, 0) = 1;
  EXPECT_TRUE(same_bits(decoded(MadeClip(ClipInput(curves)).clip), curves));
}

TEST(ClipBuilderRefuses, MoreFramesThanTheFormatNumbers) {
  ClipInput input(phone_capture(1, 20));
  ClipDesc desc = input.desc();
  desc.frame_count = kMaxClipFrames + 1;
  expect_refused(Status::kClipLimit, "frames", desc);
}

TEST(ClipBuilderRefuses, DescriptionsThatDoNotFit) {
  ClipInput input(phone_capture(1, 20));
  const auto expect_invalid = [&](const char* part, void (*change)(ClipDesc&)) {
    ClipDesc desc = input.desc();
    change(desc);
    expect_refused(Status::kInvalidArgument, part, desc);
  };
  expect_invalid("rate", [](ClipDesc& d) { d.rate_numerator = 0; });
  expect_invalid("rate", [](ClipDesc& d) { d.rate_denominator = 0; });
  expect_invalid("frame", [](ClipDesc& d) { d.frame_count = 0; });
  expect_invalid("values", [](ClipDesc& d) { d.values = nullptr; });
  expect_invalid("stride", [](ClipDesc& d) { d.frame_stride = 60; });
  expect_invalid("snaps", [](ClipDesc& d) { d.snaps.count = 60; });
  for (uint8_t snap : {1, 8, 17, 255}) {
    input.snaps[60] = snap;
    expect_invalid("snaps", [](ClipDesc&) {});
  }
  input.snaps[60] = 0;
  std::vector<ChannelReport> reports(60);
  EXPECT_EQ(refused(input.desc(), {reports.data(), 60}).status, Status::kInvalidArgument);
}

TEST(ClipBuilderRefuses, EventsOutsideOrWithoutNameOrNumber) {
  ClipInput input(phone_capture(1, 20));
  const int64_t length = 20 * ticks_per_frame(60, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  input.events = {{0, "a", 0}, {-1, "b", 0}};
  expect_refused(Status::kInvalidArgument, "event 1", input.desc());
  input.events[1].tick = length;
  expect_refused(Status::kInvalidArgument, "event 1", input.desc());
  input.events[1] = {length - 1, "", 0};
  expect_refused(Status::kName, "empty", input.desc());
  input.events[1] = {length - 1, "b", nan};
  expect_refused(Status::kClipValue, "event 1", input.desc());
  input.events[1] = {length - 1, "b", 0};
  ClipDesc desc = input.desc();
  desc.event_names.count = 1;
  expect_refused(Status::kInvalidArgument, "event 1", desc);
  EXPECT_EQ(MadeClip(input).clip.event_count, 2u);
}

TEST(ClipBuilder, SurvivesEveryFailureOfTheAllocator) {
  ClipInput input(phone_capture(1, 100));
  input.events = {{0, "a", 0}};
  const ClipDesc desc = input.desc();
  size_t requests = 0;
  {
    CountingAllocator counter;
    ClipBytes made;
    Error error;
    ASSERT_EQ(build_clip(desc, allocator_of(counter), {}, made, error), Status::kOk);
    requests = counter.requests;
    EXPECT_EQ(counter.live, 1u) << "a clip is one block";
    EXPECT_LT(counter.peak, made.size + 4096) << "and building takes little more";
    release_clip(made);
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
  for (size_t k = 1; k <= requests; ++k) {
    CountingAllocator counter;
    counter.fail_at = k;
    ClipBytes made;
    Error error;
    EXPECT_EQ(build_clip(desc, allocator_of(counter), {}, made, error), Status::kMemory);
    EXPECT_EQ(made.bytes, nullptr);
    EXPECT_NE(error.message[0], 0);
    EXPECT_TRUE(counter.clean()) << counter.first_wrong;
  }
}

}  // namespace
}  // namespace mien
