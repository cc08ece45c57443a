// SPDX-License-Identifier: MIT
// One character in one pose: its joint matrices, its channel weights, and the deformed positions and
// normals of its meshes. One block of memory.
//
//     | DeformerInstance | joints | channels | DeformedMesh 0 ... n-1
//     | positions, normals of mesh 0 | positions, normals of mesh 1 | ... | face areas | tangents
#pragma once

#include "runtime/deform/deformer.h"
#include "runtime/deform/vertex_output.h"
#include "runtime/pose/joint_pose.h"

namespace mien {

struct DeformedMesh {
  bool present = false;   // the instance has memory for this mesh
  bool empty = false;     // the mesh has no geometry
  Span<float> positions;  // [position] x y z, + 1
  Span<float> normals;    // [vertex] x y z, + 1
};

struct DeformerInstance : Object {
  static constexpr uint32_t kTag = 0x6D50'4F53;

  bool in_batch = false;  // while the arguments of a batch are checked
  const Deformer* deformer = nullptr;
  ~DeformerInstance() { release(deformer); }

  JointPose joints;
  Span<float> channels;  // [channel] weight
  Span<DeformedMesh> meshes;
  Span<float> face_areas;  // scratch, [face] x y z 0, for the largest mesh
  Span<float> tangents;    // scratch, [vertex] x y z w, for the largest mesh
  VertexOutput output;     // of write_vertices()
};

/// Bytes of an instance with memory for the meshes of some LODs: bit l is LOD l; 0 means all meshes.
size_t deformer_instance_size(const Deformer& deformer, uint64_t lods);

/// Creates an instance in the neutral pose. It becomes an owner of the deformer. Null if memory ran out.
DeformerInstance* create_deformer_instance(const Deformer& deformer, uint64_t lods,
                                           const Allocator& allocator);

/// Computes the joint matrices from joint values, and copies the channel weights; both are in the form that
/// evaluation returns. Null joint values: no deltas. Null channel weights: all 0.
void update_deformer_instance(DeformerInstance& instance, const float* joint_values,
                              const float* channel_weights);

}  // namespace mien
