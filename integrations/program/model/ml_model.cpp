// SPDX-License-Identifier: MIT
#include "integrations/program/model/ml_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "integrations/program/model/rotation_model.h"

namespace mien::model {
namespace {

using Row = std::vector<double>;
template <class T>
using RowOf = std::vector<T>;
template <class T>
using Triple = std::array<T, 3>;

constexpr double kDirections[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                      {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// 1 for what is the w of a quaternion joint: what a masked network gives.
double default_of(const LayerRig& rig, uint32_t control) {
  const MlJointLayout layout = ml_joint_layout(rig);
  if (layout.rotation != 4) return 0;
  std::vector<uint32_t> seen;
  for (const auto& [input, attribute] : rig.ml_joints) {
    const uint32_t joint = attribute / layout.width, k = attribute % layout.width;
    if (k < layout.translation || k >= layout.translation + 4) continue;
    if (std::count(seen.begin(), seen.end(), joint)) continue;
    seen.push_back(joint);
    if (input + 3u == control) return 1;
  }
  return 0;
}

template <class T>
T activation(uint16_t function, const T& v, double alpha) {
  switch (function) {
    case 1: return v < 0 ? T(0) : v;
    case 2: return v < 0 ? alpha * v : v;
    case 3: return tanh(v);
    case 4: return 1 / (1 + exp(-v));
    default: return v;
  }
}

/// The share that the mask of a network leaves (docs/rig-evaluation.md, 8.5 "Region masks" and 12.12 "Masks
/// may blend").
double mask_of(const LayerRig& rig, uint32_t network, const Row& masks, bool blend) {
  for (size_t r = 0; r < rig.regions.size(); ++r) {
    const auto& region = rig.regions[r];
    if (!std::count(region.begin(), region.end(), network)) continue;
    if (!blend) return masks[r] == 0 ? 0 : 1;
    return std::fmin(std::fmax(masks[r], 0), 1);
  }
  return 1;
}

struct Converter {
  const LayerRig& rig;
  ModelConvention from;
  double c[3][3] = {};

  template <class T>
  Triple<T> turned(const Triple<T>& v) const {
    Triple<T> out = {};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) out[i] += v[k] * c[k][i];
    }
    return out;
  }
  /// C^T R C turns as R does, about the turned axis, the other way if C mirrors.
  template <class T>
  QuaternionOf<T> turned(const QuaternionOf<T>& q) const {
    double determinant = 0;
    for (int i = 0; i < 3; ++i) {
      determinant +=
          c[0][i] * (c[1][(i + 1) % 3] * c[2][(i + 2) % 3] - c[1][(i + 2) % 3] * c[2][(i + 1) % 3]);
    }
    const Triple<T> axis = turned(Triple<T>{q.x, q.y, q.z});
    return {determinant * axis[0], determinant * axis[1], determinant * axis[2], q.w};
  }
};

template <class T>
void convert(const LayerRig& rig, uint32_t lod, RowOf<T>& controls) {
  uint32_t axes[3] = {}, seen = 0;
  Converter converter = {rig, convention_of(rig)};
  bool magnitude = true;
  for (const auto& [key, value] : rig.ml_parameters) {
    if (key == 0x8000) magnitude = value == 1;
    if (key < 3 || key > 9) continue;
    seen |= 1u << key;
    if (key < 6) axes[key - 3] = value;
    if (key >= 6 && key < 9) converter.from.signs[key - 6] = value == 1 ? 1 : -1;
    if (key == 9) converter.from.sequence = value;
  }
  if (seen != 0x3F8) return;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      for (int d = 0; d < 3; ++d) {
        converter.c[i][k] += kDirections[axes[i]][d] * kDirections[rig.axes[k]][d];
      }
    }
  }
  const MlJointLayout layout = ml_joint_layout(rig);
  for (uint32_t joint = 0; joint < rig.base.joint_count; ++joint) {
    if (!rig.has(rig.lod_joints, lod, joint)) continue;
    std::vector<uint16_t> translation, scale;
    int rotation = -1;
    for (const auto& [control, attribute] : rig.ml_joints) {
      if (attribute / layout.width != joint) continue;
      const uint32_t k = attribute % layout.width;
      if (k < layout.translation) translation.push_back(control);
      if (k >= layout.translation + layout.rotation) scale.push_back(control);
      const bool turns = k >= layout.translation && k < layout.translation + layout.rotation;
      if (turns && rotation < 0) rotation = control;
    }
    for (const auto* triple : {&translation, &scale}) {
      if (triple->size() != 3) continue;  // the tests give all three or none
      const Triple<T> v = {controls[(*triple)[0]], controls[(*triple)[1]], controls[(*triple)[2]]};
      // Scale has no direction: it goes to the other axis as it is, or its magnitude alone does.
      for (int i = 0; i < 3; ++i) {
        T sum = 0;
        for (int k = 0; k < 3; ++k) {
          sum += v[k] * (triple == &scale ? std::fabs(converter.c[k][i]) : converter.c[k][i]);
        }
        controls[(*triple)[i]] = triple == &scale && magnitude && sum < 0 ? -sum : sum;
      }
    }
    if (rotation < 0) continue;
    T* x = controls.data() + rotation;
    const ModelConvention to = convention_of(rig);
    const Triple<T> angles = {x[0], x[1], x[2]};
    const QuaternionOf<T> q =
        converter.turned(layout.rotation == 4 ? unit(QuaternionOf<T>{x[0], x[1], x[2], x[3]})
                                              : model_quaternion(converter.from, angles));
    if (layout.rotation == 4) {
      x[0] = q.x, x[1] = q.y, x[2] = q.z, x[3] = q.w;
    } else {
      const Triple<T> out = model_angles(to, q);
      std::copy(out.begin(), out.end(), x);
    }
  }
}

