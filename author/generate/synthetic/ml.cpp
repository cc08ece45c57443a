// SPDX-License-Identifier: MIT
// Machine-learned behavior of a synthetic rig, with the structure of production rigs:
//
//     gather -> encoders, one per region -> weighted sums -> decoders -> scatter -> joints
//
// Encoders read raw controls, use each kind of activation in turn, and belong to regions of the first mesh,
// whose masks switch them. Each decoder moves some joints by translation, quaternion and scale. The finer
// half of the LODs has it all; below LOD 0 fewer joints are scattered.
#include "author/generate/synthetic/body.h"

namespace mien::synthetic {
namespace {

struct MlSizes {
  uint32_t encoders, inputs, hidden, code, decoders, joints;  // joints: of each decoder
};

// In the order of the presets.
constexpr MlSizes kMlSizes[] = {
    {3, 6, 8, 4, 1, 2},     {6, 16, 16, 8, 2, 2},   {10, 32, 32, 16, 4, 5},
    {12, 45, 64, 24, 4, 8}, {12, 45, 64, 24, 4, 8},
};

constexpr uint32_t kJointValues = 10;  // 3 translation, 4 quaternion, 3 scale
enum MlStream : uint64_t { kEncoderStream = 3000, kDecoderStream };
enum Activation : uint16_t { kLinear, kRelu, kLeakyRelu, kTanh, kSigmoid, kActivationCount };

constexpr const char* kRegions[] = {"forehead",  "brows", "eyes", "nose", "cheeks", "upper_lip",
                                    "lower_lip", "mouth", "jaw",  "chin", "neck",   "shoulders"};

const MlSizes& sizes_of(SyntheticPreset preset) { return kMlSizes[static_cast<uint32_t>(preset)]; }

struct MlMaker {
  const MlSizes& sizes;
  uint64_t seed;
  Arena& arena;
  dna::DnaView& out;

  uint32_t lod_count() const { return out.desc.lod_count; }
  bool is_active(size_t lod) const { return lod < (lod_count() + 1) / 2; }
  uint32_t outputs() const { return sizes.joints * kJointValues; }
  uint32_t control_count() const { return sizes.decoders * outputs(); }
  uint32_t raw_count() const { return out.defn.raw_control_names.count; }
  uint32_t inputs() const { return sizes.inputs < raw_count() ? sizes.inputs : raw_count(); }

  /// Controls of an encoder: consecutive ones, with another beginning for each encoder.
  uint32_t input_of(uint32_t encoder, uint32_t i) const {
    return (encoder * raw_count() / sizes.encoders + i) % raw_count();
  }
  uint32_t control_of(uint32_t decoder, uint32_t i) const {
    return out.first_ml() + decoder * outputs() + i;
  }

  // Networks ----------------------------------------------------------------------------------

  bool fill_layer(uint32_t rows, uint32_t columns, Activation function, Random& random,
                  dna::NetworkLayer& layer) {
    dna::NewArray<float> biases, weights, parameters;
    if (!make(arena, rows, biases) || !make(arena, size_t{rows} * columns, weights) ||
        !make(arena, function == kLeakyRelu ? 1 : 0, parameters)) {
      return false;
    }
    for (uint32_t r = 0; r < rows; ++r) biases.set(r, static_cast<float>(random.normal() * 0.1));
    const double deviation = 1.5 / columns;
    for (uint32_t i = 0; i < rows * columns; ++i) {
      weights.set(i, static_cast<float>(random.normal() * deviation));
    }
    if (function == kLeakyRelu) parameters.set(0, 0.01f);
    layer = {biases, weights, function, parameters};
    return true;
  }

  template <class Control>
  bool fill_indices(uint32_t count, const Control& control, dna::Array<uint16_t>& to) {
    dna::NewArray<uint16_t> indices;
    if (!make(arena, count, indices)) return false;
    for (uint32_t i = 0; i < count; ++i) indices.set(i, static_cast<uint16_t>(control(i)));
    to = indices;
    return true;
  }

  bool fill_encoder(uint32_t number, Random& random, dna::NeuralNetwork& network) {
    const auto activation = [&](uint32_t layer) {
      return static_cast<Activation>((2 * number + layer) % kActivationCount);
    };
    return make(arena, 3, network.layers) &&
           fill_layer(sizes.hidden, inputs(), activation(0), random, network.layers[0]) &&
           fill_layer(sizes.hidden, sizes.hidden, activation(1), random, network.layers[1]) &&
           fill_layer(sizes.code, sizes.hidden, kLinear, random, network.layers[2]) &&
           fill_indices(
               inputs(), [&](uint32_t i) { return input_of(number, i); }, network.input_indices);
  }

