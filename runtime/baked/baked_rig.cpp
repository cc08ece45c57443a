// SPDX-License-Identifier: MIT
// The rig as a part of a baked file.
#include <new>

#include "runtime/baked/baked_objects.h"
#include "runtime/baked/part_check.h"
#include "simd/joint_kernels.h"
#include "simd/rbf_kernels.h"

namespace mien {
namespace {

/// To be raised whenever the list of numbers or arrays, or the meaning of one, changes.
constexpr uint32_t kRigPartVersion = 8;

template <class AnyRig, class Visitor>
void visit_numbers(AnyRig& rig, Visitor& visitor) {
  const auto each = [&](auto&... fields) { (visitor.number(fields), ...); };
  const auto all = [&](auto& fields) {
    for (auto& field : fields) visitor.number(field);
  };
  // The settings come first, where a hex dump shows them.
  each(rig.quaternion_outputs, rig.half_storage, rig.ml.blend_masks, rig.portable);
  each(rig.lod_count, rig.units.translation, rig.units.rotation, rig.units.rotation_sequence);
  all(rig.units.axes);
  all(rig.units.rotation_signs);
  each(rig.gui_count, rig.raw_count, rig.psd_count, rig.ml_count, rig.rbf_count);
  each(rig.control_count, rig.joint_count, rig.channel_count, rig.map_count, rig.mesh_count);
  each(rig.mask_count, rig.joint_attributes);
  each(rig.joints.contested, rig.joints.group_count, rig.joints.panel_shift);
  each(rig.joints.first_strip_column);
  each(rig.rbf.independent);
  for (auto* range : {&rig.ml_writes, &rig.rbf_writes}) each(range->first, range->end);
  each(rig.feedback_stages);

  auto& ml = rig.ml;
  each(ml.buffer_size, ml.widest_layer, ml.quaternion_rotations, ml.converts);
  each(ml.scale_magnitude);
  auto& change = ml.change;
  all(change.from);
  all(change.to);
  all(change.vector);
  all(change.normal);
  all(change.turn);
  all(change.angle);
  each(change.length_unit, change.angle_unit);
  each(change.moves_axes, change.carries_angles, change.reverses_faces);
  for (auto* rotation : {&rig.rotation, &ml.rotation}) {
    all(rotation->axes);
    all(rotation->signs);
    each(rotation->parity, rotation->to_radians);
  }
  for (auto& row : ml.to_rig.m) all(row);
}

/// First what is checked when the rig is opened, then what only evaluation reads: so opening touches
/// a run of neighboring pages.
template <class AnyRig, class Visitor>
void visit_arrays(AnyRig& rig, Visitor& visitor) {
  const auto each = [&](auto&... spans) { (visitor.array(spans), ...); };
  auto& joints = rig.joints;
  auto& rotations = rig.rotations;
  auto& rbf = rig.rbf;
  auto& ml = rig.ml;

  // Indices and counts.
  for (auto* table : {&rig.gui_to_raw, &rig.maps}) {
    each(table->inputs, table->outputs, table->run_ends);
  }
  each(rig.driven_raw, rig.map_rows_at_lod);
  each(rig.raw_to_gui.first_group, rig.raw_to_gui.first_row, rig.raw_to_gui.rows);
  each(rig.psds.outputs, rig.psds.first_input, rig.psds.inputs, rig.psds.count_at_lod);
  each(rig.psds.run_lengths, rig.psds.entry_of_psd);
  each(rig.channels.inputs, rig.channels.outputs, rig.channels.count_at_lod);
  each(rotations.groups, rotations.angle_joints, rotations.turns, rotations.blocks_at_lod);
  each(rotations.first_steps, rotations.steps_at_lod, rotations.columns);
  each(rig.twist_swing.setups, rig.twist_swing.outputs, rig.twist_swing.blocks_at_lod);
  each(rig.twist_swing.inputs);
  each(rbf.plans, rbf.solvers, rbf.inputs, rbf.rotations, rbf.poses, rbf.first_input);
  each(rbf.first_output, rbf.pose_inputs, rbf.pose_outputs);
  each(ml.steps, ml.layers, ml.controls, ml.dependencies, ml.limits, ml.joints);
  for (auto* lists : {&rig.lod_joints, &rig.lod_channels, &rig.lod_maps, &rig.lod_meshes,
                      &rbf.lod_solvers, &rig.variable_joint_values}) {
    each(lists->row_of_lod, lists->first, lists->indices);
  }
  each(rig.joint_parents);
  for (auto& names : rig.names) each(names.first, names.sorted);
  each(joints.columns, joints.column_of_control, joints.starts, joints.panels, joints.targets);
  each(joints.panels_at_lod, joints.targets_at_lod, joints.group_rows_at_lod);
  each(joints.parts, joints.block_rows, joints.strips, joints.strip_inputs);

  // Any values of these are safe.
  for (auto& names : rig.names) each(names.chars);
  each(rig.control_uses, rig.initial_controls, rig.neutral_joints);
  for (auto* table : {&rig.gui_to_raw, &rig.maps}) {
    each(table->from, table->to, table->slope, table->cut);
  }
  each(rig.psds.weights, rbf.swings, rbf.pose_scales, rbf.pose_factors, rbf.pose_weights);
  each(rbf.targets, rbf.inverses, ml.default_is_one, ml.biases, ml.values, ml.halves);
  each(rotations.lane_steps_at_lod, rotations.values, rotations.halves, rig.twist_swing.lanes);
  each(joints.scales, joints.values, joints.fixed_values);
  each(joints.strip_values, joints.strip_fixed_values);
}

// Sums of their fields: padding would give one rig two images. No size depends on that of a pointer.
static_assert(sizeof(JointColumn) == 16 && sizeof(ColumnPart) == 4 && sizeof(JointPanel) == 8 &&
                  sizeof(JointTarget) == 6 && sizeof(AngleJoint) == 4 && sizeof(RowStrip) == 12,
              "");
static_assert(sizeof(GroupRotations) == 16 && sizeof(RotationOutput) == 16 &&
                  sizeof(RbfSolver) == 4,
              "");
static_assert(sizeof(RbfSolverPlan) == 48, "");
static_assert(sizeof(NetworkLayer) == 32 && sizeof(MlDependency) == 16, "");
static_assert(sizeof(MlStep) == 56 && sizeof(MlJoint) == 24, "");
static_assert(sizeof(TwistSwing) == 8, "");

template <class AnyRig, class Visitor>
void visit_rig(AnyRig& rig, Visitor& visitor) {
  visit_numbers(rig, visitor);
  visit_arrays(rig, visitor);
}

}  // namespace

PartMeasure measure_part(const Rig& rig) {
  PartMeasure measure;
  visit_rig(rig, measure);
  return measure;
}

BakedPart write_part(const Rig& rig, uint8_t* bytes) {
  const PartMeasure measure = measure_part(rig);
  PartWriter writer(measure, bytes);
  visit_rig(rig, writer);
  return measure.entry(PartKind::kRig, kRigPartVersion);
}

Status open_baked_rig(const Baked& baked, const KernelTable* kernels, const Allocator& allocator,
                      Rig*& out, Error& error) {
  out = nullptr;
  Rig* rig = create_object<Rig>(allocator, [](Placer&, Rig&) {});
  if (!rig) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for a rig of %zu bytes", sizeof(Rig));
  }
  PartReader reader(baked, *baked.rig, kRigPartVersion, measure_part(*rig), error);
  visit_rig(*rig, reader);
  Status status = reader.finish();
  if (status == Status::kOk) {
    status = check_rig(*rig, baked.rig->size, baked.check == BakedCheck::kFull, error);
  }
  if (status != Status::kOk) {
    release(rig);
    return status;
  }
  rig->bytes = share<SharedBytes>(baked);
  rig->baked_size = static_cast<size_t>(baked.rig->size);
  rig->kernels = kernels;
  out = rig;
  return Status::kOk;
}

}  // namespace mien
