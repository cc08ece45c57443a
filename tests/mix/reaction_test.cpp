// SPDX-License-Identifier: MIT
// A light in the eyes of a face that speaks: what moves when, and what does not.
#include "runtime/mix/reaction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/mix_setup.h"

namespace mien {
namespace {

// Raw controls 0, 1: lids. 2, 3: squint. 4, 5: brows. 6 ... 19: mouth. Variables: gaze, pupil, head.
constexpr uint32_t kRaw = 20;
enum Curve : uint16_t { kLidLeft, kLidRight, kSquint = 2, kBrow = 4, kMouth = 6 };
enum Variable : uint16_t { kGaze = kRaw, kPupil, kHead };
constexpr uint32_t kReactionCurves = kRaw + 3;

struct FaceMix {
  BoundClip speech;
  MixHandle mix;

  explicit FaceMix(Retrigger rule = Retrigger::kExtend) : speech(performance(), kRaw) {
    MixInput input(kRaw, 3);
    input.add(BlendMode::kOverride, LayerSource::kClip, LayerGroup::kSpeech);
    input.add(BlendMode::kScreen, LayerSource::kPoses, LayerGroup::kEmotion).pose_count = 1;
    input.add_pose({kSquint, 3, kMouth, 7}, {0.3f, 0.3f, 0.6f, 0.6f});
    input.add_pose({kLidLeft, kLidRight}, {1.0f, 1.0f});
    input.add_pose({kSquint, 3, kBrow, 5}, {0.9f, 0.9f, 0.7f, 0.7f});
    input.add_pose({kGaze}, {-0.4f});
    input.add_pose({kPupil}, {-0.5f});
    input.add_pose({kHead}, {0.3f});
    Stroke strokes[kGlareStrokes];
    glare_strokes(1, strokes);
    ReactionDesc glare = glare_reaction(strokes);
    glare.retrigger = rule;
    input.desc.reactions = {&glare, 1};
    mix = make_mix(input);
  }

  /// Lids that do not close by themselves; the mouth moves all the time.
  static ClipInput performance() {
    Curves curves = smooth_curves(60, kRaw, 600);
    for (uint32_t f = 0; f < 600; ++f) {
      for (uint32_t l = 0; l < kMouth; ++l) curves.at(f, l) *= l < 2 ? 0.02f : 0.1f;
    }
    ClipInput input(curves);
    input.events = {{kTicksPerSecond * 5 / 2, "word", 1.0f}};
    return input;
  }

  OwnMixer start() const {
    OwnMixer own(mix);
    own.play(0, speech);
    own.pose(1, 0, 0.8f);
    return own;
  }
};

void fire(OwnMixer& own, int64_t hold = kUntilReleased, float strength = 1) {
  Error error;
  ASSERT_EQ(trigger(own.mixer, 0, strength, hold, error), Status::kOk) << error.message;
}

void let_go(OwnMixer& own) {
  Error error;
  ASSERT_EQ(end_stimulus(own.mixer, 0, error), Status::kOk);
}

void set_to(OwnMixer& own, float level) {
  Error error;
  ASSERT_EQ(set_level(own.mixer, 0, level, error), Status::kOk) << error.message;
}

/// Rows at each millisecond, from 1 on.
struct Recording {
  std::vector<Row> rows = {Row(kReactionCurves)};
  std::vector<int> events;  // milliseconds

