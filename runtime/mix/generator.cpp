// SPDX-License-Identifier: MIT
#include "runtime/mix/generator.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/vector.h"
#include "runtime/mix/fade.h"

namespace mien {
namespace {

constexpr int64_t kMillisecond = kTicksPerSecond / 1000;
constexpr int64_t kBlinkClose = 75 * kMillisecond, kBlinkHold = 25 * kMillisecond;
constexpr int64_t kBlinkOnset = 10 * kMillisecond;
constexpr int64_t kBlinkGap = kTicksPerSecond / 2;

/// 0 ... 1 (SplitMix64)
float random_at(uint64_t seed, uint64_t stream, uint64_t index) {
  uint64_t z = seed + stream * 0x9E3779B97F4A7C15u + index * 0xD1B54A32D192ED03u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<float>((z ^ (z >> 31)) >> 40) * (1.0f / 16777216.0f);
}

/// Noise from -1 to 1 at the fraction `u` of the way from a cell to the next.
float noise_at(uint64_t seed, uint64_t stream, uint64_t cell, float u) {
  const float a = random_at(seed, stream, cell), b = random_at(seed, stream, cell + 1);
  return 2.0f * (a + u * (b - a)) - 1.0f;
}

float smooth(float u) { return u * u * u * (10.0f + u * (6.0f * u - 15.0f)); }

float smooth_at(int64_t ticks, int64_t of) {
  return ticks <= 0 ? 0.0f : ticks >= of ? 1.0f : smooth(fraction_of(ticks, of));
}

int64_t interval(const LayerDesc& layer, uint64_t seed, uint32_t stream, uint32_t index) {
  const int64_t range = layer.period > kBlinkGap ? 2 * (layer.period - kBlinkGap) : 0;
  return kBlinkGap + static_cast<int64_t>(static_cast<double>(range) *
                                          static_cast<double>(random_at(seed, stream, index)));
}

void blink(const LayerDesc& layer, uint64_t seed, uint32_t stream, int64_t now, int64_t shift,
           TickRange held, const float* row, GeneratorState& state, float* out) {
  if (state.next == 0) state.next = interval(layer, seed, stream, 0);
  if (now < state.next && shift != kNoShift && shift < state.next) {
    const int64_t last = state.next - interval(layer, seed, stream, state.index);
    if (shift >= last + kBlinkGap) state.next = shift;
  }
  constexpr int64_t kWhole = kBlinkClose + kBlinkHold + kBlinkOpen + kBlinkOnset;
  if (now < state.next && row[layer.curves[0]] > kBlinkSeen) {
    state.next = now + interval(layer, seed, stream, ++state.index);
  }
  // A blink that is held continues until it would open, and waits there.
  const int64_t opens = state.next + kBlinkClose + kBlinkHold;
  state.next += std::max(held.end - std::max(held.begin, opens), int64_t{0});
  while (now >= state.next + kWhole) {
    state.next += interval(layer, seed, stream, ++state.index);
  }
  for (size_t i = 0; i < layer.curves.count; ++i) {
    const double late =
        i % 2 == 0 ? 0.0
                   : static_cast<double>(random_at(seed, uint64_t{stream} + 0x100, state.index));
    const int64_t t =
        now - state.next - static_cast<int64_t>(late * static_cast<double>(kBlinkOnset));
    const float closed = smooth_at(t, kBlinkClose);
    const float opened = smooth_at(t - kBlinkClose - kBlinkHold, kBlinkOpen);
    out[i] = layer.amounts[i] * (closed - opened);
  }
}

}  // namespace

void generate(const LayerDesc& layer, uint64_t seed, uint32_t stream, int64_t now, int64_t shift,
              TickRange held, const float* row, GeneratorState& state, float* out) {
  if (layer.curves.empty()) return;
  switch (layer.generator) {
    case Generator::kGaze: break;  // generate_gaze()
    case Generator::kBlink: blink(layer, seed, stream, now, shift, held, row, state, out); break;
    case Generator::kBreath: {
      const int64_t in = layer.period * 2 / 5, t = now % layer.period;
      const float breath = smooth_at(t, in) - smooth_at(t - in, layer.period - in);
      for (size_t i = 0; i < layer.curves.count; ++i) out[i] = layer.amounts[i] * breath;
      break;
    }
    case Generator::kNoise: {
      const auto cell = static_cast<uint64_t>(now / layer.period);
      const float s = smooth_at(now % layer.period, layer.period);
      for (size_t i = 0; i < layer.curves.count; ++i) {
        out[i] = layer.amounts[i] * noise_at(seed, (uint64_t{stream} << 32) + i, cell, s);
      }
      break;
    }
  }
}

// Gaze
// ------------------------------------------------------------------------------------------------

namespace {

Vec3 vector(const float* v) { return {v[0], v[1], v[2]}; }

/// Degrees between two places as seen from the eyes. Uses the chord instead of an arc cosine: 1 % less at 60.
float angle_between(const GazeTable& table, const float* a, const float* b) {
  const Vec3 middle = (vector(table.eyes[0].center) + vector(table.eyes[1].center)) * 0.5;
  const auto direction = [&](const float* place) {
    const Vec3 way = vector(place) - middle;
    return is_zero(way) ? way : unit(way);
  };
  const Vec3 between = direction(a) - direction(b);
  const double square = dot(between, between), chord = std::sqrt(square);
  return static_cast<float>(57.29577951308232 * chord * (1 + square / 24));
}

void start_saccade(const GazeTable& table, const float* target, int64_t now, GazeState& state) {
  const float degrees = angle_between(table, state.to, target);
  state.start = now;
  state.duration = 21 * kMillisecond + static_cast<int64_t>(2.2 * double{degrees} * kMillisecond);
  if (degrees >= kLargeShift) state.large_shift = now;
  for (int k = 0; k < 3; ++k) {
    state.from[k] = state.to[k];
    state.to[k] = target[k];
  }
}

}  // namespace

void generate_gaze(const GazeTable& table, const LayerDesc& layer, uint64_t seed, uint32_t stream,
                   int64_t now, int64_t ticks, const float* row, GazeState& state, float* scratch,
                   float* out) {
  float target[3];
  for (int k = 0; k < 3; ++k) {  // other layers may have written any value
    const float value = row[layer.curves[static_cast<size_t>(k)]];
    target[k] = value > -1e6f && value < 1e6f ? value : 0.0f;
  }
  if (!state.begun) {
    for (int k = 0; k < 3; ++k) state.from[k] = state.to[k] = target[k];
    state.begun = 1;
  }
  if (state.duration != 0 && now >= state.start + state.duration) state.duration = 0;
  if (state.duration == 0) {
    const double seconds = static_cast<double>(ticks) / kTicksPerSecond;
    const float degrees = angle_between(table, state.to, target);
    if (double{degrees} > kPursuitSpeed * seconds) {
      start_saccade(table, target, now, state);
    } else {
      for (int k = 0; k < 3; ++k) state.to[k] = target[k];
    }
  }
  const float s = state.duration != 0 ? smooth_at(now - state.start, state.duration) : 1.0f;
  float place[3];
  for (int k = 0; k < 3; ++k) place[k] = state.from[k] + s * (state.to[k] - state.from[k]);
  if (s == 1.0f) {
    for (int k = 0; k < 3; ++k) place[k] = state.to[k];
  }
  // Jitter of some degrees at the distance to the front.
  const auto cell = static_cast<uint64_t>(now / layer.period);
  const float u = smooth_at(now % layer.period, layer.period);
  for (uint32_t k = 0; k < 2; ++k) {
    const float noise = noise_at(seed, (uint64_t{stream} << 32) + k, cell, u);
    const float distance = place[2] - table.eyes[0].center[2];
    place[k] += layer.amounts[k] * 0.017453292f * noise * (distance > 1.0f ? distance : 1.0f);
  }
  float beyond[2];
  look_at(table, place, scratch, beyond);
  for (uint32_t i = 0; i < 8; ++i) out[i] = scratch[table.eyes[i / 4].curves[i % 4]];
  for (size_t i = 3; i < layer.curves.count; ++i) out[5 + i] = layer.amounts[i] * beyond[i - 3];
}

}  // namespace mien
