// SPDX-License-Identifier: MIT
// Rows that another thread pushes: a ring with one producer and one consumer, without locks.
//
// Rows are played `delay` after their time, which hides jitter of up to this time. Values between two rows
// are interpolated linearly. If no row follows, the last change is extrapolated for 50 ms, then the layer
// fades out in 250 ms. If rows arrive later and differ from what was shown, the layer blends to them
// (mixer_step.cpp).
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

  int64_t newest;  // of the producer: tick of its last frame, if there is one
  bool has_newest;

  // Of the consumer:
  float *last, *before;  // the last two frames taken
  int64_t last_tick, before_tick;
  uint32_t taken;  // how many of them there are: 0, 1, 2
  bool guessed;    // the values shown last were extrapolated
};

enum class StreamSample : uint8_t { kNone, kShown, kJumped, kLost };

void place_stream(Placer& placer, uint32_t capacity, uint32_t channels, RowStream*& stream);

/// False if the frame is dropped, because it is not newer than the last one or there is no room.
bool push_stream(RowStream& stream, int64_t tick, const float* values);

/// Computes the values at `tick`, which never goes back. kJumped: they do not continue the values shown
/// before. kLost: `tick` is more than kStreamAhead after the last frame; the values are those of
/// kStreamAhead after it. kNone: there is no frame yet, and no values.
StreamSample sample_stream(RowStream& stream, int64_t tick, float* values);

}  // namespace mien
