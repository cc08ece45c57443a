// SPDX-License-Identifier: MIT
// Reactions: responses of a face to a stimulus, as data.
//
// A reaction is a list of strokes. Each moves some curves to a pose and back to 0:
//
//     trigger --delay--> attack (to strength * gain) --> hold --> release (to 0)
//
// A stroke that is held stays as long as the stimulus lasts; others stay for their hold time. Each movement
// starts from the current value and velocity (lags: from the value), so a trigger at any time causes no jump.
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

/// A level that moves to a target like a critically damped spring: without overshoot, and never faster than
/// kLevelRate / e, 5.9 per second, for any sequence of targets in 0 ... 1.
struct Level {
  float target;
  float offset, push;  // at the start: distance from the target, and velocity / kLevelRate
  uint32_t zero;
  int64_t start;
};
constexpr float kLevelRate = 16;  // per second
/// A level that is low for less than this does not end the stimulus: 15 Hz flicker is off for 33 ms.
constexpr int64_t kLevelLinger = kTicksPerSecond / 20;

float level_value(const Level& level, int64_t now);
/// Sets another target, starting from the current value and velocity.
void follow_level(Level& level, int64_t now, float target);

struct ReactionState {
  int64_t triggered;     // when strokes last began
  int64_t stimulus_end;  // kUntilReleased: it lasts until released
  Fade gain;             // adaptation; ticks is its time constant
  Level level;           // for scaled strokes
  float strength;
  uint8_t running;
  uint8_t level_is_on;  // the level keeps up the stimulus
  uint8_t zeros[2];
};

/// exp(-x) for x >= 0, but exactly 0 below 2^-12, so that lags end. Basic operations only, so the bits are
/// the same on every machine.
float decay(float x);

/// Starts a reaction. If it is already running, its Retrigger rule applies.
void trigger_reaction(const Mix& mix, uint32_t reaction, int64_t now, float strength,
                      int64_t hold_ticks, Span<ReactionState> states, Span<StrokeState> strokes);
/// Sets the level. A level of ReactionDesc::level_on or more is a stimulus of strength 1; it ends once the level
/// has been below level_off for kLevelLinger. During the stimulus, scaled strokes follow the level.
void set_reaction_level(const Mix& mix, uint32_t reaction, int64_t now, float level,
                        Span<ReactionState> states, Span<StrokeState> strokes);
/// Ends the stimulus.
void release_reaction(uint32_t reaction, int64_t now, Span<ReactionState> states);

/// Blends the strokes of all running reactions that act before the guards, or of those after them, in the
/// order of the mix.
void mix_reactions(const Mix& mix, int64_t now, bool after_guards, Span<ReactionState> states,
                   Span<StrokeState> strokes, float* row);

/// When a stroke that closes lids (Mix::closes_lids) rises, from `lead` before on. Empty if none does.
TickRange lids_closing(const Mix& mix, int64_t lead, Span<const ReactionState> states,
                       Span<const StrokeState> strokes);

/// The strokes of a reaction to a light in the eyes. Their poses are, from `first_pose` on: lids closed;
/// squint and lowered brows; gaze turned away; narrow pupils; head turned away. The lids close and open once
/// per trigger, at most every 250 ms. The other strokes stay as long as the light; all of them but the
/// pupils adapt to 60 %.
constexpr uint32_t kGlareStrokes = 5;
void glare_strokes(uint32_t first_pose, Stroke (&strokes)[kGlareStrokes]);
ReactionDesc glare_reaction(const Stroke (&strokes)[kGlareStrokes]);

}  // namespace mien
