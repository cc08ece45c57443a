// SPDX-License-Identifier: MIT
// The findings of `mien accept`, as plain structs. Details name parts of the rig by their numbers, so that
// a report reveals nothing about the character.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mien::cli {

struct Check {
  std::string name;
  bool passed = true;
  bool skipped = false;  // something that it needs is missing; counts as passed
  std::string detail;    // one sentence
};

inline Check skipped_check(const std::string& name, const std::string& why) {
  return {name, true, true, why};
}

/// "1.2e-05"
std::string short_number(double value);

}  // namespace mien::cli
