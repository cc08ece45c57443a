// SPDX-License-Identifier: MIT
// Reactions: what a face does on its own when something happens to it, as data.
//
// A reaction is a few strokes. Each leads some lanes towards a pose and back:
//
//     trigger --delay--> attack (to strength * gain) --> hold --> release (to 0)
//
// A stroke that is held stays as long as the stimulus lasts, another one for its own time. All start
// from the value and the slope that they have, so a trigger at any time leads to no jump.
#pragma once

#include "runtime/mix/fade.h"
#include "runtime/mix/mix.h"

namespace mien {

struct StrokeState {
  Fade envelope;
  int64_t begin;  // of the attack
  uint8_t phase;  // kStrokeRests ...
  uint8_t zeros[7];
};
enum StrokePhase : uint8_t { kStrokeRests, kStrokeWaits, kStrokeRises, kStrokeFalls };

/// A level on its way to a target, as a critically damped spring: without overshoot, and whatever the
/// targets in 0 ... 1 and their times are, never faster than kLevelRate / e, 5.9 per second.
struct Level {
  float target;
  float offset, push;  // at the start: from the target, and velocity / kLevelRate
  uint32_t zero;
  int64_t start;
};
constexpr float kLevelRate = 16;  // per second
/// A level that drops for less is not gone: light that flickers at 15 Hz is off for 33 ms.
constexpr int64_t kLevelLinger = kTicksPerSecond / 20;

float level_value(const Level& level, int64_t now);
/// To another target, from the value and the velocity that it has.
void follow_level(Level& level, int64_t now, float target);

struct ReactionState {
  int64_t triggered;     // when its strokes began the last time
  int64_t stimulus_end;  // kUntilReleased: it lasts
  Fade gain;             // adaptation; ticks is its time constant
  Level level;           // of strokes that are scaled
  float strength;
  uint8_t running;
  uint8_t level_is_on;  // set_reaction_level() keeps the stimulus up
  uint8_t zeros[2];
};

/// exp(-x) for x >= 0, exactly 0 below 2^-12: lags end. From basic operations, the same everywhere.
float decay(float x);

/// Starts a reaction, or does with a running one what its rule says.
void trigger_reaction(const Mix& mix, uint32_t reaction, int64_t now, float strength,
                      int64_t hold_ticks, Span<ReactionState> states, Span<StrokeState> strokes);
/// A stimulus that a level makes: it begins where the level reaches Reaction::level_on, with strength
/// 1, and ends kLevelLinger after it was below level_off the last time. Strokes that are scaled follow
/// the level meanwhile.
void set_reaction_level(const Mix& mix, uint32_t reaction, int64_t now, float level,
                        Span<ReactionState> states, Span<StrokeState> strokes);
/// The stimulus ends.
void release_reaction(uint32_t reaction, int64_t now, Span<ReactionState> states);

/// Blends the strokes of all reactions that come before the guards, or after them.
void mix_reactions(const Mix& mix, int64_t now, bool after_guards, Span<ReactionState> states,
                   Span<StrokeState> strokes, float* row);

/// The strokes of a reaction to a light in the eyes. Their poses are, from `first_pose` on: lids
/// closed; squint and lowered brows; gaze turned away; narrow pupils; head turned away. The lids
/// close and open once per trigger, at most every 250 ms; the others stay while the light does, at
/// 60 % after some seconds.
constexpr uint32_t kGlareStrokes = 5;
void glare_strokes(uint32_t first_pose, Stroke (&strokes)[kGlareStrokes]);
ReactionDesc glare_reaction(const Stroke (&strokes)[kGlareStrokes]);

}  // namespace mien
