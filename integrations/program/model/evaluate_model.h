// SPDX-License-Identifier: MIT
// All stages of a LayerRig in double precision, in the order of docs/rig-evaluation.md, 1.3.
#pragma once

#include "integrations/program/model/rotation_model.h"

namespace mien::model {

/// Controls of a new instance after one evaluation of a LOD, with these raw controls; all masks are 1.
/// All correctives are computed, also those that the LOD does not use. `noise` is that of a Rounding.
std::vector<double> evaluate_controls(const LayerRig& rig, const std::vector<float>& raw,
                                      uint32_t lod, double noise = 0);

}  // namespace mien::model
