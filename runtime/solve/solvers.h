// SPDX-License-Identifier: MIT
// The built-in solvers. Each is a struct of parameters and a function describe(), which returns what
// create_stack() takes; the struct must live until that call. Lengths are in the rig's unit, points in its
// model space. Nothing here calls the math library, so results have the same bits everywhere.
#pragma once

#include "runtime/solve/solver_stack.h"

namespace mien {

// set_up() checks the numbers of a solver and brings them into the form that steps use: directions get
// length 1, and 0 0 0 becomes the default of a direction that has one. Returns null, or what is wrong.

constexpr uint16_t kNoSolverJoint = 0xFFFF;
constexpr uint32_t kMaxSolverJoints = 8;
constexpr float kFarthest = 1e9f;
constexpr int64_t kMaxEaseTicks = int64_t{1} << 40;  // 26 minutes

/// Turns a joint so that one of its axes points at a target, by the shortest rotation, then about that axis
/// so that `up_axis` comes as near to `up` as possible. Beyond the cone it points at the cone's edge.
struct AimSolver {
  uint16_t joint = 0;
  uint16_t target_joint = kNoSolverJoint;  // else the target is at three curves of the row
  uint32_t target_curve = 0;
  float axis[3] = {0, 0, 1};     // of the joint, unit
  float up_axis[3] = {0, 0, 0};  // of the joint, unit; zero: no turn about the axis
  float up[3] = {0, 1, 0};       // in model space, unit
  float cone_cosine = -1;        // of the largest angle from where the neutral pose points it
  float weight = 1;              // 0 ... 1
  // Set by describe().
  float cone_axis[3] = {};  // in the space of the parent
  uint16_t reads[3] = {};
};
/// `cone_degrees`: the largest angle, 0 ... 180; 0: any.
const char* set_up(AimSolver& solver, float cone_degrees);
SolverDesc describe(const Skeleton& skeleton, AimSolver& solver);

/// Moves a joint as if its parent were attached to another joint. The curve's value, rounded, selects one of
/// the spaces. When it changes, the joint stays where it is, and the difference to the new space eases out
/// by a quintic.
struct SpaceSolver {
  uint16_t joint = 0;
  uint16_t spaces[kMaxSolverJoints] = {};  // kNoSolverJoint: model space
  uint32_t space_count = 0;
  uint32_t curve = 0;
  int64_t ease_ticks = 0;
  uint16_t reads[kMaxSolverJoints + 1] = {};  // set by describe()
};
const char* set_up(const SpaceSolver& solver);
SolverDesc describe(const Skeleton& skeleton, SpaceSolver& solver);

/// Lets the position of a joint swing about its position in the pose: a damped harmonic oscillator in model
/// space, advanced by its exact solution, so it is stable for any step, and independent of the step size
/// while its goal does not move. Output 0 is its speed.
struct SpringSolver {
  uint16_t joint = 0;
  float frequency = 3;         // of the undamped spring, in Hertz; above 0
  float damping = 0.3f;        // damping ratio, 0 or more; 1 is critical damping
  float rest_offset[3] = {};   // from the pose's place, in model space
  float stretch = kFarthest;   // largest distance from it
  float teleport = kFarthest;  // a goal that jumps farther in a step takes the joint along
  uint16_t reads[2] = {};      // set by describe()
};
/// A stretch or teleport of 0 becomes the default.
const char* set_up(SpringSolver& solver);
SolverDesc describe(const Skeleton& skeleton, SpringSolver& solver);

/// Gives joints a share of the twist of another joint about an axis: 0.5 is half of its angle. Their own
/// twist is replaced. Output 0 is the sine of half of the angle.
struct TwistSolver {
  uint16_t source = 0;
  float axis[3] = {1, 0, 0};  // of the source and of all joints, unit
  uint16_t joints[kMaxSolverJoints] = {};
  float shares[kMaxSolverJoints] = {};  // -1 ... 1
  uint32_t joint_count = 0;
  uint16_t reads[1] = {};  // set by describe()
};
const char* set_up(TwistSolver& solver);
SolverDesc describe(const Skeleton& skeleton, TwistSolver& solver);

/// Moves a joint as another one was moved from its neutral pose, or as its mirror image.
struct CopySolver {
  uint16_t source = 0, joint = 0;
  bool mirrored = false;
  float mirror_axis[3] = {1, 0, 0};  // from right to left in model space, unit
  float weight = 1;                  // 0 ... 1
  uint16_t reads[1] = {};            // set by describe()
};
const char* set_up(CopySolver& solver);
SolverDesc describe(const Skeleton& skeleton, CopySolver& solver);

}  // namespace mien
