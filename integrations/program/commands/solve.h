// SPDX-License-Identifier: MIT
// What `mien solve` was asked to do.
#pragma once

#include <string>

#include "integrations/program/commands/solve_target.h"

namespace mien::cli {

/// As it was typed.
struct SolveCommand {
  TargetOptions target;             // the first TARGET
  std::vector<std::string> others;  // and those after it
  std::string weights;
  std::string rig, controls, first, rate, keys, smooth, sparse, robust, reach, report, images;
  std::string place, neutral;
  bool rigid = false, focal = false;
  OutputFile output;
};

/// Finds the controls and writes them.
void solve_file(const SolveCommand& command, const Session& session);

}  // namespace mien::cli
