// SPDX-License-Identifier: MIT
// Mixes and mixers. mien.h is the manual.
#include <cstring>

#include "capi/handles.h"
#include "runtime/probe/probe_guards.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_LAYER_GROUP_LIFE == int(LayerGroup::kLife) &&
                  MIEN_BLEND_MODE_SCALE == int(BlendMode::kScale) &&
                  MIEN_LAYER_SOURCE_GENERATOR == int(LayerSource::kGenerator) &&
                  MIEN_GENERATOR_GAZE == int(Generator::kGaze) &&
                  MIEN_RETRIGGER_IGNORE == int(Retrigger::kIgnore),
              "mix.h and mien.h number the same choices");

// Mix ---------------------------------------------------------------------------------------------

namespace {

/// The caller's lists in the form of the mix, in memory that lasts for the call.
struct MixLists {
  Span<LayerDesc> layers;
  Span<PoseDesc> poses;
  Span<ReactionDesc> reactions;
  Span<Stroke> strokes;
  Span<AntagonistPair> antagonists;

  bool allocate(Arena& arena, const MienMixDesc& desc) {
    size_t stroke_count = 0;
    for (size_t i = 0; i < desc.reaction_count; ++i) stroke_count += desc.reactions[i].stroke_count;
    layers = arena.array<LayerDesc>(desc.layer_count);
    poses = arena.array<PoseDesc>(desc.pose_count);
    reactions = arena.array<ReactionDesc>(desc.reaction_count);
    strokes = arena.array<Stroke>(stroke_count);
    antagonists = arena.array<AntagonistPair>(desc.antagonist_count);
    return layers.count == desc.layer_count && poses.count == desc.pose_count &&
           reactions.count == desc.reaction_count && strokes.count == stroke_count &&
           antagonists.count == desc.antagonist_count;
  }

