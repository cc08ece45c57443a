// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/control_names.h"

#include "integrations/program/gltf/rig_source.h"

namespace mien::gltf {

namespace {

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

char lower(char c) { return is_upper(c) ? static_cast<char>(c + ('a' - 'A')) : c; }

/// Names that are to be equal become equal.
std::string folded(const std::string& name) {
  std::string text;
  for (char c : name) text += c == '.' ? '_' : lower(c);
  return text;
}

bool takes_end(std::string& text, const char* end) {
  const std::string wanted = end;
  if (text.size() <= wanted.size() ||
      text.compare(text.size() - wanted.size(), wanted.size(), wanted) != 0) {
    return false;
  }
  text.resize(text.size() - wanted.size());
  return true;
}

/// The letters and digits of a name, and its side: "mouthSmileLeft", "mouthSmile_L", "mouth_smile_l" and
/// "MouthSmileL" become "mouthsmile<".
std::string spelled(const std::string& name) {
  std::string words = name.substr(name.rfind('.') + 1);
  char side = 0;
  // An "l" in small letters is a side after a separator only.
  for (const char* left :
       {"Left", "_left", "-left", " left", "_L", "_l", "-L", "-l", " L", " l", "L"}) {
    if (side == 0 && takes_end(words, left)) side = '<';
  }
  for (const char* right :
       {"Right", "_right", "-right", " right", "_R", "_r", "-R", "-r", " R", " r", "R"}) {
    if (side == 0 && takes_end(words, right)) side = '>';
  }
  std::string text;
  for (char c : words) {
    if (c != '_' && c != '-' && c != ' ') text += lower(c);
  }
  if (side != 0) text += side;
  return text;
}

constexpr uint32_t kSeveral = kNone;

}  // namespace

ControlNames::ControlNames(const MienRig* rig, uint32_t kind) {
  std::map<std::string, uint32_t> parts;
  uint32_t count = 0;
  check(mien_rig_count(rig, kind, &count), "cannot list controls");
  for (uint32_t i = 0; i < count; ++i) {
    MienStringView view{};
    check(mien_rig_name(rig, kind, i, &view), "cannot list controls");
    const std::string name(view.data, view.count);
    known_.emplace(folded(name), i);
    parts.emplace(folded(name.substr(name.rfind('.') + 1)), i);
    const auto [at, is_new] = spellings_.emplace(spelled(name), i);
    if (!is_new) at->second = kSeveral;
  }
  known_.insert(parts.begin(), parts.end());
}

bool ControlNames::find(const std::string& name, uint32_t& index) const {
  auto found = known_.find(folded(name));
  if (found == known_.end()) {
    found = spellings_.find(spelled(name));
    if (found == spellings_.end() || found->second == kSeveral) return false;
  }
  index = found->second;
  return true;
}

}  // namespace mien::gltf
