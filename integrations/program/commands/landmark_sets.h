// SPDX-License-Identifier: MIT
// Sets of landmarks that trackers give, and their places on a rig.
#pragma once

#include "integrations/program/commands/solve.h"

namespace mien::cli {

/// Writes a file for --landmarks with the places of a set (`command.place`: "68" or "mediapipe") on the rig.
void place_landmarks(const SolveCommand& command, const Session& session);

}  // namespace mien::cli
