// SPDX-License-Identifier: MIT
// Skin weights of a rig, as glTF wants them.
#pragma once

#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

/// Gives the meshes of a scene with joints `options.influences` per vertex at most, of sum 1. Positions that
/// no joint holds follow one that never moves, which is added after the others.
void add_skin(const RigSource& source, const SceneOptions& options, RigScene& result);

/// The same for other joints: `joint_of` gives for each joint of the rig the one to follow. Of more
/// than `influences` the heaviest stay.
void add_skin(const RigSource& source, const std::vector<uint32_t>& joint_of, uint32_t influences,
              RigScene& result);

}  // namespace mien::gltf