  void fill(const MienMixDesc& desc) {
    for (size_t i = 0; i < desc.layer_count; ++i) {
      const MienMixLayer& from = desc.layers[i];
      LayerDesc& to = layers[i];
      to.group = static_cast<LayerGroup>(from.group);
      to.mode = static_cast<BlendMode>(from.mode);
      to.source = static_cast<LayerSource>(from.source);
      to.flags = from.after_guards != 0 ? uint32_t{kLayerAfterGuards} : 0;
      to.weight = from.weight;
      to.mask = {from.mask, from.mask ? from.mask_count : 0};
      to.first_pose = from.first_pose;
      to.pose_count = from.pose_count;
      to.curves = {from.curves, from.curve_count};
      to.amounts = {from.amounts, from.amounts ? from.curve_count : 0};
      to.generator = static_cast<Generator>(from.generator);
      to.period = from.period;
      to.delay = from.delay;
      to.stream_frames = from.stream_frames != 0 ? from.stream_frames : 64;
    }
    for (size_t i = 0; i < desc.pose_count; ++i) {
      const MienMixPose& from = desc.poses[i];
      poses[i] = {{from.curves, from.count}, {from.values, from.count}};
    }
    size_t stroke = 0;
    for (size_t i = 0; i < desc.reaction_count; ++i) {
      const MienMixReaction& from = desc.reactions[i];
      ReactionDesc& to = reactions[i];
      to.strokes = strokes.slice(stroke, from.stroke_count);
      to.retrigger = static_cast<Retrigger>(from.retrigger);
      to.after_guards = from.after_guards != 0;
      to.cooldown = from.cooldown;
      to.adapted = from.adapted;
      to.adapt_ticks = from.adapt_ticks;
      to.recover_ticks = from.recover_ticks;
      to.level_on = from.level_on;
      to.level_off = from.level_off;
      for (size_t s = 0; s < from.stroke_count; ++s, ++stroke) {
        const MienMixStroke& each = from.strokes[s];
        strokes[stroke] = {each.pose,           static_cast<BlendMode>(each.mode),
                           each.is_held != 0,   each.is_lag != 0,
                           each.is_scaled != 0, each.delay,
                           each.attack,         each.hold,
                           each.release};
      }
    }
    for (size_t i = 0; i < desc.antagonist_count; ++i) {
      const MienMixAntagonists& from = desc.antagonists[i];
      antagonists[i] = {from.first, from.second, from.stiffness};
    }
  }
};

constexpr uint32_t kMaxLandmarkPoints = 65536;

/// Checks that the mix cannot make, because it takes spans and 8-bit enums.
MienStatus check_mix_desc(const MienMixDesc& desc, MienError* error) {
  if ((!desc.layers && desc.layer_count != 0) || (!desc.poses && desc.pose_count != 0) ||
      (!desc.reactions && desc.reaction_count != 0) ||
      (!desc.antagonists && desc.antagonist_count != 0) || (!desc.lower != !desc.upper) ||
      (!desc.custom_guards && desc.custom_guard_count != 0) ||
      (!desc.deformer && ((desc.guards & MIEN_GUARD_ALL) != 0 || desc.custom_guard_count != 0))) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienMixDesc: an array is NULL, but its count is not 0; one of the limits is "
                      "NULL; or guards are not 0 without a deformer");
  }
  if (desc.layer_count > kMaxLayers || desc.pose_count > kMaxPoses ||
      desc.reaction_count > kMaxReactions || desc.antagonist_count > kMaxCurves ||
      desc.guards > MIEN_GUARD_ALL || desc.custom_guard_count > kMaxGuards || desc.reserved != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienMixDesc: too many layers, poses, reactions or antagonists, unknown "
                      "guards, or .reserved is not 0");
  }
  for (size_t i = 0; i < desc.layer_count; ++i) {
    const MienMixLayer& layer = desc.layers[i];
    if (!layer.curves && layer.curve_count != 0) {
      return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "layer %zu: curves is NULL", i);
    }
    if (layer.group > MIEN_LAYER_GROUP_LIFE || layer.mode > MIEN_BLEND_MODE_SCALE ||
        layer.source > MIEN_LAYER_SOURCE_GENERATOR || layer.generator > MIEN_GENERATOR_GAZE ||
        layer.reserved != 0) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "layer %zu: group, mode, source or generator is none of its values, or "
                        "reserved is not 0",
                        i);
    }
  }
  for (size_t i = 0; i < desc.custom_guard_count; ++i) {
    const MienMixGuard& guard = desc.custom_guards[i];
    if (guard.upper.point_count <= kMaxLandmarkPoints &&
        guard.lower.point_count <= kMaxLandmarkPoints && guard.closed_by <= MIEN_NO_CONTROL) {
      continue;
    }
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "custom guard %zu: too many points, or closed_by is out of range", i);
  }
  for (size_t i = 0; i < desc.pose_count; ++i) {
    const MienMixPose& pose = desc.poses[i];
    if ((pose.curves && pose.values) || pose.count == 0) continue;
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "pose %zu: curves or values is NULL", i);
  }
  for (size_t i = 0; i < desc.reaction_count; ++i) {
    const MienMixReaction& reaction = desc.reactions[i];
    if (!reaction.strokes && reaction.stroke_count != 0) {
      return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "reaction %zu: strokes is NULL", i);
    }
    bool known = reaction.stroke_count <= kMaxStrokes &&
                 reaction.retrigger <= MIEN_RETRIGGER_IGNORE && reaction.reserved == 0;
    for (size_t s = 0; known && s < reaction.stroke_count; ++s) {
      known =
          reaction.strokes[s].mode <= MIEN_BLEND_MODE_SCALE && reaction.strokes[s].reserved == 0;
    }
    if (!known) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "reaction %zu: too many strokes, retrigger or a mode is none of its "
                        "values, or reserved is not 0",
                        i);
    }
  }
  return MIEN_OK;
}

uint32_t guard_bit(StandardGuard kind) {
  switch (kind) {
    case StandardGuard::kLidsLeft:
    case StandardGuard::kLidsRight: return MIEN_GUARD_LIDS;
    case StandardGuard::kTeeth: return MIEN_GUARD_TEETH;
    default: return MIEN_GUARD_LIPS;
  }
}

