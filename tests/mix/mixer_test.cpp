// SPDX-License-Identifier: MIT
// Layers: modes, masks, weights; what they leave alone; what is refused.
#include "runtime/mix/mixer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/counting_allocator.h"
#include "tests/support/mix_setup.h"

namespace mien {
namespace {

constexpr uint32_t kCurves = 37;  // not a multiple of anything
constexpr int64_t kStep = kTicksPerSecond / 60;
constexpr BlendMode kModes[] = {BlendMode::kOverride, BlendMode::kAdd, BlendMode::kScreen,
                                BlendMode::kMax, BlendMode::kScale};

ClipInput random_input(uint64_t seed, uint32_t frames = 100, float low = -1, float high = 2) {
  Random random = Random::from_seed(seed, 1);
  Curves curves(kCurves, frames);
  for (float& value : curves.values) {
    value = random.chance(0.1) ? (random.chance(0.5) ? 0.0f : -0.0f)
                               : static_cast<float>(random.between(low, high));
  }
  return ClipInput(curves);
}

/// A base layer that overrides, and one of each mode.
MixInput two_layers(BlendMode mode, Row mask = {}) {
  MixInput input(kCurves);
  input.add(BlendMode::kOverride);
  input.add(mode, LayerSource::kClip, LayerGroup::kEmotion);
  if (!mask.empty()) input.layers[1].mask = input.keep(std::move(mask));
  return input;
}

// Modes ----------------------------------------------------------------------------------------------

TEST(Layers, WithoutWeightKeepEveryBitInEveryMode) {
  const BoundClip base(random_input(1), kCurves), other(random_input(2), kCurves);
  for (BlendMode mode : kModes) {
    MixInput unmasked = two_layers(mode), masked = two_layers(mode, Row(kCurves, 0.0f));
    MixInput single(kCurves);
    single.add(BlendMode::kOverride);
    const MixHandle mixes[] = {make_mix(single), make_mix(unmasked), make_mix(masked)};
    OwnMixer expected(mixes[0]), weightless(mixes[1]), maskless(mixes[2]);
    for (OwnMixer* own : {&expected, &weightless, &maskless}) own->play(0, base);
    weightless.play(1, other);
    weightless.weight(1, 0.0f);
    maskless.play(1, other);
    for (int i = 0; i < 100; ++i) {
      const Row row = expected.step(kStep);
      ASSERT_TRUE(same_bits(weightless.step(kStep), row));
      ASSERT_TRUE(same_bits(maskless.step(kStep), row));
    }
  }
}

TEST(Layers, AnEmptyMixGivesZerosAndVariables) {
  MixInput input(3, 2);
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  Error error;
  ASSERT_EQ(set_variable(own.mixer, 1, -2.5f, error), Status::kOk);
  EXPECT_TRUE(same_bits(own.step(kStep), {0, 0, 0, 0, -2.5f}));
}

TEST(Layers, OverrideWithFullWeightGivesTheBitsOfTheSource) {
  const BoundClip below(random_input(3), kCurves), source(random_input(4), kCurves);
  MixInput input = two_layers(BlendMode::kOverride, Row(kCurves, 1.0f));
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  own.play(0, below);
  own.play(1, source);
  OwnSampler sampler(source.made.clip);
  for (int i = 0; i < 100; ++i) {
    const Span<const float> expected = sampler.at_tick((i + 1) * kStep);
    ASSERT_TRUE(same_bits(own.step(kStep), Row(expected.begin(), expected.end())));
  }
}

TEST(Layers, DeltaOnItsReferenceGivesTheOriginal) {
  ClipInput reference = random_input(5, 100, 0, 0.5f), original = random_input(6, 100, 0, 1);
  ClipInput delta = original;
  delta.is_delta = true;
  for (size_t i = 0; i < delta.curves.values.size(); ++i) {
    delta.curves.values[i] = original.curves.values[i] - reference.curves.values[i];
  }
  const BoundClip base(reference, kCurves), plus(delta, kCurves);
  MixInput input(kCurves);
  input.add(BlendMode::kOverride);
  input.add(BlendMode::kAdd);
  input.add(BlendMode::kAdd);
  const MixHandle mix = make_mix(input);
  OwnMixer added(mix), taken_off(mix);
  for (OwnMixer* own : {&added, &taken_off}) {
    own->play(0, base);
    own->play(1, plus);
  }
  taken_off.play(2, plus);
  taken_off.weight(2, -1.0f);
  for (uint32_t f = 1; f < 100; ++f) {
    const Row with = added.step(kStep), without = taken_off.step(kStep);
    for (uint32_t l = 0; l < kCurves; ++l) {
      ASSERT_NEAR(with[l], original.curves.at(f, l), 1.2e-7);
      ASSERT_NEAR(without[l], reference.curves.at(f, l), 2.4e-7);
    }
  }
}

TEST(Layers, ScreenStaysWithinLimitsAndCommutes) {
  const BoundClip base(random_input(7, 100, 0, 1), kCurves);
  const BoundClip a(random_input(8, 100, 0, 1), kCurves), b(random_input(9, 100, 0, 1), kCurves);
  MixInput input(kCurves);
  input.add(BlendMode::kOverride);
  input.add(BlendMode::kScreen).weight = 0.7f;
  input.add(BlendMode::kScreen).weight = 0.7f;
  const MixHandle mix = make_mix(input);
  OwnMixer first(mix), second(mix);
  first.play(0, base);
  first.play(1, a);
  first.play(2, b);
  second.play(0, base);
  second.play(1, b);
  second.play(2, a);
  for (int i = 0; i < 100; ++i) {
    const Row x = first.step(kStep), y = second.step(kStep);
    for (uint32_t l = 0; l < kCurves; ++l) {
      ASSERT_GE(x[l], 0.0f);
      ASSERT_LE(x[l], 1.0f);
      ASSERT_NEAR(x[l], y[l], 1.2e-7);
    }
  }
}

TEST(Layers, SumsOfDisjointMasksDoNotDependOnTheirOrder) {
  const BoundClip base(random_input(10), kCurves), a(random_input(11), kCurves),
      b(random_input(12), kCurves);
  Row left(kCurves), right(kCurves);
  for (uint32_t l = 0; l < kCurves; ++l) (l % 3 == 0 ? left : right)[l] = 0.5f + l / 100.0f;
  Row results[2];
  for (int order = 0; order < 2; ++order) {
    MixInput input(kCurves);
    input.add(BlendMode::kOverride);
    input.add(BlendMode::kAdd).mask = input.keep(order == 0 ? left : right);
    input.add(BlendMode::kAdd).mask = input.keep(order == 0 ? right : left);
    const MixHandle mix = make_mix(input);
    OwnMixer own(mix);
    own.play(0, base);
    own.play(1 + order, a);
    own.play(2 - order, b);
    for (int i = 0; i < 50; ++i) results[order] = own.step(kStep);
  }
  EXPECT_TRUE(same_bits(results[0], results[1]));
}

TEST(Layers, NeverTouchCurvesThatTheirMaskLeavesOut) {
  const BoundClip base(random_input(13), kCurves);
  std::deque<BoundClip> clips;
  for (int i = 0; i < 3; ++i) clips.emplace_back(random_input(20 + i), kCurves);
  for (BlendMode mode : kModes) {
    Random random = Random::from_seed(14, 0);
    Row mask(kCurves, 1.0f);
    for (uint32_t l = 0; l < kCurves; l += 2) mask[l] = 0.0f;
    MixInput input = two_layers(mode, mask), single(kCurves);
    single.add(BlendMode::kOverride);
    const MixHandle mix = make_mix(input), reference = make_mix(single);
    OwnMixer own(mix), expected(reference);
    own.play(0, base);
    expected.play(0, base);
    for (int i = 0; i < 500; ++i) {
      if (random.chance(0.1)) {
        own.play(1, clips[random.below(3)], static_cast<Transition>(random.below(3)),
                 random.below(400) * kMillisecond);
      }
      if (random.chance(0.1)) {
        own.weight(1, static_cast<float>(random.real()), random.below(300) * kMillisecond);
      }
      const int64_t ticks = random.below(30) * kMillisecond;
      const Row a = own.step(ticks), b = expected.step(ticks);
      for (uint32_t l = 0; l < kCurves; l += 2) ASSERT_EQ(bits_of(a[l]), bits_of(b[l]));
    }
  }
}

TEST(Layers, CurvesOfZerosStayZeroAndInactive) {
  constexpr uint32_t kActive = 9;
  std::deque<BoundClip> clips;
  for (int i = 0; i < 3; ++i) {
    clips.emplace_back(ClipInput(smooth_curves(30 + i, kActive, 200)), kCurves);
  }
  MixInput input(kCurves);
  for (BlendMode mode : kModes) input.add(mode);
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  Random random = Random::from_seed(15, 0);
  for (int i = 0; i < 500; ++i) {
    if (random.chance(0.2)) {
      own.play(random.below(5), clips[random.below(3)], static_cast<Transition>(random.below(3)),
               random.below(400) * kMillisecond);
    }
    uint64_t active = ~uint64_t{0};
    Row row(mix->curve_count);
    step_mixer(own.mixer, kStep, row.data(), row.size(), &active);
    for (uint32_t l = 0; l < mix->curve_count; ++l) {
      if (l >= kActive) {
        ASSERT_EQ(bits_of(row[l]), 0u) << l;
      }
      ASSERT_EQ(active >> l & 1, row[l] != 0.0f) << l;
    }
  }
  // When all has stopped, nothing is left of it.
  Error error;
  for (uint32_t l = 0; l < 5; ++l) {
    ASSERT_EQ(stop_layer(own.mixer, l, 300 * kMillisecond, error), Status::kOk);
  }
  own.step(kTicksPerSecond);
  for (float value : own.step(kTicksPerSecond)) EXPECT_EQ(bits_of(value), 0u);
}

TEST(Layers, LeaveAloneWhatTheirClipHasNoChannelFor) {
  const BoundClip base(random_input(16), kCurves);
  ClipInput few(Curves(2, 50));
  std::fill(few.curves.values.begin(), few.curves.values.end(), 0.25f);
  const BoundClip partial(few, kCurves, {5, 11});
  for (BlendMode mode : {BlendMode::kOverride, BlendMode::kScale, BlendMode::kMax}) {
    MixInput input = two_layers(mode), single(kCurves);
    single.add(BlendMode::kOverride);
    const MixHandle mix = make_mix(input), reference = make_mix(single);
    OwnMixer own(mix), expected(reference);
    own.play(0, base);
    own.play(1, partial);
    expected.play(0, base);
    const Row a = own.step(kStep), b = expected.step(kStep);
    for (uint32_t l = 0; l < kCurves; ++l) {
      if (l != 5 && l != 11) {
        EXPECT_EQ(a[l], b[l]) << l;
        continue;
      }
      const float full = mode == BlendMode::kScale ? b[l] * 0.25f
                         : mode == BlendMode::kMax ? std::max(b[l], 0.25f)
                                                   : 0.25f;
      EXPECT_NEAR(a[l], full, 1e-6) << l;
    }
  }
}

TEST(Layers, ReturnToALayerWithoutWeightIsExact) {
  const BoundClip clip(random_input(17), kCurves);
  MixInput input(kCurves);
  input.add(BlendMode::kOverride);
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix), expected(mix);
  own.play(0, clip);
  expected.play(0, clip);
  own.step(kStep);
  own.weight(0, 0.0f);
  for (int i = 0; i < 30; ++i) own.step(kStep);
  own.weight(0, 1.0f);
  expected.step(31 * kStep);
  EXPECT_TRUE(same_bits(own.step(kStep), expected.step(kStep)));
}

TEST(Layers, MirroredClipMovesTheOtherSide) {
  const BoundClip clip(ClipInput(smooth_curves(1, 4, 50)), 4);
  const std::vector<uint16_t> mirror = {1, 0, 2, 3};
  MixInput input(4);
  input.add(BlendMode::kOverride);
  input.desc.mirror = {mirror.data(), mirror.size()};
  const MixHandle mix = make_mix(input);
  OwnMixer plain(mix), mirrored(mix);
  plain.play(0, clip);
  LayerPlayDesc desc;
  desc.mirrored = true;
  desc.transition = Transition::kCut;
  Error error;
  ASSERT_EQ(play_clip(mirrored.mixer, 0, clip.source, desc, error), Status::kOk);
  const Row a = plain.step(3 * kStep), b = mirrored.step(3 * kStep);
  EXPECT_TRUE(same_bits(b, {a[1], a[0], a[2], a[3]}));
}

// Poses ----------------------------------------------------------------------------------------------

TEST(Poses, AddUpAndAreLimitedToASumOfOne) {
  MixInput input(6);
  LayerDesc& layer = input.add(BlendMode::kOverride, LayerSource::kPoses);
  input.add_pose({0, 2}, {1.0f, 0.5f});
  input.add_pose({2, 3}, {1.0f, 1.0f});
  layer.pose_count = 2;
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  EXPECT_TRUE(same_bits(own.step(kStep), Row(6, 0.0f)));
  own.pose(0, 0, 0.5f);
  EXPECT_TRUE(same_bits(own.step(kStep), {0.5f, 0, 0.25f, 0, 0, 0}));
  own.pose(0, 0, 1.0f);
  own.pose(0, 1, 1.0f);
  EXPECT_TRUE(same_bits(own.step(kStep), {0.5f, 0, 0.75f, 0.5f, 0, 0}));
}

TEST(Poses, GiveTheSameInAnyOrderOfTheirCurves) {
  std::vector<uint16_t> curves;  // one after the other
  std::vector<float> values;
  for (uint16_t l = 2; l < kCurves - 1; ++l) {
    curves.push_back(l);
    values.push_back(static_cast<float>(l * 7 % 11) / 11);
  }
  const auto row_of = [&] {
    MixInput input(kCurves);
    input.add(BlendMode::kOverride, LayerSource::kPoses).pose_count = 2;
    input.add_pose(curves, values);
    input.add_pose({1, 4}, {0.3f, 0.7f});
    const MixHandle mix = make_mix(input);
    OwnMixer own(mix);
    own.pose(0, 0, 0.3f);
    own.pose(0, 1, 0.6f);
    return own.step(kStep);
  };
  const Row ascending = row_of();
  EXPECT_EQ(ascending[0], 0);
  EXPECT_GT(ascending[4], 0.4f);
  std::reverse(curves.begin(), curves.end());
  std::reverse(values.begin(), values.end());
  EXPECT_TRUE(same_bits(row_of(), ascending));
}

TEST(Poses, LeaveAloneCurvesThatNoneOfThemHas) {
  const BoundClip base(random_input(18), kCurves);
  MixInput input(kCurves);
  input.add(BlendMode::kOverride);
  input.add(BlendMode::kOverride, LayerSource::kPoses).pose_count = 1;
  input.add_pose({3}, {0.75f});
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  own.play(0, base);
  const Row without = own.step(kStep);
  own.pose(1, 0, 1.0f);
  Row with = own.step(0);
  EXPECT_EQ(with[3], 0.75f);
  with[3] = without[3];
  EXPECT_TRUE(same_bits(with, without));
}

// Stages ---------------------------------------------------------------------------------------------

TEST(Antagonists, AreNeverBothAboveZero) {
  const BoundClip clip(random_input(19), kCurves), other(random_input(20), kCurves);
  MixInput input = two_layers(BlendMode::kAdd);
  std::vector<AntagonistPair> pairs;
  for (uint16_t l = 0; l < kCurves - 1; l = static_cast<uint16_t>(l + 2)) {
    pairs.push_back({l, static_cast<uint16_t>(l + 1), 1.0f});
  }
  input.desc.antagonists = {pairs.data(), pairs.size()};
  MixInput without = two_layers(BlendMode::kAdd);
  const MixHandle mix = make_mix(input), plain = make_mix(without);
  OwnMixer own(mix), expected(plain);
  for (OwnMixer* each : {&own, &expected}) {
    each->play(0, clip);
    each->play(1, other);
  }
  int netted = 0;
  for (int i = 0; i < 100; ++i) {
    const Row a = own.step(kStep), b = expected.step(kStep);
    for (const AntagonistPair& pair : pairs) {
      ASSERT_FALSE(a[pair.first] > 0 && a[pair.second] > 0);
      const bool both = b[pair.first] > 0 && b[pair.second] > 0;
      netted += both ? 1 : 0;
      if (both) {
        ASSERT_EQ(a[pair.first] - a[pair.second], b[pair.first] - b[pair.second]);
      } else {
        ASSERT_EQ(bits_of(a[pair.first]), bits_of(b[pair.first]));
        ASSERT_EQ(bits_of(a[pair.second]), bits_of(b[pair.second]));
      }
    }
  }
  EXPECT_GT(netted, 100);
}

TEST(Antagonists, WithStiffnessOfHalfLoseHalf) {
  MixInput input(2);
  input.add(BlendMode::kOverride, LayerSource::kPoses).pose_count = 1;
  input.add_pose({0, 1}, {0.75f, 0.5f});
  const AntagonistPair pair = {0, 1, 0.5f};
  input.desc.antagonists = {&pair, 1};
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  own.pose(0, 0, 1.0f);
  EXPECT_TRUE(same_bits(own.step(kStep), {0.5f, 0.25f}));
}

TEST(Limits, HoldWhateverTheLayersAddUpTo) {
  const BoundClip clip(random_input(21, 100, -3e38f, 3e38f), kCurves);
  const Row lower(kCurves, -0.5f), upper(kCurves, 1.25f);
  MixInput input(kCurves);
  for (int i = 0; i < 4; ++i) input.add(i % 2 == 0 ? BlendMode::kAdd : BlendMode::kScale);
  input.desc.lower = {lower.data(), lower.size()};
  input.desc.upper = {upper.data(), upper.size()};
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  Random random = Random::from_seed(22, 0);
  for (int i = 0; i < 300; ++i) {
    own.play(random.below(4), clip, static_cast<Transition>(random.below(3)), kTicksPerSecond / 5);
    for (float value : own.step(kStep)) {
      ASSERT_GE(value, -0.5f);
      ASSERT_LE(value, 1.25f);
    }
  }
}

TEST(Stages, AreSeenOneByOne) {
  MixInput input(2);
  input.add(BlendMode::kOverride, LayerSource::kPoses).pose_count = 1;
  LayerDesc& late = input.add(BlendMode::kAdd, LayerSource::kPoses, LayerGroup::kEmotion);
  late.pose_count = 1;
  late.after_guards = 1;
  input.add_pose({0, 1}, {0.5f, 0.25f});
  const AntagonistPair pair = {0, 1, 1.0f};
  input.desc.antagonists = {&pair, 1};
  const Row lower(2, 0.0f), upper(2, 0.4f);
  input.desc.lower = {lower.data(), 2};
  input.desc.upper = {upper.data(), 2};
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix);
  own.pose(0, 0, 1.0f);
  own.pose(1, 0, 1.0f);
  own.step(kStep);
  const auto at = [&](uint32_t stage) { return own.mixer.stages[stage * mix->curve_count]; };
  EXPECT_EQ(at(0), 0.5f);
  EXPECT_EQ(at(2 + kStageReactions), 0.5f);
  EXPECT_EQ(at(2 + kStageGuards), 0.5f);
  EXPECT_EQ(at(1), 1.0f);
  EXPECT_EQ(at(2 + kStageAntagonists), 0.5f);
  EXPECT_EQ(at(2 + kStageLimits), 0.4f);
}

