// SPDX-License-Identifier: MIT
// The only RBF solver of a character's head: it compares the rotations of neck and head with poses.
#include "author/generate/synthetic/head.h"

namespace mien::synthetic {

namespace {

// Sine and cosine of half of 30 degrees, as constants: no library computes them, so they are the same
// everywhere.
constexpr float kSine = 0.25881904510252074f, kCosine = 0.96592582628906831f;

/// Axis and sign of each direction, in the order of the pose controls.
struct Direction {
  uint8_t axis;
  float sine;
};
constexpr Direction kDirections[] = {{0, -kSine}, {0, kSine},  {1, kSine},
                                     {1, -kSine}, {2, -kSine}, {2, kSine}};

/// In pose `pose` one of the joints is turned in one direction, the others are at rest.
float target_of(uint32_t pose, uint32_t input) {
  const uint32_t joint = input / 4, part = input % 4;
  const Direction& turn = kDirections[pose / 3];
  if (joint != 2 - pose % 3) return part == 3 ? 1.0f : 0.0f;  // U, M, D: head, neck_02, neck_01
  return part == 3 ? kCosine : part == turn.axis ? turn.sine : 0.0f;
}

}  // namespace

bool make_neck_solver(const Head& head, Arena& arena, dna::DnaView& out) {
  const uint32_t poses = head.pose_count(), inputs = head.input_count();
  if (poses == 0) return true;
  dna::RbfBehavior& rbfb = out.rbfb;
  if (!make(arena, 1, rbfb.solvers) || !make(arena, poses, rbfb.poses) ||
      !make(arena, poses, out.rbfe.pose_control_names) || !make(arena, poses, out.rbfe.poses)) {
    return false;
  }
  auto in_lod = [](size_t, size_t) { return true; };
  if (!make_lod_map(arena, head.sizes->lod_count, rbfb.solvers.count, in_lod, rbfb.lod_solvers)) {
    return false;
  }
  dna::NewArray<uint16_t> controls, indices;
  dna::NewArray<float> targets;
  if (!make(arena, inputs, controls) || !make(arena, poses, indices) ||
      !make(arena, size_t{poses} * inputs, targets)) {
    return false;
  }
  for (uint32_t i = 0; i < inputs; ++i) {
    controls.set(i, static_cast<uint16_t>(head.sizes->raw_count + i));
  }
  for (uint32_t pose = 0; pose < poses; ++pose) {
    const uint32_t control = head.raw_count() + head.sizes->psd_count + pose;
    dna::NewArray<uint16_t> factors, outputs;
    dna::NewArray<float> weights;
    if (!make(arena, 0, factors) || !make(arena, 1, outputs) || !make(arena, 1, weights))
      return false;
    indices.set(pose, static_cast<uint16_t>(pose));
    for (uint32_t i = 0; i < inputs; ++i) targets.set(pose * inputs + i, target_of(pose, i));
    outputs.set(0, static_cast<uint16_t>(control));
    weights.set(0, 1.0f);
    Text name = Text().add("CTRL_expressions.").add(head.controls[control].name);
    if (!copy_text(arena, name, rbfb.poses[pose].name)) return false;
    rbfb.poses[pose].scale = 1.0f;
    out.rbfe.pose_control_names[pose] = rbfb.poses[pose].name;
    out.rbfe.poses[pose] = {factors, outputs, weights};
  }
  dna::RbfSolver& solver = rbfb.solvers[0];
  solver.raw_control_indices = controls;
  solver.pose_indices = indices;
  solver.raw_control_values = targets;
  // Full in its pose, zero at rest and in other poses, each of which is 30 degrees away.
  solver.radius = 30;
  solver.weight_threshold = 0.001f;
  solver.automatic_radius = 1;  // off
  solver.distance_method = 1;   // between quaternions
  solver.function_type = 2;     // linear
  return copy_text(arena, Text().add("neck_head_solver"), solver.name);
}

}  // namespace mien::synthetic
