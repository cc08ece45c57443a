// SPDX-License-Identifier: MIT
// Twenty sentences in three languages on the generated head, measured on its meshes. Their phonemes are in
// sentences/, made by `mien speak TEXT --voice VOICE --save-phonemes FILE`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "integrations/program/speech/phoneme_file.h"
#include "integrations/program/tests/speech/spoken_head.h"

namespace mien::speech {
namespace {

struct Sentence {
  std::string name;
  Utterance utterance;
  SpokenTake take;
};

const std::vector<Sentence>& sentences() {
  static const std::vector<Sentence> all = [] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(MIEN_SENTENCES)) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<Sentence> list;
    for (const auto& path : files) {
      std::ifstream stream(path);
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      PhonemeFile file = parse_phonemes(text, path.filename().string());
      SpokenTake take = make_take(file.utterance, file.alphabet, 60, text.size(), "a sentence");
      list.push_back({path.stem().string(), std::move(file.utterance), std::move(take)});
    }
    return list;
  }();
  return all;
}

bool has_letter(const std::string& label, const char* letters) {
  return label.find_first_of(letters) != std::string::npos;
}

/// The least value of a measure in the frames of a phoneme, and the one after.
template <class Measure>
double least(const Sentence& sentence, const Phoneme& phoneme, const Measure& measure) {
  double found = 1e9;
  const double rate = sentence.take.curves.rate;
  const auto last = static_cast<size_t>(std::ceil(phoneme.end * rate)) + 1;
  for (auto f = static_cast<size_t>(std::floor(phoneme.begin * rate)); f <= last; ++f) {
    found = std::min(found, measure(spoken_head().shape(sentence.take, f)));
  }
  return found;
}

double gap(const MouthShape& shape) { return shape.lip_gap; }
double to_teeth(const MouthShape& shape) { return shape.lip_to_teeth; }

TEST(Sentences, AreTwentyInThreeLanguages) {
  std::set<std::string> languages;
  for (const Sentence& sentence : sentences()) {
    languages.insert(sentence.name.substr(0, 2));
    EXPECT_TRUE(sentence.take.unknown.empty()) << sentence.name << ": " << sentence.take.unknown[0];
    EXPECT_GT(sentence.utterance.phonemes.size(), 12u) << sentence.name;
  }
  EXPECT_EQ(sentences().size(), 20u);
  EXPECT_EQ(languages, (std::set<std::string>{"de", "en", "es"}));
}

TEST(Sentences, LipsCloseAtEachMBAndP) {
  size_t count = 0;
  double worst = -1e9;
  for (const Sentence& sentence : sentences()) {
    for (const Phoneme& phoneme : sentence.utterance.phonemes) {
      if (!has_letter(phoneme.label, "mbp")) continue;
      const double closed = least(sentence, phoneme, gap);
      EXPECT_LT(closed, 0.3) << sentence.name << ": " << phoneme.label << " at " << phoneme.begin;
      worst = std::max(worst, closed);
      ++count;
    }
  }
  EXPECT_GT(count, 60u);
  std::printf("%zu closures, the worst is %.2f mm\n", count, worst);
}

TEST(Sentences, LipsStayTogetherForTheWholeClosure) {
  double worst = -1e9;
  for (const Sentence& sentence : sentences()) {
    for (const SpokenEvent& event : sentence.take.events) {
      if (event.name != "close:lips") continue;
      const double begin = static_cast<double>(event.tick) / MIEN_TICKS_PER_SECOND;
      const double end = begin + static_cast<double>(event.seconds);
      const double rate = sentence.take.curves.rate;
      for (auto f = static_cast<size_t>(std::ceil(begin * rate));
           static_cast<double>(f) <= end * rate; ++f) {
        const double apart = gap(spoken_head().shape(sentence.take, f));
        EXPECT_LT(apart, 0.1) << sentence.name << " at " << sentence.take.curves.time(f);
        worst = std::max(worst, apart);
      }
    }
  }
  std::printf("lips in closures: at most %.2f mm apart\n", worst);
}

// "my mother", "Bob": however near two closures are, a vowel between them is seen.
TEST(Sentences, VowelsBetweenTwoClosuresPartTheLips) {
  size_t count = 0;
  double worst = 1e9;
  for (const Sentence& sentence : sentences()) {
    const std::vector<Phoneme>& phonemes = sentence.utterance.phonemes;
    for (size_t p = 1; p + 1 < phonemes.size(); ++p) {
      const bool is_between =
          has_letter(phonemes[p - 1].label, "mbp") && has_letter(phonemes[p + 1].label, "mbp");
      if (!is_between || has_letter(phonemes[p].label, "mbp")) continue;
      const double open =
          -least(sentence, phonemes[p], [](const MouthShape& s) { return -s.lip_gap; });
      EXPECT_GT(open, 1) << sentence.name << ": " << phonemes[p].label << " at "
                         << phonemes[p].begin;
      worst = std::min(worst, open);
      ++count;
    }
  }
  EXPECT_GT(count, 2u);
  std::printf("%zu vowels between closures, the lips part by %.2f mm at least\n", count, worst);
}

