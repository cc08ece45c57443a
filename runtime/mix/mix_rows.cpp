// SPDX-License-Identifier: MIT
#include "runtime/mix/mix_rows.h"

#include "runtime/base/arena.h"
#include "runtime/mix/fade.h"

namespace mien {

void blend_lanes(const Mix& mix, BlendMode mode, Span<const uint16_t> lanes, const float* values,
                 const float* mask, float weight, float* row) {
  if (weight == 0.0f) return;
  // Gathered, so that there is one definition of blending.
  for (size_t first = 0; first < lanes.count; first += kLaneStep) {
    const size_t count = lanes.count - first < kLaneStep ? lanes.count - first : kLaneStep;
    // Three arrays: compilers clear a larger one by an instruction that is slow to begin.
    alignas(kBlockAlignment) float some_x[kLaneStep] = {};
    alignas(kBlockAlignment) float some_mask[kLaneStep] = {};
    alignas(kBlockAlignment) float some_row[kLaneStep] = {};
    for (size_t i = 0; i < count; ++i) {
      const uint16_t lane = lanes[first + i];
      some_x[i] = values[first + i];
      some_mask[i] = mask ? mask[lane] : 1.0f;
      some_row[i] = row[lane];
    }
    mix.kernels->blend_row({some_x, nullptr, some_mask, some_row, kLaneStep, weight, mode});
    for (size_t i = 0; i < count; ++i) row[lanes[first + i]] = some_row[i];
  }
}

void start_quintics(const float* last, const float* previous, const float* next,
                    float velocity_scale, size_t count, const QuinticRows& out) {
  for (size_t i = 0; i < count; ++i) {
    const float p = (last[i] - previous[i]) * velocity_scale;
    const Quintic quintic = quintic_from(last[i] - next[i], p);
    out.c0[i] = quintic.c0;
    out.c1[i] = quintic.c1;
    out.c2[i] = quintic.c2;
    out.rate[i] = quintic.rate;
  }
}

}  // namespace mien
