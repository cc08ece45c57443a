// SPDX-License-Identifier: MIT
// The section "Clips" of mien/clip.h.
#include <cstdio>

#include "capi/handles.h"
#include "runtime/anim/arkit_table.h"
#include "runtime/anim/event_names.h"

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

/// The caller's lists in the form of the builder, in the arena. False if memory ran out.
bool read_lists(const MienClipDesc& desc, Arena& arena, ClipDesc& out) {
  const auto names = arena.array<Span<const char>>(desc.channel_count);
  const auto snaps = arena.array<uint8_t>(desc.channel_count);
  const auto event_names = arena.array<Span<const char>>(desc.event_count);
  const auto events = arena.array<ClipEventDesc>(desc.event_count);
  if (names.count != desc.channel_count || snaps.count != desc.channel_count ||
      event_names.count != desc.event_count || events.count != desc.event_count) {
    return false;
  }
  for (uint32_t c = 0; c < desc.channel_count; ++c) {
    names[c] = span_of(desc.names[c]);
    snaps[c] = snap_of_step(desc.snaps ? desc.snaps[c] : desc.snap);
  }
  for (uint32_t e = 0; e < desc.event_count; ++e) {
    event_names[e] = span_of(desc.events[e].name);
    events[e] = {desc.events[e].tick, 0, desc.events[e].value};
  }
  out.names = names;
  out.snaps = snaps;
  return list_event_names(event_names, events, arena, out);
}

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
    if (snap_of_step(step) != kInvalidSnap) continue;
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

  ClipDesc build;
  const bool has_rate = known.rate_numerator != 0;
  build.rate_numerator = has_rate ? known.rate_numerator : 60;
  build.rate_denominator = known.rate_denominator != 0 ? known.rate_denominator : 1;
  build.frame_count = known.frame_count;
  build.values = known.values;
  build.frame_stride = known.frame_stride;
  build.wraps = known.looping == MIEN_LOOPING_WRAP;
  build.is_delta = known.is_delta != 0;
  Arena arena(allocator);
  if (!read_lists(known, arena, build)) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory to build a clip");
  }
  SharedClip* clip = nullptr;
  Error detail;
  const Status status = create_clip(build, allocator, clip, detail);
  return give_object(status, clip, detail, out_clip, error);
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

