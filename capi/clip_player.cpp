// SPDX-License-Identifier: MIT
// The section "Clip player" of mien/clip.h.
#include "capi/handles.h"

using namespace mien;
using namespace mien::capi;

MienStatus mien_clip_player_create(const MienClip* clip, const MienClipPlayerDesc* desc,
                                   MienClipPlayer** out_clip_player, MienError* error) {
  if (MienStatus status = clear_output(out_clip_player, error)) return status;
  if (MienStatus status = check(clip, "clip", error)) return status;
  MienClipPlayerDesc known;
  if (MienStatus status = read_desc(desc, known, "MienClipPlayerDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  const MienStatus in_range = check_fields(
      {{"MienClipPlayerDesc.looping", known.looping, MIEN_LOOPING_WRAP},
       {"MienClipPlayerDesc.interpolation", known.interpolation, MIEN_INTERPOLATION_CATMULL_ROM},
       {"MienClipPlayerDesc.reserved", known.reserved, 0}},
      error);
  if (in_range != MIEN_OK) return in_range;
  PlayDesc play;
  play.start_tick = known.start_tick;
  const bool has_speed = known.speed_numerator != 0 || known.speed_denominator != 0;
  play.speed_numerator = has_speed ? known.speed_numerator : 1;
  play.speed_denominator = has_speed ? known.speed_denominator : 1;
  play.interpolation = static_cast<Interpolation>(known.interpolation);
  constexpr Looping kLoopings[] = {Looping::kAsClip, Looping::kOnce, Looping::kLoop};
  play.looping = kLoopings[known.looping];

  ClipPlayer* player = nullptr;
  Error detail;
  const Status status =
      create_clip_player(*object(clip), play, known.reverse != 0, allocator, player, detail);
  return give_object(status, player, detail, out_clip_player, error);
}

void mien_clip_player_destroy(MienClipPlayer* clip_player) { destroy(clip_player); }

MienStatus mien_clip_player_info(const MienClipPlayer* clip_player, MienClipPlayerInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(clip_player)) return status;
  const ClipSampler& sampler = object(clip_player)->sampler;
  MienClipPlayerInfo info = {};
  info.tick = sampler.tick;
  info.loops = sampler.loops;
  info.looping = sampler.wraps ? MIEN_LOOPING_WRAP : MIEN_LOOPING_CLAMP;
  info.is_damaged = sampler.decoder.damaged;
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_clip_player_seek(MienClipPlayer* clip_player, int64_t tick) {
  if (MienStatus status = check(clip_player)) return status;
  seek_clip(object(clip_player)->sampler, tick);
  object(clip_player)->events = {};
  return MIEN_OK;
}

MienStatus mien_clip_player_set_speed(MienClipPlayer* clip_player, int32_t numerator,
                                      int32_t denominator) {
  if (MienStatus status = check(clip_player)) return status;
  Error detail;
  const Status status =
      set_clip_speed(object(clip_player)->sampler, numerator, denominator, detail);
  return status == Status::kOk ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

MienStatus mien_clip_player_advance(MienClipPlayer* clip_player, int64_t ticks) {
  if (MienStatus status = check(clip_player)) return status;
  if (ticks < -kMaxStepTicks || ticks > kMaxStepTicks) return MIEN_ERROR_INVALID_ARGUMENT;
  object(clip_player)->events = advance_clip(object(clip_player)->sampler, ticks);
  return MIEN_OK;
}

MienStatus mien_clip_player_next_event(MienClipPlayer* clip_player, MienClipEvent* out_event,
                                       uint32_t* out_found) {
  if (out_event) *out_event = {};
  if (out_found) *out_found = 0;
  if (!out_event || !out_found) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(clip_player)) return status;
  ClipEvent event = {};
  EventRange& events = object(clip_player)->events;
  if (!events.clip || !next_event(events, event)) return MIEN_OK;
  *out_event = view_of(event);
  *out_found = 1;
  return MIEN_OK;
}

MienStatus mien_clip_player_sample(MienClipPlayer* clip_player, MienFloatView* out_values) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  *out_values = {};
  if (MienStatus status = check(clip_player)) return status;
  const Span<const float> values = sample_clip(object(clip_player)->sampler);
  *out_values = {values.data, values.count};
  return MIEN_OK;
}
