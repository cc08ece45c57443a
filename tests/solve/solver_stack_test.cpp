// SPDX-License-Identifier: MIT
// Stacks: what they compute again, in which order solvers may stand, batches.
#include "runtime/solve/solver_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/solve/solve_setup.h"
#include "tests/support/counting_allocator.h"

namespace mien {
namespace {

/// A user solver: turns and shifts the joints of its list by numbers that depend on the row.
struct Shaker {
  uint16_t joints[4];
  uint32_t count;
};

void shake(const SolverArgs& args) {
  const Shaker& p = *static_cast<const Shaker*>(args.params);
  for (uint32_t i = 0; i < args.count; ++i) {
    const SolverPose& pose = args.poses[i];
    for (uint32_t k = 0; k < p.count; ++k) {
      float* local = pose.locals + size_t{p.joints[k]} * kLocalTransformFloats;
      for (uint32_t n = 0; n < 7; ++n) local[n] += pose.row[n] * (n < 3 ? 2.0f : 0.5f);
      const float length = std::sqrt(local[3] * local[3] + local[4] * local[4] +
                                     local[5] * local[5] + local[6] * local[6]);
      for (uint32_t n = 3; n < 7; ++n) local[n] /= length;
    }
  }
}

SolverDesc shaker_of(const Shaker& shaker, Span<const uint16_t> reads = {}) {
  SolverDesc desc;
  desc.name = "shaker";
  desc.solve = shake;
  desc.params = &shaker;
  desc.params_size = sizeof(shaker);
  desc.writes = {shaker.joints, shaker.count};
  desc.reads = reads;
  return desc;
}

std::vector<float> random_row(std::mt19937& random, size_t count = 8) {
  std::uniform_real_distribution<float> numbers(-1, 1);
  std::vector<float> row(count);
  for (float& value : row) value = numbers(random);
  return row;
}

/// Model matrices from local transforms in double precision.
std::vector<double> reference(const Skeleton& skeleton, const float* locals) {
  std::vector<double> models(size_t{skeleton.joint_count} * 12);
  for (uint16_t joint : skeleton.order) {
    const float* t = locals + size_t{joint} * kLocalTransformFloats;
    double q[4], length = 0;
    for (int k = 0; k < 4; ++k) length += double{t[3 + k]} * t[3 + k];
    for (int k = 0; k < 4; ++k) q[k] = t[3 + k] / std::sqrt(length);
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double columns[4][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
        {t[0], t[1], t[2]}};
    const uint16_t parent = skeleton.parents[joint];
    const double* p = models.data() + size_t{parent} * 12;
    for (int c = 0; c < 4; ++c) {
      const double s = c < 3 ? t[7 + c] : 1;
      for (int r = 0; r < 3; ++r) {
        double value = columns[c][r] * s;
        if (parent != joint) {
          value = (p[r] * columns[c][0] + p[3 + r] * columns[c][1] + p[6 + r] * columns[c][2]) * s;
          if (c == 3) value += p[9 + r];
        }
        models[size_t{joint} * 12 + static_cast<size_t>(c * 3 + r)] = value;
      }
    }
  }
  return models;
}

TEST(SolverStack, ModelMatricesAreThoseOfADoubleReference) {
  SolvedRig rig(3, 24);
  std::vector<uint16_t> roots;
  for (uint16_t j = 0; j < rig.joint_count(); ++j) {
    if (rig.skeleton.parents[j] == j) roots.push_back(j);
  }
  Shaker shaker = {{roots[0]}, 1};
  SolverDesc desc = shaker_of(shaker);
  desc.writes = {roots.data(), roots.size()};  // so that everything is computed again
  const StackHandle stack = make_stack(rig.skeleton, {desc});
  const StateHandle state = make_state(*stack);
  std::mt19937 random(1);
  double worst = 0;
  for (int round = 0; round < 10000; ++round) {
    rig.pose(static_cast<uint32_t>(round), round % 2 ? 0.1 : 0);
    const std::vector<float> row = random_row(random);
    rig.step(*stack, *state, row);
    const std::vector<double> expected = reference(rig.skeleton, state->locals.data);
    double size = 1;
    for (double value : expected) size = std::max(size, std::abs(value));
    for (uint32_t j = 0; j < rig.joint_count(); ++j) {
      for (uint32_t k = 0; k < 12; ++k) {
        const float made = rig.joints().model[j * 16 + k / 3 * 4 + k % 3];
        worst = std::max(worst, std::abs(made - expected[j * 12 + k]) / size);
      }
    }
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(worst, 0);
}

TEST(SolverStack, RotationsOfAnyLengthCountAsUnitOnes) {
  SolvedRig rig(4, 12);
  rig.pose(2, 0.1);
  const StackHandle stack = make_stack(rig.skeleton, {});
  std::vector<float> locals(size_t{rig.joint_count()} * kLocalTransformFloats);
  write_local_transforms(rig.skeleton, rig.joints(), locals.data());
  const JointRange all = {0, static_cast<uint16_t>(rig.joint_count())};
  std::vector<float> unit_models(rig.joints().model.count), models = unit_models;
  update_models(*stack, all, locals.data(), unit_models.data());
  for (size_t j = 0; j < rig.joint_count(); ++j) {
    for (size_t k = 3; k < 7; ++k) locals[j * kLocalTransformFloats + k] *= 3;
  }
  update_models(*stack, all, locals.data(), models.data());
  for (size_t i = 0; i < models.size(); ++i) EXPECT_NEAR(models[i], unit_models[i], 1e-4) << i;
}

TEST(SolverStack, UpdatesOfPartsHaveTheBitsOfAFullOne) {
  SolvedRig rig(5, 30);
  std::mt19937 random(2);
  for (uint16_t joint = 0; joint < rig.joint_count(); ++joint) {
    const Shaker shaker = {{joint}, 1};
    const StackHandle part = make_stack(rig.skeleton, {shaker_of(shaker)});
    const StateHandle state = make_state(*part);
    const std::vector<float> row = random_row(random);
    rig.pose(joint, 0.1);
    // What is not touched is taken from a full update of the same pose.
    std::vector<float> locals(size_t{rig.joint_count()} * kLocalTransformFloats);
    const JointRange all = {0, static_cast<uint16_t>(rig.joint_count())};
    write_local_transforms(rig.skeleton, rig.joints(), locals.data());
    update_models(*part, all, locals.data(), rig.joints().model.data);
    rig.step(*part, *state, row);
    std::vector<float> full(rig.joints().model.count);
    update_models(*part, all, state->locals.data, full.data());
    EXPECT_TRUE(same_bits(rig.joints().model, span_of(full)));
  }
}

TEST(SolverStack, SkinMatricesFollowAndTheRestKeepsItsBits) {
  SolvedRig rig(6, 30);
  const uint16_t joint = rig.joint_with_children();
  const Shaker shaker = {{joint}, 1};
  const StackHandle stack = make_stack(rig.skeleton, {shaker_of(shaker)});
  const StateHandle state = make_state(*stack);
  rig.pose(4, 0);
  const std::vector<float> before(rig.joints().skin.begin(), rig.joints().skin.end());
  std::mt19937 random(3);
  rig.step(*stack, *state, random_row(random));
  for (uint16_t j = 0; j < rig.joint_count(); ++j) {
    const bool below = rig.is_below(j, joint);
    const bool same = memcmp(before.data() + j * 16, rig.joints().skin.data + j * 16, 64) == 0;
    EXPECT_EQ(same, !below) << j;
    if (!below) continue;
    const float *m = rig.joints().model.data + j * 16, *b = rig.skeleton.inverse_bind.data + j * 16;
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 4; ++r) {
        double value = 0;
        for (int k = 0; k < 4; ++k) value += double{m[k * 4 + r]} * b[c * 4 + k];
        EXPECT_NEAR(rig.joints().skin[j * 16u + static_cast<size_t>(c * 4 + r)], value, 1e-4);
      }
    }
  }
}

TEST(SolverStack, SolversSeeWhatEarlierOnesMoved) {
  SolvedRig rig(7, 20);
  const uint16_t joint = rig.joint_with_children(), child = rig.child_of(joint);
  struct Seen {
    float* to;
    uint16_t joint;
  };
  float seen[2][16];
  const auto look = [](const SolverArgs& args) {
    const Seen& p = *static_cast<const Seen*>(args.params);
    memcpy(p.to, args.poses[0].models + p.joint * kMatrixFloats, 64);
  };
  const Seen before = {seen[0], child}, after = {seen[1], child};
  const Shaker shaker = {{joint}, 1};
  SolverDesc looks;
  looks.solve = look;
  looks.params_size = sizeof(Seen);
  const uint16_t own = rig.leaf();
  looks.writes = {&own, 1};
  SolverDesc first = looks, last = looks;
  first.params = &before;
  last.params = &after;
  last.reads = {&child, 1};
  const StackHandle stack = make_stack(rig.skeleton, {first, shaker_of(shaker), last});
  const StateHandle state = make_state(*stack);
  rig.pose(8, 0);
  float posed[16];
  memcpy(posed, rig.joints().model.data + child * kMatrixFloats, 64);
  std::mt19937 random(4);
  rig.step(*stack, *state, random_row(random));
  EXPECT_EQ(memcmp(seen[0], posed, 64), 0);
  EXPECT_EQ(memcmp(seen[1], rig.joints().model.data + child * kMatrixFloats, 64), 0);
  EXPECT_NE(memcmp(seen[1], posed, 64), 0);
}

// Order -----------------------------------------------------------------------------------------------

TEST(SolverStack, RefusesToReadWhatALaterSolverMoves) {
  SolvedRig rig(9, 20);
  const uint16_t joint = rig.joint_with_children(), child = rig.child_of(joint);
  const uint16_t other = rig.leaf();
  const Shaker late = {{joint}, 1}, early = {{other}, 1};
  for (uint16_t read : {joint, child}) {
    const auto [status, message] =
        stack_error(rig.skeleton, {shaker_of(early, {&read, 1}), shaker_of(late)});
    EXPECT_EQ(status, Status::kInvalidArgument);
    EXPECT_NE(message.find("later solver shaker"), std::string::npos) << message;
  }
  EXPECT_EQ(stack_error(rig.skeleton, {shaker_of(late), shaker_of(early, {&child, 1})}).first,
            Status::kOk);
  SolverDesc delayed = shaker_of(early);
  delayed.previous = {&child, 1};
  EXPECT_EQ(stack_error(rig.skeleton, {delayed, shaker_of(late)}).first, Status::kOk);
  EXPECT_EQ(stack_error(rig.skeleton, {shaker_of(late, {&joint, 1}), shaker_of(late)}).first,
            Status::kOk)
      << "to change further what one changes oneself";
}

TEST(SolverStack, GivesTheMatricesOfTheLastStep) {
  SolvedRig rig(9, 20);
  const uint16_t joint = rig.joint_with_children(), own = rig.leaf();
  static std::vector<std::vector<float>> seen;
  seen.clear();
  SolverDesc desc;
  desc.solve = [](const SolverArgs& args) {
    seen.emplace_back(args.poses[0].previous, args.poses[0].previous + 16);
  };
  desc.writes = {&own, 1};
  desc.previous = {&joint, 1};
  const Shaker shaker = {{joint}, 1};
  const StackHandle stack = make_stack(rig.skeleton, {desc, shaker_of(shaker)});
  const StateHandle state = make_state(*stack);
  std::mt19937 random(4);
  for (uint32_t step = 0; step < 3; ++step) {
    std::vector<float> last(rig.joints().model.data + joint * 16,
                            rig.joints().model.data + joint * 16 + 16);
    rig.pose(step, 0);
    if (step == 0)
      last.assign(rig.joints().model.data + joint * 16, rig.joints().model.data + joint * 16 + 16);
    rig.step(*stack, *state, random_row(random));
    EXPECT_EQ(seen.back(), last);
  }
}

TEST(SolverStack, NamesASolverThatWritesWhatItDidNotDeclare) {
  SolvedRig rig(10, 20);
  const uint16_t joint = rig.leaf();
  Shaker shaker = {{joint, rig.joint_with_children()}, 2};
  SolverDesc desc = shaker_of(shaker);
  desc.writes = {shaker.joints, 1};
  std::mt19937 random(5);
  for (bool checks : {false, true}) {
    const StackHandle stack = make_stack(rig.skeleton, {desc}, checks);
    const StateHandle state = make_state(*stack);
    rig.pose(1, 0);
    rig.step(*stack, *state, random_row(random));
    if (checks) {
      EXPECT_STREQ(state->undeclared, "shaker");
    } else {
      EXPECT_EQ(state->undeclared, nullptr);
    }
  }
  const StackHandle stack = make_stack(rig.skeleton, {shaker_of(shaker)}, true);
  const StateHandle state = make_state(*stack);
  rig.step(*stack, *state, random_row(random));
  EXPECT_EQ(state->undeclared, nullptr);
}

TEST(SolverStack, SolversRunAtTheirLods) {
  SolvedRig rig(10, 20);
  const Shaker shaker = {{rig.leaf()}, 1};
  SolverDesc desc = shaker_of(shaker);
  desc.lods = 2;
  const StackHandle stack = make_stack(rig.skeleton, {desc});
  const StateHandle state = make_state(*stack);
  std::mt19937 random(5);
  const std::vector<float> row = random_row(random);
  for (uint32_t lod : {0u, 1u, 32u}) {
    rig.pose(1, 0);
    std::vector<float> posed(size_t{rig.joint_count()} * kLocalTransformFloats);
    write_local_transforms(rig.skeleton, rig.joints(), posed.data());
    rig.step(*stack, *state, row, 0, lod);
    EXPECT_EQ(same_bits(state->locals, span_of(posed)), lod != 1);
  }
}

// Wrong input, memory, batches --------------------------------------------------------------------------

TEST(SolverStack, RefusesDescsThatDoNotFitTheSkeleton) {
  SolvedRig rig(11, 12);
  const uint16_t far = 12, near = 3;
  const Shaker good = {{near}, 1}, bad = {{far}, 1};
  EXPECT_EQ(stack_error(rig.skeleton, {shaker_of(bad)}).first, Status::kIndex);
  EXPECT_EQ(stack_error(rig.skeleton, {shaker_of(good, {&far, 1})}).first, Status::kIndex);
  SolverDesc desc = shaker_of(good);
  desc.previous = {&far, 1};
  EXPECT_EQ(stack_error(rig.skeleton, {desc}).first, Status::kIndex);
  desc = shaker_of(good);
  desc.solve = nullptr;
  EXPECT_EQ(stack_error(rig.skeleton, {desc}).first, Status::kInvalidArgument);
  desc = shaker_of(good);
  desc.writes = {};
  EXPECT_EQ(stack_error(rig.skeleton, {desc}).first, Status::kInvalidArgument);
}

TEST(SolverStack, WithoutSolversChangesNothing) {
  SolvedRig rig(11, 12);
  const StackHandle stack = make_stack(rig.skeleton, {});
  const StateHandle state = make_state(*stack);
  rig.pose(3, 0.1);
  const std::vector<float> model(rig.joints().model.begin(), rig.joints().model.end());
  rig.step(*stack, *state, {});
  EXPECT_TRUE(same_bits(rig.joints().model, span_of(model)));
}

TEST(SolverStack, FailsWithoutALeakWhereverMemoryRunsOut) {
  SolvedRig rig(12, 300);
  const Shaker shaker = {{1, 2}, 2};
  const SolverDesc desc = shaker_of(shaker);
  for (size_t request = 1;; ++request) {
    CountingAllocator memory;
    memory.fail_at = request;
    const MienAllocator counted = memory.get();
    const Allocator allocator = {counted.user, counted.allocate, counted.release};
    Stack* stack = nullptr;
    Error error;
    const Status status = create_stack(rig.skeleton, {{&desc, 1}}, allocator, stack, error);
    StackState* state = stack ? create_stack_state(*stack, allocator) : nullptr;
    EXPECT_EQ(status, stack ? Status::kOk : Status::kMemory);
    const bool all = state != nullptr;
    release(state);
    release(stack);
    EXPECT_TRUE(memory.clean()) << memory.first_wrong;
    EXPECT_EQ(all, memory.failed == 0);
    if (all) break;
  }
}

TEST(SolverStack, OrdersJointsDepthFirst) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    SolvedRig rig(seed, 40);
    const StackHandle stack = make_stack(rig.skeleton, {});
    std::vector<int> place(40, -1);
    for (int i = 0; i < 40; ++i) place[stack->order[static_cast<size_t>(i)]] = i;
    for (uint16_t j = 0; j < 40; ++j) {
      ASSERT_GE(place[j], 0);
      int below = 0, last = 0;
      for (uint16_t k = 0; k < 40; ++k) {
        if (!rig.is_below(k, j)) continue;
        ++below;
        last = std::max(last, place[k]);
        EXPECT_GE(place[k], place[j]);
      }
      EXPECT_EQ(last - place[j] + 1, below) << "one range";
    }
  }
}

}  // namespace
}  // namespace mien
