// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/arkit_controls.h"

#include "integrations/program/gltf/control_names.h"

namespace mien::gltf {

const char* const kArkitNames[kArkitCount] = {
    "eyeBlinkLeft",      "eyeLookDownLeft",    "eyeLookInLeft",
    "eyeLookOutLeft",    "eyeLookUpLeft",      "eyeSquintLeft",
    "eyeWideLeft",       "eyeBlinkRight",      "eyeLookDownRight",
    "eyeLookInRight",    "eyeLookOutRight",    "eyeLookUpRight",
    "eyeSquintRight",    "eyeWideRight",       "jawForward",
    "jawLeft",           "jawRight",           "jawOpen",
    "mouthClose",        "mouthFunnel",        "mouthPucker",
    "mouthLeft",         "mouthRight",         "mouthSmileLeft",
    "mouthSmileRight",   "mouthFrownLeft",     "mouthFrownRight",
    "mouthDimpleLeft",   "mouthDimpleRight",   "mouthStretchLeft",
    "mouthStretchRight", "mouthRollLower",     "mouthRollUpper",
    "mouthShrugLower",   "mouthShrugUpper",    "mouthPressLeft",
    "mouthPressRight",   "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthUpperUpLeft",  "mouthUpperUpRight",  "browDownLeft",
    "browDownRight",     "browInnerUp",        "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",
    "cheekSquintRight",  "noseSneerLeft",      "noseSneerRight",
    "tongueOut",
};

std::vector<MienMatrixEntry> arkit_matrix() {
  size_t count = 0;  // neither call can fail
  (void)mien_arkit_matrix(nullptr, 0, &count);
  std::vector<MienMatrixEntry> entries(count);
  (void)mien_arkit_matrix(entries.data(), count, &count);
  return entries;
}

ArkitControls find_arkit_controls(const RigSource& source) {
  const ControlNames names(source.rig(), MIEN_KIND_RAW_CONTROL);
  const std::vector<MienMatrixEntry> matrix = arkit_matrix();
  const auto text = [](const MienStringView& view) { return std::string(view.data, view.count); };
  ArkitControls result;
  std::string missing;
  size_t missing_count = 0;
  for (size_t e = 0; e < kArkitCount; ++e) {
    std::vector<ControlWeight>& controls = result.controls[e];
    uint32_t control = 0;
    if (names.find(kArkitNames[e], control)) {
      controls = {{control, 1}};
      continue;
    }
    result.by_name = false;
    bool complete = true;
    for (const MienMatrixEntry& entry : matrix) {
      if (text(entry.channel) != kArkitNames[e]) continue;
      const bool found = names.find(text(entry.control), control);
      complete &= found;
      if (found) controls.push_back({control, entry.weight});
    }
    if (!controls.empty() && complete) continue;
    if (++missing_count <= 5)
      missing += (missing.empty() ? "" : ", ") + std::string(kArkitNames[e]);
  }
  if (missing_count != 0) {
    throw ExportError(MIEN_ERROR_NAME, "",
                      "the rig has no raw controls for " + missing +
                          (missing_count > 5 ? " and " + std::to_string(missing_count - 5) + " more"
                                             : std::string()),
                      "see 'mien info --names raw', or export without --bake-arkit");
  }
  return result;
}

}  // namespace mien::gltf
