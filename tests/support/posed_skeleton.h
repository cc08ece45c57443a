// SPDX-License-Identifier: MIT
// The skin of an authored rig with one joint turned, as an animator does, without expressions.
#pragma once

#include <string>
#include <vector>

#include "author/base/joint_motion.h"
#include "author/rigging/rigging.h"

namespace mien::author {

/// The number of the bone, or that of the root.
inline uint32_t bone_named(const Rigging& rigging, const std::string& name) {
  const Span<const Bone> bones = rigging.placement.bones;
  for (uint32_t b = 0; b < bones.count; ++b) {
    if (std::string(bones[b].name.data, bones[b].name.count) == name) return b;
  }
  return 0;
}

/// Whether the bone or one above it is `above`.
inline bool hangs_below(const Rigging& rigging, uint32_t bone, uint32_t above) {
  const Span<const Bone> bones = rigging.placement.bones;
  while (bone != above && bones[bone].parent != bone) bone = bones[bone].parent;
  return bone == above;
}

/// How much of the vertex goes with the bone and what hangs below it.
inline double share_below(const Rigging& rigging, uint32_t vertex, uint32_t bone) {
  const SkinWeights& w = rigging.weights;
  double sum = 0;
  for (size_t i = size_t{vertex} * w.m; i < size_t{vertex + 1} * w.m; ++i) {
    if (w.weights[i] > 0 && hangs_below(rigging, w.joints[i], bone)) sum += double{w.weights[i]};
  }
  return sum;
}

/// Positions after the bone is turned by these degrees about x, y and z.
inline std::vector<Vec3> turned(const Rigging& rigging, uint32_t bone, Vec3 degrees) {
  const double angles[3] = {degrees.x, degrees.y, degrees.z};
  const Affine turn = motion(angles, rigging.placement.bones[bone].position, {});
  const Span<const Vec3> rest = rigging.read.mesh.positions;
  std::vector<Vec3> out(rest.count);
  for (uint32_t v = 0; v < rest.count; ++v) {
    out[v] = rest[v] + (turn(rest[v]) - rest[v]) * share_below(rigging, v, bone);
  }
  return out;
}

}  // namespace mien::author
