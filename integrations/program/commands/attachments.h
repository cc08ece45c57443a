// SPDX-License-Identifier: MIT
// Meshes of other files that an exported face carries.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/gltf/attachment.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

struct AttachmentOptions {
  std::vector<std::string> soft, rigid;  // paths of OBJ and GLB files
};

/// Adds them to the scene, one mesh for each object of a file, and says in notes what they follow. The
/// weights of their targets are those of the scene.
std::vector<gltf::Attached> add_attachments(const AttachmentOptions& options, gltf::Scene& scene,
                                            const Session& session);

}  // namespace mien::cli