TEST(Events, ComeFromTheClipOfTheirLayerOnce) {
  ClipInput input = random_input(23, 61);
  input.events = {{0, "begin", 1.0f}, {10 * kStep, "ten", 2.0f}, {20 * kStep, "twenty", 3.0f}};
  const BoundClip clip(input, kCurves);
  MixInput mix_input = two_layers(BlendMode::kAdd);
  mix_input.desc.max_events = 2;
  const MixHandle mix = make_mix(mix_input);
  OwnMixer own(mix);
  own.play(1, clip);
  own.step(9 * kStep);
  ASSERT_EQ(own.mixer.event_count, 1u);
  EXPECT_EQ(own.mixer.events[0].event.value, 1.0f);
  EXPECT_EQ(own.mixer.events[0].layer, 1u);
  own.step(kStep);
  ASSERT_EQ(own.mixer.event_count, 1u);
  EXPECT_EQ(own.mixer.events[0].event.value, 2.0f);
  EXPECT_FALSE(own.mixer.lost_events);
  own.step(kStep);
  EXPECT_EQ(own.mixer.event_count, 0u);
  PlayDesc loop;
  loop.looping = Looping::kLoop;
  own.play(1, clip, Transition::kCut, 0, loop);
  own.step(61 * kStep);
  EXPECT_EQ(own.mixer.event_count, 2u);
  EXPECT_TRUE(own.mixer.lost_events);
}

