// SPDX-License-Identifier: MIT
// Files of phonemes: TextGrid of Praat and forced aligners, JSON. docs/speech.md, 1 "Phonemes".
#pragma once

#include <string>

#include "integrations/program/io/output.h"
#include "integrations/program/speech/sounds.h"

namespace mien::speech {

struct PhonemeFile {
  Utterance utterance;
  Alphabet alphabet = Alphabet::kIpa;
};

/// The text of a file, told by its content. Fails with exit code 2 and the place of what is wrong.
PhonemeFile parse_phonemes(const std::string& text, const std::string& shown);

// The two, which parse_phonemes() chooses from.
PhonemeFile parse_textgrid(const std::string& text, const std::string& shown);
PhonemeFile parse_phoneme_json(const std::string& text, const std::string& shown);

/// Adds an interval of a file, unless it is a pause. Fails if it is not behind the others.
void add_interval(Utterance& utterance, Phoneme phoneme, const std::string& where);

/// What parse_phoneme_json() reads.
void write_phoneme_json(const Utterance& utterance, Alphabet alphabet, cli::Output& output);

}  // namespace mien::speech
