// SPDX-License-Identifier: MIT
#include "runtime/anim/closures.h"

#include <gtest/gtest.h>

#include "tests/support/made_clip.h"

namespace mien {
namespace {

constexpr int64_t kMs = kTicksPerSecond / 1000;

/// Two seconds at 60 frames a second, with events.
struct Labeled {
  MadeClip made;
  Closures closures;

  explicit Labeled(std::vector<ClipInput::Event> events, bool wraps = false)
      : made([&] {
          ClipInput input(Curves(1, 120));
          input.events = std::move(events);
          input.wraps = wraps;
          return input;
        }()),
        closures(find_closures(made.clip)) {}

  float at(int64_t tick, uint32_t closure = kLipsClosed, bool wraps = false) const {
    float closed[kClosures];
    closures_at(made.clip, closures, tick, wraps, closed);
    return closed[closure];
  }
};

TEST(Closures, AreFoundByTheirExactNames) {
  const Labeled none({{0, "m", 1}, {5, "close:lip", 1}, {6, "Close:lips", 1}});
  EXPECT_FALSE(none.closures.any());
  const Labeled some({{0, "m", 1}, {5, "close:teeth", 1}, {6, "close:lip-to-teeth", 1}});
  EXPECT_FALSE(some.closures.has(kLipsClosed));
  EXPECT_TRUE(some.closures.has(kLipAtTeeth));
  EXPECT_TRUE(some.closures.has(kTeethClosed));
  // A channel of such a name is none.
  ClipInput channel(Curves(1, 2));
  channel.names = {"close:lips"};
  EXPECT_FALSE(find_closures(MadeClip(std::move(channel)).clip).any());
}

TEST(Closures, AreClosedForTheirTimeAndRampAroundIt) {
  const Labeled clip({{1000 * kMs, "close:lips", 0.08f}, {1000 * kMs, "other", 0.5f}});
  for (int64_t ms : {1000, 1040, 1080}) EXPECT_EQ(clip.at(ms * kMs), 1) << ms;
  EXPECT_EQ(clip.at(875 * kMs), 0);
  EXPECT_EQ(clip.at(1205 * kMs + kMs), 0);
  EXPECT_NEAR(clip.at(1000 * kMs - kClosureRamp / 2), 0.5f, 1e-6f);
  EXPECT_NEAR(clip.at(1080 * kMs + kClosureRamp / 2), 0.5f, 1e-3f);
  EXPECT_EQ(clip.at(1000 * kMs, kLipAtTeeth), 0);
  // No step is steeper than 1.5 of the ramp: the speed that guards may have.
  const int64_t dt = kMs;
  float before = 0;
  for (int64_t tick = 800 * kMs; tick < 1300 * kMs; tick += dt) {
    const float now = clip.at(tick);
    EXPECT_LE(std::abs(now - before), 12.001f / 1000 + 1e-6f);
    before = now;
  }
}

TEST(Closures, OfSeveralEventsJoinWithoutAJump) {
  const Labeled clip({{1000 * kMs, "close:lips", 0.05f}, {1100 * kMs, "close:lips", 0.05f}});
  for (int64_t ms = 1050; ms <= 1100; ms += 5) EXPECT_GT(clip.at(ms * kMs), 0.95f);
  float before = clip.at(850 * kMs);
  for (int64_t ms = 850; ms < 1300; ++ms) {
    EXPECT_LE(std::abs(clip.at(ms * kMs) - before), 0.02f) << ms;
    before = clip.at(ms * kMs);
  }
}

TEST(Closures, OfALoopReachAcrossItsEnds) {
  const Labeled start({{0, "close:lips", 0.1f}}, true);
  EXPECT_EQ(start.at(0, kLipsClosed, true), 1);
  EXPECT_NEAR(start.at(2000 * kMs - kClosureRamp / 2, kLipsClosed, true), 0.5f, 1e-6f);
  EXPECT_EQ(start.at(2000 * kMs - kClosureRamp / 2, kLipsClosed, false), 0);
  const Labeled end({{1950 * kMs, "close:lips", 0.1f}}, true);
  EXPECT_EQ(end.at(50 * kMs, kLipsClosed, true), 1) << "goes on after the loop";
  EXPECT_EQ(end.at(50 * kMs, kLipsClosed, false), 0);
  EXPECT_GT(end.at(100 * kMs, kLipsClosed, true), 0);
}

TEST(Closures, TakeAnyValue) {
  const Labeled clip({{100 * kMs, "close:lips", -1},
                      {400 * kMs, "close:teeth", 1e30f},
                      {700 * kMs, "close:lip-to-teeth", 0}});
  EXPECT_EQ(clip.at(100 * kMs), 1) << "no time, but its ramps";
  EXPECT_EQ(clip.at(101 * kMs + kClosureRamp), 0);
  EXPECT_EQ(clip.at(700 * kMs, kLipAtTeeth), 1);
  EXPECT_EQ(clip.at(400 * kMs + kLongestClosure, kTeethClosed), 1);
  EXPECT_EQ(clip.at(400 * kMs + kLongestClosure + kClosureRamp, kTeethClosed), 0);
}

TEST(Closures, LookAtTheLastEventsOnly) {
  std::vector<ClipInput::Event> events = {{500 * kMs, "close:lips", 0.5f}};
  for (uint32_t i = 0; i + 1 < kMaxNearEvents; ++i) events.push_back({600 * kMs, "word", 0});
  EXPECT_EQ(Labeled(events).at(700 * kMs), 1);
  events.push_back({600 * kMs, "word", 0});
  EXPECT_EQ(Labeled(events).at(700 * kMs), 0) << "one more: work stays bounded";
}

}  // namespace
}  // namespace mien
