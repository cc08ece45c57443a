// SPDX-License-Identifier: MIT
#include "runtime/eval/instance.h"

#include <algorithm>

#include "simd/lanes.h"

namespace mien {
namespace {

void place_changes(const Rig& rig, Placer& placer, Instance& instance) {
  const Span<Changes> placed = placer.array<Changes>(1);
  Changes measured = {};
  Changes& changes = placer.measuring() ? measured : placed[0];
  if (!placer.measuring()) instance.changes = &changes;
  const size_t words = bit_words(rig.control_count);
  for (Span<uint64_t>* set : {&changes.psds, &changes.joints, &changes.channels, &changes.maps}) {
    *set = placer.array<uint64_t>(words);
  }
  const size_t block_rows = rig.joints.panels[rig.joints.panel_count()].first_block_row;
  changes.sums = placer.array<float>(block_rows * kJointBlockRows, kBlockAlignment);
  changes.summed = placer.array<float>(rig.control_count, kBlockAlignment);
  changes.entries = placer.array<uint64_t>(bit_words(rig.psds.outputs.count));
  changes.listed = placer.array<uint16_t>(rig.psds.outputs.count / 4 + 1);
  changes.map_outputs = placer.array<uint64_t>(bit_words(rig.map_count));
  changes.runs = placer.array<uint64_t>(rig.changes->runs.word_count);
  changes.turned = placer.array<uint64_t>(rig.quaternion_outputs ? bit_words(rig.joint_count) : 0);
}

void place_instance(const Rig& rig, Placer& placer, Instance& instance) {
  instance.controls = placer.array<float>(rig.control_count, kBlockAlignment);
  instance.gui = placer.array<float>(rig.gui_count, kBlockAlignment);
  instance.masks = placer.array<float>(rig.mask_count, kBlockAlignment);
  instance.joints_and_angles = placer.array<float>(joints_and_angles_count(rig), kBlockAlignment);
  instance.joints = instance.joints_and_angles.first(rig.joint_value_count());
  instance.channels = placer.array<float>(rig.channel_count, kBlockAlignment);
  instance.maps = placer.array<float>(rig.map_count, kBlockAlignment);
  instance.previous_raw = placer.array<float>(rig.raw_count, kBlockAlignment);
  instance.previous_masks = placer.array<float>(rig.mask_count, kBlockAlignment);
  const ControlRange &ml = rig.ml_writes, &rbf = rig.rbf_writes;
  instance.before_writing =
      placer.array<float>(std::max(ml.end - ml.first, rbf.end - rbf.first), kBlockAlignment);
  const size_t blocks = std::max(rig.rotations.block_count(), rig.twist_swing.block_count());
  instance.rotations = placer.array<float>(blocks * 4 * kBlockLanes, kBlockAlignment);
  instance.ml_values = placer.array<float>(rig.ml.buffer_size, kBlockAlignment);
  for (Span<float>& layer : instance.ml_layers) {
    layer = placer.array<float>(align_up(rig.ml.widest_layer, kBlockLanes), kBlockAlignment);
  }
  instance.rbf_inputs = placer.array<float>(rig.rbf.inputs.count, kBlockAlignment);
  instance.rbf_rotations = placer.array<float>(rig.rbf.rotations.count, kBlockAlignment);
  instance.rbf_weights = placer.array<float>(rig.rbf.pose_scales.count, kBlockAlignment);
  instance.rbf_results = placer.array<float>(rig.rbf.pose_scales.count, kBlockAlignment);
  if (rig.changes) place_changes(rig, placer, instance);
}

void fill(const Span<float>& values, float value) {
  std::fill(values.begin(), values.end(), value);
}

}  // namespace

size_t instance_size(const Rig& rig) {
  return block_bytes<Instance>(
      [&](Placer& placer, Instance& instance) { place_instance(rig, placer, instance); });
}

Instance* create_instance(const Rig& rig, const Allocator& allocator) {
  auto* const instance = create_object<Instance>(
      allocator, [&](Placer& placer, Instance& placed) { place_instance(rig, placer, placed); });
  if (!instance) return nullptr;
  instance->rig = share(rig);
  reset_instance(*instance);
  return instance;
}

void clear_results(Instance& instance) {
  const Rig& rig = *instance.rig;
  instance.stale = kAllUses;
  if (instance.changes) instance.changes->all = kStagesAll;
  fill(instance.joints_and_angles, 0.0f);
  if (rig.quaternion_outputs) {
    for (uint32_t j = 0; j < rig.joint_count; ++j) {
      instance.joints[size_t{j} * rig.joint_attributes + 6] = 1.0f;  // w
    }
  }
  fill(instance.channels, 0.0f);
  fill(instance.maps, 0.0f);
  fill(instance.ml_values, 0.0f);
}

void reset_instance(Instance& instance) {
  const Rig& rig = *instance.rig;
  std::copy(rig.initial_controls.begin(), rig.initial_controls.end(), instance.controls.begin());
  fill(instance.gui, 0.0f);
  fill(instance.masks, 1.0f);
  clear_results(instance);
  instance.lod = 0;
}

}  // namespace mien
