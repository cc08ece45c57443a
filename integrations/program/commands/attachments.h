// SPDX-License-Identifier: MIT
// Meshes of other files that an exported face carries.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "integrations/program/gltf/attachment.h"
#include "integrations/program/gltf/scene_materials.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

struct AttachmentOptions {
  std::vector<std::string> soft, rigid;  // paths of OBJ and GLB files
};

struct Attachments {
  std::vector<gltf::Attached> meshes;
  Materials materials;  // of their files, by the names of the meshes in the scene
  std::map<std::string, TextureFile>
      images;  // that the files hold, by the paths that the materials have for them
};

/// Adds them to the scene, one mesh for each object of a file, and says in notes what they follow. The
/// weights of their targets are those of the scene.
Attachments add_attachments(const AttachmentOptions& options, gltf::Scene& scene,
                            const Session& session);

/// Gives attached meshes the materials of their files. Images that those hold are left out with a note if
/// `options` embeds none.
void add_attached_materials(const Attachments& attachments, gltf::ImageOptions options,
                            gltf::Scene& scene, const Session& session);

}  // namespace mien::cli
