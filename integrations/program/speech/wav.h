// SPDX-License-Identifier: MIT
// WAV files: sound in and out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mien::speech {

/// One channel.
struct Sound16 {
  uint32_t rate = 0;  // samples per second
  std::vector<int16_t> samples;
  double seconds() const { return static_cast<double>(samples.size()) / rate; }
};

/// RIFF with PCM of 8, 16, 24 or 32 bits or floats of 32 or 64 bits; channels are averaged. A header that
/// promises more samples than the file has counts for those that are there. Fails with exit code 2.
Sound16 parse_wav(const std::string& bytes, const std::string& shown);

/// A WAV file with PCM of 16 bits.
std::string wav_bytes(const Sound16& sound);

/// At another rate, by a windowed sinc that leaves out what the lower rate cannot hold.
Sound16 resample(const Sound16& sound, uint32_t rate);

/// Root of the mean square of samples between two times, in decibels below full scale; at least -120.
double loudness(const Sound16& sound, double begin, double end);

}  // namespace mien::speech
