// SPDX-License-Identifier: MIT
// The solvers that come with the library, on random rigs.
#include "runtime/solve/solvers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "runtime/anim/clip.h"
#include "runtime/solve/rotation.h"
#include "tests/solve/solve_setup.h"

namespace mien {
namespace {

using solve::between;
using solve::inverse;
using solve::part_of;
using solve::Rotation;
using solve::rotation_of;
using solve::turn;

constexpr int64_t kSecond = kTicksPerSecond;
constexpr int64_t kMillisecond = kTicksPerSecond / 1000;

Vec3 vector(const float* v) { return {v[0], v[1], v[2]}; }
Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> numbers;
  return unit(Vec3{numbers(random), numbers(random), numbers(random)});
}
/// Precise where it is small.
double angle(Vec3 a, Vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }
double angle(const Rotation& q) {
  return 2 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::abs(q.w));
}
void put(Vec3 v, float* out) {
  out[0] = static_cast<float>(v.x);
  out[1] = static_cast<float>(v.y);
  out[2] = static_cast<float>(v.z);
}

// Rotations ---------------------------------------------------------------------------------------------

TEST(SolverRotation, PartsOfATurnAreProportional) {
  std::mt19937 random(1);
  for (double full : {0.0, 1e-6, 0.3, 1.5, 3.0}) {
    const Vec3 axis = random_direction(random) * std::sin(full / 2);
    const Rotation q = {axis.x, axis.y, axis.z, std::cos(full / 2)};
    for (double share : {0.0, 0.001, 0.25, 0.377, 0.5, 0.9, 1.0}) {
      EXPECT_NEAR(angle(part_of(q, share)), full * share, 1e-6);
    }
  }
}

TEST(SolverRotation, LeadsFromOneDirectionToAnother) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = random_direction(random), b = i < 10 ? -a : random_direction(random);
    EXPECT_NEAR(length(turn(between(a, b), a) - b), 0, 1e-9);
  }
}

// Aim -------------------------------------------------------------------------------------------------

struct AimCase {
  SolvedRig rig;
  AimSolver aim;
  std::mt19937 random;

  explicit AimCase(uint32_t seed) : rig(seed, 16), random(seed) {
    aim.joint = rig.joint_with_children();
    put(random_direction(random), aim.axis);
    rig.pose(seed, 0);
  }
  Vec3 at() { return vector(rig.model(aim.joint) + 12); }
  /// Where the axis points after a step towards a target.
  Vec3 aimed(Vec3 target) {
    float row[3];
    put(target, row);
    const StackHandle stack = make_stack(rig.skeleton, {describe(rig.skeleton, aim)});
    const StateHandle state = make_state(*stack);
    rig.step(*stack, *state, {row, row + 3});
    return turn(rotation_of(rig.model(aim.joint)), vector(aim.axis));
  }
};

TEST(Aim, ReachesTheTarget) {
  for (uint32_t seed = 0; seed < 100; ++seed) {
    AimCase c(seed);
    const Vec3 before = c.at(), target = before + random_direction(c.random) * 20;
    const Vec3 points = c.aimed(target);
    EXPECT_LT(angle(points, unit(target - before)), 1e-4);
    EXPECT_NEAR(length(c.at() - before), 0, 1e-4) << "stays in its place";
  }
}

TEST(Aim, StopsAtTheEdgeOfItsCone) {
  const double cone = 0.4;
  int outside = 0;
  for (uint32_t seed = 0; seed < 100; ++seed) {
    AimCase c(seed);
    c.aim.cone_cosine = static_cast<float>(std::cos(cone));
    const Vec3 target = c.at() + random_direction(c.random) * 20;
    const Vec3 wanted = unit(target - c.at());
    const Vec3 points = c.aimed(target);
    const uint16_t parent = c.rig.skeleton.parents[c.aim.joint];
    const Vec3 rest = turn(rotation_of(c.rig.model(parent)), vector(c.aim.cone_axis));
    if (angle(rest, wanted) <= cone) {
      EXPECT_LT(angle(points, wanted), 1e-4);
      continue;
    }
    ++outside;
    EXPECT_NEAR(angle(points, rest), cone, 1e-4);
    EXPECT_NEAR(angle(points, wanted), angle(rest, wanted) - cone, 1e-4) << "on the way to it";
  }
  EXPECT_GT(outside, 50);
}

