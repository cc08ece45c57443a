// SPDX-License-Identifier: MIT
// Skin weights by joint: the vertices that a joint moves (its footprint), and sums over them for
// the fit.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"
#include "runtime/base/parallel_for.h"

namespace mien::author {

struct Influenced {
  uint32_t vertex;
  float weight;
};

/// Squared weights of a footprint as masses: their sum, center and second moments about the center.
struct Moments {
  double mass = 0;
  Vec3 center;
  Vec3 spread[3];  // symmetric

  double size() const { return spread[0].x + spread[1].y + spread[2].z; }
};

/// True if a fit may move the bone: root, chest, neck and head do not move.
inline bool is_fitted(const Bone& bone) {
  return bone.kind == BoneKind::kFacial || bone.kind == BoneKind::kJaw ||
         bone.kind == BoneKind::kEye || bone.kind == BoneKind::kTongue;
}

struct Footprints {
  uint32_t bone_count = 0;
  Span<uint32_t> starts;     // bone_count + 1, into `entries`
  Span<Influenced> entries;  // by bone, vertices ascending
  Span<double> gram;         // bone_count rows: sums of products of weights; 0 for fixed bones
  Span<Moments> moments;     // per bone
  Span<uint8_t> fitted;      // per bone
  Span<uint8_t> facial;      // per bone: facial, not jaw, tongue or eye
  Span<uint32_t> parents;    // per bone
  // The first jaw and the bones below it, as if they were one; without the tongue, which moves mostly by
  // itself.
  uint32_t jaw = kNone;
  Vec3 jaw_position;
  Span<uint8_t> below_jaw;   // per bone: the jaw and what hangs below it
  Span<uint8_t> on_jaw;      // per bone: the same without the tongue
  Span<Influenced> carried;  // by them; vertices ascending
  uint32_t carried_count = 0;
  Moments carried_moments;
  double damping = 0;  // added to the diagonal of the Gram matrix

  Span<Influenced> of(uint32_t bone) const {
    return entries.slice(starts[bone], starts[bone + 1] - starts[bone]);
  }
  Span<Influenced> of_jaw() const { return carried.first(carried_count); }
  /// The moments of everything that moves with the joint.
  const Moments& moved_by(uint32_t bone) const {
    return bone == jaw ? carried_moments : moments[bone];
  }
};

/// Allocates all memory that fill_footprints() needs; false if there is not enough.
bool make_footprints(size_t vertex_count, const Placement& placement, uint32_t influences,
                     Arena& arena, Footprints& out);

/// Weights may change between two calls. Any number of threads gives the same bits.
void fill_footprints(Span<const Vec3> positions, const SkinWeights& weights,
                     const ParallelFor& parallel, Footprints& out);

}  // namespace mien::author
