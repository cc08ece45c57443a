// SPDX-License-Identifier: MIT
#include "runtime/mix/mixer.h"

#include <cassert>
#include <cmath>
#include <cstring>

#include "runtime/mix/mixer_layers.h"

namespace mien {
namespace {

constexpr uint32_t kNoCurve = ~uint32_t{0};
constexpr int64_t kMaxStreamTick = INT64_MAX / 4;  // differences do not overflow

void place_state(Placer& placer, const Mix& mix, Mixer& mixer) {
  mixer.header = placer.array<StateHeader>(1, kBlockAlignment).data;
  mixer.layers = placer.array<LayerState>(mix.layers.count);
  mixer.player_states = placer.array<PlayerState>(mix.player_count);
  mixer.pose_weights = placer.array<Fade>(mix.fade_count);
  mixer.variables = placer.array<float>(mix.variable_count);
  mixer.held = placer.array<float>(mix.guard_table.curves.count);
  mixer.generators = placer.array<GeneratorState>(mix.layers.count);
  mixer.gazes = placer.array<GazeState>(mix.gaze ? 1 : 0);
  mixer.reactions = placer.array<ReactionState>(mix.reactions.count);
  mixer.strokes = placer.array<StrokeState>(mix.stroke_count);
  mixer.guard_overrides = placer.array<float>(mix.guards.count);
  mixer.layer_rows = placer.array<float>(
      layers_with_rows(mix, mix.layers.count) * kLayerRows * layer_row_floats(mix),
      kBlockAlignment);
}

void place_mixer(Placer& placer, const Mix& mix, bool stages, Mixer& mixer) {
  if (stages) {
    const size_t floats = size_t{stage_count(mix)} * mix.curve_count;
    mixer.stages = placer.array<float>(floats, kBlockAlignment).data;
  }
  mixer.row = placer.array<float>(mix.curve_count, kBlockAlignment);
  mixer.guarded_rows = placer.array<float>(
      kGuardedRows * align_up(mix.guard_table.curves.count, kGuardStep), kBlockAlignment);
  mixer.layer_row = placer.array<float>(layer_row_floats(mix), kBlockAlignment);
  mixer.scratch = placer.array<float>(mix.curve_count, kBlockAlignment);
  mixer.gui = placer.array<float>(mix.max_bound_gui, kBlockAlignment);
  mixer.players = placer.array<Player>(mix.player_count, kBlockAlignment);
  for (uint32_t i = 0; i < mix.player_count; ++i) {
    Player player;
    place_clip_sampler(placer,
                       {mix.max_channels, mix.max_changing_channels, mix.reverse, mix.kernels},
                       player.sampler);
    player.rows = placer.array<float>(size_t{3} * mix.curve_count, kBlockAlignment);
    if (!placer.measuring()) mixer.players[i] = player;
  }
  mixer.streams = placer.array<RowStream*>(mix.layers.count);
  for (size_t i = 0; i < mix.layers.count; ++i) {
    const LayerDesc& layer = mix.layers[i];
    if (layer.source != LayerSource::kStream) continue;
    RowStream* stream = nullptr;
    place_stream(placer, layer.stream_frames, static_cast<uint32_t>(layer.curves.count), stream);
    if (!placer.measuring()) mixer.streams[i] = stream;
  }
  mixer.cover_rests = placer.array<uint8_t>(mix.layers.count);
  mixer.events = placer.array<MixEvent>(mix.max_events);
  Placer state(nullptr);
  place_state(state, mix, mixer);
  mixer.state = placer.array<uint8_t>(state.size(), kBlockAlignment);
  if (placer.measuring()) return;
  Placer in_state(mixer.state.data);
  place_state(in_state, mix, mixer);
}

uint32_t find_free_player(const Mixer& mixer) {
  for (uint32_t i = 0; i < mixer.players.count; ++i) {
    if (!mixer.players[i].used) return i;
  }
  return kNoCurve;
}

void set_cover(Mixer& mixer, Player& player) {
  const Mix& mix = *mixer.mix;
  memset(player.rows.data, 0, player.rows.count * sizeof(float));
  for (uint16_t curve : player.source.binding->controls) {
    player.rows[mix.curve_count + (player.mirrored ? mix.mirror[curve] : curve)] = 1.0f;
  }
}

Status bad_layer(Error& error, uint32_t layer, const char* why) {
  return fail(error, Status::kIndex, kNoOffset, "layer %u: %s", layer, why);
}

Status check_index(const char* of, uint32_t index, size_t count, Error& error) {
  if (index < count) return Status::kOk;
  return fail(error, Status::kIndex, kNoOffset, "%s %u of %zu", of, index, count);
}

/// Fades a weight from now on.
Status fade_to(const Mixer& mixer, Fade& fade, const char* of, uint32_t index, float weight,
               float lowest, int64_t ticks, Error& error) {
  if (weight >= lowest && weight <= 1.0f && ticks >= 0 && ticks <= kMaxFadeTicks) {
    start_fade(fade, mixer.header->now, weight, ticks);
    return Status::kOk;
  }
  return fail(
      error, Status::kInvalidArgument, kNoOffset,
      "%s %u: weight %g in %lld ticks; weights are %g ... 1, times 0 ... 2^40 ticks (26 minutes)",
      of, index, double{weight}, static_cast<long long>(ticks), double{lowest});
}

}  // namespace

// Creating
// ------------------------------------------------------------------------------------------------

size_t mixer_size(const Mix& mix, bool stages) {
  return block_bytes<Mixer>(
      [&](Placer& placer, Mixer& mixer) { place_mixer(placer, mix, stages, mixer); });
}

Mixer* create_mixer(const Mix& mix, uint64_t seed, bool stages, const Allocator& allocator) {
  Mixer* const created = create_object<Mixer>(
      allocator, [&](Placer& placer, Mixer& mixer) { place_mixer(placer, mix, stages, mixer); });
  if (!created) return nullptr;
  Mixer& mixer = *created;
  mixer.mix = share(mix);
  mixer.header->seed = seed;
  for (uint32_t i = 0; i < mix.layers.count; ++i) {
    LayerState& layer = mixer.layers[i];
    set_fade(layer.weight, mix.layers[i].weight);
    set_fade(layer.presence, has_rows(mix.layers[i]) ? 0.0f : 1.0f);
    set_fade(layer.cross, 1.0f);
    layer.current = layer.previous = kNoPlayer;
  }
  for (ReactionState& reaction : mixer.reactions) {
    set_fade(reaction.gain, 1.0f);
    reaction.level.target = 1.0f;
  }
  for (float& activation : mixer.guard_overrides) activation = -1.0f;
  for (GazeState& gaze : mixer.gazes) gaze.large_shift = kNoShift;
  return created;
}

size_t state_size(const Mix& mix) {
  Mixer mixer;
  Placer measure(nullptr);
  place_state(measure, mix, mixer);
  return measure.size();
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
  for (uint32_t row = 0; row < 2; ++row) sample_player(mixer, player, row, true);
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
                       (unused != kNoCurve || after_release != kNoCurve);
  uint32_t target = unused;
  if (occupied) target = crosses ? (unused != kNoCurve ? unused : after_release) : layer.current;
  Player& player = mixer.players[target];
  keep_shown(mixer, index);
  status = start_player(mixer, player, source, desc.play, desc.mirrored, error);
  if (status != Status::kOk) return status;

  const bool was_crossing = layer.previous != kNoPlayer && layer.previous != target;
  if (was_crossing) release_player(mixer, layer.previous);
  layer.previous = kNoPlayer;
  if (crosses) {
    // If a crossfade was in progress, the transition starts from its current result.
    if (fade_value(layer.cross, now) != 1.0f) {
      start_offsets(mixer, index, mixer.players[layer.current].rows.data, now, ticks);
    }
    layer.previous = layer.current;
    set_fade(layer.cross, 0.0f);
    start_fade(layer.cross, now, 1.0f, ticks);
  } else {
    set_fade(layer.cross, 1.0f);
    start_offsets(mixer, index, player.rows.data, now, shown ? ticks : 0);
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
  return fade_to(mixer, mixer.layers[index].presence, "layer", index, 0.0f, 0.0f, fade_ticks,
                 error);
}

Status set_layer_weight(Mixer& mixer, uint32_t index, float weight, int64_t fade_ticks,
                        Error& error) {
  if (index >= mixer.layers.count) return bad_layer(error, index, "it does not exist");
  const float lowest = mixer.mix->layers[index].mode == BlendMode::kAdd ? -1.0f : 0.0f;
  return fade_to(mixer, mixer.layers[index].weight, "layer", index, weight, lowest, fade_ticks,
                 error);
}

Status set_pose_weight(Mixer& mixer, uint32_t index, uint32_t pose, float weight,
                       int64_t fade_ticks, Error& error) {
  if (index >= mixer.layers.count || pose >= mixer.mix->layers[index].pose_count) {
    return bad_layer(error, index, "it does not exist or has no such pose");
  }
  Fade& fade = mixer.pose_weights[mixer.mix->first_fades[index] + pose];
  return fade_to(mixer, fade, "pose", pose, weight, 0.0f, fade_ticks, error);
}

Status set_variable(Mixer& mixer, uint32_t variable, float value, Error& error) {
  const Status status = check_index("pose variable", variable, mixer.variables.count, error);
  if (status != Status::kOk) return status;
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
    return bad_layer(error, index, "it does not exist or is not a stream");
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
  const Status status = check_index("reaction", reaction, mixer.reactions.count, error);
  if (status != Status::kOk) return status;
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
  const Status status = check_index("reaction", reaction, mixer.reactions.count, error);
  if (status != Status::kOk) return status;
  release_reaction(reaction, mixer.header->now, mixer.reactions);
  return Status::kOk;
}

Status set_level(Mixer& mixer, uint32_t reaction, float level, Error& error) {
  const Status status = check_index("reaction", reaction, mixer.reactions.count, error);
  if (status != Status::kOk) return status;
  if (mixer.mix->reactions[reaction].level_on == 0.0f || !(level >= 0.0f && level <= 1.0f)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "reaction %u: level %g; levels are 0 ... 1, of reactions with .level_on above 0",
                reaction, double{level});
  }
  set_reaction_level(*mixer.mix, reaction, mixer.header->now, level, mixer.reactions,
                     mixer.strokes);
  return Status::kOk;
}

Status set_guard(Mixer& mixer, uint32_t guard, float activation, Error& error) {
  const Status status = check_index("guard", guard, mixer.guard_overrides.count, error);
  if (status != Status::kOk) return status;
  if (!(activation <= 1.0f)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "guard %u: activation %g; it must be 0 ... 1, or negative for the guard's own",
                guard, double{activation});
  }
  mixer.guard_overrides[guard] = activation < 0.0f ? -1.0f : activation;
  return Status::kOk;
}

}  // namespace mien
