// SPDX-License-Identifier: MIT
#include "runtime/load/dna/format/pose_controls.h"

namespace mien::dna {

bool synthesize_pose_controls(DnaView& view, Arena& arena) {
  const List<RbfPose>& poses = view.rbfb.poses;
  RbfBehaviorExtension& rbfe = view.rbfe;
  if (rbfe.poses.count != 0 || poses.count == 0) return true;
  Span<String> names = arena.array<String>(poses.count);
  Span<RbfPoseControls> controls = arena.array<RbfPoseControls>(poses.count);
  NewArray<uint16_t> outputs = new_array<uint16_t>(arena, poses.count);
  NewArray<float> weights = new_array<float>(arena, poses.count);
  if (!names.data || !controls.data || !outputs.data || !weights.data) return false;
  const uint32_t first = view.first_ml() + view.ml_control_count;
  for (uint32_t i = 0; i < poses.count; ++i) {
    names[i] = poses[i].name;
    outputs.set(i, static_cast<uint16_t>(first + i));
    weights.set(i, 1.0f);
    controls[i].output_control_indices = {outputs.data + i * sizeof(uint16_t), 1};
    controls[i].output_control_weights = {weights.data + i * sizeof(float), 1};
  }
  rbfe.pose_control_names = {names.data, poses.count};
  rbfe.poses = {controls.data, poses.count};
  return true;
}

}  // namespace mien::dna
