// SPDX-License-Identifier: MIT
#include "integrations/cli/gltf/arkit_controls.h"

#include "integrations/cli/gltf/control_names.h"

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

namespace {

// Raw controls that together make an expression. The fractions are estimates.
constexpr ArkitMeaning kMeanings[] = {
    {"eyeBlinkLeft", "eyeBlinkL", 1},
    {"eyeBlinkRight", "eyeBlinkR", 1},
    {"eyeLookDownLeft", "eyeLookDownL", 1},
    {"eyeLookDownRight", "eyeLookDownR", 1},
    {"eyeLookInLeft", "eyeLookRightL", 1},
    {"eyeLookInRight", "eyeLookLeftR", 1},
    {"eyeLookOutLeft", "eyeLookLeftL", 1},
    {"eyeLookOutRight", "eyeLookRightR", 1},
    {"eyeLookUpLeft", "eyeLookUpL", 1},
    {"eyeLookUpRight", "eyeLookUpR", 1},
    {"eyeSquintLeft", "eyeSquintInnerL", 1},
    {"eyeSquintRight", "eyeSquintInnerR", 1},
    {"eyeWideLeft", "eyeWidenL", 1},
    {"eyeWideRight", "eyeWidenR", 1},
    {"jawForward", "jawFwd", 1},
    {"mouthClose", "mouthLipsTogetherUL", 1},
    {"mouthClose", "mouthLipsTogetherUR", 1},
    {"mouthClose", "mouthLipsTogetherDL", 1},
    {"mouthClose", "mouthLipsTogetherDR", 1},
    {"mouthFunnel", "mouthFunnelUL", 1},
    {"mouthFunnel", "mouthFunnelUR", 1},
    {"mouthFunnel", "mouthFunnelDL", 1},
    {"mouthFunnel", "mouthFunnelDR", 1},
    {"mouthPucker", "mouthLipsPurseUL", 1},
    {"mouthPucker", "mouthLipsPurseUR", 1},
    {"mouthPucker", "mouthLipsPurseDL", 1},
    {"mouthPucker", "mouthLipsPurseDR", 1},
    {"mouthPucker", "mouthFunnelUL", 0.75f},
    {"mouthPucker", "mouthFunnelUR", 0.75f},
    {"mouthPucker", "mouthFunnelDL", 0.75f},
    {"mouthPucker", "mouthFunnelDR", 0.75f},
    {"mouthPucker", "mouthLipsTowardsUL", 0.4f},
    {"mouthPucker", "mouthLipsTowardsUR", 0.4f},
    {"mouthPucker", "mouthLipsTowardsDL", 0.4f},
    {"mouthPucker", "mouthLipsTowardsDR", 0.4f},
    {"mouthSmileLeft", "mouthCornerPullL", 1},
    {"mouthSmileRight", "mouthCornerPullR", 1},
    {"mouthFrownLeft", "mouthCornerDepressL", 1},
    {"mouthFrownRight", "mouthCornerDepressR", 1},
    {"mouthDimpleLeft", "mouthDimpleL", 1},
    {"mouthDimpleRight", "mouthDimpleR", 1},
    {"mouthStretchLeft", "mouthStretchL", 1},
    {"mouthStretchRight", "mouthStretchR", 1},
    {"mouthRollLower", "mouthLowerLipRollInL", 1},
    {"mouthRollLower", "mouthLowerLipRollInR", 1},
    {"mouthRollLower", "mouthUpperLipRollInL", 0.5f},
    {"mouthRollLower", "mouthUpperLipRollInR", 0.5f},
    {"mouthRollUpper", "mouthUpperLipRollInL", 1},
    {"mouthRollUpper", "mouthUpperLipRollInR", 1},
    {"mouthShrugLower", "jawChinRaiseDL", 1},
    {"mouthShrugLower", "jawChinRaiseDR", 1},
    {"mouthShrugUpper", "jawChinRaiseUL", 1},
    {"mouthShrugUpper", "jawChinRaiseUR", 1},
    {"mouthPressLeft", "mouthPressUL", 1},
    {"mouthPressLeft", "mouthPressDL", 1},
    {"mouthPressRight", "mouthPressUR", 1},
    {"mouthPressRight", "mouthPressDR", 1},
    {"mouthLowerDownLeft", "mouthLowerLipDepressL", 1},
    {"mouthLowerDownRight", "mouthLowerLipDepressR", 1},
    {"mouthUpperUpLeft", "mouthUpperLipRaiseL", 1},
    {"mouthUpperUpRight", "mouthUpperLipRaiseR", 1},
    {"browDownLeft", "browDownL", 1},
    {"browDownRight", "browDownR", 1},
    {"browInnerUp", "browRaiseInL", 1},
    {"browInnerUp", "browRaiseInR", 1},
    {"browInnerUp", "browLateralL", 1},
    {"browInnerUp", "browLateralR", 1},
    {"browOuterUpLeft", "browRaiseOuterL", 1},
    {"browOuterUpLeft", "browRaiseInL", 1},
    {"browOuterUpRight", "browRaiseOuterR", 1},
    {"browOuterUpRight", "browRaiseInR", 1},
    {"cheekPuff", "mouthCheekBlowL", 1},
    {"cheekPuff", "mouthCheekBlowR", 1},
    {"cheekPuff", "mouthLipsBlowL", 1},
    {"cheekPuff", "mouthLipsBlowR", 1},
    {"cheekSquintLeft", "eyeCheekRaiseL", 1},
    {"cheekSquintRight", "eyeCheekRaiseR", 1},
    {"noseSneerLeft", "noseWrinkleL", 1},
    {"noseSneerRight", "noseWrinkleR", 1},
};

}  // namespace

std::vector<ArkitMeaning> arkit_meanings() { return {std::begin(kMeanings), std::end(kMeanings)}; }

ArkitControls find_arkit_controls(const RigSource& source) {
  const ControlNames names(source.rig(), MIEN_KIND_RAW_CONTROL);
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
    for (const ArkitMeaning& meaning : kMeanings) {
      if (std::string(kArkitNames[e]) != meaning.expression) continue;
      const bool found = names.find(meaning.control, control);
      complete &= found;
      if (found) controls.push_back({control, meaning.weight});
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
