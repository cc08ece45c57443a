// SPDX-License-Identifier: MIT
// Snapshots continue to the bit, whatever goes on; bytes that are none change nothing.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/mix_scene.h"
#include "tests/support/mix_setup.h"

namespace mien {
namespace {

constexpr uint32_t kSnapshotCurves = 24;
constexpr int64_t kSnapshotStep = kTicksPerSecond / 60;

/// Everything on.
struct Everything {
  std::deque<BoundClip> clips;
  std::vector<uint16_t> mirror;
  std::vector<uint16_t> curves = {0, 1};
  Row amounts = {1, 1};
  MixHandle mix;
  std::vector<ClipSource> sources;

  Everything() {
    for (uint32_t i = 0; i < 3; ++i) {
      ClipInput input(smooth_curves(80 + i, kSnapshotCurves, 100 + 50 * i));
      input.wraps = i > 0;
      clips.emplace_back(std::move(input), kSnapshotCurves);
      sources.push_back(clips.back().source);
    }
    for (uint16_t l = 0; l < kSnapshotCurves + 1; ++l)
      mirror.push_back(l < kSnapshotCurves ? l ^ 1 : l);
    MixInput input(kSnapshotCurves, 1);
    input.desc.mirror = {mirror.data(), mirror.size()};
    input.add(BlendMode::kOverride, LayerSource::kClip, LayerGroup::kSpeech);
    input.add(BlendMode::kScreen);
    input.add(BlendMode::kScreen, LayerSource::kPoses, LayerGroup::kEmotion).pose_count = 2;
    for (Generator kind : {Generator::kBlink, Generator::kBreath, Generator::kNoise}) {
      LayerDesc& layer = input.add(BlendMode::kAdd, LayerSource::kGenerator, LayerGroup::kLife);
      layer.generator = kind;
      layer.period = kTicksPerSecond;
      layer.curves = {curves.data(), 2};
      layer.amounts = {amounts.data(), 2};
    }
    for (uint16_t p = 0; p < 5; ++p) {
      input.add_pose({p, static_cast<uint16_t>(p + 6), 24}, {0.5f, 0.7f, 0.2f});
    }
    Stroke strokes[kGlareStrokes];
    glare_strokes(0, strokes);
    const ReactionDesc glare = glare_reaction(strokes);
    input.desc.reactions = {&glare, 1};
    const AntagonistPair pair = {3, 4, 1};
    input.desc.antagonists = {&pair, 1};
    Guard guard = {};  // which is always a bit active, so it is easing much of the time
    guard.f_on = 100;
    guard.tolerance = 0.1f;
    guard.count = 4;
    for (uint16_t i = 0; i < 4; ++i) {
      guard.curves[i] = static_cast<uint16_t>(5 + i);
      guard.gains[i] = 8 - static_cast<float>(i);
    }
    input.desc.guards = {&guard, 1};
    mix = make_mix(input);
  }