  // Outputs are near rest: small translations and scales, and a quaternion near 1.
  bool fill_decoder(uint32_t number, Random& random, dna::NeuralNetwork& network) {
    if (!make(arena, 2, network.layers) ||
        !fill_layer(sizes.hidden, sizes.code, kTanh, random, network.layers[0]) ||
        !fill_layer(outputs(), sizes.hidden, kLinear, random, network.layers[1])) {
      return false;
    }
    dna::NewArray<float> biases, weights;
    const dna::NetworkLayer& drawn = network.layers[1];
    if (!make(arena, outputs(), biases) || !make(arena, drawn.weights.count, weights)) return false;
    for (uint32_t r = 0; r < outputs(); ++r) {
      const uint32_t k = r % kJointValues;
      const float size = k < 3 ? 1.0f : k < 7 ? 0.3f : 0.1f;
      biases.set(r, k == 6 ? 1.0f : 0.0f);
      for (uint32_t c = 0; c < sizes.hidden; ++c) {
        weights.set(r * sizes.hidden + c, size * drawn.weights[r * sizes.hidden + c]);
      }
    }
    network.layers[1].biases = biases;
    network.layers[1].weights = weights;
    return fill_indices(
        outputs(), [&](uint32_t i) { return control_of(number, i); }, network.output_indices);
  }

  bool fill_networks() {
    dna::MachineLearnedBehavior& ml = out.mlbh;
    if (!make(arena, sizes.encoders + sizes.decoders, ml.networks)) return false;
    Random encoders = Random::from_seed(seed, kEncoderStream);
    Random decoders = Random::from_seed(seed, kDecoderStream);
    for (uint32_t e = 0; e < sizes.encoders; ++e) {
      if (!fill_encoder(e, encoders, ml.networks[e])) return false;
    }
    for (uint32_t d = 0; d < sizes.decoders; ++d) {
      if (!fill_decoder(d, decoders, ml.networks[sizes.encoders + d])) return false;
    }
    auto in_lod = [this](size_t lod, size_t) { return is_active(lod); };
    return make_lod_map(arena, lod_count(), ml.networks.count, in_lod, ml.lod_networks);
  }

  bool fill_control_names() {
    const char* const parts[kJointValues] = {"tx", "ty", "tz", "qx", "qy",
                                             "qz", "qw", "sx", "sy", "sz"};
    if (!make(arena, control_count(), out.mlbh.control_names)) return false;
    for (uint32_t c = 0; c < control_count(); ++c) {
      Text name = Text().add("ml_").add(out.defn.joint_names[joint_of(c / kJointValues)]);
      name.add(".").add(parts[c % kJointValues]);
      if (!copy_text(arena, name, out.mlbh.control_names[c])) return false;
    }
    return true;
  }

  bool fill_regions() {
    dna::MeshRegions& regions = out.mlbh.mesh_regions;
    const uint32_t meshes = out.defn.mesh_names.count;
    if (!make(arena, meshes, regions.region_names) || !make(arena, meshes, regions.indices) ||
        !make(arena, sizes.encoders, regions.region_names[0]) ||
        !make(arena, sizes.encoders, regions.indices[0])) {
      return false;
    }
    for (uint32_t e = 0; e < sizes.encoders; ++e) {
      if (!copy_text(arena, Text().add(kRegions[e]), regions.region_names[0][e]) ||
          !fill_indices(
              1, [e](uint32_t) { return e; }, regions.indices[0][e])) {
        return false;
      }
    }
    return true;
  }

  // Operations --------------------------------------------------------------------------------

  enum Set : uint32_t { kGathers, kEncoders, kSums, kDecoders, kScatters, kSetCount };

  template <class Parameter>
  bool fill_operation(dna::MlOperationType type, uint32_t count, const Parameter& parameter,
                      dna::MlOperation& operation) {
    dna::NewArray<uint32_t> parameters;
    if (!make(arena, count, parameters)) return false;
    for (uint32_t i = 0; i < count; ++i) parameters.set(i, parameter(i));
    operation.type = static_cast<uint16_t>(type);
    operation.parameters = parameters;
    return true;
  }

  template <class Number>
  bool depend(Set set, uint32_t count, const Number& number, dna::MlOperation& operation) {
    return fill_indices(
               count, [set](uint32_t) { return uint32_t{set}; }, operation.set_dependencies) &&
           fill_indices(count, number, operation.operation_dependencies);
  }

  // Encoders are distributed among the sums: e, e + decoders, e + 2 decoders ...
  uint32_t encoders_of(uint32_t sum) const {
    return (sizes.encoders - sum + sizes.decoders - 1) / sizes.decoders;
  }

