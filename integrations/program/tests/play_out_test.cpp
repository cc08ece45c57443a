// SPDX-License-Identifier: MIT
#include "integrations/program/live/play_out.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace mien::live {
namespace {

constexpr int64_t kSecond = 705600000, kFrame = kSecond / 60, kDelay = kSecond / 20;
using Arrival = PlayOut::Arrival;

Arrival add(PlayOut& play_out, int64_t time, int64_t now) {
  const auto value = static_cast<float>(time / kFrame);
  return play_out.add(time, now, &value, 1);
}

/// Numbers of the frames that are handed on at `now`.
std::vector<int> taken(PlayOut& play_out, int64_t now) {
  std::vector<int> frames;
  int64_t time = 0;
  std::vector<float> row;
  while (play_out.take(now, time, row)) frames.push_back(static_cast<int>(row[0]));
  return frames;
}

TEST(PlayOut, RowsComeAsTheyArePlayedOneAhead) {
  PlayOut play_out(kDelay, kSecond);
  EXPECT_TRUE(taken(play_out, 0).empty());
  for (int k = 0; k < 6; ++k) EXPECT_EQ(add(play_out, k * kFrame, k * kFrame), Arrival::kKept);
  // Played now: 2 frames after the first one. 3 is there to interpolate to.
  EXPECT_EQ(taken(play_out, 5 * kFrame), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(taken(play_out, 5 * kFrame).empty());
  EXPECT_EQ(taken(play_out, 6 * kFrame), (std::vector<int>{4}));
}

TEST(PlayOut, DisorderWithinTheDelayIsPutInOrder) {
  PlayOut play_out(kDelay, kSecond);
  for (int k : {0, 2, 1, 4, 3}) EXPECT_EQ(add(play_out, k * kFrame, 4 * kFrame), Arrival::kKept);
  std::vector<int> all;
  for (int f = 4; f < 12; ++f) {
    for (int k : taken(play_out, f * kFrame)) all.push_back(k);
  }
  EXPECT_EQ(all, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(PlayOut, ARowCountsOnceAndNotTooLate) {
  PlayOut play_out(kDelay, kSecond);
  add(play_out, 0, 0);
  EXPECT_EQ(add(play_out, 0, 1), Arrival::kTwice);
  add(play_out, 2 * kFrame, 2 * kFrame);
  EXPECT_EQ(add(play_out, 2 * kFrame, 2 * kFrame), Arrival::kTwice);
  EXPECT_EQ(taken(play_out, 3 * kFrame), (std::vector<int>{0, 2}));
  EXPECT_EQ(add(play_out, 2 * kFrame, 4 * kFrame), Arrival::kTwice);
  EXPECT_EQ(add(play_out, 1 * kFrame, 4 * kFrame), Arrival::kLate);
}

TEST(PlayOut, JitterDoesNotMoveTheTimesOfRows) {
  PlayOut play_out(kDelay, kSecond);
  std::mt19937 random(3);
  int64_t last = 0, time = 0;
  std::vector<float> row;
  for (int k = 0; k < 600; ++k) {
    // The clock of the sender reads an hour more.
    const int64_t sent = 3600 * kSecond + k * kFrame;
    const auto jitter = static_cast<int64_t>(random() % static_cast<uint32_t>(kDelay));
    const float value = 0;
    play_out.add(sent, k * kFrame + (k % 40 == 0 ? 0 : jitter), &value, 1);
    while (play_out.take(k * kFrame, time, row)) {
      if (k > 60) {
        EXPECT_NEAR(static_cast<double>(time - last), static_cast<double>(kFrame),
                    0.002 * static_cast<double>(kSecond));
      }
      last = time;
    }
  }
  EXPECT_GT(last, 590 * kFrame);
}

TEST(PlayOut, AStrayPacketIsLeftOutAndANewBeginningIsNot) {
  PlayOut play_out(kDelay, kSecond);
  add(play_out, 1000 * kSecond, 0);
  EXPECT_EQ(add(play_out, 0, kFrame), Arrival::kStrange);
  EXPECT_EQ(add(play_out, 2000 * kSecond, kFrame), Arrival::kStrange);
  EXPECT_EQ(add(play_out, 1000 * kSecond + kFrame, kFrame), Arrival::kKept);
  // After a second of silence the sender may have begun anew.
  EXPECT_EQ(taken(play_out, 4 * kFrame).size(), 2u);
  EXPECT_EQ(add(play_out, 0, 2 * kSecond), Arrival::kKept);
  EXPECT_EQ(add(play_out, kFrame, 2 * kSecond + kFrame), Arrival::kKept);
  EXPECT_EQ(taken(play_out, 3 * kSecond), (std::vector<int>{0, 1}));
}

TEST(PlayOut, AFloodIsBounded) {
  PlayOut play_out(kDelay, kSecond);
  int kept = 0;
  for (int k = 0; k < 1000; ++k) {
    if (add(play_out, k * (kFrame / 32), 0) == Arrival::kKept) ++kept;
  }
  EXPECT_EQ(kept, 256);
}

TEST(PlayOut, AClockThatDriftsIsFollowed) {
  PlayOut play_out(kDelay, kSecond);
  int64_t time = 0, lag = 0;
  std::vector<float> row;
  // The sender is slow by 0.1 ms a second.
  for (int64_t k = 0; k < 60 * 600; ++k) {
    const int64_t now = k * kFrame;
    const float value = 0;
    ASSERT_EQ(play_out.add(now - now / 10000, now, &value, 1), Arrival::kKept);
    while (play_out.take(now, time, row)) lag = now - time;
  }
  EXPECT_LT(lag, kDelay + 2 * kFrame);
}

}  // namespace
}  // namespace mien::live
