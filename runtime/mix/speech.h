// SPDX-License-Identifier: MIT
// How active guards are: by what speech closes, as its clips say or as the protected row has it.
#pragma once

#include "runtime/mix/mixer.h"

namespace mien {

/// A layer of speech, as guards see it.
struct SpeechLayer {
  float weight;
  float labeled[kClosures];  // the share of what it plays that says itself when this is closed,
  float closed[kClosures];   // and how far it is closed according to that
};

struct Speech {
  SpeechLayer layers[kMaxLayers];
  uint32_t count = 0;
};

/// What the layers of speech show now.
Speech find_speech(const Mixer& mixer);

/// Of a guard whose distance is that in the protected row. What clips say themselves counts for them
/// instead of the distance.
float activation_of(const Mixer& mixer, size_t guard, float distance, const Speech& speech);

}  // namespace mien
