// SPDX-License-Identifier: MIT
// Clips, their players and bindings. mien.h is the manual.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "capi/handles.h"
#include "runtime/anim/arkit_table.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_ERROR_CLIP_SIGNATURE == int(Status::kClipSignature) &&
                  MIEN_ERROR_CLIP_LIMIT == int(Status::kClipLimit),
              "status.h and mien.h number the same statuses");
static_assert(MIEN_LOOPING_WRAP == 2 && MIEN_INTERPOLATION_STEP == int(Interpolation::kStep) &&
                  MIEN_INTERPOLATION_CATMULL_ROM == int(Interpolation::kCatmullRom),
              "clip_sampler.h and mien.h number the same choices");
static_assert(MIEN_TICKS_PER_SECOND == kTicksPerSecond, "one unit of time");

// Building ----------------------------------------------------------------------------------------

namespace {

/// An empty clip with room for `report_count` reports.
MienStatus new_clip(const Allocator& allocator, size_t report_count, MienClip*& out,
                    MienError* error) {
  out = create_block<MienClip>(allocator, [&](Placer& placer, MienClip& clip) {
    clip.reports = placer.array<ChannelReport>(report_count);
  });
  return out ? MIEN_OK : give_error(error, MIEN_ERROR_MEMORY, "no memory for a clip");
}

/// Checks the bytes; then passes `clip` to the caller, or releases it on failure.
MienStatus finish_clip(MienClip* clip, const uint8_t* bytes, size_t size, MienClip** out_clip,
                       MienError* error) {
  Error detail;
  if (open_clip(bytes, size, clip->view, detail) != Status::kOk) {
    release_clip_handle(clip);
    return give_error(detail, error);
  }
  clip->tag = kClipTag;
  *out_clip = clip;
  return succeed(error);
}

/// n of a step of 2^-n; kNoSnap for 0, 1 for an invalid step.
uint8_t snap_of(float step) {
  if (step == 0) return kNoSnap;
  for (uint32_t n = kMinSnap; n <= kMaxSnap; ++n) {
    if (step == 1.0f / static_cast<float>(1u << n)) return static_cast<uint8_t>(n);
  }
  return 1;
}

Span<const char> text(const MienStringView& view) { return {view.data, view.count}; }

/// The caller's lists in the form of the builder, in memory that lasts for the call.
struct BuildLists {
  Allocator allocator;
  size_t block_size = 0;
  Span<Span<const char>> names, event_names;
  Span<uint8_t> snaps;
  Span<ClipEventDesc> events;
  Span<uint32_t> by_name;  // events

  void place(Placer& placer, const MienClipDesc& desc) {
    names = placer.array<Span<const char>>(desc.channel_count);
    event_names = placer.array<Span<const char>>(desc.event_count);
    snaps = placer.array<uint8_t>(desc.channel_count);
    events = placer.array<ClipEventDesc>(desc.event_count);
    by_name = placer.array<uint32_t>(desc.event_count);
  }

  void fill(const MienClipDesc& desc) {
    for (uint32_t c = 0; c < desc.channel_count; ++c) {
      names[c] = text(desc.names[c]);
      snaps[c] = snap_of(desc.snaps ? desc.snaps[c] : desc.snap);
    }
    // Each name is stored once, however many events have it.
    for (uint32_t e = 0; e < desc.event_count; ++e) by_name[e] = e;
    std::sort(by_name.begin(), by_name.end(), [&](uint32_t a, uint32_t b) {
      return compare_names(text(desc.events[a].name), text(desc.events[b].name)) < 0;
    });
    uint32_t name_count = 0;
    for (uint32_t e : by_name) {
      const Span<const char> name = text(desc.events[e].name);
      if (name_count == 0 || compare_names(event_names[name_count - 1], name) != 0) {
        event_names[name_count++] = name;
      }
      events[e] = {desc.events[e].tick, name_count - 1, desc.events[e].value};
    }
    event_names.count = name_count;
  }
};

/// Checks that the builder cannot make, because it takes spans.
MienStatus check_clip_desc(const MienClipDesc& desc, MienError* error) {
  if ((desc.channel_count != 0 && (!desc.names || !desc.values)) ||
      (desc.event_count != 0 && !desc.events)) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienClipDesc.names, .values or .events is NULL, but its count is not 0");
  }
  for (uint32_t c = 0; c < desc.channel_count; ++c) {
    if (desc.names[c].count != 0 && !desc.names[c].data) {
      return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "the name of channel %u is NULL", c);
    }
  }
  for (uint32_t e = 0; e < desc.event_count; ++e) {
    if (desc.events[e].name.count != 0 && !desc.events[e].name.data) {
      return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "the name of event %u is NULL", e);
    }
  }
  const MienStatus in_range =
      check_fields({{"MienClipDesc.looping", desc.looping, MIEN_LOOPING_WRAP}}, error);
  if (in_range != MIEN_OK) return in_range;
  for (uint32_t c = 0; c < (desc.snaps ? desc.channel_count : 1); ++c) {
    const float step = desc.snaps ? desc.snaps[c] : desc.snap;
    if (snap_of(step) != 1) continue;
    char index[16] = "";
    if (desc.snaps) snprintf(index, sizeof(index), "s[%u]", c);
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "MienClipDesc.snap%s is %g; valid steps are 0 and the powers of two from 2^-16 "
        "to 2^-9",
        index, static_cast<double>(step));
  }
  return MIEN_OK;
}

}  // namespace

