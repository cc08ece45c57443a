// SPDX-License-Identifier: MIT
// Labels of phonemes, WAV samples, and the guess from a sound.
#include "integrations/program/speech/sounds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrations/program/speech/recognizer.h"
#include "integrations/program/speech/wav.h"

namespace mien::speech {
namespace {

Segments take_apart(const std::vector<std::string>& labels) {
  Utterance utterance;
  for (size_t i = 0; i < labels.size(); ++i) {
    const double begin = static_cast<double>(i);
    utterance.phonemes.push_back({labels[i], begin, begin + 1, Stress::kUnknown, 0});
  }
  return find_segments(utterance, find_alphabet(utterance.phonemes));
}

std::u32string letters_of(const Segments& segments) {
  std::u32string letters;
  for (const Segment& segment : segments.list) letters += segment.sound->letter;
  return letters;
}

TEST(Sounds, TheThreeAlphabetsSayTheSame) {
  EXPECT_EQ(letters_of(take_apart({"tʃ", "iː", "z"})), U"tʃiz");
  EXPECT_EQ(letters_of(take_apart({"CH", "IY1", "Z"})), U"tʃiz");
  EXPECT_EQ(letters_of(take_apart({"tS", "i:", "z"})), U"tʃiz");
  EXPECT_EQ(letters_of(take_apart({"ʃ", "øː", "n", "ə"})), U"ʃønə");
  EXPECT_EQ(letters_of(take_apart({"S", "2:", "n", "@"})), U"ʃønə");
}

TEST(Sounds, LettersWithMarksAreThoseLetters) {
  EXPECT_EQ(letters_of(take_apart({"ä", "ʧ", "ɔ̃", "rʲ", "ε", "õː"})), U"atʃɔrɛo");
  for (const char* label : {"ʲ", "ː", "̃", "ʰː"}) EXPECT_TRUE(is_modifier(label)) << label;
  for (const char* label : {"", "a", "rʲ", "ˈ", "5", "(en)"}) EXPECT_FALSE(is_modifier(label));
}

TEST(Sounds, DiphthongsAndAffricatesShareTheirTime) {
  const Segments segments = take_apart({"aʊ"});
  ASSERT_EQ(segments.list.size(), 2u);
  EXPECT_GT(segments.list[0].end, 0.5);
  EXPECT_EQ(segments.list[0].end, segments.list[1].begin);
  EXPECT_EQ(segments.list[1].end, 1);
}

TEST(Sounds, UnknownLabelsAreListedOnce) {
  const Segments segments = take_apart({"m", "☃", "☃"});
  EXPECT_EQ(segments.list.size(), 1u);
  EXPECT_EQ(segments.unknown, std::vector<std::string>{"☃"});
}

TEST(Sounds, HaveAmountsAndDominancesUpToOne) {
  for (const Sound& sound : kSounds) {
    const Dominance& d = sound.dominance;
    for (const float value : {d.jaw, d.lips, d.rounding, d.spreading, d.tongue, sound.amount}) {
      EXPECT_GT(value, 0);
      EXPECT_LE(value, 1);
    }
  }
}

/// A voice of 120 Hz with energy near two frequencies.
Sound16 voice(double first, double second) {
  Sound16 sound;
  sound.rate = 16000;
  for (int i = 0; i < 8000; ++i) {
    double sum = 0;
    for (int k = 1; k < 30; ++k) {
      const double f = 120.0 * k;
      sum +=
          std::sin(2 * 3.14159265358979 * f * i / 16000) *
          (std::exp(-std::pow((f - first) / 120, 2)) + std::exp(-std::pow((f - second) / 120, 2)));
    }
    sound.samples.push_back(static_cast<int16_t>(6000 * sum));
  }
  return sound;
}

std::string guess(const Sound16& sound) {
  const Utterance utterance = guess_phonemes(sound);
  return utterance.phonemes.empty() ? "" : utterance.phonemes[utterance.phonemes.size() / 2].label;
}

TEST(Guess, TellsOpenSpreadAndRoundVowels) {
  EXPECT_EQ(guess(voice(750, 1200)), "a");
  EXPECT_EQ(guess(voice(280, 2300)), "i");
  EXPECT_EQ(guess(voice(300, 700)), "u");
}

TEST(Guess, HearsNothingInSilence) {
  Sound16 silent;
  silent.rate = 16000;
  silent.samples.resize(16000);
  EXPECT_TRUE(guess_phonemes(silent).phonemes.empty());
}

TEST(Wav, ResamplingKeepsWhatTheLowerRateHolds) {
  Sound16 sound;
  sound.rate = 44100;
  for (int i = 0; i < 44100; ++i) {
    sound.samples.push_back(
        static_cast<int16_t>(10000 * std::sin(2 * 3.14159265358979 * 1000 * i / 44100.0)));
  }
  const Sound16 low = resample(sound, 16000);
  EXPECT_NEAR(low.seconds(), 1, 0.001);
  EXPECT_NEAR(loudness(low, 0.1, 0.9), loudness(sound, 0.1, 0.9), 0.1);
  for (int i = 0; i < 44100; ++i) {
    sound.samples[static_cast<size_t>(i)] =
        static_cast<int16_t>(10000 * std::sin(2 * 3.14159265358979 * 12000 * i / 44100.0));
  }
  EXPECT_LT(loudness(resample(sound, 16000), 0.1, 0.9), -50);
}

}  // namespace
}  // namespace mien::speech
