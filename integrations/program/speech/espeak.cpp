// SPDX-License-Identifier: MIT
#include "integrations/program/speech/espeak.h"

#ifndef _WIN32
#include <dlfcn.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/text.h"
#include "integrations/program/speech/sounds.h"

namespace mien::speech {

namespace {

constexpr const char* kCannotSay = "cannot speak text";
constexpr size_t kMostText = 100000;
/// Silence before the first sound, in which lips and jaw move to it.
constexpr double kLead = 0.2;
/// A pause of the voice that is no phoneme; shorter ones belong to the sound before.
constexpr double kPause = 0.06;

// What is used of the library's interface: espeak-ng/speak_lib.h, the same since version 1.49.
constexpr int kSynchronous = 2, kPhonemeEvents = 1, kIpaEvents = 2, kDoNotExit = 0x8000;
constexpr int kTraceIpa = 3, kUtf8 = 1;
enum EventType { kLast = 0, kEndOfClause = 5, kPhonemeEvent = 7 };
struct Event {
  int type;
  unsigned number;
  int text_position, length;
  int milliseconds;
  int sample;
  void* user;
  union {
    int number;
    const char* name;
    char letters[8];  // not terminated if all eight are used
  } id;
};
using Callback = int(short*, int, Event*);
struct Voice {
  const char *name, *languages, *identifier;
  unsigned char gender, age, variant, reserved;
  int score;
  void* spare;
};

struct Library {
  int (*initialize)(int, int, const char*, int) = nullptr;
  int (*set_voice)(const char*) = nullptr;
  int (*set_voice_of)(Voice*) = nullptr;
  void (*set_callback)(Callback*) = nullptr;
  void (*trace)(int, FILE*) = nullptr;
  int (*synthesize)(const void*, size_t, unsigned, int, unsigned, unsigned, unsigned*,
                    void*) = nullptr;
  int (*synchronize)() = nullptr;
};

/// Null without the library. It stays loaded.
const Library* load() {
#ifdef _WIN32
  return nullptr;
#else
  static Library library;
  static const bool loaded = [] {
    void* handle = dlopen("libespeak-ng.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!handle) return false;
    const auto find = [&](auto& function, const char* name) {
      void* address = dlsym(handle, name);
      std::memcpy(&function, &address, sizeof function);
      return address != nullptr;
    };
    return find(library.initialize, "espeak_Initialize") &&
           find(library.set_voice, "espeak_SetVoiceByName") &&
           find(library.set_voice_of, "espeak_SetVoiceByProperties") &&
           find(library.set_callback, "espeak_SetSynthCallback") &&
           find(library.trace, "espeak_SetPhonemeTrace") &&
           find(library.synthesize, "espeak_Synth") &&
           find(library.synchronize, "espeak_Synchronize");
  }();
  return loaded ? &library : nullptr;
#endif
}

/// What the library hands to its callback.
struct Heard {
  struct Mark {
    int sample;
    std::string letters;
    bool ends_clause;
  };
  std::vector<int16_t> samples;
  std::vector<Mark> marks;
};
Heard* heard = nullptr;  // the callback has no argument for it

int hear(short* samples, int count, Event* events) {
  if (samples && count > 0) heard->samples.insert(heard->samples.end(), samples, samples + count);
  for (; events && events->type != kLast; ++events) {
    if (events->type == kPhonemeEvent) {
      const char* letters = events->id.letters;
      heard->marks.push_back({events->sample,
                              std::string(letters, strnlen(letters, sizeof events->id.letters)),
                              false});
    }
    if (events->type == kEndOfClause) heard->marks.push_back({events->sample, "", true});
  }
  return 0;
}

/// Marks of stress are not in events, but in the transcription, which has the same letters.
void find_stress(const std::string& transcription, std::vector<Phoneme>& phonemes) {
  size_t at = 0;
  const auto skip = [&](const char* mark) {
    const size_t length = std::strlen(mark);
    if (transcription.compare(at, length, mark) != 0) return false;
    at += length;
    return true;
  };
  for (Phoneme& phoneme : phonemes) {
    Stress stress = Stress::kNone;
    while (true) {
      if (skip("ˈ")) {
        stress = Stress::kPrimary;
      } else if (skip("ˌ")) {
        stress = Stress::kSecondary;
      } else if (!skip(" ") && !skip("\n")) {
        break;
      }
    }
    // A language is named where it changes: "(en)".
    while (at < transcription.size() && transcription[at] == '(') {
      const size_t end = transcription.find(')', at);
      if (end == std::string::npos) return;
      at = end + 1;
    }
    if (!skip(phoneme.label.c_str())) return;  // without stress from here on
    phoneme.stress = stress;
  }
}

double rounded(double seconds) { return std::round(seconds * 1e4) / 1e4; }

}  // namespace

bool has_espeak() { return load() != nullptr; }

Spoken speak(const std::string& text, const std::string& voice) {
  if (text.size() > kMostText) {
    cli::fail_usage("TEXT", "it is longer than 100,000 bytes", "speak it part by part");
  }
  constexpr const char* kInstall = "install it (Debian: apt-get install espeak-ng)";
  const Library* library = load();
  if (!library) {
    cli::fail(cli::kFile, kCannotSay, "", "libespeak-ng.so.1 of the package espeak-ng is missing",
              kInstall);
  }
  const int rate =
      library->initialize(kSynchronous, 0, nullptr, kPhonemeEvents | kIpaEvents | kDoNotExit);
  if (rate <= 0) {
    cli::fail(cli::kFile, kCannotSay, "", "the voices of espeak-ng are missing",
              "install them (Debian: apt-get install espeak-ng-data)");
  }
  // Names of voices, then languages, which some voices are not named after: en-gb.
  Voice language = {};
  language.languages = voice.c_str();
  if (library->set_voice(voice.c_str()) != 0 && library->set_voice_of(&language) != 0) {
    cli::fail_usage("--voice \"" + cli::one_line(voice) + "\"", "espeak-ng has no such voice",
                    "'espeak-ng --voices' lists them");
  }
  Heard all;
  heard = &all;
  library->set_callback(hear);
  // The library writes its transcription to a stream.
  std::string transcription;
  if (FILE* trace = std::tmpfile()) {
    library->trace(kTraceIpa, trace);
    const int status =
        library->synthesize(text.c_str(), text.size() + 1, 0, 1, 0, kUtf8, nullptr, nullptr);
    library->synchronize();
    library->trace(0, nullptr);
    heard = nullptr;
    std::rewind(trace);
    char buffer[4096];
    for (size_t got; (got = std::fread(buffer, 1, sizeof buffer, trace)) > 0;) {
      transcription.append(buffer, got);
    }
    std::fclose(trace);
    if (status != 0) {
      cli::fail(cli::kInternal, kCannotSay, "", "espeak-ng fails with " + std::to_string(status),
                "try a shorter text");
    }
  } else {
    cli::fail(cli::kFile, kCannotSay, "", "no temporary file can be made", "see TMPDIR");
  }

  Spoken spoken;
  spoken.sound.rate = static_cast<uint32_t>(rate);
  const auto lead = static_cast<size_t>(kLead * rate);
  spoken.sound.samples.assign(lead, 0);
  spoken.sound.samples.insert(spoken.sound.samples.end(), all.samples.begin(), all.samples.end());
  // A phoneme lasts until the next one; the last one of all until the sound ends.
  std::vector<Phoneme>& phonemes = spoken.utterance.phonemes;
  for (size_t i = 0; i < all.marks.size(); ++i) {
    const Heard::Mark& mark = all.marks[i];
    // A language is named where it changes: "(en)".
    if (mark.ends_clause || mark.letters[0] == '(') continue;
    const double end_sample = i + 1 < all.marks.size() ? all.marks[i + 1].sample
                                                       : static_cast<double>(all.samples.size());
    const double begin = kLead + mark.sample / static_cast<double>(rate);
    const double end = std::max(begin, kLead + end_sample / rate);
    if (mark.letters.empty()) {
      const bool follows = !phonemes.empty() && phonemes.back().end > begin - 1e-6;
      if (follows && end - begin < kPause) phonemes.back().end = rounded(end);
      continue;
    }
    if (is_modifier(mark.letters) && !phonemes.empty()) {
      phonemes.back().label += mark.letters;
      phonemes.back().end = rounded(end);
      continue;
    }
    // Times of 0.1 ms, so that files of phonemes are short, and give the same take.
    phonemes.push_back({mark.letters, rounded(begin), rounded(end), Stress::kUnknown, 0});
  }
  if (phonemes.empty()) {
    cli::fail(cli::kInvalid, kCannotSay, "", "there is nothing in it that can be said",
              "give words of the language of the voice");
  }
  find_stress(transcription, phonemes);
  spoken.utterance.seconds = rounded(spoken.sound.seconds());
  spoken.utterance.source = "espeak-ng, voice " + voice;
  measure_loudness(spoken.sound, spoken.utterance);
  return spoken;
}

void measure_loudness(const Sound16& sound, Utterance& utterance) {
  Utterance copy = utterance;
  const Segments segments = find_segments(copy, find_alphabet(copy.phonemes));
  std::vector<bool> has_vowel(utterance.phonemes.size());
  for (const Segment& segment : segments.list) {
    if (segment.sound->is_vowel) has_vowel[segment.phoneme] = true;
  }
  // Tenths: see the times of speak().
  const auto decibels = [](double level) {
    return std::round(std::clamp(level, -30.0, 30.0) * 10) / 10;
  };
  double sum = 0, count = 0;
  std::vector<double> levels;
  for (size_t p = 0; p < utterance.phonemes.size(); ++p) {
    const Phoneme& phoneme = utterance.phonemes[p];
    levels.push_back(loudness(sound, phoneme.begin, phoneme.end));
    if (has_vowel[p]) sum += levels[p], ++count;
  }
  for (size_t p = 0; p < utterance.phonemes.size(); ++p) {
    utterance.phonemes[p].loudness =
        has_vowel[p] ? static_cast<float>(decibels(levels[p] - sum / count)) : 0.0f;
  }
}

}  // namespace mien::speech
