// SPDX-License-Identifier: MIT
#include "integrations/program/speech/wav.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/text.h"

namespace mien::speech {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr uint32_t kLeastRate = 4000, kMostRate = 192000, kMostChannels = 64;
// Kinds of samples in a format chunk.
constexpr uint32_t kPcm = 1, kFloat = 3, kExtensible = 0xFFFE;

class Chunks {
 public:
  Chunks(const std::string& bytes, const std::string& shown) : bytes_(bytes), shown_(shown) {}

  [[noreturn]] void wrong(size_t at, const std::string& why) const {
    cli::fail(cli::kInvalid, "cannot read sound", shown_ + ", byte " + std::to_string(at), why,
              "give a WAV file of PCM samples");
  }
  /// `count` bytes, little-endian, which are there.
  uint64_t number(size_t at, size_t count) const {
    uint64_t value = 0;
    for (size_t i = 0; i < count; ++i) {
      value |= uint64_t{static_cast<unsigned char>(bytes_[at + i])} << (8 * i);
    }
    return value;
  }
  bool is(size_t at, const char* name) const { return bytes_.compare(at, 4, name) == 0; }
  size_t size() const { return bytes_.size(); }

 private:
  const std::string& bytes_;
  const std::string& shown_;
};

struct Format {
  uint32_t kind = 0, channels = 0, rate = 0, bits = 0;
};

Format parse_format(const Chunks& chunks, size_t at, size_t size) {
  if (size < 16) chunks.wrong(at, "the format is shorter than 16 bytes");
  Format format;
  format.kind = static_cast<uint32_t>(chunks.number(at, 2));
  format.channels = static_cast<uint32_t>(chunks.number(at + 2, 2));
  format.rate = static_cast<uint32_t>(chunks.number(at + 4, 4));
  format.bits = static_cast<uint32_t>(chunks.number(at + 14, 2));
  if (format.kind == kExtensible) {
    if (size < 40) chunks.wrong(at, "the extended format is shorter than 40 bytes");
    format.kind = static_cast<uint32_t>(chunks.number(at + 24, 2));
  }
  const uint32_t bits = format.bits;
  const bool known =
      (format.kind == kPcm && (bits == 8 || bits == 16 || bits == 24 || bits == 32)) ||
      (format.kind == kFloat && (bits == 32 || bits == 64));
  if (!known) {
    chunks.wrong(at, "samples are of kind " + std::to_string(format.kind) + " with " +
                         std::to_string(bits) + " bits");
  }
  if (format.channels == 0 || format.channels > kMostChannels) {
    chunks.wrong(at + 2, "there are " + std::to_string(format.channels) + " channels");
  }
  if (format.rate < kLeastRate || format.rate > kMostRate) {
    chunks.wrong(at + 4, "there are " + std::to_string(format.rate) + " samples per second");
  }
  return format;
}

/// -1 to 1; what is no number is silent.
double sample_at(const Chunks& chunks, size_t at, const Format& format) {
  const uint64_t bits = chunks.number(at, format.bits / 8);
  if (format.kind == kFloat) {
    double value = 0;
    if (format.bits == 32) {
      const auto word = static_cast<uint32_t>(bits);
      float single = 0;
      std::memcpy(&single, &word, sizeof single);
      value = static_cast<double>(single);
    } else {
      std::memcpy(&value, &bits, sizeof value);
    }
    return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0;
  }
  if (format.bits == 8) return (static_cast<double>(bits) - 128) / 128;  // without a sign
  const uint64_t sign = uint64_t{1} << (format.bits - 1);
  return static_cast<double>(static_cast<int64_t>(bits ^ sign) - static_cast<int64_t>(sign)) /
         static_cast<double>(sign);
}

}  // namespace

