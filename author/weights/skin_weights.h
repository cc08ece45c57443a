// SPDX-License-Identifier: MIT
// Skin weights by distance along the surface, so that they do not cross the gap between the lips.
//
// A bone is anchored at the nearest place of the mask; D is the distance to it along edges, plus
// the depth of the bone below the anchor. The m nearest bones of a vertex share it by
//
//     w_j ~ (1 - (D_j / R)^2)^2,   R: D of the next one
//
// (the biweight kernel). So a weight and its slope are 0 exactly where its bone leaves the list,
// and the slope is 0 at the bone.
#pragma once

#include "author/mesh/author_mesh.h"
#include "author/mesh/topology.h"
#include "runtime/base/parallel_for.h"
#include "runtime/base/status.h"

namespace mien::author {

constexpr uint32_t kMinInfluences = 1, kMaxAuthorInfluences = 12;

struct WeightOptions {
  uint32_t influences = 8;
  uint32_t facial_bones = kNone;  // the first ones by rank, for a LOD; kNone: all
};

/// How each component that is not skin is carried.
enum class Carrier : uint8_t { kSkin, kRigid, kNearestSkin };

struct WeightReport {
  double worst_sum = 0;  // largest |sum - 1| of a vertex
  double least = 1;      // smallest weight above 0
  uint32_t max_influences = 0;
  uint32_t split_supports = 0;  // bones whose vertices are in several pieces
  double roughness = 0;         // 95th percentile over edges of |w_a - w_b| spacing / length
  uint32_t idle_bones = 0;      // facial bones that are the largest influence of no vertex
  uint32_t rigid_components = 0, following_components = 0;
};

/// Weights of every vertex. `weights` and `joints` of `out` are made in `arena`. False if memory
/// ran out.
bool make_skin_weights(const AuthorMesh& mesh, const Placement& placement,
                       const WeightOptions& options, Arena& arena, const Allocator& allocator,
                       SkinWeights& out);

constexpr uint32_t kWeightLanes = 4;  // the largest number of LODs that are computed at once

/// The same for up to kWeightLanes LODs, each with its options, in parallel. The bits are the same
/// as one after the other.
bool make_lod_weights(const AuthorMesh& mesh, const Placement& placement,
                      Span<const WeightOptions> options, const ParallelFor& parallel, Arena& arena,
                      const Allocator& allocator, Span<SkinWeights> out);

/// Of the vertices of a facial bone only the connected piece with the largest weight is kept. The
/// others go to the other bones there, or to `head`. Vertices at one position get the weights of
/// the first. False if memory ran out.
bool connect_supports(const AuthorMesh& mesh, const SurfaceGraph& graph, const Placement& placement,
                      uint32_t head, Arena& scratch, SkinWeights& out);

/// Measures weights, computed or given by the caller. False if memory ran out.
bool measure_weights(const AuthorMesh& mesh, const Placement& placement, const SkinWeights& weights,
                     const Allocator& allocator, WeightReport& out);

}  // namespace mien::author
