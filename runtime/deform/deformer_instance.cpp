// SPDX-License-Identifier: MIT
#include "runtime/deform/deformer_instance.h"

#include <algorithm>

namespace mien {
namespace {

bool has_room(const DeformMesh& mesh, uint64_t lods) { return lods == 0 || (mesh.lods & lods); }

void place_deformer_instance(const Deformer& deformer, uint64_t lods, Placer& placer,
                             DeformerInstance& pose) {
  placer.array<DeformerInstance>(1);
  place_joint_pose(deformer.skeleton, placer, pose.joints);
  pose.channels = placer.array<float>(deformer.rig->channel_count, kBlockAlignment);
  pose.meshes = placer.array<DeformedMesh>(deformer.meshes.count);
  size_t max_faces = 0;
  for (size_t m = 0; m < deformer.meshes.count; ++m) {
    const DeformMesh& mesh = deformer.meshes[m];
    if (!has_room(mesh, lods)) continue;
    DeformedMesh posed;
    posed.present = true;
    posed.positions = placer.array<float>(mesh.positions.count, kBlockAlignment);
    posed.normals = placer.array<float>(mesh.normals.count, kBlockAlignment);
    if (!placer.measuring()) pose.meshes[m] = posed;
    max_faces = std::max(max_faces, size_t{mesh.face_count()});
  }
  pose.areas = placer.array<float>(max_faces * 4, kBlockAlignment);
}

}  // namespace

size_t deformer_instance_size(const Deformer& deformer, uint64_t lods) {
  DeformerInstance pose;
  Placer placer(nullptr);
  place_deformer_instance(deformer, lods, placer, pose);
  return placer.size();
}

DeformerInstance* create_deformer_instance(const Deformer& deformer, uint64_t lods,
                                           const Allocator& allocator) {
  const size_t size = deformer_instance_size(deformer, lods);
  void* block = allocator.get(size, kBlockAlignment);
  if (!block) return nullptr;
  DeformerInstance placed;
  Placer placer(block);
  place_deformer_instance(deformer, lods, placer, placed);
  DeformerInstance* pose = new (block) DeformerInstance(placed);
  pose->allocator = allocator;
  pose->block_size = size;
  pose->deformer = &deformer;
  deformer.owners.fetch_add(1, std::memory_order_relaxed);
  update_deformer_instance(*pose, nullptr, nullptr);
  for (size_t m = 0; m < pose->meshes.count; ++m) {
    if (!pose->meshes[m].present) continue;
    const DeformMesh& mesh = deformer.meshes[m];
    std::copy(mesh.positions.begin(), mesh.positions.end(), pose->meshes[m].positions.begin());
    std::copy(mesh.normals.begin(), mesh.normals.end(), pose->meshes[m].normals.begin());
  }
  return pose;
}

void destroy_deformer_instance(DeformerInstance* pose) {
  const Deformer* deformer = pose->deformer;
  const Allocator allocator = pose->allocator;
  const size_t size = pose->block_size;
  pose->tag = 0;
  allocator.put(pose, size, kBlockAlignment);
  release_deformer(deformer);
}

void update_deformer_instance(DeformerInstance& pose, const float* joint_values,
                              const float* channel_weights) {
  pose_joints(pose.deformer->skeleton, joint_values, pose.joints);
  if (channel_weights) {
    std::copy(channel_weights, channel_weights + pose.channels.count, pose.channels.begin());
  } else {
    std::fill(pose.channels.begin(), pose.channels.end(), 0.0f);
  }
}

}  // namespace mien
