// SPDX-License-Identifier: MIT
// mien/rig.h, except batches and mien_rig_create().
#include <algorithm>

#include "capi/handles.h"
#include "runtime/anim/control_names.h"
#include "runtime/eval/evaluate.h"
#include "runtime/eval/statistics.h"
#include "simd/kernels.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_KIND_ML_MASK == int(Kind::kMlMask) &&
                  MIEN_KIND_TWIST_SWING == int(Kind::kTwistSwing),
              "rig.h and mien.h number the same kinds");
static_assert(MIEN_STAGE_ALL == int(kStagesAll) &&
                  MIEN_STAGE_ANIMATED_MAPS == int(kStageAnimatedMaps),
              "evaluate.h and mien.h number the same stages");

// Rig ---------------------------------------------------------------------------------------------

void mien_rig_destroy(MienRig* rig) { destroy(rig); }

MienStatus mien_rig_info(const MienRig* rig, MienRigInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(rig)) return status;
  const Rig& of = *object(rig);
  MienRigInfo info = {};
  info.isa = static_cast<uint32_t>(of.kernels->isa);
  info.lod_count = of.lod_count;
  info.translation_unit = of.units.translation;
  info.rotation_unit = of.units.rotation;
  std::copy(of.units.axes, of.units.axes + 3, info.axes);
  info.rotation_sequence = of.units.rotation_sequence;
  std::copy(of.units.rotation_signs, of.units.rotation_signs + 3, info.rotation_signs);
  info.control_count = of.control_count;
  info.joint_value_count = of.joint_value_count();
  info.rotation_output =
      of.quaternion_outputs ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
  info.storage = of.half_storage ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
  info.arithmetic = of.portable ? MIEN_ARITHMETIC_PORTABLE : MIEN_ARITHMETIC_FAST;
  info.rig_bytes = of.block_size + of.baked_size + (of.changes ? of.changes->block_size : 0);
  info.instance_bytes = instance_size(of);
  write_struct(out_info, info);
  return MIEN_OK;
}

// Names and lists ---------------------------------------------------------------------------------

