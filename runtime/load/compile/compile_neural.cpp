// SPDX-License-Identifier: MIT
// Machine-learned behavior: operations -> steps (docs/rig-evaluation.md, 8 "Machine-learned behavior").
#include <algorithm>
#include <cmath>

#include "runtime/base/half.h"
#include "runtime/load/compile/compile_rig.h"
#include "runtime/load/dna/format/ml_joint_system.h"
#include "runtime/rig/work.h"
#include "simd/lanes.h"

namespace mien {
namespace {

using dna::Array;
using dna::DnaView;
using dna::MlOperation;
using dna::MlOperationType;
using dna::MlType;

MlOperationType type_of(const MlOperation& operation) {
  return static_cast<MlOperationType>(operation.type);
}

/// The step that each operation becomes, before there is memory for it. Networks without operations count
/// as one step each, which gathers the network's inputs and scatters its outputs.
struct Visit {
  const MlType* type;  // null: no operations
  uint32_t set, number;
  uint32_t network;              // or kNone
  const MlOperation* operation;  // or null
};
constexpr uint32_t kNone = ~uint32_t{0};

/// Calls f(visit) for each step, in order of evaluation.
template <class F>
void for_each_step(const DnaView& view, F&& f) {
  if (view.mlbe.types.count == 0) {
    for (uint32_t n = 0; n < view.mlbh.networks.count; ++n) f(Visit{nullptr, 0, n, n, nullptr});
    return;
  }
  for (const MlType& type : view.mlbe.types) {
    for (uint32_t s = 0; s < type.operations.count; ++s) {
      for (uint32_t o = 0; o < type.operations[s].count; ++o) {
        const MlOperation& operation = type.operations[s][o];
        if (type_of(operation) == MlOperationType::kMlp) {
          f(Visit{&type, s, o, operation.parameters[0], &operation});
        } else if (type_of(operation) == MlOperationType::kWeightedSum) {
          f(Visit{&type, s, o, kNone, &operation});
        }
      }
    }
  }
}

const MlOperation& dependency(const Visit& visit, uint32_t d) {
  return visit.type->operations[visit.operation->set_dependencies[d]]
                               [visit.operation->operation_dependencies[d]];
}

/// Outputs of a step.
uint32_t output_count(const DnaView& view, const Visit& visit) {
  if (visit.network == kNone) {
    return visit.operation->set_dependencies.count ? visit.operation->parameters[0] : 0;
  }
  const auto& layers = view.mlbh.networks[visit.network].layers;
  return layers.count ? layers[layers.count - 1].biases.count : 0;
}

/// Calls f(indices) for each list of controls that a step gathers.
template <class F>
void for_each_gather(const DnaView& view, const Visit& visit, F&& f) {
  if (!visit.operation) return f(view.mlbh.networks[visit.network].input_indices);
  for (uint32_t d = 0; d < visit.operation->set_dependencies.count; ++d) {
    const MlOperation& from = dependency(visit, d);
    if (type_of(from) == MlOperationType::kGather) f(from.parameters);
  }
}

/// The same for scatters of the outputs of networks: calls f(set, number, parameters) for every dependency
/// of every scatter.
template <class F>
void for_each_scatter(const MlType& type, F&& f) {
  for (const auto& set : type.operations) {
    for (const MlOperation& operation : set) {
      if (type_of(operation) != MlOperationType::kScatter) continue;
      for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
        f(operation.set_dependencies[d], operation.operation_dependencies[d], operation.parameters);
      }
    }
  }
}

/// Calls f(element, bit) for every element that a LOD lists.
template <class F>
void for_each_lod_element(const dna::LodMap& map, uint32_t lod_count, F&& f) {
  for (uint32_t l = 0; l < lod_count; ++l) {
    const Array<uint16_t> row = map.at(l);
    for (uint32_t i = 0; i < row.count; ++i) f(row[i], uint64_t{1} << l);
  }
}

size_t layer_values(const dna::NetworkLayer& layer) {
  const uint32_t outputs = layer.biases.count;
  return outputs ? size_t{padded(outputs)} * (layer.weights.count / outputs) : 0;
}

/// A step for each operation of a type: where its outputs lie, by set and number.
struct StepNumbers {
  Span<uint32_t> first_of_set;  // [set] into steps
  Span<uint32_t> steps;         // [operation], or kNone
};

bool number_steps(const MlType& type, uint32_t first_step, Arena& scratch, StepNumbers& out) {
  size_t operations = 0;
  for (const auto& set : type.operations) operations += set.count;
  out.first_of_set = scratch.array<uint32_t>(size_t{type.operations.count} + 1);
  out.steps = scratch.array<uint32_t>(operations);
  if (!out.first_of_set.data || (operations && !out.steps.data)) return false;
  uint32_t at = 0, step = first_step;
  for (uint32_t s = 0; s < type.operations.count; ++s) {
    out.first_of_set[s] = at;
    for (const MlOperation& operation : type.operations[s]) {
      const bool runs = type_of(operation) == MlOperationType::kMlp ||
                        type_of(operation) == MlOperationType::kWeightedSum;
      out.steps[at++] = runs ? step++ : kNone;
    }
  }
  return true;
}

void fill_networks(const DnaView& view, bool half_storage, MlTable& ml) {
  size_t value = 0;
  uint32_t layer_number = 0, bias = 0;
  for (const dna::NeuralNetwork& network : view.mlbh.networks) {
    for (const dna::NetworkLayer& from : network.layers) {
      NetworkLayer& layer = ml.layers[layer_number++];
      layer = {};
      layer.first_value = value;
      layer.first_bias = bias;
      layer.output_count = from.biases.count;
      layer.input_count = from.biases.count ? from.weights.count / from.biases.count : 0;
      layer.function = from.function_id <= 4 ? static_cast<uint8_t>(from.function_id) : 0;
      layer.alpha = from.parameters.count ? from.parameters[0] : 0.01f;
      for (uint32_t r = 0; r < layer.output_count; ++r) {
        const size_t lane =
            value + size_t{r / kBlockLanes} * layer.input_count * kBlockLanes + r % kBlockLanes;
        for (uint32_t c = 0; c < layer.input_count; ++c) {
          const float weight = from.weights[size_t{r} * layer.input_count + c];
          const size_t at = lane + size_t{c} * kBlockLanes;
          if (half_storage) {
            ml.halves[at] = half_from_float(weight);
          } else {
            ml.values[at] = saturated(weight);
          }
        }
      }
      for (uint32_t r = 0; r < from.biases.count; ++r) {
        ml.biases[bias + r] = from.biases[r] + 0.0f;  // 0 for -0: see docs/numbers.md, 4
      }
      value += layer_values(from);
      bias += padded(from.biases.count);
    }
  }
}

/// [network]: the first region that lists it, or kNoMask.
void find_masks(const DnaView& view, Span<uint32_t> masks) {
  std::fill(masks.begin(), masks.end(), kNoMask);
  uint32_t region = 0;
  for (const auto& mesh : view.mlbh.mesh_regions.indices) {
    for (const Array<uint16_t>& networks : mesh) {
      for (uint32_t i = 0; i < networks.count; ++i) {
        if (masks[networks[i]] == kNoMask) masks[networks[i]] = region;
      }
      ++region;
    }
  }
}

/// Attribute of a joint as ML numbers it -> as files number it; w of a quaternion gives kNone.
uint32_t file_attribute(uint32_t attribute, const dna::MlJointWidths& widths) {
  if (attribute < widths.translation) return attribute;
  attribute -= widths.translation;
  if (attribute < widths.rotation) return attribute < 3 ? 3 + attribute : kNone;
  return 6 + attribute - widths.rotation;
}

void fill_ml_joints(const DnaView& view, Rig& rig, Span<uint32_t> position) {
  const dna::MlJoints& from = view.mlbe.joints;
  MlTable& ml = rig.ml;
  const dna::MlJointWidths widths = dna::ml_joint_widths(from);
  const uint32_t attributes = widths.all();
  ml.quaternion_rotations = widths.rotation == 4;
  std::fill(position.begin(), position.end(), kNone);
  uint32_t count = 0;
  for (uint32_t i = 0; i < from.output_indices.count && attributes; ++i) {
    const uint32_t joint = from.output_indices[i] / attributes;
    const uint32_t attribute = file_attribute(from.output_indices[i] % attributes, widths);
    if (position[joint] == kNone) {
      position[joint] = count;
      ml.joints[count++] = {0,
                            static_cast<uint16_t>(joint),
                            {kNoControl, kNoControl, kNoControl},
                            {kNoControl, kNoControl, kNoControl},
                            kNoControl};
    }
    MlJoint& to = ml.joints[position[joint]];
    const uint16_t control = from.input_indices[i];
    if (attribute < 3) {
      to.translation[attribute] = control;
    } else if (attribute != kNone && attribute >= 6) {
      to.scale[attribute - 6] = control;
    } else if (to.rotation_control == kNoControl) {
      const uint32_t parts = widths.rotation;
      if (control + parts <= rig.control_count) to.rotation_control = control;
    }
  }
  ml.joints.count = count;
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    const Array<uint16_t> row = view.defn.lod_joints.at(l);
    for (uint32_t i = 0; i < row.count; ++i) {
      if (position[row[i]] != kNone) ml.joints[position[row[i]]].lods |= uint64_t{1} << l;
    }
  }
  for (const MlJoint& joint : ml.joints) {
    if (ml.quaternion_rotations && joint.rotation_control != kNoControl) {
      ml.default_is_one[joint.rotation_control + 3] = 1;
    }
  }

