// SPDX-License-Identifier: MIT
#include "integrations/program/model/layer_rig.h"

#include <algorithm>

namespace mien::model {

bool LayerRig::has(const LodIndices& list, uint32_t lod, uint32_t index) const {
  return list.empty() || std::count(list[lod].begin(), list[lod].end(), index) != 0;
}

template <class T>
std::vector<T> initial_controls(const LayerRig& rig) {
  std::vector<T> controls(rig.control_count());
  const auto start = [&](uint16_t control) {
    const bool w = std::find(rig.raw_w.begin(), rig.raw_w.end(), control) != rig.raw_w.end();
    if (w) controls[control] = 1;
  };
  for (const PlainRbfSolver& solver : rig.solvers) {
    for (uint16_t input : solver.inputs) start(input);
  }
  for (const std::vector<PlainTurn>& all : {rig.twists, rig.swings}) {
    for (const PlainTurn& turn : all) {
      for (uint16_t input : turn.inputs) start(input);
    }
  }
  for (uint16_t w : rig.ml_w) controls[size_t{rig.first_ml()} + w] = 1;
  return controls;
}
template std::vector<double> initial_controls(const LayerRig&);
template std::vector<Dual> initial_controls(const LayerRig&);

}  // namespace mien::model
