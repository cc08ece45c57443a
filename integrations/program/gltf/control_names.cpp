// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/control_names.h"

#include "integrations/program/gltf/rig_source.h"

namespace mien::gltf {

namespace {

/// Names that are to be equal become equal.
std::string folded(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
    if (c == '.') c = '_';
  }
  return name;
}

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
  }
  known_.insert(parts.begin(), parts.end());
}

bool ControlNames::find(const std::string& name, uint32_t& index) const {
  const auto found = known_.find(folded(name));
  if (found != known_.end()) index = found->second;
  return found != known_.end();
}

}  // namespace mien::gltf
