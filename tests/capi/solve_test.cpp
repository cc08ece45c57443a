// SPDX-License-Identifier: MIT
// Solver stacks through mien.h: each kind moves what the runtime's solver moves, results reach the
// meshes, wrong arguments, memory. What solvers do is tested in tests/solve.
#include <cmath>

#include "runtime/solve/solvers.h"
#include "tests/solve/solve_setup.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/misuse.h"

namespace mien {
namespace {

constexpr int64_t kSolveStep = MIEN_TICKS_PER_SECOND / 60;

struct CloseSolvers {
  void operator()(MienSolverStack* stack) const { mien_solver_stack_destroy(stack); }
  void operator()(MienSolverState* state) const { mien_solver_state_destroy(state); }
};
using SolverStackHandle = std::unique_ptr<MienSolverStack, CloseSolvers>;
using SolverStateHandle = std::unique_ptr<MienSolverState, CloseSolvers>;

/// What a solver of the caller has seen.
struct Seen {
  uint16_t root = 0;
  uint32_t calls = 0, poses = 0, joints = 0;
  int64_t ticks = 0;
  bool reset = false;
  float row = 0, previous = 0;
};

/// Raises a root by the count of its calls, which it keeps in its state and publishes.
void MIEN_CALLBACK raise_root(void* user, const MienSolverCall* call) {
  Seen& seen = *static_cast<Seen*>(user);
  ++seen.calls;
  seen.poses += call->pose_count;
  seen.joints = call->joint_count;
  seen.ticks = call->ticks;
  for (uint32_t i = 0; i < call->pose_count; ++i) {
    const MienSolverPose& pose = call->poses[i];
    auto& steps = *static_cast<double*>(pose.state);
    steps += 1;
    pose.locals[seen.root * 10 + 1] += static_cast<float>(steps);
    pose.outputs[0] = static_cast<float>(steps);
    seen.reset = pose.is_reset != 0;
    if (pose.row) seen.row = pose.row[2];
    seen.previous = pose.previous[13];
  }
}

void MIEN_CALLBACK move_another(void*, const MienSolverCall* call) {
  for (uint32_t j = 0; j < call->joint_count; ++j) call->poses[0].locals[j * 10] += 1;
}

/// One of each kind on a random skeleton.
struct Solvers {
  SolvedRig rig{7, 12};
  uint16_t middle = rig.joint_with_children(), child = rig.child_of(middle), leaf = rig.leaf();
  const uint16_t root[1] = {find_root()};
  const uint16_t spaces[2] = {MIEN_NO_JOINT, middle};
  const uint16_t twisted[1] = {leaf};
  const float half[1] = {0.5f};
  Seen seen;
  MienAimSolver aim = {};
  MienSpaceSolver space = {};
  MienSpringSolver spring = {};
  MienTwistSolver twist = {};
  MienCopySolver copy = {};
  MienUserSolver custom = {};
  std::vector<MienSolver> list;
  uint32_t curve_count = 6;

  uint16_t find_root() const {
    uint16_t joint = 0;
    while (rig.skeleton.parents[joint] != joint) joint = rig.skeleton.parents[joint];
    return joint;
  }
  Solvers() {
    seen.root = root[0];
    aim.joint = leaf;
    aim.target_joint = MIEN_NO_JOINT;
    aim.target_curve = 2;
    aim.axis[2] = 3;
    aim.cone_degrees = 40;
    aim.weight = 1;
    space.joint = child;
    space.spaces = spaces;
    space.space_count = 2;
    space.curve = 5;
    space.ease_ticks = 10 * kSolveStep;
    spring.joint = leaf;
    spring.frequency = 2;
    spring.damping = 0.2f;
    spring.rest_offset[1] = 0.5f;
    twist.source = middle;
    twist.axis[0] = 2;
    twist.joints = twisted;
    twist.shares = half;
    twist.joint_count = 1;
    copy.source = middle;
    copy.joint = leaf;
    copy.is_mirrored = 1;
    copy.weight = 0.5f;
    custom.user = &seen;
    custom.solve = raise_root;
    custom.writes = custom.previous_joints = root;
    custom.write_count = custom.previous_joint_count = 1;
    custom.state_bytes = 8;
    custom.output_count = 1;
  }

