// SPDX-License-Identifier: MIT
// The deformer: all meshes packed for deformation, in one block of memory, never changed after it
// was made.
//
//     | Deformer | skeleton | meshes | mesh 0: neutral, skin, targets, faces, corners | mesh 1 ...
//     |
//
// Positions are worked on in an order of their own, "places": by number of influences, then by the
// joint that holds them most, so that neighbors need the same code and the same matrices.
#pragma once

#include "runtime/pose/skeleton.h"

namespace mien {

/// Numbers of MIEN_NORMALS_... in mien.h.
enum class Normals : uint32_t { kDefault = 0, kNone = 1, kSkinned = 2, kRecomputed = 3 };

/// Positions that are worked on together: their scratch stays in the nearest cache.
constexpr uint32_t kBlockPlaces = 512;

/// Places with the same number of influences. Row r of the run has its weights and joints at
/// first_weight + r * influences.
struct SkinRun {
  uint64_t first_weight;
  uint32_t first, count;
  uint32_t influences;
  uint32_t zero;
};

/// What one target does to the places of one block.
struct TargetPiece {
  uint32_t target;
  uint32_t channel;
  uint32_t first_delta, count;
};

struct DeformMesh {
  uint32_t position_count = 0, vertex_count = 0, triangle_count = 0;
  uint32_t max_influences = 0, target_count = 0;
  uint64_t delta_count = 0;
  uint64_t lods = 0;

  // As the file has it, for the caller.
  Span<float> positions;                   // [position] x y z, and one float more
  Span<float> normals;                     // [vertex] x y z, unit, and one float more
  Span<float> texture_coordinates;         // [vertex] u v
  Span<uint32_t> vertex_position_indices;  // [vertex]
  Span<uint32_t> triangles;
  Span<uint16_t> target_channels;  // [target]

  // Skin.
  Span<uint32_t> position_at;  // [place]
  Span<uint32_t> place_of;     // [position]
  Span<float> neutral;         // [place] x y z 0
  Span<SkinRun> runs;
  Span<float> weights;
  Span<uint16_t> joints;

  // Blend shape targets, by block, then by target: deltas x y z (and one float more), and the
  // places that they move, counted from the first of the block.
  Span<uint32_t> first_piece;  // [block], one more at the end
  Span<TargetPiece> pieces;
  Span<float> deltas;
  Span<uint16_t> delta_places;

  // Normals. A face is four positions (a triangle has its last one twice); its area vector is
  // (p2 - p0) x (p3 - p1) / 2, pointing out of the mesh.
  Span<uint32_t> faces;            // [face][4]
  Span<uint32_t> first_touching;   // [place], one more at the end
  Span<uint32_t> touching;         // faces around the place
  Span<uint32_t> first_corner;     // [place], one more at the end
  Span<uint32_t> corners;          // vertex, with kHardCorner or without
  Span<float> neutral_directions;  // [place] x y z 0, unit, recomputed

  uint32_t block_count() const { return (position_count + kBlockPlaces - 1) / kBlockPlaces; }
  uint32_t face_count() const { return static_cast<uint32_t>(faces.count / 4); }
};

struct Deformer {
  uint32_t tag = 0;  // first, for the C API to recognize its handles
  Allocator allocator;
  size_t block_size = 0;
  size_t baked_size = 0;                    // of its part of a baked file, if its arrays are there
  mutable std::atomic<uint32_t> owners{1};  // the creator and every pose

  const KernelTable* kernels = nullptr;
  const Rig* rig = nullptr;                // owned with others
  Normals normals = Normals::kRecomputed;  // of calls that leave the choice open
  bool fix_weights = false;
  Skeleton skeleton;
  Span<DeformMesh> meshes;
};

/// The run that a place belongs to.
const SkinRun* run_of(const DeformMesh& mesh, uint32_t place);

/// x y z for each position: how far a target moves it at weight 1.
void write_target(const DeformMesh& mesh, uint32_t target, float* out);

/// Drops one owner; the last one releases the block.
void release_deformer(const Deformer* deformer);

}  // namespace mien
