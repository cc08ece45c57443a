// SPDX-License-Identifier: MIT
// Surfaces to solve: meshes from files, and another rig whose controls are given.
#pragma once

#include "integrations/program/commands/solve_target.h"

namespace mien::cli {

/// Positions of `mesh` from a folder of OBJ files, an OBJ or a GLB; morph targets of a GLB are a frame each.
SolveTarget read_meshes(const TargetOptions& options, const SolvedRig& rig, uint32_t mesh);

/// Meshes of any topology, as surfaces: from the same files.
SolveTarget read_surfaces(const TargetOptions& options, const SolvedRig& rig);

/// What frames of controls do to a mesh of the rig `options.from`, moved to `mesh`, which has the same topology:
/// each position moves from the rest of its own mesh as that of the other one does.
SolveTarget read_weights(const TargetOptions& options, const SolvedRig& rig, uint32_t mesh,
                         const Session& session);

}  // namespace mien::cli
