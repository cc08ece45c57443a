// SPDX-License-Identifier: MIT
#include "author/rigging/jaw_shape.h"

#include <algorithm>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/base/joint_motion.h"
#include "author/place/extra_joints.h"

namespace mien::author {

bool add_jaw_shape(const Placement& placement, const SkinWeights& weights, bool metahuman_names,
                   Arena& arena, AuthorMesh& mesh, PlaceReport& report) {
  constexpr double kOpenDegrees = 20;
  if (placement.jaw_share.empty() || jaw_open_shape(mesh) != kNone) return true;
  const size_t n = mesh.positions.count, given = mesh.shapes.count;
  Span<uint8_t> below;
  Span<Shape> shapes;
  Span<Vec3f> displacements;
  Span<uint32_t> moving;
  if (!make(arena, placement.bones.count, below) || !make(arena, given + 1, shapes) ||
      !make(arena, n, displacements) || !make(arena, n, moving)) {
    return false;
  }
  Vec3 pivot;
  for (uint32_t b = 0; b < placement.bones.count; ++b) {
    const Bone& bone = placement.bones[b];
    below[b] = bone.kind == BoneKind::kJaw || (bone.parent < b && below[bone.parent]);
    if (bone.kind == BoneKind::kJaw) pivot = bone.position;
  }
  const double angles[3] = {kOpenDegrees, 0, 0};
  const Affine turn = motion(angles, pivot, {});
  size_t count = 0;
  for (uint32_t v = 0; v < n; ++v) {
    double share = 0;
    for (size_t i = size_t{v} * weights.m; i < (size_t{v} + 1) * weights.m; ++i) {
      if (below[weights.joints[i]]) share += double{weights.weights[i]};
    }
    if (!(share > 0)) continue;
    const Vec3 d = (turn(mesh.positions[v]) - mesh.positions[v]) * share;
    displacements[v] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
    moving[count++] = v;
  }
  std::copy(mesh.shapes.begin(), mesh.shapes.end(), shapes.begin());
  const char* const name = metahuman_names ? "CTRL_expressions.jawOpen" : "jawOpen";
  shapes[given].name = {name, strlen(name)};
  shapes[given].displacements = displacements;
  shapes[given].moving = moving.first(count);
  shapes[given].number = static_cast<uint32_t>(given);
  mesh.shapes = shapes;
  report.jaw_shape = shapes[given].name;
  report.jaw_angle = kOpenDegrees;
  return true;
}

}  // namespace mien::author