TEST(Aim, StopsAtTheEdgeAlsoJustOutsideOfIt) {
  const double cone = 0.4;
  for (double off : {-0.002, 0.002}) {
    AimCase c(7);
    c.aim.cone_cosine = static_cast<float>(std::cos(cone));
    describe(c.rig.skeleton, c.aim);  // finds the axis of the cone
    const uint16_t parent = c.rig.skeleton.parents[c.aim.joint];
    const Vec3 rest = turn(rotation_of(c.rig.model(parent)), vector(c.aim.cone_axis));
    const Vec3 across = unit(cross(rest, random_direction(c.random)));
    const Vec3 wanted = rest * std::cos(cone + off) + across * std::sin(cone + off);
    EXPECT_NEAR(angle(c.aimed(c.at() + wanted * 20), rest), std::min(cone, cone + off), 1e-4);
  }
}

TEST(Aim, ConeIsAboutWhereTheNeutralPosePoints) {
  AimCase c(3);
  c.rig.neutral_pose();
  const Vec3 rest = turn(rotation_of(c.rig.model(c.aim.joint)), vector(c.aim.axis));
  c.aim.cone_cosine = 0.999f;
  const Vec3 points = c.aimed(c.at() + rest * 10);
  EXPECT_LT(angle(points, rest), 1e-4);
  EXPECT_LT(angle(turn(rotation_of(c.rig.model(c.rig.skeleton.parents[c.aim.joint])),
                       vector(c.aim.cone_axis)),
                  rest),
            1e-5);
}

TEST(Aim, TurnsUpAboutItsAxis) {
  for (uint32_t seed = 0; seed < 50; ++seed) {
    AimCase c(seed);
    const Vec3 axis = vector(c.aim.axis);
    put(unit(cross(axis, random_direction(c.random))), c.aim.up_axis);
    const Vec3 target = c.at() + random_direction(c.random) * 20;
    const Vec3 wanted = unit(target - c.at());
    EXPECT_LT(angle(c.aimed(target), wanted), 1e-4);
    const Vec3 up = turn(rotation_of(c.rig.model(c.aim.joint)), vector(c.aim.up_axis));
    const Vec3 best = unit(Vec3{0, 1, 0} - wanted * wanted.y);
    EXPECT_LT(angle(up, best), 1e-4);
  }
}

TEST(Aim, WeightGoesTheSameShareOfTheWay) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    AimCase c(seed);
    const Vec3 before = turn(rotation_of(c.rig.model(c.aim.joint)), vector(c.aim.axis));
    const Vec3 target = c.at() + random_direction(c.random) * 20;
    const double way = angle(before, unit(target - c.at()));
    c.aim.weight = 0.3f;
    EXPECT_NEAR(angle(before, c.aimed(target)), 0.3 * way, 1e-4);
  }
}

TEST(Aim, FollowsAJointAndLeavesJointsWithoutTargetAlone) {
  AimCase c(4);
  c.aim.target_joint = c.rig.leaf();
  const Vec3 points = c.aimed({});
  EXPECT_LT(angle(points, unit(vector(c.rig.model(c.aim.target_joint) + 12) - c.at())), 1e-4);
  AimCase none(4);
  const StackHandle stack = make_stack(none.rig.skeleton, {describe(none.rig.skeleton, none.aim)});
  const StateHandle state = make_state(*stack);
  const Rotation before = rotation_of(none.rig.model(none.aim.joint));
  none.rig.step(*stack, *state, {});
  EXPECT_LT(angle(inverse(before) * rotation_of(none.rig.model(none.aim.joint))), 1e-5);
}

// Space switch ----------------------------------------------------------------------------------------

struct SpaceCase {
  SolvedRig rig;
  SpaceSolver space;
  StackHandle stack;
  StateHandle state;

