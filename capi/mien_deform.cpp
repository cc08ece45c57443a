// SPDX-License-Identifier: MIT
// Deformers and poses. mien.h is the manual.
#include <algorithm>

#include "capi/handles.h"
#include "runtime/compile/compile_deformer.h"
#include "runtime/deform/deform.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_NORMALS_RECOMPUTED == int(Normals::kRecomputed) &&
                  MIEN_NORMALS_SKINNED == int(Normals::kSkinned) &&
                  MIEN_COMPOSE_EULER_ADD == int(Compose::kEulerAdd),
              "deformer.h, skeleton.h and mien.h number the same things");

namespace {

MienIndex16View view_of(const Span<uint16_t>& span) { return {span.data, span.count}; }
MienIndex32View view_of(const Span<uint32_t>& span) { return {span.data, span.count}; }
MienFloatView view_of(const Span<float>& span) { return {span.data, span.count}; }

/// Joints, channels and meshes of a rig and a DNA: what the two have to have in common.
MienStatus compare_names(const dna::DnaView& view, const Rig& rig, MienError* error) {
  const struct {
    Kind kind;
    const dna::List<dna::String>& names;
    const char* noun;
  } lists[] = {{Kind::kJoint, view.defn.joint_names, "joint"},
               {Kind::kBlendShapeChannel, view.defn.channel_names, "blend shape channel"},
               {Kind::kMesh, view.defn.mesh_names, "mesh"}};
  for (const auto& list : lists) {
    const NameList& own = rig.names[size_t(list.kind)];
    if (own.count() != list.names.count) {
      return give_error(error, MIEN_ERROR_MISMATCH,
                        "the rig was made of another file, or with other LODs: its number of %s "
                        "names is %u, that of the DNA is %u",
                        list.noun, own.count(), list.names.count);
    }
    for (uint32_t i = 0; i < own.count(); ++i) {
      const Span<char> a = own[i];
      const dna::String& b = list.names[i];
      if (a.count == b.count && (a.count == 0 || memcmp(a.data, b.data, a.count) == 0)) continue;
      return give_error(error, MIEN_ERROR_MISMATCH,
                        "the rig was made of another file, or with other LODs: %s %u is %.*s, "
                        "in the DNA it is %.*s",
                        list.noun, i, static_cast<int>(std::min<size_t>(a.count, 40)), a.data,
                        static_cast<int>(std::min<size_t>(b.count, 40)), b.chars());
    }
  }
  return MIEN_OK;
}

}  // namespace

// Deformer ----------------------------------------------------------------------------------------

