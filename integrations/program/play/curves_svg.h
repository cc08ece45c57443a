// SPDX-License-Identifier: MIT
// Curves over time as a vector image: one row per curve that moves, and which layer made its value; below,
// the distances of guards that held something back.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/play/script.h"

namespace mien::cli {

struct CurvePlot {
  std::string name, note;
  std::vector<float> values;               // [frame]
  std::vector<std::vector<float>> stages;  // [stage][frame] the value after it
};

/// [frame], distances in millimeters
struct GuardPlot {
  std::string name;
  std::vector<float> activation, wanted, limit, distance;
};

/// Curves below each other over `seconds`. What a layer adds has its color; what guards, antagonists and
/// limits take away is hatched. Captions stand at their times.
std::string curves_svg(const std::vector<CurvePlot>& curves, const std::vector<std::string>& stages,
                       const std::vector<GuardPlot>& guards, const Captions& captions,
                       double seconds);

}  // namespace mien::cli