  explicit SpaceCase(uint32_t seed, int64_t ease) : rig(seed, 16) {
    space.joint = rig.joint_with_children();
    space.spaces[0] = rig.skeleton.parents[space.joint];
    space.spaces[1] = rig.leaf();
    space.spaces[2] = kNoSolverJoint;
    space.space_count = 3;
    space.ease_ticks = ease;
    stack = make_stack(rig.skeleton, {describe(rig.skeleton, space)});
    state = make_state(*stack);
  }
  void step(float curve, int64_t ticks) { rig.step(*stack, *state, {curve}, ticks); }
  Vec3 at() { return vector(rig.model(space.joint) + 12); }
  Rotation turned() { return rotation_of(rig.model(space.joint)); }
};

TEST(SpaceSwitch, HoldsTheJointWhereItIsAndEasesItOver) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    SpaceCase c(seed, kSecond / 2);
    c.rig.pose(seed, 0);
    c.step(0, 0);
    const Vec3 at = c.at();
    const Rotation turned = c.turned();
    for (float curve : {1.0f, 2.0f, 0.0f}) {  // again while it eases
      const Vec3 last = c.at();
      const Rotation last_turned = c.turned();
      c.rig.pose(seed, 0);
      c.step(curve, 0);
      EXPECT_LE(length(c.at() - last), 1e-6 * std::max(1.0, length(last)));
      EXPECT_LE(angle(inverse(last_turned) * c.turned()), 2e-6);
      for (int step = 0; step < 10; ++step) {
        c.rig.pose(seed, 0);
        c.step(curve, kSecond / 100);
      }
    }
    for (int step = 0; step < 60; ++step) {
      c.rig.pose(seed, 0);
      c.step(0, kSecond / 100);
    }
    EXPECT_NEAR(length(c.at() - at), 0, 1e-4) << "back in its own space";
    EXPECT_LE(angle(inverse(turned) * c.turned()), 1e-5);
  }
}

TEST(SpaceSwitch, FollowsItsSpaceAsIfItsParentHungThere) {
  for (float curve : {0.0f, 1.0f, 2.0f}) {
    SpaceCase c(5, 0);
    c.rig.pose(1, 0);
    std::vector<float> posed(size_t{c.rig.joint_count()} * kLocalTransformFloats);
    write_local_transforms(c.rig.skeleton, c.rig.joints(), posed.data());
    c.step(curve, 0);
    // Its place in the parent's bind pose, carried by the skin matrix of the space.
    const auto apply = [](const float* m, Vec3 v) {
      return Vec3{m[0] * v.x + m[4] * v.y + m[8] * v.z + m[12],
                  m[1] * v.x + m[5] * v.y + m[9] * v.z + m[13],
                  m[2] * v.x + m[6] * v.y + m[10] * v.z + m[14]};
    };
    const Skeleton& skeleton = c.rig.skeleton;
    const uint16_t parent = skeleton.parents[c.space.joint];
    const uint16_t space = c.space.spaces[static_cast<size_t>(curve)];
    Vec3 expected = apply(skeleton.bind.data + size_t{parent} * kMatrixFloats,
                          vector(posed.data() + size_t{c.space.joint} * kLocalTransformFloats));
    if (space != kNoSolverJoint) {
      expected = apply(c.rig.joints().skin.data + size_t{space} * kMatrixFloats, expected);
    }
    EXPECT_NEAR(length(c.at() - expected), 0, 1e-4) << curve;
  }
}

TEST(SpaceSwitch, AResetDoesNotEase) {
  SpaceCase eased(6, kSecond), sudden(6, kSecond), fresh(6, kSecond);
  for (SpaceCase* c : {&eased, &sudden}) {
    c->rig.pose(3, 0);
    c->step(0, 0);
    c->rig.pose(3, 0);
    c->rig.step(*c->stack, *c->state, {1}, kSecond / 60, 0, c == &sudden);
  }
  fresh.rig.pose(3, 0);
  fresh.step(1, 0);
  EXPECT_EQ(memcmp(sudden.rig.model(sudden.space.joint), fresh.rig.model(fresh.space.joint), 64),
            0);
  EXPECT_GT(length(eased.at() - fresh.at()), 1e-3);
}

