// SPDX-License-Identifier: MIT
#include "runtime/mix/mixer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "runtime/mix/mix_rows.h"

namespace mien {
namespace {

constexpr uint32_t kNone = ~uint32_t{0};
constexpr int64_t kMaxStreamTick = INT64_MAX / 4;  // differences do not overflow

// Memory
// ------------------------------------------------------------------------------------------------

/// Layers that can lead over from what they have shown to something else.
bool has_rows(const MixLayer& layer) {
  return layer.source == LayerSource::kClip || layer.source == LayerSource::kStream;
}

/// Of the first `end` layers.
size_t layers_with_rows(const Mix& mix, size_t end) {
  size_t count = 0;
  for (const MixLayer& layer : mix.layers.first(end)) count += has_rows(layer);
  return count;
}

size_t layer_row_floats(const Mix& mix) { return size_t{2} * mix.lane_count; }

/// Of what a layer shows: streams cover the same lanes all the time.
size_t shown_floats(const Mix& mix, uint32_t layer) {
  return mix.layers[layer].source == LayerSource::kStream ? mix.lane_count : layer_row_floats(mix);
}

void place_state(Placer& placer, const Mix& mix, Mixer& mixer) {
  mixer.header = placer.array<StateHeader>(1, kBlockAlignment).data;
  mixer.layers = placer.array<LayerState>(mix.layers.count);
  mixer.player_states = placer.array<PlayerState>(mix.player_count);
  mixer.pose_weights = placer.array<Fade>(mix.fade_count);
  mixer.variables = placer.array<float>(mix.variable_count);
  mixer.held = placer.array<float>(mix.guarded.count);
  mixer.generators = placer.array<GeneratorState>(mix.layers.count);
  mixer.gazes = placer.array<GazeState>(mix.has_gaze ? 1 : 0);
  mixer.reactions = placer.array<ReactionState>(mix.reactions.count);
  mixer.strokes = placer.array<StrokeState>(mix.strokes.count);
  mixer.guard_overrides = placer.array<float>(mix.guards.count);
  mixer.layer_rows = placer.array<float>(
      layers_with_rows(mix, mix.layers.count) * kLayerRows * layer_row_floats(mix),
      kBlockAlignment);
}

void place_mixer(Placer& placer, const Mix& mix, bool stages, Mixer& mixer) {
  placer.array<Mixer>(1);
  if (stages) {
    const size_t floats = size_t{stage_count(mix)} * mix.lane_count;
    mixer.stages = placer.array<float>(floats, kBlockAlignment).data;
  }
  mixer.row = placer.array<float>(mix.lane_count, kBlockAlignment);
  mixer.guarded_rows = placer.array<float>(3 * mix.guarded.count);
  mixer.layer_row = placer.array<float>(layer_row_floats(mix), kBlockAlignment);
  mixer.scratch = placer.array<float>(mix.lane_count, kBlockAlignment);
  mixer.gui = placer.array<float>(mix.max_bound_gui, kBlockAlignment);
  mixer.players = placer.array<Player>(mix.player_count, kBlockAlignment);
  for (uint32_t i = 0; i < mix.player_count; ++i) {
    Player player;
    place_clip_sampler(placer, {mix.max_channels, mix.max_changing_channels, mix.plays_backward},
                       player.sampler);
    player.row = placer.array<float>(layer_row_floats(mix), kBlockAlignment);
    if (!placer.measuring()) mixer.players[i] = player;
  }
  mixer.streams = placer.array<RowStream*>(mix.layers.count);
  for (size_t i = 0; i < mix.layers.count; ++i) {
    const MixLayer& layer = mix.layers[i];
    if (layer.source != LayerSource::kStream) continue;
    RowStream* stream = nullptr;
    place_stream(placer, layer.stream_frames, static_cast<uint32_t>(layer.lanes.count), stream);
    if (!placer.measuring()) mixer.streams[i] = stream;
  }
  mixer.events = placer.array<MixEvent>(mix.max_events);
  Placer state(nullptr);
  place_state(state, mix, mixer);
  mixer.state = placer.array<uint8_t>(state.size(), kBlockAlignment);
  if (placer.measuring()) return;
  Placer in_state(mixer.state.data);
  place_state(in_state, mix, mixer);
}

}  // namespace

void sample_player(Mixer& mixer, Player& player, bool constants) {
  const Mix& mix = *mixer.mix;
  const Span<const float> values = sample_clip(player.sampler);
  const Binding& binding = *player.source.binding;
  if (!player.mirrored) {
    apply_binding(binding, values, mixer.gui, player.row.first(mix.raw_count), constants);
    return;
  }
  apply_binding(binding, values, mixer.gui, mixer.scratch.first(mix.raw_count));
  for (uint16_t lane : binding.controls) player.row[mix.mirror[lane]] = mixer.scratch[lane];
}

namespace {

// What a layer plays
// ------------------------------------------------------------------------------------------------

float* layer_row(Mixer& mixer, uint32_t layer, uint32_t row) {
  const size_t slot = layers_with_rows(*mixer.mix, layer);
  const size_t floats = layer_row_floats(*mixer.mix);
  return mixer.layer_rows.slice((slot * kLayerRows + row) * floats, floats).data;
}

QuinticRows quintic_rows(Mixer& mixer, uint32_t layer) {
  return {layer_row(mixer, layer, kQuintic0), layer_row(mixer, layer, kQuintic1),
          layer_row(mixer, layer, kQuintic2), layer_row(mixer, layer, kQuinticRate)};
}

/// The image of a lane on the other side of the face, if the player is mirrored.
uint32_t played_lane(const Mix& mix, const Player& player, uint32_t lane) {
  return player.mirrored ? mix.mirror[lane] : lane;
}

void release_player(Mixer& mixer, uint16_t& player) {
  if (player != kNoPlayer) mixer.players[player].used = false;
  player = kNoPlayer;
}

uint32_t find_free_player(const Mixer& mixer) {
  for (uint32_t i = 0; i < mixer.players.count; ++i) {
    if (!mixer.players[i].used) return i;
  }
  return kNone;
}

/// Leads from the rows that the layer has shown last over to another row, beginning at `start`.
void start_offsets(Mixer& mixer, uint32_t index, const float* next, int64_t start, int64_t ticks) {
  LayerState& layer = mixer.layers[index];
  layer.offset_ticks = 0;
  if (layer.shown_count == 0 || ticks == 0) return;
  const bool moves = layer.shown_count == 2 && layer.shown_ticks > 0;
  const float* last = layer_row(mixer, index, kShown0 + layer.newest);
  const float* before = moves ? layer_row(mixer, index, kShown0 + (layer.newest ^ 1)) : last;
  start_quintics(last, before, next, moves ? fraction_of(ticks, layer.shown_ticks) : 0.0f,
                 shown_floats(*mixer.mix, index), quintic_rows(mixer, index));
  layer.offset_start = start;
  layer.offset_ticks = ticks;
}

void set_cover(Mixer& mixer, Player& player) {
  const Mix& mix = *mixer.mix;
  memset(player.row.data, 0, player.row.count * sizeof(float));
  for (uint16_t lane : player.source.binding->controls) {
    player.row[mix.lane_count + played_lane(mix, player, lane)] = 1.0f;
  }
}

// A step
// ------------------------------------------------------------------------------------------------

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

float layer_weight(const LayerState& layer, BlendMode mode, int64_t now) {
  const float lowest = mode == BlendMode::kAdd ? -1.0f : 0.0f;
  const float wanted = fade_value(layer.weight, now), there = fade_value(layer.presence, now);
  const float weight = wanted * (there < 1.0f ? (there > 0.0f ? there : 0.0f) : 1.0f);
  return weight < 1.0f ? (weight > lowest ? weight : lowest) : 1.0f;
}

/// Where the row goes that a layer shows now: over the older one of its two.
float* next_shown_row(Mixer& mixer, uint32_t index, int64_t ticks) {
  LayerState& layer = mixer.layers[index];
  if (ticks > 0 || layer.shown_count == 0) {
    layer.newest ^= 1;
    layer.shown_count = layer.shown_count == 0 ? 1 : 2;
    layer.shown_ticks = ticks;
  }
  return layer_row(mixer, index, kShown0 + layer.newest);
}

void add_offsets(Mixer& mixer, uint32_t index, float* shown) {
  LayerState& layer = mixer.layers[index];
  if (layer.offset_ticks == 0) return;
  const int64_t elapsed = mixer.header->now - layer.offset_start;
  if (elapsed >= layer.offset_ticks) {
    layer.offset_ticks = 0;
    return;
  }
  mixer.mix->kernels->add_quintics(quintic_rows(mixer, index),
                                   fraction_of(elapsed, layer.offset_ticks),
                                   shown_floats(*mixer.mix, index), shown);
}

/// `cover` may be null: the layer's mask leaves out what its source has no value for.
void blend(Mixer& mixer, uint32_t index, float weight, const float* values, const float* cover) {
  const MixLayer& layer = mixer.mix->layers[index];
  mixer.mix->kernels->blend_row(
      {values, cover, layer.mask.data, mixer.row.data, mixer.mix->lane_count, weight, layer.mode});
}

void mix_clip_layer(Mixer& mixer, uint32_t index, int64_t ticks) {
  LayerState& layer = mixer.layers[index];
  const int64_t now = mixer.header->now;
  if (layer.current == kNoPlayer) return;
  if (layer.presence.target == 0.0f && fade_value(layer.presence, now) == 0.0f) {
    release_player(mixer, layer.current);
    release_player(mixer, layer.previous);
    layer.shown_count = 0;
    return;
  }
  const float weight = layer_weight(layer, mixer.mix->layers[index].mode, now);
  if (weight == 0.0f) {
    layer.shown_count = 0;  // its rows are not known
    return;
  }
  Player& current = mixer.players[layer.current];
  sample_player(mixer, current, false);
  float s = fade_value(layer.cross, now);
  s = s < 1.0f ? (s > 0.0f ? s : 0.0f) : 1.0f;
  if (s == 1.0f) release_player(mixer, layer.previous);
  float* shown = next_shown_row(mixer, index, ticks);
  if (layer.previous != kNoPlayer) {
    Player& previous = mixer.players[layer.previous];
    sample_player(mixer, previous, false);
    mixer.mix->kernels->cross_rows(previous.row.data, current.row.data, s, current.row.count,
                                   shown);
  } else {
    memcpy(shown, current.row.data, current.row.count * sizeof(float));
  }
  add_offsets(mixer, index, shown);
  blend(mixer, index, weight, shown, shown + mixer.mix->lane_count);
}

void mix_stream_layer(Mixer& mixer, uint32_t index, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  const MixLayer& layer = mix.layers[index];
  LayerState& state = mixer.layers[index];
  RowStream& stream = *mixer.streams[index];
  const int64_t now = mixer.header->now;
  const StreamSample sample = sample_stream(stream, now - layer.delay, mixer.scratch.data);
  if (sample == StreamSample::kNone) return;
  if (sample == StreamSample::kLost) {
    const int64_t lost = stream.last_tick + kStreamAhead + layer.delay;
    if (state.presence.target != 0.0f) start_fade(state.presence, lost, 0.0f, kStreamFade);
  } else if (state.presence.target != 1.0f) {
    start_fade(state.presence, now - ticks, 1.0f, kStreamFade);
  }
  float* row = mixer.layer_row.data;
  memset(row, 0, mix.lane_count * sizeof(float));
  for (size_t i = 0; i < layer.lanes.count; ++i) row[layer.lanes[i]] = mixer.scratch[i];
  const float weight = layer_weight(state, layer.mode, now);
  if (weight == 0.0f) {
    state.shown_count = 0;
    return;
  }
  if (sample == StreamSample::kJumped) {
    start_offsets(mixer, index, row, now - ticks, kStreamLeadOver);
  }
  float* shown = next_shown_row(mixer, index, ticks);
  memcpy(shown, row, mix.lane_count * sizeof(float));
  add_offsets(mixer, index, shown);
  blend(mixer, index, weight, shown, nullptr);
}

void mix_generator(Mixer& mixer, uint32_t index, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  const MixLayer& layer = mix.layers[index];
  const int64_t now = mixer.header->now;
  float* values = mixer.layer_row.data;
  const uint64_t seed = mixer.header->seed;
  if (layer.generator == Generator::kGaze) {
    generate_gaze(mix.gaze, layer, seed, index, now, ticks, mixer.row.data, mixer.gazes[0],
                  mixer.scratch.data, values);
    // The lanes of the eyes, then those that get what is left for the head.
    blend_lanes(mix, layer.mode, mix.gaze_lanes, values, layer.mask.data,
                layer_weight(mixer.layers[index], layer.mode, now), mixer.row.data);
    return;
  }
  const int64_t shift = mixer.gazes.empty() ? kNoShift : mixer.gazes[0].large_shift;
  generate(layer, seed, index, now, shift, mixer.row.data, mixer.generators[index], values);
  blend_lanes(mix, layer.mode, layer.lanes, values, layer.mask.data,
              layer_weight(mixer.layers[index], layer.mode, now), mixer.row.data);
}

void mix_pose_layer(Mixer& mixer, uint32_t index) {
  const Mix& mix = *mixer.mix;
  const MixLayer& layer = mix.layers[index];
  const int64_t now = mixer.header->now;
  const float weight = layer_weight(mixer.layers[index], layer.mode, now);
  if (weight == 0.0f) return;
  float* row = mixer.layer_row.data;
  memset(row, 0, mix.lane_count * sizeof(float));
  const Span<Fade> fades = mixer.pose_weights.slice(layer.first_fade, layer.pose_count);
  float sum = 0.0f;
  for (const Fade& fade : fades) {
    const float w = fade_value(fade, now);
    sum += w > 0.0f ? w : 0.0f;
  }
  const float scale = sum > 1.0f ? 1.0f / sum : 1.0f;
  for (uint32_t p = 0; p < layer.pose_count; ++p) {
    const float w = fade_value(fades[p], now) * scale;
    if (!(w > 0.0f)) continue;
    const uint32_t pose = layer.first_pose + p;
    const uint32_t begin = pose == 0 ? 0 : mix.pose_ends[pose - 1];
    for (uint32_t k = begin; k < mix.pose_ends[pose]; ++k) {
      row[mix.pose_lanes[k]] += w * mix.pose_values[k];
    }
  }
  blend(mixer, index, weight, row, nullptr);
}

enum GuardedRow : uint32_t { kProtected, kFree, kHeldBack };

float* guarded_row(const Mixer& mixer, GuardedRow which) {
  return mixer.guarded_rows.data + which * mixer.mix->guarded.count;
}

/// Keeps what the row is now in the lanes of guards.
void gather_guarded(Mixer& mixer, GuardedRow which) {
  const Span<uint16_t> lanes = mixer.mix->guarded;
  float* kept = guarded_row(mixer, which);
  for (size_t i = 0; i < lanes.count; ++i) kept[i] = mixer.row[lanes[i]];
}

void keep_stage(Mixer& mixer, uint32_t stage) {
  if (!mixer.stages) return;
  memcpy(mixer.stages + size_t{stage} * mixer.mix->lane_count, mixer.row.data,
         mixer.mix->lane_count * sizeof(float));
}

/// Layers from `begin` to `end` that come before the guards, or after them.
void mix_layers(Mixer& mixer, uint32_t begin, uint32_t end, bool after_guards, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  for (uint32_t i = begin; i < end; ++i) {
    if (((mix.layers[i].flags & kLayerAfterGuards) != 0) != after_guards) continue;
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

/// The strongest layer of speech.
float speech_weight(const Mixer& mixer) {
  float speech = 0.0f;
  for (size_t i = 0; i < mixer.layers.count; ++i) {
    const MixLayer& layer = mixer.mix->layers[i];
    if (layer.group != LayerGroup::kSpeech) continue;
    const float weight = layer_weight(mixer.layers[i], layer.mode, mixer.header->now);
    if (weight > speech) speech = weight;
  }
  return speech;
}

/// Of a guard whose distance is that in the protected row.
float activation_of(const Mixer& mixer, size_t guard, float distance, float speech) {
  const float wanted = mixer.guard_overrides[guard];
  if (wanted >= 0.0f) return wanted;
  const Guard& of = mixer.mix->guards[guard];
  return guard_activation(of, distance) * (of.needs_speech ? speech : 1.0f);
}

void hold_guards(Mixer& mixer, int64_t ticks) {
  const Mix& mix = *mixer.mix;
  if (mix.guards.empty()) return;
  const size_t count = mix.guarded.count;
  gather_guarded(mixer, kFree);
  gather_guarded(mixer, kHeldBack);
  const float* const before = guarded_row(mixer, kProtected);
  float* const row = guarded_row(mixer, kHeldBack);
  const float speech = speech_weight(mixer);
  for (size_t i = 0; i < mix.guards.count; ++i) {
    const Guard& guard = mix.guards[i];
    const float distance = guard_distance(guard, before);
    hold_guard(guard, before, distance, activation_of(mixer, i, distance, speech), row);
  }
  const double seconds = static_cast<double>(ticks) / kTicksPerSecond;
  ease_guards(guarded_row(mixer, kFree), before, static_cast<uint32_t>(count),
              static_cast<float>(kGuardSpeed * seconds), mixer.held.data, row);
  for (size_t i = 0; i < count; ++i) mixer.row[mix.guarded[i]] = row[i];
}

void net_antagonists(const Mix& mix, float* row) {
  for (const AntagonistPair& pair : mix.antagonists) {
    const float a = row[pair.a], b = row[pair.b];
    if (!(a > 0.0f && b > 0.0f)) continue;
    const float both = pair.stiffness * (a < b ? a : b);
    row[pair.a] = a - both;
    row[pair.b] = b - both;
  }
}

Status bad_fade(Error& error, const char* of, uint32_t index, float weight, float lowest,
                int64_t ticks) {
  return fail(
      error, Status::kInvalidArgument, kNoOffset,
      "%s %u: weight %g in %lld ticks; weights are %g ... 1, times 0 ... 2^40 ticks (26 minutes)",
      of, index, double{weight}, static_cast<long long>(ticks), double{lowest});
}

Status bad_layer(Error& error, uint32_t layer, const char* why) {
  return fail(error, Status::kIndex, kNoOffset, "layer %u: %s", layer, why);
}

}  // namespace

// Creating
// ------------------------------------------------------------------------------------------------

size_t mixer_size(const Mix& mix, bool stages) {
  Mixer mixer;
  Placer measure(nullptr);
  place_mixer(measure, mix, stages, mixer);
  return measure.size();
}

Mixer* create_mixer(const Mix& mix, uint64_t seed, bool stages, const Allocator& allocator) {
  const size_t size = mixer_size(mix, stages);
  void* block = allocator.get(size, kBlockAlignment);
  if (!block) return nullptr;
  Mixer mixer;
  mixer.mix = &mix;
  mixer.allocator = allocator;
  mixer.block_size = size;
  Placer placer(block);
  place_mixer(placer, mix, stages, mixer);
  mixer.header->seed = seed;
  for (uint32_t i = 0; i < mix.layers.count; ++i) {
    LayerState& layer = mixer.layers[i];
    set_fade(layer.weight, mix.layers[i].weight);
    set_fade(layer.presence, has_rows(mix.layers[i]) ? 0.0f : 1.0f);
    set_fade(layer.cross, 1.0f);
    layer.current = layer.previous = kNoPlayer;
  }
  for (ReactionState& reaction : mixer.reactions) set_fade(reaction.gain, 1.0f);
  for (float& activation : mixer.guard_overrides) activation = -1.0f;
  for (GazeState& gaze : mixer.gazes) gaze.large_shift = kNoShift;
  mix.owners.fetch_add(1, std::memory_order_relaxed);
  return new (block) Mixer(mixer);
}

size_t state_size(const Mix& mix) {
  Mixer mixer;
  Placer measure(nullptr);
  place_state(measure, mix, mixer);
  return measure.size();
}

void destroy_mixer(Mixer* mixer) {
  if (!mixer) return;
  const Mix* const mix = mixer->mix;
  const Allocator allocator = mixer->allocator;
  allocator.put(mixer, mixer->block_size, kBlockAlignment);
  release_mix(mix);
}

// Playing
// ------------------------------------------------------------------------------------------------

Status check_source(const Mix& mix, uint32_t layer, const ClipSource& source, Error& error) {
  if (source.binding->raw_count != mix.raw_count ||
      source.binding->channel_count != source.clip->channel_count ||
      source.binding->gui_count > mix.max_bound_gui) {
    return fail(error, Status::kMismatch, kNoOffset,
                "layer %u: the binding is of another clip, or of another rig than the mix", layer);
  }
  if (source.clip->has(kClipIsDelta) && mix.layers[layer].mode == BlendMode::kOverride) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "layer %u overrides; the clip holds differences", layer);
  }
  return Status::kOk;
}

Status start_player(Mixer& mixer, Player& player, const ClipSource& source, const PlayDesc& desc,
                    bool mirrored, Error& error) {
  const Status status = start_clip(player.sampler, *source.clip, desc, error);
  if (status != Status::kOk) return status;
  player.source = source;
  player.mirrored = mirrored;
  player.used = true;
  set_cover(mixer, player);
  sample_player(mixer, player, true);
  return Status::kOk;
}

Status play_clip(Mixer& mixer, uint32_t index, const ClipSource& source, const LayerPlayDesc& desc,
                 Error& error) {
  const Mix& mix = *mixer.mix;
  if (index >= mix.layers.count || mix.layers[index].source != LayerSource::kClip) {
    return bad_layer(error, index, "it does not exist or plays no clips");
  }
  Status status = check_source(mix, index, source, error);
  if (status != Status::kOk) return status;
  if ((desc.mirrored && mix.mirror.empty()) || desc.transition_ticks < 0 ||
      desc.transition_ticks > kMaxFadeTicks) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "layer %u: %s", index,
                desc.mirrored && mix.mirror.empty()
                    ? "the mix has no mirror map"
                    : "the time of the transition must be 0 ... 2^40 ticks (26 minutes)");
  }
  LayerState& layer = mixer.layers[index];
  const int64_t now = mixer.header->now;
  const int64_t ticks = desc.transition == Transition::kCut ? 0 : desc.transition_ticks;
  const bool occupied = layer.current != kNoPlayer;
  const bool shown = occupied && layer.shown_count > 0;

  // The old player goes on only in a crossfade; otherwise the new clip takes it over.
  const uint32_t unused = find_free_player(mixer);
  const uint32_t after_release = layer.previous != kNoPlayer ? layer.previous : unused;
  const bool crosses = desc.transition == Transition::kCrossfade && shown && ticks > 0 &&
                       (unused != kNone || after_release != kNone);
  uint32_t target = unused;
  if (occupied) target = crosses ? (unused != kNone ? unused : after_release) : layer.current;
  Player& player = mixer.players[target];
  status = start_player(mixer, player, source, desc.play, desc.mirrored, error);
  if (status != Status::kOk) return status;

  const bool was_crossing = layer.previous != kNoPlayer && layer.previous != target;
  if (was_crossing) release_player(mixer, layer.previous);
  layer.previous = kNoPlayer;
  if (crosses) {
    // If a crossfade was under way, what it had reached leads over to the player that stays.
    if (fade_value(layer.cross, now) != 1.0f) {
      start_offsets(mixer, index, mixer.players[layer.current].row.data, now, ticks);
    }
    layer.previous = layer.current;
    set_fade(layer.cross, 0.0f);
    start_fade(layer.cross, now, 1.0f, ticks);
  } else {
    set_fade(layer.cross, 1.0f);
    start_offsets(mixer, index, player.row.data, now, shown ? ticks : 0);
  }
  layer.current = static_cast<uint16_t>(target);
  if (!occupied) set_fade(layer.presence, 0.0f);
  start_fade(layer.presence, now, 1.0f, ticks);
  return Status::kOk;
}

