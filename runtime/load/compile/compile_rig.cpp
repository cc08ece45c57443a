// SPDX-License-Identifier: MIT
#include "runtime/load/compile/compile_rig.h"

#include <algorithm>
#include <cstring>

#include "runtime/load/dna/format/dna_writer.h"
#include "runtime/rig/work.h"

namespace mien {
namespace {

using dna::Array;
using dna::DnaView;
using dna::List;
using dna::LodMap;
using dna::String;

// Names -----------------------------------------------------------------------------------------

/// Calls f(kind, index, first part, second part) for every name; only masks have a second part.
template <class F>
void for_each_name(const DnaView& view, const Rig& rig, F&& f) {
  const dna::Definition& defn = view.defn;
  const struct {
    Kind kind;
    const List<String>& names;
  } lists[] = {{Kind::kGuiControl, defn.gui_control_names},
               {Kind::kRawControl, defn.raw_control_names},
               {Kind::kMlControl, view.mlbh.control_names},
               {Kind::kRbfControl, view.rbfe.pose_control_names},
               {Kind::kJoint, defn.joint_names},
               {Kind::kBlendShapeChannel, defn.channel_names},
               {Kind::kAnimatedMap, defn.map_names},
               {Kind::kMesh, defn.mesh_names}};
  for (const auto& list : lists) {
    for (uint32_t i = 0; i < list.names.count; ++i) f(list.kind, i, list.names[i], String{});
  }
  for (uint32_t i = 0; i < rig.psd_count; ++i) {
    uint8_t text[16];  // "psd" and the number, from the end
    uint32_t at = sizeof(text);
    for (uint32_t rest = i; rest != 0 || at == sizeof(text); rest /= 10) {
      text[--at] = static_cast<uint8_t>('0' + rest % 10);
    }
    for (char c : {'d', 's', 'p'}) text[--at] = static_cast<uint8_t>(c);
    f(Kind::kPsdControl, i, String{text + at, static_cast<uint32_t>(sizeof(text)) - at}, String{});
  }
  uint32_t mask = 0;
  const auto& regions = view.mlbh.mesh_regions.region_names;
  for (uint32_t m = 0; m < regions.count; ++m) {
    const String mesh = m < defn.mesh_names.count ? defn.mesh_names[m] : String{};
    for (const String& region : regions[m]) f(Kind::kMlMask, mask++, mesh, region);
  }
}

size_t name_length(Kind kind, const String& a, const String& b) {
  return size_t{a.count} + (kind == Kind::kMlMask ? 1 + size_t{b.count} : 0);
}

void place_names(const DnaView& view, Placer& placer, Rig& rig) {
  size_t counts[kKindsWithNames] = {}, chars[kKindsWithNames] = {};
  for_each_name(view, rig, [&](Kind kind, uint32_t, const String& a, const String& b) {
    ++counts[size_t(kind)];
    chars[size_t(kind)] += name_length(kind, a, b);
  });
  for (size_t k = 0; k < kKindsWithNames; ++k) {
    rig.names[k].first = placer.array<uint32_t>(counts[k] + 1);
    rig.names[k].sorted = placer.array<uint32_t>(counts[k]);
    rig.names[k].chars = placer.array<char>(chars[k]);
  }
}

/// 0 ... count - 1 by their decimal digits: 0, 1, 10, 100, 101, ..., 11, ..., 2, ...
void sort_numbers(Span<uint32_t> sorted) {
  const uint32_t count = static_cast<uint32_t>(sorted.count);
  uint32_t number = 0;
  for (uint32_t& next : sorted) {
    next = number;
    if (number != 0 && number * 10 < count) {
      number *= 10;
    } else {
      while (number % 10 == 9 || (number != 0 && number + 1 == count)) number /= 10;
      ++number;
    }
  }
}

void fill_names(const DnaView& view, Rig& rig) {
  for_each_name(view, rig, [&](Kind kind, uint32_t i, const String& a, const String& b) {
    NameList& list = rig.names[size_t(kind)];
    char* at = list.chars.data + list.first[i];
    if (a.count) memcpy(at, a.data, a.count);
    if (kind == Kind::kMlMask) {
      at[a.count] = '/';
      if (b.count) memcpy(at + a.count + 1, b.data, b.count);
    }
    list.first[i + 1] = list.first[i] + static_cast<uint32_t>(name_length(kind, a, b));
    list.sorted[i] = i;
  });
  for (NameList& list : rig.names) {
    if (&list == &rig.names[size_t(Kind::kPsdControl)]) {
      sort_numbers(list.sorted);
      continue;
    }
    const uint32_t* const first = list.first.data;
    const char* const chars = list.chars.data;
    const auto less = [first, chars](uint32_t x, uint32_t y) {
      const size_t a = first[x + 1] - first[x], b = first[y + 1] - first[y];
      const size_t common = a < b ? a : b;
      const int order = common ? memcmp(chars + first[x], chars + first[y], common) : 0;
      if (order != 0) return order < 0;
      return a != b ? a < b : x < y;
    };
    // Names that are equal keep their order.
    if (!std::is_sorted(list.sorted.begin(), list.sorted.end(), less)) {
      std::sort(list.sorted.begin(), list.sorted.end(), less);
    }
  }
}

// Neutral pose, hierarchy, initial controls -------------------------------------------------------

void place_pose(const DnaView& view, Placer& placer, Rig& rig) {
  rig.neutral_joints = placer.array<float>(rig.joint_value_count(), kBlockAlignment);
  rig.joint_parents = placer.array<uint16_t>(view.defn.joint_hierarchy.count);
  rig.initial_controls = placer.array<float>(rig.control_count, kBlockAlignment);
  rig.control_uses = placer.array<Uses>(rig.control_count);
}

bool ends_in_w(const String& name) {
  auto ends_in = [&](const char* end) {
    const size_t n = strlen(end);
    return name.count >= n && memcmp(name.data + name.count - n, end, n) == 0;
  };
  return ends_in(".w") || ends_in(".qw");
}

void fill_pose(const DnaView& view, Rig& rig) {
  const dna::Definition& defn = view.defn;
  copy_array(defn.joint_hierarchy, rig.joint_parents);
  const Array<float>* values[6] = {&defn.neutral_translations.xs, &defn.neutral_translations.ys,
                                   &defn.neutral_translations.zs, &defn.neutral_rotations.xs,
                                   &defn.neutral_rotations.ys,    &defn.neutral_rotations.zs};
  for (uint32_t j = 0; j < rig.joint_count; ++j) {
    float neutral[kFileAttributes] = {0, 0, 0, 0, 0, 0, 1, 1, 1};
    for (int a = 0; a < 6; ++a) neutral[a] = j < values[a]->count ? (*values[a])[j] : 0.0f;
    float* joint = rig.neutral_joints.data + size_t{j} * rig.joint_attributes;
    std::copy(neutral, neutral + 3, joint);
    if (rig.quaternion_outputs) {
      const Quaternion q = quaternion_from_euler(rig.rotation, neutral + 3);
      for (float part : {q.x, q.y, q.z, q.w}) *(joint++ + 3) = part;
      std::copy(neutral + 6, neutral + 9, joint + 3);
    } else {
      std::copy(neutral + 3, neutral + 9, joint + 3);
    }
  }

  // The w of a quaternion input starts at 1 (docs/rig-evaluation.md, 1.2 "Initial values").
  const auto start_w = [&](const Array<uint16_t>& inputs) {
    for (uint32_t i = 0; i < inputs.count; ++i) {
      const uint32_t control = inputs[i];
      if (control < rig.raw_count && ends_in_w(defn.raw_control_names[control])) {
        rig.initial_controls[control] = 1.0f;
      }
    }
  };
  for (const dna::RbfSolver& solver : view.rbfb.solvers) start_w(solver.raw_control_indices);
  for (const dna::Twist& twist : view.twsw.twists) start_w(twist.input_control_indices);
  for (const dna::Swing& swing : view.twsw.swings) start_w(swing.input_control_indices);
  for (uint32_t i = 0; i < view.mlbh.control_names.count; ++i) {
    if (ends_in_w(view.mlbh.control_names[i])) rig.initial_controls[view.first_ml() + i] = 1.0f;
  }
}

// Counts ------------------------------------------------------------------------------------------

// Columns may read controls of layers that were not loaded: the row has room for them.
uint32_t count_controls(const DnaView& view) {
  uint32_t count = view.control_count();
  const auto include = [&](const auto& inputs) {
    for (uint32_t i = 0; i < inputs.count; ++i) count = std::max<uint32_t>(count, inputs[i] + 1u);
  };
  for (const dna::JointGroup& group : view.bhvr.joints.groups) include(group.input_indices);
  include(view.bhvr.channels.input_indices);
  include(view.bhvr.maps.conditionals.input_indices);
  include(view.bhvr.controls.psds.columns);
  include(view.mlbe.joints.input_indices);
  for (const dna::MlType& type : view.mlbe.types) {
    for (const auto& set : type.operations) {
      for (const dna::MlOperation& operation : set) {
        const bool controls = operation.type == uint16_t(dna::MlOperationType::kGather) ||
                              operation.type == uint16_t(dna::MlOperationType::kScatter);
        if (controls) include(operation.parameters);
      }
    }
  }
  for (const dna::RbfSolver& solver : view.rbfb.solvers) include(solver.raw_control_indices);
  for (const dna::RbfPoseControls& pose : view.rbfe.poses) {
    include(pose.input_control_indices);
    include(pose.output_control_indices);
  }
  for (const dna::Twist& twist : view.twsw.twists) include(twist.input_control_indices);
  for (const dna::Swing& swing : view.twsw.swings) include(swing.input_control_indices);
  for (const dna::NeuralNetwork& network : view.mlbh.networks) {
    include(network.input_indices);
    include(network.output_indices);
  }
  return count;
}

void count_things(const DnaView& view, const CompileOptions& options, Rig& rig) {
  const dna::Definition& defn = view.defn;
  rig.kernels = options.kernels;
  rig.quaternion_outputs = options.quaternion_outputs;
  rig.half_storage = options.half_storage;
  rig.portable = options.portable;
  rig.always_evaluate = options.always_evaluate;
  if (rig.quaternion_outputs) rig.joint_attributes = kFileAttributes + 1;
  rig.lod_count = view.desc.lod_count;
  rig.gui_count = defn.gui_control_names.count;
  rig.raw_count = defn.raw_control_names.count;
  rig.psd_count = view.bhvr.controls.psd_count;
  rig.ml_count = view.ml_control_count;
  rig.rbf_count = view.rbfe.pose_control_names.count;
  rig.control_count = count_controls(view);
  rig.joint_count = defn.joint_names.count;
  rig.channel_count = defn.channel_names.count;
  rig.map_count = defn.map_names.count;
  rig.mesh_count = defn.mesh_names.count;
  for (const auto& regions : view.mlbh.mesh_regions.region_names) rig.mask_count += regions.count;

  rig.units.translation = view.desc.translation_unit;
  rig.units.rotation = view.desc.rotation_unit;
  const dna::FileCoordinateSystem& axes = view.desc.coordinate_system;
  rig.units.axes[0] = axes.x_axis;
  rig.units.axes[1] = axes.y_axis;
  rig.units.axes[2] = axes.z_axis;
  rig.units.rotation_sequence = view.dsce.rotation_sequence;
  const dna::RotationSign& sign = view.dsce.rotation_sign;
  rig.units.rotation_signs[0] = sign.x;
  rig.units.rotation_signs[1] = sign.y;
  rig.units.rotation_signs[2] = sign.z;

  rig.rotation = rotation_convention(rig.units.rotation_sequence, rig.units.rotation_signs,
                                     rig.units.rotation);
}

Status place_all(const DnaView& view, const JointPlan& joints, const RotationPlan& rotations,
                 Placer& placer, Rig& rig, Error& error) {
  place_joints(view, joints, placer, rig);
  place_rotations(rotations, placer, rig);
  place_controls(view, placer, rig);
  place_twists_and_swings(view, placer, rig);
  place_pose(view, placer, rig);
  place_lod_lists(view.defn.lod_joints, rig.lod_count, placer, rig.lod_joints);
  place_lod_lists(view.defn.lod_channels, rig.lod_count, placer, rig.lod_channels);
  place_lod_lists(view.defn.lod_maps, rig.lod_count, placer, rig.lod_maps);
  place_lod_lists(view.defn.lod_meshes, rig.lod_count, placer, rig.lod_meshes);
  place_names(view, placer, rig);
  Status status = place_rbf(view, placer, rig, error);
  return status == Status::kOk ? place_ml(view, placer, rig, error) : status;
}

/// `reach` is zeroed scratch, one for each control.
Status fill_all(const DnaView& view, JointPlan& joints, const RotationPlan& rotations,
                Span<uint8_t> reach, Arena& scratch, Rig& rig, Error& error) {
  Status status = fill_controls(view, scratch, rig, error);
  if (status != Status::kOk) return status;
  // Which LODs read a control decides which correctives they need.
  fill_joints(view, joints, reach, rig);
  mark_ml_joint_inputs(view, rig.lod_count, reach);
  status = fill_psds(view, reach, scratch, rig, error);
  if (status == Status::kOk) fill_rotations(view, rotations, rig);
  if (status == Status::kOk) status = fill_rbf(view, scratch, rig, error);
  if (status == Status::kOk) status = fill_twists_and_swings(view, scratch, rig, error);
  if (status == Status::kOk) status = fill_ml(view, scratch, rig, error);
  if (status != Status::kOk) return status;
  fill_variable_joint_values(view, rig);
  fill_pose(view, rig);
  fill_lod_lists(view.defn.lod_joints, rig.lod_joints);
  fill_lod_lists(view.defn.lod_channels, rig.lod_channels);
  fill_lod_lists(view.defn.lod_maps, rig.lod_maps);
  fill_lod_lists(view.defn.lod_meshes, rig.lod_meshes);
  fill_names(view, rig);
  fill_stage_access(rig);
  return Status::kOk;
}

/// Estimate of the scratch memory of compiling.
size_t scratch_bytes(const DnaView& view, const Rig& rig) {
  size_t bytes = size_t{rig.joint_value_count()} * 8 + size_t{rig.control_count} * 32 +
                 size_t{view.bhvr.controls.conditionals.input_indices.count} * 4 +
                 size_t{view.bhvr.controls.psds.rows.count} * 8 + size_t{rig.psd_count} * 24;
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    const size_t rows = group.output_indices.count, blocks = rows / kJointBlockRows + 2;
    bytes += rows * (3 + 2 * sizeof(PlannedTarget)) + group.input_indices.count * 2 +
             rows * ((group.input_indices.count + 63) / 64) * 8 +
             blocks * (2 * sizeof(PlannedRows) + group.input_indices.count * 5 + 40) + 184;
  }
  return bytes;
}

}  // namespace

