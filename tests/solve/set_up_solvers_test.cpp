// SPDX-License-Identifier: MIT
// The numbers of solvers: what is refused, and the form that steps use.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "runtime/solve/solvers.h"

namespace mien {
namespace {

void expect_vector(const float (&v)[3], float x, float y, float z) {
  EXPECT_FLOAT_EQ(v[0], x);
  EXPECT_FLOAT_EQ(v[1], y);
  EXPECT_FLOAT_EQ(v[2], z);
}

constexpr float kNan = NAN, kInfinity = HUGE_VALF;

TEST(SetUpSolvers, DirectionsGetLengthOneOrTheirDefault) {
  AimSolver aim;
  const float axis[] = {0, 0, 4}, zero[] = {0, 0, 0}, up[] = {3, 4, 0};
  memcpy(aim.axis, axis, sizeof(axis));
  memcpy(aim.up_axis, zero, sizeof(zero));
  memcpy(aim.up, zero, sizeof(zero));
  EXPECT_EQ(set_up(aim, 0), nullptr);
  expect_vector(aim.axis, 0, 0, 1);
  expect_vector(aim.up_axis, 0, 0, 0);
  expect_vector(aim.up, 0, 1, 0);
  EXPECT_EQ(aim.cone_cosine, -1);
  memcpy(aim.up, up, sizeof(up));
  EXPECT_EQ(set_up(aim, 60), nullptr);
  expect_vector(aim.up, 0.6f, 0.8f, 0);
  EXPECT_FLOAT_EQ(aim.cone_cosine, 0.5f);

  CopySolver copy;
  memcpy(copy.mirror_axis, zero, sizeof(zero));
  EXPECT_EQ(set_up(copy), nullptr);
  expect_vector(copy.mirror_axis, 1, 0, 0);
}

TEST(SetUpSolvers, DirectionsThatAreNoneAreRefused) {
  AimSolver aim;
  aim.axis[2] = 0;
  EXPECT_STREQ(set_up(aim, 0), "a direction has length 0");
  for (float wrong : {kNan, kInfinity, -kInfinity}) {
    aim = {};
    aim.up[1] = wrong;
    EXPECT_STREQ(set_up(aim, 0), "a direction is not finite");
  }
  TwistSolver twist;
  twist.axis[0] = 0;
  EXPECT_STREQ(set_up(twist), "a direction has length 0");
}

TEST(SetUpSolvers, NumbersOutOfRangeAreRefused) {
  for (float wrong : {-0.5f, 180.5f, kNan}) {
    AimSolver aim;
    EXPECT_STREQ(set_up(aim, wrong), "cone_degrees or weight is out of range") << wrong;
  }
  for (float wrong : {-0.5f, 1.5f, kNan}) {
    AimSolver aim;
    aim.weight = wrong;
    EXPECT_NE(set_up(aim, 0), nullptr) << wrong;
    CopySolver copy;
    copy.weight = wrong;
    EXPECT_STREQ(set_up(copy), "weight is not within 0 to 1") << wrong;
  }
  for (int64_t wrong : {int64_t{-1}, kMaxEaseTicks + 1}) {
    SpaceSolver space;
    space.ease_ticks = wrong;
    EXPECT_STREQ(set_up(space), "ease_ticks is out of range");
  }
  SpaceSolver space;
  space.ease_ticks = kMaxEaseTicks;
  EXPECT_EQ(set_up(space), nullptr);
  TwistSolver twist;
  twist.joint_count = 2;
  twist.shares[1] = -1;
  twist.shares[2] = 7;  // of no joint
  EXPECT_EQ(set_up(twist), nullptr);
  twist.shares[1] = -1.5f;
  EXPECT_STREQ(set_up(twist), "a share is not within -1 to 1");
}

TEST(SetUpSolvers, SpringsReachAsFarAsTheyMayUnlessLimited) {
  SpringSolver spring;
  spring.stretch = 0;
  spring.teleport = 3;
  EXPECT_EQ(set_up(spring), nullptr);
  EXPECT_EQ(spring.stretch, kFarthest);
  EXPECT_EQ(spring.teleport, 3);
  float SpringSolver::*const fields[] = {&SpringSolver::frequency, &SpringSolver::damping,
                                         &SpringSolver::stretch, &SpringSolver::teleport};
  for (float SpringSolver::*field : fields) {
    for (float wrong : {-1.0f, 2e9f, kNan}) {
      SpringSolver other;
      other.*field = wrong;
      EXPECT_NE(set_up(other), nullptr) << wrong;
    }
  }
  spring.frequency = 0;
  EXPECT_NE(set_up(spring), nullptr);
  spring = {};
  spring.rest_offset[2] = kInfinity;
  EXPECT_NE(set_up(spring), nullptr);
}

}  // namespace
}  // namespace mien
