// SPDX-License-Identifier: MIT
// RIG on the command line as a DNA file: opening it, and compiling a rig of it.
#pragma once

#include <string>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

/// All layers that evaluation needs: everything but geometry.
constexpr uint32_t kEvaluationLayers =
    MIEN_LAYER_DESCRIPTOR | MIEN_LAYER_DEFINITION | MIEN_LAYER_BEHAVIOR |
    MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR | MIEN_LAYER_RBF_BEHAVIOR |
    MIEN_LAYER_JOINT_BEHAVIOR_METADATA | MIEN_LAYER_TWIST_SWING_BEHAVIOR;

// No file has more. A mask of LODs has a bit for each up to the one after.
constexpr uint32_t kMaxLods = 33;
constexpr uint64_t kLastMaskLod = 63;

/// The DNA points into the bytes of standard input, so they stand before it and outlive it.
struct RigFile {
  std::string shown;  // path, or "standard input"
  std::string bytes;
  Dna dna;
  MienDnaInfo info;
};

/// `path` may be "-". Prints a note if LODs were named that the file does not have.
RigFile open_rig_file(const std::string& path, const MienDnaDesc& desc, const Session& session);

/// Files may name meshes and leave their geometry out.
bool has_geometry(const RigFile& file);

Rig create_rig(const RigFile& file, const MienRigDesc& desc);
MienRigInfo rig_info(const MienRig* rig);
uint32_t rig_count(const MienRig* rig, uint32_t kind);
std::string rig_name(const MienRig* rig, uint32_t kind, uint32_t index);

}  // namespace mien::cli
