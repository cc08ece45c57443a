// SPDX-License-Identifier: MIT
// The deformer: the geometry of a rig, packed for deformation. One block of memory, immutable once
// compiled.
//
//     | Deformer | skeleton | DeformMesh 0 ... n-1 | arrays of mesh 0 | arrays of mesh 1 | ...
//
// The positions of each window of the file are deformed in a sorted order: by number of influences, then by the
// joint with the largest weight. So neighbors run the same code and read the same matrices, and a place in a window
// has 16 bits. A *sorted index* is an index into this order; all other position indices are those of the file.
#pragma once

#include "runtime/base/bits.h"
#include "runtime/base/index_list.h"
#include "runtime/pose/skeleton.h"
#include "simd/deform_kernels.h"
#include "simd/isa.h"

namespace mien {

/// Same numbers as MIEN_NORMALS_... in mien.h.
enum class Normals : uint32_t { kDefault = 0, kNone = 1, kSkinned = 2, kRecomputed = 3 };

/// Sorted positions per block. The scratch of a block stays in the first-level cache.
constexpr uint32_t kBlockPositions = 512;

/// Positions that are sorted together.
constexpr uint32_t kWindowPositions = 8 * kBlockPositions;

/// The first position of the window of a position, or of a sorted index.
constexpr uint32_t window_of(uint32_t index) { return index / kWindowPositions * kWindowPositions; }

/// A run of sorted positions with the same number of influences. The weights and joints of its
/// position r start at first_weight + r * influences.
struct SkinRun {
  uint64_t first_weight;
  uint32_t first, count;
  uint32_t influences;
  uint32_t zero;
};

/// The deltas of one blend shape target in one block.
struct TargetRun {
  uint32_t target;
  uint32_t channel;
  uint32_t first_delta, count;
};

/// Beside a target run in 16-bit storage: groups that say which positions have deltas, then the deltas in units of a
/// scale, three 16-bit integers each, or, if the run is packed, three of 10 bits in 32. See FixedTargetArgs.
struct FixedRun {
  float scale;
  uint32_t place;  // 2 * the first 16-bit word, + 1 if packed
  uint32_t groups;

  size_t first_word() const { return place / 2; }
  size_t first_delta() const { return first_word() + groups; }
  bool is_packed() const { return place % 2 != 0; }
  size_t words_per_delta() const { return is_packed() ? 2 : 3; }
};

/// Weights of meshes with more influences per position, and deltas of meshes with more of them, keep 32 bits in 16-bit
/// storage, too.
constexpr uint32_t kMaxFixedInfluences = 64, kMaxFixedDeltas = 1 << 28;

/// One mesh. Kernels load four floats to get x y z, so arrays of x y z end with one more float ("+ 1").
struct DeformMesh {
  uint32_t position_count = 0, vertex_count = 0, triangle_count = 0, target_count = 0;
  uint16_t max_influences = 0;
  bool turned_faces = false;  // `faces` are wound against the file
  float weight_scale = 0;     // of fixed_weights
  uint64_t delta_count = 0;
  uint64_t lods = 0;  // bit l: LOD l shows the mesh

  // The neutral mesh, in the order of the file.
  Span<float> positions;                   // [position] x y z, + 1
  Span<float> normals;                     // [vertex] x y z, unit, + 1
  Span<float> tangents;                    // [vertex] x y z, unit, w 1 or -1; if requested
  Span<float> texture_coordinates;         // [vertex] u v; or origin u v, step u v of
  Span<uint16_t> fixed_coordinates;        // [vertex] u v: origin + step * number
  Span<uint32_t> vertex_position_indices;  // [vertex]
  Span<uint32_t> triangles;        // [triangle][3] vertices; empty if they follow from faces
  Span<uint16_t> target_channels;  // [target]