TEST(Batch, OfManyIsTheSameAsEachAlone) {
  const BoundClip base(random_input(24), kCurves);
  MixInput input = two_layers(BlendMode::kScreen);
  const MixHandle mix = make_mix(input);
  std::deque<OwnMixer> together, alone;
  std::vector<Mixer*> mixers;
  std::vector<Row> rows(64, Row(kCurves));
  std::vector<float*> outs;
  for (int i = 0; i < 64; ++i) {
    for (std::deque<OwnMixer>* all : {&together, &alone}) {
      all->emplace_back(mix);
      PlayDesc play;
      play.start_tick = i * kStep;
      all->back().play(0, base, Transition::kCut, 0, play);
      all->back().play(1, base, Transition::kInertial, i * kMillisecond);
    }
    mixers.push_back(&together.back().mixer);
    outs.push_back(rows[i].data());
  }
  std::vector<uint64_t> active(64);
  for (int s = 0; s < 20; ++s) {
    step_mixers({mixers.data(), 64}, kStep, outs.data(), kCurves, active.data(), 1);
    for (int i = 0; i < 64; ++i) ASSERT_TRUE(same_bits(alone[i].step(kStep), rows[i]));
  }
}

// Wrong input ----------------------------------------------------------------------------------------

Status created(MixInput& input) {
  Mix* mix = nullptr;
  Error error;
  const Status status = create_mix(input.finish(), default_allocator(), mix, error);
  release(mix);
  EXPECT_EQ(status == Status::kOk, error.message[0] == 0);
  return status;
}

