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

}  // namespace

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