  // Skin weights.
  Span<uint16_t> position_indices;  // [sorted index] position, minus the first of its window
  Span<float> sorted_positions;     // [sorted index] x y z 0; empty in 16-bit storage
  Span<SkinRun> skin_runs;
  Span<float> weights;          // or
  Span<int16_t> fixed_weights;  // the same in units of weight_scale
  Span<uint16_t> joints;

  // Blend shape targets, by block, then by target.
  Span<uint32_t> first_target_run;  // [block], + 1
  Span<TargetRun> target_runs;
  Span<float> deltas;            // [delta] x y z, + 1; or
  Span<int16_t> fixed_deltas;    // as fixed_runs say, + kDeltaPadding
  Span<FixedRun> fixed_runs;     // [target run], beside fixed_deltas
  Span<uint16_t> delta_indices;  // [delta] sorted index, minus that of the block; beside deltas

  // Normals. A face has four positions; a triangle repeats the last. Its area vector
  // (p2 - p0) x (p3 - p1) / 2 points out of the mesh.
  IndexList faces;                     // [face][4] positions
  IndexList corner_vertices;           // with triangles that follow: see write_triangles()
  Span<uint32_t> first_adjacent_face;  // [sorted index], + 1
  IndexList adjacent_faces;            // faces around each position
  Span<uint32_t> first_vertex;         // [sorted index], + 1
  Span<uint32_t> vertices;             // vertices of each position, some with kHardEdge
  Span<float> sorted_normals;          // normals in the order of `vertices`: x y z 0; empty in
                                       // 16-bit storage
  Span<uint32_t> hard_positions;       // sorted indices of those with vertices on hard edges
  Span<float> neutral_directions;      // [hard position] x y z 0: recomputed neutral normal

  /// With fixed_deltas.
  const FixedRun& fixed_run_of(const TargetRun& run) const {
    return fixed_runs[static_cast<size_t>(&run - target_runs.data)];
  }
  uint32_t block_count() const { return (position_count + kBlockPositions - 1) / kBlockPositions; }
  uint32_t face_count() const { return static_cast<uint32_t>(faces.count / 4); }
  bool triangles_follow() const { return triangles.empty() && triangle_count != 0; }
  /// The corners of a face, in the order of the file; returns how many it has.
  int face_corners(size_t face, uint32_t* corners) const {
    for (size_t k = 0; k < 4; ++k) corners[k] = faces[face * 4 + (turned_faces ? 4 - k : k) % 4];
    return corners[3] == corners[2] ? 3 : 4;
  }
  uint32_t position_of(uint32_t sorted_index) const {
    return window_of(sorted_index) + position_indices[sorted_index];
  }

  /// A file can list a mesh with six bytes, so a mesh without geometry must take almost no memory.
  bool is_empty() const { return position_count == 0 && vertex_count == 0; }
  size_t array_alignment() const { return is_empty() ? alignof(float) : kBlockAlignment; }
};

struct Deformer : Object {
  static constexpr uint32_t kTag = 0x6D44'4652;

  size_t baked_size = 0;  // of its part of a baked file, if its arrays are in one
  const KernelTable* kernels = nullptr;
  const Rig* rig = nullptr;
  const Deformer* whole = nullptr;  // of a subset: the one whose skeleton it uses
  ~Deformer() {
    release(rig);
    release(whole);
  }