TEST(MixRefuses, WhatIsOutOfRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [&](auto&& change) {
    MixInput input(8, 2);
    input.add(BlendMode::kOverride);
    input.add(BlendMode::kScreen, LayerSource::kPoses, LayerGroup::kEmotion).pose_count = 1;
    input.add_pose({1}, {1.0f});
    EXPECT_EQ(created(input), Status::kOk);
    change(input);
    return created(input) == Status::kInvalidArgument;
  };
  const Row wide(11, 0.5f), two(2, 2.0f);
  const Row ten(10, 0.0f), ones(10, 1.0f);
  Guard guard = {};
  guard.f_on = 1;
  AntagonistPair pair = {0, 1, 1};
  const std::vector<uint16_t> mirror = {1, 2, 0, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].weight = 1.5f; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].weight = -0.5f; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].weight = nan; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].mask = {wide.data(), 11}; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].mask = {two.data(), 2}; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].mode = static_cast<BlendMode>(5); }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[0].after_guards = 1; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[1].after_guards = 2; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[1].pose_count = 2; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers[1].first_pose = ~0u; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.layers.resize(kMaxLayers + 1); }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.add_pose({10}, {1.0f}); }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.add_pose({1, 2}, {1.0f}); }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.add_pose({1}, {nan}); }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.player_count = 0; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.player_count = 1000; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.raw_count = kMaxCurves; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.variable_count = ~0u; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.max_changing_channels = 513; }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.lower = {ten.data(), 10}; }));
  EXPECT_TRUE(refused([&](MixInput& i) {
    i.desc.lower = {ones.data(), 10};
    i.desc.upper = {ten.data(), 10};
  }));
  EXPECT_TRUE(refused([&](MixInput& i) { i.desc.mirror = {mirror.data(), mirror.size()}; }));
  EXPECT_TRUE(refused([&](MixInput& i) {
    guard.count = 25;
    i.desc.guards = {&guard, 1};
  }));
  EXPECT_TRUE(refused([&](MixInput& i) {
    guard.count = 1;
    guard.curves[0] = 10;
    i.desc.guards = {&guard, 1};
  }));
  for (uint32_t together : {1u, 1u << 2, 1u << 24, 6u}) {
    EXPECT_TRUE(refused([&](MixInput& i) {
      guard = Guard();
      guard.f_on = 1;
      guard.count = together == 6 ? 3 : 2;
      for (uint16_t l = 0; l < 3; ++l) guard.curves[l] = l;
      guard.together = together;
      i.desc.guards = {&guard, 1};
    })) << together;
  }
  EXPECT_TRUE(refused([&](MixInput& i) {
    guard.together = 0;
    guard.count = 1;
    guard.curves[0] = 1;
    guard.f_on = 0;
    i.desc.guards = {&guard, 1};
  }));
  EXPECT_TRUE(refused([&](MixInput& i) {
    pair.second = 10;
    i.desc.antagonists = {&pair, 1};
  }));
  EXPECT_TRUE(refused([&](MixInput& i) {
    pair = {1, 1, 1};
    i.desc.antagonists = {&pair, 1};
  }));
  EXPECT_TRUE(refused([&](MixInput& i) {
    pair = {1, 2, nan};
    i.desc.antagonists = {&pair, 1};
  }));
}