  MienSolver& add() {
    list.push_back({});
    return list.back();
  }
  SolverStackHandle stack(MienStatus expected = MIEN_OK, uint32_t check_writes = 0,
                          const MienAllocator* allocator = nullptr) const {
    MienSolverStackDesc desc = sized<MienSolverStackDesc>();
    desc.solvers = list.data();
    desc.solver_count = list.size();
    desc.curve_count = curve_count;
    desc.check_writes = check_writes;
    desc.allocator = allocator;
    MienSolverStack* made = nullptr;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_solver_stack_create(rig.deformer.get(), &desc, &made, &error), expected)
        << error.message;
    EXPECT_EQ(made == nullptr, expected != MIEN_OK);
    return SolverStackHandle(made);
  }
  static SolverStateHandle state(const SolverStackHandle& stack) {
    MienSolverState* made = nullptr;
    EXPECT_EQ(mien_solver_state_create(stack.get(), nullptr, &made, nullptr), MIEN_OK);
    return SolverStateHandle(made);
  }
};

const std::vector<float> kRow = {9, 9, 1, 20, 3, 1};
const MienSolverInput kInput = {kRow.data(), kRow.size(), 0, 0};

/// The matrices after some steps of a stack through mien.h and of one made of the same solvers.
template <class Solver>
void expect_same(Solvers& made, Solver solver) {
  const SolverStackHandle stack = made.stack();
  const SolverStateHandle state = Solvers::state(stack);
  const StackHandle plain = make_stack(made.rig.skeleton, {describe(made.rig.skeleton, solver)});
  const StateHandle plain_state = make_state(*plain);
  for (uint32_t step = 0; step < 3; ++step) {
    made.rig.pose(step, 0);
    const std::vector<float> before(made.rig.matrices().begin(), made.rig.matrices().end());
    made.rig.step(*plain, *plain_state, kRow, kSolveStep);
    const std::vector<float> wanted(made.rig.matrices().begin(), made.rig.matrices().end());
    const std::vector<float> skins(made.rig.skins().begin(), made.rig.skins().end());
    made.rig.pose(step, 0);
    ASSERT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &kInput, kSolveStep),
              MIEN_OK);
    EXPECT_TRUE(same_bits(span_of(wanted), made.rig.matrices()));
    EXPECT_TRUE(same_bits(span_of(skins), made.rig.skins()));
    EXPECT_NE(before, wanted) << "the solver does nothing";
  }
}

TEST(SolverStack, EachKindIsTheSolverOfTheRuntime) {
  {
    Solvers made;
    made.add().aim = &made.aim;
    AimSolver solver;
    solver.joint = made.leaf;
    solver.target_curve = 2;
    solver.cone_cosine = std::cos(40 * 3.14159265f / 180);
    expect_same(made, solver);
  }
  {
    Solvers made;
    made.add().space = &made.space;
    SpaceSolver solver;
    solver.joint = made.child;
    solver.spaces[0] = kNoSolverJoint;
    solver.spaces[1] = made.middle;
    solver.space_count = 2;
    solver.curve = 1;  // far above 1: the last space, as curve 5 says
    solver.ease_ticks = 10 * kSolveStep;
    expect_same(made, solver);
  }
  {
    Solvers made;
    made.add().spring = &made.spring;
    SpringSolver solver;
    solver.joint = made.leaf;
    solver.frequency = 2;
    solver.damping = 0.2f;
    solver.rest_offset[1] = 0.5f;
    expect_same(made, solver);
  }
  {
    Solvers made;
    made.add().twist = &made.twist;
    TwistSolver solver;
    solver.source = made.middle;
    solver.joints[0] = made.leaf;
    solver.shares[0] = 0.5f;
    solver.joint_count = 1;
    expect_same(made, solver);
  }
  {
    Solvers made;
    made.add().copy = &made.copy;
    CopySolver solver;
    solver.source = made.middle;
    solver.joint = made.leaf;
    solver.mirrored = true;
    solver.weight = 0.5f;
    expect_same(made, solver);
  }
}

