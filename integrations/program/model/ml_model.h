// SPDX-License-Identifier: MIT
// Machine-learned behavior of a LayerRig in double precision (docs/rig-evaluation.md, 8 "Machine-learned
// behavior").
#pragma once

#include <vector>

#include "integrations/program/model/layer_rig.h"

namespace mien::model {

/// Values per joint, as keys 0, 1 and 2 of the ML joints give them.
struct MlJointLayout {
  uint32_t translation = 0, rotation = 0, scale = 0, width = 0;
};
MlJointLayout ml_joint_layout(const LayerRig& rig);

/// Outputs of a network.
template <class T>
std::vector<T> model_network(const PlainNetwork& network, std::vector<T> inputs);

/// Runs all operations, or networks, of a LOD on the controls, then converts what ML joints read.
/// `masks` are those of the regions.
template <class T>
void model_ml(const LayerRig& rig, uint32_t lod, const std::vector<double>& masks, bool blend_masks,
              std::vector<T>& controls);

}  // namespace mien::model