namespace {

MienStatus count_of(const Rig& rig, uint32_t kind, uint32_t& count) {
  if (kind < kKindsWithNames) {
    count = rig.names[kind].count();
  } else if (kind == MIEN_KIND_JOINT_GROUP) {
    count = static_cast<uint32_t>(rig.joints.group_count);
  } else if (kind == MIEN_KIND_RBF_SOLVER) {
    count = static_cast<uint32_t>(rig.rbf.solvers.count);
  } else if (kind == MIEN_KIND_TWIST_SWING) {
    count = static_cast<uint32_t>(rig.twist_swing.setups.count);
  } else {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  return MIEN_OK;
}

}  // namespace

MienStatus mien_rig_count(const MienRig* rig, uint32_t kind, uint32_t* out_count) {
  if (!out_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_count = 0;
  if (MienStatus status = check(rig)) return status;
  return count_of(*object(rig), kind, *out_count);
}

MienStatus mien_rig_name(const MienRig* rig, uint32_t kind, uint32_t index,
                         MienStringView* out_name) {
  if (!out_name) return MIEN_ERROR_NULL_ARGUMENT;
  *out_name = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  uint32_t count = 0;
  if (MienStatus status = count_of(*object(rig), kind, count)) return status;
  if (index >= count) return MIEN_ERROR_INDEX;
  *out_name = {"", 0};
  if (kind >= kKindsWithNames) return MIEN_OK;
  const Span<char> name = object(rig)->names[kind][index];
  *out_name = {name.data, name.count};
  return MIEN_OK;
}

MienStatus mien_rig_find(const MienRig* rig, uint32_t kind, const char* name, uint32_t* out_index) {
  if (out_index) *out_index = 0;
  if (!name) return MIEN_ERROR_NULL_ARGUMENT;
  return mien_rig_find_n(rig, kind, name, strlen(name), out_index);
}

MienStatus mien_rig_find_n(const MienRig* rig, uint32_t kind, const char* name, size_t name_count,
                           uint32_t* out_index) {
  if (!out_index) return MIEN_ERROR_NULL_ARGUMENT;
  *out_index = 0;
  if (MienStatus status = check(rig)) return status;
  if (!name && name_count != 0) return MIEN_ERROR_NULL_ARGUMENT;
  if (kind >= kKindsWithNames) return MIEN_ERROR_INVALID_ARGUMENT;
  const uint32_t found = find_name(object(rig)->names[kind], {name, name_count});
  if (found == kNoName) return MIEN_ERROR_NAME;
  *out_index = found;
  return MIEN_OK;
}

MienStatus mien_rig_lod_indices(const MienRig* rig, uint32_t kind, uint32_t lod,
                                MienIndex16View* out_indices) {
  if (!out_indices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_indices = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  const Rig& of = *object(rig);
  const LodLists* lists = nullptr;
  switch (kind) {
    case MIEN_KIND_JOINT: lists = &of.lod_joints; break;
    case MIEN_KIND_BLEND_SHAPE_CHANNEL: lists = &of.lod_channels; break;
    case MIEN_KIND_ANIMATED_MAP: lists = &of.lod_maps; break;
    case MIEN_KIND_MESH: lists = &of.lod_meshes; break;
    case MIEN_KIND_RBF_SOLVER: lists = &of.rbf.lod_solvers; break;
    default: return MIEN_ERROR_INVALID_ARGUMENT;
  }
  if (lod >= of.lod_count) return MIEN_ERROR_LOD;
  *out_indices = view_of(lists->at(lod));
  return MIEN_OK;
}

MienStatus mien_rig_variable_joint_values(const MienRig* rig, uint32_t lod,
                                          MienIndex16View* out_indices) {
  if (!out_indices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_indices = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  if (lod >= object(rig)->lod_count) return MIEN_ERROR_LOD;
  *out_indices = view_of(object(rig)->variable_joint_values.at(lod));
  return MIEN_OK;
}

MienStatus mien_rig_joint_parents(const MienRig* rig, MienIndex16View* out_parents) {
  if (!out_parents) return MIEN_ERROR_NULL_ARGUMENT;
  *out_parents = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  *out_parents = view_of(object(rig)->joint_parents);
  return MIEN_OK;
}

MienStatus mien_rig_neutral_joint_values(const MienRig* rig, MienFloatView* out_values) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  *out_values = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  *out_values = {object(rig)->neutral_joints.data, object(rig)->neutral_joints.count};
  return MIEN_OK;
}

MienStatus mien_rig_psd_inputs(const MienRig* rig, uint32_t psd, MienIndex16View* out_controls) {
  if (!out_controls) return MIEN_ERROR_NULL_ARGUMENT;
  *out_controls = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  const PsdTable& psds = object(rig)->psds;
  if (psd >= psds.entry_of_psd.count) return MIEN_ERROR_INDEX;
  const uint32_t entry = psds.entry_of_psd[psd];
  const uint32_t first = psds.first_input[entry];
  *out_controls = view_of(psds.inputs.slice(first, psds.first_input[entry + 1] - first));
  return MIEN_OK;
}

MienStatus mien_rig_initial_raw_controls(const MienRig* rig, MienFloatView* out_values) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  *out_values = {nullptr, 0};
  if (MienStatus status = check(rig)) return status;
  *out_values = {object(rig)->initial_controls.data, object(rig)->raw_count};
  return MIEN_OK;
}

MienStatus mien_rig_statistics(const MienRig* rig, uint32_t lod,
                               MienRigStatistics* out_statistics) {
  if (MienStatus status = clear_struct(out_statistics)) return status;
  if (MienStatus status = check(rig)) return status;
  const Rig& of = *object(rig);
  if (lod >= of.lod_count) return MIEN_ERROR_LOD;
  MienRigStatistics statistics = {};
  const RigStatistics found = rig_statistics(of, lod);
  statistics.lod = lod;
  statistics.psd_count = found.psd_count;
  statistics.joint_count = found.joint_count;
  statistics.joint_row_count = found.joint_row_count;
  statistics.blend_shape_count = found.blend_shape_count;
  statistics.animated_map_row_count = found.animated_map_row_count;
  statistics.rbf_solver_count = found.rbf_solver_count;
  statistics.quaternion_joint_count = found.quaternion_joint_count;
  statistics.joint_entry_count = found.joint_entry_count;
  statistics.joint_byte_count = found.joint_byte_count;
  write_struct(out_statistics, statistics);
  return MIEN_OK;
}

// Instance ----------------------------------------------------------------------------------------

MienStatus mien_instance_create(const MienRig* rig, const MienInstanceDesc* desc,
                                MienInstance** out_instance, MienError* error) {
  if (MienStatus status = clear_output(out_instance, error)) return status;
  if (MienStatus status = check(rig, "rig", error)) return status;
  MienInstanceDesc known;
  if (MienStatus status = read_desc(desc, known, "MienInstanceDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  Instance* instance = create_instance(*object(rig), allocator);
  if (!instance) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for an instance of %zu bytes",
                      instance_size(*object(rig)));
  }
  *out_instance = reinterpret_cast<MienInstance*>(instance);
  return succeed(error);
}

void mien_instance_destroy(MienInstance* instance) { destroy(instance); }

MienStatus mien_instance_reset(MienInstance* instance) {
  if (MienStatus status = check(instance)) return status;
  reset_instance(*object(instance));
  return MIEN_OK;
}

namespace {

/// Returns the span that `pick(instance)` selects.
template <class View, class Handle, class Pick>
MienStatus give_view(Handle* handle, View* out_view, Pick&& pick) {
  if (!out_view) return MIEN_ERROR_NULL_ARGUMENT;
  *out_view = {nullptr, 0};
  if (MienStatus status = check(handle)) return status;
  const Span<float> span = pick(*object(handle));
  *out_view = {span.data, span.count};
  return MIEN_OK;
}

}  // namespace

MienStatus mien_instance_gui_controls(MienInstance* instance, MienMutableFloatView* out_view) {
  return give_view(instance, out_view, [](Instance& i) { return i.gui; });
}

MienStatus mien_instance_raw_controls(MienInstance* instance, MienMutableFloatView* out_view) {
  return give_view(instance, out_view,
                   [](Instance& i) { return i.controls.first(i.rig->raw_count); });
}

MienStatus mien_instance_ml_masks(MienInstance* instance, MienMutableFloatView* out_view) {
  return give_view(instance, out_view, [](Instance& i) { return i.masks; });
}

MienStatus mien_instance_controls(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) { return i.controls; });
}

