// SPDX-License-Identifier: MIT
#include "runtime/rig/work.h"

#include <algorithm>

namespace mien {
namespace {

uint32_t count_lods(const Rig& rig, uint64_t lods) {
  uint32_t count = 0;
  for (uint32_t l = 0; l < rig.lod_count; ++l) count += lods >> l & 1;
  return count;
}

/// Distances, weights and interpolation, which kernels compute, then the controls that the poses drive.
uint64_t solver_steps(const RbfTable& rbf, uint32_t index, uint64_t budget) {
  const RbfSolverPlan& plan = rbf.plans[index];
  const uint64_t lanes = padded(uint64_t{plan.pose_count});
  uint64_t steps = 64 + lanes * (plan.input_count / 4 + 4);
  if (plan.interpolative) steps += lanes * plan.pose_count / 4;
  if (plan.first_control != kNoFirstControl) return steps;
  const uint32_t first = rbf.solvers[index].first_pose;
  for (uint32_t p = 0; p < plan.pose_count && steps <= budget; ++p) {
    const uint32_t pose = rbf.poses[first + p];
    steps += 8 + uint64_t{2} * (rbf.first_input[pose + 1] - rbf.first_input[pose]) +
             uint64_t{6} * (rbf.first_output[pose + 1] - rbf.first_output[pose]);
  }
  return steps;
}

uint64_t layer_steps(const MlTable& ml, const MlStep& step, uint64_t budget) {
  uint64_t steps = 0;
  for (uint32_t l = 0; l < step.layer_count && steps <= budget; ++l) {
    const NetworkLayer& layer = ml.layers[step.first_layer + l];
    steps += 32 + padded(uint64_t{layer.output_count}) * (uint64_t{layer.input_count} + 8) / 2;
  }
  return steps;
}

}  // namespace

uint64_t count_rbf_steps(const Rig& rig, uint64_t budget) {
  const RbfTable& rbf = rig.rbf;
  uint64_t steps = 0;
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    for (const uint16_t solver : rbf.lod_solvers.at(l)) {
      if (steps > budget) return steps;
      steps += solver_steps(rbf, solver, budget);
      // A solver that reads what another one writes gathers all its inputs itself.
      steps += rbf.plans[solver].input_count;
    }
  }
  return steps;
}

uint64_t count_ml_steps(const Rig& rig, uint64_t budget) {
  const MlTable& ml = rig.ml;
  uint64_t steps = 0;
  for (const MlStep& step : ml.steps) {
    if (steps > budget) return steps;
    const uint64_t lods = count_lods(rig, step.lods);
    uint64_t once =
        32 + uint64_t{step.gather_count} + 2 * uint64_t{step.scatter_count} + step.output_count;
    if (step.layer_count != 0) {
      once += layer_steps(ml, step, budget);
      for (uint32_t d = 0; d < step.dependency_count && step.gather_count == 0; ++d) {
        once += 4 + uint64_t{ml.dependencies[step.first_dependency + d].count};
      }
    } else {
      once += step.dependency_count * (4 + 4 * uint64_t{step.output_count});
    }
    steps += lods * once;
  }
  return steps;
}

}  // namespace mien
