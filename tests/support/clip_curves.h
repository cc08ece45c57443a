// SPDX-License-Identifier: MIT
// Generated control curves that look like the material clips are made of. The size gates of the
// clip format are measured on them, so what each of them contains is stated here and does not
// change: the same numbers on every platform.
//
// What real material is like, as far as it decides about size: a face of 251 raw controls has 16 to
// 18 of them away from zero in half of the frames and at most 62; captured coefficients are zero in
// about half of their samples and noise in the rest; noise leaves about 20 bits of a float random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

namespace mien {

constexpr uint32_t kFaceControls = 251;
constexpr uint32_t kCaptureChannels = 61;  // 52 coefficients, 9 angles of head and eyes
constexpr double kSensorNoise = 0.001;     // standard deviation

struct Curves {
  uint32_t channels = 0, frames = 0;
  std::vector<float> values;  // [frame][channel]

  Curves(uint32_t channel_count, uint32_t frame_count)
      : channels(channel_count), frames(frame_count), values(size_t{channels} * frames) {}
  float& at(uint32_t frame, uint32_t channel) { return values[size_t{frame} * channels + channel]; }
  float at(uint32_t frame, uint32_t channel) const {
    return values[size_t{frame} * channels + channel];
  }
  size_t raw_bytes() const { return values.size() * sizeof(float); }
};

inline Curves one_channel(std::initializer_list<float> values) {
  Curves curves(1, static_cast<uint32_t>(values.size()));
  curves.values = values;
  return curves;
}

/// Poses of 4 to 22 controls, eased into one another over 8 to 24 frames, half of them held for up
/// to a second; controls leave up to 4 frames earlier or later than their pose. 60 per second.
Curves authored_keys(uint64_t seed, uint32_t frames);

/// Speech (8 visemes a second, overlapping, with pauses), an emotion of 8 to 15 controls that
/// comes and goes every few seconds, and a blink every four. Smooth, zero where nothing acts.
Curves clean_solve(uint64_t seed, uint32_t frames);

/// What a solver with a constraint at zero makes of a noisy face: some 20 % of all samples are not
/// zero; controls near zero flicker.
Curves noisy_solve(uint64_t seed, uint32_t frames);

/// 101 of 251 controls move and are noisy all the time; the others stay at zero.
Curves dense_noise(uint64_t seed, uint32_t frames);

/// A take of a phone: coefficients between 0 and 1, small more often than large, zero half of the
/// time and else with an error of half a percent; angles in radians that are never at rest.
/// kCaptureChannels channels. The errors are such that the coder for which the sizes of ten real takes
/// are known (runs of 16, widths of 6 bits, masks of 64) makes the same of ten of these: 2.45 times
/// smaller where it was 2.46, 10.9 where it was 11.0 rounded to 1/2048.
Curves phone_capture(uint64_t seed, uint32_t frames);

/// Rounded to a multiple of 1 / `scale`, as from a file of decimals or a sensor of few bits.
Curves rounded_to(Curves curves, double scale);
/// Rounded to half precision.
Curves rounded_to_half(Curves curves);

}  // namespace mien