TEST(SpaceSwitch, CurvesBeyondTheListTakeItsEnds) {
  for (float curve : {-3.0f, 7.5f, NAN, INFINITY}) {
    SpaceCase c(6, 0), expected(6, 0);
    for (SpaceCase* s : {&c, &expected}) s->rig.pose(3, 0);
    c.step(curve, 0);
    expected.step(curve > 1 ? 2.0f : 0.0f, 0);
    EXPECT_EQ(memcmp(c.rig.model(c.space.joint), expected.rig.model(c.space.joint), 64), 0)
        << curve;
  }
}

// Spring ----------------------------------------------------------------------------------------------

struct SpringCase {
  SolvedRig rig{8, 16};
  SpringSolver spring;
  StackHandle stack;
  StateHandle state;

  SpringCase(float frequency, float damping) {
    spring.joint = rig.joint_with_children();
    spring.frequency = frequency;
    spring.damping = damping;
  }
  void start(Vec3 off, Vec3 velocity = {}) {
    stack = make_stack(rig.skeleton, {describe(rig.skeleton, spring)});
    state = make_state(*stack);
    rig.neutral_pose();
    goal = at();
    rig.step(*stack, *state, {});
    auto* s = reinterpret_cast<Vec3*>(state->solver_states.data);  // place, velocity, goal
    s[0] = s[0] + off;
    s[1] = velocity;
  }
  void step(int64_t ticks) {
    rig.neutral_pose();
    rig.step(*stack, *state, {}, ticks);
  }
  Vec3 at() { return vector(rig.model(spring.joint) + 12); }
  Vec3 off() const { return reinterpret_cast<const Vec3*>(state->solver_states.data)[0] - goal; }
  Vec3 velocity() const { return reinterpret_cast<const Vec3*>(state->solver_states.data)[1]; }
  double energy() const {
    const double omega = 2 * M_PI * double{spring.frequency};
    return dot(velocity(), velocity()) + omega * omega * dot(off(), off());
  }
  Vec3 goal;
};

TEST(Spring, FollowsTheSolutionOfItsEquation) {
  for (float damping : {0.0f, 0.2f, 1.0f, 2.5f}) {
    SpringCase c(2, damping);
    c.start({1, -0.5, 0.25});
    c.step(kSecond / 3);
    const double t = 1.0 / 3, omega = 4 * M_PI, z = double{damping};
    double expected = 0;
    if (z < 1) {
      const double w = omega * std::sqrt(1 - z * z);
      expected = std::exp(-z * omega * t) * (std::cos(w * t) + z * omega / w * std::sin(w * t));
    } else if (z == 1) {
      expected = std::exp(-omega * t) * (1 + omega * t);
    } else {
      const double r = std::sqrt(z * z - 1), a = omega * (-z + r), b = omega * (-z - r);
      expected = (b * std::exp(a * t) - a * std::exp(b * t)) / (b - a);
    }
    EXPECT_NEAR(c.off().x, expected, 1e-9) << damping;
    EXPECT_NEAR(c.off().y, -0.5 * expected, 1e-9);
    EXPECT_NEAR(length(c.at() - c.goal - c.off()), 0, 1e-5) << "the joint is there";
    EXPECT_NEAR(c.state->outputs[0], length(c.velocity()), 1e-4);
  }
}

TEST(Spring, EnergyNeverGrowsWhateverTheStep) {
  for (float frequency : {0.5f, 3.0f, 50.0f, 500.0f}) {
    for (float damping : {0.0f, 0.05f, 1.0f, 4.0f}) {
      for (int64_t ticks : {kMillisecond / 10, kMillisecond, kSecond / 60, kSecond / 7, kSecond}) {
        SpringCase c(frequency, damping);
        c.start({1, 0.3, -0.2}, {0.5, -2, 1});
        double before = c.energy();
        for (int step = 0; step < 60; ++step) {
          c.step(ticks);
          EXPECT_LE(c.energy(), before * (1 + 1e-11) + 1e-20) << "but for rounding";
          before = c.energy();
        }
      }
    }
  }
}