static_assert(sizeof(kOfJoints) == 4 && kOfJoints == MIEN_NO_MESH &&
                  kNoControl == MIEN_NO_CONTROL && kStandardGuardCount < kMaxGuards,
              "guards of the caller are those of the runtime");

Landmark landmark_of(const MienLandmark& from) {
  return {from.mesh, {from.points, from.points ? from.point_count : 0}};
}

GuardDesc guard_of(const MienMixGuard& from) {
  GuardDesc to;
  to.upper = landmark_of(from.upper);
  to.lower = landmark_of(from.lower);
  to.closed_by = from.closed_by < kNoControl ? static_cast<uint16_t>(from.closed_by) : kNoControl;
  to.tolerance = from.tolerance;
  to.f_on = from.f_on;
  to.needs_speech = from.needs_speech != 0;
  return to;
}

/// The standard guards of MIEN_GUARD_... bits.
GuardKinds kinds_of(uint32_t guards) {
  GuardKinds kinds = 0;
  for (uint32_t k = 0; k < kStandardGuardCount; ++k) {
    if ((guards & guard_bit(static_cast<StandardGuard>(k))) != 0) kinds |= 1u << k;
  }
  return kinds;
}

const char* guard_name(StandardGuard kind) {
  switch (kind) {
    case StandardGuard::kLipsLeft: return "lips left";
    case StandardGuard::kLipsCenter: return "lips center";
    case StandardGuard::kLipsRight: return "lips right";
    case StandardGuard::kLipToTeeth: return "lower lip to teeth";
    case StandardGuard::kLidsLeft: return "left lids";
    case StandardGuard::kLidsRight: return "right lids";
    case StandardGuard::kTeeth: return "teeth";
    default: return "custom";
  }
}

uint32_t clip_layer_count(const MienMixDesc& desc) {
  uint32_t count = 0;
  for (size_t i = 0; i < desc.layer_count; ++i) {
    count += desc.layers[i].source == MIEN_LAYER_SOURCE_CLIP;
  }
  return count;
}

}  // namespace

