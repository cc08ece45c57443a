// SPDX-License-Identifier: MIT
#include "runtime/load/dna/convert/convert_networks.h"

namespace mien::dna {
namespace {

constexpr uint16_t kTanh = 3;  // this activation function and those after it are not linear

MlOperationType type_of(const MlOperation& operation) {
  return static_cast<MlOperationType>(operation.type);
}

uint32_t input_count(const NeuralNetwork& network) {
  if (network.layers.count == 0 || network.layers[0].biases.count == 0) return 0;
  return network.layers[0].weights.count / network.layers[0].biases.count;
}

uint32_t output_count(const NeuralNetwork& network) {
  return network.layers.count ? network.layers[network.layers.count - 1].biases.count : 0;
}

class NetworkConverter {
 public:
  NetworkConverter(DnaView& view, const RotationControls& controls, ConvertedArrays& arrays,
                   Arena& arena, Error& error)
      : view_(view), controls_(controls), arrays_(arrays), arena_(arena), error_(error) {}

  Status run() {
    const List<NeuralNetwork>& networks = view_.mlbh.networks;
    ends_ = arena_.array<Ends>(networks.count);
    if (ends_.count != networks.count) return arrays_.run_out();
    for (uint32_t n = 0; n < networks.count; ++n) {
      ends_[n].signs = arena_.array<int8_t>(input_count(networks[n]));
      ends_[n].units = arena_.array<double>(output_count(networks[n]));
      if (ends_[n].signs.count != input_count(networks[n]) ||
          ends_[n].units.count != output_count(networks[n])) {
        return arrays_.run_out();
      }
    }
    if (view_.mlbe.types.count == 0) note_networks();
    for (const MlType& type : view_.mlbe.types) note_operations(type);
    for (const MlType& type : view_.mlbe.types) check_dependencies(type);
    for (uint32_t n = 0; n < networks.count; ++n) check_last_layer(n);
    if (status_ != Status::kOk || arrays_.out_of_memory()) return status_;
    for (uint32_t n = 0; n < networks.count; ++n) apply(networks[n], ends_[n]);
    for (const MlType& type : view_.mlbe.types) rename_gathers(type);
    return Status::kOk;
  }

 private:
  /// Factors to fold into the weights of a network. 0: not known yet, so any factor fits.
  struct Ends {
    Span<int8_t> signs;   // by input
    Span<double> units;   // by output
    bool scales = false;  // a unit is not 1
  };

  // Controls that move joints are still in the system of the ML joints while networks run.
  Reading read(uint32_t control) const {
    if (controls_.moves_ml_joint(control)) return {static_cast<uint16_t>(control), 1};
    return controls_.read(control);
  }

  void refuse(uint32_t network, const char* why) {
    if (status_ != Status::kOk) return;
    status_ = fail(error_, Status::kDnaValue, kNoOffset,
                   "mlbh.neuralNetworks[%u]: %s; convert to a system with the same axes and units",
                   network, why);
  }

  void note_input(uint32_t n, size_t place, uint32_t control) {
    if (place >= ends_[n].signs.count) return;
    const int8_t sign = read(control).sign;
    int8_t& known = ends_[n].signs[place];
    if (known == 0) known = sign;
    if (known != sign) refuse(n, "reads inputs that change their signs in different ways");
  }

  /// `place` is that of an output: the checks count those of networks, and scatters end with them.
  void note_output(uint32_t n, size_t place, uint32_t control) {
    if (control < view_.first_psd() && !controls_.read(control).same(control)) {
      return refuse(n, "writes a control that is part of a quaternion input");
    }
    const double unit = controls_.unit_of(control);
    double& known = ends_[n].units[place];
    if (known == 0) known = unit;
    if (known != unit) refuse(n, "writes one output in two units");
    ends_[n].scales |= unit != 1;
  }

  void note_networks() {
    for (uint32_t n = 0; n < view_.mlbh.networks.count; ++n) {
      const NeuralNetwork& network = view_.mlbh.networks[n];
      for (uint32_t i = 0; i < network.input_indices.count; ++i) {
        note_input(n, i, network.input_indices[i]);
      }
      for (uint32_t i = 0; i < network.output_indices.count; ++i) {
        note_output(n, i, network.output_indices[i]);
      }
    }
  }

  static const MlOperation& dependency(const MlType& type, const MlOperation& of, uint32_t d) {
    return type.operations[of.set_dependencies[d]][of.operation_dependencies[d]];
  }