TEST(Spring, EndsAtTheSamePlaceHoweverASecondIsDivided) {
  SpringCase whole(3, 0.1f);
  whole.start({1, 2, 3}, {0, -5, 0});
  whole.step(kSecond);
  std::mt19937 random(5);
  for (int round = 0; round < 5; ++round) {
    SpringCase parts(3, 0.1f);
    parts.start({1, 2, 3}, {0, -5, 0});
    int64_t left = kSecond;
    while (left > 0) {
      const int64_t longest = round == 0 ? kSecond / 10000 : kSecond / 20;
      const int64_t ticks = std::min<int64_t>(left, 1 + static_cast<int64_t>(random()) % longest);
      parts.step(ticks);
      left -= ticks;
    }
    EXPECT_NEAR(length(parts.off() - whole.off()), 0, 1e-5);
    EXPECT_NEAR(length(parts.at() - whole.at()), 0, 1e-5);
  }
}

TEST(Spring, StretchesNoFartherThanItsLimit) {
  SpringCase c(1, 0);
  c.spring.stretch = 0.5f;
  c.start({0.4, 0, 0}, {30, 0, 0});
  for (int step = 0; step < 100; ++step) {
    c.step(kSecond / 60);
    EXPECT_LE(length(c.off()), 0.5 + 1e-6);
  }
}

TEST(Spring, GoesAlongWhenItsGoalJumpsAndAfterAReset) {
  for (bool reset : {false, true}) {
    SpringCase c(1, 0.1f);
    c.spring.teleport = reset ? 1e9f : 0.01f;
    c.start({});
    c.rig.pose(1, 0);
    const Vec3 posed = c.at();
    ASSERT_GT(length(posed - c.goal), 0.01);
    c.rig.step(*c.stack, *c.state, {}, kSecond / 60, 0, reset);
    EXPECT_NEAR(length(c.at() - posed), 0, 1e-5);
    EXPECT_EQ(c.state->outputs[0], 0);
  }
  SpringCase c(1, 0.1f);
  c.start({});
  c.rig.pose(1, 0);
  const Vec3 posed = c.at();
  c.rig.step(*c.stack, *c.state, {}, kSecond / 60);
  EXPECT_GT(length(c.at() - posed), 0.5 * length(posed - c.goal)) << "lags behind";
}

TEST(Spring, ComesToRestExactly) {
  SpringCase c(4, 0.5f);
  c.start({1, 0, 0});
  int steps = 0;
  c.step(kSecond / 60);
  while (length(c.velocity()) != 0 && steps < 1000) c.step(kSecond / 60), ++steps;
  c.step(kSecond / 60);
  EXPECT_LT(steps, 200);
  EXPECT_EQ(length(c.off()), 0);
  EXPECT_EQ(c.state->outputs[0], 0);
}

TEST(Spring, RestsAtItsOffset) {
  SpringCase c(5, 0.8f);
  c.spring.rest_offset[1] = -0.75f;
  c.start({});
  c.step(kSecond * 4);
  EXPECT_NEAR(length(c.at() - c.goal - Vec3{0, -0.75, 0}), 0, 1e-5);
}

// Twist, copy -----------------------------------------------------------------------------------------

Rotation delta_of(const SolvedRig& rig, const StackState& state, uint16_t joint) {
  const float* l = state.locals.data + size_t{joint} * kLocalTransformFloats;
  const float* bind = rig.skeleton.bind.data + size_t{joint} * kMatrixFloats;
  const uint16_t parent = rig.skeleton.parents[joint];
  const Rotation above = parent == joint
                             ? Rotation{}
                             : rotation_of(rig.skeleton.bind.data + size_t{parent} * kMatrixFloats);
  return inverse(inverse(above) * rotation_of(bind)) * Rotation{l[3], l[4], l[5], l[6]};
}

