// SPDX-License-Identifier: MIT
// View and rig -> deformer: plan each mesh in scratch memory, allocate once, fill.
#pragma once

#include "runtime/base/status.h"
#include "runtime/deform/deformer.h"
#include "runtime/dna/format/dna_view.h"

namespace mien {

struct DeformOptions {
  const KernelTable* kernels = nullptr;
  Compose compose = Compose::kProduct;
  Normals normals = Normals::kRecomputed;
  bool fix_weights = false;
};

/// Packs the geometry of a checked view, which has the joints, channels and meshes of `rig`. On
/// success `out` is one block of `allocator`, to be given back by release_deformer(), and an owner
/// of the rig.
Status compile_deformer(const dna::DnaView& view, const Rig& rig, const DeformOptions& options,
                        const Allocator& allocator, Deformer*& out, Error& error);

/// What has to be known of a mesh before its memory can be measured. Lies in the scratch arena.
struct MeshPlan {
  Span<uint64_t> order;     // [place] influences << 48 | joint that holds most << 32 | position
  Span<uint32_t> place_of;  // [position]
  uint32_t run_count = 0;
  size_t weight_count = 0;
  uint32_t max_influences = 0;
  size_t piece_count = 0, delta_count = 0;
  size_t triangle_count = 0, face_count = 0;
};

/// The mesh being packed.
struct MeshSource {
  const dna::DnaView& view;
  const dna::Mesh& mesh;
  uint32_t number;
  bool fix_weights;
  Arena& scratch;
  Error& error;

  Status no_memory() const;
};

// The skeleton, of the rig alone.

void place_skeleton(const Rig& rig, Placer& placer, Skeleton& skeleton);
/// kDnaValue if joints descend from themselves; kMemory for `scratch`.
Status fill_skeleton(const Rig& rig, const KernelTable* kernels, Compose compose, Arena& scratch,
                     Skeleton& skeleton, Error& error);

// The pieces of packing. plan_...() also finds what cannot be packed; after it only scratch memory
// can fail.

Status plan_skin(const MeshSource& source, MeshPlan& plan);
void place_skin(const MeshPlan& plan, Placer& placer, DeformMesh& mesh);
void fill_skin(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh);

Status plan_targets(const MeshSource& source, MeshPlan& plan);
void place_targets(const MeshPlan& plan, Placer& placer, DeformMesh& mesh);
Status fill_targets(const MeshSource& source, DeformMesh& mesh);

void plan_surface(const MeshSource& source, MeshPlan& plan);
void place_surface(const MeshPlan& plan, Placer& placer, DeformMesh& mesh);
Status fill_surface(const MeshSource& source, DeformMesh& mesh);

}  // namespace mien
