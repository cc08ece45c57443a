// SPDX-License-Identifier: MIT
// --mask of `mien solve`: how much each vertex, landmark or joint counts.
#pragma once

#include "integrations/program/commands/solve_target.h"

namespace mien::cli {

/// A weight of 0 or more for each point of the target, or, if it has none, for each joint value. `path`: NPY with a
/// number for each point or joint, or JSON with names and positions. Fails with kInvalid.
std::vector<float> read_mask(const std::string& path, const SolvedRig& rig,
                             const SolveTarget& target);

}  // namespace mien::cli
