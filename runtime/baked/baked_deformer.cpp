// SPDX-License-Identifier: MIT
// The deformer as a part of a baked file. Joints, channels and meshes are those of the rig, which
// the file holds too.
#include <new>

#include "runtime/baked/baked_objects.h"

namespace mien {
namespace {

/// To be raised whenever the list of numbers or arrays, or the meaning of one, changes.
constexpr uint32_t kDeformerPartVersion = 7;

static_assert(sizeof(SkinRun) == 24 && sizeof(TargetRun) == 16 && sizeof(FixedRun) == 12,
              "no padding");

/// Indices and counts first, which are checked when the deformer is opened; then values, of which
/// any are safe.
template <class AnyDeformer, class Visitor>
void visit_deformer(AnyDeformer& deformer, Visitor& visitor) {
  const auto numbers = [&](auto&... fields) { (visitor.number(fields), ...); };
  const auto arrays = [&](auto&... spans) { (visitor.array(spans), ...); };
  auto& skeleton = deformer.skeleton;
  numbers(skeleton.compose, deformer.normals, deformer.fix_weights, deformer.has_tangents,
          deformer.half_storage);
  arrays(skeleton.order);
  for (auto& mesh : deformer.meshes) {
    numbers(mesh.position_count, mesh.vertex_count, mesh.triangle_count, mesh.max_influences,
            mesh.target_count, mesh.delta_count, mesh.weight_scale, mesh.turned_faces);
    arrays(mesh.vertex_position_indices, mesh.triangles, mesh.corner_vertices, mesh.target_channels,
           mesh.position_indices, mesh.skin_runs, mesh.joints, mesh.first_target_run,
           mesh.target_runs, mesh.fixed_runs, mesh.delta_indices, mesh.faces,
           mesh.first_adjacent_face, mesh.adjacent_faces, mesh.first_vertex, mesh.vertices,
           mesh.hard_positions);
  }
  arrays(skeleton.neutral, skeleton.neutral_angles, skeleton.bind, skeleton.inverse_bind);
  for (auto& mesh : deformer.meshes) {
    arrays(mesh.positions, mesh.normals, mesh.tangents, mesh.texture_coordinates,
           mesh.fixed_coordinates, mesh.sorted_positions, mesh.weights, mesh.fixed_weights,
           mesh.deltas, mesh.fixed_deltas, mesh.sorted_normals, mesh.neutral_directions);
  }
}

}  // namespace

PartMeasure measure_part(const Deformer& deformer) {
  PartMeasure measure;
  visit_deformer(deformer, measure);
  return measure;
}

BakedPart write_part(const Deformer& deformer, uint8_t* bytes) {
  const PartMeasure measure = measure_part(deformer);
  PartWriter writer(measure, bytes);
  visit_deformer(deformer, writer);
  return measure.entry(PartKind::kDeformer, kDeformerPartVersion);
}

Status open_baked_deformer(const Baked& baked, const Rig& rig, const KernelTable* kernels,
                           const Allocator& allocator, Deformer*& out, Error& error) {
  out = nullptr;
  // The tables alone take more for each mesh, so memory is bounded by the file.
  if (rig.mesh_count > baked.deformer->size / sizeof(DeformMesh)) {
    return fail(error, Status::kBakedStructure, baked.deformer->offset,
                "the deformer has fewer meshes than its rig: the baked file is damaged; bake it "
                "again");
  }
  const auto place = [&rig](Placer& placer, Deformer& made) {
    made.meshes = placer.array<DeformMesh>(rig.mesh_count);
  };
  Deformer* deformer = create_object<Deformer>(allocator, place);
  if (!deformer) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for a deformer of %zu bytes",
                block_bytes<Deformer>(place));
  }
  for (DeformMesh& mesh : deformer->meshes) new (&mesh) DeformMesh;
  deformer->rig = share(rig);

  Skeleton& skeleton = deformer->skeleton;
  skeleton.joint_count = rig.joint_count;
  skeleton.joint_attributes = rig.joint_attributes;
  skeleton.rotation = rig.rotation;
  skeleton.parents = rig.joint_parents;
  PartReader reader(baked, *baked.deformer, kDeformerPartVersion, measure_part(*deformer), error);
  visit_deformer(*deformer, reader);
  Status status = reader.finish();
  if (status == Status::kOk) {
    status = check_deformer(*deformer, baked.check == BakedCheck::kFull, error);
  }
  if (status != Status::kOk) {
    release(deformer);
    return status;
  }
  mark_mesh_lods(rig, deformer->meshes);
  deformer->baked_size = static_cast<size_t>(baked.deformer->size);
  deformer->kernels = skeleton.kernels = kernels;
  out = deformer;
  return Status::kOk;
}

}  // namespace mien
