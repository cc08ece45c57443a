// SPDX-License-Identifier: MIT
// Curves of a mix by the names that a scene gives them: the raw controls of a rig, then variables.
#pragma once

#include <mien.h>

#include <map>
#include <string>
#include <vector>

#include "integrations/program/io/frames.h"
#include "integrations/program/io/matched_names.h"
#include "integrations/program/play/script.h"

namespace mien::cli {

struct CurveValues {
  std::vector<uint16_t> curves;
  std::vector<float> values;
};

class RigCurves {
 public:
  /// The rig outlives it.
  RigCurves(const MienRig* rig, const NamesFile& names);

  const std::vector<std::string>& controls() const { return controls_; }
  const std::vector<std::string>& variables() const { return variables_; }
  size_t count() const { return controls_.size() + variables_.size(); }

  /// A raw control by its name or by its short name without regard to case, or the one that the name means on
  /// this rig; else a variable that scenes know (pupil, breath, head., gaze., user.), which may be new.
  /// Exit code 2 with the nearest name.
  uint16_t curve(const std::string& name, const std::string& where);
  /// The variable of a name, which may be new.
  uint16_t variable(const std::string& name);
  /// The same, where a name may mean several controls.
  CurveValues curves(const NamedValues& values, const std::string& where);
  /// Tells what names the rig spells otherwise.
  void note_matched(const std::string& shown, const Session& session) const {
    matched_.note_matched(shown, session);
  }
  /// Those of the names that are raw controls; of several names of a control the first counts.
  CurveValues present(const NamedValues& values) const;
  /// Where variables of a row turn the head: to the left by head.left and head.turn, up by head.up.
  HeadPose head(const float* row) const;
  /// 1 for raw controls whose names match a pattern, or that it means, else 0; inverted if `invert`.
  std::vector<float> mask(const std::vector<std::string>& patterns, bool invert,
                          const std::string& where);

 private:
  /// The raw controls that a name has without regard to case; several if it is ambiguous.
  std::vector<size_t> find_controls(const std::string& name) const;
  /// What a name means on the rig, or nothing. Exit code 2 if it is ambiguous.
  std::vector<MienControlShare> find_shares(const std::string& name, const std::string& where);
  [[noreturn]] void fail_unknown(const std::string& name, const std::string& where) const;
  /// Names like a pattern: if it ends with its only *, beginnings of the same length.
  std::vector<std::string> as_patterns(const std::string& pattern) const;

  const MienRig* rig_;
  MatchedNames matched_;
  std::vector<std::string> controls_, variables_;
  std::map<std::string, size_t> by_name_;
  std::map<std::string, std::vector<size_t>> by_short_name_;  // in small letters
};

}  // namespace mien::cli
