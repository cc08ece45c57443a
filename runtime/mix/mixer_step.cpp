// SPDX-License-Identifier: MIT
// A step of a mixer: layers, reactions, guards, antagonists and limits, in the order of docs/mixing.md.
#include <algorithm>
#include <cassert>
#include <cstring>

#include "runtime/base/vectors.h"
#include "runtime/mix/mixer_layers.h"
#include "runtime/mix/speech.h"

namespace mien {
namespace {

void report_events(Mixer& mixer, uint32_t layer, EventRange range) {
  ClipEvent event;
  while (next_event(range, event)) {
    if (mixer.event_count == mixer.events.count) {
      mixer.lost_events = true;
      return;  // a step over many loops passes any number of them
    }
    mixer.events[mixer.event_count++] = {layer, event};
  }
}

void advance_players(Mixer& mixer, int64_t ticks) {
  mixer.event_count = 0;
  mixer.lost_events = false;
  for (uint32_t i = 0; i < mixer.layers.count; ++i) {
    LayerState& layer = mixer.layers[i];
    if (layer.previous != kNoPlayer) {
      advance_clip(mixer.players[layer.previous].sampler, ticks);
    }
    if (layer.current != kNoPlayer) {
      report_events(mixer, i, advance_clip(mixer.players[layer.current].sampler, ticks));
    }
  }
}

/// The row that a layer shows now is written over the older one of its two.
float* next_shown_row(Mixer& mixer, uint32_t index, int64_t ticks) {
  LayerState& layer = mixer.layers[index];
  if (ticks > 0 || layer.shown_count == 0) {
    layer.newest ^= 1;
    layer.shown_count = layer.shown_count == 0 ? 1 : 2;
    layer.shown_ticks = ticks;
  }
  return layer_row(mixer, index, kShown0 + layer.newest);
}

bool has_offsets(const Mixer& mixer, const LayerState& layer) {
  return mixer.header->now - layer.offset_start < layer.offset_ticks;
}

/// Computes what a layer shows: a row plus the offsets of a transition, if there are any.
void show_row(Mixer& mixer, uint32_t index, const float* row, float* shown) {
  const LayerState& layer = mixer.layers[index];
  const size_t floats = shown_floats(*mixer.mix, index), curves = mixer.mix->curve_count;
  size_t added = 0;
  if (has_offsets(mixer, layer)) {
    const int64_t elapsed = mixer.header->now - layer.offset_start;
    added = floats > curves && mixer.cover_rests[index] ? curves : floats;
    mixer.mix->kernels->add_quintics(quintic_rows(mixer, index),
                                     fraction_of(elapsed, layer.offset_ticks), added, row, shown);
  }
  if (row != shown) memcpy(shown + added, row + added, (floats - added) * sizeof(float));
}

/// `cover` may be null: the layer's mask leaves out curves for which its poses have no value.
void blend(Mixer& mixer, uint32_t index, float weight, const float* values, const float* cover,
           float scale = 1.0f) {
  const LayerDesc& layer = mixer.mix->layers[index];
  mixer.mix->kernels->blend_row({values, cover, mixer.mix->mask_rows[index].data, mixer.row.data,
                                 mixer.mix->curve_count, weight, layer.mode, scale});
}

void mix_clip_layer(Mixer& mixer, uint32_t index, int64_t ticks) {
  LayerState& layer = mixer.layers[index];
  const int64_t now = mixer.header->now;
  if (layer.current == kNoPlayer) return;
  if (layer.presence.target == 0.0f && fade_value(layer.presence, now) == 0.0f) {
    release_player(mixer, layer.current);
    release_player(mixer, layer.previous);
    layer.shown_count = layer.in_player[0] = layer.in_player[1] = 0;
    return;
  }
  const float weight = layer_weight(layer, mixer.mix->layers[index].mode, now);
  if (weight == 0.0f) {
    layer.shown_count = 0;  // its rows are not known
    return;
  }
  const Mix& mix = *mixer.mix;
  Player& current = mixer.players[layer.current];
  const float s = cross_share(layer, now);
  if (s == 1.0f) release_player(mixer, layer.previous);
  float* shown = next_shown_row(mixer, index, ticks);
  if (layer.previous == kNoPlayer && !has_offsets(mixer, layer)) {
    sample_player(mixer, current, layer.newest, false);
    layer.in_player[layer.newest] = 1;
    // The mask leaves out curves beyond the raw controls.
    const bool covers_all = current.source.binding->controls.count == mix.raw_count;
    const float* const values = player_values(mix, current, layer.newest);
    const LayerDesc& of = mix.layers[index];
    if (covers_all && of.mask.empty() && of.mode == BlendMode::kOverride && weight == 1.0f) {
      memcpy(mixer.row.data, values, mix.raw_count * sizeof(float));
      return;
    }
    blend(mixer, index, weight, values, covers_all ? nullptr : player_cover(mix, current));
    return;
  }
  layer.in_player[layer.newest] = 0;
  sample_player(mixer, current, 0, false);
  if (layer.previous != kNoPlayer) {
    Player& previous = mixer.players[layer.previous];
    sample_player(mixer, previous, 0, false);
    mix.kernels->cross_rows(previous.rows.data, current.rows.data, s, layer_row_floats(mix), shown);
    show_row(mixer, index, shown, shown);
  } else {
    show_row(mixer, index, current.rows.data, shown);
  }
  blend(mixer, index, weight, shown, shown + mix.curve_count);
}

void mix_stream_layer(Mixer& mixer, uint32_t index, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  const LayerDesc& layer = mix.layers[index];
  LayerState& state = mixer.layers[index];
  RowStream& stream = *mixer.streams[index];
  const int64_t now = mixer.header->now;
  float* const row = mixer.layer_row.data;
  const size_t floats = shown_floats(mix, index);
  memset(row, 0, floats * sizeof(float));
  const StreamSample sample = sample_stream(stream, now - layer.delay, row);
  if (sample == StreamSample::kNone) return;
  if (sample == StreamSample::kLost) {
    const int64_t lost = stream.last_tick + kStreamAhead + layer.delay;
    // A restored layer may find that its rows were lost long before.
    const int64_t start = std::max(lost, now - ticks);
    if (state.presence.target != 0.0f) start_fade(state.presence, start, 0.0f, kStreamFade);
  } else if (state.presence.target != 1.0f) {
    start_fade(state.presence, now - ticks, 1.0f, kStreamFade);
  }
  const float weight = layer_weight(state, layer.mode, now);
  if (weight == 0.0f) {
    state.shown_count = 0;
    return;
  }
  if (sample == StreamSample::kJumped) {
    start_offsets(mixer, index, row, now - ticks, kStreamLeadOver);
  }
  float* shown = next_shown_row(mixer, index, ticks);
  show_row(mixer, index, row, shown);
  blend_curves(layer.mode, layer.curves, shown, mix.mask_rows[index].data, weight, mixer.row.data);
}

void mix_generator(Mixer& mixer, uint32_t index, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  const LayerDesc& layer = mix.layers[index];
  const int64_t now = mixer.header->now;
  float* values = mixer.layer_row.data;
  const uint64_t seed = mixer.header->seed;
  if (layer.generator == Generator::kGaze) {
    generate_gaze(*mix.gaze, layer, seed, index, now, ticks, mixer.row.data, mixer.gazes[0],
                  mixer.scratch.data, values);
    // The curves of the eyes, then those of the head, which gets the rest.
    blend_curves(layer.mode, mix.gaze_curves, values, mix.mask_rows[index].data,
                 layer_weight(mixer.layers[index], layer.mode, now), mixer.row.data);
    return;
  }
  const int64_t shift = mixer.gazes.empty() ? kNoShift : mixer.gazes[0].large_shift;
  TickRange held;
  if (layer.generator == Generator::kBlink) {
    held = lids_closing(mix, kBlinkOpen, mixer.reactions, mixer.strokes);
    held = {std::max(held.begin, now - ticks), std::min(held.end, now)};
  }
  generate(layer, seed, index, now, shift, held, mixer.row.data, mixer.generators[index], values);
  blend_curves(layer.mode, layer.curves, values, mix.mask_rows[index].data,
               layer_weight(mixer.layers[index], layer.mode, now), mixer.row.data);
}

/// In a form that compilers vectorize.
void add_curves(const float* __restrict from, float scale, size_t count, float* __restrict to) {
  for (size_t i = 0; i < count; ++i) to[i] += scale * from[i];
}

void add_pose(const Mix& mix, uint32_t pose, float weight, float* row) {
  const Span<float> whole = mix.pose_rows[pose];
  if (!whole.empty()) return add_curves(whole.data, weight, whole.count, row);
  const uint16_t* const curves = mix.poses[pose].curves.data;
  const Span<const float> values = mix.poses[pose].values;
  for (size_t k = 0; k < values.count; ++k) row[curves[k]] += weight * values[k];
}

void mix_pose_layer(Mixer& mixer, uint32_t index) {
  const Mix& mix = *mixer.mix;
  const LayerDesc& layer = mix.layers[index];
  const int64_t now = mixer.header->now;
  const float weight = layer_weight(mixer.layers[index], layer.mode, now);
  if (weight == 0.0f) return;
  const Span<Fade> fades = mixer.pose_weights.slice(mix.first_fades[index], layer.pose_count);
  float sum = 0.0f;
  uint32_t shown = 0, last = 0;
  for (uint32_t p = 0; p < layer.pose_count; ++p) {
    const float w = fade_value(fades[p], now);
    if (!(w > 0.0f)) continue;
    sum += w;
    ++shown;
    last = p;
  }
  const float scale = sum > 1.0f ? 1.0f / sum : 1.0f;
  const Span<float> whole = shown == 1 ? mix.pose_rows[layer.first_pose + last] : Span<float>{};
  if (!whole.empty()) {
    return blend(mixer, index, weight, whole.data, nullptr, fade_value(fades[last], now) * scale);
  }
  float* row = mixer.layer_row.data;
  memset(row, 0, mix.curve_count * sizeof(float));
  for (uint32_t p = 0; p < layer.pose_count; ++p) {
    const float w = fade_value(fades[p], now) * scale;
    if (w > 0.0f) add_pose(mix, layer.first_pose + p, w, row);
  }
  blend(mixer, index, weight, row, nullptr);
}

float* guarded_row(const Mixer& mixer, GuardedRow which) {
  return mixer.guarded_rows.data + which * (mixer.guarded_rows.count / kGuardedRows);
}

/// Stores the current values of the curves of guards.
void gather_guarded(Mixer& mixer, GuardedRow which) {
  const Span<uint16_t> curves = mixer.mix->guard_table.curves;
  const float* const row = mixer.row.data;
  float* const kept = guarded_row(mixer, which);
  size_t i = 0;
  for (; i + 4 <= curves.count; i += 4) {
    const uint16_t* const at = &curves[i];
    store_four(kept + i, row[at[0]], row[at[1]], row[at[2]], row[at[3]]);
  }
  for (; i < curves.count; ++i) kept[i] = row[curves[i]];
}

void keep_stage(Mixer& mixer, uint32_t stage) {
  if (!mixer.stages) return;
  memcpy(mixer.stages + size_t{stage} * mixer.mix->curve_count, mixer.row.data,
         mixer.mix->curve_count * sizeof(float));
}

/// Layers from `begin` to `end` that come before the guards, or after them.
void mix_layers(Mixer& mixer, uint32_t begin, uint32_t end, bool after_guards, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  for (uint32_t i = begin; i < end; ++i) {
    if ((mix.layers[i].after_guards != 0) != after_guards) continue;
    switch (mix.layers[i].source) {
      case LayerSource::kClip: mix_clip_layer(mixer, i, ticks); break;
      case LayerSource::kPoses: mix_pose_layer(mixer, i); break;
      case LayerSource::kStream: mix_stream_layer(mixer, i, ticks); break;
      case LayerSource::kGenerator: mix_generator(mixer, i, ticks); break;
    }
    keep_stage(mixer, i);
    if (i + 1 == mix.first_unprotected) gather_guarded(mixer, kProtected);
  }
}

void mix_guards(Mixer& mixer, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  if (mix.guards.empty()) return;
  const GuardTable& table = mix.guard_table;
  const auto count = static_cast<uint32_t>(table.curves.count);
  gather_guarded(mixer, kFree);
  const float* const before = guarded_row(mixer, kProtected);
  const float* const free_row = guarded_row(mixer, kFree);
  float* const row = guarded_row(mixer, kGuarded);
  const Speech speech = find_speech(mixer);
  alignas(kBlockAlignment) float distances[kMaxGuards];
  float activations[kMaxGuards];
  guard_distances(table, before, distances);
  for (size_t i = 0; i < mix.guards.count; ++i) {
    activations[i] = activation_of(mixer, i, distances[i], speech);
  }
  float* const back = guarded_row(mixer, kBack);
  hold_guards(table, before, distances, activations, free_row, back, row);
  const double seconds = static_cast<double>(ticks) / kTicksPerSecond;
  ease_guards(free_row, before, back, count, static_cast<float>(kGuardSpeed * seconds),
              mixer.held.data, row);
  float* const all_curves = mixer.row.data;
  const uint16_t* const curves = table.curves.data;
  MIEN_UNROLL_FOUR
  for (size_t i = 0; i < count; ++i) all_curves[curves[i]] = row[i];
}

void net_antagonists(const Mix& mix, float* row) {
  for (const AntagonistPair& pair : mix.antagonists) {
    // Without branches, which would be mispredicted.
    const float a = row[pair.first], b = row[pair.second], smaller = a < b ? a : b;
    const float both = pair.stiffness * (smaller > 0.0f ? smaller : 0.0f);
    row[pair.first] = a - both;
    row[pair.second] = b - both;
  }
}

}  // namespace

Status guard_state(const Mixer& mixer, uint32_t guard, GuardState& state, Error& error) {
  const Mix& mix = *mixer.mix;
  if (guard >= mix.guards.count) {
    return fail(error, Status::kIndex, kNoOffset, "guard %u of %zu", guard, mix.guards.count);
  }
  const Guard& of = mix.guards[guard];
  const auto distance = [&](GuardedRow row) {
    alignas(kBlockAlignment) float all[kMaxGuards];
    guard_distances(mix.guard_table, guarded_row(mixer, row), all);
    return all[guard];
  };
  state.curves = {of.curves, of.count};
  state.protected_distance = distance(kProtected);
  state.wanted = distance(kFree);
  state.distance = distance(kGuarded);
  state.limit = std::max(state.protected_distance, 0.0f) + of.tolerance;
  state.activation = activation_of(mixer, guard, state.protected_distance, find_speech(mixer));
  return Status::kOk;
}

void step_mixer(Mixer& mixer, int64_t ticks, float* out, size_t count, uint64_t* active) {
  const Mix& mix = *mixer.mix;
  assert(ticks >= 0 && ticks <= kMaxStepTicks && count <= mix.curve_count);
  const auto layer_count = static_cast<uint32_t>(mix.layers.count);
  mixer.header->now += ticks;
  advance_players(mixer, ticks);

  float* row = mixer.row.data;
  memset(row, 0, mix.curve_count * sizeof(float));
  memcpy(row + mix.raw_count, mixer.variables.data, mix.variable_count * sizeof(float));
  if (mix.first_unprotected == 0) gather_guarded(mixer, kProtected);
  mix_layers(mixer, 0, mix.first_after_reactions, false, ticks);
  mix_reactions(mix, mixer.header->now, false, mixer.reactions, mixer.strokes, row);
  keep_stage(mixer, layer_count + kStageReactions);
  mix_layers(mixer, mix.first_after_reactions, layer_count, false, ticks);
  mix_guards(mixer, ticks);
  keep_stage(mixer, layer_count + kStageGuards);
  mix_layers(mixer, 0, layer_count, true, ticks);
  mix_reactions(mix, mixer.header->now, true, mixer.reactions, mixer.strokes, row);
  net_antagonists(mix, row);
  keep_stage(mixer, layer_count + kStageAntagonists);
  mix.kernels->limit_row(mix.lower_row.data, mix.upper_row.data, mix.curve_count, row);
  keep_stage(mixer, layer_count + kStageLimits);

  if (out) memcpy(out, row, count * sizeof(float));
  if (active) mix.kernels->nonzero({row, active, mix.curve_count});
}

void step_mixers(Span<Mixer* const> mixers, int64_t ticks, float* const* outs, size_t count,
                 uint64_t* active, size_t active_stride) {
  for (size_t i = 0; i < mixers.count; ++i) {
    // Mixers of the same mix share the scratch of the first one, so that it stays in the cache.
    Mixer& mixer = *mixers[i];
    const Span<float> own = mixer.layer_row;
    if (mixer.mix == mixers[0]->mix) mixer.layer_row = mixers[0]->layer_row;
    step_mixer(mixer, ticks, outs[i], count, active ? active + i * active_stride : nullptr);
    mixer.layer_row = own;
  }
}

}  // namespace mien
