// SPDX-License-Identifier: MIT
#include "tests/support/layer_rig.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using dna::List;
using dna::String;

struct Maker {
  Arena& arena;

  template <class T>
  dna::Array<T> numbers(const std::vector<T>& values) {
    const dna::NewArray<T> array = dna::new_array<T>(arena, values.size());
    for (size_t i = 0; i < values.size(); ++i) array.set(i, values[i]);
    return array;
  }
  template <class T>
  List<T> list(const std::vector<T>& items) {
    const Span<T> span = arena.array<T>(items.size());
    std::copy(items.begin(), items.end(), span.begin());
    return {span.data, static_cast<uint32_t>(span.count)};
  }
  String name(const std::string& text) {
    const Span<uint8_t> bytes = arena.array<uint8_t>(text.size());
    std::copy(text.begin(), text.end(), bytes.begin());
    return {bytes.data, static_cast<uint32_t>(bytes.count)};
  }
  List<String> names(const std::string& stem, size_t count, const std::vector<uint16_t>& with_w) {
    std::vector<String> all;
    for (size_t i = 0; i < count; ++i) {
      const bool w = std::find(with_w.begin(), with_w.end(), i) != with_w.end();
      all.push_back(name(stem + std::to_string(i) + (w ? ".w" : "")));
    }
    return list(all);
  }
  dna::LodMap lods(const LodIndices& rows, size_t all, size_t lod_count) {
    std::vector<uint16_t> row_of_lod, everything;
    std::vector<dna::Array<uint16_t>> arrays;
    for (size_t i = 0; i < all; ++i) everything.push_back(static_cast<uint16_t>(i));
    for (size_t l = 0; l < lod_count; ++l) {
      row_of_lod.push_back(static_cast<uint16_t>(l));
      arrays.push_back(numbers(rows.empty() ? everything : rows[l]));
    }
    return {numbers(row_of_lod), list(arrays)};
  }
  /// Of pairs, the first or the second.
  dna::Array<uint16_t> side(const std::vector<std::pair<uint16_t, uint16_t>>& pairs, bool second) {
    std::vector<uint16_t> all;
    for (const auto& pair : pairs) all.push_back(second ? pair.second : pair.first);
    return numbers(all);
  }
};

void add_rbf(const LayerRig& rig, Maker& make, dna::DnaView& view) {
  std::vector<dna::RbfSolver> solvers;
  for (const PlainRbfSolver& from : rig.solvers) {
    dna::RbfSolver s;
    s.name = make.name("solver" + std::to_string(solvers.size()));
    s.raw_control_indices = make.numbers(from.inputs);
    s.pose_indices = make.numbers(from.poses);
    s.raw_control_values = make.numbers(from.targets);
    s.radius = from.radius;
    s.weight_threshold = from.threshold;
    s.solver_type = from.type;
    s.automatic_radius = from.automatic_radius;
    s.distance_method = from.distance;
    s.normalize_method = from.normalize;
    s.function_type = from.function;
    s.twist_axis = from.axis;
    solvers.push_back(s);
  }
  std::vector<dna::RbfPose> poses;
  std::vector<dna::RbfPoseControls> controls;
  for (const PlainRbfPose& from : rig.poses) {
    poses.push_back({make.name("pose" + std::to_string(poses.size())), from.scale});
    controls.push_back(
        {make.numbers(from.inputs), make.numbers(from.outputs), make.numbers(from.weights)});
  }
  view.rbfb.lod_solvers = make.lods(rig.lod_solvers, solvers.size(), rig.base.lod_count);
  view.rbfb.solvers = make.list(solvers);
  view.rbfb.poses = make.list(poses);
  view.rbfe.pose_control_names = make.names("rbf", rig.rbf_count, {});
  view.rbfe.poses = make.list(controls);
}

