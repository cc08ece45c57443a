// SPDX-License-Identifier: MIT
#include "runtime/mix/mix_rows.h"

#include "runtime/mix/fade.h"

namespace mien {
namespace {

/// Calls blend(o, x, c, a) for each lane, where a is not 0.
template <class Blend>
void blend_lanes(const float* x, const float* cover, const float* mask, float weight, size_t count,
                 float* row, const Blend& blend) {
  if (cover && mask) {
    for (size_t i = 0; i < count; ++i) {
      const float a = weight * mask[i], mixed = blend(row[i], x[i], cover[i], a);
      row[i] = a == 0.0f ? row[i] : mixed;
    }
  } else if (cover) {
    for (size_t i = 0; i < count; ++i) row[i] = blend(row[i], x[i], cover[i], weight);
  } else if (mask) {
    for (size_t i = 0; i < count; ++i) {
      const float a = weight * mask[i], mixed = blend(row[i], x[i], 1.0f, a);
      row[i] = a == 0.0f ? row[i] : mixed;
    }
  } else {
    for (size_t i = 0; i < count; ++i) row[i] = blend(row[i], x[i], 1.0f, weight);
  }
}

}  // namespace

void blend_row(BlendMode mode, const float* x, const float* cover, const float* mask, float weight,
               size_t count, float* row) {
  if (weight == 0.0f) return;
  switch (mode) {
    case BlendMode::kOverride:
      blend_lanes(x, cover, mask, weight, count, row, [](float o, float v, float c, float a) {
        const float mixed = o + a * (v - c * o);
        // Without branches: each condition selects lanes.
        const float whole = a == 1.0f ? v : mixed;
        const float same = v == o ? v : whole;
        return c == 1.0f ? same : mixed;
      });
      break;
    case BlendMode::kAdd:
      blend_lanes(x, nullptr, mask, weight, count, row,
                  [](float o, float v, float, float a) { return o + a * v; });
      break;
    case BlendMode::kScreen:
      blend_lanes(x, nullptr, mask, weight, count, row, [](float o, float v, float, float a) {
        const float raised = o > 0.0f ? o : 0.0f, p = raised < 1.0f ? raised : 1.0f;
        return o + a * v * (v >= 0.0f ? 1.0f - p : p);
      });
      break;
    case BlendMode::kMax:
      blend_lanes(x, cover, mask, weight, count, row, [](float o, float v, float c, float a) {
        const float above = v - c * o;
        return o + a * (above > 0.0f ? above : 0.0f);
      });
      break;
    case BlendMode::kScale:
      blend_lanes(x, cover, mask, weight, count, row,
                  [](float o, float v, float c, float a) { return o * (1.0f + a * (v - c)); });
      break;
  }
}

void cross_rows(const float* from, const float* to, float s, size_t count, float* out) {
  for (size_t i = 0; i < count; ++i) {
    const float mixed = from[i] + s * (to[i] - from[i]);
    const float whole = s == 1.0f ? to[i] : mixed;
    out[i] = to[i] == from[i] ? to[i] : whole;
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

void add_quintics(const QuinticRows& quintics, float u, size_t count, float* row) {
  for (size_t i = 0; i < count; ++i) {
    row[i] += quintic_at({quintics.c0[i], quintics.c1[i], quintics.c2[i], quintics.rate[i]}, u);
  }
}

void clamp_row(size_t count, float* row) {
  for (size_t i = 0; i < count; ++i) {
    const float raised = row[i] > 0.0f ? row[i] : 0.0f;
    row[i] = raised < 1.0f ? raised : 1.0f;
  }
}

void limit_row(const float* lower, const float* upper, size_t count, float* row) {
  for (size_t i = 0; i < count; ++i) {
    // What is not a number becomes the lower limit.
    const float raised = row[i] > lower[i] ? row[i] : lower[i];
    const float limited = raised < upper[i] ? raised : upper[i];
    row[i] = row[i] == limited ? row[i] : limited;  // -0 stays
  }
}

void find_active_lanes(const float* row, size_t count, uint64_t* words) {
  for (size_t w = 0; w * 64 < count; ++w) {
    uint64_t word = 0;
    for (size_t i = 0; i < 64 && w * 64 + i < count; ++i) {
      word |= uint64_t{row[w * 64 + i] != 0.0f} << i;
    }
    words[w] = word;
  }
}

}  // namespace mien
