// SPDX-License-Identifier: MIT
#include "runtime/mix/guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/support/mix_setup.h"
#include "tests/support/placed_guards.h"

namespace mien {
namespace {

constexpr float kAtOnce = std::numeric_limits<float>::infinity();

/// Curves 2, 0, 1 of a row of four open by 20, 5 and 1 mm; curve 3 closes by 4 mm; the jaw does nothing
/// while curve 1 is 1.
Guard some_guard() {
  Guard guard = {};
  guard.f_on = 10;
  guard.tolerance = 0.5f;
  guard.count = 4;
  const uint16_t curves[] = {2, 0, 3, 1};
  const float gains[] = {20, 5, -4, 1};
  std::copy(curves, curves + 4, guard.curves);
  std::copy(gains, gains + 4, guard.gains);
  guard.pair_count = 1;
  guard.pairs[0] = {0, 3, -20};
  return guard;
}

void ease(const Row& free_row, const Row& protected_row, const Row& back, float max_change,
          Row& held, Row& row) {
  ease_guards(free_row.data(), protected_row.data(), back.data(), static_cast<uint32_t>(row.size()),
              max_change, held.data(), row.data());
}

/// What guards leave of a row when they have the time.
void hold(const std::vector<Guard>& guards, const Row& protected_row, float activation, Row& row) {
  Row held(row.size()), left(row.size());
  const Row back = PlacedGuards(guards).back(protected_row, row, std::max(activation, 0.0f));
  ease(row, protected_row, back, kAtOnce, held, left);
  row = left;
}
void hold(const Guard& guard, const Row& protected_row, float activation, Row& row) {
  hold(std::vector<Guard>{guard}, protected_row, activation, row);
}

TEST(Guard, DistanceIsASumOfCurvesAndOfProductsOfPairs) {
  Guard guard = some_guard();
  guard.rest = 0.25f;
  const Row row = {0.5f, 0.5f, 0.25f, 1};
  EXPECT_FLOAT_EQ(guard_distance(guard, row.data()),
                  0.25f + 20 * 0.25f + 5 * 0.5f - 4 + 0.5f - 20 * 0.25f * 0.5f);
  const PlacedGuards placed({guard});
  EXPECT_FLOAT_EQ(placed.distances(row)[0], guard_distance(guard, row.data()));
}

TEST(Guard, ActivationFallsFromContactToTheRangesEnd) {
  const Guard guard = some_guard();
  float before = 2;
  for (float open : {-0.5f, 0.0f, 0.1f, 0.25f, 0.4f, 0.5f}) {  // curve 2: 20 mm
    const Row row = {0, 0, open, 0};
    const float activation = guard_activation(guard, guard_distance(guard, row.data()));
    if (open <= 0) {
      EXPECT_EQ(activation, 1);
    } else {
      EXPECT_LT(activation, before);
    }
    before = activation;
  }
  EXPECT_EQ(before, 0);
}

TEST(Guard, LeavesRowsAloneThatKeepTheLimit) {
  const Guard guard = some_guard();
  const Row closed = {0, 0, 0, 0.5f};
  const Row row = {0.1f, 0.3f, 0.05f, 0.5f};
  Row held = row;
  hold(guard, closed, 1, held);
  EXPECT_TRUE(same_bits(held, row));
}

TEST(Guard, LeavesEveryRowAloneWhileItIsNotActive) {
  const Guard guard = some_guard();
  const Row closed(4), row = {1, 0.1f, 1, 0};
  for (float activation : {0.0f, -0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    Row held = row;
    hold(guard, closed, activation, held);
    EXPECT_TRUE(same_bits(held, row));
  }
}

TEST(Guard, TakesTheLargestGainsFirstAndNoMoreThanIsNeeded) {
  const Guard guard = some_guard();
  const Row closed(4);
  Row row = {0.2f, 0, 0.5f, 0};  // 11 mm
  hold(guard, closed, 1, row);
  EXPECT_NEAR(guard_distance(guard, row.data()), 0.5, 1e-5);
  EXPECT_EQ(row[2], 0) << "is not enough";
  EXPECT_FLOAT_EQ(row[0], 0.1f);
  Row less = {0.05f, 0, 0.5f, 0};
  hold(guard, closed, 1, less);
  EXPECT_EQ(less[0], 0.05f) << "stays, because curve 2 can make the room";
  EXPECT_NEAR(guard_distance(guard, less.data()), 0.5, 1e-5);
}

TEST(Guard, KeepsWhatHelpsAndWhatAPairHasMadeHarmless) {
  const Guard guard = some_guard();
  const Row sealed = {0, 1, 0, 0};
  Row row = {1, 1, 0.7f, 0.5f};
  hold(guard, sealed, 1, row);
  EXPECT_EQ(row[2], 0.7f) << "the jaw opens nothing while curve 1 seals";
  EXPECT_EQ(row[3], 0.5f);
  EXPECT_LT(row[0], 1);
}

TEST(Guard, MovesCurvesBackThatWereLowered) {
  const Guard guard = some_guard();
  const Row closed = {0.3f, 0, 0, 0.5f};
  Row row = {0.3f, 0, 0, 0};  // what closed is gone: 1.5 mm, of which 0.5 mm are tolerated
  hold(guard, closed, 1, row);
  EXPECT_FLOAT_EQ(row[3], 0.25f);
  EXPECT_EQ(row[0], 0.3f);
}

TEST(Guard, CountsOverlapAsRoom) {
  const Guard guard = some_guard();
  const Row pressed = {0, 0, 0, 1}, touching(4);
  Row over_pressed = {1, 0, 0, 1}, over_touching = {1, 0, 0, 0};
  hold(guard, pressed, 1, over_pressed);
  hold(guard, touching, 1, over_touching);
  EXPECT_NEAR(over_pressed[0], 0.9f, 1e-6);  // 4 mm + 0.5 mm
  EXPECT_NEAR(over_touching[0], 0.1f, 1e-6);
}

TEST(Guard, TakesTheShareThatActivationSays) {
  const Guard guard = some_guard();
  const Row closed(4);
  Row all = {0, 0, 1, 0}, half = all;
  hold(guard, closed, 1, all);
  hold(guard, closed, 0.5f, half);
  EXPECT_FLOAT_EQ(half[2], 0.5f + 0.5f * all[2]);
}

/// Of the left, the middle and the right of a mouth with four controls per half and one in the middle;
/// curve 8 - l is curve l on the other side. Halves are even only by about a tenth, as those of faces.
std::vector<Guard> mouth_guards(float uneven) {
  std::vector<Guard> guards(3);
  const float left[] = {6, 4, 2.5f, -1}, across[] = {0.2f, 0.1f, -0.3f, 0};
  for (uint32_t g = 0; g < 3; ++g) {
    float gains[9];
    for (uint32_t l = 0; l < 4; ++l) {
      const float side = 1 + uneven * (static_cast<float>(l) - 1.5f);
      gains[l] = side * (g == 0 ? left[l] : g == 2 ? across[l] : left[l] / 2);
      gains[8 - l] = (g == 2 ? left[l] : g == 0 ? across[l] : left[l] / 2) / side;
    }
    gains[4] = g == 1 ? 30.0f : 25.0f;
    uint16_t order[9] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    std::stable_sort(order, order + 9, [&gains](uint16_t a, uint16_t b) {
      return std::fabs(gains[a]) > std::fabs(gains[b]);
    });
    Guard& guard = guards[g];
    guard.f_on = 10;
    guard.tolerance = 0.3f;
    guard.count = 9;
    for (uint32_t i = 0; i < 9; ++i) {
      guard.curves[i] = order[i];
      guard.gains[i] = gains[order[i]];
      const bool mirrored = i > 0 && order[i] == 8 - order[i - 1];
      if (mirrored && g == 1) guard.together |= 1u << i;
    }
  }
  return guards;
}

Row mirrored(Row row) {
  std::reverse(row.begin(), row.end());
  return row;
}

TEST(Guard, MirroredRowsGiveMirroredResultsInAnyOrderOfGuards) {
  std::vector<Guard> guards = mouth_guards(0);
  Random random = Random::from_seed(11, 0);
  size_t held_back = 0;
  for (int round = 0; round < 200; ++round) {
    Row closed(9), row(9);
    for (size_t l = 0; l < 9; ++l) {
      closed[l] = round % 2 ? 0.2f * static_cast<float>(random.real()) : 0;
      row[l] = static_cast<float>(random.real());
      if (round % 4 > 1 && l > 4) {  // the same on both sides
        closed[l] = closed[8 - l];
        row[l] = row[8 - l];
      }
    }
    Row one = row, other = mirrored(row), turned = row;
    hold(guards, closed, 1, one);
    hold(guards, mirrored(closed), 1, other);
    std::swap(guards[0], guards[2]);
    hold(guards, closed, 1, turned);
    EXPECT_TRUE(same_bits(one, turned)) << "the order of guards";
    for (size_t l = 0; l < 9; ++l) EXPECT_NEAR(one[l], other[8 - l], 1e-5);
    if (round % 4 > 1) {
      for (size_t l = 0; l < 4; ++l) EXPECT_NEAR(one[l], one[8 - l], 1e-5);
    }
    held_back += !same_bits(one, row);
    for (const Guard& guard : guards) {
      EXPECT_LE(guard_distance(guard, one.data()),
                std::max(guard_distance(guard, closed.data()), 0.0f) + guard.tolerance + 1e-4f);
    }
  }
  EXPECT_GT(held_back, 100u);
}

TEST(Guard, HalvesOfAnUnevenFaceGoBackByAboutTheSame) {
  const std::vector<Guard> guards = mouth_guards(0.05f);
  const Row closed(9);
  for (float smile : {0.3f, 0.6f, 0.9f}) {
    Row row = {smile, smile, smile, 0, 0, 0, smile, smile, smile};
    hold(guards, closed, 1, row);
    for (size_t l = 0; l < 3; ++l) EXPECT_NEAR(row[l], row[8 - l], 0.05f) << l << " of " << smile;
  }
}

TEST(Guard, CountsPairsAmongCurvesThatGoTogetherInFull) {
  for (float gain : {6.0f, -6.0f}) {
    Guard guard = {};
    guard.f_on = 10;
    guard.count = 2;
    for (uint16_t i = 0; i < 2; ++i) {
      guard.curves[i] = i;
      guard.gains[i] = 10;
    }
    guard.pair_count = 1;
    guard.pairs[0] = {0, 1, gain};
    guard.together = 2;
    guard.tolerance = 2;
    const Row closed(2);
    Row row = {0.5f, 0.5f};
    hold(guard, closed, 1, row);
    EXPECT_LE(guard_distance(guard, row.data()), 2 + 1e-5f);
    EXPECT_GT(guard_distance(guard, row.data()), gain > 0 ? 1.5f : 0.5f);
    EXPECT_EQ(row[0], row[1]);
  }
}

TEST(Guard, EasesAtItsSpeedAndEndsAtTheExactRow) {
  const Row free_row = {0.8f, 0.3f}, protected_row = {0.1f, 0.3f}, all = {0.8f - 0.1f, 0},
            none = {0, 0};
  Row held(2), row(2);
  float before = free_row[0];
  for (int step = 0; step < 10; ++step) {
    ease(free_row, protected_row, all, 0.1f, held, row);
    EXPECT_LE(before - row[0], 0.1f + 1e-6f);
    EXPECT_EQ(row[1], 0.3f);
    before = row[0];
  }
  EXPECT_EQ(before, 0.1f) << "the bits of the protected row";
  for (int step = 0; step < 10; ++step) {
    ease(free_row, protected_row, none, 0.1f, held, row);
    EXPECT_LE(row[0] - before, 0.1f + 1e-6f);
    before = row[0];
  }
  EXPECT_EQ(before, 0.8f);
  EXPECT_EQ(held[0], 0);
}

TEST(Guard, EasingLeavesBitsWhereNothingIsHeld) {
  const Row free_row = {0.8f, -0.0f, -0.7f}, protected_row = {0, 0, -0.7f}, none(3);
  Row row(3), held(3);
  ease(free_row, protected_row, none, kAtOnce, held, row);
  EXPECT_TRUE(same_bits(row, free_row));
}

TEST(Guard, EasingNeverPassesTheProtectedRow) {
  // Held far back; then what is held disappears.
  Row held = {0.6f}, row(1);
  const Row protected_row = {0.2f}, none(1);
  for (float free_value : {0.3f, 0.2f, 0.1f}) {
    ease({free_value}, protected_row, none, 0.05f, held, row);
    EXPECT_GE(row[0], std::min(free_value, 0.2f));
    EXPECT_LE(row[0], std::max(free_value, 0.2f));
  }
  EXPECT_LE(held[0], 0);
}

// In a mixer --------------------------------------------------------------------------------------

constexpr int64_t kGuardStep = kTicksPerSecond / 60;

/// Speech and an emotion as poses, with one guard.
struct GuardedMix {
  Guard guard = some_guard();
  MixInput input{4};
  MixHandle mix;

  explicit GuardedMix(bool needs_speech = false) {
    guard.needs_speech = needs_speech;
    input.add(BlendMode::kOverride, LayerSource::kPoses, LayerGroup::kSpeech).pose_count = 1;
    LayerDesc& emotion = input.add(BlendMode::kScreen, LayerSource::kPoses, LayerGroup::kEmotion);
    emotion.first_pose = input.add_pose({3}, {0.5f}) + 1;
    emotion.pose_count = 1;
    input.add_pose({0, 2}, {0.25f, 0.6f});
    input.desc.guards = {&guard, 1};
    mix = make_mix(input);
  }
};

TEST(GuardOfAMixer, HoldsAnEmotionBackWithinAFewSteps) {
  const GuardedMix made;
  OwnMixer own(made.mix);
  own.pose(0, 0, 1);
  own.step(kGuardStep);
  own.pose(1, 0, 1);
  Row row = own.step(kGuardStep), before = row;
  EXPECT_FLOAT_EQ(row[2], 0.6f - 0.2f) << "12 per second";
  for (int step = 0; step < 10; ++step) {
    row = own.step(kGuardStep);
    EXPECT_LE(std::abs(row[2] - before[2]), 0.2001f);
    before = row;
  }
  EXPECT_EQ(row[3], 0.5f) << "speech";
  EXPECT_NEAR(guard_distance(made.guard, row.data()), 0.5f, 1e-5f);
  EXPECT_TRUE(same_bits(own.step(0), row)) << "without time nothing moves";
  // It comes back when speech is over.
  Error error;
  EXPECT_EQ(set_guard(own.mixer, 0, 0, error), Status::kOk);
  for (int step = 0; step < 10; ++step) row = own.step(kGuardStep);
  EXPECT_EQ(row[0], 0.25f);
  EXPECT_EQ(row[2], 0.6f);
}

TEST(GuardOfAMixer, TellsWhatItDid) {
  const GuardedMix made;
  OwnMixer own(made.mix);
  own.pose(0, 0, 1);
  own.pose(1, 0, 1);
  Row row;
  for (int step = 0; step < 20; ++step) row = own.step(kGuardStep);
  GuardState state = {};
  Error error;
  ASSERT_EQ(guard_state(own.mixer, 0, state, error), Status::kOk);
  ASSERT_EQ(state.curves.count, made.guard.count);
  for (uint32_t i = 0; i < made.guard.count; ++i) EXPECT_EQ(state.curves[i], made.guard.curves[i]);
  // Curves 0 and 2 as the emotion screens them over speech, which leaves both at 0.
  Row wanted = row;
  wanted[0] = 0.25f;
  wanted[2] = 0.6f;
  const Row speech = [&] {
    OwnMixer alone(made.mix);
    alone.pose(0, 0, 1);
    return alone.step(kGuardStep);
  }();
  EXPECT_FLOAT_EQ(state.protected_distance, guard_distance(made.guard, speech.data()));
  EXPECT_FLOAT_EQ(state.wanted, guard_distance(made.guard, wanted.data()));
  EXPECT_FLOAT_EQ(state.distance, guard_distance(made.guard, row.data()));
  EXPECT_EQ(state.limit, std::max(state.protected_distance, 0.0f) + made.guard.tolerance);
  EXPECT_EQ(state.activation, guard_activation(made.guard, state.protected_distance));
  EXPECT_GT(state.wanted, state.limit + 0.1f);
  EXPECT_NEAR(state.distance, state.limit, 1e-5f);
  EXPECT_EQ(set_guard(own.mixer, 0, 0.25f, error), Status::kOk);
  ASSERT_EQ(guard_state(own.mixer, 0, state, error), Status::kOk);
  EXPECT_EQ(state.activation, 0.25f);
  EXPECT_EQ(guard_state(own.mixer, 1, state, error), Status::kIndex);
}

TEST(GuardOfAMixer, ThatNeedsSpeechIsAsActiveAsItsLayers) {
  const GuardedMix made(true);
  OwnMixer own(made.mix);
  own.weight(0, 0);
  own.pose(1, 0, 1);
  Row row;
  for (int step = 0; step < 20; ++step) row = own.step(kGuardStep);
  EXPECT_EQ(row[2], 0.6f) << "silent, although the lips touch";
  own.weight(0, 1);
  for (int step = 0; step < 20; ++step) row = own.step(kGuardStep);
  EXPECT_LE(guard_distance(made.guard, row.data()), 0.5001f);
}

TEST(GuardOfAMixer, StaysOutOfAMixerThatKeepsTheLimit) {
  const GuardedMix guarded;
  GuardedMix free;
  free.input.desc.guards = {};
  const MixHandle without = make_mix(free.input);
  OwnMixer a(guarded.mix), b(without);
  for (OwnMixer* own : {&a, &b}) {
    own->pose(0, 0, 1);
    own->pose(1, 0, 0.15f);
  }
  for (int step = 0; step < 5; ++step)
    EXPECT_TRUE(same_bits(a.step(kGuardStep), b.step(kGuardStep)));
}

TEST(GuardOfAMixer, IsRefusedWithPairsThatDoNotFit) {
  const auto status_of = [](GuardPair pair, uint32_t count) {
    GuardedMix made;
    made.guard.pairs[0] = pair;
    made.guard.pair_count = count;
    Mix* mix = nullptr;
    Error error;
    const Status status = create_mix(made.input.finish(), default_allocator(), mix, error);
    EXPECT_EQ(mix, nullptr);
    return status;
  };
  EXPECT_EQ(status_of({0, 4, 1}, 1), Status::kInvalidArgument);
  EXPECT_EQ(status_of({4, 0, 1}, 1), Status::kInvalidArgument);
  EXPECT_EQ(status_of({2, 2, 1}, 1), Status::kInvalidArgument);
  EXPECT_EQ(status_of({0, 1, NAN}, 1), Status::kInvalidArgument);
  EXPECT_EQ(status_of({0, 1, 1}, kMaxGuardPairs + 1), Status::kInvalidArgument);
}

// Clips that say when lips are closed -------------------------------------------------------------

/// Speech as a clip whose row never opens, so that the distance alone would hold all the time; an
/// emotion that opens.
struct LabeledSpeech {
  Guard guard = some_guard();
  MixInput input{4};
  MixHandle mix;
  BoundClip labeled, plain;

  static ClipInput speech(std::vector<ClipInput::Event> events) {
    Curves curves(1, 120);
    ClipInput made(std::move(curves));
    made.names = {"CTRL_expressions.control3"};
    made.events = std::move(events);
    return made;
  }
  explicit LabeledSpeech(StandardGuard kind = StandardGuard::kLipsCenter)
      : labeled(speech({{1000 * kMillisecond, "close:lips", 0.1f}}), 4, {3}),
        plain(speech({}), 4, {3}) {
    guard.needs_speech = 1;
    guard.kind = static_cast<uint32_t>(kind);
    input.add(BlendMode::kOverride, LayerSource::kClip, LayerGroup::kSpeech);
    LayerDesc& emotion = input.add(BlendMode::kScreen, LayerSource::kPoses, LayerGroup::kEmotion);
    emotion.pose_count = 1;
    emotion.first_pose = input.add_pose({0, 2}, {0.25f, 0.6f});
    input.desc.guards = {&guard, 1};
    mix = make_mix(input);
  }
  /// Of the guard, at some milliseconds.
  static float activation(OwnMixer& own) {
    GuardState state = {};
    Error error;
    EXPECT_EQ(guard_state(own.mixer, 0, state, error), Status::kOk);
    return state.activation;
  }
};

TEST(GuardOfAMixer, HoldsWhatAClipSaysAndNothingElseOfIt) {
  const LabeledSpeech made;
  OwnMixer own(made.mix);
  own.play(0, made.labeled);
  own.pose(1, 0, 1);
  for (int step = 1; step <= 110; ++step) {
    const Row row = own.step(kGuardStep);
    const int64_t ms = step * 1000 / 60;
    if (ms < 870 || ms > 1290) {
      EXPECT_EQ(row[2], 0.6f) << ms << ": a pause, in which joy may open the lips";
      EXPECT_EQ(LabeledSpeech::activation(own), 0);
    }
    if (ms < 1000 || ms > 1100) continue;
    EXPECT_EQ(LabeledSpeech::activation(own), 1) << ms;
    EXPECT_NEAR(guard_distance(made.guard, row.data()), 0.5f, 1e-5f) << "in time";
  }
}

TEST(GuardOfAMixer, OfAnotherKindOrClipIsClosedByTheDistance) {
  for (StandardGuard kind : {StandardGuard::kLipToTeeth, StandardGuard::kTeeth,
                             StandardGuard::kLidsLeft, StandardGuard(99)}) {
    const LabeledSpeech made(kind);
    OwnMixer own(made.mix);
    own.play(0, made.labeled);
    own.step(kGuardStep);
    EXPECT_EQ(LabeledSpeech::activation(own), 1) << static_cast<int>(kind);
  }
  const LabeledSpeech made;
  OwnMixer own(made.mix);
  own.play(0, made.plain);
  own.step(kGuardStep);
  EXPECT_EQ(LabeledSpeech::activation(own), 1) << "a clip that says nothing";
}

TEST(GuardOfAMixer, GoesFromOneClipToTheOtherAsACrossfadeDoes) {
  const LabeledSpeech made;
  OwnMixer own(made.mix);
  own.play(0, made.plain);
  own.step(kGuardStep);
  own.play(0, made.labeled, Transition::kCrossfade, 400 * kMillisecond);
  float before = 1;
  for (int ms = 4; ms <= 400; ms += 4) {
    own.step(4 * kMillisecond);
    const float now = LabeledSpeech::activation(own);
    EXPECT_LE(now, before + 1e-6f);
    EXPECT_GE(now, before - 0.02f);
    before = now;
  }
  EXPECT_EQ(before, 0);
}

TEST(GuardOfAMixer, OfALabeledClipIsAFunctionOfTimeAndOfTheWeight) {
  const LabeledSpeech made;
  OwnMixer fine(made.mix), coarse(made.mix);
  for (OwnMixer* own : {&fine, &coarse}) {
    own->play(0, made.labeled);
    own->weight(0, 0.5f);
  }
  for (int step = 0; step < 60; ++step) {
    for (int k = 0; k < 4; ++k) fine.step(kGuardStep / 4);
    coarse.step(kGuardStep);
    EXPECT_EQ(LabeledSpeech::activation(fine), LabeledSpeech::activation(coarse));
  }
  EXPECT_EQ(LabeledSpeech::activation(fine), 0.5f);
}

}  // namespace
}  // namespace mien
