// SPDX-License-Identifier: MIT
// Labels of phonemes in three alphabets -> sounds of the table.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/speech/phoneme.h"
#include "integrations/program/speech/sound_table.h"

namespace mien::speech {

enum class Alphabet { kIpa, kArpabet, kSampa };

/// The alphabet of which all labels are; IPA if several fit.
Alphabet find_alphabet(const std::vector<Phoneme>& phonemes);

/// Whether a label only has diacritics and small raised letters, which say more about the sound before: "ʲ", "ː".
bool is_modifier(const std::string& label);

/// A sound with its time. A diphthong or an affricate is two of them.
struct Segment {
  const Sound* sound = nullptr;
  double begin = 0, end = 0;  // seconds
  uint32_t phoneme = 0;       // that it is of
};

struct Segments {
  std::vector<Segment> list;
  std::vector<std::string> unknown;  // labels without a known letter, each once
};

/// Takes labels apart, and finds the stress of vowels that labels name ("AH1", "ˈa").
Segments find_segments(Utterance& utterance, Alphabet alphabet);

}  // namespace mien::speech
