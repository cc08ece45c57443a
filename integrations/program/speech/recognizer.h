// SPDX-License-Identifier: MIT
// Sound -> phonemes, by libpocketsphinx and its model of American English, loaded when it is asked for; without
// it, a guess from energy and spectrum.
#pragma once

#include <optional>
#include <string>

#include "integrations/program/speech/phoneme.h"
#include "integrations/program/speech/wav.h"

namespace mien::speech {

/// Phonemes in ARPABET. With a text whose words the dictionary has, when its phonemes are said; else the most
/// likely phonemes. Nothing if the library or its model is missing, or finds nothing; `why` then says it in a
/// few words.
std::optional<Utterance> recognize(const Sound16& sound, const std::string& text, std::string& why);

/// Utterance.source of a guess.
constexpr const char* kGuess = "a guess from energy and spectrum";

/// Phonemes in IPA that open and shape the mouth as the sound does: a few vowels by where the energy of the spectrum
/// is, sibilants, and what is between vowels. It cannot tell m, b, p, f and v, so it has no closures.
Utterance guess_phonemes(const Sound16& sound);

}  // namespace mien::speech
