// SPDX-License-Identifier: MIT
// mien/deform.h, except mien_deformer_create().
#include "runtime/deform/deform.h"

#include "capi/handles.h"
#include "simd/kernels.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_NORMALS_RECOMPUTED == int(Normals::kRecomputed) &&
                  MIEN_NORMALS_SKINNED == int(Normals::kSkinned) &&
                  MIEN_COMPOSE_EULER_ADD == int(Compose::kEulerAdd) &&
                  MIEN_VERTEX_FORMAT_SNORM16X4 == int(VertexFormat::kSnorm16x4) &&
                  MIEN_VERTEX_FORMAT_SNORM10_10_10_2 == int(VertexFormat::kSnorm10_10_10_2),
              "mien.h numbers these as the runtime does");

// Deformer ----------------------------------------------------------------------------------------

MienStatus mien_deformer_create_subset(const MienDeformer* deformer, uint32_t mesh,
                                       const uint32_t* positions, size_t position_count,
                                       const MienAllocator* allocator, MienDeformer** out_deformer,
                                       MienError* error) {
  if (MienStatus status = clear_output(out_deformer, error)) return status;
  if (MienStatus status = check(deformer, "deformer", error)) return status;
  const Deformer& whole = *object(deformer);
  if (mesh >= whole.meshes.count) {
    return give_error(error, MIEN_ERROR_INDEX, "mesh is %u, the deformer has %zu", mesh,
                      whole.meshes.count);
  }
  if (!positions && position_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "positions is NULL");
  }
  for (size_t i = 0; i < position_count; ++i) {
    if (positions[i] >= whole.meshes[mesh].position_count) {
      return give_error(error, MIEN_ERROR_INDEX, "positions[%zu] is %u, the mesh has %u", i,
                        positions[i], whole.meshes[mesh].position_count);
    }
    if (i != 0 && positions[i] <= positions[i - 1]) {
      return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                        "positions is not ascending at %zu: sort it, each position once", i);
    }
  }
  Allocator memory;
  if (MienStatus status = read_allocator(allocator, memory, error)) return status;
  Deformer* made = create_subset(whole, mesh, {positions, position_count}, memory);
  if (!made) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a deformer of %zu positions",
                      position_count);
  }
  *out_deformer = reinterpret_cast<MienDeformer*>(made);
  return succeed(error);
}

void mien_deformer_destroy(MienDeformer* deformer) { destroy(deformer); }

