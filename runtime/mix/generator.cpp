// SPDX-License-Identifier: MIT
#include "runtime/mix/generator.h"

#include "runtime/mix/fade.h"

namespace mien {
namespace {

constexpr int64_t kMillisecond = kTicksPerSecond / 1000;
constexpr int64_t kBlinkClose = 75 * kMillisecond, kBlinkHold = 25 * kMillisecond;
constexpr int64_t kBlinkOpen = 150 * kMillisecond, kBlinkOnset = 10 * kMillisecond;
constexpr int64_t kBlinkGap = kTicksPerSecond / 2;

/// 0 ... 1 (SplitMix64)
float random_at(uint64_t seed, uint64_t stream, uint64_t index) {
  uint64_t z = seed + stream * 0x9E3779B97F4A7C15u + index * 0xD1B54A32D192ED03u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<float>((z ^ (z >> 31)) >> 40) * (1.0f / 16777216.0f);
}

float smooth(float u) { return u * u * u * (10.0f + u * (6.0f * u - 15.0f)); }

float smooth_at(int64_t ticks, int64_t of) {
  return ticks <= 0 ? 0.0f : ticks >= of ? 1.0f : smooth(fraction_of(ticks, of));
}

int64_t interval(const MixLayer& layer, uint64_t seed, uint32_t stream, uint32_t index) {
  const int64_t range = layer.period > kBlinkGap ? 2 * (layer.period - kBlinkGap) : 0;
  return kBlinkGap + static_cast<int64_t>(static_cast<double>(range) *
                                          static_cast<double>(random_at(seed, stream, index)));
}

void blink(const MixLayer& layer, uint64_t seed, uint32_t stream, int64_t now, const float* row,
           GeneratorState& state, float* out) {
  if (state.next == 0) state.next = interval(layer, seed, stream, 0);
  constexpr int64_t kWhole = kBlinkClose + kBlinkHold + kBlinkOpen + kBlinkOnset;
  if (now < state.next && row[layer.lanes[0]] > kBlinkSeen) {
    state.next = now + interval(layer, seed, stream, ++state.index);
  }
  while (now >= state.next + kWhole) {
    state.next += interval(layer, seed, stream, ++state.index);
  }
  for (size_t i = 0; i < layer.lanes.count; ++i) {
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

void generate(const MixLayer& layer, uint64_t seed, uint32_t stream, int64_t now, const float* row,
              GeneratorState& state, float* out) {
  if (layer.lanes.empty()) return;
  switch (layer.generator) {
    case Generator::kBlink: blink(layer, seed, stream, now, row, state, out); break;
    case Generator::kBreath: {
      const int64_t in = layer.period * 2 / 5, t = now % layer.period;
      const float breath = smooth_at(t, in) - smooth_at(t - in, layer.period - in);
      for (size_t i = 0; i < layer.lanes.count; ++i) out[i] = layer.amounts[i] * breath;
      break;
    }
    case Generator::kNoise: {
      const auto cell = static_cast<uint64_t>(now / layer.period);
      const float s = smooth_at(now % layer.period, layer.period);
      for (size_t i = 0; i < layer.lanes.count; ++i) {
        const uint64_t lane = (uint64_t{stream} << 32) + i;
        const float a = random_at(seed, lane, cell), b = random_at(seed, lane, cell + 1);
        out[i] = layer.amounts[i] * (2.0f * (a + s * (b - a)) - 1.0f);
      }
      break;
    }
  }
}

}  // namespace mien
