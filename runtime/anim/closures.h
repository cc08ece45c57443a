// SPDX-License-Identifier: MIT
// Where a clip says that lips or teeth are closed: its events that are named after what they close, of
// as many seconds as their value is. Guards hold on to that (runtime/mix/guard.h).
#pragma once

#include "runtime/anim/clip.h"

namespace mien {

enum Closure : uint32_t { kLipsClosed, kLipAtTeeth, kTeethClosed, kClosures };
constexpr const char* kClosureNames[kClosures] = {"close:lips", "close:lip-to-teeth",
                                                  "close:teeth"};

/// Phonemes are shorter; what is longer takes several events.
constexpr int64_t kLongestClosure = kTicksPerSecond;
/// What is closed begins to be held this long before, and is let go of in as much time after. So it is
/// no faster than kGuardSpeed where a curve has to go all the way.
constexpr int64_t kClosureRamp = kTicksPerSecond / 8;
/// Of events in this time the last ones count. Speech has 12 phonemes a second.
constexpr uint32_t kMaxNearEvents = 64;

/// Numbers of names in a clip; kNoChannel: it has none such.
struct Closures {
  uint32_t names[kClosures] = {kNoChannel, kNoChannel, kNoChannel};

  bool has(uint32_t closure) const { return names[closure] != kNoChannel; }
  bool any() const { return has(kLipsClosed) || has(kLipAtTeeth) || has(kTeethClosed); }
};

/// Looks through all names.
Closures find_closures(const Clip& clip);

/// [closure] 1 while it is closed, 0 from kClosureRamp before and after, smooth between; a function of
/// the time alone, with one binary search. Where several are near, what they leave open is multiplied.
/// `wraps`: events near the other end of the clip count, too.
void closures_at(const Clip& clip, const Closures& closures, int64_t tick, bool wraps,
                 float (&closed)[kClosures]);

}  // namespace mien