MienStatus mien_clip_build(const MienClipDesc* desc, MienClip** out_clip, MienError* error) {
  if (MienStatus status = clear_output(out_clip, error)) return status;
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienClipDesc known;
  if (MienStatus status = read_desc(desc, known, "MienClipDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (MienStatus status = check_clip_desc(known, error)) return status;
  MienClip* clip = nullptr;
  if (MienStatus status = new_clip(allocator, known.channel_count, clip, error)) return status;

  auto* const lists = create_block<BuildLists>(
      allocator, [&](Placer& placer, BuildLists& made) { made.place(placer, known); });
  if (!lists) {
    release_clip_handle(clip);
    return give_error(error, MIEN_ERROR_MEMORY, "no memory to build a clip");
  }
  lists->fill(known);

  ClipDesc build;
  const bool has_rate = known.rate_numerator != 0;
  build.rate_numerator = has_rate ? known.rate_numerator : 60;
  build.rate_denominator = known.rate_denominator != 0 ? known.rate_denominator : 1;
  build.frame_count = known.frame_count;
  build.values = known.values;
  build.frame_stride = known.frame_stride;
  build.names = lists->names;
  build.snaps = lists->snaps;
  build.events = lists->events;
  build.event_names = lists->event_names;
  build.wraps = known.looping == MIEN_LOOPING_WRAP;
  build.is_delta = known.is_delta != 0;
  Error detail;
  const Status built = build_clip(build, allocator, clip->reports, clip->own, detail);
  release_block(lists);
  if (built != Status::kOk) {
    release_clip_handle(clip);
    return give_error(detail, error);
  }
  return finish_clip(clip, clip->own.bytes, clip->own.size, out_clip, error);
}

// Opening and writing -----------------------------------------------------------------------------

namespace {

MienStatus read_open_desc(const MienClipOpenDesc* desc, MienClipOpenDesc& known,
                          Allocator& allocator, MienError* error) {
  if (MienStatus status = read_desc(desc, known, "MienClipOpenDesc", error)) return status;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  return check_fields({{"MienClipOpenDesc.file_access", known.file_access, MIEN_FILE_READ},
                       {"MienClipOpenDesc.reserved", known.reserved, 0}},
                      error);
}

}  // namespace

namespace mien::capi {

void release_clip_handle(const MienClip* clip) {
  if (clip->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  auto* last = const_cast<MienClip*>(clip);
  last->tag = 0;
  if (last->file.bytes) close_file(last->file);
  release_clip(last->own);
  release_block(last);
}

}  // namespace mien::capi

MienStatus mien_clip_open_file(const char* path, const MienClipOpenDesc* desc, MienClip** out_clip,
                               MienError* error) {
  if (MienStatus status = clear_output(out_clip, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  MienClipOpenDesc known;
  Allocator allocator;
  if (MienStatus status = read_open_desc(desc, known, allocator, error)) return status;
  MienClip* clip = nullptr;
  if (MienStatus status = new_clip(allocator, 0, clip, error)) return status;
  Error detail;
  if (open_file(path, static_cast<FileAccess>(known.file_access), {kClipMagic, sizeof(kClipMagic)},
                allocator, clip->file, detail) != Status::kOk) {
    release_clip_handle(clip);
    return give_error(detail, error);
  }
  return finish_clip(clip, clip->file.bytes, clip->file.size, out_clip, error);
}

MienStatus mien_clip_open_memory(const void* bytes, size_t size, const MienClipOpenDesc* desc,
                                 MienClip** out_clip, MienError* error) {
  if (MienStatus status = clear_output(out_clip, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  MienClipOpenDesc known;
  Allocator allocator;
  if (MienStatus status = read_open_desc(desc, known, allocator, error)) return status;
  MienClip* clip = nullptr;
  if (MienStatus status = new_clip(allocator, 0, clip, error)) return status;
  return finish_clip(clip, static_cast<const uint8_t*>(bytes), size, out_clip, error);
}

MienStatus mien_clip_open_stream(const MienStream* stream, const MienClipOpenDesc* desc,
                                 MienClip** out_clip, MienError* error) {
  if (MienStatus status = clear_output(out_clip, error)) return status;
  if (!stream || !stream->read) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "stream or stream->read is NULL");
  }
  MienClipOpenDesc known;
  Allocator allocator;
  if (MienStatus status = read_open_desc(desc, known, allocator, error)) return status;
  MienClip* clip = nullptr;
  if (MienStatus status = new_clip(allocator, 0, clip, error)) return status;
  if (stream->size != 0) {
    const bool fits = stream->size <= SIZE_MAX / 2;
    const size_t size = fits ? static_cast<size_t>(stream->size) : 0;
    void* block = fits ? allocator.get(size, kBlockAlignment) : nullptr;
    if (!block) {
      release_clip_handle(clip);
      return give_error(error, MIEN_ERROR_MEMORY, "no memory for a clip of %llu bytes",
                        static_cast<unsigned long long>(stream->size));
    }
    clip->own = {allocator, static_cast<uint8_t*>(block), size};
    if (stream->read(stream->user, 0, block, size) != size) {
      release_clip_handle(clip);
      return give_error(error, MIEN_ERROR_FILE_READ,
                        "the read function of the stream gave fewer than the %zu bytes asked for",
                        size);
    }
  }
  return finish_clip(clip, clip->own.bytes, clip->own.size, out_clip, error);
}

void mien_clip_close(MienClip* clip) {
  if (check(clip) != MIEN_OK) return;
  clip->tag = 0;
  release_clip_handle(clip);
}

MienStatus mien_clip_write_file(const MienClip* clip, const char* path, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  if (MienStatus status = check(clip, "clip", error)) return status;
  Error detail;
  const Status status =
      write_file(path, clip->view.bytes, clip->view.size, clip->allocator, detail);
  return status == Status::kOk ? succeed(error) : give_error(detail, error);
}

MienStatus mien_clip_write_memory(const MienClip* clip, void* buffer, size_t capacity,
                                  size_t* out_size, MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  if (MienStatus status = check(clip, "clip", error)) return status;
  const size_t size = clip->view.size;
  *out_size = size;
  if (!buffer) return succeed(error);
  if (capacity < size) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "the clip has %zu bytes, the buffer %zu: call again with a buffer of this size", size,
        capacity);
  }
  memcpy(buffer, clip->view.bytes, size);
  return succeed(error);
}

// Looking into it ---------------------------------------------------------------------------------

namespace {

MienStringView view_of(Span<const char> name) { return {name.data, name.count}; }

MienClipEvent event_of(const ClipEvent& event) {
  return {event.tick, view_of(event.name), event.value, 0};
}

SamplerLimits limits_of(const Clip& clip, bool reverse) {
  return {clip.channel_count, clip.changing_count, reverse};
}

struct PlacePlayer {
  SamplerLimits limits;
  void operator()(Placer& placer, MienClipPlayer& player) const {
    place_clip_sampler(placer, limits, player.sampler);
  }
};

}  // namespace

MienStatus mien_clip_info(const MienClip* handle, MienClipInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(handle)) return status;
  const Clip& clip = handle->view;
  const bool wraps = clip.has(kClipWraps);
  MienClipInfo info = {};
  info.rate_numerator = clip.rate_numerator;
  info.rate_denominator = clip.rate_denominator;
  info.frame_count = clip.frame_count;
  info.channel_count = clip.channel_count;
  info.changing_channel_count = clip.changing_count;
  info.event_count = clip.event_count;
  info.looping = wraps ? MIEN_LOOPING_WRAP : MIEN_LOOPING_CLAMP;
  info.is_delta = clip.has(kClipIsDelta);
  info.snap = clip.snap == kNoSnap ? 0 : 1.0f / static_cast<float>(1u << clip.snap);
  info.is_mapped = handle->file.mapped;
  info.ticks_per_frame = clip.ticks_per_frame;
  info.length = clip.length(wraps);
  info.file_bytes = clip.size;
  info.memory_bytes = handle->block_size + handle->file.capacity + handle->own.size;
  info.player_bytes = block_bytes<MienClipPlayer>(PlacePlayer{limits_of(clip, false)});
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_clip_channel(const MienClip* handle, uint32_t index, MienClipChannel* out_channel) {
  if (MienStatus status = clear_struct(out_channel)) return status;
  if (MienStatus status = check(handle)) return status;
  const Clip& clip = handle->view;
  if (index >= clip.channel_count) return MIEN_ERROR_INDEX;
  MienClipChannel channel = {};
  channel.name = view_of(clip.name(index));
  channel.rest = clip.rest(index);
  uint32_t begin = 0, end = clip.changing_count;
  while (begin < end) {
    const uint32_t middle = (begin + end) / 2;
    if (clip.changing(middle) < index) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  channel.is_changing = begin < clip.changing_count && clip.changing(begin) == index;
  if (!handle->reports.empty()) {
    const ChannelReport& report = handle->reports[index];
    channel.zero_blocks = report.blocks[kBlockZero];
    channel.constant_blocks = report.blocks[kBlockConstant];
    channel.grid_blocks = report.blocks[kBlockGrid];
    channel.float_blocks = report.blocks[kBlockFloat];
    channel.bits = report.bits;
    channel.max_error = report.max_error;
  }
  write_struct(out_channel, channel);
  return MIEN_OK;
}

MienStatus mien_clip_find_channel_n(const MienClip* clip, const char* name, size_t name_count,
                                    uint32_t* out_index) {
  if (!out_index) return MIEN_ERROR_NULL_ARGUMENT;
  *out_index = 0;
  if (MienStatus status = check(clip)) return status;
  if (!name && name_count != 0) return MIEN_ERROR_NULL_ARGUMENT;
  const uint32_t found = find_channel(clip->view, {name, name_count});
  if (found == kNoChannel) return MIEN_ERROR_NAME;
  *out_index = found;
  return MIEN_OK;
}

MienStatus mien_clip_find_channel(const MienClip* clip, const char* name, uint32_t* out_index) {
  if (out_index) *out_index = 0;
  if (!name) return MIEN_ERROR_NULL_ARGUMENT;
  return mien_clip_find_channel_n(clip, name, strlen(name), out_index);
}

MienStatus mien_clip_event(const MienClip* clip, uint32_t index, MienClipEvent* out_event) {
  if (!out_event) return MIEN_ERROR_NULL_ARGUMENT;
  *out_event = {};
  if (MienStatus status = check(clip)) return status;
  if (index >= clip->view.event_count) return MIEN_ERROR_INDEX;
  *out_event = event_of(clip->view.event(index));
  return MIEN_OK;
}

MienStatus mien_clip_verify(const MienClip* clip, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(clip, "clip", error)) return status;
  Error detail;
  return verify_clip(clip->view, detail) == Status::kOk ? succeed(error)
                                                        : give_error(detail, error);
}

MienStatus mien_clip_read(const MienClip* handle, uint32_t first_frame, uint32_t frame_count,
                          float* out_values, size_t frame_stride, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(handle, "clip", error)) return status;
  const Clip& clip = handle->view;
  if (!out_values && frame_count != 0 && clip.channel_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "out_values is NULL");
  }
  if (frame_stride != 0 && frame_stride < clip.channel_count) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "frame_stride is %zu, a frame has %u channels", frame_stride,
                      clip.channel_count);
  }
  if (first_frame > clip.frame_count || frame_count > clip.frame_count - first_frame) {
    return give_error(error, MIEN_ERROR_INDEX, "%u frames from frame %u on: the clip has %u",
                      frame_count, first_frame, clip.frame_count);
  }
  const size_t stride = frame_stride == 0 ? clip.channel_count : frame_stride;
  if (read_frames(clip, first_frame, frame_count, out_values, stride)) return succeed(error);
  return give_error(error, MIEN_ERROR_CLIP_STRUCTURE,
                    "a curve is damaged; fetch the clip again or build it again");
}