MienStatus mien_instance_psd_controls(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) {
    return i.controls.slice(i.rig->raw_count, i.rig->psd_count);
  });
}

MienStatus mien_instance_ml_controls(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) {
    return i.controls.slice(i.rig->raw_count + i.rig->psd_count, i.rig->ml_count);
  });
}

MienStatus mien_instance_rbf_controls(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) {
    return i.controls.slice(i.rig->raw_count + i.rig->psd_count + i.rig->ml_count,
                            i.rig->rbf_count);
  });
}

MienStatus mien_instance_joints(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) { return i.joints; });
}

MienStatus mien_instance_blend_shapes(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) { return i.channels; });
}

MienStatus mien_instance_animated_maps(const MienInstance* instance, MienFloatView* out_view) {
  return give_view(instance, out_view, [](const Instance& i) { return i.maps; });
}

MienStatus mien_instance_statistics(const MienInstance* instance,
                                    MienInstanceStatistics* out_statistics) {
  if (MienStatus status = clear_struct(out_statistics)) return status;
  if (MienStatus status = check(instance)) return status;
  const Instance& of = *object(instance);
  const InstanceStatistics found = instance_statistics(of);
  MienInstanceStatistics statistics = {};
  statistics.lod = of.lod;
  statistics.control_count = static_cast<uint32_t>(of.controls.count);
  statistics.active_control_count = found.active_control_count;
  statistics.joint_column_count = found.joint_column_count;
  statistics.joint_entry_count = found.joint_entry_count;
  statistics.joint_byte_count = found.joint_byte_count;
  write_struct(out_statistics, statistics);
  return MIEN_OK;
}

