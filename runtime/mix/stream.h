// SPDX-License-Identifier: MIT
// Rows that arrive from outside, from a thread of their own: a ring with one producer and one
// consumer and without locks.
//
// They are played `delay` after their time, so that jitter up to it is not seen. Between two of them
// the stream is linear. If none follows, it goes on as fast as before for 50 ms and fades out in
// 250 ms. Where rows that come after all tell something else than what was shown, the layer leads
// over to them (mixer.cpp).
#pragma once

#include <atomic>

#include "runtime/anim/clip.h"
#include "runtime/base/arena.h"

namespace mien {

constexpr int64_t kStreamAhead = kTicksPerSecond / 20;
constexpr int64_t kStreamFade = kTicksPerSecond / 4;
constexpr int64_t kStreamLeadOver = kTicksPerSecond / 10;
constexpr uint32_t kMaxStreamFrames = 1024;

struct RowStream {
  std::atomic<uint32_t> head, tail;  // frames pushed, frames taken
  uint32_t capacity, channels;
  float* rows;     // [frame % capacity][channel]
  int64_t* ticks;  // [frame % capacity]

  int64_t newest;  // the producer's: tick of its last frame, if there is one
  bool has_newest;

  // The consumer's:
  float *last, *before;  // the last two frames taken
  int64_t last_tick, before_tick;
  uint32_t taken;  // 0, 1, 2: how many of them are there
  bool guessed;    // what was shown last was not between two frames
};

enum class StreamSample : uint8_t { kNone, kShown, kJumped, kLost };

void place_stream(Placer& placer, uint32_t capacity, uint32_t channels, RowStream*& stream);

/// False for a frame that is dropped: it is not newer than the last one, or there is no room.
bool push_stream(RowStream& stream, int64_t tick, const float* values);

/// Values at a time that does not go back. kJumped: they do not continue what was shown before.
/// kLost: those of `kStreamAhead` after the last frame. kNone: no frame so far, no values.
StreamSample sample_stream(RowStream& stream, int64_t tick, float* values);

}  // namespace mien