// Player ------------------------------------------------------------------------------------------

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

  auto* const player = create_block<MienClipPlayer>(
      allocator, PlacePlayer{limits_of(clip->view, known.reverse != 0)});
  if (!player) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a player of a clip");
  Error detail;
  if (start_clip(player->sampler, clip->view, play, detail) != Status::kOk) {
    release_block(player);
    return give_error(detail, error);
  }
  player->clip = clip;
  clip->owners.fetch_add(1, std::memory_order_relaxed);
  player->tag = kClipPlayerTag;
  *out_clip_player = player;
  return succeed(error);
}

void mien_clip_player_destroy(MienClipPlayer* player) {
  if (check(player) != MIEN_OK) return;
  const MienClip* clip = player->clip;
  player->tag = 0;
  release_block(player);
  release_clip_handle(clip);
}

MienStatus mien_clip_player_info(const MienClipPlayer* player, MienClipPlayerInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(player)) return status;
  const ClipSampler& sampler = player->sampler;
  MienClipPlayerInfo info = {};
  info.tick = sampler.tick;
  info.loops = sampler.loops;
  info.looping = sampler.wraps ? MIEN_LOOPING_WRAP : MIEN_LOOPING_CLAMP;
  info.is_damaged = sampler.decoder.damaged;
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_clip_player_seek(MienClipPlayer* player, int64_t tick) {
  if (MienStatus status = check(player)) return status;
  seek_clip(player->sampler, tick);
  player->events = {};
  return MIEN_OK;
}