  CoordinateSystem rigs;
  std::copy(rig.units.axes, rig.units.axes + 3, rigs.axes);
  std::copy(rig.units.rotation_signs, rig.units.rotation_signs + 3, rigs.rotation_signs);
  rigs.rotation_sequence = rig.units.rotation_sequence;
  const dna::MlJointSystem stated = dna::ml_joint_system(from, rigs);
  const CoordinateSystem& own = stated.system;
  ml.scale_magnitude = stated.scale_magnitude && widths.scale != 0;
  ml.converts = stated.differs || (ml.scale_magnitude && spans_space(rigs.axes));
  if (!ml.converts) return;
  ml.change = coordinate_change(own, rigs);
  ml.rotation = rotation_convention(own.rotation_sequence, own.rotation_signs, rig.units.rotation);
  ml.to_rig = change_of_axes(own.axes, rigs.axes);
}

}  // namespace

Status place_ml(const DnaView& view, Placer& placer, Rig& rig, Error& error) {
  size_t layers = 0, values = 0, biases = 0;
  MlTable& ml = rig.ml;
  for (const dna::NeuralNetwork& network : view.mlbh.networks) {
    layers += network.layers.count;
    for (const dna::NetworkLayer& layer : network.layers) {
      const uint32_t outputs = layer.biases.count;
      values += layer_values(layer);
      biases += padded(outputs);
      ml.widest_layer = std::max(ml.widest_layer, padded(outputs));
      if (outputs) ml.widest_layer = std::max(ml.widest_layer, layer.weights.count / outputs);
    }
  }

  size_t steps = 0, controls = 0, dependencies = 0, buffer = 0;
  size_t max_inputs = 0;
  for_each_step(view, [&](const Visit& visit) {
    ++steps;
    buffer += padded(output_count(view, visit));
    // Gathered values are placed at the inputs of the first layer of a step, whether the layer takes them
    // or not; a step that gathers nothing takes the outputs of its dependencies.
    size_t inputs = 0;
    for_each_gather(view, visit, [&](const auto& indices) { inputs += indices.count; });
    controls += inputs;
    for (uint32_t d = 0; visit.operation && d < visit.operation->set_dependencies.count; ++d) {
      const MlOperation& from = dependency(visit, d);
      if (type_of(from) == MlOperationType::kMlp) {
        inputs += output_count(view, {visit.type, 0, 0, from.parameters[0], &from});
      } else if (type_of(from) == MlOperationType::kWeightedSum) {
        inputs += output_count(view, {visit.type, 0, 0, kNone, &from});
      }
    }
    if (visit.network != kNone) max_inputs = std::max(max_inputs, inputs);
    if (visit.operation) dependencies += visit.operation->set_dependencies.count;
    if (visit.network == kNone) return;
    if (!visit.operation) controls += view.mlbh.networks[visit.network].output_indices.count;
  });
  for (const MlType& type : view.mlbe.types) {
    for_each_scatter(type,
                     [&](uint32_t, uint32_t, const Array<uint32_t>& p) { controls += p.count; });
  }
  if (max_inputs > kMaxBufferFloats || buffer > kMaxBufferFloats || controls > kMaxBufferFloats) {
    return fail(
        error, Status::kDnaLimit, kNoOffset,
        "mlbe: the operations together take %zu values and %zu controls; at most %zu of each "
        "are supported",
        buffer, controls, kMaxBufferFloats);
  }
  ml.buffer_size = static_cast<uint32_t>(buffer);
  ml.widest_layer = std::max(ml.widest_layer, static_cast<uint32_t>(max_inputs));
  ml.steps = placer.array<MlStep>(steps);
  ml.layers = placer.array<NetworkLayer>(layers);
  ml.values = placer.array<float>(rig.half_storage ? 0 : values, kBlockAlignment);
  ml.halves = placer.array<uint16_t>(rig.half_storage ? values : 0, kBlockAlignment);
  ml.biases = placer.array<float>(biases, kBlockAlignment);
  ml.controls = placer.array<uint16_t>(controls);
  ml.dependencies = placer.array<MlDependency>(dependencies);
  ml.limits = placer.array<uint32_t>(steps * rig.lod_count);
  ml.default_is_one =
      placer.array<uint8_t>(steps || view.mlbe.joints.output_indices.count ? rig.control_count : 0);
  ml.joints = placer.array<MlJoint>(
      std::min<size_t>(view.mlbe.joints.output_indices.count, rig.joint_count));
  return Status::kOk;
}