/// A file without operations is gather, run, scatter for each network (8.1).
template <class T>
void run_networks(const LayerRig& rig, uint32_t lod, const Row& masks, bool blend,
                  RowOf<T>& controls) {
  for (size_t n = 0; n < rig.networks.size(); ++n) {
    if (!rig.has(rig.lod_networks, lod, static_cast<uint32_t>(n))) continue;
    const PlainNetwork& network = rig.networks[n];
    RowOf<T> inputs;
    for (uint16_t input : network.inputs) inputs.push_back(controls[input]);
    const RowOf<T> outputs = model_network(network, inputs);
    const double mask = mask_of(rig, static_cast<uint32_t>(n), masks, blend);
    for (size_t i = 0; i < network.outputs.size(); ++i) {
      const double rest = default_of(rig, network.outputs[i]);
      controls[network.outputs[i]] = rest + mask * (outputs[i] - rest);
    }
  }
}

template <class T>
void run_operations(const LayerRig& rig, uint32_t lod, const Row& masks, bool blend,
                    RowOf<T>& controls) {
  std::vector<std::vector<RowOf<T>>> results(rig.operations.size());
  // Controls are gathered when they are needed.
  const auto result_of = [&](const std::pair<uint16_t, uint16_t>& dependency) {
    const PlainOperation& from = rig.operations[dependency.first][dependency.second];
    if (from.type != OperationType::kGather) return results[dependency.first][dependency.second];
    RowOf<T> gathered;
    for (uint32_t control : from.parameters) gathered.push_back(controls[control]);
    return gathered;
  };
  for (size_t s = 0; s < rig.operations.size(); ++s) {
    for (size_t o = 0; o < rig.operations[s].size(); ++o) {
      const PlainOperation& operation = rig.operations[s][o];
      RowOf<T> out;
      const bool runs = rig.lod_operations.empty() ||
                        rig.has(rig.lod_operations[s], lod, static_cast<uint32_t>(o));
      if (operation.type == OperationType::kMlp && !runs) {
        out.assign(rig.networks[operation.parameters[0]].layers.back().biases.size(), 0.0);
      } else if (operation.type == OperationType::kMlp) {
        RowOf<T> gathered, all;
        for (const auto& [set, number] : operation.dependencies) {
          const RowOf<T> from = result_of({set, number});
          all.insert(all.end(), from.begin(), from.end());
          if (rig.operations[set][number].type != OperationType::kGather) continue;
          gathered.insert(gathered.end(), from.begin(), from.end());
        }
        const uint32_t network = operation.parameters[0];
        out = model_network(rig.networks[network], gathered.empty() ? all : gathered);
        const double mask = mask_of(rig, network, masks, blend);
        const RowOf<T> scattered = out;
        for (T& v : out) v *= mask;
        // Scatters, wherever they stand, take effect with the network (8.2).
        size_t at = 0, limit = ~size_t{0};
        const size_t limits = operation.parameters.size() - 1;
        if (limits > 1) limit = operation.parameters[1 + limits - rig.base.lod_count + lod];
        for (const PlainOperationSet& later : rig.operations) {
          for (const PlainOperation& scatter : later) {
            if (scatter.type != OperationType::kScatter) continue;
            for (const auto& [set, number] : scatter.dependencies) {
              if (set != s || number != o) continue;
              for (uint32_t control : scatter.parameters) {
                const double rest = default_of(rig, control);
                if (at < limit && at < scattered.size()) {
                  controls[control] = rest + mask * (scattered[at] - rest);
                }
                ++at;
              }
            }
          }
        }
      } else if (operation.type == OperationType::kWeightedSum) {
        out.assign(operation.dependencies.empty() ? 0 : operation.parameters[0], 0);
        for (size_t d = 0; runs && d < operation.dependencies.size(); ++d) {
          const RowOf<T> from = result_of(operation.dependencies[d]);
          float weight;
          memcpy(&weight, &operation.parameters[d + 1], sizeof(weight));
          for (size_t i = 0; i < out.size(); ++i) out[i] += weight * from[i];
        }
      }
      results[s].push_back(out);
    }
  }
}

}  // namespace