MienStatus mien_clip_player_set_speed(MienClipPlayer* player, int32_t numerator,
                                      int32_t denominator) {
  if (MienStatus status = check(player)) return status;
  Error detail;
  const Status status = set_clip_speed(player->sampler, numerator, denominator, detail);
  return status == Status::kOk ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

MienStatus mien_clip_player_advance(MienClipPlayer* player, int64_t ticks) {
  if (MienStatus status = check(player)) return status;
  if (ticks < -kMaxStepTicks || ticks > kMaxStepTicks) return MIEN_ERROR_INVALID_ARGUMENT;
  player->events = advance_clip(player->sampler, ticks);
  return MIEN_OK;
}

MienStatus mien_clip_player_next_event(MienClipPlayer* player, MienClipEvent* out_event,
                                       uint32_t* out_found) {
  if (out_event) *out_event = {};
  if (out_found) *out_found = 0;
  if (!out_event || !out_found) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(player)) return status;
  ClipEvent event = {};
  if (!player->events.clip || !next_event(player->events, event)) return MIEN_OK;
  *out_event = event_of(event);
  *out_found = 1;
  return MIEN_OK;
}

MienStatus mien_clip_player_sample(MienClipPlayer* player, MienFloatView* out_values) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  *out_values = {};
  if (MienStatus status = check(player)) return status;
  const Span<const float> values = sample_clip(player->sampler);
  *out_values = {values.data, values.count};
  return MIEN_OK;
}

