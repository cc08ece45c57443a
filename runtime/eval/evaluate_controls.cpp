// SPDX-License-Identifier: MIT
// Stages from controls to single values: conditional tables both ways, correctives, blend shapes,
// animated maps (docs/rig-evaluation.md, 2, 3 and 5).
#include <algorithm>

#include "runtime/eval/changes.h"
#include "runtime/eval/evaluate.h"
#include "runtime/eval/stages.h"
#include "simd/kernels.h"

namespace mien {
namespace {

/// NaN becomes 0.
float clamp01(float value) { return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; }

// docs/rig-evaluation.md, 2.2 "Forward", without the final clamp.
void add_table_rows(const ControlTable& table, uint32_t row_count, const Span<float>& inputs,
                    const Span<float>& outputs) {
  for (uint32_t r = 0; r < row_count;) {
    const float input = inputs[table.inputs[r]];
    if (table.from[r] <= input && input <= table.to[r]) {
      outputs[table.outputs[r]] += table.slope[r] * input + table.cut[r];
      r = table.run_ends[r];
    } else {
      ++r;
    }
  }
}

}  // namespace

void map_gui_to_raw(const Rig& rig, Instance& instance) {
  for (uint16_t raw : rig.driven_raw) instance.controls[raw] = 0.0f;
  add_table_rows(rig.gui_to_raw, static_cast<uint32_t>(rig.gui_to_raw.inputs.count), instance.gui,
                 instance.controls);
  for (uint16_t raw : rig.driven_raw) instance.controls[raw] = clamp01(instance.controls[raw]);
}

// docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls": of the groups of rows with equal
// intervals, the one that explains the most raw controls gives the value.
void map_raw_to_gui(const Rig& rig, Instance& instance) {
  const ControlTable& table = rig.gui_to_raw;
  const ReverseTable& reverse = rig.raw_to_gui;
  const auto solve = [&](uint32_t row) {
    return (instance.controls[table.outputs[row]] - table.cut[row]) / table.slope[row];
  };
  // A flat row explains nothing, even if its interval is unbounded.
  const auto within = [&](uint32_t row, float value) {
    return table.slope[row] != 0.0f && table.from[row] <= value && value <= table.to[row];
  };

  for (uint32_t i = 0; i < rig.gui_count; ++i) {
    instance.gui[i] = 0.0f;
    const uint32_t begin = reverse.first_group[i], end = reverse.first_group[i + 1];
    uint32_t best = begin, most = 0;
    for (uint32_t g = begin; g < end; ++g) {
      uint32_t consistent = 0;
      for (uint32_t k = reverse.first_row[g]; k < reverse.first_row[g + 1]; ++k) {
        const uint32_t row = reverse.rows[k];
        consistent += instance.controls[table.outputs[row]] != 0.0f && within(row, solve(row));
      }
      if (consistent > most) {
        most = consistent;
        best = g;
      }
    }
    if (begin == end) continue;
    for (uint32_t k = reverse.first_row[best]; k < reverse.first_row[best + 1]; ++k) {
      const uint32_t row = reverse.rows[k];
      const float value = solve(row);
      if (!within(row, value)) continue;
      instance.gui[i] = value;
      break;
    }
  }
}

// docs/rig-evaluation.md, 3.3 "Value", in order of dependency.
void evaluate_psds(const Rig& rig, Instance& instance, uint32_t lod) {
  if (rig.changes && evaluate_changed_psds(rig, instance, lod)) return;
  const PsdTable& psds = rig.psds;
  note_written_psds(
      instance, rig.kernels->psds({psds.outputs.data, psds.weights.data, psds.first_input.data,
                                   psds.inputs.data, psds.run_lengths.data, rig.control_uses.data,
                                   instance.controls.data, psds.count_at_lod[lod]}));
  if (rig.changes) mark_all_psds(rig, instance);
}

// docs/rig-evaluation.md, 5 "Blend shapes and animated maps".
void evaluate_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod) {
  if (rig.changes && evaluate_changed_blend_shapes(rig, instance, lod)) return;
  const uint32_t count = rig.channels.count_at_lod[lod];
  for (uint32_t i = 0; i < count; ++i) {
    instance.channels[rig.channels.outputs[i]] = instance.controls[rig.channels.inputs[i]];
  }
}

void evaluate_animated_maps(const Rig& rig, Instance& instance, uint32_t lod) {
  if (rig.changes && evaluate_changed_maps(rig, instance, lod)) return;
  std::fill(instance.maps.begin(), instance.maps.end(), 0.0f);
  add_table_rows(rig.maps, rig.map_rows_at_lod[lod], instance.controls, instance.maps);
  for (float& value : instance.maps) value = clamp01(value);
}

}  // namespace mien
