// SPDX-License-Identifier: MIT
// RBF solvers as anyone would write them: one pose after another, the C library's acos and exp, the
// matrix times the weights. The yardstick for the stage.
#pragma once

#include <cstdint>
#include <vector>

#include "capi/include/mien.h"

namespace mien::bench {

struct PlainSolver {
  std::vector<uint16_t> inputs;
  std::vector<uint16_t> poses;
  std::vector<float> targets;  // [pose][input]
  std::vector<float> inverse;  // [pose][pose], if interpolative
  float radius = 0, threshold = 0;
  uint32_t distance = 0, function = 0, twist_axis = 0;
  bool interpolative = false, always_normalize = false;
};

struct PlainPose {
  float scale = 1;
  std::vector<uint16_t> inputs, outputs;
  std::vector<float> weights;
};

struct PlainRbf {
  std::vector<PlainSolver> solvers;
  std::vector<PlainPose> poses;
};

PlainRbf read_plain_rbf(const MienDna* dna);

/// All solvers, on a row of controls.
void evaluate(const PlainRbf& rbf, std::vector<float>& controls);

}  // namespace mien::bench