  Normals normals = Normals::kRecomputed;  // what Normals::kDefault means
  bool fix_weights = false;
  bool has_tangents = false;
  bool half_storage = false;
  Skeleton skeleton;
  Span<DeformMesh> meshes;
};

/// Sets DeformMesh::lods. The meshes are those of the rig.
void mark_mesh_lods(const Rig& rig, const Span<DeformMesh>& meshes);

/// A deformer of some positions of one mesh, ascending. It becomes an owner of `whole`, which has its skeleton. Null
/// if memory ran out.
Deformer* create_subset(const Deformer& whole, uint32_t mesh, Span<const uint32_t> positions,
                        const Allocator& allocator);

/// The run that contains a sorted index.
const SkinRun* skin_run_of(const DeformMesh& mesh, uint32_t sorted_index);

/// The neutral positions of a block, x y z * each: those of the mesh, or a copy in `scratch`.
const float* neutral_positions(const DeformMesh& mesh, uint32_t block, float* scratch);

/// positions += weight * deltas of the run; `positions` are those of its block, x y z * each.
void add_target_run(const KernelTable& kernels, const DeformMesh& mesh, const TargetRun& run,
                    float weight, float* positions);

/// A delta of a run in 16-bit storage, as it is stored: x y z.
void read_fixed_delta(const FixedRun& run, const int16_t* words, float* xyz);

/// Calls f(sorted index minus that of the block, x y z) for each delta of a run.
template <class F>
void for_each_delta(const DeformMesh& mesh, const TargetRun& run, F&& f) {
  if (mesh.fixed_deltas.empty()) {
    for (uint32_t i = run.first_delta; i < run.first_delta + run.count; ++i) {
      f(uint32_t{mesh.delta_indices[i]},
        static_cast<const float*>(mesh.deltas.data + size_t{i} * 3));
    }
    return;
  }
  const FixedRun& fixed = mesh.fixed_run_of(run);
  const int16_t* group = mesh.fixed_deltas.data + fixed.first_word();
  const int16_t* delta = mesh.fixed_deltas.data + fixed.first_delta();
  for (uint32_t g = 0; g < fixed.groups; ++g) {
    const uint32_t of_group = static_cast<uint16_t>(group[g]);
    for (uint32_t mask = of_group & 15; mask != 0; mask &= mask - 1) {
      float xyz[3];
      read_fixed_delta(fixed, delta, xyz);
      f((of_group >> 4) * kGroupPositions + lowest_bit(mask), static_cast<const float*>(xyz));
      delta += fixed.words_per_delta();
    }
  }
}

/// to[i] = from[i] * scale.
void expand_fixed(const KernelTable& kernels, const int16_t* from, float scale, size_t count,
                  float* to);

/// Calls f(first, count, weights) for parts of `count` positions of a run, from sorted index `first` on. Weights
/// in 16-bit storage are expanded, those of one part at a time.
template <class F>
void for_each_weights(const KernelTable& kernels, const DeformMesh& mesh, const SkinRun& run,
                      uint32_t first, uint32_t count, F&& f) {
  const size_t row = run.first_weight + size_t{first - run.first} * run.influences;
  if (mesh.fixed_weights.empty()) return f(first, count, mesh.weights.data + row);
  constexpr uint32_t kAtOnce = 256;
  static_assert(kMaxFixedInfluences <= kAtOnce, "at least one position");
  float weights[kAtOnce];
  const uint32_t step = kAtOnce / run.influences;
  for (uint32_t done = 0; done < count; done += step) {
    const uint32_t part = count - done < step ? count - done : step;
    expand_fixed(kernels, mesh.fixed_weights.data + row + size_t{done} * run.influences,
                 mesh.weight_scale, size_t{part} * run.influences, weights);
    f(first + done, part, static_cast<const float*>(weights));
  }
}

/// The joints that move a position, in file order, and their weights. Not for fixed_weights.
void find_influences(const DeformMesh& mesh, uint32_t position, Span<const uint16_t>& joints,
                     Span<const float>& weights);

/// Writes three vertices per triangle, wound as in the file. Where triangles follow from faces, each face is two of them,
/// or one if it repeats its last position; a corner is the only vertex of its position, or else the next one of
/// `corner_vertices`. False if memory ran out, of which the latter takes four bytes for each position, temporarily.
bool write_triangles(const DeformMesh& mesh, const Allocator& allocator, uint32_t* out);

/// Writes u v per vertex.
void write_texture_coordinates(const DeformMesh& mesh, float* out);

/// Writes x y z per position: the delta of a target at weight 1, in file order.
void write_target(const DeformMesh& mesh, uint32_t target, float* out);

}  // namespace mien
