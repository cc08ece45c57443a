// SPDX-License-Identifier: MIT
// Operations of a step on rows that are not kernels.
#pragma once

#include "runtime/mix/mix.h"

namespace mien {

/// Blends one value for each of `curves` over a row, by the formulas of KernelTable::blend_row. `mask` has
/// one number per curve of the row; null: all 1.
void blend_curves(BlendMode mode, Span<const uint16_t> curves, const float* values,
                  const float* mask, float weight, float* row);

/// Creates offsets that lead from `last` to `next`. They start with the velocity from `previous` to `last`:
/// (last - previous) * velocity_scale is the velocity times T.
void start_quintics(const float* last, const float* previous, const float* next,
                    float velocity_scale, size_t count, const QuinticRows& out);

}  // namespace mien
