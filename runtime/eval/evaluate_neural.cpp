// SPDX-License-Identifier: MIT
// The ML stage: controls -> networks and weighted sums -> controls (docs/rig-evaluation.md,
// 8 "Machine-learned behavior").
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "runtime/eval/instance_packet.h"
#include "runtime/eval/stages.h"
#include "simd/dense_kernels.h"
#include "simd/lanes.h"

namespace mien {
namespace {

bool is_active(uint64_t lods, uint32_t lod) { return lods >> lod & 1; }

void gather(const Rig& rig, Instance& instance, const MlStep& step, float* inputs) {
  const MlTable& ml = rig.ml;
  if (step.gather_count != 0) {
    rig.kernels->gather_inputs(instance.controls.data, ml.controls.data + step.first_gather,
                               step.gather_count, inputs);
    return;
  }
  for (const MlDependency& from :
       ml.dependencies.slice(step.first_dependency, step.dependency_count)) {
    const float* values = instance.ml_values.data + from.first;
    inputs = std::copy(values, values + from.count, inputs);
  }
}

/// The kernel arguments of a layer that are the same in a single evaluation and a batch.
template <class Args>
Args layer_args(const Rig& rig, const NetworkLayer& layer) {
  Args args = {};
  args.portable = rig.portable;
  args.biases = rig.ml.biases.data + layer.first_bias;
  args.alpha = layer.alpha;
  args.column_count = layer.input_count;
  args.row_count = layer.output_count;
  args.function = layer.function;
  return args;
}

/// Layer after layer; the last one writes to the step's outputs.
void run_network(const Rig& rig, Instance& instance, const MlStep& step) {
  float* in = instance.ml_layers[0].data;
  float* out = instance.ml_layers[1].data;
  gather(rig, instance, step, in);
  for (uint32_t l = 0; l < step.layer_count; ++l) {
    const NetworkLayer& layer = rig.ml.layers[step.first_layer + l];
    auto args = layer_args<DenseLayerArgs>(rig, layer);
    const bool last = l + 1 == step.layer_count;
    args.halves = rig.half_storage;
    if (args.halves) {
      args.values = rig.ml.halves.data + layer.first_value;
    } else {
      args.values = rig.ml.values.data + layer.first_value;
    }
    args.inputs = in;
    args.sparse = l == 0 || rig.ml.layers[step.first_layer + l - 1].function == 1;
    args.outputs = last ? instance.ml_values.data + step.first_output : out;
    rig.kernels->dense_layer(args);
    std::swap(in, out);
  }
}

// Several instances: they are lanes ---------------------------------------------------------------

/// Gathers the inputs of a step from controls that are in lanes already, [control][32], into the lanes of
/// `those`.
void gather_in_lanes(const Rig& rig, const float* controls, const MlStep& step, float* inputs) {
  const uint32_t count = std::min(step.gather_count, rig.ml.layers[step.first_layer].input_count);
  for (const uint16_t control : rig.ml.controls.slice(step.first_gather, count)) {
    memcpy(inputs, controls + size_t{control} * kBatchLanes, kBatchLanes * sizeof(float));
    inputs += kBatchLanes;
  }
}

/// The same for one instance after another.
void gather_one_by_one(const InstancePacket& those, const MlStep& step, float* to) {
  const Rig& rig = those.rig;
  float* inputs[kBatchLanes];
  for (uint32_t k = 0; k < those.count; ++k) {
    inputs[k] = those.instances[k]->ml_layers[0].data;
    gather(rig, *those.instances[k], step, inputs[k]);
  }
  rig.kernels->gather_lanes(inputs, those.count, rig.ml.layers[step.first_layer].input_count, to);
}

/// Layer after layer; returns the outputs of the last one in lanes. `controls` as for gather_in_lanes(), or
/// null.
const float* run_layers(const InstancePacket& those, const MlStep& step, const float* controls) {
  const Rig& rig = those.rig;
  const PacketScratch& scratch = *those.scratch;
  float* in = scratch.ml_layers[0].data;
  float* out = scratch.ml_layers[1].data;
  if (controls && step.gather_count >= rig.ml.layers[step.first_layer].input_count) {
    gather_in_lanes(rig, controls, step, in);
  } else {
    gather_one_by_one(those, step, in);
  }
  for (uint32_t l = 0; l < step.layer_count; ++l) {
    const NetworkLayer& layer = rig.ml.layers[step.first_layer + l];
    auto args = layer_args<DenseBatchArgs>(rig, layer);
    args.values = those.tables->ml_values.data + layer.first_value;
    args.inputs = in;
    args.outputs = out;
    args.lane_count = those.count;
    rig.kernels->dense_batch(args);
    std::swap(in, out);
  }
  return in;
}

/// Copies values to the step's outputs.
void keep_values(const InstancePacket& those, const MlStep& step, const float* values) {
  float* outputs[kBatchLanes];
  for (uint32_t k = 0; k < those.count; ++k) outputs[k] = those.instances[k]->ml_values.data;
  those.rig.kernels->scatter_lanes(values, step.output_count, those.count, outputs,
                                   step.first_output);
}

/// Runs a network step for the instances whose mask is above 0.
void run_networks(const InstancePacket& packet, const MlStep& step, const float* masks) {
  Instance* running[kBatchLanes];
  InstancePacket those = packet;
  those.instances = running;
  those.count = 0;
  for (uint32_t i = 0; i < packet.count; ++i) {
    if (masks[i] > 0.0f) running[those.count++] = packet.instances[i];
  }
  if (fills_lanes(those)) return keep_values(those, step, run_layers(those, step, nullptr));
  for (uint32_t i = 0; i < those.count; ++i) run_network(packet.rig, *running[i], step);
}

void add_weighted(const Rig& rig, Instance& instance, const MlStep& step) {
  float* sums = instance.ml_values.data + step.first_output;
  std::fill(sums, sums + step.output_count, 0.0f);
  for (const MlDependency& from :
       rig.ml.dependencies.slice(step.first_dependency, step.dependency_count)) {
    for (uint32_t i = 0; i < step.output_count; ++i) {
      const float value = from.gathers ? instance.controls[rig.ml.controls[from.first + i]]
                                       : instance.ml_values[from.first + i];
      sums[i] = saturated(sums[i] + saturated(from.weight * value));
    }
  }
}

/// Whether controls are consecutive, as those of most networks are.
bool are_neighbors(const uint16_t* controls, uint32_t count) {
  uint32_t elsewhere = 0;
  for (uint32_t i = 1; i < count; ++i) elsewhere |= controls[i] - controls[0] - i;
  return elsewhere == 0;
}

// Between 0 and 1 a mask blends with the default: 0, or 1 for the w of a quaternion. In the buffer,
// for later steps, the default is 0.
void scatter(const Rig& rig, Instance& instance, const MlStep& step, uint32_t lod, float mask) {
  const MlTable& ml = rig.ml;
  const float* values = instance.ml_values.data + step.first_output;
  const uint32_t count = scatter_count(rig, step, lod);
  const uint16_t* const to = ml.controls.data + step.first_scatter;
  float* const controls = instance.controls.data;
  if (mask == 1.0f) {
    if (count != 0 && are_neighbors(to, count)) {
      std::copy(values, values + count, controls + to[0]);
    } else {
      for (uint32_t i = 0; i < count; ++i) controls[to[i]] = values[i];
    }
    return;
  }
  for (uint32_t i = 0; i < count; ++i) {
    const float rest = ml.default_is_one[to[i]] ? 1.0f : 0.0f;
    controls[to[i]] = rest + mask * (values[i] - rest);
  }
}

// ML joints may come in axes and angles of their own. Scales have no direction, only a magnitude.
void convert_triple(const Rig& rig, Instance& instance, const uint16_t controls[3], bool scale) {
  const CoordinateChange& change = rig.ml.change;
  float v[3] = {};
  for (int i = 0; i < 3; ++i)
    v[i] = controls[i] == kNoControl ? 0.0f : instance.controls[controls[i]];
  for (int i = 0; i < 3; ++i) {
    if (controls[i] == kNoControl) continue;
    const float value = v[change.from[i]];
    instance.controls[controls[i]] = !scale                   ? value * change.normal[i]
                                     : rig.ml.scale_magnitude ? std::fabs(value)
                                                              : value;
  }
}

void convert_rotation(const Rig& rig, Instance& instance, uint16_t base) {
  const MlTable& ml = rig.ml;
  float* x = instance.controls.data + base;
  if (ml.quaternion_rotations) {
    const Quaternion q = normalized({x[0], x[1], x[2], x[3]});
    const float v[3] = {q.x, q.y, q.z};
    for (int i = 0; i < 3; ++i) x[i] = v[ml.change.from[i]] * ml.change.turn[i];
    x[3] = q.w;
    return;
  }
  const float angles[3] = {x[0], x[1], x[2]};
  if (ml.change.carries_angles) {  // so that sums of angles stay sums
    for (int i = 0; i < 3; ++i) {
      x[i] = angles[ml.change.from[i]] * static_cast<float>(ml.change.angle[i]);
    }
    return;
  }
  alignas(kBlockAlignment) float rows[4 * kBlockLanes] = {};
  for (int i = 0; i < 3; ++i) rows[i * kBlockLanes] = angles[i];
  rig.kernels->quaternions_from_angles({euler_form(ml.rotation), rows, rows, 1});
  const float v[3] = {rows[0], rows[kBlockLanes], rows[2 * kBlockLanes]};
  for (int i = 0; i < 3; ++i) rows[i * kBlockLanes] = v[ml.change.from[i]] * ml.change.turn[i];
  rig.kernels->angles_from_quaternions({euler_form(rig.rotation), rows, rows, 1});
  for (int i = 0; i < 3; ++i) x[i] = rows[i * kBlockLanes];
}

void clear_joint_controls(const Rig& rig, Instance& instance) {
  const auto clear = [&](uint32_t control) {
    if (control < rig.raw_count || control >= rig.control_count) return;  // of others
    instance.controls[control] = rig.initial_controls[control];
  };
  for (const MlJoint& joint : rig.ml.joints) {
    for (const uint16_t control : joint.translation) clear(control);
    for (const uint16_t control : joint.scale) clear(control);
    if (joint.rotation_control == kNoControl) continue;
    const uint32_t parts = rig.ml.quaternion_rotations ? 4 : 3;
    for (uint32_t i = 0; i < parts; ++i) clear(joint.rotation_control + i);
  }
}

}  // namespace

namespace {

/// The controls that steps read, in lanes; null if lanes do not pay, or if steps read what others write.
const float* controls_in_lanes(const InstancePacket& packet) {
  const Rig& rig = packet.rig;
  if (!fills_lanes(packet) || (rig.feedback_stages & kStageMl) != 0) return nullptr;
  uint32_t end = 0;
  for (const MlStep& step : rig.ml.steps) {
    for (const uint16_t control : rig.ml.controls.slice(step.first_gather, step.gather_count)) {
      end = std::max<uint32_t>(end, control + 1u);
    }
  }
  gather_controls(packet, 0, end);
  return packet.scratch->controls.data;
}

/// Runs a network step that all instances run in full, and whose outputs are neighboring controls, without
/// leaving the lanes. Returns false if it is not such a step.
bool run_in_lanes(const InstancePacket& packet, const MlStep& step, const float* masks,
                  const float* controls) {
  const Rig& rig = packet.rig;
  if (!controls) return false;
  float* to[kBatchLanes];
  for (uint32_t i = 0; i < packet.count; ++i) {
    if (masks[i] != 1.0f) return false;
    to[i] = packet.instances[i]->controls.data;
  }
  const uint32_t count = scatter_count(rig, step, packet.lod);
  const uint16_t* const targets = rig.ml.controls.data + step.first_scatter;
  if (!are_neighbors(targets, count)) return false;
  const float* const values = run_layers(packet, step, controls);
  if (!rig.ml.dependencies.empty()) keep_values(packet, step, values);
  if (count != 0) rig.kernels->scatter_lanes(values, count, packet.count, to, targets[0]);
  return true;
}

}  // namespace

void evaluate_ml(const InstancePacket& packet) {
  const Rig& rig = packet.rig;
  // Otherwise results converted in the last frame that no network writes in this one would be converted
  // again.
  for (uint32_t i = 0; i < packet.count && rig.ml.converts; ++i) {
    clear_joint_controls(rig, *packet.instances[i]);
  }
  const float* const controls = controls_in_lanes(packet);
  for (const MlStep& step : rig.ml.steps) {
    if (!is_active(step.lods, packet.lod)) continue;
    if (step.layer_count == 0) {
      for (uint32_t i = 0; i < packet.count; ++i) add_weighted(rig, *packet.instances[i], step);
      continue;
    }
    float masks[kBatchLanes];
    for (uint32_t i = 0; i < packet.count; ++i) {
      masks[i] = mask_of(rig, *packet.instances[i], step);
    }
    if (run_in_lanes(packet, step, masks, controls)) continue;
    run_networks(packet, step, masks);
    for (uint32_t i = 0; i < packet.count; ++i) {
      Instance& instance = *packet.instances[i];
      float* values = instance.ml_values.data + step.first_output;
      if (!(masks[i] > 0.0f)) std::fill(values, values + step.output_count, 0.0f);
      scatter(rig, instance, step, packet.lod, masks[i]);
      if (masks[i] > 0.0f && masks[i] < 1.0f) {
        for (uint32_t k = 0; k < step.output_count; ++k) values[k] *= masks[i];
      }
    }
  }
  for (uint32_t i = 0; i < packet.count && rig.ml.converts; ++i) {
    Instance& instance = *packet.instances[i];
    for (const MlJoint& joint : rig.ml.joints) {
      convert_triple(rig, instance, joint.translation, false);
      convert_triple(rig, instance, joint.scale, true);
      if (joint.rotation_control != kNoControl)
        convert_rotation(rig, instance, joint.rotation_control);
    }
  }
}

}  // namespace mien
