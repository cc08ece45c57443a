// SPDX-License-Identifier: MIT
// What the meshes of a rig are made to look like: by the colors that the file brings, else by what
// their names say they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/cli/rig_file.h"
#include "integrations/picture/camera.h"
#include "integrations/picture/render.h"

namespace mien::cli {

enum class MeshKind {
  kSkin,
  kEye,
  kTeeth,
  kTongue,
  kHair,   // brows and lashes that are solid
  kCover,  // films and cards that are nothing without their textures: shells of eyes, lashes,
           // saliva
};

MeshKind mesh_kind(const std::string& name);
picture::Material mesh_material(MeshKind kind);

/// Colors of a mesh from the metadata "mien.colors.NAME" of the file: base64 of r g b for each
/// position. Empty if there is none; if it does not fit, a note says so.
std::vector<uint8_t> read_mesh_colours(const RigFile& file, const std::string& name,
                                       uint32_t position_count, const Session& session);

/// Pupil and iris on the front of an eyeball, by position.
std::vector<uint8_t> paint_eye(const float* positions, uint32_t position_count,
                               picture::Vec3 front);

}  // namespace mien::cli
