// SPDX-License-Identifier: MIT
// From shapes to motions of bones: which bones move with a shape, their translations by least
// squares, their rotations by block descent, and weights that suit both.
//
// A vertex v goes to v + sum over bones j of w_vj (M_js v - v), where M_js is the rigid motion of
// bone j at full value of shape s. Bones that do not move with s have the identity.
#pragma once

#include "author/base/joint_motion.h"
#include "author/fit/footprints.h"
#include "author/mesh/topology.h"

namespace mien::author {

struct FitOptions {
  bool rotations = true;
  uint32_t sweeps = 6;         // of block descent over the bones
  uint32_t alternations = 2;   // refits of the weights, each followed by a new fit; 0 keeps weights
  uint32_t shared_rounds = 2;  // in which motions are fitted to all LODs, if there are several
  double smoothness = 0.17;    // of the weights of LOD 0, for each edge between two bones
  double lod_smoothness = 0.05;  // of further LODs, whose joints have more to make up for
  // Of weights to what they were, in squares: with less, some bones weigh most nowhere.
  double pull = 0.01, lod_pull = 0.0025;
  double support = 1e-3;    // share of the largest energy from which on a bone moves with a shape
  double max_degrees = 30;  // rotation of a facial bone by one shape
};

struct Motions {
  Span<Affine> items;    // [shape * bone_count + bone]
  Span<uint8_t> active;  // likewise: 0 where the motion is the identity by decision
  uint32_t bone_count = 0;

  Span<Affine> of(size_t shape) const { return items.slice(shape * bone_count, bone_count); }
  Span<uint8_t> active_in(size_t shape) const {
    return active.slice(shape * bone_count, bone_count);
  }
};

/// Memory of one thread's work at a time; work is dealt out to lanes, never to threads, so results
/// do not depend on these.
struct FitLane {
  Span<Vec3> rest;      // per vertex: what is left to do
  Span<double> matrix;  // bones * bones
  Span<Vec3> steps;     // per bone
  Span<uint16_t> rows;  // per bone
  Span<double> energy;  // per bone
};
constexpr uint32_t kFitLanes = 8;

/// Rows are the vertices of the mesh, or those of several LODs one below the other.
struct Fitter {
  Span<const Vec3> positions;
  Span<const uint32_t> vertices;  // of the mesh, which rows are; empty: row v is vertex v
  Span<const double> scales;      // roots of what rows count; empty: one each
  Footprints footprints;
  FitLane lanes[kFitLanes];
  FitOptions options;
};

/// False if memory ran out.
bool make_fitter(Span<const Vec3> positions, const Placement& placement, uint32_t influences,
                 const FitOptions& options, Arena& arena, Fitter& out);
bool make_motions(size_t shapes, size_t bones, Arena& arena, Motions& out);

/// Marks bones with energy under their footprint: sum of w^2 |rest|^2. Facial bones are compared with
/// facial bones: a jaw with thousands of vertices of teeth would hide them.
void find_support(const Fitter& fitter, FitLane& lane, Span<uint8_t> active);

/// Moves active bones further so that they take up what `lane.rest` still has to do, and leaves what
/// they do not.
void fit_motions(const Fitter& fitter, const Placement& placement, FitLane& lane,
                 Span<const uint8_t> active, Span<Affine> motions);

/// All shapes, with bones where they are and `weights`, those of each row times its scale. `given`:
/// keeps `active` as it is, rather than find it, and goes on from the motions as they are if bones turn.
void fit_all(Fitter& fitter, const AuthorMesh& mesh, const Placement& placement,
             const SkinWeights& weights, bool given, const ParallelFor& parallel,
             const Motions& out);

/// Weights of each vertex that bring it closest to its displacements, all shapes together: not
/// negative, summing to one, drawn to what they were by `pull`. Of its influences in `from` and the `shared`
/// bones those stay that `out` has room for; vertices without a facial bone, a jaw or an eye are left as
/// they are, and so are the weights of `held` bones (one for each bone; empty: none) everywhere. The first of the shared ones is the head. With
/// `smoothness` they are drawn to those of their neighbors, the more the higher it is. `out` may be
/// `from`. False if memory ran out.
constexpr uint32_t kMaxSharedBones = 4;
bool refit_weights(const AuthorMesh& mesh, const SurfaceGraph& graph, const Motions& motions,
                   Span<const uint16_t> shared, Span<const uint8_t> held, double smoothness,
                   double pull, const ParallelFor& parallel, Arena& scratch,
                   const SkinWeights& from, SkinWeights& out);

/// The weights of LOD 0, as smooth as the options say, and every bone's in one piece.
bool refit_finest(const AuthorMesh& mesh, const Placement& placement, const Motions& motions,
                  Span<const uint16_t> shared, const FitOptions& options,
                  const ParallelFor& parallel, const Allocator& allocator, SkinWeights& weights);
/// Those of a further LOD.
bool refit_lod(const AuthorMesh& mesh, const Placement& placement, const Motions& motions,
               Span<const uint16_t> shared, const FitOptions& options, const ParallelFor& parallel,
               const Allocator& allocator, const SkinWeights& from, SkinWeights& out);

}  // namespace mien::author
