// SPDX-License-Identifier: MIT
// Continuity: fades, crossfades, inertial transitions, at steps of a millisecond.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/support/mix_setup.h"

namespace mien {
namespace {

constexpr uint32_t kTransitionCurves = 16;
constexpr int64_t kTransitionStep = kMillisecond;
constexpr float kDt = 0.001f;

struct TwoClips {
  std::deque<BoundClip> clips;
  MixHandle mix;

  explicit TwoClips(uint32_t clip_count = 2, uint32_t players = 2) {
    for (uint32_t i = 0; i < clip_count; ++i) {
      ClipInput input(smooth_curves(40 + i, kTransitionCurves, 600));
      input.wraps = true;
      clips.emplace_back(std::move(input), kTransitionCurves);
    }
    MixInput input(kTransitionCurves);
    input.add(BlendMode::kOverride);
    input.desc.player_count = players;
    mix = make_mix(input);
  }
};

/// A mixer, its rows at steps of a millisecond, and how fast they change.
struct Playing {
  OwnMixer own;
  Row row, before;

  Playing(const TwoClips& setup, uint32_t clip, int64_t start = 0) : own(setup.mix) {
    PlayDesc play;
    play.start_tick = start;
    own.play(0, setup.clips[clip], Transition::kCut, 0, play);
  }
  void step() {
    before = row;
    row = own.step(kTransitionStep);
  }
  float change(uint32_t curve) const { return row[curve] - before[curve]; }
};

TEST(WeightFade, IsTheQuinticAndEndsExactly) {
  const TwoClips setup;
  Playing faded(setup, 0), source(setup, 0);
  faded.own.weight(0, 0.0f);
  for (int i = 0; i < 5; ++i) {
    faded.step();
    source.step();
  }
  constexpr int kSteps = 200;
  const float seconds = kSteps * kDt;
  faded.own.weight(0, 1.0f, kSteps * kTransitionStep);
  for (int i = 1; i <= kSteps + 20; ++i) {
    faded.step();
    source.step();
    const double u = std::min(1.0, i / double{kSteps});
    const double s = u * u * u * (10 + u * (6 * u - 15));
    for (uint32_t l = 0; l < kTransitionCurves; ++l) {
      ASSERT_NEAR(faded.row[l], s * source.row[l], 1e-6);
      const float own = std::fabs(source.change(l));
      const float most = 1.875f * std::max(source.row[l], source.before[l]) / seconds * kDt;
      const bool at_end = i == 1 || i == kSteps;
      ASSERT_LE(std::fabs(faded.change(l)), own + (at_end ? 0.01f : 1.0f) * most + 1e-6f);
      if (i >= kSteps) {
        ASSERT_EQ(bits_of(faded.row[l]), bits_of(source.row[l]));
      }
    }
  }
}

TEST(Crossfade, KeepsTheSpeedOfItsSourcesAtBothEnds) {
  const TwoClips setup;
  Playing crossed(setup, 0), from(setup, 0);
  for (int i = 0; i < 100; ++i) {
    crossed.step();
    from.step();
  }
  constexpr int kSteps = 250;
  crossed.own.play(0, setup.clips[1], Transition::kCrossfade, kSteps * kTransitionStep);
  Playing to(setup, 1);
  to.row = to.own.step(0);
  for (int i = 1; i <= kSteps + 50; ++i) {
    crossed.step();
    from.step();
    to.step();
    for (uint32_t l = 0; l < kTransitionCurves; ++l) {
      const float apart =
          std::max(std::fabs(from.row[l] - to.row[l]), std::fabs(from.before[l] - to.before[l]));
      const float own = std::max(std::fabs(from.change(l)), std::fabs(to.change(l)));
      const float most = 1.875f * apart / (kSteps * kDt) * kDt;
      const bool at_end = i == 1 || i == kSteps;
      ASSERT_LE(std::fabs(crossed.change(l)), own + (at_end ? 0.01f : 1.0f) * most + 1e-6f)
          << i << ", curve " << l;
      if (i >= kSteps) {
        ASSERT_EQ(bits_of(crossed.row[l]), bits_of(to.row[l]));
      }
    }
  }
}

TEST(Inertial, CarriesValueAndSpeedAndEndsExactly) {
  const TwoClips setup;
  for (int start : {30, 333, 1200}) {
    Playing run(setup, 0);
    for (int i = 0; i < start; ++i) run.step();
    const Row last = run.row;
    Row velocity(kTransitionCurves);
    for (uint32_t l = 0; l < kTransitionCurves; ++l) velocity[l] = run.change(l) / kDt;
    constexpr int kSteps = 200;
    const float seconds = kSteps * kDt;
    run.own.play(0, setup.clips[1], Transition::kInertial, kSteps * kTransitionStep);
    Playing to(setup, 1);
    to.row = to.own.step(0);
    const Row first = to.row;
    for (int i = 1; i <= kSteps + 10; ++i) {
      run.step();
      to.step();
      for (uint32_t l = 0; l < kTransitionCurves; ++l) {
        const float d = last[l] - first[l], v = velocity[l];
        const float offset = run.row[l] - to.row[l];
        if (i == 1) {
          // The layer's own speed and the new source's movement, and nothing else.
          ASSERT_LE(std::fabs(run.change(l) - to.change(l)), std::fabs(v) * kDt + 1e-6f);
          const float t = d * v < 0 ? std::min(seconds, 5 * std::fabs(d / v)) : seconds;
          const float bound = (10 * std::fabs(d) / (t * t) + 4 * std::fabs(v) / t) * kDt * kDt;
          ASSERT_LE(std::fabs(run.change(l) - to.change(l) - v * kDt), bound + 1e-6f);
        }
        if (d != 0) {
          ASSERT_GE(offset * d, -2e-7f * std::fabs(d)) << i;
        }
        if (i >= kSteps) {
          ASSERT_EQ(bits_of(run.row[l]), bits_of(to.row[l]));
        }
      }
    }
  }
}

TEST(Inertial, OffsetsNeverChangeTheirSign) {
  Random random = Random::from_seed(50, 0);
  for (int round = 0; round < 20000; ++round) {
    const auto d = static_cast<float>(random.between(-1, 1) * (random.chance(0.2) ? 1e-4 : 1));
    const auto p = static_cast<float>(random.between(-20, 20));
    const Quintic quintic = quintic_from(d, p);
    EXPECT_EQ(quintic_at(quintic, 0.0f), d);
    for (int i = 0; i < 100; ++i) ASSERT_GE(quintic_at(quintic, i * 0.01f) * d, 0.0f) << d << p;
    EXPECT_EQ(quintic_at(quintic, 1.0f), 0.0f);
    EXPECT_EQ(quintic_slope(quintic, 1.0f), 0.0f);
    const float shortened = d * p < 0 && std::fabs(p) > 5 * std::fabs(d) ? 2e-2f : 0.0f;
    EXPECT_NEAR(quintic_slope(quintic, 0.0f), p, 1e-4f + shortened * std::fabs(p));
  }
}

TEST(Inertial, SlopeIsTheDerivative) {
  Random random = Random::from_seed(51, 0);
  for (int round = 0; round < 2000; ++round) {
    const Quintic quintic = quintic_from(static_cast<float>(random.between(-1, 1)),
                                         static_cast<float>(random.between(-4, 4)));
    const auto u = static_cast<float>(random.between(0.05, 0.6));
    const float step = 1e-3f;
    const float slope =
        (quintic_at(quintic, u + step) - quintic_at(quintic, u - step)) / (2 * step);
    // Compared where the quintic has not ended.
    if ((u + step) * quintic.rate < 1) {
      ASSERT_NEAR(quintic_slope(quintic, u), slope, 2e-2f * quintic.rate * quintic.rate);
    }
  }
}

TEST(Transitions, WithoutEndsOfOtherOnesAreContinuous) {
  for (uint32_t players : {1u, 2u, 3u}) {
    const TwoClips setup(3, players);
    Random random = Random::from_seed(52, players);
    Playing run(setup, 0);
    int triggers = 0, until = 100, compared = 0;
    Row velocity(kTransitionCurves), first;
    std::optional<Playing> to;  // the clip of an inertial transition that has just begun
    Row last;
    for (int i = 0; triggers < 100 && i < 60000; ++i) {
      run.step();
      if (i == 0) run.before = run.row;
      for (uint32_t l = 0; l < kTransitionCurves; ++l) {
        // No source is faster than 16 * 0.0963 / (40 / 60 s) * 1.1; a transition of 200 ms adds less
        // than 1.875 / 0.2 s, and what it carries over was within this bound itself.
        const float changed = run.change(l) / kDt, limit = 2.6f + 2 * 1.875f / 0.2f;
        ASSERT_LE(std::fabs(changed), limit) << i << ", curve " << l;
      }
      if (to) to->step();
      for (uint32_t l = 0; to && l < kTransitionCurves; ++l) {
        // As of an undisturbed one: the speed that there was, and what the new clip moves.
        const float d = last[l] - first[l], v = velocity[l], seconds = 0.2f;
        if (d * v < 0 && 5 * std::fabs(d) < seconds * std::fabs(v)) continue;  // it lasts shorter
        ++compared;
        const float bound = 10 * std::fabs(d) / (seconds * seconds) + 4 * std::fabs(v) / seconds;
        ASSERT_LE(std::fabs(run.change(l) - to->change(l) - v * kDt), bound * kDt * kDt + 2e-6f)
            << i << ", curve " << l;
      }
      to.reset();
      for (uint32_t l = 0; l < kTransitionCurves; ++l) velocity[l] = run.change(l) / kDt;
      if (--until > 0) continue;
      until = static_cast<int>(5 + random.below(250));
      ++triggers;
      PlayDesc play;
      play.start_tick = random.below(9000) * kMillisecond;
      const auto transition = random.chance(0.5) ? Transition::kCrossfade : Transition::kInertial;
      const uint32_t clip = random.below(3);
      last = run.row;
      run.own.play(0, setup.clips[clip], transition, 200 * kMillisecond, play);
      if (transition == Transition::kInertial) {
        to.emplace(setup, clip, play.start_tick);
        first = to->row = to->own.step(0);
      }
      const Row now = run.own.step(0);
      for (uint32_t l = 0; l < kTransitionCurves; ++l) ASSERT_NEAR(now[l], last[l], 1e-6f);
    }
    EXPECT_EQ(triggers, 100);
    EXPECT_GT(compared, 300);
  }
}

TEST(WeightFade, RetriggeredKeepsValueAndSpeed) {
  Random random = Random::from_seed(53, 0);
  Fade fade;
  set_fade(fade, 0.5f);
  int64_t now = 0;
  for (int i = 0; i < 1000; ++i) {
    const float value = fade_value(fade, now), velocity = fade_velocity(fade, now);
    const auto target = static_cast<float>(random.real());
    start_fade(fade, now, target, (50 + random.below(500)) * kMillisecond);
    ASSERT_NEAR(fade_value(fade, now), value, 1e-6f);
    const float d = value - target;
    const float p = velocity * static_cast<float>(fade.ticks);
    if (!(d * p < 0 && std::fabs(p) > 5 * std::fabs(d))) {
      ASSERT_NEAR(fade_velocity(fade, now) * kMillisecond, velocity * kMillisecond, 1e-6f);
    }
    now += random.below(600) * kMillisecond;
  }
  EXPECT_EQ(fade_value(fade, now + kTicksPerSecond), fade.target);
}

TEST(WeightFade, DoesNotDependOnHowTimeIsDivided) {
  const TwoClips setup;
  Playing coarse(setup, 0), fine(setup, 0);
  for (Playing* run : {&coarse, &fine}) {
    run->own.weight(0, 0.0f);
    run->own.weight(0, 1.0f, kTicksPerSecond / 3);
    run->own.play(0, setup.clips[1], Transition::kCrossfade, kTicksPerSecond / 4);
  }
  for (int i = 0; i < 60; ++i) {
    const Row row = coarse.own.step(4 * kTransitionStep);
    for (int k = 0; k < 3; ++k) fine.own.step(kTransitionStep);
    ASSERT_TRUE(same_bits(fine.own.step(kTransitionStep), row));
  }
}

TEST(Loops, WithWrappingAddNoStep) {
  const TwoClips setup;
  const Curves curves = decoded(setup.clips[0].made.clip);
  Playing run(setup, 0, 9900 * kMillisecond);
  run.row = run.own.step(0);
  for (int i = 0; i < 200; ++i) {
    run.step();
    for (uint32_t l = 0; l < kTransitionCurves; ++l) {
      float largest = 0;
      for (uint32_t f : {593u, 594u, 595u, 596u, 597u, 598u, 599u, 0u, 1u, 2u, 3u, 4u, 5u, 6u}) {
        largest = std::max(largest, std::fabs(curves.at((f + 1) % 600, l) - curves.at(f, l)));
      }
      ASSERT_LE(std::fabs(run.change(l)), largest * 0.06f + 1e-6f);
    }
  }
}

TEST(Crossfade, BetweenClipsOfDifferentControlsFadesEachOfThem) {
  Curves full(4, 10), other(2, 10), base(4, 10);
  std::fill(base.values.begin(), base.values.end(), 0.25f);
  std::fill(full.values.begin(), full.values.end(), 1.0f);
  std::fill(other.values.begin(), other.values.end(), 0.5f);
  const BoundClip below(ClipInput(base), 4), first(ClipInput(full), 4);
  const BoundClip second(ClipInput(other), 4, {1, 2});
  for (Transition transition : {Transition::kCrossfade, Transition::kInertial}) {
    MixInput input(4);
    input.add(BlendMode::kOverride);
    input.add(BlendMode::kOverride);
    const MixHandle mix = make_mix(input);
    OwnMixer own(mix);
    own.play(0, below);
    own.play(1, first);
    EXPECT_TRUE(same_bits(own.step(kTransitionStep), Row(4, 1.0f)));
    own.play(1, second, transition, 100 * kMillisecond);
    const Row half = own.step(50 * kMillisecond);
    EXPECT_NEAR(half[0], 0.625f, 1e-6f);
    EXPECT_NEAR(half[1], 0.75f, 1e-6f);
    EXPECT_TRUE(same_bits(own.step(50 * kMillisecond), {0.25f, 0.5f, 0.5f, 0.25f}));
  }
}

TEST(Play, OnAnEmptyLayerFadesInAndStopFadesOut) {
  Curves ones(2, 10);
  std::fill(ones.values.begin(), ones.values.end(), 1.0f);
  const BoundClip clip(ClipInput(ones), 2);
  MixInput input(2);
  input.add(BlendMode::kOverride);
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  own.play(0, clip, Transition::kInertial, 100 * kMillisecond);
  EXPECT_NEAR(own.step(50 * kMillisecond)[0], 0.5f, 1e-6f);
  EXPECT_EQ(own.step(50 * kMillisecond)[0], 1.0f);
  Error error;
  ASSERT_EQ(stop_layer(own.mixer, 0, 100 * kMillisecond, error), Status::kOk);
  EXPECT_NEAR(own.step(50 * kMillisecond)[0], 0.5f, 1e-6f);
  EXPECT_EQ(own.step(50 * kMillisecond)[0], 0.0f);
  EXPECT_EQ(own.mixer.layers[0].current, kNoPlayer);
  // Stopped on the way, it comes back from where it is.
  own.play(0, clip, Transition::kCut);
  EXPECT_EQ(own.step(kMillisecond)[0], 1.0f);
  ASSERT_EQ(stop_layer(own.mixer, 0, 100 * kMillisecond, error), Status::kOk);
  const float there = own.step(50 * kMillisecond)[0];
  own.play(0, clip, Transition::kInertial, 100 * kMillisecond);
  EXPECT_NEAR(own.step(0)[0], there, 1e-6f);
  EXPECT_EQ(own.step(200 * kMillisecond)[0], 1.0f);
}

}  // namespace
}  // namespace mien
