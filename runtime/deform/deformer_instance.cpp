// SPDX-License-Identifier: MIT
#include "runtime/deform/deformer_instance.h"

#include <algorithm>

namespace mien {
namespace {

bool is_shown(const DeformMesh& mesh, uint64_t lods) { return lods == 0 || (mesh.lods & lods); }

void place_deformer_instance(const Deformer& deformer, uint64_t lods, Placer& placer,
                             DeformerInstance& instance) {
  place_joint_pose(deformer.skeleton, placer, instance.joints);
  instance.channels = placer.array<float>(deformer.rig->channel_count, kBlockAlignment);
  instance.meshes = placer.array<DeformedMesh>(deformer.meshes.count);
  size_t max_faces = 0, max_tangents = 0;
  for (size_t m = 0; m < deformer.meshes.count; ++m) {
    const DeformMesh& mesh = deformer.meshes[m];
    if (!is_shown(mesh, lods)) continue;
    DeformedMesh deformed;
    deformed.present = true;
    deformed.empty = mesh.is_empty();
    const size_t alignment = mesh.array_alignment();
    deformed.positions = placer.array<float>(mesh.positions.count, alignment);
    deformed.normals = placer.array<float>(mesh.normals.count, alignment);
    if (!placer.measuring()) instance.meshes[m] = deformed;
    max_faces = std::max(max_faces, size_t{mesh.face_count()});
    max_tangents = std::max(max_tangents, mesh.tangents.count);
  }
  instance.face_areas = placer.array<float>(max_faces * 4, kBlockAlignment);
  instance.tangents = placer.array<float>(max_tangents, kBlockAlignment);
}

}  // namespace

size_t deformer_instance_size(const Deformer& deformer, uint64_t lods) {
  return block_bytes<DeformerInstance>([&](Placer& placer, DeformerInstance& instance) {
    place_deformer_instance(deformer, lods, placer, instance);
  });
}

DeformerInstance* create_deformer_instance(const Deformer& deformer, uint64_t lods,
                                           const Allocator& allocator) {
  auto* const instance =
      create_object<DeformerInstance>(allocator, [&](Placer& placer, DeformerInstance& placed) {
        place_deformer_instance(deformer, lods, placer, placed);
      });
  if (!instance) return nullptr;
  instance->deformer = share(deformer);
  update_deformer_instance(*instance, nullptr, nullptr);
  for (size_t m = 0; m < instance->meshes.count; ++m) {
    DeformedMesh& deformed = instance->meshes[m];
    if (!deformed.present) continue;
    const DeformMesh& mesh = deformer.meshes[m];
    std::copy(mesh.positions.begin(), mesh.positions.end(), deformed.positions.begin());
    std::copy(mesh.normals.begin(), mesh.normals.end(), deformed.normals.begin());
  }
  return instance;
}

void update_deformer_instance(DeformerInstance& instance, const float* joint_values,
                              const float* channel_weights) {
  pose_joints(instance.deformer->skeleton, joint_values, instance.joints);
  if (channel_weights) {
    std::copy(channel_weights, channel_weights + instance.channels.count,
              instance.channels.begin());
  } else {
    std::fill(instance.channels.begin(), instance.channels.end(), 0.0f);
  }
}

}  // namespace mien
