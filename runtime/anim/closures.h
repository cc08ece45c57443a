// SPDX-License-Identifier: MIT
// When a clip says that lips or teeth are closed: its events that are named after a closure; the value is the
// duration in seconds. Guards keep the closure closed (runtime/mix/guard.h).
#pragma once

#include "runtime/anim/clip.h"

namespace mien {

enum Closure : uint32_t { kLipsClosed, kLipAtTeeth, kTeethClosed, kClosures };
constexpr const char* kClosureNames[kClosures] = {"close:lips", "close:lip-to-teeth",
                                                  "close:teeth"};

/// Phonemes are shorter; longer closures take several events.
constexpr int64_t kLongestClosure = kTicksPerSecond;
/// A closure ramps up over this time before it begins, and down over the same time after it ends. So a curve
/// that has to move all the way is no faster than kGuardSpeed.
constexpr int64_t kClosureRamp = kTicksPerSecond / 8;
/// If more events are in this time, the last ones count. Speech has 12 phonemes per second.
constexpr uint32_t kMaxNearEvents = 64;

/// Numbers of names in a clip; kNoChannel if the clip has no such name.
struct Closures {
  uint32_t names[kClosures] = {kNoChannel, kNoChannel, kNoChannel};

  bool has(uint32_t closure) const { return names[closure] != kNoChannel; }
  bool any() const { return has(kLipsClosed) || has(kLipAtTeeth) || has(kTeethClosed); }
};

/// Searches all names.
Closures find_closures(const Clip& clip);

/// [closure] 1 while it is closed, 0 from kClosureRamp before and after, smooth between; a function of the
/// time alone, with one binary search. Where several events overlap, the shares that they leave open are
/// multiplied. `wraps`: events near the other end of the clip count, too.
void closures_at(const Clip& clip, const Closures& closures, int64_t tick, bool wraps,
                 float (&closed)[kClosures]);

}  // namespace mien
