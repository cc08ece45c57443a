// SPDX-License-Identifier: MIT
// The file that is checked, the poses that it is checked in, and what the library makes of them.
#pragma once

#include "integrations/program/accept/rig_model.h"

namespace mien::cli {

/// Everything that evaluation gives, of one instance at one LOD.
struct Results {
  std::vector<float> controls, joints, channels, maps;
};

/// Each with a fresh instance of its own.
Results evaluate_fresh(const MienRig* rig, const std::vector<float>& raw, uint32_t lod);

/// Whether all bits are the same.
bool same_bits(const Results& a, const Results& b);

struct AcceptedRig {
  RigFile file;  // with all layers and LODs
  Rig rig;       // of the best instruction set
  model::LayerRig model;
  std::vector<std::vector<float>> poses;  // raw controls

  uint32_t lod_count() const { return file.info.lod_count; }
};

/// Opens the file and draws the poses: the initial values, then 24 in which each raw control takes part,
/// with values from 0 to 1 and random rotations of up to a quarter turn. The same every time.
AcceptedRig open_accepted_rig(const std::string& path, const Session& session);

/// Instruction sets of this machine: MIEN_ISA_...
std::vector<uint32_t> present_isas();

Rig create_rig(const AcceptedRig& from, uint32_t isa, uint32_t rotation_output);

}  // namespace mien::cli
