// SPDX-License-Identifier: MIT
// RBF solvers of a LayerRig in double precision (docs/rig-evaluation.md, 6 "RBF solvers").
#pragma once

#include <vector>

#include "integrations/program/model/layer_rig.h"

namespace mien::model {

/// What rounding may do to solvers: the squared dot products of angular distances are off by `noise` of themselves, up or
/// down, and the weights that an inverse multiplies by a 32nd of it; the products by `noise`. `signs` chooses one of
/// many sequences of ups and downs, which are independent of each other. What that changes tells how far results can be
/// trusted (docs/rig-evaluation.md, 10).
struct Rounding {
  double noise = 0;
  uint32_t signs = 0;
};

/// Weight of each pose before normalization, for inputs as the controls give them.
template <class T>
std::vector<T> model_rbf_weights(const LayerRig& rig, const PlainRbfSolver& solver,
                                 const std::vector<T>& inputs, const Rounding& rounding = {});

/// Runs one solver on the controls.
template <class T>
void model_rbf_solver(const LayerRig& rig, const PlainRbfSolver& solver, std::vector<T>& controls,
                      const Rounding& rounding = {});

/// Runs those of a LOD.
template <class T>
void model_rbf(const LayerRig& rig, uint32_t lod, std::vector<T>& controls,
               const Rounding& rounding = {});

}  // namespace mien::model
