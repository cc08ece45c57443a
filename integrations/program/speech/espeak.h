// SPDX-License-Identifier: MIT
// Text -> sound and phonemes with times, by libespeak-ng. The library is loaded when it is asked for: Mien is
// neither built nor linked with it.
#pragma once

#include <string>

#include "integrations/program/speech/phoneme.h"
#include "integrations/program/speech/wav.h"

namespace mien::speech {

struct Spoken {
  Utterance utterance;  // in IPA
  Sound16 sound;
};

/// Whether the library is there.
bool has_espeak();

/// Speaks a text of up to 100,000 bytes with a voice such as "en-us" or "de". The sound begins with a short
/// silence, in which the mouth takes its first shape. Exit code 3 with the package's name if the library or
/// its data is missing, 1 if there is no such voice, 2 if nothing of the text can be said.
Spoken speak(const std::string& text, const std::string& voice);

/// Puts the loudness of a sound into phonemes: decibels above the mean of those with a vowel.
void measure_loudness(const Sound16& sound, Utterance& utterance);

}  // namespace mien::speech
