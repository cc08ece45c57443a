// SPDX-License-Identifier: MIT
#include "runtime/mix/mix_rows.h"

#include "runtime/mix/fade.h"

namespace mien {
namespace {

/// What a mode adds to a curve: the formulas of simd/mix_kernels.inl, with the same bits.
template <BlendMode kMode>
float added(float o, float x, float a) {
  switch (kMode) {
    case BlendMode::kOverride: return a * (x - o);
    case BlendMode::kAdd: return a * x;
    case BlendMode::kScreen: {
      const float raised = o > 0.0f ? o : 0.0f, p = raised < 1.0f ? raised : 1.0f;
      return a * x * (x < 0.0f ? p : 1.0f - p);
    }
    case BlendMode::kMax: return a * (x - o > 0.0f ? x - o : 0.0f);
    case BlendMode::kScale: return a * (x - 1.0f) * o;
  }
  return 0.0f;
}

template <BlendMode kMode>
void blend_each(Span<const uint16_t> curves, const float* values, const float* mask, float weight,
                float* row) {
  for (size_t i = 0; i < curves.count; ++i) {
    float& o = row[curves[i]];
    const float x = values[i], a = mask ? weight * mask[curves[i]] : weight;
    const float more = added<kMode>(o, x, a);
    if (kMode == BlendMode::kOverride && a == 1.0f) {
      o = x;
    } else if (more != 0.0f) {  // -0 + 0 would be 0
      o += more;
    }
  }
}

}  // namespace

void blend_curves(BlendMode mode, Span<const uint16_t> curves, const float* values,
                  const float* mask, float weight, float* row) {
  if (weight == 0.0f) return;
  const auto blend = [&](auto each) { each(curves, values, mask, weight, row); };
  switch (mode) {
    case BlendMode::kOverride: return blend(blend_each<BlendMode::kOverride>);
    case BlendMode::kAdd: return blend(blend_each<BlendMode::kAdd>);
    case BlendMode::kScreen: return blend(blend_each<BlendMode::kScreen>);
    case BlendMode::kMax: return blend(blend_each<BlendMode::kMax>);
    case BlendMode::kScale: return blend(blend_each<BlendMode::kScale>);
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