TEST(SolverStack, CallsTheSolversOfTheCaller) {
  Solvers made;
  made.add().custom = &made.custom;
  MienSolver& second = made.add();
  second.custom = &made.custom;
  second.lods = 2;
  const SolverStackHandle stack = made.stack();
  const SolverStateHandle state = Solvers::state(stack);
  MienSolverStackInfo info = sized<MienSolverStackInfo>();
  ASSERT_EQ(mien_solver_stack_info(stack.get(), &info), MIEN_OK);
  EXPECT_EQ(info.solver_count, 2u);
  EXPECT_EQ(info.output_count, 2u);
  EXPECT_EQ(info.curve_count, 6u);
  EXPECT_EQ(info.joint_count, 12u);

  made.rig.pose(1, 0);
  const float height = made.rig.model(made.root[0])[13];
  ASSERT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &kInput, kSolveStep),
            MIEN_OK);
  EXPECT_EQ(made.seen.calls, 1u) << "the second one is for LOD 1";
  EXPECT_EQ(made.seen.joints, 12u);
  EXPECT_EQ(made.seen.ticks, kSolveStep);
  EXPECT_EQ(made.seen.row, 1);
  EXPECT_TRUE(made.seen.reset);
  EXPECT_FLOAT_EQ(made.rig.model(made.root[0])[13], height + 1);

  MienSolverInput input = kInput;
  input.lod = 1;
  made.rig.pose(1, 0);
  ASSERT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &input, 0), MIEN_OK);
  EXPECT_EQ(made.seen.calls, 3u);
  EXPECT_FALSE(made.seen.reset);
  EXPECT_FLOAT_EQ(made.seen.previous, height + 1);
  EXPECT_FLOAT_EQ(made.rig.model(made.root[0])[13], height + 2 + 1)
      << "each has a state of its own";
  MienFloatView outputs = {}, transforms = {};
  ASSERT_EQ(mien_solver_state_outputs(state.get(), 0, &outputs), MIEN_OK);
  ASSERT_EQ(outputs.count, 1u);
  EXPECT_EQ(outputs.data[0], 2);
  ASSERT_EQ(mien_solver_state_outputs(state.get(), 1, &outputs), MIEN_OK);
  EXPECT_EQ(outputs.data[0], 1);
  EXPECT_EQ(mien_solver_state_outputs(state.get(), 2, &outputs), MIEN_ERROR_INDEX);
  ASSERT_EQ(mien_solver_state_transforms(state.get(), &transforms), MIEN_OK);
  EXPECT_EQ(transforms.count, 120u);

  input.is_reset = 1;
  ASSERT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &input, 0), MIEN_OK);
  EXPECT_TRUE(made.seen.reset);
}

TEST(SolverStack, NormalsFollowTheScalesOfSolvers) {
  const auto flatten = [](void*, const MienSolverCall* call) {
    for (uint32_t j = 0; j < call->joint_count; ++j) call->poses[0].locals[j * 10 + 8] = 0.25f;
  };
  Solvers made;
  made.custom = {};
  made.custom.solve = flatten;
  made.custom.writes = made.root;
  made.custom.write_count = 1;
  made.add().custom = &made.custom;
  const SolverStackHandle stack = made.stack();
  const SolverStateHandle state = Solvers::state(stack);
  made.rig.pose(3, 0);
  EXPECT_FALSE(made.rig.joints().non_uniform_scale);
  ASSERT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &kInput, kSolveStep),
            MIEN_OK);
  EXPECT_TRUE(made.rig.joints().non_uniform_scale);
}

TEST(SolverStack, NamesASolverThatWritesMoreThanItSays) {
  Solvers made;
  made.custom.solve = move_another;
  MienSolver& solver = made.add();
  solver.custom = &made.custom;
  solver.name = "hat";
  const SolverStackHandle unchecked = made.stack(), stack = made.stack(MIEN_OK, 1);
  const SolverStateHandle careless = Solvers::state(unchecked), state = Solvers::state(stack);
  MienStringView name;
  EXPECT_EQ(mien_solver_state_undeclared(careless.get(), &name), MIEN_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(mien_solver_state_undeclared(state.get(), &name), MIEN_OK);
  EXPECT_EQ(name.count, 0u);
  ASSERT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &kInput, 1), MIEN_OK);
  ASSERT_EQ(mien_solver_state_undeclared(state.get(), &name), MIEN_OK);
  EXPECT_EQ(std::string(name.data, name.count), "hat");
}