MienStatus mien_mix_create(const MienRig* rig, const MienMixDesc* desc, MienMix** out_mix,
                           MienError* error) {
  if (MienStatus status = clear_output(out_mix, error)) return status;
  if (MienStatus status = check(rig)) return give_error(error, status, "not a rig");
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienMixDesc known;
  if (MienStatus status = read_desc(desc, known, "MienMixDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (MienStatus status = check_mix_desc(known, error)) return status;
  if (known.deformer) {
    if (MienStatus status = check(known.deformer)) {
      return give_error(error, status, "MienMixDesc.deformer is not a deformer");
    }
    if (object(known.deformer)->rig != object(rig)) {
      return give_error(error, MIEN_ERROR_MISMATCH, "MienMixDesc.deformer is of another rig");
    }
  }
  if (known.gaze) {
    if (MienStatus status = check(known.gaze)) {
      return give_error(error, status, "MienMixDesc.gaze is not a gaze");
    }
    if (object(known.gaze)->raw_count != object(rig)->raw_count) {
      return give_error(error, MIEN_ERROR_MISMATCH, "MienMixDesc.gaze is of another rig");
    }
  }

  Arena arena(allocator);
  MixLists lists;
  if (!lists.allocate(arena, known))
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a mix");
  lists.fill(known);
  const Rig& of = *object(rig);
  MixDesc mix;
  mix.kernels = of.kernels;
  mix.raw_count = of.raw_count;
  mix.names = of.names[static_cast<size_t>(Kind::kRawControl)];
  mix.variable_count = known.variable_count;
  const size_t curves = size_t{of.raw_count} + known.variable_count;
  mix.layers = lists.layers;
  mix.poses = lists.poses;
  mix.reactions = lists.reactions;
  mix.antagonists = lists.antagonists;
  if (known.mirror) mix.mirror = {known.mirror, curves};
  if (known.lower) mix.lower = {known.lower, curves};
  if (known.upper) mix.upper = {known.upper, curves};
  mix.player_count = known.player_count != 0 ? known.player_count : 2 * clip_layer_count(known);
  mix.max_channels = known.max_channels != 0 ? known.max_channels : of.raw_count;
  mix.max_changing_channels = known.max_changing_channels;
  if (mix.max_changing_channels == 0) {
    mix.max_changing_channels =
        mix.max_channels < kMaxChangingChannels ? mix.max_channels : kMaxChangingChannels;
  }
  mix.max_bound_gui = bound_gui_limit(of.gui_count);
  mix.plays_backward = known.reverse != 0;
  mix.max_events = known.max_events != 0 ? known.max_events : 64;
  Error detail;
  Guard guards[kMaxGuards];
  uint32_t guard_count = 0;
  if (known.guards != 0 || known.custom_guard_count != 0) {
    GuardDesc own[kMaxGuards];
    for (size_t g = 0; g < known.custom_guard_count; ++g) own[g] = guard_of(known.custom_guards[g]);
    const Status planned =
        plan_guards(*object(known.deformer), kinds_of(known.guards),
                    {own, known.custom_guard_count}, allocator, guards, guard_count, detail);
    if (planned != Status::kOk) return give_error(detail, error);
  }
  mix.guards = {guards, guard_count};
  if (known.gaze) mix.gaze = &object(known.gaze)->table;
  Mix* made = nullptr;
  const Status status = create_mix(mix, allocator, made, detail);
  return give_object(status, made, detail, out_mix, error);
}

void mien_mix_destroy(MienMix* mix) { destroy(mix); }

MienStatus mien_mix_info(const MienMix* mix, MienMixInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(mix)) return status;
  const Mix& of = *object(mix);
  MienMixInfo info = {};
  info.raw_control_count = of.raw_count;
  info.variable_count = of.variable_count;
  info.curve_count = of.used_curves();
  info.layer_count = static_cast<uint32_t>(of.layers.count);
  info.stage_count = stage_count(of);
  info.guard_count = static_cast<uint32_t>(of.guards.count);
  info.mixer_bytes = mixer_size(of, false);
  info.snapshot_bytes = snapshot_size(of);
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_mix_guard(const MienMix* mix, uint32_t guard_index, MienMixGuardInfo* out_guard) {
  if (MienStatus status = clear_struct(out_guard)) return status;
  if (MienStatus status = check(mix)) return status;
  const Span<const Guard> guards = object(mix)->guards;
  if (guard_index >= guards.count) return MIEN_ERROR_INDEX;
  const Guard& of = guards[guard_index];
  MienMixGuardInfo info = {};
  info.curves = {of.curves, of.count};
  info.gains = {of.gains, of.count};
  info.needs_speech = of.needs_speech;
  info.pair_count = of.pair_count;
  info.rest = of.rest;
  info.tolerance = of.tolerance;
  info.f_on = of.f_on;
  info.fit_error = of.fit_error;
  write_struct(out_guard, info);
  return MIEN_OK;
}

MienStatus mien_mix_glare(uint32_t first_pose, MienMixStroke* out_strokes, size_t stroke_count,
                          MienMixReaction* out_reaction) {
  if (out_reaction) *out_reaction = {};
  if (!out_strokes || !out_reaction) return MIEN_ERROR_NULL_ARGUMENT;
  if (stroke_count < kGlareStrokes) return MIEN_ERROR_INVALID_ARGUMENT;
  Stroke strokes[kGlareStrokes];
  glare_strokes(first_pose, strokes);
  const ReactionDesc reaction = glare_reaction(strokes);
  for (uint32_t i = 0; i < kGlareStrokes; ++i) {
    const Stroke& from = strokes[i];
    out_strokes[i] = {from.delay,  from.attack,
                      from.hold,   from.release,
                      from.pose,   static_cast<uint32_t>(from.mode),
                      from.held,   from.lags,
                      from.scaled, 0};
  }
  *out_reaction = {reaction.cooldown,
                   reaction.adapt_ticks,
                   reaction.recover_ticks,
                   out_strokes,
                   kGlareStrokes,
                   static_cast<uint32_t>(reaction.retrigger),
                   0,
                   reaction.adapted,
                   reaction.level_on,
                   reaction.level_off,
                   0};
  return MIEN_OK;
}

// Mixer -------------------------------------------------------------------------------------------

namespace {

/// The statuses that setting a number can return.
MienStatus status_of(Status status) {
  if (status == Status::kOk) return MIEN_OK;
  return status == Status::kIndex ? MIEN_ERROR_INDEX : MIEN_ERROR_INVALID_ARGUMENT;
}

MienStatus check_step(const MienMixer* mixer, const MienInstance* instance, int64_t ticks) {
  if (MienStatus status = check(mixer)) return status;
  if (ticks < 0 || ticks > kMaxStepTicks || object(mixer)->header->now > kMaxMixerTime - ticks) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  if (!instance) return MIEN_OK;
  if (MienStatus status = check(instance)) return status;
  return object(instance)->rig->raw_count == object(mixer)->mix->raw_count ? MIEN_OK
                                                                           : MIEN_ERROR_MISMATCH;
}

void step(MienMixer* mixer, MienInstance* instance, int64_t ticks) {
  Mixer& m = *object(mixer);
  step_mixer(m, ticks, instance ? object(instance)->controls.data : nullptr,
             instance ? m.mix->raw_count : 0, nullptr);
}

}  // namespace

MienStatus mien_mixer_create(const MienMix* mix, const MienMixerDesc* desc, MienMixer** out_mixer,
                             MienError* error) {
  if (MienStatus status = clear_output(out_mixer, error)) return status;
  if (MienStatus status = check(mix)) return give_error(error, status, "not a mix");
  MienMixerDesc known;
  if (MienStatus status = read_desc(desc, known, "MienMixerDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (known.reserved != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "MienMixerDesc.reserved is not 0");
  }
  Mixer* made = create_mixer(*object(mix), known.seed, known.stages != 0, allocator);
  if (!made) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a mixer");
  *out_mixer = reinterpret_cast<MienMixer*>(made);
  return succeed(error);
}

void mien_mixer_destroy(MienMixer* mixer) { destroy(mixer); }

MienStatus mien_mixer_play(MienMixer* mixer, uint32_t layer, const MienClip* clip,
                           const MienClipBinding* clip_binding, const MienPlayDesc* desc,
                           MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(mixer)) return give_error(error, status, "not a mixer");
  if (MienStatus status = check(clip)) return give_error(error, status, "not a clip");
  if (MienStatus status = check(clip_binding)) {
    return give_error(error, status, "not a binding of a clip");
  }
  MienPlayDesc known;
  if (MienStatus status = read_desc(desc, known, "MienPlayDesc", error)) return status;
  if (known.transition > MIEN_TRANSITION_CUT || known.looping > MIEN_LOOPING_WRAP ||
      known.interpolation > MIEN_INTERPOLATION_CATMULL_ROM) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienPlayDesc.transition, .looping or .interpolation is none of its values");
  }
  constexpr Transition kTransitions[] = {Transition::kInertial, Transition::kCrossfade,
                                         Transition::kCut};
  constexpr Looping kLoopings[] = {Looping::kAsClip, Looping::kOnce, Looping::kLoop};
  LayerPlayDesc play;
  play.transition = kTransitions[known.transition];
  play.transition_ticks = known.transition_ticks;
  play.mirrored = known.mirrored != 0;
  play.play.start_tick = known.start_tick;
  const bool has_speed = known.speed_numerator != 0 || known.speed_denominator != 0;
  play.play.speed_numerator = has_speed ? known.speed_numerator : 1;
  play.play.speed_denominator = has_speed ? known.speed_denominator : 1;
  play.play.looping = kLoopings[known.looping];
  play.play.interpolation = static_cast<Interpolation>(known.interpolation);
  Error detail;
  const Status status =
      play_clip(*object(mixer), layer, {known.clip_id, &object(clip)->view, object(clip_binding)},
                play, detail);
  return give_status(status, detail, error);
}

MienStatus mien_mixer_stop(MienMixer* mixer, uint32_t layer, int64_t fade_ticks) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(stop_layer(*object(mixer), layer, fade_ticks, detail));
}