MlJointLayout ml_joint_layout(const LayerRig& rig) {
  MlJointLayout layout;
  for (const auto& [key, value] : rig.ml_parameters) {
    if (key == 0) layout.translation = 3;
    if (key == 1) layout.rotation = value == 1 ? 4 : 3;
    if (key == 2) layout.scale = 3;
  }
  layout.width = layout.translation + layout.rotation + layout.scale;
  return layout;
}

template <class T>
std::vector<T> model_network(const PlainNetwork& network, std::vector<T> values) {
  for (const PlainNetworkLayer& layer : network.layers) {
    RowOf<T> out;
    const size_t inputs = layer.weights.size() / layer.biases.size();
    const double alpha = layer.parameters.empty() ? 0.01 : layer.parameters[0];
    for (size_t r = 0; r < layer.biases.size(); ++r) {
      T sum = layer.biases[r];
      for (size_t c = 0; c < inputs; ++c) sum += layer.weights[r * inputs + c] * values[c];
      out.push_back(activation(layer.function, sum, alpha));
    }
    values = out;
  }
  return values;
}

template <class T>
void model_ml(const LayerRig& rig, uint32_t lod, const std::vector<double>& masks, bool blend_masks,
              std::vector<T>& controls) {
  if (rig.operations.empty()) {
    run_networks(rig, lod, masks, blend_masks, controls);
  } else {
    run_operations(rig, lod, masks, blend_masks, controls);
  }
  convert(rig, lod, controls);
}

#define MIEN_MODEL_ML(T)                                                              \
  template std::vector<T> model_network(const PlainNetwork&, std::vector<T>);         \
  template void model_ml(const LayerRig&, uint32_t, const std::vector<double>&, bool, \
                         std::vector<T>&);
MIEN_MODEL_ML(double)
MIEN_MODEL_ML(Dual)

}  // namespace mien::model