// Evaluation --------------------------------------------------------------------------------------

namespace {

MienStatus check_pair(const MienRig* rig, const MienInstance* instance) {
  if (MienStatus status = check(rig)) return status;
  if (MienStatus status = check(instance)) return status;
  return object(instance)->rig == object(rig) ? MIEN_OK : MIEN_ERROR_MISMATCH;
}

}  // namespace

MienStatus mien_rig_map_gui_to_raw(const MienRig* rig, MienInstance* instance) {
  if (MienStatus status = check_pair(rig, instance)) return status;
  map_gui_to_raw(*object(rig), *object(instance));
  return MIEN_OK;
}

MienStatus mien_rig_map_raw_to_gui(const MienRig* rig, MienInstance* instance) {
  if (MienStatus status = check_pair(rig, instance)) return status;
  map_raw_to_gui(*object(rig), *object(instance));
  return MIEN_OK;
}

MienStatus mien_rig_evaluate(const MienRig* rig, MienInstance* instance, uint32_t lod) {
  return mien_rig_evaluate_stages(rig, instance, lod, MIEN_STAGE_ALL);
}

MienStatus mien_rig_evaluate_stages(const MienRig* rig, MienInstance* instance, uint32_t lod,
                                    uint32_t stages) {
  if (MienStatus status = check_pair(rig, instance)) return status;
  if (lod >= object(rig)->lod_count) return MIEN_ERROR_LOD;
  if (stages & ~uint32_t{kStagesAll}) return MIEN_ERROR_INVALID_ARGUMENT;
  evaluate(*object(rig), *object(instance), lod, stages);
  return MIEN_OK;
}

MienStatus mien_rig_evaluate_joint_group(const MienRig* rig, MienInstance* instance, uint32_t lod,
                                         uint32_t group) {
  if (MienStatus status = check_pair(rig, instance)) return status;
  if (lod >= object(rig)->lod_count) return MIEN_ERROR_LOD;
  if (group >= object(rig)->joints.group_count) return MIEN_ERROR_INDEX;
  evaluate_joint_group(*object(rig), *object(instance), lod, group);
  return MIEN_OK;
}

MienStatus mien_rig_evaluate_rbf_solver(const MienRig* rig, MienInstance* instance, uint32_t lod,
                                        uint32_t solver) {
  if (MienStatus status = check_pair(rig, instance)) return status;
  if (lod >= object(rig)->lod_count) return MIEN_ERROR_LOD;
  if (solver >= object(rig)->rbf.solvers.count) return MIEN_ERROR_INDEX;
  evaluate_rbf_solver(*object(rig), *object(instance), lod, solver);
  return MIEN_OK;
}

MienStatus mien_rig_evaluate_twist_swing(const MienRig* rig, MienInstance* instance, uint32_t lod,
                                         uint32_t setup) {
  if (MienStatus status = check_pair(rig, instance)) return status;
  if (lod >= object(rig)->lod_count) return MIEN_ERROR_LOD;
  if (setup >= object(rig)->twist_swing.setups.count) return MIEN_ERROR_INDEX;
  evaluate_twist_swing(*object(rig), *object(instance), lod, setup);
  return MIEN_OK;
}