// Binding -----------------------------------------------------------------------------------------

namespace {

MienStatus new_binding(const Clip& clip, const Rig& rig, const MienClipBindingDesc& desc,
                       const Allocator& allocator, MienClipBinding* out, MienError* error) {
  const size_t scratch_size = desc.matrix_count * sizeof(MatrixEntry) + kBlockAlignment;
  void* scratch = allocator.get(scratch_size, kBlockAlignment);
  if (!scratch) return give_error(error, MIEN_ERROR_MEMORY, "no memory to bind a clip");
  auto* matrix = static_cast<MatrixEntry*>(scratch);
  for (size_t e = 0; e < desc.matrix_count; ++e) {
    const MienMatrixEntry& entry = desc.matrix[e];
    new (&matrix[e]) MatrixEntry{text(entry.channel), text(entry.control), entry.weight};
  }
  Error detail;
  const Status bound =
      bind_clip(clip, rig, {matrix, desc.matrix_count}, allocator, out->binding, detail);
  allocator.put(scratch, scratch_size, kBlockAlignment);
  if (bound != Status::kOk) return give_error(detail, error);
  if (out->binding->gui_count <= kMaxBoundGuiControls) return MIEN_OK;
  return give_error(error, MIEN_ERROR_CLIP_LIMIT,
                    "the channels drive %u GUI controls, %u is the limit; bind raw controls",
                    out->binding->gui_count - 1, kMaxBoundGuiControls - 1);
}

void release(MienClipBinding* binding) {
  const Allocator allocator = binding->allocator;
  release_binding(binding->binding);
  binding->~MienClipBinding();
  allocator.put(binding, sizeof(MienClipBinding), kBlockAlignment);
}

MienIndex16View view_of(Span<const uint16_t> list) { return {list.data, list.count}; }

}  // namespace