Status stop_layer(Mixer& mixer, uint32_t index, int64_t fade_ticks, Error& error) {
  if (index >= mixer.layers.count || mixer.mix->layers[index].source != LayerSource::kClip) {
    return bad_layer(error, index, "it does not exist or plays no clips");
  }
  if (fade_ticks < 0 || fade_ticks > kMaxFadeTicks) {
    return bad_fade(error, "layer", index, 0.0f, 0.0f, fade_ticks);
  }
  start_fade(mixer.layers[index].presence, mixer.header->now, 0.0f, fade_ticks);
  return Status::kOk;
}

Status set_layer_weight(Mixer& mixer, uint32_t index, float weight, int64_t fade_ticks,
                        Error& error) {
  if (index >= mixer.layers.count) return bad_layer(error, index, "it does not exist");
  const float lowest = mixer.mix->layers[index].mode == BlendMode::kAdd ? -1.0f : 0.0f;
  if (!(weight >= lowest && weight <= 1.0f) || fade_ticks < 0 || fade_ticks > kMaxFadeTicks) {
    return bad_fade(error, "layer", index, weight, lowest, fade_ticks);
  }
  start_fade(mixer.layers[index].weight, mixer.header->now, weight, fade_ticks);
  return Status::kOk;
}

Status set_pose_weight(Mixer& mixer, uint32_t index, uint32_t pose, float weight,
                       int64_t fade_ticks, Error& error) {
  if (index >= mixer.layers.count || pose >= mixer.mix->layers[index].pose_count) {
    return bad_layer(error, index, "it does not exist or has no such pose");
  }
  if (!(weight >= 0.0f && weight <= 1.0f) || fade_ticks < 0 || fade_ticks > kMaxFadeTicks) {
    return bad_fade(error, "pose", pose, weight, 0.0f, fade_ticks);
  }
  start_fade(mixer.pose_weights[mixer.mix->layers[index].first_fade + pose], mixer.header->now,
             weight, fade_ticks);
  return Status::kOk;
}

