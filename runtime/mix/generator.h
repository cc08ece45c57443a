// SPDX-License-Identifier: MIT
// Small movements of a face that nothing asks for: blinks, breath, noise. Random numbers are a hash
// of the seed and a counter, so they do not depend on what else happens or on how time is divided.
#pragma once

#include "runtime/mix/mix.h"

namespace mien {

struct GeneratorState {
  int64_t next;    // kBlink: when the current or next blink begins
  uint32_t index;  // of it
  uint32_t zero;
};

/// `out` gets a value for each of the layer's lanes; `row` is what the layers before it have made.
/// `stream` tells generators of a mix apart.
///
/// kBlink: closes in 75 ms, stays 25 ms, opens in 150 ms. The time from one to the next is 0.5 s to
/// 2 * period - 0.5 s; every other lane begins up to 10 ms later. If the first lane of the row is
/// above kBlinkSeen, the performance blinks, and the time begins anew.
/// kBreath: 40 % of the period in, 60 % out.
/// kNoise: smooth between -1 and 1, with a new random number every period, for each lane its own.
/// `shift` is when the eyes last began to turn far (GazeState::large_shift): with it a blink begins, if the
/// last one was long enough ago.
void generate(const MixLayer& layer, uint64_t seed, uint32_t stream, int64_t now, int64_t shift,
              const float* row, GeneratorState& state, float* out);

constexpr float kBlinkSeen = 0.6f;

constexpr int64_t kNoShift = -(int64_t{1} << 60);
constexpr float kLargeShift = 20;    // degrees
constexpr float kPursuitSpeed = 30;  // degrees per second

/// Where the eyes look: on the way from one place to another in a saccade, or at `to`.
struct GazeState {
  int64_t start, duration;  // of the saccade; 0: it rests or pursues
  int64_t large_shift;      // when the last one beyond kLargeShift began
  float from[3], to[3];     // as GazeEye::center
  uint32_t begun, zero;
};

/// kGaze: a place that moves by less than kPursuitSpeed is pursued, else a saccade of 21 ms and 2.2 ms per
/// degree goes there; it does not change its goal on the way. `out` gets values for Mix::gaze_lanes,
/// `scratch` has as many lanes as a row.
void generate_gaze(const GazeTable& table, const MixLayer& layer, uint64_t seed, uint32_t stream,
                   int64_t now, int64_t ticks, const float* row, GazeState& state, float* scratch,
                   float* out);

}  // namespace mien
