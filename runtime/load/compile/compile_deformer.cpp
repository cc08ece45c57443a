// SPDX-License-Identifier: MIT
#include "runtime/load/compile/compile_deformer.h"

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

using dna::DnaView;
using dna::Mesh;

const Mesh kNoMesh;
const MeshPlan kNoPlan;

/// Meshes that the geometry lacks are empty.
const Mesh& mesh_at(const DnaView& view, uint32_t m) {
  return m < view.geom.meshes.count ? view.geom.meshes[m] : kNoMesh;
}

/// Index of the first vector that is not finite; kNoItem if all are.
constexpr uint32_t kNoItem = ~uint32_t{0};
uint32_t first_not_finite(const dna::Vec3Array& vectors) {
  for (uint32_t i = 0; i < vectors.xs.count; ++i) {
    if (!std::isfinite(vectors.xs[i]) || !std::isfinite(vectors.ys[i]) ||
        !std::isfinite(vectors.zs[i])) {
      return i;
    }
  }
  return kNoItem;
}

Status plan_mesh(const MeshSource& source, MeshPlan& plan) {
  const uint32_t bad = first_not_finite(source.mesh.positions);
  if (bad != kNoItem) {
    return fail(source.error, Status::kDnaValue,
                source.view.offset_of(source.mesh.positions.xs.data + bad * sizeof(float)),
                "geom.meshes[%u].positions: position %u is not finite", source.index, bad);
  }
  Status status = plan_skin(source, plan);
  if (status == Status::kOk) status = plan_targets(source, plan);
  return status == Status::kOk ? plan_surface(source, plan) : status;
}

void place_mesh(const Mesh& source, const MeshPlan& plan, const DeformOptions& options,
                Placer& placer, DeformMesh& mesh) {
  mesh.position_count = source.positions.xs.count;
  mesh.vertex_count = source.layouts.positions.count;
  mesh.target_count = source.blend_shape_targets.count;
  mesh.triangle_count = static_cast<uint32_t>(plan.triangle_count);
  mesh.max_influences = static_cast<uint16_t>(plan.max_influences);
  mesh.delta_count = plan.delta_count;
  place_skin(plan, options.half_storage, placer, mesh);
  place_targets(plan, placer, mesh);
  place_surface(plan, options, placer, mesh);
}

Status fill_mesh(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
  if (mesh.is_empty() && mesh.target_count == 0) return Status::kOk;
  fill_skin(source, plan, mesh);
  const Status status = fill_targets(source, plan, mesh);
  return status == Status::kOk ? fill_surface(source, plan, mesh) : status;
}

void place_all(const DnaView& view, const Rig& rig, Span<const MeshPlan> plans,
               const DeformOptions& options, Placer& placer, Deformer& deformer) {
  placer.object<Deformer>();
  place_skeleton(rig, placer, deformer.skeleton);
  deformer.meshes = placer.unwritten_array<DeformMesh>(rig.mesh_count);
  for (uint32_t m = 0; m < rig.mesh_count; ++m) {
    DeformMesh measured;
    DeformMesh& mesh = placer.measuring() ? measured : *new (&deformer.meshes[m]) DeformMesh;
    place_mesh(mesh_at(view, m), m < plans.count ? plans[m] : kNoPlan, options, placer, mesh);
  }
}

/// A rig and a DNA file must have the same joints, channels and meshes.
Status compare_names(const DnaView& view, const Rig& rig, Error& error) {
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
      return fail(error, Status::kMismatch, kNoOffset,
                  "the rig was made of another file, or with other LODs: it has %u %s names, "
                  "the DNA has %u",
                  own.count(), list.noun, list.names.count);
    }
    for (uint32_t i = 0; i < own.count(); ++i) {
      const Span<char> a = own[i];
      const dna::String& b = list.names[i];
      if (a.count == b.count && (a.count == 0 || memcmp(a.data, b.data, a.count) == 0)) continue;
      return fail(error, Status::kMismatch, kNoOffset,
                  "the rig was made of another file, or with other LODs: %s %u is %.*s, "
                  "in the DNA it is %.*s",
                  list.noun, i, static_cast<int>(std::min<size_t>(a.count, 40)), a.data,
                  static_cast<int>(std::min<size_t>(b.count, 40)), b.chars());
    }
  }
  return Status::kOk;
}

}  // namespace

Status MeshSource::no_memory() const {
  return fail(error, Status::kMemory, kNoOffset, "no memory to compile mesh %u", index);
}

int16_t in_units(double value, float scale) {
  // The quotient by a denormal scale could be out of range; numbers so small move nothing.
  if (!(scale > 1e-37f)) return 0;
  return static_cast<int16_t>(std::lround(value / double{scale}));
}

Status compile_deformer(const DnaView& view, const Rig& rig, const DeformOptions& options,
                        const Allocator& allocator, Deformer*& out, Error& error) {
  out = nullptr;
  Status status = compare_names(view, rig, error);
  if (status != Status::kOk) return status;
  Arena scratch(allocator);
  // Meshes that the geometry lacks, which are the last, have nothing to plan and to fill.
  const uint32_t present = std::min(rig.mesh_count, view.geom.meshes.count);
  const Span<MeshPlan> plans = scratch.array<MeshPlan>(present);
  if (!plans.data && present != 0) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to compile %u meshes", present);
  }
  const auto source = [&](uint32_t m) {
    return MeshSource{view, mesh_at(view, m), m, options, scratch, error};
  };
  for (uint32_t m = 0; m < present; ++m) {
    status = plan_mesh(source(m), plans[m]);
    if (status != Status::kOk) return status;
  }

  Deformer measured;
  Placer measure(nullptr);
  place_all(view, rig, plans, options, measure, measured);
  void* block = allocator.get(measure.size(), kBlockAlignment);
  if (!block) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for a deformer of %zu bytes",
                measure.size());
  }
  Placer placer(block);
  Deformer placed;
  place_all(view, rig, plans, options, placer, placed);
  Deformer* deformer = start_object<Deformer>(block, measure.size(), allocator);
  deformer->kernels = options.kernels;
  deformer->rig = share(rig);
  deformer->normals = options.normals;
  deformer->fix_weights = options.fix_weights;
  deformer->has_tangents = options.tangents;
  deformer->half_storage = options.half_storage;
  deformer->skeleton = placed.skeleton;
  deformer->meshes = placed.meshes;
  mark_mesh_lods(rig, deformer->meshes);

  status = fill_skeleton(rig, options.kernels, options.compose, scratch, deformer->skeleton, error);
  for (uint32_t m = 0; m < present && status == Status::kOk; ++m) {
    status = fill_mesh(source(m), plans[m], deformer->meshes[m]);
  }
  if (status != Status::kOk) {
    release(deformer);
    return status;
  }
  out = deformer;
  return Status::kOk;
}

}  // namespace mien
