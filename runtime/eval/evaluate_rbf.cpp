// SPDX-License-Identifier: MIT
// RBF solvers: raw controls -> pose controls (docs/rig-evaluation.md, 6 "RBF solvers").
#include <algorithm>

#include "runtime/eval/instance_packet.h"
#include "runtime/eval/stages.h"
#include "simd/lanes.h"
#include "simd/rbf_kernels.h"

namespace mien {
namespace {

void fetch(const Instance& instance, const Span<uint16_t>& controls, float* to) {
  const float* from = instance.controls.data;
#pragma GCC unroll 4
  for (size_t i = 0; i < controls.count; ++i) to[i] = from[controls[i]];
}

void run_solvers(const Rig& rig, Instance& instance, const Span<uint16_t>& solvers,
                 uint32_t first_block, uint32_t block_count) {
  const RbfTable& rbf = rig.rbf;
  RbfArgs args;
  args.solvers = rbf.plans.data;
  args.list = solvers.data;
  args.count = static_cast<uint32_t>(solvers.count);
  args.inputs = instance.rbf_inputs.data;
  args.rotations = instance.rbf_rotations.data;
  args.swings = rbf.swings.data;
  args.first_block = first_block;
  args.block_count = block_count;
  args.targets = rbf.targets.data;
  args.inverses = rbf.inverses.data;
  args.pose_scales = rbf.pose_scales.data;
  args.pose_factors = rbf.pose_factors.data;
  args.weights = instance.rbf_weights.data;
  args.results = instance.rbf_results.data;
  args.controls = instance.controls.data;
  rig.kernels->rbf_solvers(args);
}

/// Clears every control that a pose of the solver drives.
void clear_pose_controls(const Rig& rig, const RbfSolver& solver, uint32_t pose_count,
                         Instance& instance) {
  const RbfTable& rbf = rig.rbf;
  for (uint16_t pose : rbf.poses.slice(solver.first_pose, pose_count)) {
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      instance.controls[rbf.pose_outputs[o]] = 0.0f;
    }
  }
}

/// Poses may share controls, and may be multiplied by controls that earlier poses drove.
void add_pose_controls(const Rig& rig, const RbfSolver& solver, const float* results,
                       uint32_t pose_count, Instance& instance) {
  const RbfTable& rbf = rig.rbf;
  for (uint32_t p = 0; p < pose_count; ++p) {
    if (results[p] == 0.0f) continue;
    const uint32_t pose = rbf.poses[solver.first_pose + p];
    float factor = results[p];
    for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
      factor = saturated(factor * instance.controls[rbf.pose_inputs[i]]);
    }
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      float& control = instance.controls[rbf.pose_outputs[o]];
      control = saturated(control + saturated(rbf.pose_weights[o] * factor));
    }
  }
}

/// For solvers whose results are not written to their controls directly.
void drive_pose_controls(const Rig& rig, uint32_t index, Instance& instance) {
  const RbfSolverPlan& plan = rig.rbf.plans[index];
  if (plan.first_control != kNoFirstControl) return;
  const RbfSolver& solver = rig.rbf.solvers[index];
  const float* results = instance.rbf_results.data + plan.first_lane;
  clear_pose_controls(rig, solver, plan.pose_count, instance);
  add_pose_controls(rig, solver, results, plan.pose_count, instance);
}

}  // namespace

void solve_rbf(const Rig& rig, Instance& instance, uint32_t index) {
  const RbfTable& rbf = rig.rbf;
  const RbfSolverPlan& plan = rbf.plans[index];
  // A solver may read controls that it drives, but not its previous results.
  clear_pose_controls(rig, rbf.solvers[index], plan.pose_count, instance);
  uint32_t first_block = 0, block_count = 0;
  if (takes_parts(plan)) {
    const uint32_t count = plan.input_count / plan.angle_inputs;
    first_block = plan.first_input / kBlockLanes;
    block_count = count ? (plan.first_input + count - 1) / kBlockLanes + 1 - first_block : 0;
    const size_t first = size_t{first_block} * 4 * kBlockLanes;
    fetch(instance, rbf.rotations.slice(first, size_t{block_count} * 4 * kBlockLanes),
          instance.rbf_rotations.data + first);
  } else {
    fetch(instance, rbf.inputs.slice(plan.first_input, plan.input_count),
          instance.rbf_inputs.data + plan.first_input);
  }
  uint16_t number = static_cast<uint16_t>(index);
  run_solvers(rig, instance, {&number, 1}, first_block, block_count);
  drive_pose_controls(rig, index, instance);
}

