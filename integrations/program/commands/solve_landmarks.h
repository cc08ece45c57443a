// SPDX-License-Identifier: MIT
// Landmarks to solve: a CSV of their positions, and JSON that says where they are on the mesh.
#pragma once

#include "integrations/program/commands/solve_target.h"

namespace mien::cli {

/// `images`: two coordinates each, as the camera of the JSON sees them.
SolveTarget read_landmarks(const TargetOptions& options, bool images, const SolvedRig& rig);

}  // namespace mien::cli