TEST(MixerRefuses, AndGoesOnAsBefore) {
  const BoundClip clip(random_input(25), kCurves), of_other_rig(random_input(26), kCurves + 1);
  ClipInput input_of_delta = random_input(27);
  input_of_delta.is_delta = true;
  const BoundClip delta(input_of_delta, kCurves);
  MixInput input = two_layers(BlendMode::kScreen);
  input.add(BlendMode::kOverride, LayerSource::kPoses).pose_count = 1;
  input.add_pose({0}, {1.0f});
  input.desc.variable_count = 1;
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix), expected(mix);
  own.play(0, clip);
  expected.play(0, clip);
  own.step(kStep);
  expected.step(kStep);

  Error error;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  LayerPlayDesc desc;
  EXPECT_EQ(play_clip(own.mixer, 3, clip.source, desc, error), Status::kIndex);
  EXPECT_EQ(play_clip(own.mixer, 2, clip.source, desc, error), Status::kIndex);
  EXPECT_EQ(play_clip(own.mixer, 0, of_other_rig.source, desc, error), Status::kMismatch);
  EXPECT_EQ(play_clip(own.mixer, 0, delta.source, desc, error), Status::kInvalidArgument);
  desc.mirrored = true;
  EXPECT_EQ(play_clip(own.mixer, 0, clip.source, desc, error), Status::kInvalidArgument);
  desc.mirrored = false;
  desc.transition_ticks = -1;
  EXPECT_EQ(play_clip(own.mixer, 0, clip.source, desc, error), Status::kInvalidArgument);
  desc.transition_ticks = 1;
  desc.play.speed_denominator = 0;
  for (Transition transition : {Transition::kCut, Transition::kCrossfade, Transition::kInertial}) {
    desc.transition = transition;
    EXPECT_EQ(play_clip(own.mixer, 0, clip.source, desc, error), Status::kInvalidArgument);
  }
  EXPECT_EQ(stop_layer(own.mixer, 2, 0, error), Status::kIndex);
  EXPECT_EQ(stop_layer(own.mixer, 0, -1, error), Status::kInvalidArgument);
  EXPECT_EQ(set_layer_weight(own.mixer, 3, 0.5f, 0, error), Status::kIndex);
  EXPECT_EQ(set_layer_weight(own.mixer, 0, -0.5f, 0, error), Status::kInvalidArgument);
  EXPECT_EQ(set_layer_weight(own.mixer, 0, nan, 0, error), Status::kInvalidArgument);
  EXPECT_EQ(set_pose_weight(own.mixer, 2, 1, 0.5f, 0, error), Status::kIndex);
  EXPECT_EQ(set_pose_weight(own.mixer, 0, 0, 0.5f, 0, error), Status::kIndex);
  EXPECT_EQ(set_pose_weight(own.mixer, 2, 0, nan, 0, error), Status::kInvalidArgument);
  EXPECT_EQ(set_variable(own.mixer, 1, 0, error), Status::kIndex);
  EXPECT_EQ(set_variable(own.mixer, 0, nan, error), Status::kInvalidArgument);
  EXPECT_EQ(set_guard(own.mixer, 0, 0, error), Status::kIndex);
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(same_bits(own.step(kStep), expected.step(kStep)));
  }
}