Status set_variable(Mixer& mixer, uint32_t variable, float value, Error& error) {
  if (variable >= mixer.variables.count) {
    return fail(error, Status::kIndex, kNoOffset, "pose variable %u of %zu", variable,
                mixer.variables.count);
  }
  if (!std::isfinite(value)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "pose variable %u: the value is not finite", variable);
  }
  mixer.variables[variable] = value;
  return Status::kOk;
}

Status push_row(Mixer& mixer, uint32_t index, int64_t tick, Span<const float> values,
                bool* accepted, Error& error) {
  if (index >= mixer.streams.count || !mixer.streams[index]) {
    return bad_layer(error, index, "it does not exist or is no stream");
  }
  RowStream& stream = *mixer.streams[index];
  if (values.count != stream.channels) {
    return fail(error, Status::kMismatch, kNoOffset, "layer %u: %zu values for %u channels", index,
                values.count, stream.channels);
  }
  for (float value : values) {
    if (std::isfinite(value)) continue;
    return fail(error, Status::kInvalidArgument, kNoOffset, "layer %u: a value is not finite",
                index);
  }
  if (tick > kMaxStreamTick || tick < -kMaxStreamTick) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "layer %u: tick %lld; times are within 2^61 of 0", index,
                static_cast<long long>(tick));
  }
  const bool pushed = push_stream(stream, tick, values.data);
  if (accepted) *accepted = pushed;
  return Status::kOk;
}