TEST(SolverStack, ABatchIsEachAlone) {
  constexpr size_t kCount = 70;  // more than a solver is called with
  Solvers made;
  made.add().custom = &made.custom;
  made.add().spring = &made.spring;
  const SolverStackHandle stack = made.stack();
  std::vector<SolverStateHandle> states;
  std::vector<DeformerInstanceHandle> instances;
  std::vector<MienSolverState*> state_list;
  std::vector<MienDeformerInstance*> instance_list;
  std::vector<MienSolverInput> inputs(kCount, kInput);
  for (size_t i = 0; i < kCount; ++i) {
    states.push_back(Solvers::state(stack));
    instances.push_back(create_deformer_instance(made.rig.deformer.get()));
    state_list.push_back(states.back().get());
    instance_list.push_back(instances.back().get());
  }
  const SolverStateHandle alone = Solvers::state(stack);
  const auto seed_of = [](size_t i, uint32_t step) { return static_cast<uint32_t>(i % 3) + step; };
  for (uint32_t step = 0; step < 2; ++step) {
    for (size_t i = 0; i < kCount; ++i) {
      Deformed::update(instance_list[i], random_values(made.rig.rig.get(), seed_of(i, step), 0));
    }
    ASSERT_EQ(mien_solver_state_step_batch(state_list.data(), instance_list.data(), inputs.data(),
                                           kCount, kSolveStep),
              MIEN_OK);
  }
  for (uint32_t step = 0; step < 2; ++step) {
    made.rig.pose(seed_of(69, step), 0);
    ASSERT_EQ(mien_solver_state_step(alone.get(), made.rig.instance.get(), &kInput, kSolveStep),
              MIEN_OK);
  }
  MienFloatView last = {};
  ASSERT_EQ(mien_deformer_instance_joint_matrices(instance_list[69], &last), MIEN_OK);
  EXPECT_TRUE(same_bits(made.rig.matrices(), {last.data, last.count}));

  const uint32_t calls = made.seen.calls;
  const auto refused = [&](MienStatus expected) {
    EXPECT_EQ(mien_solver_state_step_batch(state_list.data(), instance_list.data(), inputs.data(),
                                           kCount, kSolveStep),
              expected);
    EXPECT_EQ(made.seen.calls, calls);
  };
  state_list[69] = state_list[0];
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  state_list[69] = states[69].get();
  instance_list[69] = instance_list[0];
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  instance_list[69] = nullptr;
  refused(MIEN_ERROR_NULL_ARGUMENT);
  instance_list[69] = instances[69].get();
  inputs[69].row_count = 5;
  refused(MIEN_ERROR_MISMATCH);
  inputs[69].row_count = 6;
  const SolverStackHandle other = made.stack();
  const SolverStateHandle stranger = Solvers::state(other);
  state_list[69] = stranger.get();
  refused(MIEN_ERROR_MISMATCH);
}

