// SPDX-License-Identifier: MIT
#include "integrations/program/speech/source.h"

#include <cstdint>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/speech_input.h"
#include "integrations/program/io/text.h"
#include "integrations/program/speech/espeak.h"
#include "integrations/program/speech/phoneme_file.h"
#include "integrations/program/speech/recognizer.h"

namespace mien::speech {

namespace {

constexpr double kLongestSound = 3600;
constexpr double kSilent = -70;  // decibels below full scale

Speech hear(const SpeechSource& source, const cli::Session& session) {
  Speech speech;
  speech.shown = cli::shown_name(source.audio);
  const std::string bytes = cli::read_wav(source.audio);
  speech.bytes = bytes.size();
  speech.sound = parse_wav(bytes, speech.shown);
  if (speech.sound->seconds() > kLongestSound) {
    cli::fail(cli::kInvalid, "cannot hear sound", speech.shown, "it is longer than an hour",
              "cut it into parts");
  }
  if (loudness(*speech.sound, 0, speech.sound->seconds()) < kSilent) {
    cli::fail(cli::kInvalid, "cannot hear sound", speech.shown, "it is silent",
              "give another WAV file");
  }
  std::string why;
  if (std::optional<Utterance> found = recognize(*speech.sound, source.text, why)) {
    speech.utterance = std::move(*found);
    speech.alphabet = Alphabet::kArpabet;
    if (!why.empty()) cli::note(session, speech.shown + ": not aligned with the text: " + why);
  } else {
    speech.utterance = guess_phonemes(*speech.sound);
    cli::note(session, speech.shown + ": " + why + "; phonemes are " + speech.utterance.source +
                           ", without the closures of m, b, p, f and v");
  }
  if (speech.utterance.phonemes.empty()) {
    cli::fail(cli::kInvalid, "cannot hear sound", speech.shown, "there is no speech in it",
              "give another WAV file, or --phonemes");
  }
  measure_loudness(*speech.sound, speech.utterance);
  return speech;
}

}  // namespace

Speech read_speech(const SpeechSource& source, const cli::Session& session) {
  Speech speech;
  if (!source.phonemes.empty()) {
    speech.shown = cli::shown_name(source.phonemes);
    const std::string text = cli::read_phonemes(source.phonemes);
    speech.bytes = text.size();
    PhonemeFile file = parse_phonemes(text, speech.shown);
    speech.utterance = std::move(file.utterance);
    speech.alphabet = file.alphabet;
    speech.utterance.source = speech.shown;
    return speech;
  }
  if (!source.audio.empty()) return hear(source, session);
  Spoken spoken = speak(source.text, source.voice);
  speech.shown = "the text";
  speech.utterance = std::move(spoken.utterance);
  speech.sound = std::move(spoken.sound);
  speech.bytes = 2 * speech.sound->samples.size();
  return speech;
}

SpokenTake make_take(const Speech& speech, double rate, const cli::Session& session) {
  SpokenTake take = make_take(speech.utterance, speech.alphabet, rate, speech.bytes, speech.shown);
  // A take says itself that it was guessed.
  if (speech.utterance.source == kGuess) {
    take.events.insert(take.events.begin(), {0, std::string("source: ") + kGuess, 0});
  }
  if (take.unknown.empty()) return take;
  std::string list;
  for (size_t i = 0; i < take.unknown.size() && i < 12; ++i) {
    list += (i == 0 ? "" : ", ") + cli::one_line(take.unknown[i]);
  }
  cli::note(session, speech.shown + ": no sound is known for " + cli::grouped(take.unknown.size()) +
                         (take.unknown.size() == 1 ? " label" : " labels") + ": " + list);
  return take;
}

}  // namespace mien::speech