  void step(OwnMixer& own) {
    rows.push_back(own.step(kMillisecond));
    if (own.mixer.event_count > 0) events.push_back(static_cast<int>(rows.size() - 1));
  }
};

TEST(Glare, ActsWhenAndWhereItShould) {
  const FaceMix face;
  OwnMixer plain = face.start(), lit = face.start();
  Recording without, with;
  for (int ms = 1; ms <= 9000; ++ms) {
    without.step(plain);
    with.step(lit);
    if (ms == 2000) fire(lit);
    if (ms == 3500) let_go(lit);
  }
  int closed[2] = {0, 0}, last_difference = 0;
  for (int ms = 1; ms <= 9000; ++ms) {
    const Row &a = without.rows[ms], &b = with.rows[ms];
    if (!same_bits(a, b)) last_difference = ms;
    if (ms <= 2060) {
      ASSERT_TRUE(same_bits(a, b)) << ms;
    }
    for (int lid = 0; lid < 2; ++lid) {
      if (closed[lid] == 0 && b[lid] >= 0.9f) closed[lid] = ms;
    }
    if (ms <= 2200) {
      ASSERT_EQ(bits_of(a[kPupil]), bits_of(b[kPupil])) << ms;
    }
    for (uint32_t l = kMouth; l < kRaw; ++l) ASSERT_EQ(bits_of(a[l]), bits_of(b[l]));
    for (uint32_t l = 0; l < kReactionCurves && ms > 1; ++l) {
      const float faster =
          std::fabs((b[l] - with.rows[ms - 1][l]) - (a[l] - without.rows[ms - 1][l]));
      ASSERT_LE(faster * 1000, l < 2 ? 30.0f : 12.0f) << ms << ", curve " << l;
    }
  }
  for (int lid : closed) {
    EXPECT_GE(lid, 2110);
    EXPECT_LE(lid, 2160);
  }
  const float travel = with.rows[2450][kPupil] / -0.5f;
  EXPECT_NEAR(travel, 1 - std::exp(-1.0), 0.003);
  EXPECT_EQ(with.events, without.events);
  EXPECT_EQ(with.events.size(), 1u);
  // Pupils are the last: 500 ms * 12 ln 2 after the light.
  EXPECT_GT(last_difference, 3500);
  EXPECT_LT(last_difference, 3500 + 4200);
  lit.step(20 * kTicksPerSecond);  // until it has recovered from adaptation
  EXPECT_EQ(lit.mixer.reactions[0].running, 0);
}

TEST(Glare, StrokesStartAndTakeAsLongAsTheyShould) {
  const FaceMix face;
  OwnMixer plain = face.start(), lit = face.start();
  Recording without, with;
  for (int ms = 1; ms <= 2600; ++ms) {
    without.step(plain);
    with.step(lit);
    if (ms == 2000) fire(lit);
  }
  const struct {
    uint16_t curve;
    float pose;
    int delay, attack;
  } strokes[] = {{kSquint, 0.9f, 90, 150},
                 {kBrow, 0.7f, 90, 150},
                 {kGaze, -0.4f, 200, 120},
                 {kHead, 0.3f, 180, 350}};
  for (const auto& stroke : strokes) {
    // What of the pose is on top of the row without the light, in mode screen or add.
    const auto share = [&](int ms) {
      const float below = without.rows[2000 + ms][stroke.curve];
      const float room = stroke.curve < kRaw ? 1 - below : 1;
      return (with.rows[2000 + ms][stroke.curve] - below) / (stroke.pose * room);
    };
    const auto adapted = [](int ms) { return 0.6 + 0.4 * std::exp(-ms / 1500.0); };
    const int middle = stroke.delay + stroke.attack / 2, end = stroke.delay + stroke.attack;
    EXPECT_EQ(share(stroke.delay), 0) << stroke.curve;
    EXPECT_GT(share(stroke.delay + 3), 0) << stroke.curve;
    EXPECT_NEAR(share(middle), 0.5 * adapted(middle), 0.002) << stroke.curve;
    EXPECT_LT(share(end - 10), 0.9999 * adapted(end - 10)) << stroke.curve;
    EXPECT_NEAR(share(end), adapted(end), 0.001) << stroke.curve;
  }
  for (uint16_t lid : {kLidLeft, kLidRight}) {  // in mode max, for a time of its own
    const auto share = [&](int ms) {
      const float below = without.rows[2000 + ms][lid];
      return (with.rows[2000 + ms][lid] - below) / (1 - below);
    };
    EXPECT_NEAR(share(60 + 35), 0.5f, 1e-4f);
    EXPECT_LT(share(60 + 65), 0.999f);
    EXPECT_NEAR(share(60 + 70), 1, 1e-6f);
    EXPECT_NEAR(share(60 + 70 + 60), 1, 1e-6f);
    EXPECT_NEAR(share(60 + 70 + 60 + 110), 0.5f, 1e-4f);
    EXPECT_EQ(share(60 + 70 + 60 + 220), 0);
  }
}

TEST(Glare, TriggeredAgainActsAtTheLargerOfBothStrengths) {
  const FaceMix face;
  const auto gaze_after = [&face](float first, float second) {
    OwnMixer lit = face.start();
    fire(lit, kUntilReleased, first);
    lit.step(250 * kMillisecond);  // the gaze is on its way
    fire(lit, kUntilReleased, second);
    return lit.step(350 * kMillisecond)[kGaze];
  };
  const float full = gaze_after(1, 1);
  EXPECT_LT(full, -0.3f);
  EXPECT_FLOAT_EQ(gaze_after(0.4f, 1), full);
  EXPECT_FLOAT_EQ(gaze_after(1, 0.4f), full);
  EXPECT_FLOAT_EQ(gaze_after(0.4f, 0.4f), 0.4f * full);
}

TEST(Glare, AdaptsWhileTheLightStays) {
  const FaceMix face;
  OwnMixer lit = face.start();
  fire(lit);
  const float at_first = lit.step(400 * kMillisecond)[kGaze];
  const float later = lit.step(20 * kTicksPerSecond)[kGaze];
  EXPECT_LT(at_first, -0.33f);
  EXPECT_NEAR(later, 0.6f * -0.4f, 1e-4f);
}

TEST(Glare, TriggeredAgainOrFlickeringMakesNoJump) {
  for (int flicker : {0, 1}) {
    for (Retrigger rule : {Retrigger::kExtend, Retrigger::kRestart, Retrigger::kIgnore}) {
      const FaceMix face(rule);
      OwnMixer plain = face.start(), lit = face.start();
      Recording without, with;
      bool on = false;
      for (int ms = 1; ms <= 9000; ++ms) {
        without.step(plain);
        with.step(lit);
        if (flicker == 0) {
          if (ms == 2000 || ms == 2030) fire(lit);
          if (ms == 3500) let_go(lit);
        } else if (ms >= 2000 && ms < 3500 && ms % 33 == 0) {  // 15 Hz
          on = !on;
          on ? fire(lit) : let_go(lit);
        } else if (ms == 3500) {
          let_go(lit);
        }
      }
      int blinks = 0, last_blink = -1000;
      for (int ms = 2; ms <= 9000; ++ms) {
        const Row &a = without.rows[ms], &b = with.rows[ms];
        for (uint32_t l = 0; l < kReactionCurves; ++l) {
          const float changed = (b[l] - with.rows[ms - 1][l]) - (a[l] - without.rows[ms - 1][l]);
          ASSERT_LE(std::fabs(changed) * 1000, l < 2 ? 30.0f : 12.0f) << ms << ", curve " << l;
        }
        if (b[0] >= 0.9f && with.rows[ms - 1][0] < 0.9f) {
          EXPECT_GE(ms - last_blink, 250);
          last_blink = ms;
          ++blinks;
        }
      }
      EXPECT_GE(blinks, 1);
      EXPECT_TRUE(same_bits(with.rows[9000], without.rows[9000]));
    }
  }
}

TEST(Level, IsAStimulusFromOneThresholdToTheOther) {
  const FaceMix face;
  OwnMixer by_level = face.start(), by_hand = face.start();
  Recording level, hand;
  for (int ms = 1; ms <= 9000; ++ms) {
    level.step(by_level);
    hand.step(by_hand);
    if (ms == 1000) set_to(by_level, 0.49f);  // too little
    if (ms == 2000) {
      set_to(by_level, 1);
      fire(by_hand);
    }
    if (ms == 2500) set_to(by_level, 1);
    if (ms == 3500) set_to(by_level, 0.34f);
    if (ms == 3520) set_to(by_level, 0);
    if (ms == 3550) let_go(by_hand);
  }
  for (int ms = 1; ms <= 9000; ++ms) {
    ASSERT_TRUE(same_bits(level.rows[ms], hand.rows[ms])) << ms;
  }
  EXPECT_GT(hand.rows[2500][kSquint], 0.5f);
}

TEST(Level, ScalesStrokesWithoutAJump) {
  const FaceMix face;
  OwnMixer plain = face.start(), lit = face.start();
  Recording without, with;
  std::minstd_rand random(5);
  for (int ms = 1; ms <= 12000; ++ms) {
    without.step(plain);
    with.step(lit);
    if (ms == 1000) set_to(lit, 0.6f);
    // Then it jumps between all and the least that is a stimulus.
    if (ms >= 4000 && ms < 6000 && random() % 60 == 0) {
      set_to(lit, random() % 2 == 0 ? 1.0f : 0.36f);
    }
    if (ms == 6000) set_to(lit, 0);
  }
  EXPECT_NEAR(with.rows[3999][kPupil], 0.6f * -0.5f, 2e-4f) << "pupils do not adapt";
  EXPECT_LT(with.rows[1400][kGaze], -0.3f) << "gaze is not scaled";
  for (int ms = 2; ms <= 12000; ++ms) {
    const Row &a = without.rows[ms], &b = with.rows[ms];
    for (uint32_t l = 0; l < kReactionCurves; ++l) {
      const float changed = (b[l] - with.rows[ms - 1][l]) - (a[l] - without.rows[ms - 1][l]);
      ASSERT_LE(std::fabs(changed) * 1000, l < 2 ? 30.0f : 12.0f) << ms << ", curve " << l;
    }
  }
  EXPECT_TRUE(same_bits(with.rows[12000], without.rows[12000]));
}

TEST(Level, ThatFlickersIsALightThatIsOn) {
  for (Retrigger rule : {Retrigger::kExtend, Retrigger::kRestart, Retrigger::kIgnore}) {
    const FaceMix face(rule);
    OwnMixer steady = face.start(), flickering = face.start();
    Recording on, flicker;
    for (int ms = 1; ms <= 9000; ++ms) {
      on.step(steady);
      flicker.step(flickering);
      if (ms == 60 * 33) set_to(steady, 1);
      if (ms == 105 * 33) set_to(steady, 0);
      if (ms >= 60 * 33 && ms <= 105 * 33 && ms % 33 == 0) {  // 15 Hz
        set_to(flickering, ms / 33 % 2 == 0 ? 1.0f : 0.0f);
      }
    }
    for (int ms = 1; ms <= 9000; ++ms) {
      ASSERT_TRUE(same_bits(on.rows[ms], flicker.rows[ms])) << ms;
    }
    EXPECT_LT(on.rows[104 * 33][kPupil], -0.4f);
  }
}

TEST(Level, IsFollowedWithoutOvershootAndSlowly) {
  Level level = {0, 0, 0, 0, 0};
  std::minstd_rand random(1);
  float last = 0;
  double fastest = 0;
  for (int64_t ms = 1; ms <= 60000; ++ms) {
    const int64_t now = ms * kMillisecond;
    const float value = level_value(level, now);
    ASSERT_GE(value, -1e-6f) << ms;
    ASSERT_LE(value, 1 + 1e-6f) << ms;
    fastest = std::max(fastest, std::fabs(double{value} - last) * 1000);
    last = value;
    const bool rare = ms < 30000;
    if (random() % (rare ? 300 : 20) == 0) {
      follow_level(level, now,
                   static_cast<float>(rare ? random() % 2 * 1000 : random() % 1000) / 1000);
      ASSERT_NEAR(level_value(level, now), value, 1e-7f) << ms;
    }
  }
  EXPECT_LE(fastest, kLevelRate / std::exp(1.0) + 0.002);
  EXPECT_GT(fastest, 5.5) << "the bound is reached";
  level = {0, 0, 0, 0, 0};
  follow_level(level, 0, 1);
  EXPECT_NEAR(level_value(level, 243 * kMillisecond), 0.9, 0.002);
  EXPECT_EQ(level_value(level, 1100 * kMillisecond), 1.0f);
}

TEST(Level, DoesNotDependOnHowTimeIsDivided) {
  const FaceMix face;
  OwnMixer coarse = face.start(), fine = face.start();
  for (int i = 0; i < 200; ++i) {
    const float levels[] = {0.7f, 0.9f, 0.1f};
    if (i % 30 == 0) {
      set_to(coarse, levels[i / 30 % 3]);
      set_to(fine, levels[i / 30 % 3]);
    }
    const Row row = coarse.step(16 * kMillisecond);
    for (int k = 0; k < 3; ++k) fine.step(4 * kMillisecond);
    ASSERT_TRUE(same_bits(fine.step(4 * kMillisecond), row)) << i;
  }
}

TEST(Level, EndsWithAReleaseUntilItIsSetAgain) {
  const FaceMix face;
  OwnMixer lit = face.start();
  set_to(lit, 1);
  lit.step(kTicksPerSecond);
  let_go(lit);
  EXPECT_EQ(lit.step(kTicksPerSecond)[kGaze], 0.0f);
  set_to(lit, 1);
  EXPECT_LT(lit.step(kTicksPerSecond)[kGaze], -0.2f);
}

TEST(Level, IsIgnoredWhereTriggersAre) {
  const FaceMix face(Retrigger::kIgnore);
  OwnMixer lit = face.start();
  fire(lit, 100 * kMillisecond);
  lit.step(kTicksPerSecond);
  set_to(lit, 1);  // the reaction recovers still
  EXPECT_EQ(lit.step(kTicksPerSecond)[kGaze], 0.0f);
  lit.step(40 * kTicksPerSecond);
  set_to(lit, 1);
  EXPECT_LT(lit.step(kTicksPerSecond)[kGaze], -0.2f);
}

TEST(Glare, DoesNotDependOnHowTimeIsDivided) {
  const FaceMix face;
  OwnMixer coarse = face.start(), fine = face.start();
  for (int i = 0; i < 100; ++i) {
    if (i == 20) {
      fire(coarse, 700 * kMillisecond, 0.7f);
      fire(fine, 700 * kMillisecond, 0.7f);
    }
    const Row row = coarse.step(16 * kMillisecond);
    for (int k = 0; k < 3; ++k) fine.step(4 * kMillisecond);
    ASSERT_TRUE(same_bits(fine.step(4 * kMillisecond), row)) << i;
  }
}

TEST(Reactions, RefuseWhatDoesNotExist) {
  const FaceMix face;
  OwnMixer own = face.start();
  Error error;
  EXPECT_EQ(trigger(own.mixer, 1, 1, 0, error), Status::kIndex);
  EXPECT_EQ(trigger(own.mixer, 0, 1.5f, 0, error), Status::kInvalidArgument);
  EXPECT_EQ(trigger(own.mixer, 0, NAN, 0, error), Status::kInvalidArgument);
  EXPECT_EQ(trigger(own.mixer, 0, 1, -1, error), Status::kInvalidArgument);
  EXPECT_EQ(end_stimulus(own.mixer, 1, error), Status::kIndex);
  EXPECT_EQ(set_level(own.mixer, 1, 1, error), Status::kIndex);
  for (float level : {1.01f, -0.01f, NAN}) {
    EXPECT_EQ(set_level(own.mixer, 0, level, error), Status::kInvalidArgument);
  }
  EXPECT_EQ(own.mixer.reactions[0].running, 0);

  Stroke strokes[kGlareStrokes];
  const auto created = [&](auto&& change) {
    MixInput input(4);
    for (int i = 0; i < 5; ++i) input.add_pose({0}, {1.0f});
    glare_strokes(0, strokes);
    ReactionDesc desc = glare_reaction(strokes);
    input.desc.reactions = {&desc, 1};
    change(desc);
    Mix* mix = nullptr;
    const Status status = create_mix(input.finish(), default_allocator(), mix, error);
    release(mix);
    return status;
  };
  EXPECT_EQ(created([](ReactionDesc&) {}), Status::kOk);
  EXPECT_EQ(created([&](ReactionDesc&) { strokes[4].pose = 5; }), Status::kInvalidArgument);
  EXPECT_EQ(created([&](ReactionDesc&) { strokes[0].attack = -1; }), Status::kInvalidArgument);
  EXPECT_EQ(created([&](ReactionDesc& d) { d.adapted = 2; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](ReactionDesc& d) { d.level_on = 1.5f; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](ReactionDesc& d) { d.level_off = 0.6f; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](ReactionDesc& d) { d.level_on = NAN; }), Status::kInvalidArgument);
  EXPECT_EQ(created([](ReactionDesc& d) { d.level_on = d.level_off = 0; }), Status::kOk);
  EXPECT_EQ(created([&](ReactionDesc& d) { d.cooldown = INT64_MAX; }), Status::kInvalidArgument);
}

TEST(Decay, IsExponentialAndEnds) {
  for (int i = 0; i < 8300; ++i) {
    const float x = static_cast<float>(i) * 0.001f;
    EXPECT_NEAR(decay(x), std::exp(-double{x}), 3e-7) << x;
  }
  EXPECT_EQ(decay(8.4f), 0.0f);
  EXPECT_EQ(decay(INFINITY), 0.0f);
  EXPECT_EQ(decay(NAN), 0.0f);
}

/// Lids that blink below the reaction or over it, and a light.
struct BlinkMix {
  std::vector<uint16_t> lids = {kLidLeft, kLidRight};
  Row amounts = {1, 1};
  MixHandle mix;

