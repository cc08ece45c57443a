// SPDX-License-Identifier: MIT
// Poses of the procedural head for tests of mixing: visemes that close something, and 39 emotions.
#pragma once

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace mien {

/// "jawOpen .3, mouthSmile .5": values by control. A name whose control has sides stands for both.
using PoseText = const char*;

/// Lips closed for p, b, m: pressed, sealed over an open jaw, rounded, rolled in, tense.
constexpr PoseText kClosedLips[] = {
    "mouthPress .6, mouthRollLower .2, mouthRollUpper .15",
    "jawOpen .25, mouthClose 1, mouthPress .3",
    "mouthPucker .5, mouthPress .4, mouthClose .4",
    "mouthRollLower .7, mouthRollUpper .6, mouthStretch .2",
    "mouthPress .35, mouthShrugLower .25, mouthDimple .3, jawOpen .08, mouthClose 1",
};

/// Lower lip at the upper teeth for f, v.
constexpr PoseText kLipToTeeth[] = {
    "mouthRollLower .7, mouthShrugLower .15, mouthUpperUp .2",
    "mouthRollLower .5, mouthShrugLower .3, mouthUpperUp .35, mouthStretch .2",
};

constexpr PoseText kBasicEmotions[] = {
    // joy, laughter, grief, anger, rage
    "mouthSmile .8, cheekSquint .6, eyeSquint .3, browOuterUp .2, mouthDimple .2, mouthUpperUp "
    ".25, "
    "jawOpen .12",
    "mouthSmile .9, cheekSquint .8, eyeSquint .5, mouthUpperUp .4, mouthLowerDown .3, jawOpen .5, "
    "noseSneer .2, browInnerUp .2",
    "browInnerUp .8, browDown .3, mouthFrown .7, mouthShrugLower .4, mouthStretch .25, eyeSquint "
    ".25, "
    "eyeLookDown .3, mouthLowerDown .15",
    "browDown .9, noseSneer .5, eyeSquint .5, mouthUpperUp .3, mouthLowerDown .3, mouthFrown .3, "
    "jawForward .3, cheekSquint .3",
    "browDown 1, noseSneer .8, eyeWide .3, mouthUpperUp .6, mouthLowerDown .6, mouthStretch .5, "
    "jawOpen .6, cheekSquint .5",
    // fear, surprise, disgust, contempt, pain
    "browInnerUp .8, browOuterUp .5, browDown .3, eyeWide .8, mouthStretch .6, mouthLowerDown .35, "
    "jawOpen .25, mouthFrown .2",
    "browInnerUp .9, browOuterUp .9, eyeWide .7, jawOpen .55, mouthFunnel .2, eyeLookUp .1",
    "noseSneer .9, mouthUpperUp .5, browDown .5, eyeSquint .5, cheekSquint .5, mouthFrown .4, "
    "mouthShrugLower .5",
    "mouthSmileLeft .5, mouthDimpleLeft .6, mouthUpperUpLeft .3, noseSneerLeft .3, eyeSquint .3, "
    "browOuterUpRight .5, browDownLeft .3, jawLeft .15",
    "browDown .7, browInnerUp .4, eyeSquint .8, cheekSquint .7, noseSneer .5, mouthStretch .6, "
    "mouthUpperUp .4, mouthLowerDown .2, jawOpen .15",
    // pride, tenderness, worry
    "mouthSmile .35, mouthPress .2, mouthShrugLower .3, browOuterUp .3, eyeSquint .2, mouthDimple "
    ".3, "
    "eyeLookDown .2",
    "mouthSmile .4, browInnerUp .5, cheekSquint .3, mouthPucker .2, eyeSquint .2, eyeLookDown .15, "
    "mouthRollLower .1",
    "browInnerUp .7, browDown .5, mouthRollLower .3, mouthPress .3, mouthStretch .2, eyeWide .2, "
    "mouthFrown .25",
};

using Pose = std::vector<float>;  // [raw control]

inline Pose pose_of(PoseText text, const std::vector<std::string>& controls) {
  Pose pose(controls.size());
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    std::istringstream words(item);
    std::string name;
    float value = 0;
    words >> name >> value;
    bool found = false;
    for (size_t c = 0; c < controls.size(); ++c) {
      if (controls[c] != name && controls[c] != name + "Left" && controls[c] != name + "Right") {
        continue;
      }
      pose[c] = value;
      found = true;
    }
    if (!found) abort();
  }
  return pose;
}

/// The basic emotions, and mixtures of neighbors.
inline std::vector<Pose> emotions_of(const std::vector<std::string>& controls) {
  constexpr size_t kCount = sizeof(kBasicEmotions) / sizeof(kBasicEmotions[0]);
  std::vector<Pose> basic, all;
  for (PoseText text : kBasicEmotions) basic.push_back(pose_of(text, controls));
  all = basic;
  for (size_t step : {1, 5}) {
    for (size_t i = 0; i < kCount; ++i) {
      Pose mixed(controls.size());
      for (size_t c = 0; c < mixed.size(); ++c) {
        mixed[c] = 0.6f * basic[i][c] + 0.4f * basic[(i + step) % kCount][c];
      }
      all.push_back(mixed);
    }
  }
  return all;
}

}  // namespace mien
