// SPDX-License-Identifier: MIT
// The numbers of a DNA file, for the model in double precision.
#pragma once

#include "integrations/program/io/rig_file.h"
#include "integrations/program/model/layer_rig.h"

namespace mien::cli {

/// `file` was opened with all layers of the behavior, and `rig` was made of it.
model::LayerRig read_rig_model(const RigFile& file, const MienRig* rig);

/// First raw controls of the quaternions that twists, swings and RBF solvers by angle read.
std::vector<uint16_t> quaternion_inputs(const model::LayerRig& rig);

}  // namespace mien::cli
