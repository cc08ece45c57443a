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

constexpr const char* kCannotPlayCurves = "cannot play scene";
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

RigCurves::RigCurves(const MienRig* rig, const NamesFile& names)
    : rig_(rig), matched_(rig, names, kCannotPlayCurves) {
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

void RigCurves::fail_unknown(const std::string& name, const std::string& where) const {
  fail(kInvalid, kCannotPlayCurves, where, "no raw control is named \"" + one_line(name) + "\"",
       nearest_question(name, controls_, kHowToList));
}

std::vector<MienControlShare> RigCurves::find_shares(const std::string& name,
                                                     const std::string& where) {
  if (!matched_.is_given(name)) {
    const std::vector<size_t> found = find_controls(name);
    if (found.size() > 1) {
      fail(kInvalid, kCannotPlayCurves, where,
           "\"" + one_line(name) + "\" is ambiguous: " + controls_[found[0]] + " or " +
               controls_[found[1]],
           "give the full name");
    }
    if (!found.empty()) return {{static_cast<uint32_t>(found[0]), 1}};
    if (is_variable_name(name)) return {};
  }
  return matched_.find(name).shares;
}

uint16_t RigCurves::curve(const std::string& name, const std::string& where) {
  const std::vector<MienControlShare> found = find_shares(name, where);
  if (found.size() > 1) {
    fail(kInvalid, kCannotPlayCurves, where,
         "\"" + one_line(name) + "\" is " + std::to_string(found.size()) +
             " controls of this rig: " + controls_[found[0].control] + ", " +
             controls_[found[1].control] + (found.size() > 2 ? ", ..." : ""),
         "give one of them");
  }
  if (!found.empty()) return static_cast<uint16_t>(found[0].control);
  if (is_variable_name(name)) return variable(name);
  fail_unknown(name, where);
}

CurveValues RigCurves::curves(const NamedValues& values, const std::string& where) {
  struct Sum {
    float value = 0;
    bool is_alone = false;  // a name that is this control alone
  };
  std::map<uint16_t, Sum> sums;
  for (const auto& [name, value] : values) {
    std::vector<MienControlShare> shares = find_shares(name, where);
    if (shares.empty() && !is_variable_name(name)) fail_unknown(name, where);
    if (shares.empty()) shares = {{variable(name), 1}};
    const bool is_alone = shares.size() == 1 && shares[0].weight == 1;
    for (const MienControlShare& share : shares) {
      const auto curve = static_cast<uint16_t>(share.control);
      Sum& sum = sums[curve];
      if (is_alone && sum.is_alone) {
        const std::string& twice =
            curve < controls_.size() ? controls_[curve] : variables_[curve - controls_.size()];
        fail(kInvalid, kCannotPlayCurves, where, "\"" + twice + "\" is listed twice",
             "leave one of them out");
      }
      sum.value += share.weight * value;
      sum.is_alone |= is_alone;
    }
  }
  CurveValues found;
  for (const auto& [curve, sum] : sums) {
    found.curves.push_back(curve);
    found.values.push_back(sum.value);
  }
  return found;
}

CurveValues RigCurves::present(const NamedValues& values) const {
  std::map<uint16_t, float> first;
  for (const auto& [name, value] : values) {
    for (const MienControlShare& share : match_name(rig_, name).shares) {
      first.emplace(static_cast<uint16_t>(share.control), share.weight * value);
    }
  }
  CurveValues found;
  for (const auto& [curve, value] : first) {
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
                                   const std::string& where) {
  std::vector<float> mask(controls_.size(), invert ? 1.0f : 0.0f);
  for (const std::string& pattern : patterns) {
    bool matches = false;
    for (size_t i = 0; i < controls_.size(); ++i) {
      if (!matches_pattern(pattern, controls_[i])) continue;
      matches = true;
      mask[i] = invert ? 0.0f : 1.0f;
    }
    for (const MienControlShare& share :
         matches ? std::vector<MienControlShare>() : find_shares(pattern, where)) {
      matches = true;
      mask[share.control] = invert ? 0.0f : 1.0f;
    }
    if (matches) continue;
    fail(kInvalid, kCannotPlayCurves, where, "no raw control matches \"" + one_line(pattern) + "\"",
         nearest_question(pattern, as_patterns(pattern), kHowToList));
  }
  return mask;
}

}  // namespace mien::cli