namespace {

void solve_alone(const Rig& rig, Instance& instance, const Span<uint16_t>& solvers) {
  const RbfTable& rbf = rig.rbf;
  if (!rbf.independent) {
    for (uint16_t solver : solvers) solve_rbf(rig, instance, solver);
    return;
  }
  fetch(instance, rbf.inputs, instance.rbf_inputs.data);
  fetch(instance, rbf.rotations, instance.rbf_rotations.data);
  run_solvers(rig, instance, solvers, 0,
              static_cast<uint32_t>(rbf.rotations.count / (4 * kBlockLanes)));
  for (uint16_t solver : solvers) drive_pose_controls(rig, solver, instance);
}

/// The end of the controls that a solver reads.
uint32_t inputs_end(const RbfTable& rbf) {
  uint32_t end = 0;
  for (const auto* inputs : {&rbf.inputs, &rbf.rotations}) {
    for (const uint16_t control : *inputs) end = std::max<uint32_t>(end, control + 1u);
  }
  return end;
}

/// For solvers that do not read what others write.
void solve_together(const InstancePacket& packet, const Span<uint16_t>& solvers) {
  const RbfTable& rbf = packet.rig.rbf;
  const PacketScratch& scratch = *packet.scratch;
  float *rows[kBatchLanes], *results[kBatchLanes];
  for (uint32_t i = 0; i < packet.count; ++i) {
    rows[i] = packet.instances[i]->controls.data;
    results[i] = packet.instances[i]->rbf_results.data;
  }
  gather_controls(packet, 0, inputs_end(rbf));
  RbfBatchArgs args;
  args.solvers = rbf.plans.data;
  args.list = solvers.data;
  args.count = static_cast<uint32_t>(solvers.count);
  args.inputs = rbf.inputs.data;
  args.rotation_inputs = rbf.rotations.data;
  args.swings = rbf.swings.data;
  args.targets = rbf.targets.data;
  args.inverses = rbf.inverses.data;
  args.pose_scales = rbf.pose_scales.data;
  args.pose_factors = rbf.pose_factors.data;
  args.controls = scratch.controls.data;
  args.rotations = scratch.rbf_rotations.data;
  args.weights[0] = scratch.rbf_weights[0].data;
  args.weights[1] = scratch.rbf_weights[1].data;
  args.rows = rows;
  args.results = results;
  args.block_count = static_cast<uint32_t>(rbf.rotations.count / (4 * kBlockLanes));
  args.lane_count = packet.count;
  packet.rig.kernels->rbf_batch(args);
  for (uint16_t solver : solvers) {
    if (rbf.plans[solver].first_control != kNoFirstControl) continue;
    for (uint32_t i = 0; i < packet.count; ++i) {
      drive_pose_controls(packet.rig, solver, *packet.instances[i]);
    }
  }
}

}  // namespace

bool evaluate_rbf(const InstancePacket& packet) {
  const Rig& rig = packet.rig;
  if (rig.rbf_count == 0) return false;  // without a pose control there is nothing to drive
  const Span<uint16_t> solvers = rig.rbf.lod_solvers.at(packet.lod);
  if (solvers.empty()) return false;
  if (!rig.rbf.independent || !fills_lanes(packet)) {
    for (uint32_t i = 0; i < packet.count; ++i) solve_alone(rig, *packet.instances[i], solvers);
    return false;
  }
  solve_together(packet, solvers);
  // Otherwise lanes without an instance would not be 0.
  return packet.count == kBatchLanes &&
         std::all_of(solvers.begin(), solvers.end(), [&](uint16_t solver) {
           return rig.rbf.plans[solver].first_control != kNoFirstControl;
         });
}

void gather_after_rbf(const InstancePacket& packet) {
  const RbfTable& rbf = packet.rig.rbf;
  uint32_t at = inputs_end(rbf);
  for (const uint16_t solver : rbf.lod_solvers.at(packet.lod)) {
    const RbfSolverPlan& plan = rbf.plans[solver];
    if (plan.first_control > at) gather_controls(packet, at, plan.first_control);
    at = std::max<uint32_t>(at, plan.first_control + plan.pose_count);
  }
  gather_controls(packet, at, packet.rig.control_count);
}

}  // namespace mien
