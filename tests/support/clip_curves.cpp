// SPDX-License-Identifier: MIT
#include "tests/support/clip_curves.h"

#include <algorithm>
#include <cmath>

#include "author/base/exact_math.h"
#include "author/base/random.h"
#include "runtime/base/half.h"

namespace mien {
namespace {

using author::clamp01;
using author::exact_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

/// Curves in double precision until they are finished.
struct Sums {
  uint32_t channels, frames;
  std::vector<double> values;

  Sums(uint32_t channel_count, uint32_t frame_count)
      : channels(channel_count), frames(frame_count), values(size_t{channels} * frames) {}
  double& at(uint32_t frame, uint32_t channel) {
    return values[size_t{frame} * channels + channel];
  }

  Curves clamped() const {
    Curves curves(channels, frames);
    for (size_t i = 0; i < values.size(); ++i) {
      curves.values[i] = static_cast<float>(clamp01(values[i]));
    }
    return curves;
  }
};

struct PoseValue {
  uint32_t channel;
  double value;
};
using SparsePose = std::vector<PoseValue>;

/// `count` different controls of first ... first + range - 1.
SparsePose random_pose(Random& random, uint32_t count, uint32_t first, uint32_t range) {
  SparsePose pose;
  while (pose.size() < count) {
    const uint32_t channel = first + random.below(range);
    const bool there = std::any_of(
        pose.begin(), pose.end(), [&](const PoseValue& entry) { return entry.channel == channel; });
    if (!there) pose.push_back({channel, random.between(0.15, 1)});
  }
  return pose;
}

/// Values at random times every `period` frames, with a smooth curve through them.
class SmoothNoise {
 public:
  SmoothNoise(Random& random, double period, uint32_t frames) : period_(period) {
    const uint32_t count = static_cast<uint32_t>(frames / period) + 4;
    for (uint32_t i = 0; i < count; ++i) knots_.push_back(random.normal());
  }
  double at(uint32_t frame) const {
    const double place = frame / period_ + 1;
    const size_t i = static_cast<size_t>(place);
    const double t = place - static_cast<double>(i);
    const double a = knots_[i - 1], b = knots_[i], c = knots_[i + 1], d = knots_[i + 2];
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
  }

