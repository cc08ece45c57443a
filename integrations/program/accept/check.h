// SPDX-License-Identifier: MIT
// What `mien accept` found out about a file, in plain structs. Details name parts of the rig by their numbers,
// so that a report tells nothing of the character.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mien::cli {

struct Check {
  std::string name;
  bool passed = true;
  bool skipped = false;  // what it needs is not there; counts as passed
  std::string detail;    // one sentence
};

inline Check skipped_check(const std::string& name, const std::string& why) {
  return {name, true, true, why};
}

/// "1.2e-05"
std::string short_number(double value);

}  // namespace mien::cli