void add_networks(const LayerRig& rig, Maker& make, dna::DnaView& view) {
  dna::MachineLearnedBehavior& ml = view.mlbh;
  ml.control_names = make.names("ml", rig.ml_count, rig.ml_w);
  view.ml_control_count = rig.ml_count;
  ml.lod_networks = make.lods(rig.lod_networks, rig.networks.size(), rig.base.lod_count);
  std::vector<dna::NeuralNetwork> networks;
  for (const PlainNetwork& from : rig.networks) {
    std::vector<dna::NetworkLayer> layers;
    for (const PlainNetworkLayer& l : from.layers) {
      layers.push_back({make.numbers(l.biases), make.numbers(l.weights), l.function,
                        make.numbers(l.parameters)});
    }
    dna::NeuralNetwork network;
    network.input_indices = make.numbers(from.inputs);
    network.output_indices = make.numbers(from.outputs);
    network.layers = make.list(layers);
    networks.push_back(network);
  }
  ml.networks = make.list(networks);
  if (!rig.regions.empty()) {
    std::vector<dna::Array<uint16_t>> regions;
    for (const auto& region : rig.regions) regions.push_back(make.numbers(region));
    view.defn.mesh_names = make.list<String>({make.name("mesh")});
    view.defn.lod_meshes = make.lods({}, 1, rig.base.lod_count);
    ml.mesh_regions.region_names =
        make.list<List<String>>({make.names("region", rig.regions.size(), {})});
    ml.mesh_regions.indices = make.list<List<dna::Array<uint16_t>>>({make.list(regions)});
  }
}

void add_operations(const LayerRig& rig, Maker& make, dna::DnaView& view) {
  if (!rig.operations.empty()) {
    std::vector<List<dna::MlOperation>> sets;
    std::vector<dna::LodMap> lods;
    for (const PlainOperationSet& set : rig.operations) {
      std::vector<dna::MlOperation> operations;
      for (const PlainOperation& from : set) {
        dna::MlOperation operation;
        operation.type = static_cast<uint16_t>(from.type);
        operation.parameters = make.numbers(from.parameters);
        operation.set_dependencies = make.side(from.dependencies, false);
        operation.operation_dependencies = make.side(from.dependencies, true);
        operations.push_back(operation);
      }
      sets.push_back(make.list(operations));
      lods.push_back(make.lods({}, operations.size(), rig.base.lod_count));
    }
    dna::MlType type;
    type.operations = make.list(sets);
    type.lod_operations = make.list(lods);
    view.mlbe.types = make.list<dna::MlType>({type});
  }
  dna::MlJoints& joints = view.mlbe.joints;
  joints.parameter_keys = make.side(rig.ml_parameters, false);
  joints.parameter_values = make.side(rig.ml_parameters, true);
  joints.input_indices = make.side(rig.ml_joints, false);
  joints.output_indices = make.side(rig.ml_joints, true);
}

template <class Turn>
List<Turn> turns(const std::vector<PlainTurn>& from, Maker& make) {
  std::vector<Turn> all;
  for (const PlainTurn& turn : from) {
    all.push_back({make.numbers(turn.blends), make.numbers(turn.joints), make.numbers(turn.inputs),
                   turn.axis});
  }
  return make.list(all);
}

// The way back.

template <class T>
std::vector<T> copy_array(const dna::Array<T>& array) {
  std::vector<T> all(array.count);
  for (uint32_t i = 0; i < array.count; ++i) all[i] = array[i];
  return all;
}

/// LODs that the file leaves out have no rows.
std::vector<uint16_t> row_counts(const dna::Array<uint16_t>& lods, size_t lod_count) {
  std::vector<uint16_t> counts = copy_array(lods);
  counts.resize(lod_count);
  return counts;
}

LodIndices read_lods(const dna::LodMap& map, size_t lod_count) {
  LodIndices rows;
  for (size_t lod = 0; lod < lod_count; ++lod) rows.push_back(copy_array(map.at(lod)));
  return rows;
}

PlainTable read_table(const dna::ConditionalTable& t) {
  PlainTable table;
  for (uint32_t r = 0; r < t.input_indices.count; ++r) {
    table.push_back({t.input_indices[r], t.output_indices[r], t.from_values[r], t.to_values[r],
                     t.slope_values[r], t.cut_values[r]});
  }
  return table;
}

std::vector<uint16_t> with_w(const List<String>& names) {
  std::vector<uint16_t> found;
  for (uint32_t i = 0; i < names.count; ++i) {
    const std::string name(names[i].chars(), names[i].count);
    for (const std::string end : {".w", ".qw"}) {
      const bool ends =
          name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
      if (ends) found.push_back(static_cast<uint16_t>(i));
    }
  }
  return found;
}

