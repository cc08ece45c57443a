// SPDX-License-Identifier: MIT
// Lanes over time as a picture: one row per lane that moves, and which layer made its value.
#pragma once

#include <string>
#include <vector>

namespace mien::cli {

struct LanePlot {
  std::string name;
  std::vector<float> values;               // [frame]
  std::vector<std::vector<float>> stages;  // [stage][frame] the value after it
};

/// Lanes below each other over `seconds`; the share of each stage is filled in its color.
std::string lanes_svg(const std::vector<LanePlot>& lanes, const std::vector<std::string>& stages,
                      double seconds);

}  // namespace mien::cli
