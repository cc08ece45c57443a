// SPDX-License-Identifier: MIT
// Time -> values: a clip being played. seek_clip() and advance_clip() move, sample_clip() gives the values there.
//
// The position is a whole number of ticks, plus the fraction of a tick that a speed leaves. So loops are
// exact, and the position does not depend on the step size. Moving decodes nothing. Sampling decodes
// the frames that it needs, which is cheap if little time has passed.
#pragma once

#include "runtime/anim/clip_block.h"
#include "runtime/base/arena.h"

namespace mien {

enum class Interpolation : uint8_t { kLinear, kStep, kCatmullRom };
enum class Looping : uint8_t { kAsClip, kLoop, kOnce };

// Then no product or sum of times overflows.
constexpr int64_t kMaxStepTicks = int64_t{1} << 40;  // 26 minutes
constexpr int32_t kMaxSpeed = 1 << 20;
constexpr int64_t kMaxLoops = INT64_MAX / 4;

struct PlayDesc {
  int64_t start_tick = 0;
  int32_t speed_numerator = 1;    // negative: backward; -kMaxSpeed ... kMaxSpeed
  int32_t speed_denominator = 1;  // 1 ... kMaxSpeed
  Looping looping = Looping::kAsClip;
  Interpolation interpolation = Interpolation::kLinear;
};

constexpr uint32_t kSamplerRows = 6;  // what Catmull-Rom needs where a half-rate clip wraps

/// The playback of one clip for one character. Its memory is allocated once, for a maximum number of
/// channels; starting another clip allocates nothing.
struct ClipSampler {
  const Clip* clip = nullptr;  // must outlive the playback
  int64_t tick = 0;            // 0 ... length, or below it in a loop
  int64_t loops = 0;           // completed, kMaxLoops at most; negative: backward
  int64_t fraction = 0;        // of a tick, in units of 1 / speed_denominator
  int64_t length = 0;
  int32_t speed_numerator = 1, speed_denominator = 1;
  bool wraps = false;
  bool fresh = false;     // has not moved since the start or a seek
  bool backward = false;  // in the last step
  Interpolation interpolation = Interpolation::kLinear;

  Span<float> values;  // [channel] of the clip, as sampled last

  // The most recently needed frames, of changing channels.
  BlockDecoder decoder;
  const KernelTable* kernels = nullptr;
  Span<ClipLanes> groups;  // of the decoder
  Span<float> rows[kSamplerRows];
  Span<float> sampled;
  uint32_t row_frames[kSamplerRows] = {};
  uint32_t row_uses[kSamplerRows] = {};  // when it was last needed
  uint32_t uses = 0;
  Span<float> block_rows;  // [frame of a block][changing channel], or no memory
  uint32_t block_of_rows = 0;
};

/// The largest clip that a sampler can play.
struct SamplerLimits {
  uint32_t channels = 0, changing_channels = 0;
  /// Takes 256 bytes more per changing channel, and makes a frame backward as cheap as one forward; otherwise
  /// each frame backward decodes half a block on average.
  bool reverse = false;
  const KernelTable* kernels = nullptr;  // null: the best; the results are the same with any
};

void place_clip_sampler(Placer& placer, const SamplerLimits& limits, ClipSampler& sampler);

/// kInvalidArgument for a speed out of range, kClipLimit for a clip with more channels than there is room
/// for; then the sampler does not change.
Status start_clip(ClipSampler& sampler, const Clip& clip, const PlayDesc& desc, Error& error);

/// Takes effect from here on. kInvalidArgument.
Status set_clip_speed(ClipSampler& sampler, int32_t numerator, int32_t denominator, Error& error);

/// Moves to any time: in a loop modulo its length, otherwise to the nearest end. Passes no events; the next
/// step also passes events at the new tick itself, as after a start.
void seek_clip(ClipSampler& sampler, int64_t tick);

/// Events that a step passed, in the order of passing; see next_event().
struct EventRange {
  const Clip* clip = nullptr;
  int64_t from = 0, to = 0;  // passed when from < tick <= to, or, backward, to <= tick < from
  int64_t loop_length = 0;   // 0: no loop
  int64_t base = 0;          // time at which the current loop begins
  int64_t index = 0;         // next event
};

/// Moves by `ticks` times the speed (-kMaxStepTicks ... kMaxStepTicks) and returns the events that it
/// passed. An event is passed by arriving at its tick or moving beyond it, in either direction: once
/// in each loop, however time is divided into steps.
EventRange advance_clip(ClipSampler& sampler, int64_t ticks);

/// The next event of a step; false after the last. Events are not collected in an array, because a step
/// over many loops can pass any number of them.
bool next_event(EventRange& range, ClipEvent& event);

/// As sample_clip(), but only the channels that change, in their order; `values` stays as it is. The result
/// is valid until the next call.
Span<const float> sample_changing(ClipSampler& sampler);

/// The values of all channels at the sampler's position, valid until the next call. At a frame they have its
/// bits; between two frames they are between their values. Always finite; a damaged block gives zeros and
/// sets `decoder.damaged`.
Span<const float> sample_clip(ClipSampler& sampler);

}  // namespace mien
