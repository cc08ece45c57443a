// SPDX-License-Identifier: MIT
// Materials with textures for the meshes of a scene.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "integrations/program/gltf/scene.h"
#include "integrations/program/io/materials.h"

namespace mien::gltf {

struct ImageOptions {
  bool embed = true;   // the bytes, or else the path
  std::string folder;  // of the file to write, which paths are relative to
  const std::map<std::string, cli::TextureFile>* held =
      nullptr;  // images that are no files, by "paths"
};

/// A path from a folder, which is the current one if it is empty.
std::string path_from(const std::string& folder, const std::string& path);

/// Gives each mesh of which `materials` says something this material in place of the one that its name chose. A
/// mesh with a texture for its base color loses its vertex colors. Each image is in the scene once. Meshes without
/// texture coordinates have no use for textures: their names are returned. Fails as read_texture().
std::vector<std::string> apply_materials(const cli::Materials& materials,
                                         const ImageOptions& options, Scene& scene);

}  // namespace mien::gltf