TEST(Memory, EveryFailedRequestIsReported) {
  MixInput input = two_layers(BlendMode::kAdd);
  CountingAllocator counting;
  const MienAllocator given = counting.get();
  const Allocator allocator = {given.user, given.allocate, given.release};
  counting.fail_at = 1;
  Mix* mix = nullptr;
  Error error;
  EXPECT_EQ(create_mix(input.finish(), allocator, mix, error), Status::kMemory);
  EXPECT_EQ(mix, nullptr);
  counting.fail_at = 4;
  ASSERT_EQ(create_mix(input.finish(), allocator, mix, error), Status::kOk);
  Mixer* mixer = create_mixer(*mix, 1, false, allocator);
  ASSERT_NE(mixer, nullptr);
  EXPECT_EQ(create_mixer(*mix, 1, false, allocator), nullptr);
  release(mixer);
  release(mix);
  EXPECT_TRUE(counting.clean());
}

TEST(Memory, StepsAndPlaysTakeNone) {
  const BoundClip clip(random_input(28), kCurves), other(random_input(29), kCurves);
  MixInput input = two_layers(BlendMode::kScreen);
  CountingAllocator counting;
  const MienAllocator given = counting.get();
  const MixHandle mix = make_mix(input);
  const MixerHandle mixer(
      create_mixer(*mix, 1, false, {given.user, given.allocate, given.release}));
  EXPECT_EQ(counting.bytes, mixer_size(*mix, false));
  LayerPlayDesc desc;
  Error error;
  for (uint32_t i = 0; i < 100; ++i) {
    desc.transition = static_cast<Transition>(i % 3);
    play_clip(*mixer, i % 2, (i % 4 == 0 ? clip : other).source, desc, error);
    step_mixer(*mixer, kStep, nullptr, 0, nullptr);
  }
  EXPECT_EQ(counting.requests, 1u);
}

}  // namespace
}  // namespace mien
