// SPDX-License-Identifier: MIT
// Rig -> OBJ, for a quick look: one pose, no skeleton.
#pragma once

#include <string>

#include "integrations/program/gltf/rig_source.h"
#include "integrations/program/io/materials.h"

namespace mien::gltf {

/// All meshes as `pose` deforms them, with recomputed normals: one group per mesh, faces with the
/// corners of the file, texture coordinates where there are some, colors of positions (after x y
/// z, as many programs read them) where the file has some. Meters, y up, z to the front. With the
/// name of a material library, meshes use its materials: those of `materials`, or by their names.
std::string write_obj(const RigSource& source, MienDeformerInstance* pose,
                      const std::string& material_library, const cli::Materials& materials);

/// The material library (MTL), with paths of textures from its folder.
std::string write_mtl(const RigSource& source, const cli::Materials& materials,
                      const std::string& folder);

}  // namespace mien::gltf
