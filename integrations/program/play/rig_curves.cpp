// SPDX-License-Identifier: MIT
#include "integrations/program/play/rig_curves.h"

#include <algorithm>
#include <cctype>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr const char* kCannot = "cannot play scene";
constexpr const char* kHowToList = "'mien info RIG --names raw' lists the names";

std::string in_small_letters(std::string_view word) {
  std::string small(word);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

bool is_variable_name(const std::string& name) {
  return name == "pupil" || name == "breath" || name.compare(0, 5, "head.") == 0 ||
         name.compare(0, 5, "gaze.") == 0 || name.compare(0, 5, "user.") == 0;
}

}  // namespace

RigCurves::RigCurves(const MienRig* rig) {
  for (uint32_t i = 0; i < rig_count(rig, MIEN_KIND_RAW_CONTROL); ++i) {
    controls_.push_back(rig_name(rig, MIEN_KIND_RAW_CONTROL, i));
    by_name_.emplace(controls_.back(), i);
    by_short_name_[in_small_letters(short_name(controls_.back()))].push_back(i);
  }
}

std::vector<size_t> RigCurves::find_controls(const std::string& name) const {
  const auto whole = by_name_.find(name);
  if (whole != by_name_.end()) return {whole->second};
  const auto found = by_short_name_.find(in_small_letters(name));
  if (found == by_short_name_.end()) return {};
  std::vector<size_t> exact;
  for (const size_t i : found->second) {
    if (short_name(controls_[i]) == name) exact.push_back(i);
  }
  return exact.empty() ? found->second : exact;
}

uint16_t RigCurves::variable(const std::string& name) {
  const auto found = std::find(variables_.begin(), variables_.end(), name);
  const size_t index = static_cast<size_t>(found - variables_.begin());
  if (found == variables_.end()) variables_.push_back(name);
  return static_cast<uint16_t>(controls_.size() + index);
}

uint16_t RigCurves::curve(const std::string& name, const std::string& where) {
  const std::vector<size_t> found = find_controls(name);
  if (found.size() > 1) {
    fail(kInvalid, kCannot, where,
         "\"" + one_line(name) + "\" is ambiguous: " + controls_[found[0]] + " or " +
             controls_[found[1]],
         "give the full name");
  }
  if (!found.empty()) return static_cast<uint16_t>(found[0]);
  if (is_variable_name(name)) return variable(name);
  fail(kInvalid, kCannot, where, "no raw control is named \"" + one_line(name) + "\"",
       nearest_question(name, controls_, kHowToList));
}

CurveValues RigCurves::curves(const NamedValues& values, const std::string& where) {
  std::vector<std::pair<uint16_t, float>> sorted;
  for (const auto& [name, value] : values) sorted.emplace_back(curve(name, where), value);
  std::sort(sorted.begin(), sorted.end());
  CurveValues found;
  for (const auto& [curve, value] : sorted) {
    if (!found.curves.empty() && found.curves.back() == curve) {
      const size_t variable = curve - std::min<size_t>(curve, controls_.size());
      const std::string& name = curve < controls_.size() ? controls_[curve] : variables_[variable];
      fail(kInvalid, kCannot, where, "\"" + name + "\" is listed twice", "leave one of them out");
    }
    found.curves.push_back(curve);
    found.values.push_back(value);
  }
  return found;
}

CurveValues RigCurves::present(const NamedValues& values) const {
  std::vector<std::pair<uint16_t, float>> sorted;
  for (const auto& [name, value] : values) {
    const std::vector<size_t> found = find_controls(name);
    if (!found.empty()) sorted.emplace_back(static_cast<uint16_t>(found[0]), value);
  }
  std::sort(sorted.begin(), sorted.end());
  CurveValues found;
  for (const auto& [curve, value] : sorted) {
    found.curves.push_back(curve);
    found.values.push_back(value);
  }
  return found;
}

HeadPose RigCurves::head(const float* row) const {
  HeadPose head;
  for (size_t i = 0; i < variables_.size(); ++i) {
    const float value = row[controls_.size() + i];
    if (variables_[i] == "head.left" || variables_[i] == "head.turn") head.left += value;
    if (variables_[i] == "head.up") head.up += value;
  }
  return head;
}

std::vector<std::string> RigCurves::as_patterns(const std::string& pattern) const {
  if (pattern.empty() || pattern.find('*') + 1 != pattern.size()) return controls_;
  std::vector<std::string> beginnings;
  for (const std::string& name : controls_) {
    beginnings.push_back(std::string(short_name(name).substr(0, pattern.size() - 1)) + "*");
  }
  return beginnings;
}

std::vector<float> RigCurves::mask(const std::vector<std::string>& patterns, bool invert,
                                   const std::string& where) const {
  std::vector<float> mask(controls_.size(), invert ? 1.0f : 0.0f);
  for (const std::string& pattern : patterns) {
    bool matches = false;
    for (size_t i = 0; i < controls_.size(); ++i) {
      if (!matches_pattern(pattern, controls_[i])) continue;
      matches = true;
      mask[i] = invert ? 0.0f : 1.0f;
    }
    if (matches) continue;
    fail(kInvalid, kCannot, where, "no raw control matches \"" + one_line(pattern) + "\"",
         nearest_question(pattern, as_patterns(pattern), kHowToList));
  }
  return mask;
}

}  // namespace mien::cli