MienStatus mien_mixer_set_weight(MienMixer* mixer, uint32_t layer, float weight,
                                 int64_t fade_ticks) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(set_layer_weight(*object(mixer), layer, weight, fade_ticks, detail));
}

MienStatus mien_mixer_set_pose_weight(MienMixer* mixer, uint32_t layer, uint32_t pose, float weight,
                                      int64_t fade_ticks) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(set_pose_weight(*object(mixer), layer, pose, weight, fade_ticks, detail));
}

MienStatus mien_mixer_set_variable(MienMixer* mixer, uint32_t variable, float value) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(set_variable(*object(mixer), variable, value, detail));
}

MienStatus mien_mixer_set_guard(MienMixer* mixer, uint32_t guard_index, float activation) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(set_guard(*object(mixer), guard_index, activation, detail));
}

MienStatus mien_mixer_guard(const MienMixer* mixer, uint32_t guard_index,
                            MienGuardState* out_state) {
  if (MienStatus status = clear_struct(out_state)) return status;
  if (MienStatus status = check(mixer)) return status;
  const Mixer& of = *object(mixer);
  GuardState found = {};
  Error detail;
  if (guard_state(of, guard_index, found, detail) != Status::kOk) return MIEN_ERROR_INDEX;
  const auto kind = static_cast<StandardGuard>(of.mix->guards[guard_index].kind);
  const char* name = guard_name(kind);
  MienGuardState state = {};
  state.name = {name, strlen(name)};
  state.controls = {found.curves.data, found.curves.count};
  state.kind = of.mix->guards[guard_index].kind < kStandardGuardCount ? guard_bit(kind) : 0;
  state.activation = found.activation;
  state.protected_distance = found.protected_distance;
  state.wanted = found.wanted;
  state.limit = found.limit;
  state.distance = found.distance;
  write_struct(out_state, state);
  return MIEN_OK;
}