  void disturb(OwnMixer& own, Random& random) const {
    Error error;
    if (random.chance(0.05)) {
      LayerPlayDesc desc;
      desc.transition = static_cast<Transition>(random.below(3));
      desc.transition_ticks = random.below(500) * kMillisecond;
      desc.mirrored = random.chance(0.3);
      desc.play.speed_numerator = static_cast<int32_t>(random.below(7)) - 3;
      desc.play.speed_denominator = 2;
      desc.play.interpolation = static_cast<Interpolation>(random.below(3));
      ASSERT_EQ(play_clip(own.mixer, random.below(2), sources[random.below(3)], desc, error),
                Status::kOk);
    }
    if (random.chance(0.02)) {
      ASSERT_EQ(stop_layer(own.mixer, random.below(2), random.below(300) * kMillisecond, error),
                Status::kOk);
    }
    if (random.chance(0.05)) {
      own.weight(random.below(6), static_cast<float>(random.real()),
                 random.below(300) * kMillisecond);
    }
    if (random.chance(0.05)) {
      own.pose(2, random.below(2), static_cast<float>(random.real()),
               random.below(300) * kMillisecond);
    }
    if (random.chance(0.03)) {
      ASSERT_EQ(trigger(own.mixer, 0, static_cast<float>(random.real()),
                        random.below(1000) * kMillisecond, error),
                Status::kOk);
    }
    if (random.chance(0.05)) {
      ASSERT_EQ(set_level(own.mixer, 0, static_cast<float>(random.real()), error), Status::kOk);
    }
  }
};

std::vector<uint8_t> snapshot(OwnMixer& own) {
  std::vector<uint8_t> bytes(snapshot_size(*own.mixer.mix));
  Error error;
  EXPECT_EQ(take_snapshot(own.mixer, {bytes.data(), bytes.size()}, error), Status::kOk);
  return bytes;
}

Status restore(OwnMixer& own, const std::vector<uint8_t>& bytes,
               const std::vector<ClipSource>& sources) {
  const auto find = [](const void* user, uint64_t id, ClipSource& source) {
    for (const ClipSource& each : *static_cast<const std::vector<ClipSource>*>(user)) {
      if (each.id != id) continue;
      source = each;
      return true;
    }
    return false;
  };
  Error error;
  return restore_snapshot(own.mixer, {bytes.data(), bytes.size()}, {&sources, find}, error);
}

TEST(Snapshot, ContinuesToTheBitAnywhere) {
  const Everything all;
  OwnMixer own(all.mix, 9);
  Random random = Random::from_seed(90, 0);
  for (int round = 0; round < 100; ++round) {
    for (uint32_t i = random.below(40); i > 0; --i) {
      all.disturb(own, random);
      own.step(random.below(30) * kMillisecond);
    }
    // Into a fresh mixer, and into one that has done something else.
    OwnMixer other(all.mix, 1);
    other.play(0, all.clips[0]);
    if (round % 2 == 0) other.step(kSnapshotStep);
    const std::vector<uint8_t> bytes = snapshot(own);
    ASSERT_EQ(restore(other, bytes, all.sources), Status::kOk);
    ASSERT_EQ(snapshot(other), bytes);
    Random mine = Random::from_seed(91, static_cast<uint64_t>(round)), its = mine;
    for (int i = 0; i < 40; ++i) {
      all.disturb(own, mine);
      all.disturb(other, its);
      ASSERT_TRUE(same_bits(own.step(kSnapshotStep), other.step(kSnapshotStep)))
          << round << ", " << i;
      ASSERT_EQ(own.mixer.event_count, other.mixer.event_count);
    }
  }
}

TEST(Snapshot, RefusesOtherMixesMissingClipsAndLittleRoom) {
  const Everything all;
  OwnMixer own(all.mix);
  own.play(0, all.clips[0]);
  own.step(kSnapshotStep);
  const std::vector<uint8_t> bytes = snapshot(own);
  Error error;
  std::vector<uint8_t> small(bytes.size() - 1);
  EXPECT_EQ(take_snapshot(own.mixer, {small.data(), small.size()}, error),
            Status::kInvalidArgument);

  OwnMixer other(all.mix);
  const std::vector<uint8_t> untouched = snapshot(other);
  EXPECT_EQ(restore(other, bytes, {all.sources[1], all.sources[2]}), Status::kMismatch);
  std::vector<ClipSource> wrong = all.sources;
  const BoundClip short_one(ClipInput(smooth_curves(1, kSnapshotCurves, 1)), kSnapshotCurves);
  wrong[0].clip = short_one.source.clip;
  EXPECT_EQ(restore(other, bytes, wrong), Status::kMismatch);
  EXPECT_EQ(restore(other, small, all.sources), Status::kInvalidArgument);
  EXPECT_EQ(restore(other, {}, all.sources), Status::kInvalidArgument);
  EXPECT_EQ(snapshot(other), untouched);

  MixInput input(kSnapshotCurves);
  input.add(BlendMode::kOverride);
  const MixHandle small_mix = make_mix(input);
  OwnMixer of_other_mix(small_mix);
  EXPECT_EQ(restore(of_other_mix, bytes, all.sources), Status::kInvalidArgument);
}

// Else a step would go through all the blinks of 51 years.
TEST(Snapshot, OfATimeLongAfterTheNextBlinkAreRefused) {
  const Everything all;
  OwnMixer own(all.mix), other(all.mix);
  own.step(kSnapshotStep);
  std::vector<uint8_t> bytes = snapshot(own);
  const size_t header = bytes.size() - own.mixer.state.count;
  const auto offset_of = [&](const void* in_state) {
    return header +
           static_cast<size_t>(static_cast<const uint8_t*>(in_state) - own.mixer.state.data);
  };
  size_t blinks = 0;
  for (uint32_t i = 0; i < all.mix->layers.count; ++i) {
    const LayerDesc& layer = all.mix->layers[i];
    if (layer.source != LayerSource::kGenerator || layer.generator != Generator::kBlink) continue;
    ++blinks;
    for (const int64_t next : {int64_t{0}, kMaxMixerTime - kMaxFadeTicks - 1}) {
      memcpy(&bytes[offset_of(&own.mixer.header->now)], &kMaxMixerTime, sizeof(kMaxMixerTime));
      memcpy(&bytes[offset_of(&own.mixer.generators[i].next)], &next, sizeof(next));
      EXPECT_EQ(restore(other, bytes, all.sources), Status::kInvalidArgument) << next;
    }
    const int64_t next = kMaxMixerTime - kMaxFadeTicks;
    memcpy(&bytes[offset_of(&own.mixer.generators[i].next)], &next, sizeof(next));
  }
  EXPECT_EQ(blinks, 1u);
  EXPECT_EQ(restore(other, bytes, all.sources), Status::kOk);
  other.step(0);
}

TEST(Snapshot, DamagedOnesAreRefusedOrHarmless) {
  const Everything all;
  OwnMixer own(all.mix, 9);
  Random random = Random::from_seed(92, 0);
  for (int i = 0; i < 100; ++i) {
    all.disturb(own, random);
    own.step(kSnapshotStep);
  }
  const std::vector<uint8_t> good = snapshot(own);
  // Most of a snapshot are rows; the numbers that matter come first.
  const uint32_t front = static_cast<uint32_t>(good.size() / 5);
  int accepted = 0, refused = 0;
  for (int round = 0; round < 20000; ++round) {
    std::vector<uint8_t> bytes = good;
    for (uint32_t i = 1 + random.below(4); i > 0; --i) {
      const uint32_t at =
          random.below(random.chance(0.9) ? front : static_cast<uint32_t>(good.size()));
      bytes[at] = random.chance(0.5) ? static_cast<uint8_t>(bytes[at] ^ 1u << random.below(8))
                                     : static_cast<uint8_t>(random.below(256));
    }
    OwnMixer other(all.mix);
    const std::vector<uint8_t> untouched = snapshot(other);
    if (restore(other, bytes, all.sources) != Status::kOk) {
      ++refused;
      ASSERT_EQ(snapshot(other), untouched);
      continue;
    }
    ++accepted;
    for (int i = 0; i < 3; ++i) {
      for (float value : other.step(kSnapshotStep)) ASSERT_FALSE(std::isnan(value));
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(accepted, 1000);
}

/// Clips, poses, a live stream, all generators with a gaze, guards and reactions with levels.
Status restore(SceneActor& actor, const std::vector<uint8_t>& bytes, Error& error) {
  return restore_snapshot(*actor.mixer, {bytes.data(), bytes.size()}, actor.scene.finder(), error);
}

std::vector<uint8_t> snapshot(SceneActor& actor) {
  std::vector<uint8_t> bytes(snapshot_size(*actor.scene.mix));
  Error error;
  EXPECT_EQ(take_snapshot(*actor.mixer, {bytes.data(), bytes.size()}, error), Status::kOk);
  return bytes;
}

// Whatever numbers of a snapshot are changed: if it is accepted, so are those that follow it.
TEST(Snapshot, OfAMixerThatAcceptedOneAreAccepted) {
  const MixScene scene(9);
  SceneActor made(scene, 3);
  made.begin();
  Random random = Random::from_seed(93, 0);
  const uint32_t values[] = {0,          1,          0x7FFFFFFF, 0x80000000, 0x3F800000,
                             0x00000001, 0x7F7FFFFF, 0xFF7FFFFF, 0x497423F0, 0xFFFFFFFF};
  int accepted = 0;
  for (int round = 0; round < 4000; ++round) {
    if (round % 50 == 0) {
      for (int i = 0; i < 30; ++i) {
        made.disturb(random);
        made.step(kSceneStep);
      }
    }
    std::vector<uint8_t> bytes = snapshot(made);
    const size_t rows = made.mixer->layer_rows.count * sizeof(float);
    const auto words = static_cast<uint32_t>((bytes.size() - rows - 24) / 4);
    for (uint32_t i = 1 + random.below(4); i > 0; --i) {
      const uint32_t value = random.chance(0.8) ? values[random.below(10)] : random.below(~0u);
      memcpy(&bytes[24 + size_t{4} * random.below(words)], &value, sizeof(value));
    }
    Error error;
    SceneActor other(scene, 1);
    // Its queue has a row of long ago, which snapshots do not have.
    if (random.chance(0.2)) {
      const Row row(other.mixer->streams[MixScene::kLive]->channels, 0.5f);
      ASSERT_EQ(push_row(*other.mixer, MixScene::kLive, -(int64_t{1} << 61) + 1,
                         {row.data(), row.size()}, nullptr, error),
                Status::kOk);
    }
    if (restore(other, bytes, error) != Status::kOk) continue;
    ++accepted;
    other.pushed = other.mixer->header->now;
    if (other.pushed > kMaxMixerTime - kTicksPerSecond) continue;  // its time is over
    for (int i = 0; i < 6; ++i) {
      const std::vector<uint8_t> next = snapshot(other);
      SceneActor third(scene, 2);
      ASSERT_EQ(restore(third, next, error), Status::kOk) << round << ": " << error.message;
      other.disturb(random);
      other.step(kSceneStep);
    }
  }
  EXPECT_GT(accepted, 1000);
}

// The offset of a transition is tiny beside its speed, so that it ends at once.
TEST(Snapshot, OfATransitionWithoutADistanceIsAccepted) {
  ClipInput moves(Curves(2, 10)), rests(Curves(2, 10));
  for (uint32_t f = 0; f < 10; ++f) {
    moves.curves.at(f, 0) = f % 2 == 0 ? 1.0f : 1e-40f;
    rests.curves.at(f, 0) = 0.0f;
  }
  const BoundClip first(std::move(moves), 2), second(std::move(rests), 2);
  MixInput input(2);
  input.add(BlendMode::kOverride);
  const MixHandle mix = make_mix(input);
  OwnMixer own(mix), other(mix);
  own.play(0, first);
  own.step(0);
  own.step(kSnapshotStep);
  own.play(0, second, Transition::kInertial, kTicksPerSecond);
  own.step(kSnapshotStep);
  EXPECT_EQ(restore(other, snapshot(own), {first.source, second.source}), Status::kOk);
}

}  // namespace
}  // namespace mien
