// SPDX-License-Identifier: MIT
// Skeletons, poses and stacks as tests of solvers make them.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "runtime/solve/solver_stack.h"
#include "tests/support/deform_rig.h"

namespace mien {

/// A rig of joints that hang on each other at random.
struct SolvedRig : Deformed {
  const Skeleton& skeleton;

  SolvedRig(uint32_t seed, uint32_t joints, bool one_root = false)
      : Deformed(random_deform_rig(seed, options(joints, one_root))),
        skeleton(capi::object(deformer.get())->skeleton) {}

  static DeformRigOptions options(uint32_t joints, bool one_root) {
    DeformRigOptions result;
    result.joints = joints;
    result.meshes = 1;
    result.one_root = one_root;
    return result;
  }

  uint32_t joint_count() const { return skeleton.joint_count; }
  JointPose& joints() { return capi::object(instance.get())->joints; }

  /// Random deltas.
  void pose(uint32_t seed, double scale_skew) {
    update(random_values(rig.get(), seed, scale_skew));
  }
  void neutral_pose() { pose_joints(skeleton, nullptr, joints()); }

  bool is_below(uint16_t joint, uint16_t top) const {
    while (joint != top && skeleton.parents[joint] != joint) joint = skeleton.parents[joint];
    return joint == top;
  }
  uint16_t joint_with_children() const {
    for (uint16_t j = 0; j < joint_count(); ++j) {
      if (skeleton.parents[j] != j && child_of(j) != j) return j;
    }
    ADD_FAILURE() << "no joint has both";
    return 0;
  }
  uint16_t child_of(uint16_t joint) const {
    for (uint16_t j = 0; j < joint_count(); ++j) {
      if (skeleton.parents[j] == joint && j != joint) return j;
    }
    return joint;
  }
  /// One that does not hang on joint_with_children().
  uint16_t leaf() const {
    for (uint16_t j = 0; j < joint_count(); ++j) {
      if (child_of(j) == j && !is_below(j, joint_with_children())) return j;
    }
    ADD_FAILURE() << "no leaf";
    return 0;
  }

  void step(const Stack& stack, StackState& state, const std::vector<float>& row, int64_t ticks = 0,
            uint32_t lod = 0, bool reset = false) {
    const StackPose character = {&state, &joints(), row.empty() ? nullptr : row.data(), lod, reset};
    step_stack(stack, {&character, 1}, ticks);
  }
  const float* model(uint16_t joint) { return joints().model.data + size_t{joint} * kMatrixFloats; }
};

struct CloseStack {
  void operator()(Stack* stack) const { release(stack); }
  void operator()(StackState* state) const { release(state); }
};
using StackHandle = std::unique_ptr<Stack, CloseStack>;
using StateHandle = std::unique_ptr<StackState, CloseStack>;

inline StackHandle make_stack(const Skeleton& skeleton, const std::vector<SolverDesc>& solvers,
                              bool check_writes = false) {
  Stack* stack = nullptr;
  Error error;
  const StackDesc desc = {{solvers.data(), solvers.size()}, 0, check_writes};
  EXPECT_EQ(create_stack(skeleton, desc, default_allocator(), stack, error), Status::kOk)
      << error.message;
  return StackHandle(stack);
}

inline StateHandle make_state(const Stack& stack) {
  return StateHandle(create_stack_state(stack, default_allocator()));
}

inline std::pair<Status, std::string> stack_error(const Skeleton& skeleton,
                                                  const std::vector<SolverDesc>& solvers) {
  Stack* stack = nullptr;
  Error error;
  const Status status =
      create_stack(skeleton, {{solvers.data(), solvers.size()}}, default_allocator(), stack, error);
  EXPECT_EQ(stack != nullptr, status == Status::kOk);
  release(stack);
  return {status, error.message};
}

}  // namespace mien
