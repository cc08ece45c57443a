// SPDX-License-Identifier: MIT
// The meaning of control names on a rig: the user's file first, then mien_rig_match().
#pragma once

#include <mien.h>

#include <map>
#include <string>
#include <vector>

#include "integrations/program/io/terminal.h"

namespace mien::cli {

struct MatchedName {
  uint32_t how = MIEN_NAME_MATCH_NONE;  // MIEN_NAME_MATCH_...
  std::vector<MienControlShare> shares;

  bool found() const { return !shares.empty(); }
  /// One control that gets the value of the name as it is.
  bool is_one() const { return shares.size() == 1 && shares[0].weight == 1; }
};

MatchedName match_name(const MienRig* rig, const std::string& name);

/// Names that a JSON file gives another meaning than the table of the library: {"smileL": "mouthSmile_L",
/// "browUp": {"browInnerUp": 1, "browOuterUp_L": 0.5}}.
class NamesFile {
 public:
  struct Share {
    std::string control;
    float weight;
  };

  NamesFile() = default;
  /// An empty path has no names. Exit code 2 for files of another form.
  explicit NamesFile(const std::string& path);

  bool empty() const { return names_.empty(); }
  const std::map<std::string, std::vector<Share>>& names() const { return names_; }
  const std::string& shown() const { return shown_; }

 private:
  std::string shown_;
  std::map<std::string, std::vector<Share>> names_;
};

/// The names of ARKit as controls of MetaHuman heads. Names are static.
std::vector<MienMatrixEntry> arkit_matrix();

/// The usual name of a control: "mouthSmileLeft" for "AU12_L"; "" if the library has none.
std::string usual_name(const std::string& name);
/// The raw control of MetaHuman heads that a name means, "CTRL_expressions.mouthCornerPullL" for "AU12_L"; "" if none of
/// theirs alone does.
std::string metahuman_name(const std::string& name);

/// Finds names on one rig, and remembers those that the rig spells otherwise. The rig outlives it.
class MatchedNames {
 public:
  /// Fails if the rig lacks a control of the file.
  MatchedNames(const MienRig* rig, const NamesFile& file, const char* what);

  MatchedName find(const std::string& name);
  /// Remembers what a name means for note_matched(), unless that is what is written.
  void keep(const std::string& name, const MatchedName& match);
  /// The names of the file on the rig.
  const std::map<std::string, MatchedName>& given() const { return given_; }
  /// Whether the file has the name.
  bool is_given(const std::string& name) const { return given_.count(name) != 0; }
  /// A note with the names found so far that the rig does not have as they are written:
  /// "mouthSmileLeft is mouthSmile_L; ...".
  void note_matched(const std::string& shown, const Session& session) const;

 private:
  const MienRig* rig_;
  std::map<std::string, MatchedName> given_;
  std::map<std::string, std::string> matched_;  // texts
};

}  // namespace mien::cli