MienStatus mien_deformer_create(const MienDna* dna, const MienRig* handle,
                                const MienDeformerDesc* desc, MienDeformer** out_deformer,
                                MienError* error) {
  if (MienStatus status = clear_output(out_deformer, error)) return status;
  if (MienStatus status = check(dna)) return give_error(error, status, "not an open DNA");
  if (MienStatus status = check(handle)) return give_error(error, status, "not a rig");
  MienDeformerDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDeformerDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (known.compose > MIEN_COMPOSE_EULER_ADD || known.weights > MIEN_WEIGHTS_FIX ||
      known.normals > MIEN_NORMALS_RECOMPUTED) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienDeformerDesc.compose, .weights or .normals is none of its values");
  }
  const Rig& rig = *object(handle);
  const KernelTable* kernels = rig.kernels;
  if (known.isa != MIEN_ISA_BEST) {
    if (MienStatus status = find_kernels(known.isa, kernels, error)) return status;
  }
  if (known.compose == MIEN_COMPOSE_EULER_ADD && rig.quaternion_outputs) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MIEN_COMPOSE_EULER_ADD needs a rig with MIEN_ROTATION_OUTPUT_EULER");
  }
  if (!dna->view.has(dna::kLayerGeometry)) {
    return give_error(error, MIEN_ERROR_DNA_LAYER,
                      "the DNA was opened without its geometry; open it with MIEN_LAYER_GEOMETRY");
  }
  if (MienStatus status = compare_names(dna->view, rig, error)) return status;

  DeformOptions options;
  options.kernels = kernels;
  options.compose = static_cast<Compose>(known.compose);
  options.fix_weights = known.weights == MIEN_WEIGHTS_FIX;
  if (known.normals != MIEN_NORMALS_DEFAULT) options.normals = static_cast<Normals>(known.normals);
  Deformer* deformer = nullptr;
  Error detail;
  if (compile_deformer(dna->view, rig, options, allocator, deformer, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  deformer->tag = kDeformerTag;
  *out_deformer = reinterpret_cast<MienDeformer*>(deformer);
  return succeed(error);
}

void mien_deformer_destroy(MienDeformer* deformer) {
  if (check(deformer) != MIEN_OK) return;
  object(deformer)->tag = 0;
  release_deformer(object(deformer));
}

MienStatus mien_deformer_info(const MienDeformer* handle, MienDeformerInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(handle)) return status;
  const Deformer& deformer = *object(handle);
  MienDeformerInfo info = {};
  info.isa = static_cast<uint32_t>(deformer.kernels->isa);
  info.compose = static_cast<uint32_t>(deformer.skeleton.compose);
  info.weights = deformer.fix_weights ? MIEN_WEIGHTS_FIX : MIEN_WEIGHTS_AS_STORED;
  info.normals = static_cast<uint32_t>(deformer.normals);
  info.lod_count = deformer.rig->lod_count;
  info.joint_count = deformer.skeleton.joint_count;
  info.channel_count = deformer.rig->channel_count;
  info.mesh_count = static_cast<uint32_t>(deformer.meshes.count);
  info.deformer_bytes = deformer.block_size;
  info.instance_bytes = deformer_instance_size(deformer, 0);
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_deformer_mesh(const MienDeformer* handle, uint32_t m, MienMesh* out_mesh) {
  if (MienStatus status = clear_struct(out_mesh)) return status;
  if (MienStatus status = check(handle)) return status;
  if (m >= object(handle)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& mesh = object(handle)->meshes[m];
  MienMesh told = {};
  told.position_count = mesh.position_count;
  told.vertex_count = mesh.vertex_count;
  told.triangle_count = mesh.triangle_count;
  told.max_influences = mesh.max_influences;
  told.target_count = mesh.target_count;
  told.delta_count = static_cast<uint32_t>(mesh.delta_count);
  told.lods = mesh.lods;
  told.positions = {mesh.positions.data, size_t{mesh.position_count} * 3};
  told.normals = {mesh.normals.data, size_t{mesh.vertex_count} * 3};
  told.texture_coordinates = view_of(mesh.texture_coordinates);
  told.vertex_position_indices = view_of(mesh.vertex_position_indices);
  told.triangles = view_of(mesh.triangles);
  told.target_channels = view_of(mesh.target_channels);
  write_struct(out_mesh, told);
  return MIEN_OK;
}

MienStatus mien_deformer_influences(const MienDeformer* handle, uint32_t m, uint32_t position,
                                    MienIndex16View* out_joints, MienFloatView* out_weights) {
  if (out_joints) *out_joints = {nullptr, 0};
  if (out_weights) *out_weights = {nullptr, 0};
  if (!out_joints || !out_weights) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check(handle)) return status;
  if (m >= object(handle)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& mesh = object(handle)->meshes[m];
  if (position >= mesh.position_count) return MIEN_ERROR_INDEX;
  const uint32_t sorted_index = mesh.sorted_indices[position];
  const SkinRun* run = skin_run_of(mesh, sorted_index);
  const size_t row = run->first_weight + size_t{sorted_index - run->first} * run->influences;
  *out_joints = view_of(mesh.joints.slice(row, run->influences));
  *out_weights = view_of(mesh.weights.slice(row, run->influences));
  return MIEN_OK;
}

MienStatus mien_deformer_target(const MienDeformer* handle, uint32_t m, uint32_t target,
                                float* out_deltas, size_t count) {
  if (MienStatus status = check(handle)) return status;
  if (m >= object(handle)->meshes.count) return MIEN_ERROR_INDEX;
  const DeformMesh& mesh = object(handle)->meshes[m];
  if (target >= mesh.target_count) return MIEN_ERROR_INDEX;
  if (!out_deltas) return MIEN_ERROR_NULL_ARGUMENT;
  if (count < size_t{mesh.position_count} * 3) return MIEN_ERROR_INVALID_ARGUMENT;
  write_target(mesh, target, out_deltas);
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

// Pose --------------------------------------------------------------------------------------------

MienStatus mien_deformer_instance_create(const MienDeformer* deformer,
                                         const MienDeformerInstanceDesc* desc,
                                         MienDeformerInstance** out_pose, MienError* error) {
  if (MienStatus status = clear_output(out_pose, error)) return status;
  if (MienStatus status = check(deformer)) return give_error(error, status, "not a deformer");
  MienDeformerInstanceDesc known;
  if (MienStatus status = read_desc(desc, known, "MienDeformerInstanceDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  DeformerInstance* pose = create_deformer_instance(*object(deformer), known.lods, allocator);
  if (!pose) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a pose of %zu bytes",
                      deformer_instance_size(*object(deformer), known.lods));
  }
  pose->tag = kPoseTag;
  *out_pose = reinterpret_cast<MienDeformerInstance*>(pose);
  return succeed(error);
}

void mien_deformer_instance_destroy(MienDeformerInstance* pose) {
  if (check(pose) == MIEN_OK) destroy_deformer_instance(object(pose));
}

MienStatus mien_deformer_instance_update(MienDeformerInstance* pose, const MienInstance* instance) {
  if (MienStatus status = check(pose)) return status;
  if (MienStatus status = check(instance)) return status;
  const Instance& source = *object(instance);
  if (source.rig != object(pose)->deformer->rig) return MIEN_ERROR_MISMATCH;
  update_deformer_instance(*object(pose), source.joints.data, source.channels.data);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_update_from_values(MienDeformerInstance* handle,
                                                     const float* joint_values,
                                                     size_t joint_value_count,
                                                     const float* channel_weights,
                                                     size_t channel_weight_count) {
  if (MienStatus status = check(handle)) return status;
  DeformerInstance& pose = *object(handle);
  if (joint_value_count != (joint_values ? pose.deformer->skeleton.value_count() : 0) ||
      channel_weight_count != (channel_weights ? pose.channels.count : 0)) {
    return MIEN_ERROR_INVALID_ARGUMENT;
  }
  update_deformer_instance(pose, joint_values, channel_weights);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_joint_matrices(const MienDeformerInstance* pose,
                                                 MienFloatView* out_matrices) {
  if (!out_matrices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_matrices = {nullptr, 0};
  if (MienStatus status = check(pose)) return status;
  *out_matrices = view_of(object(pose)->joints.model);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_skin_matrices(const MienDeformerInstance* pose,
                                                MienFloatView* out_matrices) {
  if (!out_matrices) return MIEN_ERROR_NULL_ARGUMENT;
  *out_matrices = {nullptr, 0};
  if (MienStatus status = check(pose)) return status;
  *out_matrices = view_of(object(pose)->joints.skin);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_local_transforms(const MienDeformerInstance* pose,
                                                   float* out_transforms, size_t count) {
  if (MienStatus status = check(pose)) return status;
  if (!out_transforms) return MIEN_ERROR_NULL_ARGUMENT;
  const Skeleton& skeleton = object(pose)->deformer->skeleton;
  if (count < skeleton.joint_count * kLocalTransformFloats) return MIEN_ERROR_INVALID_ARGUMENT;
  write_local_transforms(skeleton, object(pose)->joints, out_transforms);
  return MIEN_OK;
}

MienStatus mien_deformer_instance_deform(MienDeformerInstance* pose, uint32_t mesh,
                                         uint32_t normals, const MienParallelFor* parallel) {
  return mien_deformer_instance_deform_batch(&pose, 1, mesh, normals, parallel);
}

MienStatus mien_deformer_instance_deform_batch(MienDeformerInstance* const* handles,
                                               size_t pose_count, uint32_t mesh, uint32_t normals,
                                               const MienParallelFor* parallel) {
  if (pose_count == 0) return MIEN_OK;
  if (!handles) return MIEN_ERROR_NULL_ARGUMENT;
  for (size_t i = 0; i < pose_count; ++i) {
    if (MienStatus status = check(handles[i])) return status;
  }
  const Deformer& deformer = *object(handles[0])->deformer;
  if (normals > MIEN_NORMALS_RECOMPUTED) return MIEN_ERROR_INVALID_ARGUMENT;
  if (parallel && !parallel->run) return MIEN_ERROR_INVALID_ARGUMENT;
  if (mesh >= deformer.meshes.count) return MIEN_ERROR_INDEX;
  MienStatus status = MIEN_OK;
  size_t marked = 0;
  for (; marked < pose_count && status == MIEN_OK; ++marked) {
    DeformerInstance& pose = *object(handles[marked]);
    if (pose.deformer != &deformer) {
      status = MIEN_ERROR_MISMATCH;
    } else if (!pose.meshes[mesh].present) {
      status = MIEN_ERROR_LOD;
    } else if (pose.in_batch) {
      status = MIEN_ERROR_INVALID_ARGUMENT;
    } else {
      pose.in_batch = true;
    }
  }
  for (size_t i = 0; i < marked; ++i) object(handles[i])->in_batch = false;
  if (status != MIEN_OK) return status;

  ParallelFor run;
  if (parallel) run = {parallel->user, parallel->run};
  const Normals wanted =
      normals == MIEN_NORMALS_DEFAULT ? deformer.normals : static_cast<Normals>(normals);
  deform(deformer, {reinterpret_cast<DeformerInstance* const*>(handles), pose_count}, mesh, wanted,
         run);
  return MIEN_OK;
}

namespace {

template <class Count>
MienStatus view_mesh(const MienDeformerInstance* handle, uint32_t m, MienFloatView* out,
                     Count&& count, Span<float> DeformedMesh::*values) {
  if (!out) return MIEN_ERROR_NULL_ARGUMENT;
  *out = {nullptr, 0};
  if (MienStatus status = check(handle)) return status;
  const DeformerInstance& pose = *object(handle);
  if (m >= pose.meshes.count) return MIEN_ERROR_INDEX;
  if (!pose.meshes[m].present) return MIEN_ERROR_LOD;
  *out = {(pose.meshes[m].*values).data, size_t{count(pose.deformer->meshes[m])} * 3};
  return MIEN_OK;
}

}  // namespace

MienStatus mien_deformer_instance_positions(const MienDeformerInstance* pose, uint32_t mesh,
                                            MienFloatView* out_positions) {
  return view_mesh(
      pose, mesh, out_positions, [](const DeformMesh& m) { return m.position_count; },
      &DeformedMesh::positions);
}

MienStatus mien_deformer_instance_normals(const MienDeformerInstance* pose, uint32_t mesh,
                                          MienFloatView* out_normals) {
  return view_mesh(
      pose, mesh, out_normals, [](const DeformMesh& m) { return m.vertex_count; },
      &DeformedMesh::normals);
}
