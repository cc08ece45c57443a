// SPDX-License-Identifier: MIT
// Skin weights that follow the surface, not the air between the lips.
//
// A bone is anchored at the nearest place of the mask; D is the length of the way to it along edges,
// together with the bone's depth below the anchor. The m nearest bones of a vertex share it by
//
//     w_j ~ (1 - (D_j / R)^2)^2,   R: D of the next one
//
// (the biweight kernel), so a weight and its slope fall to 0 exactly where its bone leaves the list,
// and are flat at the bone.
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
  double least = 1;      // smallest weight but for 0
  uint32_t max_influences = 0;
  uint32_t split_supports = 0;  // bones whose vertices are in several pieces
  double roughness = 0;         // 95th percentile over edges of |w_a - w_b| spacing / length
  uint32_t idle_bones = 0;      // facial bones that weigh most at no vertex
  uint32_t rigid_components = 0, following_components = 0;
};

/// Weights of every vertex. `weights` and `joints` of `out` are made in `arena`. False if memory ran out.
bool make_skin_weights(const AuthorMesh& mesh, const Placement& placement,
                       const WeightOptions& options, Arena& arena, const Allocator& allocator,
                       SkinWeights& out);

constexpr uint32_t kWeightLanes = 4;  // LODs that are weighed at once at most

/// The same for up to kWeightLanes LODs, each with its options, in parallel. The bits are those of
/// one after the other.
bool make_lod_weights(const AuthorMesh& mesh, const Placement& placement,
                      Span<const WeightOptions> options, const ParallelFor& parallel, Arena& arena,
                      const Allocator& allocator, Span<SkinWeights> out);

/// Facial bones keep the piece of their vertices in which they weigh most; what lies apart goes to the
/// other bones there, or to `head`. Vertices at one place get the weights of the first. False if memory
/// ran out.
bool connect_supports(const AuthorMesh& mesh, const SurfaceGraph& graph, const Placement& placement,
                      uint32_t head, Arena& scratch, SkinWeights& out);

/// Measures weights, also those of a caller. False if memory ran out.
bool measure_weights(const AuthorMesh& mesh, const Placement& placement, const SkinWeights& weights,
                     const Allocator& allocator, WeightReport& out);

}  // namespace mien::author