std::vector<std::pair<uint16_t, uint16_t>> read_pairs(const dna::Array<uint16_t>& first,
                                                      const dna::Array<uint16_t>& second) {
  std::vector<std::pair<uint16_t, uint16_t>> pairs;
  for (uint32_t i = 0; i < first.count; ++i) pairs.emplace_back(first[i], second[i]);
  return pairs;
}

void read_base(const dna::DnaView& view, PlainRig& base) {
  const dna::Behavior& bhvr = view.bhvr;
  const auto count = [](const List<String>& names) { return static_cast<uint16_t>(names.count); };
  base.lod_count = view.desc.lod_count;
  base.gui_count = count(view.defn.gui_control_names);
  base.raw_count = count(view.defn.raw_control_names);
  base.psd_count = bhvr.controls.psd_count;
  base.joint_count = count(view.defn.joint_names);
  base.channel_count = count(view.defn.channel_names);
  base.map_count = count(view.defn.map_names);
  base.gui_to_raw = read_table(bhvr.controls.conditionals);
  const dna::PsdTable& psds = bhvr.controls.psds;
  for (uint32_t i = 0; i < psds.rows.count; ++i) {
    base.psds.push_back({psds.rows[i], psds.columns[i], psds.values[i]});
  }
  for (const dna::JointGroup& group : bhvr.joints.groups) {
    base.groups.push_back({row_counts(group.lods, base.lod_count), copy_array(group.input_indices),
                           copy_array(group.output_indices), copy_array(group.values)});
  }
  base.channel_lods = row_counts(bhvr.channels.lods, base.lod_count);
  base.channel_inputs = copy_array(bhvr.channels.input_indices);
  base.channel_outputs = copy_array(bhvr.channels.output_indices);
  base.map_lods = row_counts(bhvr.maps.lods, base.lod_count);
  base.maps = read_table(bhvr.maps.conditionals);
}

void read_rbf(const dna::DnaView& view, LayerRig& rig) {
  for (const dna::RbfSolver& s : view.rbfb.solvers) {
    rig.solvers.push_back({copy_array(s.raw_control_indices), copy_array(s.pose_indices),
                           copy_array(s.raw_control_values), s.radius, s.weight_threshold,
                           s.solver_type, s.automatic_radius, s.distance_method, s.normalize_method,
                           s.function_type, s.twist_axis});
  }
  rig.lod_solvers = read_lods(view.rbfb.lod_solvers, rig.base.lod_count);
  for (uint32_t p = 0; p < view.rbfb.poses.count; ++p) {
    // Before 2.5 each pose drives a control of its own.
    PlainRbfPose pose = {
        view.rbfb.poses[p].scale, {}, {static_cast<uint16_t>(rig.first_rbf() + p)}, {1.0f}};
    if (view.rbfe.pose_control_names.count != 0) {
      const dna::RbfPoseControls& controls = view.rbfe.poses[p];
      pose = {pose.scale, copy_array(controls.input_control_indices),
              copy_array(controls.output_control_indices),
              copy_array(controls.output_control_weights)};
    }
    rig.poses.push_back(pose);
  }
}

void read_networks(const dna::DnaView& view, LayerRig& rig) {
  for (const dna::NeuralNetwork& n : view.mlbh.networks) {
    PlainNetwork network = {copy_array(n.input_indices), copy_array(n.output_indices), {}};
    for (const dna::NetworkLayer& l : n.layers) {
      network.layers.push_back(
          {copy_array(l.biases), copy_array(l.weights), l.function_id, copy_array(l.parameters)});
    }
    rig.networks.push_back(network);
  }
  rig.lod_networks = read_lods(view.mlbh.lod_networks, rig.base.lod_count);
  for (const auto& mesh : view.mlbh.mesh_regions.indices) {
    for (const auto& region : mesh) rig.regions.push_back(copy_array(region));
  }
  for (const dna::MlType& type : view.mlbe.types) {
    const auto first_set = static_cast<uint16_t>(rig.operations.size());
    for (uint32_t s = 0; s < type.operations.count; ++s) {
      PlainOperationSet set;
      for (const dna::MlOperation& o : type.operations[s]) {
        set.push_back({static_cast<OperationType>(o.type), copy_array(o.parameters),
                       read_pairs(o.set_dependencies, o.operation_dependencies)});
        for (auto& dependency : set.back().dependencies) dependency.first += first_set;
      }
      rig.operations.push_back(set);
      rig.lod_operations.push_back(read_lods(type.lod_operations[s], rig.base.lod_count));
    }
  }
  const dna::MlJoints& joints = view.mlbe.joints;
  rig.ml_parameters = read_pairs(joints.parameter_keys, joints.parameter_values);
  rig.ml_joints = read_pairs(joints.input_indices, joints.output_indices);
}

