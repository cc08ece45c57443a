// SPDX-License-Identifier: MIT
// A rig, its deformer and one character of both.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/rig_file.h"

namespace mien::cli {

struct Character {
  Rig rig;
  Deformer deformer;
  Instance instance;
  DeformerInstance pose;

  /// `delta_error` as in MienDeformerDesc.
  Character(const MienDna* dna, const MienRigDesc& desc, uint32_t deformer_storage,
            double delta_error, const std::string& shown);

  MienMutableFloatView raw() const;
  void evaluate(uint32_t lod);
  /// The positions of a mesh after evaluate(): 3 floats each.
  MienFloatView deformed(uint32_t mesh);
  uint64_t rig_bytes() const { return rig_info(rig.get()).rig_bytes; }
  uint64_t deformer_bytes() const;
  MienMesh mesh(uint32_t index) const;
  MienIndex16View meshes_of(uint32_t lod) const;
  /// The influences of a position: as many joints as weights. With 32-bit storage only.
  void influences(uint32_t mesh, uint32_t position, MienIndex16View& joints,
                  MienFloatView& weights) const;
};

}  // namespace mien::cli
