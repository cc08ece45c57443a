// SPDX-License-Identifier: MIT
#include "author/fit/joint_tree.h"

#include <algorithm>

#include "author/base/dna_making.h"

namespace mien::author {

bool hang_on_jaw(const AuthorMesh& mesh, const Shape& shape, const Affine& opened,
                 const SkinWeights& weights, Arena& arena, Placement& placement) {
  const size_t count = placement.bones.count;
  uint32_t jaw = kNone;
  for (uint32_t b = 0; b < placement.first_facial && jaw == kNone; ++b) {
    if (placement.bones[b].kind == BoneKind::kJaw) jaw = b;
  }
  if (jaw == kNone) return true;
  struct Sums {
    double along = 0, all = 0;  // of the shape along the jaw's motion, and of that motion
  };
  Span<Bone> bones;
  Span<Sums> sums;
  if (!make(arena, count, bones) || !make(arena, count, sums)) return false;
  std::copy(placement.bones.begin(), placement.bones.end(), bones.begin());
  for (size_t v = 0; v < mesh.positions.count; ++v) {
    const Vec3 with_jaw = opened(mesh.positions[v]) - mesh.positions[v];
    const Vec3f f = shape.displacements[v];
    const double along = dot({double{f.x}, double{f.y}, double{f.z}}, with_jaw);
    const double all = dot(with_jaw, with_jaw);
    for (size_t i = v * weights.m; i < (v + 1) * weights.m; ++i) {
      const double mass = double{weights.weights[i]} * double{weights.weights[i]};
      sums[weights.joints[i]].along += mass * along;
      sums[weights.joints[i]].all += mass * all;
    }
  }
  for (uint32_t b = placement.first_facial; b < placement.first_facial + placement.facial_count;
       ++b) {
    const uint32_t other = bones[b].mirror;
    const double along = sums[b].along + sums[other].along, all = sums[b].all + sums[other].all;
    if (all > 0 && along >= kWithJaw * all) bones[b].parent = jaw;
  }
  placement.bones = bones;
  return true;
}

}  // namespace mien::author
