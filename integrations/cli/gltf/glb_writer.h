// SPDX-License-Identifier: MIT
// Scene -> GLB.
#pragma once

#include <string>

#include "integrations/cli/gltf/scene.h"

namespace mien::gltf {

/// A binary glTF 2.0 file; the same scene gives the same bytes everywhere.
///
///   nodes       first one that holds the skeleton (named as the scene), then the joints, then one
///               for each mesh
///   scenes      one per LOD, the finest first and shown first; all of them share the skeleton
///   skin        one for all meshes
///   targets     sparse where that is smaller; names in mesh.extras.targetNames
///   animation   joint channels for what moves, weights for each mesh with targets
///
/// Throws ExportError for numbers that are not finite and for more than 4 GiB.
std::string write_glb(const Scene& scene);

}  // namespace mien::gltf
