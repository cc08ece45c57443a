// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_sampler.h"

#include <cassert>
#include <cstring>

namespace mien {
namespace {

constexpr uint32_t kNoFrame = ~uint32_t{0};

int64_t floor_div(int64_t a, int64_t b) { return a / b - (a % b < 0); }

Status check_speed(int32_t numerator, int32_t denominator, Error& error) {
  if (numerator >= -kMaxSpeed && numerator <= kMaxSpeed && denominator >= 1 &&
      denominator <= kMaxSpeed) {
    return Status::kOk;
  }
  return fail(error, Status::kInvalidArgument, kNoOffset,
              "a speed is a fraction of whole numbers up to %d, the lower one above 0", kMaxSpeed);
}

/// Returns the number of loops between the first one and `tick`.
int64_t put_position(ClipSampler& sampler, int64_t tick) {
  if (sampler.wraps) {
    const int64_t rest = tick % sampler.length;
    sampler.tick = rest < 0 ? rest + sampler.length : rest;
    return floor_div(tick, sampler.length);
  }
  sampler.tick = tick < 0 ? 0 : tick > sampler.length ? sampler.length : tick;
  if (sampler.tick != tick) sampler.fraction = 0;
  return 0;
}

/// With loops of one tick at the highest speed, a step has 2^60 loops: counting stops before it overflows.
void count_loops(ClipSampler& sampler, int64_t passed) {
  const int64_t loops = sampler.loops + passed;
  sampler.loops = loops < -kMaxLoops ? -kMaxLoops : loops > kMaxLoops ? kMaxLoops : loops;
}

/// Decodes a whole block, for playing backward.
void fill_block_rows(ClipSampler& sampler, uint32_t block) {
  const uint32_t first = block * kBlockFrames;
  const uint32_t left = sampler.clip->stored_frame_count() - first;
  float* row = sampler.block_rows.data;
  for (uint32_t f = 0; f < kBlockFrames && f < left; ++f, row += sampler.sampled.count) {
    decode_frame(sampler.decoder, first + f, row);
  }
  sampler.block_of_rows = block;
}

/// Decodes a stored frame into `row`.
void copy_frame(ClipSampler& sampler, uint32_t frame, float* row) {
  BlockDecoder& decoder = sampler.decoder;
  const uint32_t block = frame / kBlockFrames;
  const bool goes_back = sampler.backward && frame + 1 < decoder.next;
  if (!sampler.block_rows.empty() && goes_back && block != sampler.block_of_rows) {
    fill_block_rows(sampler, block);
  }
  if (block != sampler.block_of_rows) return decode_frame(decoder, frame, row);
  const size_t count = sampler.sampled.count;
  memcpy(row, sampler.block_rows.data + frame % kBlockFrames * count, count * sizeof(float));
}

/// The values of a frame. They are kept until kSamplerRows other frames were needed, including the neighbors
/// of frames that a half-rate clip does not store.
const float* frame_row(ClipSampler& sampler, uint32_t frame) {
  ++sampler.uses;
  for (uint32_t i = 0; i < kSamplerRows; ++i) {
    if (sampler.row_frames[i] != frame) continue;
    sampler.row_uses[i] = sampler.uses;
    return sampler.rows[i].data;
  }
  const bool half_rate = sampler.clip->has(kClipHalfRate);
  const float *a = nullptr, *b = nullptr;
  if (half_rate && frame % 2 == 1) {
    a = frame_row(sampler, frame - 1);
    b = frame_row(sampler, frame + 1);
  }
  uint32_t oldest = 0;
  for (uint32_t i = 1; i < kSamplerRows; ++i) {
    if (sampler.uses - sampler.row_uses[i] > sampler.uses - sampler.row_uses[oldest]) oldest = i;
  }
  const Span<float>& row = sampler.rows[oldest];
  if (a) {
    for (size_t i = 0; i < row.count; ++i) row[i] = half_rate_mean(a[i], b[i]);
  } else {
    copy_frame(sampler, half_rate ? frame / 2 : frame, row.data);
  }
  sampler.row_frames[oldest] = frame;
  sampler.row_uses[oldest] = sampler.uses;
  return row.data;
}

/// Limited to the range of two values; one of them if `x` is NaN.
float clamp_between(float x, float a, float b) {
  const float low = a < b ? a : b, high = a < b ? b : a;
  const float raised = x > low ? x : low;
  return raised < high ? raised : high;
}

// The clamp keeps values finite if the difference overflows, and within the range of the frames despite
// rounding.
void linear(const float* a, const float* b, float t, size_t count, float* out) {
  for (size_t i = 0; i < count; ++i) out[i] = clamp_between(a[i] + (b[i] - a[i]) * t, a[i], b[i]);
}

// Catmull-Rom, limited to the range of the two frames, so that it does not overshoot the limits of
// controls.
void catmull_rom(const float* a, const float* b, const float* c, const float* d, float t,
                 size_t count, float* out) {
  for (size_t i = 0; i < count; ++i) {
    const float cubic = 3.0f * (b[i] - c[i]) + d[i] - a[i];
    const float square = 2.0f * a[i] - 5.0f * b[i] + 4.0f * c[i] - d[i];
    const float curve = b[i] + 0.5f * t * (c[i] - a[i] + t * (square + t * cubic));
    out[i] = clamp_between(curve, b[i], c[i]);
  }
}

}  // namespace

void place_clip_sampler(Placer& placer, const SamplerLimits& limits, ClipSampler& sampler) {
  const size_t count = clip_row_floats(limits.changing_channels);
  sampler.kernels = limits.kernels ? limits.kernels : kernels_for(Isa::kBest);
  sampler.values = placer.array<float>(limits.channels, kBlockAlignment);
  sampler.groups = placer.array<ClipLanes>(clip_groups(limits.changing_channels), kBlockAlignment);
  for (Span<float>& row : sampler.rows) row = placer.array<float>(count, kBlockAlignment);
  sampler.sampled = placer.array<float>(count, kBlockAlignment);
  sampler.block_rows =
      placer.array<float>(limits.reverse ? count * kBlockFrames : 0, kBlockAlignment);
}

Status start_clip(ClipSampler& sampler, const Clip& clip, const PlayDesc& desc, Error& error) {
  const Status status = check_speed(desc.speed_numerator, desc.speed_denominator, error);
  if (status != Status::kOk) return status;
  const bool wraps =
      desc.looping == Looping::kLoop || (desc.looping == Looping::kAsClip && clip.has(kClipWraps));
  if (clip.channel_count > sampler.values.count || clip.changing_count > sampler.sampled.count) {
    return fail(error, Status::kClipLimit, kNoOffset,
                "the clip has %u channels, of which %u change; there is room for %zu and %zu",
                clip.channel_count, clip.changing_count, sampler.values.count,
                sampler.sampled.count);
  }
  sampler.clip = &clip;
  sampler.wraps = wraps;
  sampler.length = clip.length(wraps);
  sampler.speed_numerator = desc.speed_numerator;
  sampler.speed_denominator = desc.speed_denominator;
  sampler.interpolation = desc.interpolation;
  sampler.backward = desc.speed_numerator < 0;
  begin_decoding(clip, *sampler.kernels, sampler.groups, sampler.decoder);
  for (uint32_t& frame : sampler.row_frames) frame = kNoFrame;
  sampler.block_of_rows = kNoFrame;
  for (uint32_t c = 0; c < clip.channel_count; ++c) sampler.values[c] = clip.rest(c);
  seek_clip(sampler, desc.start_tick);
  return Status::kOk;
}

Status set_clip_speed(ClipSampler& sampler, int32_t numerator, int32_t denominator, Error& error) {
  const Status status = check_speed(numerator, denominator, error);
  if (status != Status::kOk) return status;
  sampler.fraction = sampler.fraction * denominator / sampler.speed_denominator;
  sampler.speed_numerator = numerator;
  sampler.speed_denominator = denominator;
  return Status::kOk;
}

void seek_clip(ClipSampler& sampler, int64_t tick) {
  sampler.fraction = 0;
  (void)put_position(sampler, tick);
  sampler.loops = 0;
  sampler.fresh = true;
}

EventRange advance_clip(ClipSampler& sampler, int64_t ticks) {
  assert(ticks >= -kMaxStepTicks && ticks <= kMaxStepTicks);
  const int64_t scaled = ticks * sampler.speed_numerator + sampler.fraction;
  const int64_t moved = floor_div(scaled, sampler.speed_denominator);
  sampler.fraction = scaled - moved * sampler.speed_denominator;
  sampler.backward = ticks == 0 ? sampler.backward : (ticks < 0) != (sampler.speed_numerator < 0);

  EventRange range;
  range.clip = sampler.clip;
  range.loop_length = sampler.wraps ? sampler.length : 0;
  const bool backward = moved < 0;
  // After a start the tick itself is passed too.
  range.from = sampler.tick + (sampler.fresh ? (backward ? 1 : -1) : 0);
  range.to = sampler.tick + moved;
  sampler.fresh = false;
  count_loops(sampler, put_position(sampler, range.to));
  if (!sampler.wraps) range.to = sampler.tick;
  range.index = backward ? count_events(*sampler.clip, range.from, false) - 1
                         : count_events(*sampler.clip, range.from, true);
  return range;
}

bool next_event(EventRange& range, ClipEvent& event) {
  const int64_t count = range.clip->event_count;
  if (count == 0) return false;
  const bool backward = range.to < range.from;
  if (range.index < 0 || range.index >= count) {
    if (range.loop_length == 0) return false;
    range.base += backward ? -range.loop_length : range.loop_length;
    range.index = backward ? count - 1 : 0;
  }
  const int64_t tick = range.base + range.clip->event_tick(static_cast<uint32_t>(range.index));
  if (backward ? tick < range.to : tick > range.to) return false;
  event = range.clip->event(static_cast<uint32_t>(range.index));
  range.index += backward ? -1 : 1;
  return true;
}

Span<const float> sample_changing(ClipSampler& sampler) {
  const Clip& clip = *sampler.clip;
  const size_t count = clip.changing_count;
  if (count == 0) return {};
  const int64_t last = int64_t{clip.frame_count} - 1;
  const int64_t at = sampler.tick / clip.ticks_per_frame;
  const int64_t past = sampler.tick % clip.ticks_per_frame;
  const auto row = [&](int64_t f) {
    if (sampler.wraps && f < 0) f += last + 1;
    if (sampler.wraps && f > last) f -= last + 1;
    return frame_row(sampler, static_cast<uint32_t>(f < 0 ? 0 : f > last ? last : f));
  };
  const auto t =
      static_cast<float>(static_cast<double>(past) / static_cast<double>(clip.ticks_per_frame));
  const float* b = row(at);
  if (past == 0 || sampler.interpolation == Interpolation::kStep) return {b, count};
  float* const out = sampler.sampled.data;
  if (sampler.interpolation == Interpolation::kLinear) {
    linear(b, row(at + 1), t, count, out);
  } else {
    const float *a = row(at - 1), *c = row(at + 1), *d = row(at + 2);
    catmull_rom(a, b, c, d, t, count, out);
  }
  return sampler.sampled.first(count);
}

Span<const float> sample_clip(ClipSampler& sampler) {
  const Clip& clip = *sampler.clip;
  const Span<const float> out = sample_changing(sampler);
  const uint8_t* channel = clip.bytes + clip.at.changing;
  float* const values = sampler.values.data;
  for (size_t i = 0; i < out.count; ++i) {
    values[load_little_endian<uint16_t>(channel + i * sizeof(uint16_t))] = out[i];
  }
  return sampler.values.first(clip.channel_count);
}

}  // namespace mien
