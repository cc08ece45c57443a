// SPDX-License-Identifier: MIT
// Spoken text as phonemes with times: what readers, synthesizers and recognizers make, and what becomes motion.
#pragma once

#include <string>
#include <vector>

namespace mien::speech {

/// Stress of a syllable, known at its vowel.
enum class Stress { kUnknown, kNone, kSecondary, kPrimary };

struct Phoneme {
  std::string label;          // as its source spells it, UTF-8: "oʊ", "AH0", "@"
  double begin = 0, end = 0;  // seconds
  Stress stress = Stress::kUnknown;
  float loudness = 0;  // decibels above the mean of the vowels; 0 without sound
};

/// Pauses are the gaps between phonemes.
struct Utterance {
  std::vector<Phoneme> phonemes;  // by time, not overlapping
  double seconds = 0;             // length of the sound, or of the file of phonemes
  std::string source;             // "espeak-ng, voice en-us", for notes
};

// Limits of what files may ask for: SECURITY.md, "What is promised".
constexpr size_t kMostPhonemes = 1000000;
constexpr double kLongestSeconds = 24 * 3600;
constexpr size_t kLongestLabel = 63;  // bytes

/// Spellings of pauses: "", "sil", "sp", "<p:>", ...
bool is_pause(const std::string& label);

}  // namespace mien::speech
