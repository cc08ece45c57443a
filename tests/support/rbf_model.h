// SPDX-License-Identifier: MIT
// RBF solvers of a LayerRig in double precision (docs/rig-evaluation.md, 6 "RBF solvers").
#pragma once

#include <vector>

#include "tests/support/layer_rig.h"

namespace mien {

/// Weight of each pose before normalization, for inputs as the controls give them.
std::vector<double> model_rbf_weights(const LayerRig& rig, const PlainRbfSolver& solver,
                                      const std::vector<double>& inputs);

/// Runs one solver on the controls.
void model_rbf_solver(const LayerRig& rig, const PlainRbfSolver& solver,
                      std::vector<double>& controls);

/// Runs those of a LOD.
void model_rbf(const LayerRig& rig, uint32_t lod, std::vector<double>& controls);

}  // namespace mien