Status trigger(Mixer& mixer, uint32_t reaction, float strength, int64_t hold_ticks, Error& error) {
  if (reaction >= mixer.reactions.count) {
    return fail(error, Status::kIndex, kNoOffset, "reaction %u of %zu", reaction,
                mixer.reactions.count);
  }
  if (!(strength >= 0.0f && strength <= 1.0f) || hold_ticks < 0 ||
      (hold_ticks > kMaxFadeTicks && hold_ticks != kUntilReleased)) {
    return fail(
        error, Status::kInvalidArgument, kNoOffset,
        "reaction %u: strength %g for %lld ticks; strengths are 0 ... 1, times 0 ... 2^40, or "
        "kUntilReleased",
        reaction, double{strength}, static_cast<long long>(hold_ticks));
  }
  trigger_reaction(*mixer.mix, reaction, mixer.header->now, strength, hold_ticks, mixer.reactions,
                   mixer.strokes);
  return Status::kOk;
}

Status end_stimulus(Mixer& mixer, uint32_t reaction, Error& error) {
  if (reaction >= mixer.reactions.count) {
    return fail(error, Status::kIndex, kNoOffset, "reaction %u of %zu", reaction,
                mixer.reactions.count);
  }
  release_reaction(reaction, mixer.header->now, mixer.reactions);
  return Status::kOk;
}