TEST(Twist, SharesTheAngleAndKeepsTheSwing) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    SolvedRig rig(seed, 16);
    std::mt19937 random(seed);
    TwistSolver twist;
    const Vec3 axis = random_direction(random);
    put(axis, twist.axis);
    twist.source = 3;
    twist.joints[0] = 5;
    twist.joints[1] = 9;
    twist.shares[0] = 0.25f;
    twist.shares[1] = -0.5f;
    twist.joint_count = 2;
    const StackHandle stack = make_stack(rig.skeleton, {describe(rig.skeleton, twist)});
    const StateHandle state = make_state(*stack), plain = make_state(*stack);
    rig.pose(seed, 0);
    write_local_transforms(rig.skeleton, rig.joints(), plain->locals.data);
    rig.step(*stack, *state, {});
    const auto twist_angle = [&](const Rotation& q) {
      const Rotation t = solve::twist_of(q, vector(twist.axis));
      return 2 * std::atan2(dot({t.x, t.y, t.z}, axis) * (t.w < 0 ? -1 : 1), std::abs(t.w));
    };
    const double source = twist_angle(delta_of(rig, *plain, 3));
    EXPECT_NEAR(twist_angle(delta_of(rig, *state, 5)), 0.25 * source, 1e-5);
    EXPECT_NEAR(twist_angle(delta_of(rig, *state, 9)), -0.5 * source, 1e-5);
    EXPECT_NEAR(state->outputs[0], std::sin(source / 2), 1e-5);
    for (uint16_t joint : {uint16_t{5}, uint16_t{9}}) {
      const auto swing = [&](const StackState& s) {
        return turn(delta_of(rig, s, joint), vector(twist.axis));
      };
      EXPECT_LT(angle(swing(*state), swing(*plain)), 1e-5);
    }
  }
}

TEST(Copy, MovesAsTheOtherJointOrAsItsMirrorImage) {
  for (bool mirrored : {false, true}) {
    for (uint32_t seed = 0; seed < 20; ++seed) {
      SolvedRig rig(seed, 16);
      CopySolver copy;
      copy.source = 3;
      copy.joint = 7;
      copy.mirrored = mirrored;
      const StackHandle stack = make_stack(rig.skeleton, {describe(rig.skeleton, copy)});
      const StateHandle state = make_state(*stack);
      rig.pose(seed, 0);
      rig.step(*stack, *state, {});
      // Along the axes of model space in the neutral pose.
      const auto moved = [&](uint16_t joint, Vec3 v) {
        const Rotation own = rotation_of(rig.skeleton.bind.data + size_t{joint} * kMatrixFloats);
        return turn(own * delta_of(rig, *state, joint) * inverse(own), v);
      };
      std::mt19937 random(seed);
      const auto image = [mirrored](Vec3 v) { return mirrored ? Vec3{-v.x, v.y, v.z} : v; };
      for (int i = 0; i < 5; ++i) {
        const Vec3 v = random_direction(random);
        // The delta of the parent's axes: the delta itself turned by the neutral rotation.
        EXPECT_LT(angle(moved(7, image(v)), image(moved(3, v))), 1e-4);
      }
    }
  }
}

