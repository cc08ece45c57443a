// SPDX-License-Identifier: MIT
// From shapes to motions of bones: which bones move with a shape, their translations by least
// squares, their rotations by block descent, and weights fitted to both.
//
// A vertex v goes to v + sum over bones j of w_vj (M_js v - v), where M_js is the rigid motion of
// bone j at full value of shape s, including the motion of its parent. A bone that does not move
// relative to its parent has the motion of the parent; below bones that never move this is the identity.
#pragma once

#include "author/base/joint_motion.h"
#include "author/fit/footprints.h"
#include "author/mesh/topology.h"

namespace mien::author {

struct FitOptions {
  bool rotations = true;
  uint32_t sweeps = 6;           // of block descent over the bones
  uint32_t alternations = 2;     // refits of weights, then motions; 0 keeps the weights
  uint32_t shared_rounds = 2;    // rounds that fit the motions to all LODs, if there are several
  double smoothness = 0.17;      // of the weights of LOD 0, for each edge between two bones
  double lod_smoothness = 0.05;  // of LODs after LOD 0, whose joints have larger errors
  // Pull of weights to their previous values, squared: with less, some bones are the largest
  // influence nowhere.
  double pull = 0.01, lod_pull = 0.0025;
  double support = 1e-3;  // bones with at least this share of the largest energy move with a shape
  double max_degrees = 30;  // rotation of a facial bone by one shape
  double jaw_share =
      0.7;  // of the squared motion below the jaw, from which on a shape moves the jaw
};

struct Motions {
  Span<Affine> items;  // [shape * bone_count + bone]
  Span<uint8_t>
      active;  // likewise: 0 where the bone does not move relative to its parent, by choice
  uint32_t bone_count = 0;

  Span<Affine> of(size_t shape) const { return items.slice(shape * bone_count, bone_count); }
  Span<uint8_t> active_in(size_t shape) const {
    return active.slice(shape * bone_count, bone_count);
  }
};

/// Memory for the work of one thread. Work is assigned to lanes, not to threads, so results do not
/// depend on the number of threads.
struct FitLane {
  Span<Vec3> rest;      // per vertex: the remaining displacement
  Span<double> matrix;  // bones * bones
  Span<Vec3> steps;     // per bone
  Span<uint16_t> rows;  // per bone
  Span<double> energy;  // per bone
};
constexpr uint32_t kFitLanes = 8;

/// Rows are the vertices of the mesh, or those of several LODs, LOD after LOD.
struct Fitter {
  Span<const Vec3> positions;
  Span<const uint32_t> vertices;  // vertex of the mesh of each row; empty: row v is vertex v
  Span<const double> scales;      // square roots of the weights of the rows; empty: 1 each
  Footprints footprints;
  FitLane lanes[kFitLanes];
  FitOptions options;
};

/// False if memory ran out.
bool make_fitter(Span<const Vec3> positions, const Placement& placement, uint32_t influences,
                 const FitOptions& options, Arena& arena, Fitter& out);
bool make_motions(size_t shapes, size_t bones, Arena& arena, Motions& out);

/// Marks bones with energy under their footprint: sum of w^2 |rest|^2. Facial bones are only
/// compared with each other: a jaw with thousands of vertices of teeth would dwarf them.
void find_support(const Fitter& fitter, FitLane& lane, Span<uint8_t> active);

/// Bones that do not move of their own get the motion of their parent. `active` of the shape.
void follow_parents(const Footprints& footprints, Span<const uint8_t> active, Span<Affine> motions);

/// Moves active bones further so that they reduce the displacements in `lane.rest`, and leaves the
/// remainder there.
void fit_motions(const Fitter& fitter, FitLane& lane, Span<const uint8_t> active,
                 Span<Affine> motions);

/// Fits all shapes, with fixed bone positions and `weights`; those of each row are multiplied by
/// its scale. `given`: `active` is an input, and the fit continues from the current motions if
/// bones turn.
void fit_all(Fitter& fitter, const AuthorMesh& mesh, const SkinWeights& weights, bool given,
             const ParallelFor& parallel, const Motions& out);

/// Bones whose weights are not fitted as those of others.
struct BoneRoles {
  Span<uint8_t> held;       // by bone: chest and neck, which keep their weights; empty: none
  uint32_t jaw = kNone;     // the first one
  uint32_t opens = kNone;   // the shape that turns it most
  Span<uint8_t> below_jaw;  // by bone: the jaw and what hangs below it
};

/// The weights of each vertex that fit its displacements best, over all shapes. They are not
/// negative and sum to one. `pull` pulls them to their previous values, `smoothness` to those of
/// their neighbors. The candidates are the influences in `from` and the `shared` bones, of which
/// the first is the head; `out` gets as many as it has room for. Vertices without a facial bone, a
/// jaw or an eye do not change. `out` may be `from`. False if memory ran out.
constexpr uint32_t kMaxSharedBones = 4;
bool refit_weights(const AuthorMesh& mesh, const SurfaceGraph& graph, const Motions& motions,
                   Span<const uint16_t> shared, const BoneRoles& roles, double smoothness,
                   double pull, const ParallelFor& parallel, Arena& scratch,
                   const SkinWeights& from, SkinWeights& out);

/// The weights of LOD 0, as smooth as the options ask for; the vertices of each bone are connected.
bool refit_finest(const AuthorMesh& mesh, const Placement& placement, const Motions& motions,
                  Span<const uint16_t> shared, const FitOptions& options,
                  const ParallelFor& parallel, const Allocator& allocator, SkinWeights& weights);
/// The weights of another LOD.
bool refit_lod(const AuthorMesh& mesh, const Placement& placement, const Motions& motions,
               Span<const uint16_t> shared, const FitOptions& options, const ParallelFor& parallel,
               const Allocator& allocator, const SkinWeights& from, SkinWeights& out);

}  // namespace mien::author
