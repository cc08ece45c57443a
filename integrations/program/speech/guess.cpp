// SPDX-License-Identifier: MIT
// Phonemes from energy and spectrum alone: docs/speech.md, 7 "Sound without a recognizer".
#include <algorithm>
#include <array>
#include <cmath>

#include "integrations/program/speech/recognizer.h"

namespace mien::speech {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr uint32_t kGuessRate = 16000;
constexpr size_t kWindow = 400, kHop = 160;  // 25 ms and 10 ms
// Bands of the spectrum, in Hz; energies of filters of second order.
constexpr std::array<double, 9> kCenters = {250, 400, 600, 850, 1200, 1700, 2300, 3300, 5500};
/// Below the loudest part by more than this, in decibels, is a pause.
constexpr double kSilence = 35;
/// A dip of this many decibels below the vowels around it is a consonant.
constexpr double kDip = 10;

/// Energy near a frequency in a window of samples, by Goertzel's algorithm with a Hann window.
double energy(const int16_t* samples, double frequency) {
  const double turn = 2 * kPi * frequency / kGuessRate, factor = 2 * std::cos(turn);
  double last = 0, before = 0;
  for (size_t i = 0; i < kWindow; ++i) {
    const double window = 0.5 - 0.5 * std::cos(2 * kPi * static_cast<double>(i) / kWindow);
    const double now = samples[i] / 32768.0 * window + factor * last - before;
    before = last;
    last = now;
  }
  return last * last + before * before - factor * last * before;
}

/// Where energy of some bands is: their centers, weighted.
double center(const std::array<double, 9>& bands, size_t first, size_t last) {
  double sum = 0, weighted = 0;
  for (size_t b = first; b <= last; ++b) {
    sum += bands[b];
    weighted += bands[b] * kCenters[b];
  }
  return sum > 0 ? weighted / sum : 0;
}

/// The label of a window; "" for a pause.
const char* label_of(const std::array<double, 9>& bands, double level, double loudest,
                     double near) {
  if (level < loudest - kSilence) return "";
  double low = 0, high = bands[7] + bands[8];
  for (size_t b = 0; b < 7; ++b) low += bands[b];
  if (high > low) return bands[8] > 1.5 * bands[7] ? "s" : "ʃ";
  if (level < near - kDip) return "d";
  // The first formant rises with the opening of the jaw, the second falls with rounding.
  const double first = center(bands, 0, 3), second = center(bands, 4, 6);
  const double front = (bands[5] + bands[6]) / (low + 1e-12);
  if (first > 560) return "a";
  if (front > 0.05 && second > 1650) return first < 400 ? "i" : "e";
  if (front < 0.006) return first < 400 ? "u" : "o";
  return "ə";
}

}  // namespace

Utterance guess_phonemes(const Sound16& sound) {
  Sound16 heard = resample(sound, kGuessRate);
  Utterance utterance;
  utterance.seconds = sound.seconds();
  utterance.source = kGuess;
  heard.samples.resize(std::max(heard.samples.size(), kWindow));
  const size_t count = (heard.samples.size() - kWindow) / kHop + 1;
  std::vector<double> levels(count);
  double loudest = -120;
  for (size_t w = 0; w < count; ++w) {
    const double begin = static_cast<double>(w * kHop) / kGuessRate;
    levels[w] = loudness(heard, begin, begin + static_cast<double>(kWindow) / kGuessRate);
    loudest = std::max(loudest, levels[w]);
  }
  if (loudest < -70) return utterance;  // silence
  std::vector<const char*> labels(count);
  for (size_t w = 0; w < count; ++w) {
    std::array<double, 9> bands{};
    for (size_t b = 0; b < bands.size(); ++b) {
      bands[b] = energy(&heard.samples[w * kHop], kCenters[b]);
    }
    double near = -120;  // the loudest within 150 ms
    for (size_t i = w < 15 ? 0 : w - 15; i < std::min(count, w + 16); ++i) {
      near = std::max(near, levels[i]);
    }
    labels[w] = label_of(bands, levels[w], loudest, near);
  }
  // Runs of one label, of at least 40 ms; a shorter one goes with the one before.
  constexpr size_t kShortest = 4;
  struct Run {
    const char* label;
    size_t begin, end;
  };
  std::vector<Run> runs;
  for (size_t w = 0; w < count;) {
    size_t end = w + 1;
    while (end < count && labels[end] == labels[w]) ++end;
    const bool continues = !runs.empty() && runs.back().label == labels[w];
    if (!runs.empty() && (continues || end - w < kShortest)) {
      runs.back().end = end;
    } else {
      runs.push_back({labels[w], w, end});
    }
    w = end;
  }
  // A window shows what is in its middle.
  const auto time = [&](size_t window) {
    return static_cast<double>(window * kHop + (window == 0 ? 0 : (kWindow - kHop) / 2)) /
           kGuessRate;
  };
  for (const Run& run : runs) {
    if (*run.label == 0) continue;
    const double end = std::min(time(run.end), utterance.seconds);
    if (end > time(run.begin)) {
      utterance.phonemes.push_back({run.label, time(run.begin), end, Stress::kUnknown, 0});
    }
  }
  return utterance;
}

}  // namespace mien::speech