Status set_guard(Mixer& mixer, uint32_t guard, float activation, Error& error) {
  if (guard >= mixer.guard_overrides.count) {
    return fail(error, Status::kIndex, kNoOffset, "guard %u of %zu", guard,
                mixer.guard_overrides.count);
  }
  if (!(activation <= 1.0f)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "guard %u: activation %g; it must be 0 ... 1, or negative for the guard's own",
                guard, double{activation});
  }
  mixer.guard_overrides[guard] = activation < 0.0f ? -1.0f : activation;
  return Status::kOk;
}

Status guard_state(const Mixer& mixer, uint32_t guard, GuardState& state, Error& error) {
  const Mix& mix = *mixer.mix;
  if (guard >= mix.guards.count) {
    return fail(error, Status::kIndex, kNoOffset, "guard %u of %zu", guard, mix.guards.count);
  }
  const Guard& of = mix.guards[guard];
  size_t first = 0;
  for (uint32_t i = 0; i < guard; ++i) first += mix.guards[i].count;
  const auto lanes = mix.guard_lanes.slice(first, of.count);
  state.lanes = {lanes.data, lanes.count};
  state.protected_distance = guard_distance(of, guarded_row(mixer, kProtected));
  state.wanted = guard_distance(of, guarded_row(mixer, kFree));
  state.distance = guard_distance(of, guarded_row(mixer, kHeldBack));
  state.limit = std::max(state.protected_distance, 0.0f) + of.tolerance;
  state.activation = activation_of(mixer, guard, state.protected_distance, speech_weight(mixer));
  return Status::kOk;
}

