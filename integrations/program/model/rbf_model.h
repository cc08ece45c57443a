// SPDX-License-Identifier: MIT
// RBF solvers of a LayerRig in double precision (docs/rig-evaluation.md, 6 "RBF solvers").
#pragma once

#include <vector>

#include "integrations/program/model/layer_rig.h"

namespace mien::model {

/// Weight of each pose before normalization, for inputs as the controls give them. With `noise` the squared
/// dot products of angular distances are off by this part of themselves, up or down, as rounding may have it: what
/// that changes tells how far results can be trusted (docs/rig-evaluation.md, 10).
std::vector<double> model_rbf_weights(const LayerRig& rig, const PlainRbfSolver& solver,
                                      const std::vector<double>& inputs, double noise = 0);

/// Runs one solver on the controls.
void model_rbf_solver(const LayerRig& rig, const PlainRbfSolver& solver,
                      std::vector<double>& controls, double noise = 0);

/// Runs those of a LOD.
void model_rbf(const LayerRig& rig, uint32_t lod, std::vector<double>& controls, double noise = 0);

}  // namespace mien::model
