// SPDX-License-Identifier: MIT
// Controls named on the command line, and names chosen by patterns.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "integrations/program/io/frames.h"

namespace mien::cli {

struct Control {
  uint32_t kind;  // MIEN_KIND_RAW_CONTROL or MIEN_KIND_GUI_CONTROL
  uint32_t index;
  std::string name;
};

/// A name without its prefix, which ends with the last dot: "jawOpen" of "CTRL_expressions.jawOpen".
std::string_view short_name(std::string_view name);

/// Finds what has a short name; the rig is read once, whatever the number of names.
class ShortNames {
 public:
  ShortNames(const MienRig* rig, uint32_t kind);

  /// The indices, ascending.
  const std::vector<uint32_t>& find(const std::string& name) const;

 private:
  std::unordered_map<std::string, std::vector<uint32_t>> indices_;
};

/// A raw or GUI control by its name, or by its short name if only one control has it; raw controls
/// come first. Fails with the nearest name and exit code 2.
Control find_control(const MienRig* rig, const std::string& name, const std::string& what,
                     const std::string& where);

/// The value of a control from the command line. `option` is for the message.
float parse_control_value(const std::string& option, const std::string& number);

/// Settings such as "jawOpen=0.5" as a frame: GUI controls are mapped first, then raw ones are set.
Frame parse_settings(const std::vector<std::string>& settings, const MienRig* rig,
                     const std::string& shown);

/// `pattern` is a list of names with commas between; * stands for any characters and ? for one. Case
/// does not matter, and a pattern may match the name or the short name.
bool matches_pattern(std::string_view pattern, std::string_view name);

}  // namespace mien::cli