void mark_joint_lods(const DnaView& view, Span<uint64_t> lods) {
  for (uint32_t l = 0; l < view.desc.lod_count; ++l) {
    const Array<uint16_t> row = view.defn.lod_joints.at(l);
    for (uint32_t i = 0; i < row.count; ++i) lods[row[i]] |= uint64_t{1} << l;
  }
  for (uint64_t& bits : lods) {
    if (bits == 0) bits = ~uint64_t{0};
  }
}

void place_lod_lists(const LodMap& map, uint32_t lod_count, Placer& placer, LodLists& lists) {
  size_t total = 0;
  for (const Array<uint16_t>& row : map.indices) total += row.count;
  lists.row_of_lod = placer.array<uint16_t>(std::min(map.lods.count, lod_count));
  lists.first = placer.array<uint32_t>(size_t{map.indices.count} + 1);
  lists.indices = placer.array<uint16_t>(total);
}

void fill_lod_lists(const LodMap& map, LodLists& lists) {
  for (size_t l = 0; l < lists.row_of_lod.count; ++l) lists.row_of_lod[l] = map.lods[l];
  for (uint32_t r = 0; r < map.indices.count; ++r) {
    copy_array(map.indices[r], lists.indices.slice(lists.first[r], map.indices[r].count));
    lists.first[r + 1] = lists.first[r] + map.indices[r].count;
  }
}