  void note_operations(const MlType& type) {
    // How much of its outputs each operation has scattered: several scatters go on where the last
    // one ended (docs/rig-evaluation.md, 8.2 "MLP").
    Span<Span<uint32_t>> scattered = arena_.array<Span<uint32_t>>(type.operations.count);
    for (uint32_t s = 0; s < scattered.count; ++s) {
      scattered[s] = arena_.array<uint32_t>(type.operations[s].count);
      if (scattered[s].count != type.operations[s].count) return void(arrays_.run_out());
    }
    if (scattered.count != type.operations.count) return void(arrays_.run_out());
    for (const auto& set : type.operations) {
      for (const MlOperation& operation : set) {
        if (type_of(operation) == MlOperationType::kMlp) note_gathers(type, operation);
        if (type_of(operation) != MlOperationType::kScatter) continue;
        for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
          const MlOperation& from = dependency(type, operation, d);
          if (type_of(from) != MlOperationType::kMlp) continue;
          const uint32_t n = from.parameters[0];
          uint32_t& place =
              scattered[operation.set_dependencies[d]][operation.operation_dependencies[d]];
          for (uint32_t i = 0; i < operation.parameters.count && place < ends_[n].units.count;
               ++i) {
            note_output(n, place++, operation.parameters[i]);
          }
        }
      }
    }
  }

  void note_gathers(const MlType& type, const MlOperation& operation) {
    const uint32_t n = operation.parameters[0];
    size_t place = 0;
    for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
      const MlOperation& from = dependency(type, operation, d);
      if (type_of(from) != MlOperationType::kGather) continue;
      for (uint32_t i = 0; i < from.parameters.count && place < ends_[n].signs.count; ++i) {
        note_input(n, place++, from.parameters[i]);
      }
    }
  }

  // Outputs with other units may not go on to other operations; a sum has one weight for all values that it
  // gathers, so no sign changes there.
  void check_dependencies(const MlType& type) {
    for (const auto& set : type.operations) {
      for (const MlOperation& operation : set) {
        const bool sums = type_of(operation) == MlOperationType::kWeightedSum;
        if (!sums && type_of(operation) != MlOperationType::kMlp) continue;
        for (uint32_t d = 0; d < operation.set_dependencies.count; ++d) {
          const MlOperation& from = dependency(type, operation, d);
          if (type_of(from) == MlOperationType::kMlp && ends_[from.parameters[0]].scales) {
            refuse(from.parameters[0], "moves joints, and other operations read it too");
          }
          if (sums && type_of(from) == MlOperationType::kGather) check_sum(from);
        }
      }
    }
  }

  void check_sum(const MlOperation& gather) {
    for (uint32_t i = 0; i < gather.parameters.count && status_ == Status::kOk; ++i) {
      if (read(gather.parameters[i]).sign == 1) continue;
      status_ =
          fail(error_, Status::kDnaValue, view_.offset_of(gather.parameters.data + 4 * size_t{i}),
               "mlbe: a weighted sum reads control %u, which is part of a rotation: it cannot "
               "be converted to other axes",
               gather.parameters[i]);
    }
  }

  void check_last_layer(uint32_t n) {
    const NeuralNetwork& network = view_.mlbh.networks[n];
    if (!ends_[n].scales || network.layers[network.layers.count - 1].function_id < kTanh) return;
    refuse(n, "ends in tanh or sigmoid and moves joints: its outputs cannot have another unit");
  }

  void apply(NeuralNetwork& network, const Ends& ends) {
    bool negates = false;
    for (const int8_t sign : ends.signs) negates |= sign < 0;
    if (negates) {
      NetworkLayer& layer = network.layers[0];
      const Array<float> old = layer.weights;
      const uint32_t columns = static_cast<uint32_t>(ends.signs.count);
      layer.weights = arrays_.remake(
          old, [&](uint32_t i) { return ends.signs[i % columns] < 0 ? -old[i] : old[i]; });
    }
    if (ends.scales) {
      NetworkLayer& layer = network.layers[network.layers.count - 1];
      const auto unit = [&](uint32_t row) { return ends.units[row] == 0 ? 1.0 : ends.units[row]; };
      const Array<float> weights = layer.weights, biases = layer.biases;
      const uint32_t columns = weights.count / biases.count;
      layer.biases = arrays_.remake(biases, [&](uint32_t r) { return scaled(biases[r], unit(r)); });
      if (columns != 0) {
        layer.weights = arrays_.remake(
            weights, [&](uint32_t i) { return scaled(weights[i], unit(i / columns)); });
      }
    }
    network.input_indices =
        arrays_.map_if_new(network.input_indices, [this](uint16_t c) { return read(c).control; });
  }

  void rename_gathers(const MlType& type) {
    for (const auto& set : type.operations) {
      for (MlOperation& operation : set) {
        if (type_of(operation) != MlOperationType::kGather) continue;
        operation.parameters = arrays_.map_if_new(
            operation.parameters, [this](uint32_t c) { return uint32_t{read(c).control}; });
      }
    }
  }

  DnaView& view_;
  const RotationControls& controls_;
  ConvertedArrays& arrays_;
  Arena& arena_;
  Error& error_;
  Status status_ = Status::kOk;
  Span<Ends> ends_;
};

}  // namespace

Status convert_networks(DnaView& view, const RotationControls& controls, ConvertedArrays& arrays,
                        Arena& arena, Error& error) {
  if (!controls.any() || view.mlbh.networks.count == 0) return Status::kOk;
  return NetworkConverter(view, controls, arrays, arena, error).run();
}

}  // namespace mien::dna
