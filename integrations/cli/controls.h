// SPDX-License-Identifier: MIT
// Controls named on the command line, and names chosen by patterns.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "integrations/cli/cli.h"
#include "integrations/cli/frames.h"

namespace mien::cli {

struct Control {
  uint32_t kind;  // MIEN_KIND_RAW_CONTROL or MIEN_KIND_GUI_CONTROL
  uint32_t index;
  std::string name;
};

std::string rig_name(const MienRig* rig, uint32_t kind, uint32_t index);

/// What follows the last dot of a name that has one in the middle: "jawOpen" of
/// "CTRL_expressions.jawOpen".
std::string_view short_name(std::string_view name);

/// A raw or GUI control by its name, or by its short name if only one control has it; raw controls
/// first. Fails with the nearest name: exit code 2.
Control find_control(const MienRig* rig, const std::string& name, const std::string& what,
                     const std::string& where);

/// Settings like "jawOpen=0.5" as a frame: GUI controls are mapped first, raw controls then set.
Frame parse_settings(const std::vector<std::string>& settings, const MienRig* rig,
                     const std::string& shown);

/// `pattern` is names with * for any characters and ? for one, with commas between; upper and lower
/// case count as equal, and a pattern may leave out what comes before the short name.
bool matches_pattern(std::string_view pattern, std::string_view name);

}  // namespace mien::cli
