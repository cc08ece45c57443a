// SPDX-License-Identifier: MIT
// The layers that came after 2.2: joint metadata, twists and swings, RBF solvers, neural networks.
#include <cmath>

#include "runtime/load/dna/check/dna_checker.h"
#include "runtime/load/dna/format/ml_joint_system.h"

namespace mien::dna {
namespace {

// Joint metadata, twists and swings -------------------------------------------------------------

void check_joint_metadata(Checker& c) {
  const List<JointRepresentation>& joints = c.view.jbmd.joints;
  const Field jbmd{nullptr, "jbmd"};
  if (joints.count > c.view.defn.joint_names.count) {
    c.error(Field{&jbmd, "jointRepresentations"}, Status::kDnaStructure, kNoOffset,
            "has %u elements, but there are %u joints", joints.count,
            c.view.defn.joint_names.count);
  }
  for (uint32_t j = 0; j < joints.count && !c.stopped(); ++j) {
    const Field field{&jbmd, "jointRepresentations", j};
    c.enumeration(Field{&field, "translation"}, kNoOffset, joints[j].translation, 0);
    c.enumeration(Field{&field, "rotation"}, kNoOffset, joints[j].rotation, 1);
    c.enumeration(Field{&field, "scale"}, kNoOffset, joints[j].scale, 0);
  }
}

// A twist or a swing: the records differ in the names of their fields only.
template <class Setup>
void check_setup(Checker& c, const Field& at, const char* weights, const char* outputs,
                 const char* inputs, const Setup& setup) {
  c.equal_lengths(
      at, {length(outputs, setup.output_joint_indices), length(weights, setup.blend_weights)});
  c.indices_below(Field{&at, outputs}, setup.output_joint_indices, c.view.defn.joint_names.count,
                  "joints");
  c.has_length(Field{&at, inputs}, setup.input_control_indices, 4, "parts of a quaternion");
  c.indices_below(Field{&at, inputs}, setup.input_control_indices, c.control_limit, "controls");
  c.enumeration(Field{&at, "twistAxis"}, c.offset_after(setup.input_control_indices),
                setup.twist_axis, 2);
  c.finite(Field{&at, weights}, setup.blend_weights);
}

void check_twists_and_swings(Checker& c) {
  const TwistSwingBehavior& twsw = c.view.twsw;
  const Field field{nullptr, "twsw"};
  c.numbered(Field{&field, "twists"}, twsw.twists.count);
  c.numbered(Field{&field, "swings"}, twsw.swings.count);
  for (uint32_t t = 0; t < twsw.twists.count && !c.stopped(); ++t) {
    check_setup(c, Field{&field, "twists", t}, "twistBlendWeights", "twistOutputJointIndices",
                "twistInputControlIndices", twsw.twists[t]);
  }
  for (uint32_t s = 0; s < twsw.swings.count && !c.stopped(); ++s) {
    check_setup(c, Field{&field, "swings", s}, "swingBlendWeights", "swingOutputJointIndices",
                "swingInputControlIndices", twsw.swings[s]);
  }
}

// RBF solvers -----------------------------------------------------------------------------------

void warn_if_odd(Checker& c, const Field& field, uint64_t offset, float value) {
  if (!std::isfinite(value)) c.warning(field, offset, "is %g", static_cast<double>(value));
}

void check_solver(Checker& c, const Field& at, const RbfSolver& s) {
  const uint32_t inputs = s.raw_control_indices.count;
  c.indices_below(Field{&at, "rawControlIndices"}, s.raw_control_indices, c.control_limit,
                  "controls");
  c.indices_below(Field{&at, "poseIndices"}, s.pose_indices, c.view.rbfb.poses.count, "poses");
  c.has_length(Field{&at, "rawControlValues"}, s.raw_control_values,
               uint64_t{s.pose_indices.count} * inputs, "poses times inputs");
  c.finite(Field{&at, "rawControlValues"}, s.raw_control_values);

  // Radius and threshold, then the enumerations, two bytes each, follow the values.
  const uint64_t after = c.offset_after(s.raw_control_values);
  auto byte = [&](unsigned bytes) { return after == kNoOffset ? kNoOffset : after + bytes; };
  c.enumeration(Field{&at, "solverType"}, byte(8), s.solver_type, 1);
  c.enumeration(Field{&at, "automaticRadius"}, byte(10), s.automatic_radius, 1);
  c.enumeration(Field{&at, "distanceMethod"}, byte(12), s.distance_method, 3);
  c.enumeration(Field{&at, "normalizeMethod"}, byte(14), s.normalize_method, 1);
  c.enumeration(Field{&at, "functionType"}, byte(16), s.function_type, 4);
  c.enumeration(Field{&at, "twistAxis"}, byte(18), s.twist_axis, 2);
  if (!c.thorough) return;

  warn_if_odd(c, Field{&at, "radius"}, byte(0), s.radius);
  warn_if_odd(c, Field{&at, "weightThreshold"}, byte(4), s.weight_threshold);
  if (s.distance_method != 0 && inputs % 4 != 0) {
    c.warning(Field{&at, "rawControlIndices"}, c.offset(s.raw_control_indices),
              "has %u elements, but this distance takes quaternions of four", inputs);
  }
}

void check_rbf(Checker& c) {
  const RbfBehavior& rbfb = c.view.rbfb;
  const Field field{nullptr, "rbfb"};
  c.numbered(Field{&field, "solvers"}, rbfb.solvers.count);
  c.numbered(Field{&field, "poses"}, rbfb.poses.count);
  // Evaluation runs through these lists: a solver would run each time that it is listed.
  c.lod_map(Field{&field, "lodSolverMapping"}, rbfb.lod_solvers, rbfb.solvers.count, "solvers",
            Status::kDnaValue);
  for (uint32_t s = 0; s < rbfb.solvers.count && !c.stopped(); ++s) {
    check_solver(c, Field{&field, "solvers", s}, rbfb.solvers[s]);
  }
  for (uint32_t p = 0; c.thorough && p < rbfb.poses.count && !c.stopped(); ++p) {
    const Field pose{&field, "poses", p};
    warn_if_odd(c, Field{&pose, "scale"}, c.offset_after(rbfb.poses[p].name), rbfb.poses[p].scale);
  }

  const RbfBehaviorExtension& rbfe = c.view.rbfe;
  const Field extension{nullptr, "rbfe"};
  c.names(Field{&extension, "poseControlNames"}, rbfe.pose_control_names);
  if (rbfe.poses.count != rbfb.poses.count) {
    c.error(Field{&extension, "poses"}, Status::kDnaStructure, kNoOffset,
            "has %u elements, but there are %u poses", rbfe.poses.count, rbfb.poses.count);
  }
  for (uint32_t p = 0; p < rbfe.poses.count && !c.stopped(); ++p) {
    const RbfPoseControls& pose = rbfe.poses[p];
    const Field at{&extension, "poses", p};
    c.equal_lengths(at, {length("outputControlIndices", pose.output_control_indices),
                         length("outputControlWeights", pose.output_control_weights)});
    c.indices_below(Field{&at, "inputControlIndices"}, pose.input_control_indices, c.control_limit,
                    "controls");
    c.indices_below(Field{&at, "outputControlIndices"}, pose.output_control_indices,
                    c.control_limit, "controls");
    c.finite(Field{&at, "outputControlWeights"}, pose.output_control_weights);
  }
}

// Neural networks -------------------------------------------------------------------------------

void check_network(Checker& c, const Field& at, const NeuralNetwork& network) {
  c.indices_below(Field{&at, "outputIndices"}, network.output_indices, c.control_limit, "controls");
  c.indices_below(Field{&at, "inputIndices"}, network.input_indices, c.control_limit, "controls");
  c.numbered(Field{&at, "layers"}, network.layers.count);

  // If there are operations they define inputs and outputs; else the network does.
  const bool stands_alone = c.view.mlbe.types.count == 0;
  bool inputs_known = stands_alone;
  uint32_t inputs = network.input_indices.count;
  for (uint32_t l = 0; l < network.layers.count && !c.stopped(); ++l) {
    const NetworkLayer& layer = network.layers[l];
    const Field field{&at, "layers", l};
    const Field weights{&field, "weights"};
    const uint32_t outputs = layer.biases.count;
    if (inputs_known) {
      c.has_length(weights, layer.weights, uint64_t{inputs} * outputs, "outputs times inputs");
    } else if (outputs == 0 ? layer.weights.count != 0 : layer.weights.count % outputs != 0) {
      c.error(weights, Status::kDnaStructure, c.offset(layer.weights),
              "has %u elements, which is not a multiple of its %u outputs", layer.weights.count,
              outputs);
    }
    c.finite(weights, layer.weights);
    c.finite(Field{&field, "biases"}, layer.biases);
    c.finite(Field{&field, "parameters"}, layer.parameters);
    c.informative_enumeration(Field{&field, "functionId"}, c.offset_after(layer.weights),
                              layer.function_id, 4);
    if (layer.function_id == 2 && layer.parameters.count == 0) {
      c.warning(Field{&field, "parameters"}, c.offset(layer.parameters),
                "leaky relu without its slope");
    }
    inputs = outputs;
    inputs_known = true;
  }
  const uint32_t last = network.layers.count ? inputs : 0;
  if (stands_alone && last < network.output_indices.count) {
    c.error(Field{&at, "outputIndices"}, Status::kDnaStructure, c.offset(network.output_indices),
            "has %u elements, but the last layer gives %u values", network.output_indices.count,
            last);
  }
}

void check_networks(Checker& c) {
  const MachineLearnedBehavior& mlbh = c.view.mlbh;
  const Field field{nullptr, "mlbh"};
  c.names(Field{&field, "mlControlNames"}, mlbh.control_names);
  c.numbered(Field{&field, "neuralNetworks"}, mlbh.networks.count);
  // Where operations have LOD lists of their own, this one may be left out.
  const LodMap& lods = mlbh.lod_networks;
  if (lods.lods.count + lods.indices.count != 0 || c.view.mlbe.types.count == 0) {
    c.lod_map(Field{&field, "lodNeuralNetworkMapping"}, lods, mlbh.networks.count, "networks");
  }
  for (uint32_t n = 0; n < mlbh.networks.count && !c.stopped(); ++n) {
    check_network(c, Field{&field, "neuralNetworks", n}, mlbh.networks[n]);
  }

  const MeshRegions& meshes = mlbh.mesh_regions;
  const Field regions{&field, "neuralNetworkToMeshRegion"};
  if (meshes.region_names.count > c.view.defn.mesh_names.count) {
    c.error(Field{&regions, "regionNames"}, Status::kDnaStructure, kNoOffset,
            "has %u elements, but there are %u meshes", meshes.region_names.count,
            c.view.defn.mesh_names.count);
  }
  if (meshes.indices.count != meshes.region_names.count) {
    c.error(Field{&regions, "indices"}, Status::kDnaStructure, kNoOffset,
            "has %u elements, but regionNames has %u", meshes.indices.count,
            meshes.region_names.count);
  }
  for (uint32_t m = 0; m < meshes.indices.count && !c.stopped(); ++m) {
    const Field mesh{&regions, "indices", m};
    const List<Array<uint16_t>>& networks = meshes.indices[m];
    if (m < meshes.region_names.count && networks.count != meshes.region_names[m].count) {
      c.error(mesh, Status::kDnaStructure, kNoOffset, "has %u elements, but %u regions have names",
              networks.count, meshes.region_names[m].count);
    }
    for (uint32_t r = 0; r < networks.count; ++r) {
      c.indices_below(Field{&mesh, "", r}, networks[r], mlbh.networks.count, "networks");
    }
  }
}

// ML operations ---------------------------------------------------------------------------------

MlOperationType type_of(const MlOperation& operation) {
  return static_cast<MlOperationType>(operation.type);
}

/// Values that an operation hands to those that depend on it.
uint32_t output_count(const DnaView& view, const MlOperation& operation) {
  const Array<uint32_t>& p = operation.parameters;
  switch (type_of(operation)) {
    case MlOperationType::kGather: return p.count;
    case MlOperationType::kWeightedSum: return p.count ? p[0] : 0;
    case MlOperationType::kMlp: {
      if (p.count == 0 || p[0] >= view.mlbh.networks.count) return 0;
      const List<NetworkLayer>& layers = view.mlbh.networks[p[0]].layers;
      return layers.count ? layers[layers.count - 1].biases.count : 0;
    }
    case MlOperationType::kUnspecified:
    case MlOperationType::kScatter: break;
  }
  return 0;
}

/// Values that come in: those of the gathers alone if there are any, else those of all
/// dependencies.
uint64_t input_count(const DnaView& view, const MlType& type, const MlOperation& operation) {
  uint64_t gathered = 0, all = 0;
  bool gathers = false;
  for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
    const MlOperation& dependency =
        type.operations[operation.set_dependencies[d]][operation.operation_dependencies[d]];
    const uint32_t count = output_count(view, dependency);
    all += count;
    if (type_of(dependency) != MlOperationType::kGather) continue;
    gathers = true;
    gathered += count;
  }
  return gathers ? gathered : all;
}

/// False if a dependency cannot be followed.
bool check_dependencies(Checker& c, const Field& at, const MlType& type, uint32_t set,
                        const MlOperation& operation) {
  const Array<uint16_t>& sets = operation.set_dependencies;
  const Array<uint16_t>& operations = operation.operation_dependencies;
  const Field set_field{&at, "mlOperationSetDependencyIndices"};
  const Field operation_field{&at, "mlOperationDependencyIndices"};
  c.equal_lengths(at, {length(set_field.name, sets), length(operation_field.name, operations)});
  if (sets.count != operations.count) return false;

  bool good = true;
  for (uint32_t d = 0; d < sets.count && !c.stopped(); ++d) {
    const unsigned s = sets[d], o = operations[d];
    if (s >= type.operations.count) {
      c.error(set_field, Status::kDnaReference, c.offset(sets, d),
              "element %u is %u, but there are %u "
              "operation sets",
              d, s, type.operations.count);
    } else if (s >= set) {
      c.error(set_field, Status::kDnaValue, c.offset(sets, d),
              "element %u is %u, but an operation of "
              "set %u can only depend on earlier sets",
              d, s, set);
    } else if (o >= type.operations[s].count) {
      c.error(operation_field, Status::kDnaReference, c.offset(operations, d),
              "element %u is %u, but "
              "set %u has %u operations",
              d, o, s, type.operations[s].count);
    } else {
      continue;
    }
    good = false;
  }
  return good;
}

void check_mlp(Checker& c, const Field& at, const MlType& type, const MlOperation& operation) {
  const DnaView& view = c.view;
  const Array<uint32_t>& p = operation.parameters;
  const Field field{&at, "parameters"};
  if (p.count == 0) {
    return c.error(field, Status::kDnaStructure, c.offset(p), "has no network to run");
  }
  if (p[0] >= view.mlbh.networks.count) {
    return c.error(field, Status::kDnaReference, c.offset(p),
                   "element 0 is %u, but there are %u "
                   "networks",
                   p[0], view.mlbh.networks.count);
  }
  const List<NetworkLayer>& layers = view.mlbh.networks[p[0]].layers;
  const uint32_t lods = view.desc.lod_count;
  if (p.count != 1 && p.count != 1 + uint64_t{layers.count} * lods) {
    c.error(field, Status::kDnaStructure, c.offset(p),
            "has %u elements; network %u takes 1, or %llu "
            "with row limits",
            p.count, p[0], 1 + static_cast<unsigned long long>(layers.count) * lods);
  } else if (p.count != 1) {
    for (uint32_t i = 1; i < p.count && !c.stopped(); ++i) {
      const uint32_t layer = (i - 1) / lods, rows = layers[layer].biases.count;
      if (p[i] <= rows) continue;
      c.error(field, Status::kDnaStructure, c.offset(p, i),
              "element %u limits layer %u to %u rows, but "
              "it has %u",
              i, layer, p[i], rows);
    }
  }
  const uint32_t outputs = layers.count ? layers[0].biases.count : 0;
  const uint32_t wanted = outputs ? layers[0].weights.count / outputs : 0;
  const uint64_t given = input_count(view, type, operation);
  if (given != wanted) {
    c.error(field, Status::kDnaStructure, c.offset(p),
            "network %u takes %u values, but the dependencies "
            "give %llu",
            p[0], wanted, static_cast<unsigned long long>(given));
  }
}

void check_weighted_sum(Checker& c, const Field& at, const MlType& type,
                        const MlOperation& operation) {
  const Array<uint32_t>& p = operation.parameters;
  const Field field{&at, "parameters"};
  const uint32_t dependencies = operation.set_dependencies.count;
  c.has_length(field, p, 1 + uint64_t{dependencies}, "dependencies and the number of outputs");
  if (p.count == 0) return;
  c.finite(field, {p.data, p.count});  // the first one is not a float, but reads as a tiny one
  for (uint32_t d = 0; d < dependencies && !c.stopped(); ++d) {
    const uint32_t given = output_count(
        c.view,
        type.operations[operation.set_dependencies[d]][operation.operation_dependencies[d]]);
    if (p[0] <= given) continue;
    c.error(field, Status::kDnaStructure, c.offset(p),
            "asks for %u values, but dependency %u gives %u", p[0], d, given);
  }
}

void check_operation(Checker& c, const Field& at, const MlType& type, uint32_t set,
                     const MlOperation& operation) {
  if (!check_dependencies(c, at, type, set, operation)) return;
  const Array<uint32_t>& p = operation.parameters;
  switch (type_of(operation)) {
    case MlOperationType::kGather:
    case MlOperationType::kScatter:
      return c.indices_below(Field{&at, "parameters"}, p, c.control_limit, "controls");
    case MlOperationType::kMlp: return check_mlp(c, at, type, operation);
    case MlOperationType::kWeightedSum: return check_weighted_sum(c, at, type, operation);
    case MlOperationType::kUnspecified: return;
  }
  c.informative_enumeration(Field{&at, "operationType"},
                            c.offset_after(operation.operation_dependencies), operation.type, 4);
}

void check_operations(Checker& c) {
  const Field mlbe{nullptr, "mlbe"};
  for (uint32_t t = 0; t < c.view.mlbe.types.count && !c.stopped(); ++t) {
    const MlType& type = c.view.mlbe.types[t];
    const Field field{&mlbe, "mlbTypeData", t};
    c.numbered(Field{&field, "operations"}, type.operations.count);
    if (type.lod_operations.count != type.operations.count) {
      c.error(Field{&field, "lodMLOperationMappings"}, Status::kDnaStructure, kNoOffset,
              "has %u elements, but there are %u operation sets", type.lod_operations.count,
              type.operations.count);
    }
    for (uint32_t s = 0; s < type.operations.count && !c.stopped(); ++s) {
      const List<MlOperation>& operations = type.operations[s];
      const Field set{&field, "operations", s};
      c.numbered(set, operations.count);
      if (s < type.lod_operations.count) {
        c.lod_map(Field{&field, "lodMLOperationMappings", s}, type.lod_operations[s],
                  operations.count, "operations");
      }
      for (uint32_t o = 0; o < operations.count && !c.stopped(); ++o) {
        check_operation(c, Field{&set, "", o}, type, s, operations[o]);
      }
    }
  }
}

// ML joints -------------------------------------------------------------------------------------

void check_ml_joints(Checker& c) {
  const MlJoints& joints = c.view.mlbe.joints;
  const Field field{nullptr, "mlbe.mlbJoints"};
  c.equal_lengths(field, {length("parameterKeys", joints.parameter_keys),
                          length("parameterValues", joints.parameter_values)});
  c.equal_lengths(field, {length("inputIndices", joints.input_indices),
                          length("outputIndices", joints.output_indices)});
  c.indices_below(Field{&field, "inputIndices"}, joints.input_indices, c.control_limit, "controls");

  // Largest value of keys 0 to 9: three representations, three directions, three signs, a sequence.
  // Then that of Mien's own key.
  constexpr unsigned kLast[11] = {0, 1, 0, 5, 5, 5, 65535, 65535, 65535, 5, 1};
  const Array<uint16_t>& keys = joints.parameter_keys;
  uint32_t seen = 0;
  for (uint32_t i = 0; i < keys.count && i < joints.parameter_values.count && !c.stopped(); ++i) {
    const unsigned key = keys[i];
    if (key > 9 && key != kMlScaleKey) {
      c.warning(Field{&field, "parameterKeys"}, c.offset(keys, i),
                "element %u is %u; only 0 to 9 are "
                "known",
                i, key);
      continue;
    }
    const unsigned place = key > 9 ? 10 : key;
    if (seen >> place & 1) {
      c.error(Field{&field, "parameterKeys"}, Status::kDnaValue, c.offset(keys, i),
              "element %u repeats %u", i, key);
    }
    seen |= 1u << place;
    c.enumeration(Field{&field, "parameterValues", i}, c.offset(joints.parameter_values, i),
                  joints.parameter_values[i], kLast[place]);
  }

  const Field outputs{&field, "outputIndices"};
  const uint32_t attributes = ml_joint_attributes(joints);
  if (attributes != 0) {
    c.indices_below(outputs, joints.output_indices, c.view.defn.joint_names.count * attributes,
                    "joint values");
  } else if (joints.output_indices.count != 0) {
    c.error(outputs, Status::kDnaValue, c.offset(joints.output_indices),
            "no parameter key says which values a joint has");
  }
}

}  // namespace

void check_extensions(Checker& c) {
  check_joint_metadata(c);
  check_twists_and_swings(c);
  check_rbf(c);
  check_networks(c);
  check_operations(c);
  check_ml_joints(c);
}

}  // namespace mien::dna