TEST(SolverStack, RefusesWhatIsWrong) {
  const auto refused = [](MienStatus expected, auto&& change) {
    Solvers made;
    MienSolver& solver = made.add();
    change(made, solver);
    made.stack(expected);
  };
  const MienStatus invalid = MIEN_ERROR_INVALID_ARGUMENT, index = MIEN_ERROR_INDEX;
  refused(invalid, [](Solvers&, MienSolver&) {});
  refused(invalid, [](Solvers& m, MienSolver& s) {
    s.aim = &m.aim;
    s.copy = &m.copy;
  });
  const auto of_aim = [&](MienStatus expected, auto&& change) {
    refused(expected, [&](Solvers& m, MienSolver& s) {
      s.aim = &m.aim;
      change(m, m.aim);
    });
  };
  of_aim(index, [](Solvers&, MienAimSolver& a) { a.joint = 12; });
  of_aim(index, [](Solvers&, MienAimSolver& a) { a.target_joint = 12; });
  of_aim(index, [](Solvers&, MienAimSolver& a) { a.target_curve = 4; });
  of_aim(index, [](Solvers& m, MienAimSolver&) { m.curve_count = 0; });
  of_aim(invalid, [](Solvers&, MienAimSolver& a) { a.axis[2] = 0; });
  of_aim(invalid, [](Solvers&, MienAimSolver& a) { a.up[1] = NAN; });
  of_aim(invalid, [](Solvers&, MienAimSolver& a) { a.cone_degrees = 181; });
  of_aim(invalid, [](Solvers&, MienAimSolver& a) { a.weight = NAN; });
  const auto of_space = [&](MienStatus expected, auto&& change) {
    refused(expected, [&](Solvers& m, MienSolver& s) {
      s.space = &m.space;
      change(m.space);
    });
  };
  of_space(index, [](MienSpaceSolver& s) { s.joint = MIEN_NO_JOINT; });
  of_space(index, [](MienSpaceSolver& s) { s.curve = 6; });
  of_space(invalid, [](MienSpaceSolver& s) { s.spaces = nullptr; });
  of_space(invalid, [](MienSpaceSolver& s) { s.space_count = 9; });
  of_space(invalid, [](MienSpaceSolver& s) { s.ease_ticks = -1; });
  of_space(invalid, [](MienSpaceSolver& s) { s.reserved = 1; });
  const auto of_spring = [&](MienStatus expected, auto&& change) {
    refused(expected, [&](Solvers& m, MienSolver& s) {
      s.spring = &m.spring;
      change(m.spring);
    });
  };
  of_spring(index, [](MienSpringSolver& s) { s.joint = 12; });
  of_spring(invalid, [](MienSpringSolver& s) { s.frequency = 0; });
  of_spring(invalid, [](MienSpringSolver& s) { s.damping = -1; });
  of_spring(invalid, [](MienSpringSolver& s) { s.rest_offset[0] = INFINITY; });
  const auto of_twist = [&](MienStatus expected, auto&& change) {
    refused(expected, [&](Solvers& m, MienSolver& s) {
      s.twist = &m.twist;
      change(m.twist);
    });
  };
  of_twist(index, [](MienTwistSolver& t) { t.source = 12; });
  of_twist(invalid, [](MienTwistSolver& t) { t.joint_count = 0; });
  of_twist(invalid, [](MienTwistSolver& t) { t.joint_count = 9; });
  of_twist(invalid, [](MienTwistSolver& t) { t.shares = nullptr; });
  of_twist(invalid, [](MienTwistSolver& t) { t.axis[0] = 0; });
  refused(index, [](Solvers& m, MienSolver& s) {
    s.copy = &m.copy;
    m.copy.source = 12;
  });
  refused(invalid, [](Solvers& m, MienSolver& s) {
    s.copy = &m.copy;
    m.copy.weight = 2;
  });
  const auto of_custom = [&](MienStatus expected, auto&& change) {
    refused(expected, [&](Solvers& m, MienSolver& s) {
      s.custom = &m.custom;
      change(m.custom);
    });
  };
  static const uint16_t far[1] = {12};
  of_custom(index, [](MienUserSolver& u) { u.writes = far; });
  of_custom(index, [](MienUserSolver& u) { u.previous_joints = far; });
  of_custom(invalid, [](MienUserSolver& u) { u.solve = nullptr; });
  of_custom(invalid, [](MienUserSolver& u) { u.write_count = 0; });
  of_custom(invalid, [](MienUserSolver& u) { u.write_count = 13; });
  of_custom(invalid, [](MienUserSolver& u) { u.read_count = 1; });
  of_custom(invalid, [](MienUserSolver& u) { u.state_bytes = UINT32_MAX; });
  of_custom(invalid, [](MienUserSolver& u) { u.output_count = UINT32_MAX; });
  refused(invalid, [](Solvers& m, MienSolver& s) {  // reads what the next one moves
    s.aim = &m.aim;
    m.aim.target_joint = m.middle;
    m.copy.joint = m.middle;
    m.copy.source = m.leaf;
    m.add().copy = &m.copy;
  });
}