MienStatus mien_deformer_info(const MienDeformer* deformer, MienDeformerInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(deformer)) return status;
  const Deformer& of = *object(deformer);
  MienDeformerInfo info = {};
  info.isa = static_cast<uint32_t>(of.kernels->isa);
  info.compose = static_cast<uint32_t>(of.skeleton.compose);
  info.weights = of.fix_weights ? MIEN_WEIGHTS_FIX : MIEN_WEIGHTS_AS_STORED;
  info.normals = static_cast<uint32_t>(of.normals);
  info.lod_count = of.rig->lod_count;
  info.joint_count = of.skeleton.joint_count;
  info.channel_count = of.rig->channel_count;
  info.mesh_count = static_cast<uint32_t>(of.meshes.count);
  info.deformer_bytes = of.block_size + of.baked_size;
  info.instance_bytes = deformer_instance_size(of, 0);
  info.storage = of.half_storage ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_deformer_mesh(const MienDeformer* deformer, uint32_t mesh, MienMesh* out_mesh) {
  if (MienStatus status = clear_struct(out_mesh)) return status;
  if (MienStatus status = check(deformer)) return status;
  if (mesh >= object(deformer)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& shape = object(deformer)->meshes[mesh];
  MienMesh told = {};
  told.position_count = shape.position_count;
  told.vertex_count = shape.vertex_count;
  told.triangle_count = shape.triangle_count;
  told.max_influences = shape.max_influences;
  told.target_count = shape.target_count;
  told.delta_count = static_cast<uint32_t>(shape.delta_count);
  told.lods = shape.lods;
  told.positions = {shape.positions.data, size_t{shape.position_count} * 3};
  told.normals = {shape.normals.data, size_t{shape.vertex_count} * 3};
  told.tangents = view_of(shape.tangents);
  if (shape.fixed_coordinates.empty()) {
    told.texture_coordinates = view_of(shape.texture_coordinates);
  }
  told.vertex_position_indices = view_of(shape.vertex_position_indices);
  told.triangles = view_of(shape.triangles);
  told.target_channels = view_of(shape.target_channels);
  write_struct(out_mesh, told);
  return MIEN_OK;
}

MienStatus mien_deformer_influences(const MienDeformer* deformer, uint32_t mesh, uint32_t position,
                                    MienIndex16View* out_joints, MienFloatView* out_weights) {
  if (out_joints) *out_joints = {nullptr, 0};
  if (out_weights) *out_weights = {nullptr, 0};
  if (!out_joints || !out_weights) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(deformer)) return status;
  if (mesh >= object(deformer)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& shape = object(deformer)->meshes[mesh];
  if (position >= shape.position_count) return MIEN_ERROR_INDEX;
  if (!shape.fixed_weights.empty()) return MIEN_ERROR_UNSUPPORTED;
  Span<const uint16_t> joints;
  Span<const float> weights;
  find_influences(shape, position, joints, weights);
  *out_joints = view_of(joints);
  *out_weights = view_of(weights);
  return MIEN_OK;
}

MienStatus mien_deformer_triangles(const MienDeformer* deformer, uint32_t mesh,
                                   uint32_t* out_triangles, size_t count) {
  if (MienStatus status = check(deformer)) return status;
  if (mesh >= object(deformer)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& shape = object(deformer)->meshes[mesh];
  if (count < size_t{3} * shape.triangle_count) return MIEN_ERROR_INVALID_ARGUMENT;
  if (shape.triangle_count == 0) return MIEN_OK;
  if (!out_triangles) return MIEN_ERROR_NULL_ARGUMENT;
  const bool written = write_triangles(shape, object(deformer)->allocator, out_triangles);
  return written ? MIEN_OK : MIEN_ERROR_MEMORY;
}

MienStatus mien_deformer_texture_coordinates(const MienDeformer* deformer, uint32_t mesh,
                                             float* out_coordinates, size_t count) {
  if (MienStatus status = check(deformer)) return status;
  if (mesh >= object(deformer)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& shape = object(deformer)->meshes[mesh];
  if (count < size_t{2} * shape.vertex_count) return MIEN_ERROR_INVALID_ARGUMENT;
  if (shape.vertex_count == 0) return MIEN_OK;
  if (!out_coordinates) return MIEN_ERROR_NULL_ARGUMENT;
  write_texture_coordinates(shape, out_coordinates);
  return MIEN_OK;
}

MienStatus mien_deformer_target(const MienDeformer* deformer, uint32_t mesh, uint32_t target,
                                float* out_deltas, size_t count) {
  if (MienStatus status = check(deformer)) return status;
  if (mesh >= object(deformer)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& shape = object(deformer)->meshes[mesh];
  if (target >= shape.target_count) return MIEN_ERROR_INDEX;
  if (!out_deltas) return MIEN_ERROR_NULL_ARGUMENT;
  if (count < size_t{shape.position_count} * 3) return MIEN_ERROR_INVALID_ARGUMENT;
  write_target(shape, target, out_deltas);
  return MIEN_OK;
}

MienStatus mien_deformer_bind_matrices(const MienDeformer* deformer, MienFloatView* out_matrices) {
  if (!out_matrices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_matrices = {nullptr, 0};
  if (MienStatus status = check(deformer)) return status;
  *out_matrices = view_of(object(deformer)->skeleton.bind);
  return MIEN_OK;
}

MienStatus mien_deformer_inverse_bind_matrices(const MienDeformer* deformer,
                                               MienFloatView* out_matrices) {
  if (!out_matrices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_matrices = {nullptr, 0};
  if (MienStatus status = check(deformer)) return status;
  *out_matrices = view_of(object(deformer)->skeleton.inverse_bind);
  return MIEN_OK;
}

// Deformer instance -------------------------------------------------------------------------------

MienStatus mien_deformer_instance_create(const MienDeformer* deformer,
                                         const MienDeformerInstanceDesc* desc,
                                         MienDeformerInstance** out_deformer_instance,
                                         MienError* error) {
  if (MienStatus status = clear_output(out_deformer_instance, error)) return status;
  if (MienStatus status = check(deformer, "deformer", error)) return status;
  MienDeformerInstanceDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDeformerInstanceDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  DeformerInstance* instance = create_deformer_instance(*object(deformer), known.lods, allocator);
  if (!instance) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a deformer instance of %zu bytes",
                      deformer_instance_size(*object(deformer), known.lods));
  }
  *out_deformer_instance = reinterpret_cast<MienDeformerInstance*>(instance);
  return succeed(error);
}

void mien_deformer_instance_destroy(MienDeformerInstance* deformer_instance) {
  destroy(deformer_instance);
}

MienStatus mien_deformer_instance_update(MienDeformerInstance* deformer_instance,
                                         const MienInstance* instance) {
  if (MienStatus status = check(deformer_instance)) return status;
  if (MienStatus status = check(instance)) return status;
  const Instance& evaluated = *object(instance);
  if (evaluated.rig != object(deformer_instance)->deformer->rig) return MIEN_ERROR_MISMATCH;
  update_deformer_instance(*object(deformer_instance), evaluated.joints.data,
                           evaluated.channels.data);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_update_from_values(MienDeformerInstance* deformer_instance,
                                                     const float* joint_values,
                                                     size_t joint_value_count,
                                                     const float* channel_weights,
                                                     size_t channel_weight_count) {
  if (MienStatus status = check(deformer_instance)) return status;
  DeformerInstance& instance = *object(deformer_instance);
  if (joint_value_count != (joint_values ? instance.deformer->skeleton.value_count() : 0) ||
      channel_weight_count != (channel_weights ? instance.channels.count : 0)) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  update_deformer_instance(instance, joint_values, channel_weights);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_joint_matrices(const MienDeformerInstance* deformer_instance,
                                                 MienFloatView* out_matrices) {
  if (!out_matrices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_matrices = {nullptr, 0};
  if (MienStatus status = check(deformer_instance)) return status;
  *out_matrices = view_of(object(deformer_instance)->joints.model);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_skin_matrices(const MienDeformerInstance* deformer_instance,
                                                MienFloatView* out_matrices) {
  if (!out_matrices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_matrices = {nullptr, 0};
  if (MienStatus status = check(deformer_instance)) return status;
  *out_matrices = view_of(object(deformer_instance)->joints.skin);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_local_transforms(const MienDeformerInstance* deformer_instance,
                                                   float* out_transforms, size_t count) {
  if (MienStatus status = check(deformer_instance)) return status;
  if (!out_transforms) return MIEN_ERROR_NULL_ARGUMENT;
  const Skeleton& skeleton = object(deformer_instance)->deformer->skeleton;
  if (count < skeleton.joint_count * kLocalTransformFloats) return MIEN_ERROR_INVALID_ARGUMENT;
  write_local_transforms(skeleton, object(deformer_instance)->joints, out_transforms);
  return MIEN_OK;
}

namespace {

using Handles = MienDeformerInstance* const*;

/// Checks a batch: all instances are distinct handles of one deformer, with memory for the mesh. Fills `out`;
/// `normals` is not kDefault then.
struct DeformBatch {
  const Deformer* deformer;
  Span<DeformerInstance* const> instances;
  Normals normals;
  ParallelFor parallel;
};
MienStatus read_batch(Handles handles, size_t count, uint32_t mesh, uint32_t normals,
                      const MienParallelFor* parallel, DeformBatch& out) {
  if (!handles) return MIEN_ERROR_NULL_ARGUMENT;
  for (size_t i = 0; i < count; ++i) {
    if (MienStatus status = check(handles[i])) return status;
  }
  const Deformer& deformer = *object(handles[0])->deformer;
  if (normals > MIEN_NORMALS_RECOMPUTED) return MIEN_ERROR_INVALID_ARGUMENT;
  if (parallel && !parallel->run) return MIEN_ERROR_INVALID_ARGUMENT;
  if (mesh >= deformer.meshes.count) return MIEN_ERROR_INDEX;
  MienStatus status = MIEN_OK;
  size_t marked = 0;
  for (; marked < count && status == MIEN_OK; ++marked) {
    DeformerInstance& instance = *object(handles[marked]);
    if (instance.deformer != &deformer) {
      status = MIEN_ERROR_MISMATCH;
    } else if (!instance.meshes[mesh].present) {
      status = MIEN_ERROR_LOD;
    } else if (instance.in_batch) {
      status = MIEN_ERROR_INVALID_ARGUMENT;
    } else {
      instance.in_batch = true;
    }
  }
  for (size_t i = 0; i < marked; ++i) object(handles[i])->in_batch = false;
  out.deformer = &deformer;
  out.instances = {reinterpret_cast<DeformerInstance* const*>(handles), count};
  out.normals = normals == MIEN_NORMALS_DEFAULT ? deformer.normals : static_cast<Normals>(normals);
  if (parallel) out.parallel = {parallel->user, parallel->run};
  return status;
}

VertexStream stream_of(const MienVertexStream& stream) {
  return {static_cast<uint8_t*>(stream.data), stream.stride,
          static_cast<VertexFormat>(stream.format)};
}

/// Checks the outputs of a batch and stores them in its instances.
MienStatus read_outputs(const DeformBatch& batch, uint32_t mesh, const MienVertexOutput* outputs) {
  if (!outputs) return MIEN_ERROR_NULL_ARGUMENT;
  const uint32_t vertex_count = batch.deformer->meshes[mesh].vertex_count;
  const size_t struct_size = outputs->struct_size;
  if (struct_size % alignof(MienVertexOutput) != 0) return MIEN_ERROR_STRUCT_SIZE;
  for (size_t i = 0; i < batch.instances.count; ++i) {
    const void* at = reinterpret_cast<const uint8_t*>(outputs) + i * struct_size;
    const MienVertexOutput* given = static_cast<const MienVertexOutput*>(at);
    MienVertexOutput known;
    if (MienStatus status = read_struct(given, known)) return status;
    if (known.struct_size != struct_size) return MIEN_ERROR_STRUCT_SIZE;
    VertexOutput& output = batch.instances[i]->output;
    output = {stream_of(known.positions), stream_of(known.normals), stream_of(known.tangents)};
    if (known.vertex_capacity < vertex_count || !is_valid(output, vertex_count) ||
        (output.tangents.data && !batch.deformer->has_tangents)) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
  }
  return outputs_overlap(batch.instances, vertex_count) ? MIEN_ERROR_INVALID_ARGUMENT : MIEN_OK;
}

}  // namespace

MienStatus mien_deformer_instance_deform(MienDeformerInstance* deformer_instance, uint32_t mesh,
                                         uint32_t normals, const MienParallelFor* parallel) {
  return mien_deformer_instance_deform_batch(&deformer_instance, 1, mesh, normals, parallel);
}

MienStatus mien_deformer_instance_deform_batch(Handles deformer_instances, size_t count,
                                               uint32_t mesh, uint32_t normals,
                                               const MienParallelFor* parallel) {
  if (count == 0) return MIEN_OK;
  DeformBatch batch;
  if (MienStatus status = read_batch(deformer_instances, count, mesh, normals, parallel, batch))
    return status;
  deform(*batch.deformer, batch.instances, mesh, batch.normals, batch.parallel);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_write_vertices(MienDeformerInstance* deformer_instance,
                                                 uint32_t mesh, uint32_t normals,
                                                 const MienVertexOutput* output,
                                                 const MienParallelFor* parallel) {
  return mien_deformer_instance_write_vertices_batch(&deformer_instance, 1, mesh, normals, output,
                                                     parallel);
}

MienStatus mien_deformer_instance_write_vertices_batch(Handles deformer_instances, size_t count,
                                                       uint32_t mesh, uint32_t normals,
                                                       const MienVertexOutput* outputs,
                                                       const MienParallelFor* parallel) {
  if (count == 0) return MIEN_OK;
  DeformBatch batch;
  if (MienStatus status = read_batch(deformer_instances, count, mesh, normals, parallel, batch))
    return status;
  if (MienStatus status = read_outputs(batch, mesh, outputs)) return status;
  write_vertices(*batch.deformer, batch.instances, mesh, batch.normals, batch.parallel);
  return MIEN_OK;
}

namespace {

template <class Count>
MienStatus view_mesh(const MienDeformerInstance* handle, uint32_t m, MienFloatView* out,
                     Count&& count, Span<float> DeformedMesh::*values) {
  if (!out) return MIEN_ERROR_NULL_ARGUMENT;
  *out = {nullptr, 0};
  if (MienStatus status = check(handle)) return status;
  const DeformerInstance& instance = *object(handle);
  if (m >= instance.meshes.count) return MIEN_ERROR_INDEX;
  if (!instance.meshes[m].present) return MIEN_ERROR_LOD;
  *out = {(instance.meshes[m].*values).data, size_t{count(instance.deformer->meshes[m])} * 3};
  return MIEN_OK;
}

}  // namespace

MienStatus mien_deformer_instance_positions(const MienDeformerInstance* deformer_instance,
                                            uint32_t mesh, MienFloatView* out_positions) {
  return view_mesh(
      deformer_instance, mesh, out_positions, [](const DeformMesh& m) { return m.position_count; },
      &DeformedMesh::positions);
}

MienStatus mien_deformer_instance_normals(const MienDeformerInstance* deformer_instance,
                                          uint32_t mesh, MienFloatView* out_normals) {
  return view_mesh(
      deformer_instance, mesh, out_normals, [](const DeformMesh& m) { return m.vertex_count; },
      &DeformedMesh::normals);
}
