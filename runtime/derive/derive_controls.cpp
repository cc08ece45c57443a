// SPDX-License-Identifier: MIT
// Derivatives of conditional tables, correctives, channels and maps (docs/derivatives.md, 2).
#include <cmath>

#include "runtime/derive/derive_stages.h"

namespace mien {
namespace {

/// The slope of a clamp to 0 ... 1: at its ends the one into the interval. NaN counts as below.
bool moves(float value) { return value >= 0.0f && value <= 1.0f; }

/// The rows that fire. Where two intervals of a run meet at the input, the steeper row counts, so that a flat
/// one does not hide its neighbor.
uint32_t list_slopes(const ControlTable& table, uint32_t row_count, const float* inputs,
                     const Span<float>& sums, const Span<TableSlope>& slopes) {
  std::fill(sums.begin(), sums.end(), 0.0f);
  const auto fires = [&](uint32_t r) {
    const float input = inputs[table.inputs[r]];
    return table.from[r] <= input && input <= table.to[r];
  };
  uint32_t count = 0;
  for (uint32_t r = 0; r < row_count;) {
    if (!fires(r)) {
      ++r;
      continue;
    }
    const uint16_t input = table.inputs[r], output = table.outputs[r];
    sums[output] += table.slope[r] * inputs[input] + table.cut[r];
    float slope = table.slope[r];
    const uint32_t end = std::min(table.run_ends[r], row_count);
    for (uint32_t next = r + 1; next < end; ++next) {
      if (fires(next) && std::fabs(table.slope[next]) > std::fabs(slope)) slope = table.slope[next];
    }
    slopes[count++] = {input, output, slope};
    r = table.run_ends[r];
  }
  uint32_t kept = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (moves(sums[slopes[i].output])) slopes[kept++] = slopes[i];
  }
  return kept;
}

}  // namespace

void linearize_tables(Derivatives& d, const Instance& instance) {
  const Rig& rig = *d.rig;
  d.gui_slope_count =
      list_slopes(rig.gui_to_raw, static_cast<uint32_t>(rig.gui_to_raw.inputs.count),
                  instance.gui.data, d.controls.first(rig.control_count), d.gui_slopes);
  d.map_slope_count = list_slopes(rig.maps, rig.map_rows_at_lod[d.lod], d.values.data,
                                  d.maps.first(rig.map_count), d.map_slopes);
}

// Of one input: the weight times the other factors, where neither clamp holds.
void linearize_psds(Derivatives& d) {
  const PsdTable& psds = d.rig->psds;
  const uint32_t count = psds.count_at_lod[d.lod];
  const auto clamped = [&](uint32_t i) {
    const float v = d.values[psds.inputs[i]];
    return v > 0.0f ? (v < 1.0f ? v : 1.0f) : 0.0f;
  };
  for (uint32_t e = 0; e < count; ++e) {
    const uint32_t first = psds.first_input[e], end = psds.first_input[e + 1];
    float before = psds.weights[e];
    for (uint32_t i = first; i < end; ++i) {
      d.psd_slopes[i] = before;
      before *= clamped(i);
    }
    const bool limited = before > 1.0f || !std::isfinite(before);
    float after = 1.0f;
    uint8_t any = 0;
    for (uint32_t i = end; i-- > first;) {
      const bool moving = !limited && moves(d.values[psds.inputs[i]]);
      d.psd_slopes[i] = moving ? d.psd_slopes[i] * after : 0.0f;
      any |= d.psd_slopes[i] != 0.0f && d.moving[psds.inputs[i]];
      after *= clamped(i);
    }
    d.moving[psds.outputs[e]] = any;
    // Later correctives read the value of this one.
    d.values[psds.outputs[e]] = saturated(before < 1.0f ? before : 1.0f);
  }
}

template <uint32_t L>
void push_gui(Derivatives& d) {
  for (const uint16_t raw : d.rig->driven_raw) clear<L>(d.controls.data + size_t{raw} * L);
  for (const TableSlope& s : d.gui_slopes.first(d.gui_slope_count)) {
    add_scaled<L>(d.controls.data + size_t{s.output} * L, d.gui.data + size_t{s.input} * L,
                  s.slope);
  }
}

