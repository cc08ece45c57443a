// SPDX-License-Identifier: MIT
// RBF solvers: raw controls -> pose controls (rig-evaluation 6).
#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

void fetch_inputs(const Rig& rig, const RbfSolver& solver, Instance& instance) {
  const uint16_t* controls = rig.rbf.inputs.data + solver.first_input;
  float* inputs = instance.rbf_inputs.data;
  for (uint32_t i = 0; i < solver.input_count; ++i) inputs[i] = instance.controls[controls[i]];
  if (solver.distance < kSwingAngle) return;
  for (uint32_t i = 0; i + 4 <= solver.input_count; i += 4) {
    float* q = inputs + i;
    const Quaternion part =
        rotation_part({q[0], q[1], q[2], q[3]}, solver.twist_axis, solver.distance == kSwingAngle);
    q[0] = part.x;
    q[1] = part.y;
    q[2] = part.z;
    q[3] = part.w;
  }
}

float clamp01(float value) { return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; }

/// Weight of each pose, in instance.rbf_weights.
void weigh_poses(const Rig& rig, const RbfSolver& solver, Instance& instance) {
  float* weights = instance.rbf_weights.data;
  RbfWeightArgs args;
  args.targets = rig.rbf.targets.data + solver.first_target;
  args.inputs = instance.rbf_inputs.data;
  args.input_count = solver.input_count;
  args.pose_count = static_cast<uint32_t>(align_up(solver.pose_count, kBlockRows));
  args.weights = solver.interpolative ? weights + args.pose_count : weights;
  args.scale = solver.scale;
  args.function = solver.function;
  args.angular = solver.distance != kEuclidean;
  rig.kernels->rbf_weights(args);
  if (!solver.interpolative) return;

  // The inverse times the weights.
  const float* inverse = rig.rbf.inverses.data + solver.first_inverse;
  for (uint32_t p = 0; p < solver.pose_count; ++p) {
    const float* row =
        inverse + size_t{p / kBlockRows} * solver.pose_count * kBlockRows + p % kBlockRows;
    float sum = 0;
    for (uint32_t t = 0; t < solver.pose_count; ++t)
      sum += row[size_t{t} * kBlockRows] * args.weights[t];
    weights[p] = clamp01(sum);
  }
}

void drive_pose_controls(const Rig& rig, const RbfSolver& solver, Instance& instance) {
  const RbfTable& rbf = rig.rbf;
  const float* weights = instance.rbf_weights.data;
  float sum = 0;
  for (uint32_t p = 0; p < solver.pose_count; ++p) sum += weights[p];
  const bool normalize = sum > 1.0f || (solver.always_normalize && sum > 0.0f);
  const float scale = normalize ? 1.0f / sum : 1.0f;

  for (uint32_t p = 0; p < solver.pose_count; ++p) {
    const uint32_t pose = rbf.poses[solver.first_pose + p];
    const float value = weights[p] * (scale < 3.4e38f ? scale : 0.0f) * rbf.pose_scales[pose];
    if (!(value > solver.threshold)) continue;
    float factor = value;
    for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
      factor *= instance.controls[rbf.pose_inputs[i]];
    }
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      instance.controls[rbf.pose_outputs[o]] += rbf.pose_weights[o] * factor;
    }
  }
}

}  // namespace

void solve_rbf(const Rig& rig, Instance& instance, uint32_t index) {
  const RbfTable& rbf = rig.rbf;
  const RbfSolver& solver = rbf.solvers[index];
  for (uint32_t p = 0; p < solver.pose_count; ++p) {
    const uint32_t pose = rbf.poses[solver.first_pose + p];
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      instance.controls[rbf.pose_outputs[o]] = 0.0f;
    }
  }
  fetch_inputs(rig, solver, instance);
  weigh_poses(rig, solver, instance);
  drive_pose_controls(rig, solver, instance);
}

void evaluate_rbf(const Rig& rig, Instance& instance, uint32_t lod) {
  if (rig.rbf_count == 0) return;  // without a pose control there is nothing to drive
  for (uint16_t solver : rig.rbf.lod_solvers.at(lod)) solve_rbf(rig, instance, solver);
}

}  // namespace mien
