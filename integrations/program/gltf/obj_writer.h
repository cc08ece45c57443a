// SPDX-License-Identifier: MIT
// Rig -> OBJ, for a quick look: one pose, no skeleton.
#pragma once

#include <string>

#include "integrations/program/gltf/rig_source.h"

namespace mien::gltf {

/// All meshes as `pose` deforms them, with recomputed normals: one group per mesh, faces with the
/// corners of the file, texture coordinates where there are some, colors of positions (after x y
/// z, as many programs read them) where the file has some. Meters, y up, z to the front. With the
/// name of a material library, meshes use its materials.
std::string write_obj(const RigSource& source, MienDeformerInstance* pose,
                      const std::string& material_library);

/// The material library (MTL): plain colors, by the names of the meshes.
std::string write_mtl(const RigSource& source);

}  // namespace mien::gltf
