// SPDX-License-Identifier: MIT
#include "integrations/program/io/controls.h"

#include <cctype>
#include <cmath>
#include <cstdlib>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

constexpr uint32_t kControlKinds[] = {MIEN_KIND_RAW_CONTROL, MIEN_KIND_GUI_CONTROL};

bool equal_letters(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// One pattern without commas. Backtracks to the last *.
bool matches_glob(std::string_view pattern, std::string_view name) {
  size_t p = 0, n = 0, star = std::string_view::npos, after_star = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || equal_letters(pattern[p], name[n]))) {
      ++p;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++after_star;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

// Far past the range of every control. Larger values are slips of the hand.
constexpr float kLargestSetting = 1000;

}  // namespace

std::string_view short_name(std::string_view name) {
  const size_t dot = name.rfind('.');
  return dot == std::string_view::npos || dot + 1 == name.size() ? name : name.substr(dot + 1);
}

ShortNames::ShortNames(const MienRig* rig, uint32_t kind) {
  const uint32_t count = rig_count(rig, kind);
  for (uint32_t i = 0; i < count; ++i) {
    const std::string name = rig_name(rig, kind, i);
    indices_[std::string(short_name(name))].push_back(i);
  }
}

const std::vector<uint32_t>& ShortNames::find(const std::string& name) const {
  static const std::vector<uint32_t> kNone;
  const auto found = indices_.find(name);
  return found == indices_.end() ? kNone : found->second;
}

Control find_control(const MienRig* rig, const std::string& name, const std::string& what,
                     const std::string& where) {
  for (const uint32_t kind : kControlKinds) {
    uint32_t index = 0;
    if (mien_rig_find_n(rig, kind, name.data(), name.size(), &index) == MIEN_OK)
      return {kind, index, name};
  }
  NearestName nearest(name);
  for (const uint32_t kind : kControlKinds) {
    const ShortNames short_names(rig, kind);
    const std::vector<uint32_t>& found = short_names.find(name);
    if (found.size() == 1) return {kind, found[0], rig_name(rig, kind, found[0])};
    if (found.size() > 1) {
      fail(kInvalid, what, where,
           "\"" + name + "\" is ambiguous: " + rig_name(rig, kind, found[0]) + " or " +
               rig_name(rig, kind, found[1]),
           "give the full name");
    }
    const uint32_t count = rig_count(rig, kind);
    for (uint32_t i = 0; i < count; ++i) nearest.offer(rig_name(rig, kind, i));
  }
  const MatchedName match = match_name(rig, name);
  if (match.is_one()) {
    const uint32_t index = match.shares[0].control;
    return {MIEN_KIND_RAW_CONTROL, index, rig_name(rig, MIEN_KIND_RAW_CONTROL, index)};
  }
  if (match.found()) {
    fail(kInvalid, what, where,
         "\"" + name + "\" is " + std::to_string(match.shares.size()) +
             " controls of this rig, the first is " +
             rig_name(rig, MIEN_KIND_RAW_CONTROL, match.shares[0].control),
         "give one of them");
  }
  fail(kInvalid, what, where, "no raw or GUI control is named \"" + name + "\"",
       nearest.question("'mien info RIG --names raw,gui' lists the names"));
}

float parse_control_value(const std::string& option, const std::string& number) {
  char* end = nullptr;
  const float value = std::strtof(number.c_str(), &end);
  const bool whole = !number.empty() && end == number.c_str() + number.size() &&
                     !std::isspace(static_cast<unsigned char>(number[0]));
  if (!whole) {
    fail_usage(option, "\"" + number + "\" is not a number", "controls are usually in 0..1");
  }
  if (!(std::fabs(value) <= kLargestSetting)) {
    fail_usage(option, "the value has to be a finite number from -1000 to 1000",
               "controls are usually in 0..1");
  }
  return value;
}

Frame parse_settings(const std::vector<std::string>& settings, const MienRig* rig,
                     const std::string& shown) {
  Frame frame;
  for (const std::string& setting : settings) {
    const size_t equals = setting.rfind('=');
    if (equals == std::string::npos || equals == 0) {
      fail_usage("--set \"" + setting + "\"", "this is not NAME=VALUE",
                 "write it as --set jawOpen=0.5");
    }
    const float value = parse_control_value("--set " + setting, setting.substr(equals + 1));
    const Control control =
        find_control(rig, setting.substr(0, equals), "cannot set controls", shown);
    const bool gui = control.kind == MIEN_KIND_GUI_CONTROL;
    std::vector<Assignment>& assignments = gui ? frame.gui : frame.raw;
    for (const Assignment& other : assignments) {
      if (other.index == control.index) {
        fail_usage("--set " + setting, "\"" + control.name + "\" is set twice",
                   "leave one of them out");
      }
    }
    assignments.push_back({control.index, value});
    frame.maps_gui |= gui;
  }
  return frame;
}

bool matches_pattern(std::string_view pattern, std::string_view name) {
  for (size_t begin = 0; begin <= pattern.size();) {
    const size_t comma = std::min(pattern.find(',', begin), pattern.size());
    const std::string_view one = pattern.substr(begin, comma - begin);
    if (matches_glob(one, name) || matches_glob(one, short_name(name))) return true;
    begin = comma + 1;
  }
  return false;
}

}  // namespace mien::cli
