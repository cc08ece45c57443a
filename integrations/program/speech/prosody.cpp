// SPDX-License-Identifier: MIT
#include "integrations/program/speech/prosody.h"

#include <algorithm>
#include <cmath>

namespace mien::speech {

namespace {

/// Gaps from this length on end a phrase.
constexpr double kPhraseEnd = 0.15;

// Scales of vowels by stress, and per decibel.
constexpr float kPrimaryEffort = 1.12f, kUnstressedEffort = 0.85f, kEffortPerDecibel = 0.025f;
constexpr float kLeastEffort = 0.7f, kMostEffort = 1.25f;

/// A movement there and back.
struct Gesture {
  double begin, attack, hold, release;
  float amount;

  double at(double time) const {
    const double since = time - begin;
    if (since < attack) return static_cast<double>(amount) * ease(since / attack);
    return static_cast<double>(amount) * (1 - ease((since - attack - hold) / release));
  }
  double end() const { return begin + attack + hold + release; }
};

// Brows rise for the accent of a phrase; they begin to before it.
constexpr Gesture kBrows = {-0.06 - 0.18, 0.18, 0.12, 0.3, 0.3f};
constexpr float kOuterBrows = 0.5f;  // of the inner ones
// A blink, as the generator of mixers has it: docs/mixing.md.
constexpr Gesture kBlink = {0.03, 0.075, 0.025, 0.15, 1};
constexpr double kBlinkInterval = 1;
// The head beats down with stressed vowels: degrees, as tangents.
constexpr Gesture kAccentBeat = {-0.12, 0.16, 0.02, 0.32, -0.052f};
constexpr Gesture kStressBeat = {-0.1, 0.14, 0.0, 0.24, -0.021f};

/// What stands between two pauses.
struct Phrase {
  double end = 0;
  std::vector<size_t> stressed;  // segments with primary stress
  size_t accent = 0;             // of them, the index; only if there are any
};

/// How much a vowel stands out: long, and loud.
double prominence(const Segment& segment, const Phoneme& phoneme) {
  return (segment.end - segment.begin) *
         std::exp2(std::clamp(static_cast<double>(phoneme.loudness), -12.0, 12.0) / 6);
}

/// Without marks of stress, vowels that stand out among those of their phrase count as stressed.
std::vector<Phrase> find_phrases(const std::vector<Segment>& segments,
                                 const std::vector<Phoneme>& phonemes) {
  const bool is_marked = std::any_of(phonemes.begin(), phonemes.end(), [](const Phoneme& phoneme) {
    return phoneme.stress == Stress::kPrimary;
  });
  std::vector<Phrase> phrases;
  for (size_t begin = 0; begin < segments.size();) {
    size_t end = begin + 1;
    while (end < segments.size() && segments[end].begin - segments[end - 1].end < kPhraseEnd) ++end;
    Phrase phrase;
    phrase.end = segments[end - 1].end;
    double sum = 0, count = 0, most = -1;
    size_t longest = end;
    for (size_t s = begin; s < end; ++s) {
      if (!segments[s].sound->is_vowel) continue;
      if (prominence(segments[s], phonemes[segments[s].phoneme]) > most) {
        most = prominence(segments[s], phonemes[segments[s].phoneme]);
        longest = s;
      }
      sum += prominence(segments[s], phonemes[segments[s].phoneme]);
      ++count;
    }
    for (size_t s = begin; s < end; ++s) {
      const Phoneme& phoneme = phonemes[segments[s].phoneme];
      if (!segments[s].sound->is_vowel) continue;
      // The second vowel of a diphthong is in the same syllable.
      const bool is_second = s > begin && segments[s - 1].phoneme == segments[s].phoneme &&
                             segments[s - 1].sound->is_vowel;
      const bool stands_out = is_marked ? phoneme.stress == Stress::kPrimary
                                        : prominence(segments[s], phoneme) > 1.15 * sum / count;
      if (stands_out && !is_second) phrase.stressed.push_back(s);
    }
    // Each phrase has an accent: if none stands out, on its longest vowel.
    if (phrase.stressed.empty() && longest < end) phrase.stressed.push_back(longest);
    for (size_t i = 0; i < phrase.stressed.size(); ++i) {
      const auto of = [&](size_t number) {
        const Segment& segment = segments[phrase.stressed[number]];
        return prominence(segment, phonemes[segment.phoneme]);
      };
      // The last of equals: accents of phrases are late.
      if (of(i) >= of(phrase.accent)) phrase.accent = i;
    }
    phrases.push_back(std::move(phrase));
    begin = end;
  }
  return phrases;
}

Gesture at_time(Gesture gesture, double time) {
  gesture.begin += time;
  return gesture;
}

/// The larger one where gestures overlap; `use` gets frames and values.
template <class Use>
void play(const Gesture& gesture, double rate, size_t frame_count, const Use& use) {
  const double last = std::floor(gesture.end() * rate);
  for (double f = std::max(0.0, std::ceil(gesture.begin * rate));
       f <= last && f < static_cast<double>(frame_count); ++f) {
    use(static_cast<size_t>(f), gesture.at(f / rate));
  }
}

}  // namespace

std::vector<float> find_effort(const std::vector<Phoneme>& phonemes) {
  const bool is_marked = std::any_of(phonemes.begin(), phonemes.end(), [](const Phoneme& phoneme) {
    return phoneme.stress == Stress::kPrimary;
  });
  std::vector<float> effort;
  for (const Phoneme& phoneme : phonemes) {
    float own = 1;
    if (is_marked && phoneme.stress == Stress::kPrimary) own = kPrimaryEffort;
    if (is_marked && phoneme.stress <= Stress::kNone) own = kUnstressedEffort;
    own *= 1 + kEffortPerDecibel * phoneme.loudness;
    effort.push_back(std::clamp(own, kLeastEffort, kMostEffort));
  }
  return effort;
}

void move_upper_face(const std::vector<Segment>& segments, const std::vector<Phoneme>& phonemes,
                     Curves& curves) {
  const size_t inner = curves.control("browInnerUp"), left = curves.control("browOuterUpLeft"),
               right = curves.control("browOuterUpRight"),
               left_lid = curves.control("eyeBlinkLeft"),
               right_lid = curves.control("eyeBlinkRight");
  const auto raise = [&](size_t frame, size_t control, double value) {
    curves.at(frame, control) =
        std::max(curves.at(frame, control), static_cast<float>(std::clamp(value, 0.0, 1.0)));
  };
  double last_blink = -kBlinkInterval;
  for (const Phrase& phrase : find_phrases(segments, phonemes)) {
    if (!phrase.stressed.empty()) {
      const double accent = segments[phrase.stressed[phrase.accent]].begin;
      play(at_time(kBrows, accent), curves.rate, curves.frame_count, [&](size_t f, double value) {
        raise(f, inner, value);
        raise(f, left, value * static_cast<double>(kOuterBrows));
        raise(f, right, value * static_cast<double>(kOuterBrows));
      });
    }
    if (phrase.end - last_blink < kBlinkInterval) continue;
    last_blink = phrase.end;
    play(at_time(kBlink, phrase.end), curves.rate, curves.frame_count, [&](size_t f, double value) {
      raise(f, left_lid, value);
      raise(f, right_lid, value);
    });
  }
}

std::vector<float> move_head(const std::vector<Segment>& segments,
                             const std::vector<Phoneme>& phonemes, double rate,
                             size_t frame_count) {
  std::vector<float> up(frame_count);
  for (const Phrase& phrase : find_phrases(segments, phonemes)) {
    for (size_t i = 0; i < phrase.stressed.size(); ++i) {
      const Gesture& beat = i == phrase.accent ? kAccentBeat : kStressBeat;
      play(at_time(beat, segments[phrase.stressed[i]].begin), rate, frame_count,
           [&](size_t f, double value) { up[f] = std::min(up[f], static_cast<float>(value)); });
    }
  }
  return up;
}

}  // namespace mien::speech
