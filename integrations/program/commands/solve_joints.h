// SPDX-License-Identifier: MIT
// Joints of an animated GLB as a target of `mien solve`.
#pragma once

#include "integrations/program/commands/solve_target.h"

namespace mien::cli {

/// Nodes with names of joints, as joint values: differences from the neutral pose. Joints without a node are
/// missing.
SolveTarget read_glb_joints(const TargetOptions& options, const SolvedRig& rig,
                            const Session& session);

}  // namespace mien::cli
