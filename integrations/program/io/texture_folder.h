// SPDX-License-Identifier: MIT
// Textures in a folder, by the usual names: skin_basecolor.png, T_Head_Normal.png, teeth_roughness.jpg.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/materials.h"

namespace mien::cli {

/// What a file's name says, without its ending: the kind, by its last words (basecolor, albedo, diffuse, color,
/// d, bc; normal, nrm, n; roughness, rough, r), and what it is of, by the words before: "skin".
struct TextureName {
  bool known = false;
  TextureKind kind = TextureKind::kBaseColor;
  std::string subject;  // lower case, letters and digits only; may be empty
};
TextureName parse_texture_name(const std::string& stem);

/// Gives meshes the textures of a folder (PNG and JPEG files, in the order of their names). A texture is for the
/// meshes whose material or name is its subject ("head" for head_lod0_mesh); else for the meshes of that
/// class (teeth, eye, lash, ...; skin, face and head are skin, and so is no subject). What is set already is replaced.
struct TextureFolder {
  size_t used = 0;                  // files
  std::vector<std::string> unused;  // names of files that no mesh takes
};
TextureFolder add_texture_folder(const std::string& folder, const std::vector<std::string>& meshes,
                                 Materials& materials);

}  // namespace mien::cli
