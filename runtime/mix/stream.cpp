// SPDX-License-Identifier: MIT
#include "runtime/mix/stream.h"

#include <algorithm>
#include <cstring>

#include "runtime/mix/fade.h"

namespace mien {

void place_stream(Placer& placer, uint32_t capacity, uint32_t channels, RowStream*& stream) {
  const Span<RowStream> place = placer.array<RowStream>(1, kBlockAlignment);
  const Span<float> rows = placer.array<float>(size_t{capacity} * channels);
  const Span<int64_t> ticks = placer.array<int64_t>(capacity);
  const Span<float> last = placer.array<float>(channels), before = placer.array<float>(channels);
  stream = place.data;
  if (placer.measuring()) return;
  new (stream) RowStream{};
  stream->capacity = capacity;
  stream->channels = channels;
  stream->rows = rows.data;
  stream->ticks = ticks.data;
  stream->last = last.data;
  stream->before = before.data;
}

bool push_stream(RowStream& stream, int64_t tick, const float* values) {
  if (stream.has_newest && tick <= stream.newest) return false;
  const uint32_t head = stream.head.load(std::memory_order_relaxed);
  if (head - stream.tail.load(std::memory_order_acquire) == stream.capacity) return false;
  const uint32_t slot = head % stream.capacity;
  memcpy(stream.rows + size_t{slot} * stream.channels, values, stream.channels * sizeof(float));
  stream.ticks[slot] = tick;
  stream.newest = tick;
  stream.has_newest = true;
  stream.head.store(head + 1, std::memory_order_release);
  return true;
}

StreamSample sample_stream(RowStream& stream, int64_t tick, float* values) {
  const uint32_t head = stream.head.load(std::memory_order_acquire);
  uint32_t tail = stream.tail.load(std::memory_order_relaxed);
  const uint32_t first = tail;
  const size_t bytes = stream.channels * sizeof(float);
  for (; tail != head && stream.ticks[tail % stream.capacity] <= tick; ++tail) {
    const uint32_t slot = tail % stream.capacity;
    float* oldest = stream.before;
    stream.before = stream.last;
    stream.before_tick = stream.last_tick;
    stream.last = oldest;
    memcpy(stream.last, stream.rows + size_t{slot} * stream.channels, bytes);
    stream.last_tick = stream.ticks[slot];
    if (stream.taken < 2) ++stream.taken;
  }
  const bool took = tail != first, has_next = tail != head;
  stream.tail.store(tail, std::memory_order_release);
  if (stream.taken == 0) return StreamSample::kNone;

  const int64_t age = tick - stream.last_tick;
  const bool jumped = stream.guessed && (took || has_next);
  stream.guessed = !has_next && age > 0;
  // The values move on from the last frame by a share of the change from `from` to `to`.
  const float *from = stream.before, *to = stream.last;
  float s = 0.0f;
  if (has_next) {
    const uint32_t slot = tail % stream.capacity;
    from = stream.last;
    to = stream.rows + size_t{slot} * stream.channels;
    s = fraction_of(age, stream.ticks[slot] - stream.last_tick);
  } else if (stream.taken == 2 && stream.last_tick - stream.before_tick <= 2 * kStreamAhead) {
    s = fraction_of(std::min(age, kStreamAhead), stream.last_tick - stream.before_tick);
  }
  for (uint32_t i = 0; i < stream.channels; ++i) {
    values[i] = stream.last[i] + s * (to[i] - from[i]);
  }
  if (!has_next && age > kStreamAhead) return StreamSample::kLost;
  return jumped ? StreamSample::kJumped : StreamSample::kShown;
}

}  // namespace mien
