// SPDX-License-Identifier: MIT
// Playing: any order of frames, interpolation, loops, speeds; and events, once for each passing.
#include "runtime/anim/clip_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "author/base/random.h"
#include "tests/support/made_clip.h"

namespace mien {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr Interpolation kInterpolations[] = {Interpolation::kStep, Interpolation::kLinear,
                                             Interpolation::kCatmullRom};

std::vector<float> copy(Span<const float> values) { return {values.begin(), values.end()}; }

void expect_frame(Span<const float> values, const Curves& curves, uint32_t frame) {
  ASSERT_EQ(values.count, curves.channels);
  ASSERT_EQ(memcmp(values.data, &curves.values[size_t{frame} * curves.channels],
                   values.count * sizeof(float)),
            0)
      << "frame " << frame;
}

/// Every odd frame is the mean of its neighbors.
Curves half_rate_curves(uint32_t frames) {
  Curves curves = rounded_to(phone_capture(5, frames), 1024);
  for (uint32_t f = 1; f + 1 < frames; f += 2) {
    for (uint32_t c = 0; c < curves.channels; ++c) {
      curves.at(f, c) = 0.5f * curves.at(f - 1, c) + 0.5f * curves.at(f + 1, c);
    }
  }
  return curves;
}

// Instruction sets -----------------------------------------------------------------------------------

TEST(ClipSampler, GivesTheSameBitsOnEveryInstructionSet) {
  // Grids, floats and constants side by side in a group of lanes, zeros, and a last group in part.
  Curves curves = phone_capture(6, 150);
  for (uint32_t f = 0; f < curves.frames; ++f) {
    for (uint32_t c = 0; c < curves.channels; c += 3) {
      curves.at(f, c) = static_cast<float>(static_cast<int>(curves.at(f, c) * 1024)) / 1024;
    }
    curves.at(f, 1) = f < 64 ? -0.25f : f < 128 ? 0.0f : 0.5f;
    curves.at(f, 4) = -1e30f * curves.at(f, 4);
  }
  const MadeClip made{ClipInput(curves)};
  ASSERT_NE(made.clip.changing_count % kClipLanes, 0u);
  for (uint32_t isa = 1; isa < kIsaCount; ++isa) {
    const KernelTable* const kernels = kernels_for(static_cast<Isa>(isa));
    if (!kernels) continue;
    OwnSampler own(
        SamplerLimits{made.clip.channel_count, made.clip.changing_count, false, kernels});
    Error error;
    ASSERT_EQ(start_clip(own.sampler, made.clip, {}, error), Status::kOk);
    for (uint32_t f = 0; f < curves.frames; ++f) expect_frame(own.at_frame(f), curves, f);
  }
}

// Order of frames ------------------------------------------------------------------------------------

class AnyOrder : public testing::TestWithParam<int> {
 protected:
  Curves curves() const {
    switch (GetParam()) {
      case 0: return authored_keys(1, 300);
      case 1: return phone_capture(1, 257);
      case 2: return noisy_solve(1, 64);
      case 3: return half_rate_curves(281);
      default: return one_channel({0.25f});
    }
  }
};

TEST_P(AnyOrder, ForwardBackwardAndAtRandomGivesTheBitsOfTheFrames) {
  const Curves expected = curves();
  const MadeClip made((ClipInput(expected)));
  const int64_t frame = made.clip.ticks_per_frame;
  for (const bool reverse : {false, true}) {
    for (Interpolation interpolation : kInterpolations) {
      PlayDesc desc;
      desc.interpolation = interpolation;
      OwnSampler own(made.clip, desc, reverse);
      for (uint32_t f = 0; f < expected.frames; ++f) {
        expect_frame(sample_clip(own.sampler), expected, f);
        advance_clip(own.sampler, frame);
      }
      for (uint32_t f = expected.frames; f-- > 0;) {
        expect_frame(sample_clip(own.sampler), expected, f);
        advance_clip(own.sampler, -frame);
      }
    }
    OwnSampler own(made.clip, {}, reverse);
    Random random = Random::from_seed(1, 2);
    for (int i = 0; i < 10000; ++i) {
      const uint32_t f = random.below(expected.frames);
      expect_frame(own.at_frame(f), expected, f);
      if (random.chance(0.3)) advance_clip(own.sampler, random.chance(0.5) ? frame : -frame);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, AnyOrder, testing::Range(0, 5));

TEST(ClipSampler, PlaysOneClipAfterAnother) {
  const MadeClip large((ClipInput(authored_keys(1, 100)))),
      small((ClipInput(phone_capture(1, 70))));
  OwnSampler own(SamplerLimits{300, 300, true});
  Error error;
  for (const MadeClip* made : {&large, &small, &large}) {
    const Curves expected = decoded(made->clip);
    ASSERT_EQ(start_clip(own.sampler, made->clip, {}, error), Status::kOk);
    for (uint32_t f : {3u, 4u, 69u, 2u, 1u, 65u}) expect_frame(own.at_frame(f), expected, f);
  }
}

TEST(ClipSampler, RefusesClipsThatAreTooLargeAndGoesOn) {
  const MadeClip small((ClipInput(phone_capture(1, 70)))),
      large((ClipInput(authored_keys(1, 100))));
  OwnSampler own(small.clip);
  advance_clip(own.sampler, 12345678);
  const std::vector<float> before = copy(sample_clip(own.sampler));
  Error error;
  EXPECT_EQ(start_clip(own.sampler, large.clip, {}, error), Status::kClipLimit);
  EXPECT_NE(std::string(error.message).find("251"), std::string::npos) << error.message;
  EXPECT_EQ(copy(sample_clip(own.sampler)), before);
  EXPECT_EQ(own.sampler.tick, 12345678);
}

TEST(ClipSampler, RefusesSpeedsOutOfRange) {
  const MadeClip made((ClipInput(phone_capture(1, 70))));
  OwnSampler own(made.clip);
  Error error;
  for (const auto& [numerator, denominator] :
       {std::pair{1, 0}, {1, -1}, {kMaxSpeed + 1, 1}, {-kMaxSpeed - 1, 1}, {1, kMaxSpeed + 1}}) {
    PlayDesc desc;
    desc.speed_numerator = numerator;
    desc.speed_denominator = denominator;
    EXPECT_EQ(start_clip(own.sampler, made.clip, desc, error), Status::kInvalidArgument);
    EXPECT_EQ(set_clip_speed(own.sampler, numerator, denominator, error), Status::kInvalidArgument);
  }
  EXPECT_EQ(own.sampler.speed_numerator, 1);
}

// Interpolation --------------------------------------------------------------------------------------

TEST(ClipInterpolation, LinearGoesStraight) {
  const MadeClip made((ClipInput(one_channel({0.25f, 0.75f, -1}))));
  OwnSampler own(made.clip);
  const int64_t frame = made.clip.ticks_per_frame;
  EXPECT_EQ(own.at_tick(frame / 4)[0], 0.375f);
  EXPECT_EQ(own.at_tick(frame / 2)[0], 0.5f);
  EXPECT_EQ(own.at_tick(frame + frame / 2)[0], -0.125f);
}

TEST(ClipInterpolation, StepHoldsUntilTheNextFrame) {
  const MadeClip made((ClipInput(one_channel({0.25f, 0.75f}))));
  PlayDesc desc;
  desc.interpolation = Interpolation::kStep;
  OwnSampler own(made.clip, desc);
  EXPECT_EQ(own.at_tick(made.clip.ticks_per_frame - 1)[0], 0.25f);
  EXPECT_EQ(own.at_tick(made.clip.ticks_per_frame)[0], 0.75f);
}

TEST(ClipInterpolation, CatmullRomFollowsItsFormulaWithinItsLimits) {
  const Curves curves = phone_capture(3, 150);
  const MadeClip made((ClipInput(curves)));
  PlayDesc desc;
  desc.interpolation = Interpolation::kCatmullRom;
  OwnSampler own(made.clip, desc);
  Random random = Random::from_seed(3, 3);
  int clamped = 0;
  for (int i = 0; i < 500; ++i) {
    const auto frame = static_cast<int64_t>(random.below(149));
    const int64_t past = random.below(static_cast<uint32_t>(made.clip.ticks_per_frame));
    const Span<const float> values = own.at_tick(frame * made.clip.ticks_per_frame + past);
    const double t = double(past) / double(made.clip.ticks_per_frame);
    for (uint32_t k = 0; k < curves.channels; ++k) {
      const auto at = [&](int64_t f) {
        return double{curves.at(static_cast<uint32_t>(f < 0 ? 0 : f > 149 ? 149 : f), k)};
      };
      const double a = at(frame - 1), b = at(frame), c = at(frame + 1), d = at(frame + 2);
      const double curve = 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t +
                                  (3 * b - 3 * c + d - a) * t * t * t);
      const double limited = std::min(std::max(curve, std::min(b, c)), std::max(b, c));
      clamped += limited != curve;
      ASSERT_NEAR(values[k], limited, 1e-6);
      ASSERT_GE(values[k], static_cast<float>(std::min(b, c)));
      ASSERT_LE(values[k], static_cast<float>(std::max(b, c)));
    }
  }
  EXPECT_GT(clamped, 100);
}

TEST(ClipInterpolation, StaysBetweenItsFramesAndFinite) {
  const MadeClip made((ClipInput(one_channel(
      {kLargest, -kLargest, -kLargest, kLargest, 0, kLargest, 1, 1, -0.1f, 1e-45f, 0, 0}))));
  const Curves curves = decoded(made.clip);
  for (Interpolation interpolation : kInterpolations) {
    PlayDesc desc;
    desc.interpolation = interpolation;
    desc.looping = Looping::kLoop;
    OwnSampler own(made.clip, desc);
    for (int64_t i = 0; i < 12 * 16; ++i) {
      const float value = own.at_tick(made.clip.ticks_per_frame / 16 * i)[0];
      const float a = curves.at(static_cast<uint32_t>(i / 16), 0);
      const float b = curves.at(static_cast<uint32_t>(i / 16 + 1) % 12, 0);
      ASSERT_GE(value, std::min(a, b)) << i;
      ASSERT_LE(value, std::max(a, b)) << i;
    }
  }
}

TEST(ClipInterpolation, ZeroStaysZero) {
  const MadeClip made((ClipInput(one_channel({0, 0, 1, 0, 0, 0, 0}))));
  for (Interpolation interpolation : kInterpolations) {
    PlayDesc desc;
    desc.interpolation = interpolation;
    OwnSampler own(made.clip, desc);
    for (double at : {0.3, 3.5, 4.1, 5.7}) {
      const auto tick = static_cast<int64_t>(at * double(made.clip.ticks_per_frame));
      EXPECT_EQ(bits_of(own.at_tick(tick)[0]), 0u) << at;
    }
  }
}

// A half-rate clip plays exactly like the same curves stored at the full rate.
TEST(ClipInterpolation, OfHalfRateClipsIsThatOfWholeOnes) {
  const Curves curves = half_rate_curves(141);
  Curves more(curves.channels + 1, curves.frames);
  for (uint32_t f = 0; f < curves.frames; ++f) {
    for (uint32_t c = 0; c < curves.channels; ++c) more.at(f, c) = curves.at(f, c);
    more.at(f, curves.channels) = f == 7 ? 1.0f : 0.0f;
  }
  const MadeClip half((ClipInput(curves))), whole((ClipInput(more)));
  ASSERT_TRUE(half.clip.has(kClipHalfRate));
  ASSERT_FALSE(whole.clip.has(kClipHalfRate));
  Random random = Random::from_seed(4, 4);
  for (Interpolation interpolation : kInterpolations) {
    for (Looping looping : {Looping::kOnce, Looping::kLoop}) {
      for (const bool reverse : {false, true}) {
        PlayDesc desc;
        desc.interpolation = interpolation;
        desc.looping = looping;
        OwnSampler a(half.clip, desc, reverse), b(whole.clip, desc, !reverse);
        for (int i = 0; i < 1000; ++i) {
          const int64_t ticks = random.below(40000000) - int64_t{i < 500 ? 15000000 : 25000000};
          advance_clip(a.sampler, ticks);
          advance_clip(b.sampler, ticks);
          const Span<const float> x = sample_clip(a.sampler), y = sample_clip(b.sampler);
          ASSERT_EQ(memcmp(x.data, y.data, x.count * sizeof(float)), 0) << i;
        }
      }
    }
  }
}

// Time -----------------------------------------------------------------------------------------------

TEST(ClipTime, OnceStopsAtItsEnds) {
  const MadeClip made((ClipInput(one_channel({0.25f, 0.5f, 0.75f}))));
  OwnSampler own(made.clip);
  const int64_t frame = made.clip.ticks_per_frame;
  advance_clip(own.sampler, 10 * frame);
  EXPECT_EQ(own.sampler.tick, 2 * frame);
  EXPECT_EQ(sample_clip(own.sampler)[0], 0.75f);
  advance_clip(own.sampler, -frame / 2);
  EXPECT_EQ(sample_clip(own.sampler)[0], 0.625f) << "it turns at once";
  advance_clip(own.sampler, -10 * frame);
  EXPECT_EQ(own.sampler.tick, 0);
  EXPECT_EQ(own.sampler.loops, 0);
}

TEST(ClipTime, LoopsMoveFromTheLastFrameToTheFirst) {
  ClipInput input(one_channel({0.25f, 0.5f, 0.75f}));
  input.wraps = true;
  const MadeClip made(input);
  const int64_t frame = made.clip.ticks_per_frame;
  OwnSampler own(made.clip);
  advance_clip(own.sampler, 2 * frame + frame / 2);
  EXPECT_EQ(sample_clip(own.sampler)[0], 0.5f);
  advance_clip(own.sampler, frame / 2);
  EXPECT_EQ(own.sampler.tick, 0);
  EXPECT_EQ(own.sampler.loops, 1);
  advance_clip(own.sampler, -1);
  EXPECT_EQ(own.sampler.tick, 3 * frame - 1);
  EXPECT_EQ(own.sampler.loops, 0);
}

TEST(ClipTime, TheCallerMayOverruleTheClip) {
  ClipInput input(one_channel({0.25f, 0.5f}));
  for (const bool wraps : {false, true}) {
    input.wraps = wraps;
    const MadeClip made(input);
    PlayDesc desc;
    desc.looping = wraps ? Looping::kOnce : Looping::kLoop;
    OwnSampler own(made.clip, desc);
    EXPECT_EQ(own.sampler.length, made.clip.ticks_per_frame * (wraps ? 1 : 2));
  }
}

TEST(ClipTime, AMillionLoopsDoNotDrift) {
  ClipInput input(clean_solve(1, 77));
  input.rate_numerator = 30000;
  input.rate_denominator = 1001;
  input.wraps = true;
  const MadeClip made(input);
  OwnSampler own(made.clip);
  const int64_t length = 77 * made.clip.ticks_per_frame;
  const int64_t step = kMaxStepTicks - 1234567;
  int64_t total = 0;
  for (int i = 0; i < 2000; ++i) {
    advance_clip(own.sampler, step);
    total += step;
  }
  EXPECT_EQ(own.sampler.tick, total % length);
  EXPECT_EQ(own.sampler.loops, total / length);
  EXPECT_GT(own.sampler.loops, 1000000);
}

// A loop of one tick, played as fast as can be: each step has 2^60 of them.
TEST(ClipTime, LoopsAreCountedAsFarAsTheirNumberReaches) {
  ClipInput input(one_channel({0.5f}));
  input.rate_numerator = static_cast<uint32_t>(kTicksPerSecond);
  input.wraps = true;
  const MadeClip made(input);
  ASSERT_EQ(made.clip.length(true), 1);
  for (const int32_t speed : {kMaxSpeed, -kMaxSpeed}) {
    OwnSampler own(made.clip);
    Error error;
    ASSERT_EQ(set_clip_speed(own.sampler, speed, 1, error), Status::kOk);
    for (int i = 1; i < 20; ++i) {
      advance_clip(own.sampler, kMaxStepTicks);
      const int64_t loops = i == 1 ? int64_t{1} << 60 : kMaxLoops;
      EXPECT_EQ(own.sampler.loops, speed > 0 ? loops : -loops) << i;
      EXPECT_EQ(own.sampler.tick, 0);
    }
    for (const int64_t tick : {INT64_MIN, INT64_MAX}) {
      seek_clip(own.sampler, tick);
      EXPECT_EQ(own.sampler.loops, 0);
      advance_clip(own.sampler, -kMaxStepTicks);
    }
  }
}

TEST(ClipTime, ItDoesNotMatterHowTimeIsCutIntoSteps) {
  ClipInput input(phone_capture(1, 100));
  input.wraps = true;
  const MadeClip made(input);
  Random random = Random::from_seed(5, 5);
  for (int i = 0; i < 200; ++i) {
    PlayDesc desc;
    desc.speed_numerator = static_cast<int32_t>(random.below(2001)) - 1000;
    desc.speed_denominator = static_cast<int32_t>(1 + random.below(1000));
    desc.start_tick = random.below(1000000000);
    OwnSampler whole(made.clip, desc), parts(made.clip, desc);
    const int64_t total = random.below(2000000000);
    int64_t left = total;
    while (left > 0) {
      const int64_t part = std::min<int64_t>(left, 1 + random.below(100000000));
      advance_clip(parts.sampler, part);
      if (random.chance(0.3)) sample_clip(parts.sampler);
      left -= part;
    }
    advance_clip(whole.sampler, total);
    ASSERT_EQ(whole.sampler.tick, parts.sampler.tick);
    ASSERT_EQ(whole.sampler.loops, parts.sampler.loops);
    ASSERT_EQ(copy(sample_clip(whole.sampler)), copy(sample_clip(parts.sampler)));

    // And it is the exact time, rounded down.
    const int64_t length = made.clip.length(true), denominator = desc.speed_denominator;
    const int64_t scaled = desc.start_tick % length * denominator + total * desc.speed_numerator;
    const int64_t position = scaled / denominator - (scaled % denominator < 0);
    const int64_t tick = (position % length + length) % length;
    ASSERT_EQ(whole.sampler.tick, tick);
  }
}

/// Instead of sync groups: docs/mixing.md, 10 "Limits of this release".
TEST(ClipTime, LoopsOfDifferentLengthsKeepStepAtTheFractionOfTheirFrames) {
  ClipInput walk(phone_capture(1, 100)), breath(phone_capture(2, 153));
  walk.wraps = breath.wraps = true;
  const MadeClip first(walk), second(breath);
  PlayDesc desc;
  desc.start_tick = first.clip.length(true) / 4;
  OwnSampler leads(first.clip, desc);
  desc.start_tick = second.clip.length(true) / 4;
  desc.speed_numerator = 153;
  desc.speed_denominator = 100;
  OwnSampler follows(second.clip, desc);
  Random random = Random::from_seed(5, 6);
  for (int i = 0; i < 2000; ++i) {
    const int64_t ticks = random.below(2000000000);
    advance_clip(leads.sampler, ticks);
    advance_clip(follows.sampler, ticks);
    ASSERT_EQ(follows.sampler.loops, leads.sampler.loops) << i;
    ASSERT_EQ(follows.sampler.tick, leads.sampler.tick * 153 / 100) << i;
  }
  EXPECT_GT(leads.sampler.loops, 1000);
}

TEST(ClipTime, SpeedMayChangeOnTheWay) {
  const MadeClip made((ClipInput(phone_capture(1, 100))));
  OwnSampler own(made.clip);
  Error error;
  advance_clip(own.sampler, 1001);
  ASSERT_EQ(set_clip_speed(own.sampler, 1, 3, error), Status::kOk);
  advance_clip(own.sampler, 1000);
  EXPECT_EQ(own.sampler.tick, 1001 + 333);
  ASSERT_EQ(set_clip_speed(own.sampler, -2, 1, error), Status::kOk);
  advance_clip(own.sampler, 334);
  EXPECT_EQ(own.sampler.tick, 1001 + 333 - 668);
  ASSERT_EQ(set_clip_speed(own.sampler, 0, 1, error), Status::kOk);
  advance_clip(own.sampler, 1000);
  EXPECT_EQ(own.sampler.tick, 1001 + 333 - 668);
}

TEST(ClipTime, SeekingGoesToAnyTime) {
  ClipInput input(phone_capture(1, 100));
  for (const bool wraps : {false, true}) {
    input.wraps = wraps;
    const MadeClip made(input);
    const int64_t length = made.clip.length(wraps);
    OwnSampler own(made.clip);
    for (int64_t tick :
         {int64_t{0}, int64_t{5}, length, length + 7, int64_t{-3},
          std::numeric_limits<int64_t>::max(), std::numeric_limits<int64_t>::min()}) {
      seek_clip(own.sampler, tick);
      const int64_t within = (tick % length + length) % length;
      EXPECT_EQ(own.sampler.tick, wraps ? within : tick < 0 ? 0 : std::min(tick, length));
      EXPECT_EQ(own.sampler.loops, 0);
      sample_clip(own.sampler);
    }
  }
}

// Events ---------------------------------------------------------------------------------------------

std::vector<ClipEvent> passed(ClipSampler& sampler, int64_t ticks) {
  std::vector<ClipEvent> events;
  EventRange range = advance_clip(sampler, ticks);
  ClipEvent event;
  while (next_event(range, event)) events.push_back(event);
  EXPECT_FALSE(next_event(range, event)) << "the end is the end";
  return events;
}

/// Values of the events that a step passes, as a list to be compared.
std::vector<int> values(ClipSampler& sampler, int64_t ticks) {
  std::vector<int> list;
  for (const ClipEvent& event : passed(sampler, ticks))
    list.push_back(static_cast<int>(event.value));
  return list;
}

using Values = std::vector<int>;

/// Five frames; the events have the values 1, 2 ...
ClipInput with_events(std::initializer_list<int64_t> ticks, bool wraps) {
  ClipInput input(one_channel({0, 1, 0, 1, 0}));
  input.wraps = wraps;
  float value = 1;
  for (int64_t tick : ticks) input.events.push_back({tick, "event", value++});
  return input;
}

TEST(ClipEvents, ArePassedOnArrival) {
  const MadeClip made(with_events({0, 100, 200, 200, 300}, false));
  OwnSampler own(made.clip);
  EXPECT_EQ(values(own.sampler, 0), (Values{1})) << "the one of the start";
  EXPECT_EQ(values(own.sampler, 0), Values{});
  EXPECT_EQ(values(own.sampler, 99), Values{});
  EXPECT_EQ(values(own.sampler, 1), (Values{2}));
  EXPECT_EQ(values(own.sampler, 1), Values{});
  EXPECT_EQ(values(own.sampler, 250), (Values{3, 4, 5}));
  EXPECT_EQ(values(own.sampler, -50), Values{});
  EXPECT_EQ(values(own.sampler, -1), (Values{5})) << "backward";
  EXPECT_EQ(values(own.sampler, -300), (Values{4, 3, 2, 1}));
  EXPECT_EQ(values(own.sampler, -300), Values{}) << "at the beginning it stays";
  EXPECT_EQ(values(own.sampler, 100), (Values{2}));
}

TEST(ClipEvents, OfTurningPointsArePassedOncePerArrival) {
  const MadeClip made(with_events({100}, false));
  OwnSampler own(made.clip);
  EXPECT_EQ(values(own.sampler, 100), (Values{1}));
  EXPECT_EQ(values(own.sampler, -10), Values{}) << "leaving is not arriving";
  EXPECT_EQ(values(own.sampler, 10), (Values{1}));
  EXPECT_EQ(values(own.sampler, 10), Values{});
  EXPECT_EQ(values(own.sampler, -10), (Values{1}));
}

TEST(ClipEvents, OfTheEndArePassedOnce) {
  const int64_t length = 4 * ticks_per_frame(60, 1);
  const MadeClip made(with_events({length}, false));
  OwnSampler own(made.clip);
  EXPECT_EQ(values(own.sampler, length - 1), Values{});
  EXPECT_EQ(values(own.sampler, 1000), (Values{1}));
  EXPECT_EQ(values(own.sampler, 1000), Values{});
}

TEST(ClipEvents, AreNotPassedBySeekingButAtItsTarget) {
  const MadeClip made(with_events({0, 100, 200}, false));
  OwnSampler own(made.clip);
  seek_clip(own.sampler, 150);
  EXPECT_EQ(values(own.sampler, 10), Values{});
  seek_clip(own.sampler, 200);
  EXPECT_EQ(values(own.sampler, -10), (Values{3}));
  seek_clip(own.sampler, 100);
  EXPECT_EQ(values(own.sampler, 10), (Values{2}));
}

TEST(ClipEvents, OfSeveralLoopsAreAllPassedInOrder) {
  const int64_t length = 5 * ticks_per_frame(60, 1);
  const MadeClip made(with_events({0, 100, length - 1}, true));
  OwnSampler own(made.clip);
  EXPECT_EQ(values(own.sampler, 2 * length + 100), (Values{1, 2, 3, 1, 2, 3, 1, 2}));
  EXPECT_EQ(own.sampler.loops, 2);
  EXPECT_EQ(values(own.sampler, -2 * length), (Values{1, 3, 2, 1, 3, 2}));
  EXPECT_EQ(own.sampler.loops, 0);
}

TEST(ClipEvents, OfAStartBackwardBeginWithItsOwnTick) {
  const int64_t length = 5 * ticks_per_frame(60, 1);
  const MadeClip made(with_events({0, 100}, true));
  PlayDesc desc;
  desc.speed_numerator = -1;
  OwnSampler own(made.clip, desc);
  EXPECT_EQ(values(own.sampler, length), (Values{1, 2, 1}));
}

/// How many times a position that was at `from` arrives at `tick` + k * length on the way to `to`.
int64_t arrivals(int64_t tick, int64_t length, int64_t from, int64_t to) {
  const auto floor_div = [](int64_t a, int64_t b) { return a / b - (a % b < 0); };
  if (to >= from) return floor_div(to - tick, length) - floor_div(from - tick, length);
  return floor_div(from - 1 - tick, length) - floor_div(to - 1 - tick, length);
}

/// The order of the way: each event of the clip at each time of a loop, in the clip's order.
std::vector<int> on_the_way(const Clip& clip, int64_t length, int64_t from, int64_t to) {
  std::vector<int> all;
  const int64_t first_loop = std::min(from, to) / length - 2,
                last_loop = std::max(from, to) / length;
  for (int64_t loop = first_loop; loop <= last_loop + 1; ++loop) {
    for (uint32_t e = 0; e < clip.event_count; ++e) {
      const int64_t tick = clip.event(e).tick + loop * length;
      const bool passes = to >= from ? tick > from && tick <= to : tick < from && tick >= to;
      if (passes) all.push_back(static_cast<int>(clip.event(e).value));
    }
  }
  if (to < from) std::reverse(all.begin(), all.end());
  return all;
}

TEST(ClipEvents, AreAsManyAsThereAreArrivalsInTheirOrder) {
  Random random = Random::from_seed(6, 6);
  const int64_t length = 5 * ticks_per_frame(60, 1);
  const auto below_length = [&] { return int64_t{random.below(static_cast<uint32_t>(length))}; };
  size_t total = 0;
  for (int sequence = 0; sequence < 1000; ++sequence) {
    ClipInput input(one_channel({0, 1, 0, 1, 0}));
    input.wraps = true;
    for (uint32_t i = random.below(6); i > 0; --i) {
      // Some together, some at the ends.
      const int64_t ticks[] = {0, length - 1, 1000, below_length()};
      input.events.push_back({ticks[random.below(4)], "event", static_cast<float>(i)});
    }
    const MadeClip made(input);
    PlayDesc desc;
    desc.speed_numerator = static_cast<int32_t>(random.below(7)) - 3;
    desc.speed_denominator = static_cast<int32_t>(1 + random.below(3));
    desc.start_tick = random.chance(0.2) ? 1000 : below_length();
    OwnSampler own(made.clip, desc);
    int64_t position = desc.start_tick;
    for (int step = 0; step < 40; ++step) {
      const int64_t ticks = below_length() * (random.chance(0.1) ? 7 : 1) - below_length() / 2;
      const std::vector<int> got = values(own.sampler, random.chance(0.1) ? 0 : ticks);
      const int64_t to = own.sampler.tick + own.sampler.loops * length;
      // The first step also passes the tick that it leaves.
      const int64_t from = step > 0 ? position : to < position ? position + 1 : position - 1;
      int64_t expected = 0;
      for (const ClipInput::Event& event : input.events) {
        expected += arrivals(event.tick, length, from, to);
      }
      ASSERT_EQ(static_cast<int64_t>(got.size()), expected);
      ASSERT_EQ(got, on_the_way(made.clip, length, from, to));
      total += got.size();
      position = to;
    }
  }
  EXPECT_GT(total, 10000u);
}

}  // namespace
}  // namespace mien