TEST(Copy, OfTheNeutralPoseIsTheNeutralPose) {
  SolvedRig rig(2, 16);
  CopySolver copy;
  copy.source = 3;
  copy.joint = 7;
  copy.mirrored = true;
  const StackHandle stack = make_stack(rig.skeleton, {describe(rig.skeleton, copy)});
  const StateHandle state = make_state(*stack);
  rig.neutral_pose();
  const std::vector<float> before(rig.joints().model.begin(), rig.joints().model.end());
  rig.step(*stack, *state, {});
  for (size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(rig.joints().model[i], before[i], 1e-4);
}

// All of them -----------------------------------------------------------------------------------------

TEST(Solvers, ABatchHasTheBitsOfSingleCharacters) {
  SolvedRig rig(13, 40);
  const Skeleton& skeleton = rig.skeleton;
  AimSolver aim;
  aim.joint = rig.joint_with_children();
  SpringSolver spring;
  spring.joint = rig.leaf();
  SpaceSolver space;
  space.joint = aim.joint;
  space.spaces[0] = skeleton.parents[aim.joint];
  space.spaces[1] = kNoSolverJoint;
  space.space_count = 2;
  space.curve = 3;
  space.ease_ticks = kSecond / 4;
  const StackHandle stack = make_stack(
      skeleton, {describe(skeleton, space), describe(skeleton, aim), describe(skeleton, spring)});
  struct One {
    DeformerInstanceHandle instance;
    StateHandle state;
    std::vector<float> row;
  };
  const auto make = [&](uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> numbers(-20, 20);
    One one = {create_deformer_instance(rig.deformer.get()), make_state(*stack), {}};
    for (int i = 0; i < 4; ++i) one.row.push_back(numbers(random));
    return one;
  };
  std::vector<One> singles, batch;
  for (uint32_t i = 0; i < kMaxStackPoses; ++i) {
    singles.push_back(make(i));
    batch.push_back(make(i));
  }
  for (uint32_t step = 0; step < 10; ++step) {
    std::vector<StackPose> poses;
    for (uint32_t i = 0; i < kMaxStackPoses; ++i) {
      for (One* one : {&singles[i], &batch[i]}) {
        one->row[3] = static_cast<float>((i + step) / 4 % 2);
        Deformed::update(one->instance.get(), random_values(rig.rig.get(), i * 100 + step, 0));
      }
      const auto pose_of = [](One& one) {
        JointPose& joints = capi::object(one.instance.get())->joints;
        return StackPose{one.state.get(), &joints, one.row.data(), 0, false};
      };
      const StackPose single = pose_of(singles[i]);
      step_stack(*stack, {&single, 1}, kSecond / 60);
      poses.push_back(pose_of(batch[i]));
    }
    step_stack(*stack, {poses.data(), poses.size()}, kSecond / 60);
    for (uint32_t i = 0; i < kMaxStackPoses; ++i) {
      const JointPose& a = capi::object(singles[i].instance.get())->joints;
      const JointPose& b = *poses[i].pose;
      ASSERT_TRUE(same_bits(a.model, b.model));
      ASSERT_TRUE(same_bits(a.skin, b.skin));
      ASSERT_TRUE(same_bits(singles[i].state->outputs, batch[i].state->outputs));
    }
  }
}

TEST(Solvers, MoveTheMesh) {
  SolvedRig rig(14, 12);
  rig.neutral_pose();
  rig.deform(0);
  const Span<const float> positions = rig.positions(0);
  const std::vector<float> before(positions.begin(), positions.end());
  AimSolver aim;
  aim.joint = rig.joint_with_children();
  const StackHandle stack = make_stack(rig.skeleton, {describe(rig.skeleton, aim)});
  const StateHandle state = make_state(*stack);
  rig.step(*stack, *state, {40, 30, -20});
  rig.deform(0);
  EXPECT_FALSE(same_bits(rig.positions(0), span_of(before)));
}

TEST(Solvers, AreRefusedForJointsThatDoNotExist) {
  SolvedRig rig(15, 8);
  AimSolver aim;
  aim.joint = 8;
  SpringSolver spring;
  spring.joint = 700;
  SpaceSolver space;
  space.spaces[0] = 9;
  space.space_count = 1;
  CopySolver copy;
  copy.source = 8;
  TwistSolver twist;
  twist.joint_count = 1;
  twist.joints[0] = 8;
  for (const SolverDesc& desc :
       {describe(rig.skeleton, aim), describe(rig.skeleton, spring), describe(rig.skeleton, space),
        describe(rig.skeleton, copy), describe(rig.skeleton, twist)}) {
    EXPECT_EQ(stack_error(rig.skeleton, {desc}).first, Status::kIndex) << desc.name;
  }
  TwistSolver none;
  EXPECT_EQ(stack_error(rig.skeleton, {describe(rig.skeleton, none)}).first,
            Status::kInvalidArgument);
}

}  // namespace
}  // namespace mien
