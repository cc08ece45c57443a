// SPDX-License-Identifier: MIT
#include "integrations/program/io/matched_names.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using Json = nlohmann::basic_json<MemberList>;

constexpr char kCannotUseNames[] = "cannot use names";
constexpr char kExample[] =
    R"(write {"smileL": "mouthSmile_L", "browUp": {"browInnerUp": 1, "browOuterUp_L": 0.5}})";

[[noreturn]] void wrong(const std::string& where, const std::string& why) {
  fail(kInvalid, kCannotUseNames, where, why, kExample);
}

std::string share_text(const MienRig* rig, const MienControlShare& share) {
  const std::string name = one_line(rig_name(rig, MIEN_KIND_RAW_CONTROL, share.control));
  if (share.weight == 1) return name;
  char number[32];
  std::snprintf(number, sizeof number, "%.3g ", double{share.weight});
  return number + name;
}

}  // namespace

MatchedName match_name(const MienRig* rig, const std::string& name) {
  MienControlShare shares[MIEN_MOST_SHARES];
  size_t count = 0;
  MatchedName match;
  const MienStatus status =
      mien_rig_match(rig, name.data(), name.size(), shares, MIEN_MOST_SHARES, &count, &match.how);
  if (status == MIEN_ERROR_NAME) return {};
  check(status, nullptr, kCannotUseNames, name);
  match.shares.assign(shares, shares + count);
  return match;
}

std::string usual_name(const std::string& name) {
  char text[256];
  size_t count = 0;
  const MienStatus status = mien_control_name(name.data(), name.size(), text, sizeof text, &count);
  return status == MIEN_OK ? std::string(text, std::min(count, sizeof text)) : std::string();
}

std::string metahuman_name(const std::string& name) {
  // One for each side; MetaHuman heads have several for what ARKit has one for both.
  static const std::map<std::string, std::string> kMain = {
      {"browInnerUpLeft", "browRaiseInL"},    {"browInnerUpRight", "browRaiseInR"},
      {"browOuterUpLeft", "browRaiseOuterL"}, {"browOuterUpRight", "browRaiseOuterR"},
      {"cheekPuffLeft", "mouthCheekBlowL"},   {"cheekPuffRight", "mouthCheekBlowR"}};
  static const std::set<std::string> kShared = {"jawOpen",   "jawLeft",    "jawRight",
                                                "mouthLeft", "mouthRight", "tongueOut"};
  const std::string usual = usual_name(name), group = "CTRL_expressions.";
  if (usual.empty()) return {};
  if (const auto main = kMain.find(usual); main != kMain.end()) return group + main->second;
  if (kShared.count(usual) != 0) return group + usual;
  std::string control;
  bool is_arkit = false;
  for (const MienMatrixEntry& entry : arkit_matrix()) {
    const std::string channel(entry.channel.data, entry.channel.count);
    // Also "mouthSmile", which is neither side's.
    is_arkit = is_arkit || channel.compare(0, usual.size(), usual) == 0;
    if (channel != usual) continue;
    if (!control.empty()) return {};
    control.assign(entry.control.data, entry.control.count);
  }
  if (!control.empty()) return group + control;
  // What ARKit has no name for is MetaHuman's already.
  return is_arkit ? std::string() : group + usual;
}

NamesFile::NamesFile(const std::string& path) {
  if (path.empty()) return;
  shown_ = shown_name(path);
  const Json document =
      parse_json<Json>(read_json(path, kCannotUseNames), kCannotUseNames, shown_, kExample);
  if (!document.is_object()) wrong(shown_, "expected an object of names");
  for (const auto& [name, meaning] : document.items()) {
    const std::string where = shown_ + ", " + one_line(name);
    std::vector<Share>& shares = names_[name];
    if (meaning.is_string()) {
      shares.push_back({meaning.get<std::string>(), 1});
      continue;
    }
    if (!meaning.is_object() || meaning.empty()) {
      wrong(where, "expected the name of a control, or an object of controls and weights");
    }
    for (const auto& [control, weight] : meaning.items()) {
      if (!weight.is_number() || !(std::fabs(weight.get<double>()) <= 10)) {
        wrong(where + "." + one_line(control), "expected a weight from -10 to 10");
      }
      shares.push_back({control, weight.get<float>()});
    }
  }
}

std::vector<MienMatrixEntry> arkit_matrix() {
  size_t count = 0;  // neither call can fail
  (void)mien_arkit_matrix(nullptr, 0, &count);
  std::vector<MienMatrixEntry> entries(count);
  (void)mien_arkit_matrix(entries.data(), count, &count);
  return entries;
}

MatchedNames::MatchedNames(const MienRig* rig, const NamesFile& file, const char* what)
    : rig_(rig) {
  for (const auto& [name, shares] : file.names()) {
    MatchedName& given = given_[name];
    given.how = MIEN_NAME_MATCH_EXPRESSION;
    for (const NamesFile::Share& share : shares) {
      const MatchedName found = match_name(rig, share.control);
      if (!found.found()) {
        std::vector<std::string> known;
        for (uint32_t i = 0; i < rig_count(rig, MIEN_KIND_RAW_CONTROL); ++i) {
          known.push_back(rig_name(rig, MIEN_KIND_RAW_CONTROL, i));
        }
        fail(kInvalid, what, file.shown() + ", " + one_line(name),
             "the rig has no raw control \"" + one_line(share.control) + "\"",
             nearest_question(share.control, known, "'mien info RIG --names raw' lists the names"));
      }
      for (const MienControlShare& of : found.shares) {
        given.shares.push_back({of.control, of.weight * share.weight});
      }
    }
  }
}

MatchedName MatchedNames::find(const std::string& name) {
  const auto given = given_.find(name);
  const MatchedName match = given != given_.end() ? given->second : match_name(rig_, name);
  keep(name, match);
  return match;
}

void MatchedNames::keep(const std::string& name, const MatchedName& match) {
  if (!match.found() || match.how == MIEN_NAME_MATCH_AS_WRITTEN) return;
  if (match.is_one()) {
    const MatchedName written = match_name(rig_, name);
    if (written.how == MIEN_NAME_MATCH_AS_WRITTEN &&
        written.shares[0].control == match.shares[0].control) {
      return;
    }
  }
  std::string text;
  for (const MienControlShare& share : match.shares) {
    text += (text.empty() ? "" : " + ") + share_text(rig_, share);
  }
  matched_[name] = text;
}

void MatchedNames::note_matched(const std::string& shown, const Session& session) const {
  if (matched_.empty()) return;
  std::string text;
  for (const auto& [name, meaning] : matched_) {
    text += (text.empty() ? "" : "; ") + one_line(name) + " is " + meaning;
  }
  note(session, shown + ": " + std::to_string(matched_.size()) +
                    " names stand for other controls of this rig: " + text);
}

}  // namespace mien::cli