 private:
  double period_;
  std::vector<double> knots_;
};

/// Adds a pose that comes from frame `begin` on within `attack` frames, stays until `end`, and is
/// gone `release` frames later.
void add_pose(Sums& sums, const SparsePose& pose, double weight, double begin, double attack,
              double end, double release) {
  const uint32_t first = static_cast<uint32_t>(std::max(0.0, std::floor(begin)));
  for (uint32_t f = first; f < sums.frames && f <= end + release; ++f) {
    const double rise = smooth_step(begin, begin + attack, f);
    const double fall = 1 - smooth_step(end, end + release, f);
    for (const PoseValue& entry : pose)
      sums.at(f, entry.channel) += weight * entry.value * rise * fall;
  }
}

void add_speech(Sums& sums, Random& random) {
  std::vector<SparsePose> visemes;
  for (int i = 0; i < 15; ++i) visemes.push_back(random_pose(random, 4 + random.below(5), 0, 90));
  double time = 10;
  while (time < sums.frames) {
    const double sentence_end = time + random.between(60, 240);
    while (time < sentence_end) {
      // Raised cosines that reach from neighbor to neighbor: one viseme blends into the next.
      const double length = random.between(5, 10), center = time + length / 2;
      const double reach = length, weight = random.between(0.5, 1);
      const SparsePose& viseme = visemes[random.below(15)];
      const auto first = static_cast<uint32_t>(std::max(0.0, center - reach));
      for (uint32_t f = first; f < sums.frames && f <= center + reach; ++f) {
        const double off = (f - center) / reach;
        if (off < -1 || off > 1) continue;
        const double bump = 0.5 + 0.5 * exact_cosine(kPi * off);
        for (const PoseValue& entry : viseme)
          sums.at(f, entry.channel) += weight * entry.value * bump;
      }
      time += length;
    }
    time += random.between(30, 150);
  }
}

void add_emotions(Sums& sums, Random& random) {
  double time = 0;
  while (time < sums.frames) {
    const SparsePose emotion = random_pose(random, 8 + random.below(8), 60, kFaceControls - 64);
    const double attack = random.between(20, 60), hold = random.between(60, 240);
    add_pose(sums, emotion, random.between(0.3, 1), time, attack, time + attack + hold, attack);
    time += 2 * attack + hold + random.between(0, 90);
  }
}

void add_blinks(Sums& sums, Random& random) {
  for (double time = 60; time < sums.frames; time += random.between(120, 360)) {
    const SparsePose lids = {{247, 1}, {248, 1}, {249, 0.3}, {250, 0.3}};
    add_pose(sums, lids, 1, time, 4.5, time + 6, 9);
  }
}

}  // namespace

Curves authored_keys(uint64_t seed, uint32_t frames) {
  Random random = Random::from_seed(seed, 1);
  Sums sums(kFaceControls, frames);
  std::vector<SparsePose> poses;
  for (int i = 0; i < 12; ++i) {
    poses.push_back(random_pose(random, 4 + random.below(19), 0, kFaceControls));
  }
  std::vector<double> now(kFaceControls), next(kFaceControls);
  double time = 0;
  while (time < frames) {
    const double length = random.between(8, 24);
    const double hold = random.chance(0.5) ? random.between(6, 60) : 0;
    std::fill(next.begin(), next.end(), 0.0);
    for (const PoseValue& entry : poses[random.below(12)]) next[entry.channel] = entry.value;
    for (uint32_t c = 0; c < kFaceControls; ++c) {
      const double shift = random.between(-4, 4);
      const auto first = static_cast<uint32_t>(std::max(0.0, time - 4));
      const auto end = std::min(static_cast<double>(frames), time + length + hold + 4);
      for (uint32_t f = first; f < end; ++f) {
        sums.at(f, c) = mix(now[c], next[c], smooth_step(time + shift, time + shift + length, f));
      }
    }
    now = next;
    time += length + hold;
  }
  return sums.clamped();
}

Curves clean_solve(uint64_t seed, uint32_t frames) {
  Random random = Random::from_seed(seed, 2);
  Sums sums(kFaceControls, frames);
  add_speech(sums, random);
  add_emotions(sums, random);
  add_blinks(sums, random);
  return sums.clamped();
}

Curves noisy_solve(uint64_t seed, uint32_t frames) {
  Random random = Random::from_seed(seed, 3);
  Sums sums(kFaceControls, frames);
  add_speech(sums, random);
  add_emotions(sums, random);
  add_blinks(sums, random);
  // Where a control acts, or nearly does, the solver finds it with an error.
  for (uint32_t c = 0; c < kFaceControls; ++c) {
    const SmoothNoise leak(random, 20, frames);
    for (uint32_t f = 0; f < frames; ++f) {
      double& value = sums.at(f, c);
      value += 0.02 * (leak.at(f) - 1.2);
      if (value > -0.01) value += kSensorNoise * random.normal();
    }
  }
  return sums.clamped();
}

Curves dense_noise(uint64_t seed, uint32_t frames) {
  Random random = Random::from_seed(seed, 4);
  Sums sums(kFaceControls, frames);
  for (uint32_t c = 0; c < 101; ++c) {
    const SmoothNoise motion(random, 30, frames);
    const double center = random.between(0.2, 0.8);
    for (uint32_t f = 0; f < frames; ++f) {
      sums.at(f, c) = center + 0.05 * motion.at(f) + kSensorNoise * random.normal();
    }
  }
  return sums.clamped();
}

Curves phone_capture(uint64_t seed, uint32_t frames) {
  Random random = Random::from_seed(seed, 5);
  Curves curves(kCaptureChannels, frames);
  for (uint32_t c = 0; c < kCaptureChannels; ++c) {
    const bool angle = c >= 52;
    const SmoothNoise motion(random, random.between(12, 40), frames);
    const double amplitude = 0.02 + 0.3 * random.real() * random.real(),
                 offset = random.between(-1, 0.6);
    for (uint32_t f = 0; f < frames; ++f) {
      const double m = motion.at(f), error = random.normal();
      if (angle) {
        curves.at(f, c) = static_cast<float>(0.2 * m + 0.0005 * error);
      } else if (m + offset > 0) {
        const double value = amplitude * (m + offset) * (m + offset);
        curves.at(f, c) = static_cast<float>(clamp01(value * (1 + 0.005 * error)));
      }
    }
  }
  return curves;
}

Curves rounded_to(Curves curves, double scale) {
  for (float& value : curves.values) {
    value = static_cast<float>(std::floor(static_cast<double>(value) * scale + 0.5) / scale);
  }
  return curves;
}

Curves rounded_to_half(Curves curves) {
  for (float& value : curves.values) value = float_from_half(half_from_float(value));
  return curves;
}

}  // namespace mien
