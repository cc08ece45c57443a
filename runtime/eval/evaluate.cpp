// SPDX-License-Identifier: MIT
#include "runtime/eval/evaluate.h"

#include <algorithm>
#include <cstring>

namespace mien {
namespace {

/// NaN becomes 0.
float clamp01(float value) { return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; }

// Outputs that a LOD does not write stay 0 from here on, so evaluation needs to clear nothing.
// Raw controls belong to the caller.
void enter_lod(const Rig& rig, Instance& instance, uint32_t lod) {
  if (instance.lod == lod) return;
  instance.lod = lod;
  std::copy(rig.initial_controls.begin() + rig.raw_count, rig.initial_controls.end(),
            instance.controls.begin() + rig.raw_count);
  clear_outputs(instance);
}

bool same_rows(const float* a, const float* b, size_t count) {
  return count == 0 || memcmp(a, b, count * sizeof(float)) == 0;
}

/// Whether `seen`, which becomes `now`, differed from it. Marks the panels of the joint matrix that
/// read the controls `first` ... that did.
bool note_changes(const Rig& rig, Instance& instance, uint32_t first, const Span<float>& seen) {
  const float* now = instance.controls.data + first;
  if (same_rows(seen.data, now, seen.count)) return false;
  for (size_t i = 0; i < seen.count; ++i) {
    if (same_bits(seen[i], now[i])) continue;
    instance.stale_panels |= rig.joints.control_panels[first + i];
    seen[i] = now[i];
  }
  return true;
}

/// Looks for what the caller changed.
void find_changes(const Rig& rig, Instance& instance) {
  if (rig.always_evaluate) return forget_results(instance);
  if (note_changes(rig, instance, 0, instance.previous_inputs.first(rig.raw_count))) {
    instance.stale_stages = kStagesAll;
  }
  const Span<float> seen = instance.previous_inputs.slice(rig.raw_count, rig.mask_count);
  if (same_rows(seen.data, instance.masks.data, seen.count)) return;
  std::copy(instance.masks.begin(), instance.masks.end(), seen.begin());
  instance.stale_stages |= kStageMl;
}

/// Stages that read controls of networks and poses, or correctives.
constexpr uint32_t kStagesOutputs = kStageJoints | kStageBlendShapes | kStageAnimatedMaps;
constexpr uint32_t kStagesAfterMl = kStageRbf | kStagePsd | kStagesOutputs;

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

// docs/rig-evaluation.md, 3.3 "Value", in dependency order.
void evaluate_psds(const Rig& rig, Instance& instance, uint32_t lod) {
  const PsdTable& psds = rig.psds;
  const PsdChanges changes =
      rig.kernels->psds({psds.outputs.data, psds.weights.data, psds.first_input.data,
                         psds.inputs.data, psds.run_lengths.data, rig.joints.control_panels.data,
                         instance.controls.data, psds.count_at_lod[lod]});
  note_changed_psds(instance, changes.marks, changes.any);
}

void evaluate_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  // What networks add to joints must not be added twice, and where rows contend for an output the
  // last one is to write last.
  const bool all = !rig.ml.joints.empty() || rig.joints.contested;
  const uint64_t panels = all ? kAllPanels : instance.stale_panels;
  begin_joints(rig, instance, lod);
  evaluate_joint_rows(rig, instance, lod, panels, kAllGroups);
  finish_joints(rig, instance, lod);
}

// docs/rig-evaluation.md, 5 "Blend shapes and animated maps".
void evaluate_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod) {
  const uint32_t count = rig.channels.count_at_lod[lod];
  for (uint32_t i = 0; i < count; ++i) {
    instance.channels[rig.channels.outputs[i]] = instance.controls[rig.channels.inputs[i]];
  }
}

void evaluate_animated_maps(const Rig& rig, Instance& instance, uint32_t lod) {
  std::fill(instance.maps.begin(), instance.maps.end(), 0.0f);
  add_table_rows(rig.maps, rig.map_rows_at_lod[lod], instance.controls, instance.maps);
  for (float& value : instance.maps) value = clamp01(value);
}

}  // namespace