template <class Turn>
std::vector<PlainTurn> read_turns(const List<Turn>& from) {
  std::vector<PlainTurn> turns;
  for (const Turn& turn : from) {
    turns.push_back({turn.twist_axis, copy_array(turn.input_control_indices),
                     copy_array(turn.output_joint_indices), copy_array(turn.blend_weights)});
  }
  return turns;
}

}  // namespace

LayerRig read_layer_rig(const dna::DnaView& view, const RigHandle& of) {
  LayerRig rig;
  read_base(view, rig.base);
  rig.ml_count = static_cast<uint16_t>(view.ml_control_count);
  rig.rbf_count = static_cast<uint16_t>(count_of(of, MIEN_KIND_RBF_CONTROL));
  rig.absent_count = static_cast<uint16_t>(info_of(of).control_count - rig.control_count());
  rig.rotation_unit = view.desc.rotation_unit;
  rig.sequence = static_cast<uint16_t>(view.dsce.rotation_sequence);
  rig.signs = {view.dsce.rotation_sign.x, view.dsce.rotation_sign.y, view.dsce.rotation_sign.z};
  const dna::FileCoordinateSystem& system = view.desc.coordinate_system;
  rig.axes = {system.x_axis, system.y_axis, system.z_axis};
  rig.rotations.resize(rig.base.joint_count);
  for (uint32_t j = 0; j < view.jbmd.joints.count && j < rig.rotations.size(); ++j) {
    rig.rotations[j] = view.jbmd.joints[j].rotation;
  }
  rig.lod_joints = read_lods(view.defn.lod_joints, rig.base.lod_count);
  rig.raw_w = with_w(view.defn.raw_control_names);
  rig.ml_w = with_w(view.mlbh.control_names);
  read_rbf(view, rig);
  read_networks(view, rig);
  rig.twists = read_turns(view.twsw.twists);
  rig.swings = read_turns(view.twsw.swings);
  return rig;
}

dna::DnaView to_view(const LayerRig& rig, Arena& arena) {
  Maker make{arena};
  dna::DnaView view = to_view(rig.base, arena);
  view.desc.rotation_unit = rig.rotation_unit;
  view.desc.coordinate_system = {rig.axes[0], rig.axes[1], rig.axes[2]};
  view.dsce.rotation_sequence = rig.sequence;
  view.dsce.rotation_sign = {rig.signs[0], rig.signs[1], rig.signs[2]};
  view.defn.raw_control_names = make.names("raw", rig.base.raw_count, rig.raw_w);
  view.defn.lod_joints = make.lods(rig.lod_joints, rig.base.joint_count, rig.base.lod_count);
  std::vector<dna::JointRepresentation> representations;
  for (uint16_t rotation : rig.rotations) representations.push_back({0, rotation, 0});
  view.jbmd.joints = make.list(representations);
  if (!rig.solvers.empty()) add_rbf(rig, make, view);
  add_networks(rig, make, view);
  add_operations(rig, make, view);
  view.twsw.twists = turns<dna::Twist>(rig.twists, make);
  view.twsw.swings = turns<dna::Swing>(rig.swings, make);
  return view;
}

LayerFile::LayerFile(const LayerRig& rig) {
  Arena arena(default_allocator());
  bytes = write_view(to_view(rig, arena));
  dna = open_dna(bytes);
}

std::vector<float> random_raw(const LayerRig& rig, const std::vector<uint16_t>& quaternions,
                              Random& random) {
  std::vector<float> raw(rig.base.raw_count);
  for (float& value : raw) value = static_cast<float>(random.between(-0.5, 1.5));
  for (uint16_t first : quaternions) {
    double length = 0;
    for (int k = 0; k < 4; ++k) {
      raw[first + k] = static_cast<float>(random.between(-1, 1));
      length += double{raw[first + k]} * raw[first + k];
    }
    for (int k = 0; k < 4; ++k) {
      raw[first + k] = static_cast<float>(raw[first + k] / std::sqrt(length));
    }
  }
  return raw;
}

}  // namespace mien
