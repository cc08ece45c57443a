// SPDX-License-Identifier: MIT
// What kinds of behavior a rig has beyond its counts: how joints turn, solvers by kind, networks
// by activation and operation.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "integrations/program/io/rig_file.h"

namespace mien::cli {

/// Counts by kind.
struct Tally {
  const char* key;    // in JSON
  const char* label;  // for people
  std::vector<std::pair<const char*, uint64_t>> kinds;

  bool empty() const;
};

/// All of them, whether the rig has any or not; of layers that were loaded.
std::vector<Tally> tally_behavior(const RigFile& file);

}  // namespace mien::cli