void map_gui_to_raw(const Rig& rig, Instance& instance) {
  for (uint16_t raw : rig.driven_raw) instance.controls[raw] = 0.0f;
  add_table_rows(rig.gui_to_raw, static_cast<uint32_t>(rig.gui_to_raw.inputs.count), instance.gui,
                 instance.controls);
  for (uint16_t raw : rig.driven_raw) instance.controls[raw] = clamp01(instance.controls[raw]);
}

// docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls": of the groups of rows with equal
// intervals the one that explains the most raw controls tells the value.
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

void note_changed_psds(Instance& instance, uint64_t panels, bool changed) {
  instance.stale_stages &= ~uint32_t{kStagePsd};
  if (!changed) return;
  instance.stale_panels |= panels;
  instance.stale_stages |= kStagesOutputs;
}

void begin_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  clear_ml_joints(rig, instance, lod);
}

void finish_joints(const Rig& rig, Instance& instance, uint32_t lod) {
  const RotationTable& rotations = rig.rotations;
  if (!rotations.angle_joints.empty() || !rotations.quaternion_joints.empty()) {
    for (uint32_t g = 0; g < rig.joints.group_count; ++g) evaluate_rotations(rig, instance, lod, g);
  }
  for (const TwistSwing& setup : rig.twist_swing.setups)
    apply_twist_swing(rig, instance, lod, setup);
  add_ml_joints(rig, instance, lod);
  instance.stale_panels = 0;
  instance.stale_stages &= ~uint32_t{kStageJoints};
}

void evaluate(const Rig& rig, Instance& instance, uint32_t lod, uint32_t stages) {
  begin_evaluation(rig, instance, lod);
  evaluate_stages(rig, instance, lod, stages);
}

void begin_evaluation(const Rig& rig, Instance& instance, uint32_t lod) {
  enter_lod(rig, instance, lod);
  find_changes(rig, instance);
}

void evaluate_stages(const Rig& rig, Instance& instance, uint32_t lod, uint32_t stages) {
  const auto runs = [&](uint32_t stage) {
    if ((stages & instance.stale_stages & stage) == 0) return false;
    instance.stale_stages &= ~stage;
    return true;
  };
  if (runs(kStageMl)) {
    evaluate_ml(rig, instance, lod);
    if (note_changes(rig, instance, rig.raw_count + rig.psd_count, instance.previous_after_psds)) {
      instance.stale_stages |= kStagesAfterMl;
    }
  }
  if (runs(kStageRbf)) {
    evaluate_rbf(rig, instance, lod);
    if (note_changes(rig, instance, rig.raw_count + rig.psd_count, instance.previous_after_psds)) {
      instance.stale_stages |= kStagePsd | kStagesOutputs;
    }
  }
  if (runs(kStagePsd)) evaluate_psds(rig, instance, lod);
  if (runs(kStageJoints)) evaluate_joints(rig, instance, lod);
  if (runs(kStageBlendShapes)) evaluate_blend_shapes(rig, instance, lod);
  if (runs(kStageAnimatedMaps)) evaluate_animated_maps(rig, instance, lod);
}

void evaluate_joint_group(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group) {
  enter_lod(rig, instance, lod);
  evaluate_joint_rows(rig, instance, lod, kAllPanels, group);
  evaluate_rotations(rig, instance, lod, group);
  forget_results(instance);
}

void evaluate_rbf_solver(const Rig& rig, Instance& instance, uint32_t lod, uint32_t solver) {
  enter_lod(rig, instance, lod);
  solve_rbf(rig, instance, solver);
  forget_results(instance);
}

void evaluate_twist_swing(const Rig& rig, Instance& instance, uint32_t lod, uint32_t setup) {
  enter_lod(rig, instance, lod);
  apply_twist_swing(rig, instance, lod, rig.twist_swing.setups[setup]);
  forget_results(instance);
}

}  // namespace mien
