// SPDX-License-Identifier: MIT
// One character as deformed: joint matrices, channel weights, and the positions and normals of its
// meshes, in one block of memory.
//
//     | Pose | joints | channel weights | meshes | positions and normals of mesh 0 | mesh 1 ... |
//     areas |
#pragma once

#include "runtime/deform/deformer.h"
#include "runtime/pose/joint_pose.h"

namespace mien {

struct DeformedMesh {
  bool present = false;
  Span<float> positions;  // [position] x y z, and one float more
  Span<float> normals;    // [vertex] x y z, and one float more
};

struct DeformerInstance {
  uint32_t tag = 0;  // first, for the C API to recognize its handles
  bool in_batch = false;
  Allocator allocator;
  size_t block_size = 0;
  const Deformer* deformer = nullptr;

  JointPose joints;
  Span<float> channels;
  Span<DeformedMesh> meshes;
  Span<float> areas;  // scratch: area vectors of the faces of the largest mesh, x y z and one more
};

/// Bytes of a pose with room for the meshes of `lods` (bits; 0: of all meshes).
size_t deformer_instance_size(const Deformer& deformer, uint64_t lods);

/// In neutral. Becomes an owner of the deformer. Null if memory ran out.
DeformerInstance* create_deformer_instance(const Deformer& deformer, uint64_t lods,
                                           const Allocator& allocator);
void destroy_deformer_instance(DeformerInstance* pose);

/// Null: no deltas, no weights.
void update_deformer_instance(DeformerInstance& pose, const float* joint_values,
                              const float* channel_weights);

}  // namespace mien