TEST(SolverStack, StepsAreChecked) {
  Solvers made;
  made.add().spring = &made.spring;
  const SolverStackHandle stack = made.stack();
  const SolverStateHandle handle = Solvers::state(stack);
  MienSolverState* const state = handle.get();
  MienDeformerInstance* const instance = made.rig.instance.get();
  EXPECT_EQ(mien_solver_state_step(state, instance, nullptr, 0), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_solver_state_step(state, instance, &kInput, -1), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_solver_state_step(nullptr, instance, &kInput, 0), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_solver_state_step(state, nullptr, &kInput, 0), MIEN_ERROR_NULL_ARGUMENT);
  MienSolverInput input = kInput;
  input.lod = 64;
  EXPECT_EQ(mien_solver_state_step(state, instance, &input, 0), MIEN_ERROR_INVALID_ARGUMENT);
  input = {nullptr, 6, 0, 0};
  EXPECT_EQ(mien_solver_state_step(state, instance, &input, 0), MIEN_ERROR_NULL_ARGUMENT);
  SolvedRig other(7, 12);
  EXPECT_EQ(mien_solver_state_step(state, other.instance.get(), &kInput, 0), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(
      mien_solver_state_step(reinterpret_cast<MienSolverState*>(stack.get()), instance, &kInput, 0),
      MIEN_ERROR_HANDLE);
  EXPECT_EQ(mien_solver_state_step_batch(nullptr, nullptr, nullptr, 0, 0), MIEN_OK);
  EXPECT_EQ(mien_solver_state_step_batch(nullptr, nullptr, nullptr, 1, 0),
            MIEN_ERROR_NULL_ARGUMENT);
  MienSolverStack* made_stack = nullptr;
  EXPECT_EQ(mien_solver_stack_create(made.rig.deformer.get(), nullptr, &made_stack, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  MienSolverStackDesc desc = sized<MienSolverStackDesc>();
  desc.solver_count = 257;
  desc.solvers = made.list.data();
  EXPECT_EQ(mien_solver_stack_create(made.rig.deformer.get(), &desc, &made_stack, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  mien_solver_stack_destroy(nullptr);
  mien_solver_state_destroy(nullptr);
}

TEST(SolverStack, StatesOutliveTheStackAndTheDeformer) {
  Solvers made;
  made.add().copy = &made.copy;
  SolverStackHandle stack = made.stack();
  const SolverStateHandle state = Solvers::state(stack);
  stack.reset();
  made.rig.deformer.reset();
  made.rig.pose(2, 0);
  EXPECT_EQ(mien_solver_state_step(state.get(), made.rig.instance.get(), &kInput, kSolveStep),
            MIEN_OK);
}

TEST(SolverStack, EveryFailedAllocationIsReportedAndNothingLeaks) {
  Solvers made;
  made.add().aim = &made.aim;
  made.add().spring = &made.spring;
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  for (size_t fail_at = 1;; ++fail_at) {
    counting.restart();
    counting.fail_at = fail_at;
    MienSolverStackDesc desc = sized<MienSolverStackDesc>();
    desc.solvers = made.list.data();
    desc.solver_count = made.list.size();
    desc.curve_count = 6;
    desc.allocator = &allocator;
    MienSolverStack* stack = nullptr;
    const MienStatus created =
        mien_solver_stack_create(made.rig.deformer.get(), &desc, &stack, nullptr);
    MienSolverState* state = nullptr;
    const auto state_desc = desc_with<MienSolverStateDesc>(&allocator);
    const MienStatus status = created == MIEN_OK
                                  ? mien_solver_state_create(stack, &state_desc, &state, nullptr)
                                  : created;
    mien_solver_state_destroy(state);
    mien_solver_stack_destroy(stack);
    ASSERT_TRUE(counting.clean()) << counting.first_wrong;
    if (counting.failed == 0) {
      EXPECT_EQ(status, MIEN_OK);
      EXPECT_GT(fail_at, 3u);
      break;
    }
    EXPECT_EQ(status, MIEN_ERROR_MEMORY);
  }
}

}  // namespace
}  // namespace mien
