// SPDX-License-Identifier: MIT
// The section "Mixer" of mien/mix.h.
#include <cstring>

#include "capi/handles.h"

using namespace mien;
using namespace mien::capi;

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
  const uint32_t kind = of.mix->guards[guard_index].kind;
  const char* name = guard_name(kind);
  MienGuardState state = {};
  state.name = {name, strlen(name)};
  state.controls = {found.curves.data, found.curves.count};
  state.kind = guard_group(kind);
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
  *out_event = view_of(event.event);
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
