// SPDX-License-Identifier: MIT
// Derivatives of networks and weighted sums (docs/derivatives.md, 3). A layer is a product with its
// weights, forward, or with the transposed ones, which are stored separately, in reverse.
#include <cmath>
#include <utility>

#include "runtime/base/half.h"
#include "runtime/derive/derive_stages.h"
#include "runtime/eval/stages.h"
#include "simd/dense_kernels.h"

namespace mien {
namespace {

const float* weights_of(const Derivatives& d, const NetworkLayer& layer) {
  const float* all = d.rig->half_storage ? d.forward_weights.data : d.rig->ml.values.data;
  return all + layer.first_value;
}

/// outputs = weights * inputs, without bias and activation.
template <uint32_t L>
void multiply(const Derivatives& d, const float* weights, uint32_t columns, uint32_t rows,
              const float* inputs, float* outputs) {
  const KernelTable& kernels = *d.rig->kernels;
  if constexpr (L == 1) {
    DenseLayerArgs args = {};
    args.values = weights;
    args.biases = d.zero_biases.data;
    args.inputs = inputs;
    args.outputs = outputs;
    args.column_count = columns;
    args.row_count = rows;
    args.portable = d.rig->portable;
    kernels.dense_layer(args);
  } else {
    DenseBatchArgs args = {};
    args.values = weights;
    args.biases = d.zero_biases.data;
    args.inputs = inputs;
    args.outputs = outputs;
    args.column_count = columns;
    args.row_count = rows;
    args.lane_count = kBatchLanes;
    args.portable = d.rig->portable;
    kernels.dense_batch(args);
  }
}

/// The slope of an activation, and its result. ReLU and leaky ReLU get the sum, the others their result.
float slope_of(const NetworkLayer& layer, float& value) {
  switch (layer.function) {
    case 1:
    case 2: {
      const float slope = value < 0.0f ? (layer.function == 1 ? 0.0f : layer.alpha) : 1.0f;
      value *= slope;
      return slope;
    }
    case 3: return 1.0f - value * value;
    case 4: return value * (1.0f - value);
    default: return 1.0f;
  }
}

void run_layer(Derivatives& d, const NetworkLayer& layer, const float* in, float* out,
               float* slopes) {
  const Rig& rig = *d.rig;
  DenseLayerArgs args = {};
  args.values = weights_of(d, layer);
  args.biases = rig.ml.biases.data + layer.first_bias;
  args.inputs = in;
  args.outputs = out;
  args.column_count = layer.input_count;
  args.row_count = layer.output_count;
  args.portable = rig.portable;
  args.function = layer.function <= 2 ? 0 : layer.function;
  rig.kernels->dense_layer(args);
  for (uint32_t i = 0; i < layer.output_count; ++i) slopes[i] = slope_of(layer, out[i]);
}

/// Calls f(control) for what ML joints read, if it is converted: those controls start from constants.
template <class F>
void for_each_joint_control(const Rig& rig, F&& f) {
  const auto call = [&](uint32_t control) {
    if (control >= rig.raw_count && control < rig.control_count) f(control);
  };
  for (const MlJoint& joint : rig.ml.joints) {
    for (const uint16_t control : joint.translation) call(control);
    for (const uint16_t control : joint.scale) call(control);
    if (joint.rotation_control == kNoControl) continue;
    const uint32_t parts = rig.ml.quaternion_rotations ? 4 : 3;
    for (uint32_t i = 0; i < parts; ++i) call(joint.rotation_control + i);
  }
}

// Converted ML joints -----------------------------------------------------------------------------

void linearize_conversion(Derivatives& d) {
  const Rig& rig = *d.rig;
  const CoordinateChange& change = rig.ml.change;
  for (size_t j = 0; j < rig.ml.joints.count; ++j) {
    const MlJoint& joint = rig.ml.joints[j];
    float* const factors = d.ml_triples.data + j * 6;
    for (int part = 0; part < 2; ++part) {
      const uint16_t* controls = part == 0 ? joint.translation : joint.scale;
      float v[3] = {};
      for (int i = 0; i < 3; ++i) v[i] = controls[i] == kNoControl ? 0.0f : d.values[controls[i]];
      for (int i = 0; i < 3; ++i) {
        const float value = v[change.from[i]];
        const bool flips = part == 1 && rig.ml.scale_magnitude && value < 0.0f;
        factors[3 * part + i] = part == 0 ? change.normal[i] : flips ? -1.0f : 1.0f;
        if (controls[i] != kNoControl) d.values[controls[i]] = value * factors[3 * part + i];
      }
    }
    if (joint.rotation_control == kNoControl) continue;
    float* const x = d.values.data + joint.rotation_control;
    convert_rotation_slopes(d, x, d.ml_turns.data + j * 16);
  }
}

/// The three values of a triple that are moved: from[i] of those with a control.
template <uint32_t L>
void push_triple(Derivatives& d, const uint16_t* controls, const float* factors) {
  const CoordinateChange& change = d.rig->ml.change;
  float v[3][L] = {};
  for (int i = 0; i < 3; ++i) {
    if (controls[i] == kNoControl) continue;
    take<L>(v[i], d.controls.data + size_t{controls[i]} * L);
  }
  for (int i = 0; i < 3; ++i) {
    if (controls[i] == kNoControl) continue;
    add_scaled<L>(d.controls.data + size_t{controls[i]} * L, v[change.from[i]], factors[i]);
  }
}
template <uint32_t L>
void pull_triple(Derivatives& d, const uint16_t* controls, const float* factors) {
  const CoordinateChange& change = d.rig->ml.change;
  float v[3][L] = {};
  for (int i = 0; i < 3; ++i) {
    if (controls[i] == kNoControl) continue;
    float gradient[L];
    take<L>(gradient, d.controls.data + size_t{controls[i]} * L);
    add_scaled<L>(v[change.from[i]], gradient, factors[i]);
  }
  for (int i = 0; i < 3; ++i) {
    if (controls[i] == kNoControl) continue;
    std::copy(v[i], v[i] + L, d.controls.data + size_t{controls[i]} * L);
  }
}

/// x = M x, or M^T x.
template <uint32_t L>
void turn(float* x, const float* m, uint32_t parts, bool transposed) {
  float in[4][L], zero = 0;
  for (uint32_t i = 0; i < parts; ++i) take<L>(in[i], x + size_t{i} * L);
  static_cast<void>(zero);
  for (uint32_t i = 0; i < parts; ++i) {
    for (uint32_t k = 0; k < parts; ++k) {
      add_scaled<L>(x + size_t{i} * L, in[k], transposed ? m[4 * k + i] : m[4 * i + k]);
    }
  }
}

template <uint32_t L>
void push_conversion(Derivatives& d) {
  const Rig& rig = *d.rig;
  for (size_t j = 0; j < rig.ml.joints.count; ++j) {
    const MlJoint& joint = rig.ml.joints[j];
    push_triple<L>(d, joint.translation, d.ml_triples.data + j * 6);
    push_triple<L>(d, joint.scale, d.ml_triples.data + j * 6 + 3);
    if (joint.rotation_control == kNoControl) continue;
    turn<L>(d.controls.data + size_t{joint.rotation_control} * L, d.ml_turns.data + j * 16,
            rig.ml.quaternion_rotations ? 4 : 3, false);
  }
}
template <uint32_t L>
void pull_conversion(Derivatives& d) {
  const Rig& rig = *d.rig;
  for (size_t j = rig.ml.joints.count; j-- > 0;) {
    const MlJoint& joint = rig.ml.joints[j];
    if (joint.rotation_control != kNoControl) {
      turn<L>(d.controls.data + size_t{joint.rotation_control} * L, d.ml_turns.data + j * 16,
              rig.ml.quaternion_rotations ? 4 : 3, true);
    }
    pull_triple<L>(d, joint.scale, d.ml_triples.data + j * 6 + 3);
    pull_triple<L>(d, joint.translation, d.ml_triples.data + j * 6);
  }
}

/// A network may be run by several steps, so slopes belong to steps.
size_t first_slope_of(const Derivatives& d, const MlStep& step, uint32_t layer) {
  size_t first = d.first_slope[static_cast<size_t>(&step - d.rig->ml.steps.data)];
  for (uint32_t l = 0; l < layer; ++l) {
    first += padded(d.rig->ml.layers[step.first_layer + l].output_count);
  }
  return first;
}

template <uint32_t L>
void push_network(Derivatives& d, const MlStep& step) {
  float* in = d.ml_layers[0].data;
  float* out = d.ml_layers[1].data;
  for_each_ml_input<L>(
      d.rig->ml, step, d.controls.data, d.ml_values.data,
      [&](const float* from, uint32_t i) { std::copy(from, from + L, in + size_t{i} * L); });
  for (uint32_t l = 0; l < step.layer_count; ++l) {
    const NetworkLayer& layer = d.rig->ml.layers[step.first_layer + l];
    multiply<L>(d, weights_of(d, layer), layer.input_count, layer.output_count, in, out);
    const float* slopes = d.slopes.data + first_slope_of(d, step, l);
    for (uint32_t i = 0; i < layer.output_count; ++i) {
      for (uint32_t k = 0; k < L; ++k) out[size_t{i} * L + k] *= slopes[i];
    }
    std::swap(in, out);
  }
  std::copy(in, in + size_t{step.output_count} * L,
            d.ml_values.data + size_t{step.first_output} * L);
}

/// Gradients of the step's outputs, in the buffer, -> of its inputs, added.
template <uint32_t L>
void pull_network(Derivatives& d, const MlStep& step) {
  float* in = d.ml_layers[0].data;
  float* out = d.ml_layers[1].data;
  float* values = d.ml_values.data + size_t{step.first_output} * L;
  std::copy(values, values + size_t{step.output_count} * L, in);
  for (uint32_t l = step.layer_count; l-- > 0;) {
    const NetworkLayer& layer = d.rig->ml.layers[step.first_layer + l];
    const float* slopes = d.slopes.data + first_slope_of(d, step, l);
    for (uint32_t i = 0; i < layer.output_count; ++i) {
      for (uint32_t k = 0; k < L; ++k) in[size_t{i} * L + k] *= slopes[i];
    }
    multiply<L>(d, d.transposed.data + d.first_transposed[step.first_layer + l], layer.output_count,
                layer.input_count, in, out);
    std::swap(in, out);
  }
  for_each_ml_input<L>(d.rig->ml, step, d.controls.data, d.ml_values.data,
                       [&](float* to, uint32_t i) { add_scaled<L>(to, in + size_t{i} * L, 1.0f); });
}

}  // namespace

void pack_networks(Derivatives& d) {
  const Rig& rig = *d.rig;
  const MlTable& ml = rig.ml;
  for (size_t i = 0; i < d.forward_weights.count; ++i) {
    d.forward_weights[i] = float_from_half(ml.halves[i]);
  }
  std::fill(d.zero_biases.begin(), d.zero_biases.end(), 0.0f);
  std::fill(d.transposed.begin(), d.transposed.end(), 0.0f);
  uint64_t value = 0;
  for (size_t l = 0; l < ml.layers.count; ++l) {
    const NetworkLayer& layer = ml.layers[l];
    d.first_transposed[l] = value;
    const float* from = weights_of(d, layer);
    float* to = d.transposed.data + value;
    for (size_t r = 0; r < layer.output_count; ++r) {
      const float* row = from + r / kBlockLanes * layer.input_count * kBlockLanes + r % kBlockLanes;
      for (size_t c = 0; c < layer.input_count; ++c) {
        to[(c / kBlockLanes * layer.output_count + r) * kBlockLanes + c % kBlockLanes] =
            row[c * kBlockLanes];
      }
    }
    value += padded(size_t{layer.input_count}) * layer.output_count;
  }
}

void linearize_ml(Derivatives& d, const Instance& instance) {
  const Rig& rig = *d.rig;
  const MlTable& ml = rig.ml;
  if (ml.converts) {
    for_each_joint_control(rig, [&](uint32_t c) { d.values[c] = rig.initial_controls[c]; });
  }
  for (size_t s = 0; s < ml.steps.count; ++s) {
    const MlStep& step = ml.steps[s];
    if (!is_at_lod(step.lods, d.lod)) continue;
    float* const outputs = d.ml_values.data + step.first_output;
    if (step.layer_count == 0) {
      std::fill(outputs, outputs + step.output_count, 0.0f);
      for_each_ml_term<1>(ml, step, d.values.data, d.ml_values.data,
                          [&](const float* from, uint32_t i, float weight) {
                            outputs[i] = saturated(outputs[i] + saturated(weight * *from));
                          });
      continue;
    }
    const float mask = d.ml_masks[s] = mask_of(rig, instance, step);
    if (!(mask > 0.0f)) {
      std::fill(outputs, outputs + step.output_count, 0.0f);
    } else {
      float* in = d.ml_layers[0].data;
      float* out = d.ml_layers[1].data;
      for_each_ml_input<1>(ml, step, d.values.data, d.ml_values.data,
                           [&](const float* from, uint32_t i) { in[i] = *from; });
      for (uint32_t l = 0; l < step.layer_count; ++l) {
        run_layer(d, ml.layers[step.first_layer + l], in, out,
                  d.slopes.data + first_slope_of(d, step, l));
        std::swap(in, out);
      }
      std::copy(in, in + step.output_count, outputs);
    }
    const uint32_t count = scatter_count(rig, step, d.lod);
    for (uint32_t i = 0; i < count; ++i) {
      const uint16_t to = ml.controls[step.first_scatter + i];
      const float rest = ml.default_is_one[to] ? 1.0f : 0.0f;
      d.values[to] = mask == 1.0f ? outputs[i] : rest + mask * (outputs[i] - rest);
      d.moving[to] = mask > 0.0f;
    }
    if (mask > 0.0f && mask < 1.0f) {
      for (uint32_t i = 0; i < step.output_count; ++i) outputs[i] *= mask;
    }
  }
  if (ml.converts) linearize_conversion(d);
}

template <uint32_t L>
void push_ml(Derivatives& d) {
  const Rig& rig = *d.rig;
  const MlTable& ml = rig.ml;
  if (ml.converts) {
    for_each_joint_control(rig, [&](uint32_t c) { clear<L>(d.controls.data + size_t{c} * L); });
  }
  std::fill(d.ml_values.data, d.ml_values.data + size_t{ml.buffer_size} * L, 0.0f);
  for (size_t s = 0; s < ml.steps.count; ++s) {
    const MlStep& step = ml.steps[s];
    if (!is_at_lod(step.lods, d.lod)) continue;
    float* const outputs = d.ml_values.data + size_t{step.first_output} * L;
    if (step.layer_count == 0) {
      for_each_ml_term<L>(ml, step, d.controls.data, d.ml_values.data,
                          [&](const float* from, uint32_t i, float weight) {
                            add_scaled<L>(outputs + size_t{i} * L, from, weight);
                          });
      continue;
    }
    const float mask = d.ml_masks[s];
    if (mask > 0.0f) push_network<L>(d, step);
    for (size_t i = 0; mask < 1.0f && i < size_t{step.output_count} * L; ++i) outputs[i] *= mask;
    const uint32_t count = scatter_count(rig, step, d.lod);
    for (uint32_t i = 0; i < count; ++i) {
      const float* from = outputs + size_t{i} * L;
      std::copy(from, from + L, d.controls.data + size_t{ml.controls[step.first_scatter + i]} * L);
    }
  }
  if (ml.converts) push_conversion<L>(d);
}

template <uint32_t L>
void pull_ml(Derivatives& d) {
  const Rig& rig = *d.rig;
  const MlTable& ml = rig.ml;
  if (ml.converts) pull_conversion<L>(d);
  std::fill(d.ml_values.data, d.ml_values.data + size_t{ml.buffer_size} * L, 0.0f);
  for (size_t s = ml.steps.count; s-- > 0;) {
    const MlStep& step = ml.steps[s];
    if (!is_at_lod(step.lods, d.lod)) continue;
    float* const outputs = d.ml_values.data + size_t{step.first_output} * L;
    if (step.layer_count == 0) {
      for_each_ml_term<L>(ml, step, d.controls.data, d.ml_values.data,
                          [&](float* to, uint32_t i, float weight) {
                            add_scaled<L>(to, outputs + size_t{i} * L, weight);
                          });
      continue;
    }
    const uint32_t count = scatter_count(rig, step, d.lod);
    for (uint32_t i = count; i-- > 0;) {
      float gradient[L];
      take<L>(gradient, d.controls.data + size_t{ml.controls[step.first_scatter + i]} * L);
      add_scaled<L>(outputs + size_t{i} * L, gradient, 1.0f);
    }
    const float mask = d.ml_masks[s];
    for (size_t i = 0; mask < 1.0f && i < size_t{step.output_count} * L; ++i) outputs[i] *= mask;
    if (mask > 0.0f) pull_network<L>(d, step);
  }
  if (ml.converts) {
    for_each_joint_control(rig, [&](uint32_t c) { clear<L>(d.controls.data + size_t{c} * L); });
  }
}

template void push_ml<1>(Derivatives&);
template void push_ml<kBatchLanes>(Derivatives&);
template void pull_ml<1>(Derivatives&);
template void pull_ml<kBatchLanes>(Derivatives&);

}  // namespace mien
