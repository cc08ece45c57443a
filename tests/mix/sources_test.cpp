// SPDX-License-Identifier: MIT
// Streams and generators: what moves a face without a clip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "tests/support/mix_setup.h"

namespace mien {
namespace {

constexpr uint32_t kSourceCurves = 8;

struct StreamMix {
  std::vector<uint16_t> curves = {1, 2, 5};
  MixHandle mix;

  explicit StreamMix(int64_t delay, uint32_t frames = 16) {
    MixInput input(kSourceCurves);
    LayerDesc& layer = input.add(BlendMode::kOverride, LayerSource::kStream);
    layer.curves = {curves.data(), curves.size()};
    layer.delay = delay;
    layer.stream_frames = frames;
    mix = make_mix(input);
  }
};

bool push(OwnMixer& own, int64_t tick, const Row& values) {
  Error error;
  bool accepted = false;
  EXPECT_EQ(push_row(own.mixer, 0, tick, {values.data(), values.size()}, &accepted, error),
            Status::kOk)
      << error.message;
  return accepted;
}

/// Continuous, with a period of 4 s and speeds up to 1 per second.
Row face_at(double seconds) {
  const auto wave = [](double t) {
    const double x = t / 4 - std::floor(t / 4);
    return static_cast<float>(0.5 + 0.3 * std::sin(2 * 3.14159265358979 * x));
  };
  return {wave(seconds), wave(seconds + 1), wave(seconds + 2.5)};
}

TEST(Stream, IsLinearBetweenItsFramesAndDelayed) {
  const StreamMix stream(100 * kMillisecond);
  OwnMixer own(stream.mix);
  push(own, 0, {0, 0, 1});
  push(own, 50 * kMillisecond, {0, 1, 1});
  push(own, 100 * kMillisecond, {1, 1, 1});
  for (int i = 0; i < 14; ++i) push(own, (101 + i) * kMillisecond, {1, 1, 1});
  own.step(100 * kMillisecond);  // fades in from here
  Row row = own.step(25 * kMillisecond);
  const float shown = row[5];
  EXPECT_GT(shown, 0.0f);
  EXPECT_NEAR(row[2], 0.5f * shown, 1e-6f);
  EXPECT_EQ(row[0], 0.0f);
}

TEST(Stream, WithLossJitterAndAGapMakesNoJump) {
  const StreamMix stream(60 * kMillisecond);
  OwnMixer own(stream.mix);
  Random random = Random::from_seed(70, 0);
  // 60 frames a second, 30 % lost, 40 ms of jitter, none from 4 s to 5 s.
  std::vector<std::pair<int, int>> arrivals;  // millisecond, frame
  for (int frame = 0; frame < 600; ++frame) {
    const int sent = frame * 1000 / 60;
    if (random.chance(0.3) || (sent >= 4000 && sent < 5000)) continue;
    arrivals.push_back({sent + static_cast<int>(random.below(40)), frame});
  }
  std::sort(arrivals.begin(), arrivals.end());
  size_t next = 0;
  Row before(kSourceCurves);
  bool rested = false;
  float largest = 0;
  for (int ms = 1; ms < 9900; ++ms) {
    for (; next < arrivals.size() && arrivals[next].first <= ms; ++next) {
      const int frame = arrivals[next].second;
      push(own, frame * kTicksPerSecond / 60, face_at(frame / 60.0));
    }
    const Row row = own.step(kMillisecond);
    for (uint32_t l = 0; l < kSourceCurves; ++l) {
      // The curve's own speed, up to three times where jitter skips frames, and a fade in 250 ms.
      largest = std::max(largest, std::fabs(row[l] - before[l]) * 1000);
    }
    before = row;
    if (ms == 4500) {
      for (float value : row) EXPECT_EQ(value, 0.0f);
      rested = true;
    }
    const bool steady = (ms > 1000 && ms < 3900) || ms > 6000;
    if (steady) {
      const Row expected = face_at((ms - 60) / 1000.0);
      EXPECT_NEAR(row[1], expected[0], 0.08f) << ms;
      EXPECT_NEAR(row[5], expected[2], 0.08f) << ms;
    }
  }
  EXPECT_TRUE(rested);
  EXPECT_LE(largest, 1.875f / 0.25f);
}

TEST(Stream, BlendsToRowsThatDoNotGoOnAsWasGuessed) {
  const StreamMix stream(0, 64);
  OwnMixer own(stream.mix);
  for (int ms = 0; ms <= 440; ms += 20) {
    push(own, ms * kMillisecond,
         {ms < 400 ? 0.4f : 0.4f + 0.001f * static_cast<float>(ms - 400), 0, 0});
  }
  float before = own.step(470 * kMillisecond)[1];
  EXPECT_NEAR(before, 0.47f, 1e-4f) << "30 ms after the last row";
  for (int ms = 470; ms <= 700; ms += 25) push(own, ms * kMillisecond, {0.1f, 0, 0});
  float fastest = 0;
  for (int ms = 471; ms <= 600; ++ms) {
    const float now = own.step(kMillisecond)[1];
    fastest = std::max(fastest, std::fabs(now - before) * 1000);
    before = now;
  }
  EXPECT_EQ(before, 0.1f);
  EXPECT_GT(fastest, 5.0f);
  EXPECT_LE(fastest, 1 + 1.875f * 0.38f / 0.1f) << "its own speed and that of a blend in 100 ms";
}

TEST(Stream, FadesOutFromItsOwnTimeWhateverTheSteps) {
  const StreamMix stream(0);
  OwnMixer fine(stream.mix), coarse(stream.mix);
  for (OwnMixer* own : {&fine, &coarse}) {
    for (int ms : {0, 50, 100, 150, 200, 250, 294}) {
      push(*own, ms * kMillisecond, {0.5f, 0.001f * static_cast<float>(ms), 1});
    }
  }
  for (int ms = 16; ms < 1000; ms += 16) {
    for (int k = 0; k < 3; ++k) fine.step(4 * kMillisecond);
    const Row row = fine.step(4 * kMillisecond);
    ASSERT_TRUE(same_bits(coarse.step(16 * kMillisecond), row)) << ms;
    if (ms == 304) {
      EXPECT_EQ(row[1], 0.5f);
    } else if (ms == 464) {
      EXPECT_NEAR(row[1], 0.25f, 0.03f) << "344 ms and half of 250 ms";
    } else if (ms > 600) {
      EXPECT_EQ(row[1], 0.0f);
    }
  }
}

TEST(Stream, DropsWhatIsLateOrTooMuchAndRefusesWhatIsNotFinite) {
  const StreamMix stream(0, 4);
  OwnMixer own(stream.mix);
  EXPECT_TRUE(push(own, 10, {0, 0, 0}));
  EXPECT_FALSE(push(own, 10, {1, 1, 1}));
  EXPECT_FALSE(push(own, 5, {1, 1, 1}));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(push(own, 20 + i, {0, 0, 0}));
  EXPECT_FALSE(push(own, 30, {0, 0, 0}));
  own.step(25);
  EXPECT_TRUE(push(own, 30, {0, 0, 0}));

  Error error;
  const Row bad = {0, NAN, 0}, few = {0, 0};
  EXPECT_EQ(push_row(own.mixer, 0, 40, {bad.data(), 3}, nullptr, error), Status::kInvalidArgument);
  EXPECT_EQ(push_row(own.mixer, 0, 40, {few.data(), 2}, nullptr, error), Status::kMismatch);
  const Row good(3);
  EXPECT_EQ(push_row(own.mixer, 0, INT64_MAX, {good.data(), 3}, nullptr, error),
            Status::kInvalidArgument);
  EXPECT_EQ(push_row(own.mixer, 1, 40, {bad.data(), 3}, nullptr, error), Status::kIndex);
}

TEST(Stream, TakesRowsFromAnotherThread) {
  const StreamMix stream(0);
  OwnMixer own(stream.mix);
  std::thread producer([&] {
    for (int i = 0; i < 20000; ++i) {
      Error error;
      const Row row(3, static_cast<float>(i % 2));
      push_row(own.mixer, 0, i * kMillisecond, {row.data(), 3}, nullptr, error);
    }
  });
  bool whole = true;
  for (int i = 0; i < 20000; ++i) {
    const Row row = own.step(kMillisecond);
    whole = whole && row[1] == row[2] && row[1] == row[5];
  }
  producer.join();
  EXPECT_TRUE(whole);
}

// Generators -----------------------------------------------------------------------------------------

MixHandle generator_mix(MixInput& input, Generator kind, int64_t period,
                        Span<const uint16_t> curves, Span<const float> amounts,
                        BlendMode mode = BlendMode::kAdd) {
  LayerDesc& layer = input.add(mode, LayerSource::kGenerator, LayerGroup::kLife);
  layer.generator = kind;
  layer.period = period;
  layer.curves = curves;
  layer.amounts = amounts;
  return make_mix(input);
}

const uint16_t kTwo[2] = {2, 3};
const float kOnes[2] = {1, 1};

TEST(Blinks, ComeAboutEveryPeriodAndCloseBothLids) {
  MixInput input(kSourceCurves);
  const MixHandle mix = generator_mix(input, Generator::kBlink, 4 * kTicksPerSecond, {kTwo, 2},
                                      {kOnes, 2}, BlendMode::kMax);
  OwnMixer own(mix, 5), same(mix, 5), other(mix, 6);
  int blinks = 0, differing = 0;
  float before = 0, last_right = 0;
  int last = -1000;
  for (int ms = 1; ms < 400000; ms += 5) {
    const Row row = own.step(5 * kMillisecond);
    ASSERT_TRUE(same_bits(same.step(5 * kMillisecond), row));
    differing += !same_bits(other.step(5 * kMillisecond), row);
    if (row[2] > 0.99f && before <= 0.99f) {
      EXPECT_GE(ms - last, 495);
      last = ms;
      ++blinks;
    }
    before = row[2];
    last_right = std::max(last_right, std::fabs(row[2] - row[3]));
    ASSERT_EQ(row[0], 0.0f);
  }
  EXPECT_GT(blinks, 80);
  EXPECT_LT(blinks, 125);
  EXPECT_GT(differing, 1000);
  EXPECT_LT(last_right, 0.3f);
  EXPECT_GT(last_right, 0.0f);
}

TEST(Blinks, CloseIn75StayFor25AndOpenIn150Milliseconds) {
  MixInput input(kSourceCurves);
  const MixHandle mix = generator_mix(input, Generator::kBlink, 4 * kTicksPerSecond, {kTwo, 2},
                                      {kOnes, 2}, BlendMode::kMax);
  OwnMixer own(mix, 5);
  std::vector<Row> rows;  // a millisecond apart
  while (rows.size() < 10000) rows.push_back(own.step(kMillisecond));
  int begins[2] = {};
  for (uint32_t curve : kTwo) {
    const auto first = [&](int from, auto&& is) {
      while (from < 9999 && !is(rows[static_cast<size_t>(from)][curve])) ++from;
      return from;
    };
    const int begin = first(0, [](float v) { return v > 0; });
    const int closed = first(begin, [](float v) { return v == 1; });
    const int opens = first(closed, [](float v) { return v < 1; });
    const int open = first(opens, [](float v) { return v == 0; });
    ASSERT_LT(open, 9999);
    EXPECT_NEAR(closed - begin, 75, 1);
    EXPECT_NEAR(opens - begin, 100, 1);
    EXPECT_NEAR(open - begin, 250, 1);
    EXPECT_NEAR(rows[static_cast<size_t>(begin + 37)][curve], 0.5f, 0.05f);
    begins[curve - kTwo[0]] = begin;
  }
  EXPECT_GE(begins[1], begins[0]);
  EXPECT_LE(begins[1], begins[0] + 10);
}

TEST(Blinks, WaitAfterThoseOfThePerformance) {
  MixInput input(kSourceCurves);
  input.add(BlendMode::kOverride, LayerSource::kPoses).pose_count = 1;
  input.add_pose({2}, {1.0f});
  const MixHandle mix = generator_mix(input, Generator::kBlink, 2 * kTicksPerSecond, {kTwo, 2},
                                      {kOnes, 2}, BlendMode::kMax);
  OwnMixer own(mix);
  for (int i = 0; i < 1000; ++i) {  // closed for 20 ms every 400 ms
    own.pose(0, 0, i % 20 == 0 ? 1.0f : 0.0f);
    ASSERT_EQ(own.step(20 * kMillisecond)[3], 0.0f);
  }
}

TEST(Breath, TakesTwoFifthsInAndRestsAtZero) {
  MixInput input(kSourceCurves);
  const MixHandle mix =
      generator_mix(input, Generator::kBreath, kTicksPerSecond, {kTwo, 2}, {kOnes, 2});
  OwnMixer own(mix);
  EXPECT_NEAR(own.step(200 * kMillisecond)[2], 0.5f, 1e-6f);
  EXPECT_EQ(own.step(200 * kMillisecond)[2], 1.0f);
  EXPECT_NEAR(own.step(300 * kMillisecond)[2], 0.5f, 1e-6f);
  EXPECT_EQ(own.step(300 * kMillisecond)[2], 0.0f);
}

TEST(Noise, IsSmoothBoundedAndDiffersByCurveAndSeed) {
  MixInput input(kSourceCurves);
  const MixHandle mix =
      generator_mix(input, Generator::kNoise, kTicksPerSecond / 5, {kTwo, 2}, {kOnes, 2});
  OwnMixer own(mix, 1), other(mix, 2);
  Row before = own.step(kMillisecond), sum(2);
  int curves = 0, seeds = 0;
  for (int ms = 2; ms < 20000; ++ms) {
    const Row row = own.step(kMillisecond), otherwise = other.step(kMillisecond);
    ASSERT_LE(std::fabs(row[2]), 1.0f);
    ASSERT_LE(std::fabs(row[2] - before[2]), 2 * 1.875f / 200 + 1e-6f);
    sum[0] += row[2] / 20000;
    curves += row[2] != row[3];
    seeds += row[2] != otherwise[2];
    before = row;
  }
  EXPECT_LT(std::fabs(sum[0]), 0.2f);
  EXPECT_GT(curves, 19000);
  EXPECT_GT(seeds, 19000);
}

TEST(Generators, DoNotDependOnHowTimeIsDivided) {
  for (Generator kind : {Generator::kBlink, Generator::kBreath, Generator::kNoise}) {
    MixInput input(kSourceCurves);
    const MixHandle mix =
        generator_mix(input, kind, kTicksPerSecond, {kTwo, 2}, {kOnes, 2}, BlendMode::kAdd);
    OwnMixer fine(mix, 3), coarse(mix, 3), rare(mix, 3);
    int moving = 0;
    for (int i = 1; i <= 3600; ++i) {
      const Row row = coarse.step(kTicksPerSecond / 60);
      for (int k = 0; k < 3; ++k) fine.step(kTicksPerSecond / 240);
      ASSERT_TRUE(same_bits(fine.step(kTicksPerSecond / 240), row)) << i;
      moving += row[2] != 0;
      if (i % 97 == 0) {
        ASSERT_TRUE(same_bits(rare.step(97 * (kTicksPerSecond / 60)), row)) << i;
      }
    }
    EXPECT_GT(moving, 500);
  }
}

TEST(Generators, RefuseWhatIsOutOfRange) {
  const auto created = [](auto&& change) {
    MixInput input(kSourceCurves);
    LayerDesc& layer = input.add(BlendMode::kAdd, LayerSource::kGenerator, LayerGroup::kLife);
    layer.curves = {kTwo, 2};
    layer.amounts = {kOnes, 2};
    layer.period = 1;
    change(layer);
    Mix* mix = nullptr;
    Error error;
    const Status status = create_mix(input.finish(), default_allocator(), mix, error);
    release(mix);
    return status;
  };
  static const uint16_t beyond[2] = {2, kSourceCurves};
  EXPECT_EQ(created([](LayerDesc&) {}), Status::kOk);
  EXPECT_EQ(created([](LayerDesc& l) { l.period = 0; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](LayerDesc& l) { l.amounts.count = 1; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](LayerDesc& l) { l.curves = {beyond, 2}; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](LayerDesc& l) { l.generator = static_cast<Generator>(3); }),
            Status::kInvalidArgument);
  EXPECT_EQ(created([](LayerDesc& l) {
              l.source = LayerSource::kStream;
              l.stream_frames = 1;
            }),
            Status::kInvalidArgument);
}

}  // namespace
}  // namespace mien
