// SPDX-License-Identifier: MIT
// Time that this process ran, whatever else the machine does.
#pragma once

#include <ctime>

namespace mien {

inline double cpu_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

}  // namespace mien
