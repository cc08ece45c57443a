// SPDX-License-Identifier: MIT
// Smooth change over time: a quintic brings an offset to zero. All fades, crossfades and transitions of
// the mixing layer use it, and all envelopes of strokes but lags.
//
// With the offset d and its velocity v at the start, p = v T, u = t / T and w = 1 - u:
//
//     offset = w^3 (d + u (3 d + p) + u^2 (6 d + 3 p + q)),   q = max(0, -4 p - 10 d) for d >= 0
//
// At T the offset, its velocity and its acceleration are zero. The offset never changes its sign: if v
// points toward zero, T is limited to -5 d / v; if v points away from zero, no limit is needed. q is half
// of the acceleration at the start, times T^2. With v = 0 the offset is d (1 - s), where
// s = 6 u^5 - 15 u^4 + 10 u^3. After D. Bollo, "Inertialization: High-Performance Animation
// Transitions in Gears of War", GDC 2018.
#pragma once

#include <cstdint>

#include "runtime/anim/clip.h"

namespace mien {

constexpr int64_t kMaxFadeTicks = int64_t{1} << 40;  // 26 minutes

/// The coefficients of the offset, and the factor by which its duration is shorter than T.
struct Quintic {
  float c0, c1, c2;
  float rate;  // T / duration, 1 or more
};

struct TickRange {
  int64_t begin = 0, end = 0;
};

/// `p` is the velocity times T. If a coefficient is not finite, the offset is zero.
inline Quintic quintic_from(float d, float p) {
  float rate = 1.0f;
  const float limit = -5.0f * d;
  if (d > 0.0f ? p < limit : d < 0.0f && p > limit) {
    rate = p / limit;
    p = limit;
  }
  const float a = -4.0f * p - 10.0f * d;
  const bool positive = d > 0.0f || (d == 0.0f && p >= 0.0f);
  const float q = positive ? (a > 0.0f ? a : 0.0f) : (a < 0.0f ? a : 0.0f);
  const float c1 = 3.0f * d + p, c2 = 6.0f * d + 3.0f * p + q;
  constexpr float kLarge = 1e30f;
  const bool finite = c2 < kLarge && c2 > -kLarge && c1 < kLarge && c1 > -kLarge;
  return finite ? Quintic{d, c1, c2, rate} : Quintic{0.0f, 0.0f, 0.0f, 1.0f};
}

/// The offset at `u` = t / T, 0 or more. Exactly 0 from its end on.
inline float quintic_at(const Quintic& quintic, float u) {
  const float scaled = u * quintic.rate;
  const float v = scaled < 1.0f ? scaled : 1.0f;
  const float w = 1.0f - v;
  const float offset = w * w * w * (quintic.c0 + v * (quintic.c1 + v * quintic.c2));
  return offset * quintic.c0 < 0.0f ? 0.0f : offset;  // rounding near the end
}

/// The derivative by u.
inline float quintic_slope(const Quintic& quintic, float u) {
  const float v = u * quintic.rate;
  if (!(v < 1.0f)) return 0.0f;
  const float w = 1.0f - v;
  const float value = quintic.c0 + v * (quintic.c1 + v * quintic.c2);
  const float slope = quintic.c1 + 2.0f * v * quintic.c2;
  return w * w * (w * slope - 3.0f * value) * quintic.rate;
}

inline float fraction_of(int64_t ticks, int64_t of) {
  return static_cast<float>(static_cast<double>(ticks) / static_cast<double>(of));
}

/// A number that moves to a target. A function of time alone, however time is divided into steps.
struct Fade {
  float target;
  Quintic offset;
  uint32_t zero;
  int64_t start, ticks;  // ticks 0: it has arrived
};

inline float fade_value(const Fade& fade, int64_t now) {
  if (now - fade.start >= fade.ticks) return fade.target;
  return fade.target + quintic_at(fade.offset, fraction_of(now - fade.start, fade.ticks));
}

/// The velocity per tick.
inline float fade_velocity(const Fade& fade, int64_t now) {
  if (now - fade.start >= fade.ticks) return 0.0f;
  const float slope = quintic_slope(fade.offset, fraction_of(now - fade.start, fade.ticks));
  return slope / static_cast<float>(fade.ticks);
}

/// Starts from the current value and velocity.
inline void start_fade(Fade& fade, int64_t now, float target, int64_t ticks) {
  const float value = fade_value(fade, now), velocity = fade_velocity(fade, now);
  fade.target = target;
  fade.start = now;
  fade.ticks = ticks > 0 ? ticks : 0;
  fade.offset = quintic_from(value - target, velocity * static_cast<float>(fade.ticks));
}

inline void set_fade(Fade& fade, float value) {
  fade = Fade{};
  fade.target = value;
}

}  // namespace mien