MienStatus mien_mixer_trigger(MienMixer* mixer, uint32_t reaction, float strength,
                              int64_t hold_ticks) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(trigger(*object(mixer), reaction, strength,
                           hold_ticks < 0 ? kUntilReleased : hold_ticks, detail));
}

MienStatus mien_mixer_release(MienMixer* mixer, uint32_t reaction) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return end_stimulus(*object(mixer), reaction, detail) == Status::kOk ? MIEN_OK : MIEN_ERROR_INDEX;
}

MienStatus mien_mixer_set_level(MienMixer* mixer, uint32_t reaction, float level) {
  if (MienStatus status = check(mixer)) return status;
  Error detail;
  return status_of(set_level(*object(mixer), reaction, level, detail));
}

MienStatus mien_mixer_push(MienMixer* mixer, uint32_t layer, int64_t tick, const float* values,
                           size_t value_count, uint32_t* out_accepted) {
  if (out_accepted) *out_accepted = 0;
  if (MienStatus status = check(mixer)) return status;
  if (!values && value_count != 0) return MIEN_ERROR_NULL_ARGUMENT;
  Error detail;
  bool accepted = false;
  const Status status =
      push_row(*object(mixer), layer, tick, {values, value_count}, &accepted, detail);
  if (out_accepted) *out_accepted = accepted;
  return status == Status::kMismatch ? MIEN_ERROR_MISMATCH : status_of(status);
}

MienStatus mien_mixer_step(MienMixer* mixer, int64_t ticks, MienInstance* instance) {
  if (MienStatus status = check_step(mixer, instance, ticks)) return status;
  step(mixer, instance, ticks);
  return MIEN_OK;
}

MienStatus mien_mixer_step_batch(MienMixer* const* mixers, MienInstance* const* instances,
                                 size_t count, int64_t ticks) {
  if (!mixers && count != 0) return MIEN_ERROR_NULL_ARGUMENT;
  for (size_t i = 0; i < count; ++i) {
    if (MienStatus status = check_step(mixers[i], instances ? instances[i] : nullptr, ticks)) {
      return status;
    }
  }
  size_t marked = 0;
  while (marked < count && !object(mixers[marked])->in_batch) {
    object(mixers[marked++])->in_batch = true;
  }
  for (size_t i = 0; i < marked; ++i) object(mixers[i])->in_batch = false;
  if (marked < count) return MIEN_ERROR_INVALID_ARGUMENT;
  for (size_t i = 0; i < count; ++i) step(mixers[i], instances ? instances[i] : nullptr, ticks);
  return MIEN_OK;
}

