// SPDX-License-Identifier: MIT
// Whether a target is in the unit and axes of the rig.
#pragma once

#include "integrations/program/commands/solve.h"

namespace mien::cli {

/// Each frame of vertices or of a surface is checked as it is read: kInvalid if it is more than 5 times as large or
/// small as the mesh, unless --unit says its unit; or if vertices are the mesh with other axes, unless they may turn.
/// What --mask leaves out, and targets of other kinds, are not looked at.
void watch_space(const TargetOptions& options, bool rigid, const SolvedRig& rig,
                 SolveTarget& target);

}  // namespace mien::cli