// Stepping
// ------------------------------------------------------------------------------------------------

void step_mixer(Mixer& mixer, int64_t ticks, float* out, size_t count, uint64_t* active) {
  const Mix& mix = *mixer.mix;
  assert(ticks >= 0 && ticks <= kMaxStepTicks && count <= mix.lane_count);
  const auto layer_count = static_cast<uint32_t>(mix.layers.count);
  mixer.header->now += ticks;
  advance_players(mixer, ticks);

  float* row = mixer.row.data;
  memset(row, 0, mix.lane_count * sizeof(float));
  memcpy(row + mix.raw_count, mixer.variables.data, mix.variable_count * sizeof(float));
  if (mix.first_unprotected == 0) gather_guarded(mixer, kProtected);
  mix_layers(mixer, 0, mix.first_after_reactions, false, ticks);
  mix_reactions(mix, mixer.header->now, false, mixer.reactions, mixer.strokes, row);
  keep_stage(mixer, layer_count + kStageReactions);
  mix_layers(mixer, mix.first_after_reactions, layer_count, false, ticks);
  hold_guards(mixer, ticks);
  keep_stage(mixer, layer_count + kStageGuards);
  mix_layers(mixer, 0, layer_count, true, ticks);
  mix_reactions(mix, mixer.header->now, true, mixer.reactions, mixer.strokes, row);
  net_antagonists(mix, row);
  keep_stage(mixer, layer_count + kStageAntagonists);
  mix.kernels->limit_row(mix.lower.data, mix.upper.data, mix.lane_count, row);
  keep_stage(mixer, layer_count + kStageLimits);

  if (out) memcpy(out, row, count * sizeof(float));
  if (active) mix.kernels->nonzero({row, active, mix.lane_count});
}

void step_mixers(Span<Mixer* const> mixers, int64_t ticks, float* const* outs, size_t count,
                 uint64_t* active, size_t active_stride) {
  for (size_t i = 0; i < mixers.count; ++i) {
    step_mixer(*mixers[i], ticks, outs[i], count, active ? active + i * active_stride : nullptr);
  }
}

}  // namespace mien