  bool fill_sum(uint32_t number, dna::MlOperation& sum) {
    const uint32_t count = encoders_of(number);
    const float weight = 1.0f / static_cast<float>(count);
    uint32_t bits;
    memcpy(&bits, &weight, sizeof(bits));
    return fill_operation(
               dna::MlOperationType::kWeightedSum, 1 + count,
               [&](uint32_t i) { return i == 0 ? sizes.code : bits; }, sum) &&
           depend(
               kEncoders, count, [&](uint32_t i) { return number + i * sizes.decoders; }, sum);
  }

  /// Network number, then the number of rows of each layer at each LOD: whole joints, fewer from LOD 1 on.
  bool fill_decoder_operation(uint32_t number, dna::MlOperation& run) {
    const uint32_t lods = lod_count();
    const auto parameter = [&](uint32_t i) -> uint32_t {
      if (i == 0) return sizes.encoders + number;
      if (i - 1 < lods) return sizes.hidden;
      return i - 1 - lods == 0 ? outputs() : (sizes.joints + 1) / 2 * kJointValues;
    };
    return fill_operation(dna::MlOperationType::kMlp, 1 + 2 * lods, parameter, run) &&
           depend(
               kSums, 1, [number](uint32_t) { return number; }, run);
  }

  bool fill_operations() {
    if (!make(arena, 1, out.mlbe.types)) return false;
    dna::MlType& type = out.mlbe.types[0];
    const uint32_t counts[kSetCount] = {sizes.encoders, sizes.encoders, sizes.decoders,
                                        sizes.decoders, sizes.decoders};
    if (!make(arena, kSetCount, type.operations) || !make(arena, kSetCount, type.lod_operations)) {
      return false;
    }
    auto in_lod = [this](size_t lod, size_t) { return is_active(lod); };
    for (uint32_t s = 0; s < kSetCount; ++s) {
      if (!make(arena, counts[s], type.operations[s]) ||
          !make_lod_map(arena, lod_count(), counts[s], in_lod, type.lod_operations[s])) {
        return false;
      }
    }
    for (uint32_t e = 0; e < sizes.encoders; ++e) {
      const auto itself = [e](uint32_t) { return e; };
      dna::MlOperation& run = type.operations[kEncoders][e];
      if (!fill_operation(
              dna::MlOperationType::kGather, inputs(), [&](uint32_t i) { return input_of(e, i); },
              type.operations[kGathers][e]) ||
          !fill_operation(dna::MlOperationType::kMlp, 1, itself, run) ||
          !depend(kGathers, 1, itself, run)) {
        return false;
      }
    }
    for (uint32_t d = 0; d < sizes.decoders; ++d) {
      dna::MlOperation& scatter = type.operations[kScatters][d];
      if (!fill_sum(d, type.operations[kSums][d]) ||
          !fill_decoder_operation(d, type.operations[kDecoders][d]) ||
          !fill_operation(
              dna::MlOperationType::kScatter, outputs(),
              [&](uint32_t i) { return control_of(d, i); }, scatter) ||
          !depend(
              kDecoders, 1, [d](uint32_t) { return d; }, scatter)) {
        return false;
      }
    }
    return true;
  }

  // Joints ------------------------------------------------------------------------------------

  /// Evenly distributed over those of the coarsest LOD that has networks.
  uint32_t joint_of(uint32_t n) const {
    uint32_t last = 0;
    while (is_active(last + 1)) ++last;
    const dna::Array<uint16_t> joints = out.defn.lod_joints.at(last);
    const uint32_t wanted = sizes.decoders * sizes.joints;
    return joints[(n + 1) * joints.count / (wanted + 1)];
  }

  bool fill_joints() {
    dna::MlJoints& joints = out.mlbe.joints;
    const auto output = [this](uint32_t i) {
      return joint_of(i / kJointValues) * kJointValues + i % kJointValues;
    };
    return fill_indices(
               3, [](uint32_t i) { return i; }, joints.parameter_keys) &&
           fill_indices(
               3, [](uint32_t i) { return i == 1 ? 1u : 0u; }, joints.parameter_values) &&
           fill_indices(
               control_count(), [this](uint32_t i) { return out.first_ml() + i; },
               joints.input_indices) &&
           fill_indices(control_count(), output, joints.output_indices);
  }
};

}  // namespace

uint32_t ml_control_count_of(SyntheticPreset preset) {
  const MlSizes& sizes = sizes_of(preset);
  return sizes.decoders * sizes.joints * kJointValues;
}

bool add_learned_behavior(SyntheticPreset preset, uint64_t seed, Arena& arena, dna::DnaView& out) {
  MlMaker maker{sizes_of(preset), seed, arena, out};
  out.ml_control_count = maker.control_count();
  return maker.fill_networks() && maker.fill_control_names() && maker.fill_regions() &&
         maker.fill_operations() && maker.fill_joints();
}

}  // namespace mien::synthetic
