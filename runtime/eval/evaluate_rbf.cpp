// SPDX-License-Identifier: MIT
// RBF solvers: raw controls -> pose controls (rig-evaluation 6).
#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

void fetch_inputs(const Rig& rig, uint32_t index, Instance& instance) {
  const RbfSolver& solver = rig.rbf.solvers[index];
  const RbfSolverPlan& plan = rig.rbf.plans[index];
  const uint16_t* controls = rig.rbf.inputs.data + plan.first_input;
  float* inputs = instance.rbf_inputs.data + plan.first_input;
  for (uint32_t i = 0; i < plan.input_count; ++i) inputs[i] = instance.controls[controls[i]];
  if (solver.distance < kSwingAngle) return;
  for (uint32_t i = 0; i + 4 <= plan.input_count; i += 4) {
    float* q = inputs + i;
    const Quaternion part =
        rotation_part({q[0], q[1], q[2], q[3]}, solver.twist_axis, solver.distance == kSwingAngle);
    q[0] = part.x;
    q[1] = part.y;
    q[2] = part.z;
    q[3] = part.w;
  }
}

void run_solvers(const Rig& rig, Instance& instance, const uint16_t* list, uint32_t count) {
  RbfArgs args;
  args.solvers = rig.rbf.plans.data;
  args.list = list;
  args.count = count;
  args.inputs = instance.rbf_inputs.data;
  args.targets = rig.rbf.targets.data;
  args.inverses = rig.rbf.inverses.data;
  args.pose_scales = rig.rbf.pose_scales.data;
  args.pose_factors = rig.rbf.pose_factors.data;
  args.weights = instance.rbf_weights.data;
  args.results = instance.rbf_results.data;
  rig.kernels->rbf_solvers(args);
}

/// Every control that a pose of the solver drives.
void clear_pose_controls(const Rig& rig, const RbfSolver& solver, uint32_t pose_count,
                         Instance& instance) {
  const RbfTable& rbf = rig.rbf;
  for (uint16_t pose : rbf.poses.slice(solver.first_pose, pose_count)) {
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      instance.controls[rbf.pose_outputs[o]] = 0.0f;
    }
  }
}

float finite(float value) {
  constexpr float kLargest = 3.40282347e38f;
  return value < kLargest ? (value > -kLargest ? value : -kLargest) : kLargest;
}

/// Poses may share controls, and multiply with others, which earlier poses may have driven.
void add_pose_controls(const Rig& rig, const RbfSolver& solver, const float* results,
                       uint32_t pose_count, Instance& instance) {
  const RbfTable& rbf = rig.rbf;
  for (uint32_t p = 0; p < pose_count; ++p) {
    if (results[p] == 0.0f) continue;
    const uint32_t pose = rbf.poses[solver.first_pose + p];
    float factor = results[p];
    for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
      factor = finite(factor * instance.controls[rbf.pose_inputs[i]]);
    }
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      float& control = instance.controls[rbf.pose_outputs[o]];
      control = finite(control + finite(rbf.pose_weights[o] * factor));
    }
  }
}

void drive_pose_controls(const Rig& rig, uint32_t index, Instance& instance) {
  const RbfTable& rbf = rig.rbf;
  const RbfSolver& solver = rbf.solvers[index];
  const RbfSolverPlan& plan = rbf.plans[index];
  const float* results = instance.rbf_results.data + plan.first_lane;
  if (!solver.direct) {
    clear_pose_controls(rig, solver, plan.pose_count, instance);
    add_pose_controls(rig, solver, results, plan.pose_count, instance);
    return;
  }
  const uint16_t* outputs = rbf.direct_outputs.data + plan.first_lane;
  for (uint32_t p = 0; p < plan.pose_count; ++p) instance.controls[outputs[p]] = results[p];
}

}  // namespace

void solve_rbf(const Rig& rig, Instance& instance, uint32_t index) {
  const auto listed = static_cast<uint16_t>(index);
  // A solver may read what it drives, but not what it gave before.
  clear_pose_controls(rig, rig.rbf.solvers[index], rig.rbf.plans[index].pose_count, instance);
  fetch_inputs(rig, index, instance);
  run_solvers(rig, instance, &listed, 1);
  drive_pose_controls(rig, index, instance);
}

void evaluate_rbf(const Rig& rig, Instance& instance, uint32_t lod) {
  if (rig.rbf_count == 0) return;  // without a pose control there is nothing to drive
  const Span<uint16_t> solvers = rig.rbf.lod_solvers.at(lod);
  if (!rig.rbf.independent) {
    for (uint16_t solver : solvers) solve_rbf(rig, instance, solver);
    return;
  }
  for (uint16_t solver : solvers) fetch_inputs(rig, solver, instance);
  run_solvers(rig, instance, solvers.data, static_cast<uint32_t>(solvers.count));
  for (uint16_t solver : solvers) drive_pose_controls(rig, solver, instance);
}

}  // namespace mien