// Looking into it ---------------------------------------------------------------------------------

MienStatus mien_mixer_row(const MienMixer* mixer, MienFloatView* out_row) {
  if (!out_row) return MIEN_ERROR_NULL_ARGUMENT;
  *out_row = {};
  if (MienStatus status = check(mixer)) return status;
  *out_row = {object(mixer)->row.data, object(mixer)->mix->used_curves()};
  return MIEN_OK;
}

MienStatus mien_mixer_stage(const MienMixer* mixer, uint32_t stage, MienFloatView* out_row) {
  if (!out_row) return MIEN_ERROR_NULL_ARGUMENT;
  *out_row = {};
  if (MienStatus status = check(mixer)) return status;
  const Mixer& of = *object(mixer);
  if (!of.stages) return MIEN_ERROR_INVALID_ARGUMENT;
  if (stage >= stage_count(*of.mix)) return MIEN_ERROR_INDEX;
  *out_row = {of.stages + size_t{stage} * of.mix->curve_count, of.mix->used_curves()};
  return MIEN_OK;
}

MienStatus mien_mixer_info(const MienMixer* mixer, MienMixerInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(mixer)) return status;
  const Mixer& of = *object(mixer);
  MienMixerInfo info = {};
  info.tick = of.header->now;
  info.event_count = of.event_count;
  info.lost_events = of.lost_events;
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_mixer_event(const MienMixer* mixer, uint32_t index, MienClipEvent* out_event,
                            uint32_t* out_layer) {
  if (out_event) *out_event = {};
  if (out_layer) *out_layer = 0;
  if (!out_event || !out_layer) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(mixer)) return status;
  const Mixer& of = *object(mixer);
  if (index >= of.event_count) return MIEN_ERROR_INDEX;
  const MixEvent& event = of.events[index];
  *out_event = {
      event.event.tick, {event.event.name.data, event.event.name.count}, event.event.value, 0};
  *out_layer = event.layer;
  return MIEN_OK;
}

MienStatus mien_mixer_snapshot(MienMixer* mixer, void* buffer, size_t capacity, size_t* out_size,
                               MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  if (MienStatus status = check(mixer)) return give_error(error, status, "not a mixer");
  *out_size = snapshot_size(*object(mixer)->mix);
  if (!buffer) return succeed(error);
  Error detail;
  const Status status =
      take_snapshot(*object(mixer), {static_cast<uint8_t*>(buffer), capacity}, detail);
  return give_status(status, detail, error);
}

MienStatus mien_mixer_restore(MienMixer* mixer, const void* bytes, size_t size,
                              const MienMixerClip* clips, size_t clip_count, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if ((!bytes && size != 0) || (!clips && clip_count != 0)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes or clips is NULL");
  }
  if (MienStatus status = check(mixer)) return give_error(error, status, "not a mixer");
  // A mixer plays few clips at a time, so the caller's clips are searched one by one.
  const auto find = [](const void* user, uint64_t id, ClipSource& source) {
    const auto& list = *static_cast<const Span<const MienMixerClip>*>(user);
    for (const MienMixerClip& clip : list) {
      if (clip.clip_id != id || check(clip.clip) != MIEN_OK ||
          check(clip.clip_binding) != MIEN_OK) {
        continue;
      }
      source = {id, &object(clip.clip)->view, object(clip.clip_binding)};
      return true;
    }
    return false;
  };
  const Span<const MienMixerClip> list = {clips, clip_count};
  Error detail;
  const Status status = restore_snapshot(*object(mixer), {static_cast<const uint8_t*>(bytes), size},
                                         {&list, find}, detail);
  return give_status(status, detail, error);
}