Sound16 parse_wav(const std::string& bytes, const std::string& shown) {
  const Chunks chunks(bytes, shown);
  if (bytes.size() < 12 || !chunks.is(0, "RIFF") || !chunks.is(8, "WAVE")) {
    chunks.wrong(0, "it does not begin as a WAV file");
  }
  Format format;
  for (size_t at = 12; at + 8 <= bytes.size();) {
    const uint64_t promised = chunks.number(at + 4, 4);
    const size_t body = at + 8;
    const size_t size = static_cast<size_t>(std::min<uint64_t>(promised, bytes.size() - body));
    if (chunks.is(at, "fmt ")) format = parse_format(chunks, body, size);
    if (chunks.is(at, "data")) {
      if (format.channels == 0) chunks.wrong(at, "samples come before their format");
      const size_t width = format.bits / 8, frame = width * format.channels;
      Sound16 sound;
      sound.rate = format.rate;
      sound.samples.reserve(size / frame);
      for (size_t i = body; i + frame <= body + size; i += frame) {
        double sum = 0;
        for (uint32_t c = 0; c < format.channels; ++c) {
          sum += sample_at(chunks, i + c * width, format);
        }
        sound.samples.push_back(static_cast<int16_t>(
            std::lround(std::clamp(sum / format.channels, -1.0, 1.0) * 32767)));
      }
      if (sound.samples.empty()) chunks.wrong(at, "there are no samples");
      return sound;
    }
    at = body + size + (size & 1);
  }
  chunks.wrong(bytes.size(), "the file ends before its samples");
}

std::string wav_bytes(const Sound16& sound) {
  const auto data = static_cast<uint32_t>(2 * sound.samples.size());
  std::string bytes;
  const auto number = [&](uint64_t value, size_t count) {
    for (size_t i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
  };
  bytes += "RIFF";
  number(36 + data, 4);
  bytes += "WAVEfmt ";
  number(16, 4);
  number(kPcm, 2);
  number(1, 2);
  number(sound.rate, 4);
  number(2 * sound.rate, 4);
  number(2, 2);
  number(16, 2);
  bytes += "data";
  number(data, 4);
  for (const int16_t sample : sound.samples) number(static_cast<uint16_t>(sample), 2);
  return bytes;
}

Sound16 resample(const Sound16& sound, uint32_t rate) {
  if (rate == sound.rate) return sound;
  constexpr double kZeros = 12;  // of the sinc, on each side
  const double step = static_cast<double>(sound.rate) / rate;
  const double width = kZeros * std::max(step, 1.0), cut = std::min(1.0, 1 / step);
  Sound16 out;
  out.rate = rate;
  const auto count = static_cast<size_t>(static_cast<double>(sound.samples.size()) / step);
  const auto last = static_cast<double>(sound.samples.size()) - 1;
  for (size_t i = 0; i < count; ++i) {
    const double center = static_cast<double>(i) * step;
    double sum = 0;
    for (double k = std::max(0.0, std::ceil(center - width)); k <= std::min(last, center + width);
         ++k) {
      const double x = k - center, phase = kPi * x * cut;
      const double sinc = std::abs(phase) < 1e-9 ? 1 : std::sin(phase) / phase;
      const double window = 0.5 + 0.5 * std::cos(kPi * x / width);
      sum += cut * sinc * window * sound.samples[static_cast<size_t>(k)];
    }
    out.samples.push_back(static_cast<int16_t>(std::lround(std::clamp(sum, -32768.0, 32767.0))));
  }
  return out;
}

double loudness(const Sound16& sound, double begin, double end) {
  const auto index = [&](double time) {
    return static_cast<size_t>(
        std::clamp(time * sound.rate, 0.0, static_cast<double>(sound.samples.size())));
  };
  double sum = 0;
  const size_t first = index(begin), last = std::max(index(end), first);
  for (size_t i = first; i < last; ++i) sum += std::pow(sound.samples[i] / 32768.0, 2);
  if (last == first) return -120;
  return std::max(-120.0, 10 * std::log10(sum / static_cast<double>(last - first) + 1e-12));
}

}  // namespace mien::speech
