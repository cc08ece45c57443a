// SPDX-License-Identifier: MIT
// What `mien speak` and scenes are told to say -> an utterance, and its sound if there is one.
#pragma once

#include <optional>
#include <string>

#include "integrations/program/io/terminal.h"
#include "integrations/program/speech/take.h"
#include "integrations/program/speech/wav.h"

namespace mien::speech {

/// A text, or a sound with or without its text, or a file of phonemes.
struct SpeechSource {
  std::string text, voice = "en-us";
  std::string audio, phonemes;  // paths
};

struct Speech {
  Utterance utterance;
  Alphabet alphabet = Alphabet::kIpa;
  std::optional<Sound16> sound;
  std::string shown;  // for messages
  size_t bytes = 0;   // that it came from, for make_take()
};

/// Reads, synthesizes or recognizes. Notes say what the phonemes come from where that is a guess.
Speech read_speech(const SpeechSource& source, const cli::Session& session);

/// make_take(), and a note about labels that are not known.
SpokenTake make_take(const Speech& speech, double rate, const cli::Session& session);

}  // namespace mien::speech
