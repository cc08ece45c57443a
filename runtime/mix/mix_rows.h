// SPDX-License-Identifier: MIT
// What a step does to whole rows: plain loops over multiples of 16 lanes, which compilers vectorize.
// Every lane is computed alone and nothing is fused, so the bits are the same everywhere.
#pragma once

#include "runtime/mix/mix.h"

namespace mien {

/// Blends `x` over `row`. `cover` is 1 in lanes that the source has a value for, 0 in the others and
/// in between while a transition changes that; x is already multiplied by it. Null: 1 everywhere.
/// kAdd and kScreen do not need it, as x is 0 where it is 0. `mask` may be null.
///
/// With a = weight * mask = 0 a lane keeps its bits; kOverride with a = 1 and cover = 1, or with
/// x = row, gives those of x.
void blend_row(BlendMode mode, const float* x, const float* cover, const float* mask, float weight,
               size_t count, float* row);

/// out = from + s (to - from); the bits of `to` where they are equal or s is 1.
void cross_rows(const float* from, const float* to, float s, size_t count, float* out);

/// Coefficients of one Quintic (fade.h) per lane.
struct QuinticRows {
  float *c0, *c1, *c2, *rate;
};

/// From `last` to `next`; `velocity_scale` makes the velocity times T out of last - previous.
void start_quintics(const float* last, const float* previous, const float* next,
                    float velocity_scale, size_t count, const QuinticRows& out);

/// row += offset at u
void add_quintics(const QuinticRows& quintics, float u, size_t count, float* row);

/// 0 ... 1
void clamp_row(size_t count, float* row);

void limit_row(const float* lower, const float* upper, size_t count, float* row);

/// Bit i of word i / 64: lane i is not 0. Writes (count + 63) / 64 words.
void find_active_lanes(const float* row, size_t count, uint64_t* words);

}  // namespace mien
