// SPDX-License-Identifier: MIT
// Gazes as a generator: saccades, pursuit, what is left for the head, blinks. The controls that turn
// eyes are tested with their table in tests/probe.
#include "runtime/mix/gaze.h"

#include <cmath>

#include "tests/support/mix_setup.h"

namespace mien {
namespace {

constexpr uint32_t kControls = 10;  // eight of the eyes, two lids
constexpr uint16_t kTarget[5] = {10, 11, 12, 13, 14};
constexpr float kAmounts[5] = {0, 0, 0, 1, 1};

/// Both eyes turn by up to 45 degrees in all directions.
GazeTable table() {
  GazeTable made = {};
  for (uint16_t e = 0; e < 2; ++e) {
    made.eyes[e].center[0] = e == 0 ? 30.0f : -30.0f;
    for (uint16_t d = 0; d < 4; ++d) {
      made.eyes[e].curves[d] = static_cast<uint16_t>(e * 4 + d);
      for (uint32_t i = 0; i < kGazeSteps; ++i) {
        made.eyes[e].tangents[d][i] = static_cast<float>(i + 1) / kGazeSteps;
      }
    }
  }
  return made;
}

struct Gazing {
  MixInput input{kControls, 5};
  GazeTable gaze = table();
  MixHandle mix;