  BlinkMix(LayerGroup group, BlendMode mode) {
    MixInput input(kRaw);
    LayerDesc& layer = input.add(mode, LayerSource::kGenerator, group);
    layer.generator = Generator::kBlink;
    layer.period = kTicksPerSecond * 2;
    layer.curves = {lids.data(), 2};
    layer.amounts = {amounts.data(), 2};
    const uint32_t closed = input.add_pose({kLidLeft, kLidRight}, {1.0f, 1.0f});
    for (uint32_t p = 1; p < kGlareStrokes; ++p) input.add_pose({kSquint}, {0.1f});
    Stroke strokes[kGlareStrokes];
    glare_strokes(closed, strokes);
    const ReactionDesc glare = glare_reaction(strokes);
    input.desc.reactions = {&glare, 1};
    mix = make_mix(input);
  }
};

// A light at any phase of a blink: the lids do not open before the reaction has closed them.
TEST(Blinks, DoNotOpenTheLidsWhileAReactionClosesThem) {
  constexpr int64_t kGlareDelay = 60, kGlareAttack = 70;  // milliseconds
  for (LayerGroup group : {LayerGroup::kBase, LayerGroup::kLife}) {
    for (BlendMode mode : {BlendMode::kMax, BlendMode::kScreen, BlendMode::kAdd}) {
      const BlinkMix blinks(group, mode);
      // When the first blink begins.
      OwnMixer watch(blinks.mix);
      int64_t begin = 0;
      while (watch.step(kMillisecond)[kLidLeft] == 0) ++begin;
      int opening = 0;
      for (int64_t phase = -150; phase <= 280; phase += 3) {
        for (int64_t step : {4, 8, 16, 33}) {
          for (float strength : {1.0f, 0.4f}) {
            OwnMixer own(blinks.mix);
            own.step((begin + phase) * kMillisecond);
            Row last = own.step(step * kMillisecond);
            const Row before = last;
            fire(own, kTicksPerSecond, strength);
            const int64_t until = kGlareDelay + kGlareAttack;
            for (int64_t t = step; t <= until; t += step) {
              const Row row = own.step(step * kMillisecond);
              for (uint16_t lid : {kLidLeft, kLidRight}) {
                ASSERT_GE(row[lid], last[lid] - 1e-6f)
                    << "mode " << int(mode) << ", group " << int(group) << ", phase " << phase
                    << ", steps of " << step << ", after " << t << " ms";
              }
              last = row;
            }
            opening += before[kLidLeft] > 0.1f && phase > 100;
            // Then it opens as before.
            for (int64_t t = 0; t < 700; t += step) last = own.step(step * kMillisecond);
            EXPECT_LT(last[kLidLeft], 0.01f) << phase;
          }
        }
      }
      EXPECT_GT(opening, 50) << "blinks that were opening";
    }
  }
}

// A blink goes on in any steps as in small ones.
TEST(Blinks, AreHeldForTheSameTimeInAnySteps) {
  const BlinkMix blinks(LayerGroup::kBase, BlendMode::kMax);
  OwnMixer watch(blinks.mix);
  int64_t begin = 0;
  while (watch.step(kMillisecond)[kLidLeft] == 0) ++begin;
  for (int64_t phase = -20; phase < 240; phase += 20) {
    OwnMixer small(blinks.mix), large(blinks.mix);
    small.step((begin + phase) * kMillisecond);
    large.step((begin + phase) * kMillisecond);
    fire(small, 0);
    fire(large, 0);
    Row fine;
    for (int i = 0; i < 40; ++i) fine = small.step(5 * kMillisecond);
    const Row coarse = large.step(200 * kMillisecond);
    EXPECT_EQ(fine[kLidLeft], coarse[kLidLeft]) << phase;
    EXPECT_EQ(small.mixer.generators[0].next, large.mixer.generators[0].next) << phase;
  }
}

}  // namespace
}  // namespace mien
