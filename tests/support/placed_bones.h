// SPDX-License-Identifier: MIT
// Bones placed on a mesh, and what tests measure of them.
#pragma once

#include <gtest/gtest.h>

#include "author/place/place.h"
#include "tests/support/mesh_source.h"

namespace mien::author {

struct Placed {
  Arena arena{default_allocator()};
  ReadMesh read;
  Placement placement;
  PlaceReport report;
  Error error;
  Status status;

  Placed(const Placed&) = delete;
  explicit Placed(TestMesh mesh, const PlaceOptions& options = {}) {
    status = read_mesh(mesh.source(), arena, default_allocator(), read, error);
    if (status != Status::kOk) return;
    status =
        place_bones(read.mesh, options, {}, arena, default_allocator(), placement, report, error);
  }
  Span<const Bone> facial() const {
    return placement.bones.slice(placement.first_facial, placement.facial_count);
  }
  const Bone& bone(BoneKind kind) const {
    for (const Bone& bone : placement.bones) {
      if (bone.kind == kind) return bone;
    }
    ADD_FAILURE() << "no bone of kind " << int(kind);
    return placement.bones[0];
  }
};

inline PlaceOptions with_joints(uint32_t joints) {
  PlaceOptions options;
  options.facial_joints = joints;
  return options;
}

inline double objective(const Placed& placed, const std::vector<Vec3>& bones) {
  double sum = 0;
  for (uint32_t v : placed.placement.mask) {
    double best = 1e300;
    for (const Vec3& b : bones) {
      const Vec3 d = placed.read.mesh.positions[v] - b;
      best = std::min(best, dot(d, d));
    }
    sum += best;
  }
  return sum;
}

inline std::vector<Vec3> places(Span<const Bone> bones) {
  std::vector<Vec3> out;
  for (const Bone& bone : bones) out.push_back(bone.position);
  return out;
}

/// The largest distance of a bone to the nearest one of the others, after `back` maps those here.
template <class Back>
double worst_distance(const Placed& from, const Placed& to, const Back& back) {
  double worst = 0;
  for (const Bone& a : from.placement.bones) {
    double best = 1e300;
    for (const Bone& b : to.placement.bones)
      best = std::min(best, length(a.position - back(b.position)));
    worst = std::max(worst, best);
  }
  return worst;
}

}  // namespace mien::author
