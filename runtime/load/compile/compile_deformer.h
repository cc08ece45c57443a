// SPDX-License-Identifier: MIT
// DNA view and rig -> deformer: plan each mesh in scratch memory, allocate one block, fill it.
#pragma once

#include "runtime/base/status.h"
#include "runtime/base/vector.h"
#include "runtime/deform/deformer.h"
#include "runtime/load/dna/format/dna_view.h"
#include "simd/isa.h"

namespace mien {

struct DeformOptions {
  const KernelTable* kernels = nullptr;
  Compose compose = Compose::kProduct;
  Normals normals = Normals::kRecomputed;
  bool fix_weights = false;
  bool tangents = false;
  bool half_storage = false;
  double delta_error = 0;  // as in MienDeformerDesc
};

/// Compiles the geometry of a checked view. kMismatch if its joints, channels or meshes are not those of
/// `rig`. On success `out` is one block of `allocator`, which release() frees, and shares the rig.
/// kDnaValue: a joint is its own ancestor, or a position, delta or weight is not finite. kDnaLimit: a
/// position has more than 65535 influences. kMemory.
Status compile_deformer(const dna::DnaView& view, const Rig& rig, const DeformOptions& options,
                        const Allocator& allocator, Deformer*& out, Error& error);

/// What the runs of targets of a block take in 16-bit storage.
struct FixedBlock {
  uint32_t runs = 0, deltas = 0;
  size_t words = 0;
};

/// The sorted order and the counts of a mesh, in scratch memory.
struct MeshPlan {
  Span<uint64_t>
      order;  // [sorted index] influences << 48 | joint of largest weight << 32 | position
  Span<uint32_t> sorted_indices;  // [position]
  uint32_t skin_run_count = 0;
  size_t weight_count = 0;
  uint32_t max_influences = 0;
  float max_weight = 0;  // in magnitude
  size_t target_run_count = 0, delta_count = 0;
  bool fixed_targets = false;  // deltas are integers; then also:
  size_t fixed_words = 0;      // of masks and deltas
  float largest_packed = 0;    // runs of smaller numbers are packed
  Span<FixedBlock> fixed_blocks;
  size_t triangle_count = 0, face_count = 0, hard_count = 0;
  Span<Vec3> directions;          // [position] outward recomputed neutral normal
  Span<uint8_t> hard;             // [position] 1: it has vertices on hard edges
  bool inward = false;            // the faces, as the file winds them, point into the mesh
  bool triangles_follow = false;  // from faces; then also:
  Span<uint8_t> vertex_counts;    // [position] 0, 1, or 2: several
  size_t corner_count = 0;        // of those at positions without exactly one vertex
  bool fixed_coordinates = false;
};

/// A mesh of the DNA, and the data that its compilation needs.
struct MeshSource {
  const dna::DnaView& view;
  const dna::Mesh& mesh;
  uint32_t index;
  const DeformOptions& options;
  Arena& scratch;
  Error& error;

  Status no_memory() const;
};

/// Room for `count` indices below `limit`.
inline void place_indices(size_t count, size_t limit, Placer& placer, IndexList& list,
                          size_t alignment) {
  list = limit <= 0x10000 ? IndexList(placer.array<uint16_t>(count, alignment))
                          : IndexList(placer.array<uint32_t>(count, alignment));
}

/// Calls f(three vertices) for each triangle of the file, the fans of its faces.
template <class F>
void for_each_triangle(const dna::Mesh& mesh, F&& f) {
  for (const dna::Face& face : mesh.faces) {
    const dna::Array<uint32_t>& vertices = face.layout_indices;
    for (uint32_t i = 2; i < vertices.count; ++i) {
      const uint32_t triangle[3] = {vertices[0], vertices[i - 1], vertices[i]};
      f(triangle);
    }
  }
}

/// The texture coordinates of a vertex; 0 if there are none.
inline void read_coordinates(const dna::Mesh& mesh, uint32_t vertex, float* uv) {
  const bool any = mesh.texture_coordinates.us.count != 0;
  const uint32_t at = any ? mesh.layouts.texture_coordinates[vertex] : 0;
  uv[0] = any ? float(mesh.texture_coordinates.us[at]) : 0;
  uv[1] = any ? float(mesh.texture_coordinates.vs[at]) : 0;
}

/// `value`, at most 32767 scales, in units of a scale.
int16_t in_units(double value, float scale);

// The skeleton only needs the rig.

void place_skeleton(const Rig& rig, Placer& placer, Skeleton& skeleton);
/// kDnaValue if a joint is its own ancestor; kMemory if `scratch` runs out.
Status fill_skeleton(const Rig& rig, const KernelTable* kernels, Compose compose, Arena& scratch,
                     Skeleton& skeleton, Error& error);

// The parts of a mesh, one file each: pack_skin.cpp, pack_targets.cpp, pack_surface.cpp,
// pack_tangents.cpp.
// plan_...() counts, and refuses what cannot be compiled; place_...() lays out the memory;
// fill_...() writes it, and fails only if scratch memory runs out.

Status plan_skin(const MeshSource& source, MeshPlan& plan);
void place_skin(const MeshPlan& plan, bool half_storage, Placer& placer, DeformMesh& mesh);
void fill_skin(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh);

Status plan_targets(const MeshSource& source, MeshPlan& plan);
void place_targets(const MeshPlan& plan, Placer& placer, DeformMesh& mesh);
Status fill_targets(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh);

// In 16-bit storage, for plan_targets() and fill_targets():
Status plan_fixed_targets(const MeshSource& source, MeshPlan& plan);
Status fill_fixed_targets(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh);

Status plan_surface(const MeshSource& source, MeshPlan& plan);
void place_surface(const MeshPlan& plan, const DeformOptions& options, Placer& placer,
                   DeformMesh& mesh);
Status fill_surface(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh);

/// Part of fill_surface(). `inward`: the triangles, as the file winds them, face into the mesh.
Status fill_tangents(const MeshSource& source, bool inward, DeformMesh& mesh);

}  // namespace mien
