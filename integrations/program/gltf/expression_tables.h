// SPDX-License-Identifier: MIT
// Sets of expressions as values of controls. Names are those of ARKit or of MetaHuman's raw controls; ways
// stand behind |, the first of which a rig has all controls counts; = is the name itself, as
// mien_rig_match() finds it; what is behind - is the pose that a difference
// is taken to. docs/face-capture.md, 5 "Sets of expressions" has the sources and reasons.
#pragma once

#include <cstddef>

namespace mien::gltf {

struct ExpressionRow {
  const char* name;
  const char* ways;
};

struct ExpressionTable {
  const char* name;
  const ExpressionRow* rows;
  size_t count;
};

constexpr const char* kArkitNames[] = {
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
    "tongueOut"};

// The 15 visemes of Oculus lip sync.
constexpr ExpressionRow kVisemes[] = {
    {"viseme_sil", ""},
    {"viseme_PP", "mouthPressLeft 0.6 mouthPressRight 0.6 mouthRollLower 0.3 mouthRollUpper 0.3"},
    {"viseme_FF", "mouthRollLower 0.5 mouthUpperUpLeft 0.3 mouthUpperUpRight 0.3 jawOpen 0.04"},
    {"viseme_TH", "jawOpen 0.14 tongueOut 0.4 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2"},
    {"viseme_DD",
     "jawOpen 0.1 mouthLowerDownLeft 0.3 mouthLowerDownRight 0.3 mouthUpperUpLeft 0.15 "
     "mouthUpperUpRight 0.15"},
    {"viseme_kk",
     "jawOpen 0.18 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2 mouthStretchLeft 0.1 "
     "mouthStretchRight 0.1"},
    {"viseme_CH",
     "jawOpen 0.07 mouthFunnel 0.6 mouthPucker 0.2 mouthUpperUpLeft 0.2 mouthUpperUpRight 0.2"},
    {"viseme_SS",
     "jawOpen 0.04 mouthStretchLeft 0.3 mouthStretchRight 0.3 mouthLowerDownLeft 0.35 "
     "mouthLowerDownRight 0.35 mouthUpperUpLeft 0.2 mouthUpperUpRight 0.2"},
    {"viseme_nn",
     "jawOpen 0.09 mouthLowerDownLeft 0.25 mouthLowerDownRight 0.25 mouthUpperUpLeft 0.1 "
     "mouthUpperUpRight 0.1"},
    {"viseme_RR", "jawOpen 0.12 mouthFunnel 0.45 mouthPucker 0.3"},
    {"viseme_aa",
     "jawOpen 0.6 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2 mouthUpperUpLeft 0.15 "
     "mouthUpperUpRight 0.15"},
    {"viseme_E",
     "jawOpen 0.3 mouthSmileLeft 0.25 mouthSmileRight 0.25 mouthStretchLeft 0.2 mouthStretchRight "
     "0.2 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2"},
    {"viseme_ih",
     "jawOpen 0.2 mouthSmileLeft 0.3 mouthSmileRight 0.3 mouthLowerDownLeft 0.2 "
     "mouthLowerDownRight 0.2"},
    {"viseme_oh", "jawOpen 0.4 mouthFunnel 0.6 mouthPucker 0.15"},
    {"viseme_ou", "jawOpen 0.15 mouthPucker 0.75 mouthFunnel 0.35"},
};

// The 22 viseme numbers of cloud voices (Azure), each with a phoneme of its group.
constexpr ExpressionRow kVisemes22[] = {
    {"viseme_0_silence", ""},
    {"viseme_1_ae",
     "jawOpen 0.4 mouthSmileLeft 0.1 mouthSmileRight 0.1 mouthLowerDownLeft 0.2 "
     "mouthLowerDownRight 0.2 mouthUpperUpLeft 0.1 mouthUpperUpRight 0.1"},
    {"viseme_2_aa",
     "jawOpen 0.6 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2 mouthUpperUpLeft 0.15 "
     "mouthUpperUpRight 0.15"},
    {"viseme_3_ao", "jawOpen 0.5 mouthFunnel 0.45"},
    {"viseme_4_ey",
     "jawOpen 0.3 mouthSmileLeft 0.25 mouthSmileRight 0.25 mouthStretchLeft 0.2 mouthStretchRight "
     "0.2 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2"},
    {"viseme_5_er", "jawOpen 0.2 mouthFunnel 0.35 mouthPucker 0.2"},
    {"viseme_6_y",
     "jawOpen 0.12 mouthSmileLeft 0.35 mouthSmileRight 0.35 mouthStretchLeft 0.15 "
     "mouthStretchRight 0.15"},
    {"viseme_7_w", "jawOpen 0.08 mouthPucker 0.85 mouthFunnel 0.3"},
    {"viseme_8_ow", "jawOpen 0.4 mouthFunnel 0.6 mouthPucker 0.15"},
    {"viseme_9_aw", "jawOpen 0.5 mouthFunnel 0.3 mouthPucker 0.2"},
    {"viseme_10_oy", "jawOpen 0.35 mouthFunnel 0.5 mouthStretchLeft 0.1 mouthStretchRight 0.1"},
    {"viseme_11_ay",
     "jawOpen 0.5 mouthSmileLeft 0.2 mouthSmileRight 0.2 mouthLowerDownLeft 0.2 "
     "mouthLowerDownRight 0.2"},
    {"viseme_12_h", "jawOpen 0.25 mouthLowerDownLeft 0.1 mouthLowerDownRight 0.1"},
    {"viseme_13_r", "jawOpen 0.12 mouthFunnel 0.45 mouthPucker 0.3"},
    {"viseme_14_l",
     "jawOpen 0.2 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2 mouthUpperUpLeft 0.1 "
     "mouthUpperUpRight 0.1"},
    {"viseme_15_s",
     "jawOpen 0.04 mouthStretchLeft 0.3 mouthStretchRight 0.3 mouthLowerDownLeft 0.35 "
     "mouthLowerDownRight 0.35 mouthUpperUpLeft 0.2 mouthUpperUpRight 0.2"},
    {"viseme_16_sh",
     "jawOpen 0.07 mouthFunnel 0.6 mouthPucker 0.2 mouthUpperUpLeft 0.2 mouthUpperUpRight 0.2"},
    {"viseme_17_th", "jawOpen 0.14 tongueOut 0.4 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2"},
    {"viseme_18_f", "mouthRollLower 0.5 mouthUpperUpLeft 0.3 mouthUpperUpRight 0.3 jawOpen 0.04"},
    {"viseme_19_d",
     "jawOpen 0.1 mouthLowerDownLeft 0.3 mouthLowerDownRight 0.3 mouthUpperUpLeft 0.15 "
     "mouthUpperUpRight 0.15"},
    {"viseme_20_k",
     "jawOpen 0.18 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2 mouthStretchLeft 0.1 "
     "mouthStretchRight 0.1"},
    {"viseme_21_p", "mouthPressLeft 0.6 mouthPressRight 0.6 mouthRollLower 0.3 mouthRollUpper 0.3"},
};

// Unified Expressions, without those that no rig has: EyeOpenness is EyeClosed here.
constexpr ExpressionRow kUnified[] = {
    {"EyeLookOutRight", "="},
    {"EyeLookOutLeft", "="},
    {"EyeLookInRight", "="},
    {"EyeLookInLeft", "="},
    {"EyeLookUpRight", "="},
    {"EyeLookUpLeft", "="},
    {"EyeLookDownRight", "="},
    {"EyeLookDownLeft", "="},
    {"EyeClosedRight", "="},
    {"EyeClosedLeft", "="},
    {"EyeSquintRight", "="},
    {"EyeSquintLeft", "="},
    {"EyeWideRight", "="},
    {"EyeWideLeft", "="},
    {"EyeDilationRight", "="},
    {"EyeDilationLeft", "="},
    {"EyeConstrictRight", "="},
    {"EyeConstrictLeft", "="},
    {"BrowPinchRight", "="},
    {"BrowPinchLeft", "="},
    {"BrowLowererRight", "="},
    {"BrowLowererLeft", "="},
    {"BrowInnerUpRight", "browRaiseInR 1 browLateralR 1"},
    {"BrowInnerUpLeft", "browRaiseInL 1 browLateralL 1"},
    {"BrowOuterUpRight", "="},
    {"BrowOuterUpLeft", "="},
    {"NasalDilationRight", "="},
    {"NasalDilationLeft", "="},
    {"NasalConstrictRight", "="},
    {"NasalConstrictLeft", "="},
    {"CheekSquintRight", "="},
    {"CheekSquintLeft", "="},
    {"CheekPuffRight", "="},
    {"CheekPuffLeft", "="},
    {"CheekSuckRight", "="},
    {"CheekSuckLeft", "="},
    {"JawOpen", "="},
    {"JawRight", "="},
    {"JawLeft", "="},
    {"JawForward", "="},
    {"JawBackward", "="},
    {"JawClench", "jawClenchL 1 jawClenchR 1"},
    {"MouthClosed", "mouthClose 1 jawOpen 1 - jawOpen 1"},
    {"LipSuckUpperRight", "="},
    {"LipSuckUpperLeft", "="},
    {"LipSuckLowerRight", "="},
    {"LipSuckLowerLeft", "="},
    {"LipFunnelUpperRight", "="},
    {"LipFunnelUpperLeft", "="},
    {"LipFunnelLowerRight", "="},
    {"LipFunnelLowerLeft", "="},
    {"LipPuckerUpperRight", "="},
    {"LipPuckerUpperLeft", "="},
    {"LipPuckerLowerRight", "="},
    {"LipPuckerLowerLeft", "="},
    {"MouthUpperUpRight", "="},
    {"MouthUpperUpLeft", "="},
    {"MouthUpperDeepenRight", "="},
    {"MouthUpperDeepenLeft", "="},
    {"NoseSneerRight", "="},
    {"NoseSneerLeft", "="},
    {"MouthLowerDownRight", "="},
    {"MouthLowerDownLeft", "="},
    {"MouthUpperRight", "="},
    {"MouthUpperLeft", "="},
    {"MouthLowerRight", "="},
    {"MouthLowerLeft", "="},
    {"MouthCornerPullRight", "="},
    {"MouthCornerPullLeft", "="},
    {"MouthCornerSlantRight", "="},
    {"MouthCornerSlantLeft", "="},
    {"MouthFrownRight", "="},
    {"MouthFrownLeft", "="},
    {"MouthStretchRight", "="},
    {"MouthStretchLeft", "="},
    {"MouthDimpleRight", "="},
    {"MouthDimpleLeft", "="},
    {"MouthRaiserUpper", "="},
    {"MouthRaiserLower", "="},
    {"MouthPressRight", "="},
    {"MouthPressLeft", "="},
    {"MouthTightenerRight", "mouthLipsTightenUR 1 mouthLipsTightenDR 1"},
    {"MouthTightenerLeft", "mouthLipsTightenUL 1 mouthLipsTightenDL 1"},
    {"TongueOut", "="},
    {"TongueUp", "="},
    {"TongueDown", "="},
    {"TongueRight", "="},
    {"TongueLeft", "="},
    {"TongueRoll", "="},
    {"TongueBendDown", "="},
    {"TongueCurlUp", "="},
    {"TongueSquish", "="},
    {"TongueFlat", "="},
    {"TongueTwistRight", "="},
    {"TongueTwistLeft", "="},
    {"ThroatSwallow", "="},
    {"NeckFlexRight", "="},
    {"NeckFlexLeft", "="},
};

// Prototypes of EMFACS, by their action units.
constexpr ExpressionRow kEmotions[] = {
    {"happy", "mouthSmileLeft 0.9 mouthSmileRight 0.9 cheekSquintLeft 0.7 cheekSquintRight 0.7"},
    {"sad",
     "browInnerUp 0.8 browDownLeft 0.3 browDownRight 0.3 mouthFrownLeft 0.7 mouthFrownRight 0.7"},
    {"angry",
     "browDownLeft 0.9 browDownRight 0.9 eyeWideLeft 0.3 eyeWideRight 0.3 eyeSquintLeft 0.5 "
     "eyeSquintRight 0.5 mouthPressLeft 0.6 mouthPressRight 0.6"},
    {"fearful",
     "browInnerUp 0.9 browOuterUpLeft 0.5 browOuterUpRight 0.5 browDownLeft 0.3 browDownRight 0.3 "
     "eyeWideLeft 0.8 eyeWideRight 0.8 mouthStretchLeft 0.6 mouthStretchRight 0.6 jawOpen 0.2"},
    {"surprised",
     "browInnerUp 0.9 browOuterUpLeft 0.9 browOuterUpRight 0.9 eyeWideLeft 0.7 eyeWideRight 0.7 "
     "jawOpen 0.4"},
    {"disgusted",
     "noseSneerLeft 0.9 noseSneerRight 0.9 mouthFrownLeft 0.5 mouthFrownRight 0.5 "
     "mouthLowerDownLeft 0.3 mouthLowerDownRight 0.3"},
    {"contemptuous", "mouthSmileRight 0.5 mouthDimpleRight 0.7"},
};

// The presets of VRM 1.0 but neutral, which is the face as it is. Vowels are the visemes above; to the left is to
// the left of the character.
constexpr ExpressionRow kVrm[] = {
    {"happy", "mouthSmileLeft 0.9 mouthSmileRight 0.9 cheekSquintLeft 0.7 cheekSquintRight 0.7"},
    {"angry",
     "browDownLeft 0.9 browDownRight 0.9 eyeSquintLeft 0.5 eyeSquintRight 0.5 noseSneerLeft 0.3 "
     "noseSneerRight 0.3 mouthPressLeft 0.6 mouthPressRight 0.6"},
    {"sad",
     "browInnerUp 0.8 browDownLeft 0.3 browDownRight 0.3 mouthFrownLeft 0.7 mouthFrownRight 0.7"},
    {"relaxed",
     "mouthSmileLeft 0.35 mouthSmileRight 0.35 eyeBlinkLeft 0.2 eyeBlinkRight 0.2 browInnerUp 0.1"},
    {"surprised",
     "browInnerUp 0.9 browOuterUpLeft 0.9 browOuterUpRight 0.9 eyeWideLeft 0.7 eyeWideRight 0.7 "
     "jawOpen 0.4"},
    {"aa",
     "jawOpen 0.6 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2 mouthUpperUpLeft 0.15 "
     "mouthUpperUpRight 0.15"},
    {"ih",
     "jawOpen 0.2 mouthSmileLeft 0.3 mouthSmileRight 0.3 mouthLowerDownLeft 0.2 "
     "mouthLowerDownRight 0.2"},
    {"ou", "jawOpen 0.15 mouthPucker 0.75 mouthFunnel 0.35"},
    {"ee",
     "jawOpen 0.3 mouthSmileLeft 0.25 mouthSmileRight 0.25 mouthStretchLeft 0.2 "
     "mouthStretchRight 0.2 mouthLowerDownLeft 0.2 mouthLowerDownRight 0.2"},
    {"oh", "jawOpen 0.4 mouthFunnel 0.6 mouthPucker 0.15"},
    {"blink", "eyeBlinkLeft 1 eyeBlinkRight 1"},
    {"blinkLeft", "eyeBlinkLeft 1"},
    {"blinkRight", "eyeBlinkRight 1"},
    {"lookUp", "eyeLookUpLeft 1 eyeLookUpRight 1"},
    {"lookDown", "eyeLookDownLeft 1 eyeLookDownRight 1"},
    {"lookLeft", "eyeLookOutLeft 1 eyeLookInRight 1"},
    {"lookRight", "eyeLookInLeft 1 eyeLookOutRight 1"},
};

template <size_t kCount>
constexpr ExpressionTable table_of(const char* name, const ExpressionRow (&rows)[kCount]) {
  return {name, rows, kCount};
}

constexpr ExpressionTable kExpressionTables[] = {
    table_of("visemes", kVisemes), table_of("visemes22", kVisemes22), table_of("unified", kUnified),
    table_of("vrm", kVrm), table_of("emotions", kEmotions)};

}  // namespace mien::gltf
