// SPDX-License-Identifier: MIT
// How active guards are: by the closures that clips of speech label, or by the protected row.
#pragma once

#include "runtime/mix/mixer.h"

namespace mien {

/// A speech layer, as guards see it.
struct SpeechLayer {
  float weight;
  float labeled[kClosures];  // share of what it plays that labels this closure,
  float closed[kClosures];   // and how far it is closed according to these labels
};

struct Speech {
  SpeechLayer layers[kMaxLayers];
  uint32_t count = 0;
};

/// The speech layers at the current time.
Speech find_speech(const Mixer& mixer);

/// The activation of a guard; `distance` is that in the protected row. For clips with labels, these count
/// instead of the distance.
float activation_of(const Mixer& mixer, size_t guard, float distance, const Speech& speech);

}  // namespace mien