MienStatus mien_clip_binding_create(const MienClip* clip, const MienRig* rig,
                                    const MienClipBindingDesc* desc,
                                    MienClipBinding** out_clip_binding, MienError* error) {
  if (MienStatus status = clear_output(out_clip_binding, error)) return status;
  if (MienStatus status = check(clip, "clip", error)) return status;
  if (MienStatus status = check(rig, "rig", error)) return status;
  MienClipBindingDesc known;
  if (MienStatus status = read_desc(desc, known, "MienClipBindingDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (!known.matrix && known.matrix_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT,
                      "MienClipBindingDesc.matrix is NULL, but .matrix_count is %zu",
                      known.matrix_count);
  }
  if (known.matrix_count > UINT32_MAX / 2) {
    return give_error(error, MIEN_ERROR_CLIP_LIMIT,
                      "MienClipBindingDesc.matrix_count is %zu; at most %u are supported",
                      known.matrix_count, UINT32_MAX / 2);
  }
  for (size_t e = 0; e < known.matrix_count; ++e) {
    const MienMatrixEntry& entry = known.matrix[e];
    if ((entry.channel.data || entry.channel.count == 0) &&
        (entry.control.data || entry.control.count == 0)) {
      continue;
    }
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "entry %zu of the matrix: a name is NULL",
                      e);
  }
  void* block = allocator.get(sizeof(MienClipBinding), kBlockAlignment);
  if (!block) return give_error(error, MIEN_ERROR_MEMORY, "no memory to bind a clip");
  auto* made = new (block) MienClipBinding;
  made->allocator = allocator;
  if (MienStatus status = new_binding(clip->view, *object(rig), known, allocator, made, error)) {
    release(made);
    return status;
  }
  made->tag = kClipBindingTag;
  *out_clip_binding = made;
  return succeed(error);
}

MienStatus mien_arkit_matrix(MienMatrixEntry* out_entries, size_t capacity, size_t* out_count) {
  if (!out_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_count = 0;
  if (!out_entries && capacity != 0) return MIEN_ERROR_NULL_ARGUMENT;
  const Span<const ArkitEntry> table = arkit_table();
  *out_count = table.count;
  for (size_t i = 0; i < table.count && i < capacity; ++i) {
    const ArkitEntry& from = table[i];
    out_entries[i] = {{from.expression, strlen(from.expression)},
                      {from.control, strlen(from.control)},
                      from.weight,
                      0};
  }
  return MIEN_OK;
}

void mien_clip_binding_destroy(MienClipBinding* binding) {
  if (check(binding) != MIEN_OK) return;
  binding->tag = 0;
  release(binding);
}

MienStatus mien_clip_binding_info(const MienClipBinding* handle, MienClipBindingInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(handle)) return status;
  const Binding& binding = *handle->binding;
  MienClipBindingInfo info = {};
  info.channel_count = binding.channel_count;
  info.raw_control_count = binding.raw_count;
  info.missing_entry_count = binding.missing_entries;
  info.controls = view_of(binding.controls);
  info.extra_controls = view_of(binding.extra_controls);
  info.missing_channels = view_of(binding.missing_channels);
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_clip_binding_apply(const MienClipBinding* handle, const float* values,
                                   size_t value_count, float* raw_controls,
                                   size_t raw_control_count) {
  if (MienStatus status = check(handle)) return status;
  const Binding& binding = *handle->binding;
  if ((!values && value_count != 0) || (!raw_controls && raw_control_count != 0)) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (value_count != binding.channel_count || raw_control_count != binding.raw_count) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  float gui[kMaxBoundGuiControls];
  apply_binding(binding, {values, value_count}, {gui, kMaxBoundGuiControls},
                {raw_controls, raw_control_count});
  return MIEN_OK;
}
