// SPDX-License-Identifier: MIT
// Materials of a mesh, written beside the rig that is made of it.
#pragma once

#include <mien.h>

#include <memory>
#include <string>
#include <vector>

#include "integrations/program/io/materials.h"
#include "integrations/program/io/output.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

/// OUT.materials.json and the images in the folder OUT.textures: those that the mesh file holds, and with `copy` all.
/// Without materials, or if the rig goes to standard output, there are none. Everything is in temporary files until
/// commit().
class AuthoredMaterials {
 public:
  AuthoredMaterials(const MeshFile& mesh, const MienDna* dna, const std::string& rig, bool copy,
                    const Session& session);
  ~AuthoredMaterials();
  void commit();

 private:
  std::vector<std::unique_ptr<Output>> outputs_;
  std::string made_folder_;  // to be removed again if it stays empty
};

}  // namespace mien::cli