MienStatus mien_clip_open_file(const char* path, const MienClipOpenDesc* desc, MienClip** out_clip,
                               MienError* error) {
  if (MienStatus status = clear_output(out_clip, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  MienClipOpenDesc known;
  Allocator allocator;
  if (MienStatus status = read_open_desc(desc, known, allocator, error)) return status;
  SharedClip* clip = nullptr;
  Error detail;
  const Status status =
      open_clip_file(path, static_cast<FileAccess>(known.file_access), allocator, clip, detail);
  return give_object(status, clip, detail, out_clip, error);
}

MienStatus mien_clip_open_memory(const void* bytes, size_t size, const MienClipOpenDesc* desc,
                                 MienClip** out_clip, MienError* error) {
  if (MienStatus status = clear_output(out_clip, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  MienClipOpenDesc known;
  Allocator allocator;
  if (MienStatus status = read_open_desc(desc, known, allocator, error)) return status;
  SharedClip* clip = nullptr;
  Error detail;
  const Status status =
      open_clip_memory({static_cast<const uint8_t*>(bytes), size}, allocator, clip, detail);
  return give_object(status, clip, detail, out_clip, error);
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
  SharedClip* clip = nullptr;
  Error detail;
  const Status status =
      open_clip_stream({stream->user, stream->size, stream->read}, allocator, clip, detail);
  return give_object(status, clip, detail, out_clip, error);
}

void mien_clip_close(MienClip* clip) { destroy(clip); }

MienStatus mien_clip_write_file(const MienClip* clip, const char* path, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  if (MienStatus status = check(clip, "clip", error)) return status;
  const SharedClip& of = *object(clip);
  Error detail;
  const Status status = write_file(path, of.view.bytes, of.view.size, of.allocator, detail);
  return give_status(status, detail, error);
}

MienStatus mien_clip_write_memory(const MienClip* clip, void* buffer, size_t capacity,
                                  size_t* out_size, MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  if (MienStatus status = check(clip, "clip", error)) return status;
  const Clip& of = object(clip)->view;
  const size_t size = of.size;
  *out_size = size;
  if (!buffer) return succeed(error);
  if (capacity < size) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "the clip has %zu bytes, the buffer %zu: call again with a buffer of this size", size,
        capacity);
  }
  memcpy(buffer, of.bytes, size);
  return succeed(error);
}

// Looking into it ---------------------------------------------------------------------------------

MienStatus mien_clip_info(const MienClip* clip, MienClipInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(clip)) return status;
  const SharedClip& shared = *object(clip);
  const Clip& of = shared.view;
  const bool wraps = of.has(kClipWraps);
  MienClipInfo info = {};
  info.rate_numerator = of.rate_numerator;
  info.rate_denominator = of.rate_denominator;
  info.frame_count = of.frame_count;
  info.channel_count = of.channel_count;
  info.changing_channel_count = of.changing_count;
  info.event_count = of.event_count;
  info.looping = wraps ? MIEN_LOOPING_WRAP : MIEN_LOOPING_CLAMP;
  info.is_delta = of.has(kClipIsDelta);
  info.snap = snap_step(of.snap);
  info.is_mapped = shared.file.mapped;
  info.ticks_per_frame = of.ticks_per_frame;
  info.length = of.length(wraps);
  info.file_bytes = of.size;
  info.memory_bytes = shared.block_size + shared.file.capacity + shared.built.size;
  info.player_bytes = clip_player_size(of, false);
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_clip_channel(const MienClip* clip, uint32_t index, MienClipChannel* out_channel) {
  if (MienStatus status = clear_struct(out_channel)) return status;
  if (MienStatus status = check(clip)) return status;
  const Clip& of = object(clip)->view;
  if (index >= of.channel_count) return MIEN_ERROR_INDEX;
  MienClipChannel channel = {};
  channel.name = view_of(of.name(index));
  channel.rest = of.rest(index);
  channel.is_changing = is_changing(of, index);
  if (!object(clip)->reports.empty()) {
    const ChannelReport& report = object(clip)->reports[index];
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
  const uint32_t found = find_channel(object(clip)->view, {name, name_count});
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
  const Clip& of = object(clip)->view;
  if (index >= of.event_count) return MIEN_ERROR_INDEX;
  *out_event = view_of(of.event(index));
  return MIEN_OK;
}

MienStatus mien_clip_verify(const MienClip* clip, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(clip, "clip", error)) return status;
  Error detail;
  return give_status(verify_clip(object(clip)->view, detail), detail, error);
}

MienStatus mien_clip_read(const MienClip* clip, uint32_t first_frame, uint32_t frame_count,
                          float* out_values, size_t frame_stride, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(clip, "clip", error)) return status;
  const Clip& of = object(clip)->view;
  if (!out_values && frame_count != 0 && of.channel_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "out_values is NULL");
  }
  if (frame_stride != 0 && frame_stride < of.channel_count) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "frame_stride is %zu, a frame has %u channels", frame_stride,
                      of.channel_count);
  }
  if (first_frame > of.frame_count || frame_count > of.frame_count - first_frame) {
    return give_error(error, MIEN_ERROR_INDEX, "%u frames from frame %u on: the of has %u",
                      frame_count, first_frame, of.frame_count);
  }
  const size_t stride = frame_stride == 0 ? of.channel_count : frame_stride;
  if (read_frames(of, first_frame, frame_count, out_values, stride)) return succeed(error);
  return give_error(error, MIEN_ERROR_CLIP_STRUCTURE,
                    "a curve is damaged; fetch the of again or build it again");
}