TEST(Sentences, TheLowerLipTouchesTheUpperTeethAtEachFAndV) {
  const double at_rest = spoken_head().shape({}).lip_to_teeth;
  ASSERT_GT(at_rest, 3);
  size_t count = 0;
  double worst = 0;
  for (const Sentence& sentence : sentences()) {
    for (const Phoneme& phoneme : sentence.utterance.phonemes) {
      if (!has_letter(phoneme.label, "fv")) continue;
      const double touching = least(sentence, phoneme, to_teeth);
      EXPECT_LT(touching, 1.3) << sentence.name << ": " << phoneme.label << " at " << phoneme.begin;
      worst = std::max(worst, touching);
      ++count;
    }
  }
  EXPECT_GT(count, 20u);
  std::printf("%zu contacts, the worst is %.2f mm, %.1f at rest\n", count, worst, at_rest);
}

TEST(Sentences, NoToothIsInTheTongue) {
  size_t count = 0;
  for (const Sentence& sentence : sentences()) {
    const Curves& curves = sentence.take.curves;
    const size_t tongue = curves.control("tongueOut");
    for (size_t f = 0; f < curves.frame_count; ++f) {
      if (!(curves.values[f * curves.controls.size() + tongue] > 0)) continue;
      const PiercedTongue pierced = spoken_head().pierced(sentence.take, f);
      EXPECT_LT(pierced.by_lower, 0.3) << sentence.name << " at " << curves.time(f);
      EXPECT_LT(pierced.by_upper, 0.3) << sentence.name << " at " << curves.time(f);
      ++count;
    }
  }
  EXPECT_GT(count, 200u);
}

TEST(Sentences, TheMouthOpensAtOpenVowels) {
  size_t count = 0;
  for (const Sentence& sentence : sentences()) {
    for (const Phoneme& phoneme : sentence.utterance.phonemes) {
      const bool is_open = phoneme.label == "a" || phoneme.label == "aɪ" || phoneme.label == "ɑː";
      if (!is_open || phoneme.stress != Stress::kPrimary || phoneme.end - phoneme.begin < 0.09)
        continue;
      const double most = -least(sentence, phoneme, [](const MouthShape& s) { return -s.lip_gap; });
      EXPECT_GT(most, 3) << sentence.name << ": " << phoneme.label << " at " << phoneme.begin;
      ++count;
    }
  }
  EXPECT_GT(count, 10u);
}

// docs/speech.md, 6 "Measured": what is known of the jaw in speech.
TEST(Sentences, TheJawMovesAsJawsOfSpeakersDo) {
  double fastest = 0, widest = 0;
  for (const Sentence& sentence : sentences()) {
    double before = 0;
    for (size_t f = 0; f < sentence.take.curves.frame_count; ++f) {
      const double jaw = spoken_head().jaw(sentence.take, f);
      const double speed = f > 0 ? std::abs(jaw - before) * sentence.take.curves.rate : 0;
      EXPECT_LT(speed, 200) << sentence.name << " at " << sentence.take.curves.time(f);
      fastest = std::max(fastest, speed);
      widest = std::max(widest, jaw);
      before = jaw;
    }
  }
  EXPECT_GT(fastest, 60);
  EXPECT_LT(widest, 18);
  EXPECT_GT(widest, 7);
  std::printf("jaw: at most %.1f mm open and %.0f mm/s fast\n", widest, fastest);
}

// The opening of the mouth is modulated at 2 to 7 Hz: docs/speech.md, 6 "Measured".
TEST(Sentences, TheMouthOpensAsOftenAsInSpeech) {
  double all_openings = 0, all_seconds = 0;
  for (const Sentence& sentence : sentences()) {
    double openings = 0, low = 0, high = 0;
    bool rises = true;
    for (size_t f = 0; f < sentence.take.curves.frame_count; f += 2) {
      const double open = std::max(0.0, spoken_head().shape(sentence.take, f).lip_gap);
      low = std::min(low, open);
      high = std::max(high, open);
      // It rises from the least so far until it is a millimeter below the most, and so on.
      if (rises && high - low > 1 && open < high - 1) ++openings, rises = false, low = open;
      if (!rises && open > low + 1) rises = true, high = open;
    }
    Utterance utterance = sentence.utterance;
    std::set<uint32_t> syllables;
    for (const Segment& segment : find_segments(utterance, Alphabet::kIpa).list) {
      if (segment.sound->is_vowel) syllables.insert(segment.phoneme);
    }
    EXPECT_LE(openings, syllables.size()) << sentence.name;
    all_openings += openings;
    all_seconds += utterance.phonemes.back().end - utterance.phonemes.front().begin;
  }
  EXPECT_GT(all_openings / all_seconds, 2);
  EXPECT_LT(all_openings / all_seconds, 7);
  std::printf("%.1f openings per second\n", all_openings / all_seconds);
}

TEST(Sentences, ComeToRest) {
  for (const Sentence& sentence : sentences()) {
    const Curves& curves = sentence.take.curves;
    for (size_t c = 0; c < curves.controls.size(); ++c) {
      const float last = curves.values[(curves.frame_count - 1) * curves.controls.size() + c];
      EXPECT_LT(last, 0.03f) << sentence.name << ": " << curves.controls[c];
    }
  }
}

}  // namespace
}  // namespace mien::speech
