// SPDX-License-Identifier: MIT
#include "runtime/mix/mix_rows.h"

#include "runtime/base/arena.h"
#include "runtime/mix/fade.h"

namespace mien {

void blend_lanes(const Mix& mix, BlendMode mode, Span<const uint16_t> lanes, const float* values,
                 const float* mask, float weight, float* row) {
  if (weight == 0.0f) return;
  // Gathered, so that there is one definition of blending.
  struct alignas(kBlockAlignment) Lanes {
    float x[kLaneStep], mask[kLaneStep], row[kLaneStep];
  } some = {};
  for (size_t first = 0; first < lanes.count; first += kLaneStep) {
    const size_t count = lanes.count - first < kLaneStep ? lanes.count - first : kLaneStep;
    for (size_t i = 0; i < count; ++i) {
      const uint16_t lane = lanes[first + i];
      some.x[i] = values[first + i];
      some.mask[i] = mask ? mask[lane] : 1.0f;
      some.row[i] = row[lane];
    }
    mix.kernels->blend_row({some.x, nullptr, some.mask, some.row, kLaneStep, weight, mode});
    for (size_t i = 0; i < count; ++i) row[lanes[first + i]] = some.row[i];
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