template <uint32_t L>
void pull_gui(Derivatives& d) {
  for (const TableSlope& s : d.gui_slopes.first(d.gui_slope_count)) {
    add_scaled<L>(d.gui.data + size_t{s.input} * L, d.controls.data + size_t{s.output} * L,
                  s.slope);
  }
  for (const uint16_t raw : d.rig->driven_raw) clear<L>(d.controls.data + size_t{raw} * L);
}

template <uint32_t L>
void push_psds(Derivatives& d) {
  const PsdTable& psds = d.rig->psds;
  const uint32_t count = psds.count_at_lod[d.lod];
  float* const x = d.controls.data;
  for (uint32_t e = 0; e < count; ++e) {
    float sum[L] = {};
    for (uint32_t i = psds.first_input[e]; i < psds.first_input[e + 1]; ++i) {
      if (d.psd_slopes[i] == 0.0f) continue;
      add_scaled<L>(sum, x + size_t{psds.inputs[i]} * L, d.psd_slopes[i]);
    }
    std::copy(sum, sum + L, x + size_t{psds.outputs[e]} * L);
  }
}

template <uint32_t L>
void pull_psds(Derivatives& d) {
  const PsdTable& psds = d.rig->psds;
  float* const x = d.controls.data;
  for (uint32_t e = psds.count_at_lod[d.lod]; e-- > 0;) {
    float gradient[L];
    take<L>(gradient, x + size_t{psds.outputs[e]} * L);
    for (uint32_t i = psds.first_input[e]; i < psds.first_input[e + 1]; ++i) {
      if (d.psd_slopes[i] == 0.0f) continue;
      add_scaled<L>(x + size_t{psds.inputs[i]} * L, gradient, d.psd_slopes[i]);
    }
  }
}

template <uint32_t L>
void push_channels(Derivatives& d) {
  const ChannelTable& channels = d.rig->channels;
  std::fill(d.weights.data, d.weights.data + size_t{d.rig->channel_count} * L, 0.0f);
  for (uint32_t i = 0; i < channels.count_at_lod[d.lod]; ++i) {
    const float* from = d.controls.data + size_t{channels.inputs[i]} * L;
    std::copy(from, from + L, d.weights.data + size_t{channels.outputs[i]} * L);
  }
}

template <uint32_t L>
void pull_channels(Derivatives& d) {
  const ChannelTable& channels = d.rig->channels;
  for (uint32_t i = channels.count_at_lod[d.lod]; i-- > 0;) {
    float gradient[L];
    take<L>(gradient, d.weights.data + size_t{channels.outputs[i]} * L);
    add_scaled<L>(d.controls.data + size_t{channels.inputs[i]} * L, gradient, 1.0f);
  }
}

template <uint32_t L>
void push_maps(Derivatives& d) {
  std::fill(d.maps.data, d.maps.data + size_t{d.rig->map_count} * L, 0.0f);
  for (const TableSlope& s : d.map_slopes.first(d.map_slope_count)) {
    add_scaled<L>(d.maps.data + size_t{s.output} * L, d.controls.data + size_t{s.input} * L,
                  s.slope);
  }
}

template <uint32_t L>
void pull_maps(Derivatives& d) {
  for (const TableSlope& s : d.map_slopes.first(d.map_slope_count)) {
    add_scaled<L>(d.controls.data + size_t{s.input} * L, d.maps.data + size_t{s.output} * L,
                  s.slope);
  }
}

#define MIEN_CONTROL_LANES(L)                   \
  template void push_gui<L>(Derivatives&);      \
  template void pull_gui<L>(Derivatives&);      \
  template void push_psds<L>(Derivatives&);     \
  template void pull_psds<L>(Derivatives&);     \
  template void push_channels<L>(Derivatives&); \
  template void pull_channels<L>(Derivatives&); \
  template void push_maps<L>(Derivatives&);     \
  template void pull_maps<L>(Derivatives&);
MIEN_CONTROL_LANES(1)
MIEN_CONTROL_LANES(kBatchLanes)

}  // namespace mien