Status fill_ml(const DnaView& view, Arena& scratch, Rig& rig, Error& error) {
  MlTable& ml = rig.ml;
  Span<uint32_t> masks = scratch.array<uint32_t>(view.mlbh.networks.count);
  Span<uint32_t> first_layer = scratch.array<uint32_t>(view.mlbh.networks.count);
  Span<uint32_t> position = scratch.array<uint32_t>(rig.joint_count);
  Span<StepNumbers> numbers = scratch.array<StepNumbers>(view.mlbe.types.count);
  // An array that could not be allocated has no elements.
  bool memory = masks.count == view.mlbh.networks.count &&
                first_layer.count == view.mlbh.networks.count &&
                position.count == rig.joint_count && numbers.count == view.mlbe.types.count;
  uint32_t first_step = 0;
  for (uint32_t t = 0; t < view.mlbe.types.count && memory; ++t) {
    memory = number_steps(view.mlbe.types[t], first_step, scratch, numbers[t]);
    for (uint32_t step : numbers[t].steps) first_step += memory && step != kNone;
  }
  if (!memory) return fail(error, Status::kMemory, kNoOffset, "no memory to compile the networks");

  fill_networks(view, rig.half_storage, ml);
  find_masks(view, masks);
  for (uint32_t n = 0, layer = 0; n < first_layer.count; ++n) {
    first_layer[n] = layer;
    layer += view.mlbh.networks[n].layers.count;
  }

  uint32_t step_number = 0, control = 0, dependency_number = 0, buffer = 0;
  for_each_step(view, [&](const Visit& visit) {
    MlStep& step = ml.steps[step_number];
    step = {};
    step.mask = kNoMask;
    step.first_limit = step_number++ * rig.lod_count;
    if (visit.network != kNone) {
      step.first_layer = first_layer[visit.network];
      step.layer_count = view.mlbh.networks[visit.network].layers.count;
      step.mask = masks[visit.network];
    }
    step.first_gather = control;
    for_each_gather(view, visit, [&](const auto& indices) {
      for (uint32_t i = 0; i < indices.count; ++i) {
        ml.controls[control++] = static_cast<uint16_t>(indices[i]);
      }
    });
    step.gather_count = control - step.first_gather;
    step.first_output = buffer;
    step.output_count = output_count(view, visit);
    buffer += padded(step.output_count);
    for (uint32_t l = 0; l < rig.lod_count; ++l) ml.limits[step.first_limit + l] = kNone;
    step.first_dependency = dependency_number;
    if (!visit.operation) {
      step.first_scatter = control;
      const Array<uint16_t>& outputs = view.mlbh.networks[visit.network].output_indices;
      copy_array(outputs, ml.controls.slice(control, outputs.count));
      step.scatter_count = outputs.count;
      control += outputs.count;
      return;
    }

    const MlOperation& operation = *visit.operation;
    const StepNumbers& type_steps =
        numbers[static_cast<size_t>(visit.type - view.mlbe.types.items)];
    uint32_t gathered = step.first_gather;
    for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
      const uint32_t from =
          type_steps.steps[type_steps.first_of_set[operation.set_dependencies[d]] +
                           operation.operation_dependencies[d]];
      MlDependency& to = ml.dependencies[dependency_number++];
      to = {};
      if (from != kNone) {
        to = {ml.steps[from].first_output, ml.steps[from].output_count, 0, false, {}};
      } else if (type_of(dependency(visit, d)) == MlOperationType::kGather) {
        to = {gathered, dependency(visit, d).parameters.count, 0, true, {}};
        gathered += to.count;
      }
      if (visit.network == kNone)
        to.weight = load_big_endian<float>(operation.parameters.data + 4 * (d + 1));
      ++step.dependency_count;
    }
    // Only the limit of the last layer matters: the number of outputs that are scattered.
    const size_t limits = operation.parameters.count - 1;
    if (visit.network != kNone && limits > 1) {
      for (uint32_t l = 0; l < rig.lod_count; ++l) {
        ml.limits[step.first_limit + l] = operation.parameters[1 + limits - rig.lod_count + l];
      }
    }
  });

  if (view.mlbe.types.count == 0) {
    for_each_lod_element(view.mlbh.lod_networks, rig.lod_count,
                         [&](uint32_t network, uint64_t lod) { ml.steps[network].lods |= lod; });
  }
  for (uint32_t t = 0; t < view.mlbe.types.count; ++t) {
    const MlType& type = view.mlbe.types[t];
    for (uint32_t s = 0; s < type.operations.count; ++s) {
      const uint32_t* steps = numbers[t].steps.data + numbers[t].first_of_set[s];
      for_each_lod_element(type.lod_operations[s], rig.lod_count, [&](uint32_t o, uint64_t lod) {
        if (steps[o] != kNone) ml.steps[steps[o]].lods |= lod;
      });
    }
  }

  // Scatters, in two passes: how much each step scatters, then where.
  for (uint32_t t = 0; t < view.mlbe.types.count; ++t) {
    const auto step_of = [&](uint32_t set, uint32_t number) -> MlStep* {
      const uint32_t step = numbers[t].steps[numbers[t].first_of_set[set] + number];
      return step == kNone || ml.steps[step].layer_count == 0 ? nullptr : &ml.steps[step];
    };
    for_each_scatter(view.mlbe.types[t],
                     [&](uint32_t set, uint32_t number, const Array<uint32_t>& p) {
                       if (MlStep* step = step_of(set, number)) step->scatter_count += p.count;
                     });
    for (uint32_t number : numbers[t].steps) {
      if (number == kNone) continue;
      ml.steps[number].first_scatter = control;
      control += ml.steps[number].scatter_count;
      ml.steps[number].scatter_count = 0;
    }
    for_each_scatter(
        view.mlbe.types[t], [&](uint32_t set, uint32_t number, const Array<uint32_t>& p) {
          MlStep* step = step_of(set, number);
          for (uint32_t i = 0; step && i < p.count; ++i) {
            ml.controls[step->first_scatter + step->scatter_count++] = static_cast<uint16_t>(p[i]);
          }
        });
  }
  fill_ml_joints(view, rig, position);
  const uint64_t budget = compile_budget(view, rig),
                 steps_at_all_lods = count_ml_steps(rig, budget);
  if (steps_at_all_lods <= budget) return Status::kOk;
  return fail(error, Status::kDnaLimit, kNoOffset,
              "mlbe: %llu steps or more to evaluate each LOD once; at most %llu are supported for "
              "a file of "
              "this size",
              static_cast<unsigned long long>(steps_at_all_lods),
              static_cast<unsigned long long>(budget));
}

void mark_ml_joint_inputs(const DnaView& view, uint32_t lod_count, Span<uint8_t> reach) {
  const dna::MlJoints& joints = view.mlbe.joints;
  const uint32_t attributes = dna::ml_joint_attributes(joints);
  if (attributes == 0) return;
  // By joint, the coarsest LOD that has it.
  uint8_t joint_reach[65536 / kFileAttributes + 1] = {};
  for (uint32_t l = 0; l < lod_count; ++l) {
    const Array<uint16_t> row = view.defn.lod_joints.at(l);
    for (uint32_t i = 0; i < row.count; ++i) joint_reach[row[i]] = static_cast<uint8_t>(l + 1);
  }
  for (uint32_t i = 0; i < joints.output_indices.count; ++i) {
    uint8_t& control = reach[joints.input_indices[i]];
    control = std::max(control, joint_reach[joints.output_indices[i] / attributes]);
  }
}

}  // namespace mien