uint64_t compile_budget(const DnaView& view, const Rig& rig) {
  return work_budget(std::min<uint64_t>(view.file_size, rig.block_size));
}

Status compile_rig(const DnaView& view, const CompileOptions& options, const Allocator& allocator,
                   Rig*& out, Error& error) {
  out = nullptr;
  Rig measured;
  count_things(view, options, measured);
  if (options.quaternion_outputs &&
      measured.joint_value_count() + size_t{measured.joint_count} * 3 > kNoOutput) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "%u joints are too many for quaternion outputs; use MIEN_ROTATION_OUTPUT_EULER",
                measured.joint_count);
  }
  // A mesh's name is repeated for each of its regions, so a long one multiplies.
  constexpr size_t kMaxMaskNameBytes = size_t{1} << 20;
  size_t mask_name_bytes = 0;
  for_each_name(view, measured, [&](Kind kind, uint32_t, const String& a, const String& b) {
    if (kind == Kind::kMlMask) mask_name_bytes += name_length(kind, a, b);
  });
  if (mask_name_bytes > kMaxMaskNameBytes) {
    return fail(
        error, Status::kDnaLimit, kNoOffset,
        "mlbh.neuralNetworkToMeshRegion.regionNames: the names of the regions take %zu bytes "
        "with those of their meshes; at most %zu are supported",
        mask_name_bytes, kMaxMaskNameBytes);
  }
  Arena scratch(allocator);
  scratch.expect(scratch_bytes(view, measured));
  JointPlan joints;
  Status status = plan_joints(view, measured, scratch, joints, error);
  if (status != Status::kOk) return status;
  RotationPlan rotations;
  status = plan_rotations(view, joints, measured, scratch, rotations, error);
  if (status != Status::kOk) return status;
  Placer measure(nullptr);
  measure.object<Rig>();
  status = place_all(view, joints, rotations, measure, measured, error);
  if (status != Status::kOk) return status;

  Span<uint8_t> reach = scratch.array<uint8_t>(measured.control_count);
  void* block = nullptr;
  if (reach.data || measured.control_count == 0) {
    block = allocator.get(measure.size(), kBlockAlignment);
  }
  if (!block) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for a rig of %zu bytes",
                measure.size());
  }

  Placer placer(block);
  placer.object<Rig>();
  Rig* rig = start_object<Rig>(block, measure.size(), allocator);
  rig->ml.blend_masks = options.blend_masks;
  count_things(view, options, *rig);
  status = place_all(view, joints, rotations, placer, *rig, error);
  if (status == Status::kOk)
    status = fill_all(view, joints, rotations, reach, scratch, *rig, error);
  if (status != Status::kOk) {
    release(rig);
    return status;
  }
  out = rig;
  return Status::kOk;
}

}  // namespace mien
