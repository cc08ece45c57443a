// SPDX-License-Identifier: MIT
// What a step does to rows and is no kernel.
#pragma once

#include "runtime/mix/mix.h"

namespace mien {

/// Blends a value for each of some lanes over a row, as KernelTable::blend_row does whole rows. `mask` is by the lanes of the row, or null: 1.
void blend_lanes(BlendMode mode, Span<const uint16_t> lanes, const float* values, const float* mask,
                 float weight, float* row);

/// Offsets that lead from `last`, with the velocity that it has after `previous`, to `next`.
/// `velocity_scale` makes the velocity times T out of last - previous.
void start_quintics(const float* last, const float* previous, const float* next,
                    float velocity_scale, size_t count, const QuinticRows& out);

}  // namespace mien
