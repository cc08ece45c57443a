// SPDX-License-Identifier: MIT
// Curves of a mix by the names that a scene gives them: the raw controls of a rig, then variables.
#pragma once

#include <mien.h>

#include <map>
#include <string>
#include <vector>

#include "integrations/program/io/frames.h"
#include "integrations/program/play/script.h"

namespace mien::cli {

struct CurveValues {
  std::vector<uint16_t> curves;
  std::vector<float> values;
};

class RigCurves {
 public:
  explicit RigCurves(const MienRig* rig);

  const std::vector<std::string>& controls() const { return controls_; }
  const std::vector<std::string>& variables() const { return variables_; }
  size_t count() const { return controls_.size() + variables_.size(); }

  /// A raw control by its name or by its short name without regard to case; else a variable that scenes
  /// know (pupil, breath, head., gaze., user.), which may be new. Exit code 2 with the nearest name.
  uint16_t curve(const std::string& name, const std::string& where);
  /// The variable of a name, which may be new.
  uint16_t variable(const std::string& name);
  CurveValues curves(const NamedValues& values, const std::string& where);
  /// Those of the names that are raw controls.
  CurveValues present(const NamedValues& values) const;
  /// Where variables of a row turn the head: to the left by head.left and head.turn, up by head.up.
  HeadPose head(const float* row) const;
  /// 1 for raw controls whose names match a pattern, else 0; inverted if `invert`.
  std::vector<float> mask(const std::vector<std::string>& patterns, bool invert,
                          const std::string& where) const;

 private:
  /// The raw controls that a name can mean; several if it is ambiguous.
  std::vector<size_t> find_controls(const std::string& name) const;
  /// Names like a pattern: if it ends with its only *, beginnings of the same length.
  std::vector<std::string> as_patterns(const std::string& pattern) const;

  std::vector<std::string> controls_, variables_;
  std::map<std::string, size_t> by_name_;
  std::map<std::string, std::vector<size_t>> by_short_name_;  // in small letters
};

}  // namespace mien::cli
