// SPDX-License-Identifier: MIT
// Small spontaneous movements of a face: blinks, breath, noise; and the gaze. Random numbers are a hash
// of the seed and a counter, so they do not depend on other events or on how time is divided into steps.
#pragma once

#include "runtime/mix/fade.h"
#include "runtime/mix/mix.h"

namespace mien {

struct GeneratorState {
  int64_t next;    // kBlink: when the current or next blink begins
  uint32_t index;  // of this blink
  uint32_t zero;
};

/// `out` gets a value for each of the layer's curves; `row` is the result of the layers before it.
/// `stream` gives each generator of a mix its own random numbers.
///
/// kBlink: closes in 75 ms, stays closed for 25 ms, opens in 150 ms. The time from one blink to the next
/// is 0.5 s to 2 * period - 0.5 s; every other curve begins up to 10 ms later. If the first curve of the
/// row is above kBlinkSeen, the performance blinks, and the wait for the next blink starts over.
/// kBreath: 40 % of the period in, 60 % out.
/// kNoise: smooth between -1 and 1; each curve has a new random number every period.
/// `shift` is when the eyes last began a large turn (GazeState::large_shift). A blink begins with it if
/// the last one began 0.5 s before or earlier.
/// `held`: a blink does not open in this part of the last step, because a reaction is closing the lids.
void generate(const LayerDesc& layer, uint64_t seed, uint32_t stream, int64_t now, int64_t shift,
              TickRange held, const float* row, GeneratorState& state, float* out);

constexpr int64_t kBlinkOpen = kTicksPerSecond * 150 / 1000;

constexpr float kBlinkSeen = 0.6f;

constexpr int64_t kNoShift = -(int64_t{1} << 60);
constexpr float kLargeShift = 20;    // degrees
constexpr float kPursuitSpeed = 30;  // degrees per second

/// Where the eyes look: during a saccade on the way from one place to another, otherwise at `to`.
struct GazeState {
  int64_t start, duration;  // of the saccade; duration 0: the eyes rest or pursue
  int64_t large_shift;      // when the last saccade of kLargeShift or more began
  float from[3], to[3];     // as GazeEye::center
  uint32_t begun, zero;
};

/// kGaze: the eyes pursue a target that moves by less than kPursuitSpeed. Otherwise they make a saccade to
/// it, which takes 21 ms plus 2.2 ms per degree and does not change its goal on the way. `out` gets values
/// for Mix::gaze_curves; `scratch` has as many curves as a row.
void generate_gaze(const GazeTable& table, const LayerDesc& layer, uint64_t seed, uint32_t stream,
                   int64_t now, int64_t ticks, const float* row, GazeState& state, float* scratch,
                   float* out);

}  // namespace mien