  explicit Gazing(bool blinks = false, const float (&amounts)[5] = kAmounts) {
    static const uint16_t lids[2] = {8, 9};
    static const float ones[2] = {1, 1};
    LayerDesc& layer = input.add(BlendMode::kOverride, LayerSource::kGenerator, LayerGroup::kLife);
    layer.generator = Generator::kGaze;
    layer.curves = {kTarget, 5};
    layer.amounts = {amounts, 5};
    layer.period = kTicksPerSecond / 4;
    if (blinks) {
      LayerDesc& blink = input.add(BlendMode::kMax, LayerSource::kGenerator, LayerGroup::kLife);
      blink.generator = Generator::kBlink;
      blink.curves = {lids, 2};
      blink.amounts = {ones, 2};
      blink.period = 1000 * kTicksPerSecond;
    }
    input.desc.gaze = &gaze;
    mix = make_mix(input);
  }
};

void look(OwnMixer& own, float left, float up, float front) {
  Error error;
  const float place[3] = {left, up, front};
  for (uint32_t k = 0; k < 3; ++k) {
    EXPECT_EQ(set_variable(own.mixer, k, place[k], error), Status::kOk);
  }
}

Row eyes_at(float left, float up, float front) {
  Row row(kControls);
  const float place[3] = {left, up, front};
  look_at(table(), place, row.data(), nullptr);
  row.resize(8);
  return row;
}

Row eyes(const Row& row) { return {row.begin(), row.begin() + 8}; }

TEST(Gazes, BeginAtTheirTarget) {
  const Gazing gazing;
  OwnMixer own(gazing.mix);
  look(own, 200, 100, 1000);
  EXPECT_TRUE(same_bits(eyes(own.step(kMillisecond)), eyes_at(200, 100, 1000)));
}

TEST(Gazes, JumpInASaccadeOfTheRightLengthAndNeverBack) {
  const Gazing gazing;
  OwnMixer own(gazing.mix);
  look(own, 0, 0, 1000);
  own.step(kMillisecond);
  look(own, 176.327f, 0, 1000);  // 10 degrees: 43 ms
  float before = own.step(kMillisecond)[kGazeLeft];
  EXPECT_EQ(before, eyes_at(0, 0, 1000)[kGazeLeft]) << "it begins at this step";
  for (int ms = 1; ms < 43; ++ms) {
    const float now = own.step(kMillisecond)[kGazeLeft];
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_LT(before, eyes_at(176.327f, 0, 1000)[kGazeLeft]);
  EXPECT_TRUE(same_bits(eyes(own.step(kMillisecond)), eyes_at(176.327f, 0, 1000)));
}

TEST(Gazes, KeepTheirGoalDuringASaccade) {
  const Gazing gazing;
  OwnMixer own(gazing.mix), calm(gazing.mix);
  for (OwnMixer* each : {&own, &calm}) {
    look(*each, 0, 0, 1000);
    each->step(kMillisecond);
    look(*each, 300, 0, 1000);
    each->step(kMillisecond);
  }
  look(own, -300, 0, 1000);
  for (int ms = 0; ms < 50; ++ms) {
    EXPECT_TRUE(same_bits(eyes(own.step(kMillisecond)), eyes(calm.step(kMillisecond))));
  }
  for (int ms = 0; ms < 200; ++ms) own.step(kMillisecond);
  EXPECT_TRUE(same_bits(eyes(own.step(kMillisecond)), eyes_at(-300, 0, 1000)));
}

TEST(Gazes, PursueWhatMovesSlowly) {
  const Gazing gazing;
  OwnMixer own(gazing.mix);
  for (int frame = 0; frame < 100; ++frame) {  // 20 degrees a second
    const float left = static_cast<float>(frame) * 1000 * 0.35f / 60;
    look(own, left, 0, 1000);
    EXPECT_TRUE(same_bits(eyes(own.step(kTicksPerSecond / 60)), eyes_at(left, 0, 1000)));
  }
}

TEST(Gazes, PursueUpTo30DegreesASecondAndJumpAboveThat) {
  const Gazing gazing;
  for (float degrees : {29.0f, 31.0f}) {  // a second
    OwnMixer own(gazing.mix);
    look(own, 0, 0, 1000);
    own.step(kTicksPerSecond / 60);
    const float left = 1000 * degrees * 0.01745329f / 60;
    look(own, left, 0, 1000);
    const float shown = degrees < 30 ? left : 0;
    EXPECT_TRUE(same_bits(eyes(own.step(kTicksPerSecond / 60)), eyes_at(shown, 0, 1000)))
        << degrees;
  }
}

TEST(Gazes, LeaveToTheHeadWhatEyesDoNotReach) {
  const Gazing gazing;
  OwnMixer own(gazing.mix);
  look(own, 0, -2000, 1000);
  const Row row = own.step(kMillisecond);
  EXPECT_EQ(row[kTarget[3]], 0);
  EXPECT_NEAR(row[kTarget[4]], -1, 1e-3);
  look(own, 0, 0, 1000);
  own.step(kMillisecond);
  EXPECT_EQ(own.step(kTicksPerSecond)[kTarget[4]], 0);
}

TEST(Gazes, JitterByAsMuchAsTheyAreTold) {
  const float amounts[5] = {0.5f, 0, 0, 0, 0};
  const Gazing gazing(false, amounts);
  OwnMixer own(gazing.mix, 3);
  look(own, 100, 0, 1000);
  double least = 1, most = 0;
  for (int ms = 0; ms < 20000; ms += 10) {
    const double left = own.step(10 * kMillisecond)[kGazeLeft];
    least = std::min(least, left);
    most = std::max(most, left);
  }
  EXPECT_GT(most - least, 0.3 * 0.01745);
  EXPECT_LT(most - least, 1.05 * 0.01745);
}

TEST(Gazes, BlinkWithLargeShiftsOnly) {
  const Gazing gazing(true);
  const auto largest_closure = [&](float left) {
    OwnMixer own(gazing.mix);
    look(own, 0, 0, 1000);
    own.step(kTicksPerSecond);
    look(own, left, 0, 1000);
    float largest = 0;
    for (int ms = 0; ms < 400; ++ms) largest = std::max(largest, own.step(kMillisecond)[8]);
    // Another one at once does not blink again.
    look(own, 0, 0, 1000);
    for (int ms = 0; ms < 90; ++ms) EXPECT_EQ(own.step(kMillisecond)[8], 0.0f);
    return largest;
  };
  EXPECT_EQ(largest_closure(300), 0.0f);  // 17 degrees
  EXPECT_EQ(largest_closure(400), 1.0f);  // 22 degrees
}

TEST(Gazes, DoNotDependOnTheDivisionOfTimeWhileTheyRest) {
  const Gazing gazing(true);
  OwnMixer coarse(gazing.mix), fine(gazing.mix);
  for (int at : {0, 1, 2, 3}) {
    for (OwnMixer* each : {&coarse, &fine}) look(*each, at % 2 == 0 ? 0 : 500, 50, 1000);
    coarse.step(0);
    fine.step(0);
    for (int step = 0; step < 10; ++step) {
      for (int part = 0; part < 4; ++part) fine.step(4 * kMillisecond);
      EXPECT_TRUE(same_bits(coarse.step(16 * kMillisecond), fine.step(0)));
    }
  }
}

TEST(Gazes, GoOnFromASnapshot) {
  const Gazing gazing(true);
  OwnMixer own(gazing.mix, 1), other(gazing.mix, 2);
  look(own, 0, 0, 1000);
  own.step(kMillisecond);
  look(own, 500, 0, 1000);
  own.step(10 * kMillisecond);
  std::vector<uint8_t> bytes(snapshot_size(*gazing.mix));
  Error error;
  ASSERT_EQ(take_snapshot(own.mixer, {bytes.data(), bytes.size()}, error), Status::kOk);
  ASSERT_EQ(restore_snapshot(other.mixer, {bytes.data(), bytes.size()}, {}, error), Status::kOk)
      << error.message;
  for (int ms = 0; ms < 300; ++ms) {
    ASSERT_TRUE(same_bits(own.step(kMillisecond), other.step(kMillisecond)));
  }
}

TEST(Gazes, TakeNoPlaceThatIsNone) {
  const Gazing gazing;
  OwnMixer own(gazing.mix);
  look(own, 1e30f, 0, 1000);
  for (float value : own.step(kMillisecond)) EXPECT_TRUE(std::isfinite(value) || value > 1e29f);
}

TEST(Gazes, AreRefusedIfTheyAreWrong) {
  const auto created = [](auto&& change) {
    MixInput input(kControls, 5);
    GazeTable gaze = table();
    LayerDesc& layer = input.add(BlendMode::kOverride, LayerSource::kGenerator, LayerGroup::kLife);
    layer.generator = Generator::kGaze;
    layer.curves = {kTarget, 5};
    layer.amounts = {kAmounts, 5};
    layer.period = 1;
    input.desc.gaze = &gaze;
    change(input, gaze);
    Mix* mix = nullptr;
    Error error;
    const Status status = create_mix(input.finish(), default_allocator(), mix, error);
    release(mix);
    return status;
  };
  EXPECT_EQ(created([](MixInput&, GazeTable&) {}), Status::kOk);
  EXPECT_EQ(created([](MixInput& i, GazeTable&) { i.desc.gaze = nullptr; }),
            Status::kInvalidArgument);
  EXPECT_EQ(created([](MixInput& i, GazeTable&) {
              i.layers[0].curves = {kTarget, 4};
              i.layers[0].amounts = {kAmounts, 4};
            }),
            Status::kInvalidArgument);
  EXPECT_EQ(created([](MixInput& i, GazeTable&) { i.layers.push_back(i.layers[0]); }),
            Status::kInvalidArgument);
  EXPECT_EQ(created([](MixInput&, GazeTable& g) { g.eyes[1].curves[2] = kControls; }),
            Status::kInvalidArgument);
}

}  // namespace
}  // namespace mien
