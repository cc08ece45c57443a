// SPDX-License-Identifier: MIT
// The bones that a baked face keeps: those that a program turns by itself.
#pragma once

#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

/// Gives a still scene the root, neck, head and eye joints of the rig, as far as it has joints of such
/// names ("C_Head", "neck_01", "FACIAL_L_Eye"), and a skin: each position follows the kept joints that
/// its own are, or hang from, at most `influences` of them. A rig without such joints gets no skeleton.
void add_bake_skeleton(const RigSource& source, uint32_t influences, RigScene& scene);

}  // namespace mien::gltf
