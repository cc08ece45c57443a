// SPDX-License-Identifier: MIT
#include "runtime/mix/reaction.h"

#include <algorithm>

#include "runtime/mix/mix_rows.h"

namespace mien {
namespace {

constexpr int64_t kLagEnd = 9;  // time constants; decay() is 0 from 8.3 on

/// As quintic_from() does it.
float finite_or_zero(float offset) { return offset < 1e30f && offset > -1e30f ? offset : 0.0f; }

/// The share of its offset that a lag, a Fade whose ticks are a time constant, has left; 0: it has ended.
float lag_left(const Fade& lag, int64_t now) {
  if (lag.ticks <= 0) return 0.0f;
  return now > lag.start ? decay(fraction_of(now - lag.start, lag.ticks)) : 1.0f;
}

float lag_value(const Fade& lag, int64_t now) {
  return lag.offset.c0 == 0.0f ? lag.target : lag.target + lag.offset.c0 * lag_left(lag, now);
}

void start_lag(Fade& lag, int64_t now, float target, int64_t time_constant) {
  const float value = lag_value(lag, now);
  lag.target = target;
  lag.offset = {finite_or_zero(value - target), 0.0f, 0.0f, 1.0f};
  lag.start = now;
  lag.ticks = time_constant;
}

void lead(const Stroke& stroke, StrokeState& state, int64_t now, float target, int64_t ticks) {
  if (stroke.is_lag) {
    start_lag(state.envelope, now, target, ticks);
  } else {
    start_fade(state.envelope, now, target, ticks);
  }
}

/// Goes through the phases that have begun, each at its own time and not at that of the step.
void advance_stroke(const Stroke& stroke, const ReactionState& reaction, int64_t now,
                    StrokeState& state) {
  if (state.phase == kStrokeWaits && now >= state.begin) {
    lead(stroke, state, state.begin, reaction.strength, stroke.attack);
    state.phase = kStrokeRises;
  }
  if (state.phase == kStrokeRises) {
    const int64_t risen = state.begin + stroke.attack;
    int64_t end = risen + stroke.hold;
    if (stroke.is_held) end = reaction.stimulus_end > risen ? reaction.stimulus_end : risen;
    if (now >= end) {
      lead(stroke, state, end, 0.0f, stroke.release);
      state.phase = kStrokeFalls;
    }
  }
  if (state.phase != kStrokeFalls) return;
  const bool ended = stroke.is_lag ? lag_left(state.envelope, now) == 0.0f
                                   : now - state.envelope.start >= state.envelope.ticks;
  if (!ended) return;
  set_fade(state.envelope, 0.0f);
  state.phase = kStrokeRests;
}

struct LevelAt {
  float value, push;
};

LevelAt level_at(const Level& level, int64_t now) {
  if (level.offset == 0.0f && level.push == 0.0f) return {level.target, 0.0f};
  const float u =
      kLevelRate * fraction_of(now > level.start ? now - level.start : 0, kTicksPerSecond);
  const float half = decay(0.5f * u), left = half * half;  // so that it ends far below 2^-12
  if (left == 0.0f) return {level.target, 0.0f};
  const float both = level.offset + level.push;
  return {level.target + (level.offset + both * u) * left, (level.push - both * u) * left};
}

Span<StrokeState> strokes_of(const Mix& mix, uint32_t index, Span<StrokeState> strokes) {
  return strokes.slice(mix.first_strokes[index], mix.reactions[index].strokes.count);
}

/// At once if nothing shows that it is scaled. `strokes` are those of the reaction.
void aim_level(const ReactionDesc& reaction, int64_t now, float target, ReactionState& state,
               Span<const StrokeState> strokes) {
  if (state.level.target == target) return;
  bool shows = false;
  for (size_t s = 0; s < strokes.count; ++s) {
    shows = shows || (reaction.strokes[s].is_scaled && strokes[s].phase != kStrokeRests);
  }
  if (!shows) state.level = {target, 0.0f, 0.0f, 0, now};
  follow_level(state.level, now, target);
}

void blend_pose(const Mix& mix, const Stroke& stroke, float weight, float* row) {
  const PoseDesc& pose = mix.poses[stroke.pose];
  blend_curves(stroke.mode, pose.curves, pose.values.data, nullptr, weight, row);
}

}  // namespace

float decay(float x) {
  if (!(x < 8.3178f)) return 0.0f;  // 12 ln 2
  // exp(-x) = 2^-n * exp(-r), 0 <= r < ln 2
  const float scaled = x * 1.44269504f;
  const auto n = static_cast<int>(scaled);
  const float r = x - static_cast<float>(n) * 0.693147181f;
  float power = 1.0f;
  for (int i = 0; i < n; ++i) power *= 0.5f;
  // exp(-r) by its series, without divisions: they would wait for each other.
  constexpr float kSeries[] = {-1.0f / 362880, 1.0f / 40320, -1.0f / 5040, 1.0f / 720, -1.0f / 120,
                               1.0f / 24,      -1.0f / 6,    0.5f,         -1.0f,      1.0f};
  float sum = 0.0f;
  for (float term : kSeries) sum = sum * r + term;
  return power * sum;
}

float level_value(const Level& level, int64_t now) { return level_at(level, now).value; }

void follow_level(Level& level, int64_t now, float target) {
  const LevelAt at = level_at(level, now);
  level = {target, finite_or_zero(at.value - target), finite_or_zero(at.push), 0, now};
}

void trigger_reaction(const Mix& mix, uint32_t index, int64_t now, float strength,
                      int64_t hold_ticks, Span<ReactionState> states, Span<StrokeState> all) {
  const ReactionDesc& reaction = mix.reactions[index];
  const Span<StrokeState> strokes = strokes_of(mix, index, all);
  ReactionState& state = states[index];
  const bool running = state.running != 0;
  const bool cooled = !running || now - state.triggered >= reaction.cooldown;
  if (running && reaction.retrigger == Retrigger::kIgnore) return;
  // A trigger without a level means the full level.
  if (!state.level_is_on) aim_level(reaction, now, 1.0f, state, strokes);
  const int64_t end = hold_ticks == kUntilReleased ? kUntilReleased : now + hold_ticks;
  const bool lasted = running && state.stimulus_end >= now;
  state.stimulus_end = !lasted || end > state.stimulus_end ? end : state.stimulus_end;
  const float stronger = lasted && state.strength > strength ? state.strength : strength;
  const bool grows = stronger > state.strength;
  state.strength = stronger;
  state.running = 1;
  if (!lasted) start_lag(state.gain, now, reaction.adapted, reaction.adapt_ticks);
  const bool restarts = reaction.retrigger == Retrigger::kRestart && cooled;
  bool began = false;
  for (size_t s = 0; s < strokes.count; ++s) {
    const Stroke& stroke = reaction.strokes[s];
    StrokeState& now_at = strokes[s];
    advance_stroke(stroke, state, now, now_at);
    if (now_at.phase == kStrokeWaits) continue;
    const bool resting = now_at.phase == kStrokeRests || now_at.phase == kStrokeFalls;
    if (restarts || (resting && (stroke.is_held || cooled))) {
      now_at.begin = now + stroke.delay;
      now_at.phase = kStrokeWaits;
      began = began || !stroke.is_held;
    } else if (grows && now_at.phase == kStrokeRises) {
      lead(stroke, now_at, now, stronger, stroke.attack);
    }
  }
  if (began || !running) state.triggered = now;
}

void set_reaction_level(const Mix& mix, uint32_t index, int64_t now, float level,
                        Span<ReactionState> states, Span<StrokeState> strokes) {
  const ReactionDesc& reaction = mix.reactions[index];
  ReactionState& state = states[index];
  const bool lasts = state.running && state.stimulus_end > now;
  if (state.level_is_on && level < reaction.level_off) {
    // Strokes that are scaled stay at the level they had: their release leads to 0.
    state.level_is_on = 0;
    if (lasts && state.stimulus_end > now + kLevelLinger) state.stimulus_end = now + kLevelLinger;
    return;
  }
  if (!state.level_is_on && level < reaction.level_on) return;
  aim_level(reaction, now, level, state, strokes_of(mix, index, strokes));
  if (state.level_is_on) return;
  if (lasts) {
    state.level_is_on = 1;
    state.stimulus_end = kUntilReleased;
  } else if (!state.running || reaction.retrigger != Retrigger::kIgnore) {
    state.level_is_on = 1;
    trigger_reaction(mix, index, now, 1.0f, kUntilReleased, states, strokes);
  }
}

void release_reaction(uint32_t index, int64_t now, Span<ReactionState> states) {
  ReactionState& state = states[index];
  state.level_is_on = 0;
  if (state.running && state.stimulus_end > now) state.stimulus_end = now;
}

void mix_reactions(const Mix& mix, int64_t now, bool after_guards, Span<ReactionState> states,
                   Span<StrokeState> all, float* row) {
  for (uint32_t r = 0; r < mix.reactions.count; ++r) {
    const ReactionDesc& reaction = mix.reactions[r];
    ReactionState& state = states[r];
    if (!state.running || reaction.after_guards != after_guards) continue;
    if (now >= state.stimulus_end && state.gain.target != 1.0f) {
      start_lag(state.gain, state.stimulus_end, 1.0f, reaction.recover_ticks);
    }
    const float left = lag_left(state.gain, now);
    const float gain = state.gain.target + state.gain.offset.c0 * left;
    const float level = level_value(state.level, now);
    const Span<StrokeState> strokes = strokes_of(mix, r, all);
    bool running = state.gain.target != 1.0f || left != 0.0f;
    for (size_t s = 0; s < strokes.count; ++s) {
      const Stroke& stroke = reaction.strokes[s];
      advance_stroke(stroke, state, now, strokes[s]);
      running = running || strokes[s].phase != kStrokeRests;
      float weight = stroke.is_lag ? lag_value(strokes[s].envelope, now)
                                   : fade_value(strokes[s].envelope, now);
      if (stroke.is_held && !stroke.is_lag) weight *= gain;
      if (stroke.is_scaled) weight *= level;
      if (weight > 0.0f) blend_pose(mix, stroke, weight < 1.0f ? weight : 1.0f, row);
    }
    state.running = running ? 1 : 0;
  }
}

TickRange lids_closing(const Mix& mix, int64_t lead, Span<const ReactionState> states,
                       Span<const StrokeState> all) {
  TickRange found;
  for (uint32_t r = 0; r < mix.reactions.count; ++r) {
    if (!states[r].running) continue;
    const Span<const Stroke> strokes = mix.reactions[r].strokes;
    for (size_t s = 0; s < strokes.count; ++s) {
      const StrokeState& state = all[mix.first_strokes[r] + s];
      const bool waits = state.phase == kStrokeWaits;
      const float target = waits ? states[r].strength : state.envelope.target;
      if (!mix.closes_lids[mix.first_strokes[r] + s] || target == 0.0f) continue;
      if (!waits && state.phase != kStrokeRises) continue;
      const int64_t rises = waits ? state.begin : state.envelope.start;
      const int64_t ticks = waits ? strokes[s].attack : state.envelope.ticks;
      const int64_t end = rises + (strokes[s].is_lag ? kLagEnd * ticks : ticks);
      const bool first = found.begin == found.end;
      found.begin = first ? rises - lead : std::min(found.begin, rises - lead);
      found.end = first ? end : std::max(found.end, end);
    }
  }
  return found;
}

void glare_strokes(uint32_t first_pose, Stroke (&strokes)[kGlareStrokes]) {
  constexpr int64_t ms = kTicksPerSecond / 1000;
  const Stroke all[kGlareStrokes] = {
      {0, BlendMode::kMax, false, false, false, 60 * ms, 70 * ms, 60 * ms, 220 * ms},
      {1, BlendMode::kScreen, true, false, true, 90 * ms, 150 * ms, 0, 400 * ms},
      {2, BlendMode::kAdd, true, false, false, 200 * ms, 120 * ms, 0, 350 * ms},
      {3, BlendMode::kAdd, true, true, true, 200 * ms, 250 * ms, 0, 500 * ms},
      {4, BlendMode::kAdd, true, false, false, 180 * ms, 350 * ms, 0, 600 * ms},
  };
  for (uint32_t i = 0; i < kGlareStrokes; ++i) {
    strokes[i] = all[i];
    strokes[i].pose += first_pose;
  }
}

ReactionDesc glare_reaction(const Stroke (&strokes)[kGlareStrokes]) {
  ReactionDesc desc;
  desc.strokes = {strokes, kGlareStrokes};
  desc.cooldown = kTicksPerSecond / 4;
  desc.adapted = 0.6f;
  desc.adapt_ticks = desc.recover_ticks = kTicksPerSecond * 3 / 2;
  desc.level_on = 0.5f;
  desc.level_off = 0.35f;
  return desc;
}

}  // namespace mien
