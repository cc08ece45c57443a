// SPDX-License-Identifier: MIT
#include "runtime/anim/closures.h"

#include <cstring>

namespace mien {
namespace {

/// 0 outside, 1 from begin to end.
float closed_at(int64_t tick, int64_t begin, int64_t end) {
  const int64_t off = tick < begin ? begin - tick : tick > end ? tick - end : 0;
  if (off >= kClosureRamp) return 0.0f;
  const float u = 1.0f - static_cast<float>(off) / static_cast<float>(kClosureRamp);
  return u * u * (3.0f - 2.0f * u);
}

int64_t length_of(float seconds) {
  if (!(seconds > 0.0f)) return 0;
  if (seconds >= 1.0f) return kLongestClosure;
  return static_cast<int64_t>(static_cast<double>(seconds) * kTicksPerSecond);
}

void multiply_open(const Clip& clip, const Closures& closures, int64_t tick,
                   float (&open)[kClosures]) {
  const auto end = static_cast<uint32_t>(count_events(clip, tick + kClosureRamp, false));
  const uint32_t first = end > kMaxNearEvents ? end - kMaxNearEvents : 0;
  for (uint32_t i = end; i > first; --i) {
    const int64_t begin = clip.event_tick(i - 1);
    if (begin <= tick - kLongestClosure - kClosureRamp) return;
    const uint32_t name = clip.event_name(i - 1);
    for (uint32_t c = 0; c < kClosures; ++c) {
      if (name != closures.names[c]) continue;
      open[c] *= 1.0f - closed_at(tick, begin, begin + length_of(clip.event(i - 1).value));
    }
  }
}

}  // namespace

Closures find_closures(const Clip& clip) {
  Closures found;
  for (uint32_t i = clip.channel_count; i < clip.name_count; ++i) {
    const Span<const char> name = clip.name(i);
    for (uint32_t c = 0; c < kClosures; ++c) {
      const Span<const char> wanted = {kClosureNames[c], strlen(kClosureNames[c])};
      if (!found.has(c) && compare_names(name, wanted) == 0) found.names[c] = i;
    }
  }
  return found;
}

void closures_at(const Clip& clip, const Closures& closures, int64_t tick, bool wraps,
                 float (&closed)[kClosures]) {
  float open[kClosures] = {1, 1, 1};
  multiply_open(clip, closures, tick, open);
  const int64_t length = clip.length(true);
  if (wraps && tick < kLongestClosure + kClosureRamp) {
    multiply_open(clip, closures, tick + length, open);
  }
  if (wraps && tick + kClosureRamp > length) multiply_open(clip, closures, tick - length, open);
  for (uint32_t c = 0; c < kClosures; ++c) closed[c] = 1.0f - open[c];
}

}  // namespace mien
