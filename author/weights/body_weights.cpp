// SPDX-License-Identifier: MIT
#include "author/weights/body_weights.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/weights/carriers.h"

namespace mien::author {

namespace {

// Distances from the axis of the neck, in halves of its width: the end of the neck, and of the
// shoulders.
constexpr double kNeckSkin = 1.5, kShoulder = 2.6;

}  // namespace

BodyChain body_chain(const Placement& placement) {
  BodyChain chain;
  for (uint32_t b = 0; b < placement.bones.count && chain.count + 1 < BodyChain::kCapacity; ++b) {
    const BoneKind kind = placement.bones[b].kind;
    if (kind == BoneKind::kChest || kind == BoneKind::kNeck) chain.bones[chain.count++] = b;
  }
  chain.bones[chain.count++] = bone_of_kind(placement, BoneKind::kHead, 0);
  return chain;
}

double height_in_neck(const Placement& placement, Vec3 p) {
  const NeckCut& cut = placement.neck_cut;
  const double above = cut.above(p);
  if (!cut.exists || above >= 0) return 1;
  const double low = p.y - cut.base;
  if (low <= 0) return 0;
  const double height = smooth_step(0, 1, low / (low - above));
  const double aside = std::abs(p.x - placement.symmetry_plane);
  return cut.half_width > 0
             ? height * (1 - smooth_step(kNeckSkin, kShoulder, aside / cut.half_width))
             : height;
}

double front_of_neck(const Placement& placement, Vec3 p) {
  const NeckCut& cut = placement.neck_cut;
  if (!cut.exists || !(cut.half_width > 0)) return 0;
  return smooth_step(0, 1, (p.z - cut.z) / cut.half_width + 1);
}

void share_body(const BodyChain& chain, double height, double front,
                double (&shares)[BodyChain::kCapacity]) {
  const uint32_t top = chain.count - 1;
  if (top == 0) {
    shares[0] = 1;
    return;
  }
  const double between = height * (1 - height);
  const uint32_t necks = top - 1;
  shares[0] = 1 - height - (necks > 0 ? between : 0);
  for (uint32_t n = 1; n < top; ++n) shares[n] = (2 - front) * between / necks;
  shares[top] = height - (necks > 0 ? (1 - front) * between : 0);
}

double head_share(const Placement& placement, const BodyChain& chain, Vec3 p) {
  double shares[BodyChain::kCapacity];
  share_body(chain, height_in_neck(placement, p), front_of_neck(placement, p), shares);
  return shares[chain.count - 1];
}

bool balance_head(const AuthorMesh& mesh, Arena& arena, Placement& placement) {
  const NeckCut& cut = placement.neck_cut;
  if (!cut.exists || !(cut.half_width > 0)) return true;
  const BodyChain chain = body_chain(placement);
  const Vec3 head = placement.bones[chain.bones[chain.count - 1]].position;
  Span<Bone> bones;
  Span<double> shares;
  if (!make(arena, placement.bones.count, bones) || !make(arena, mesh.positions.count, shares)) {
    return false;
  }
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    shares[v] = head_share(placement, chain, mesh.positions[v]);
  }
  // How fast the volume between skin and joint changes with a nod about this joint.
  const auto growth = [&](Vec3 joint) {
    const auto nod = [&](uint32_t v) {
      const Vec3 p = mesh.positions[v] - joint;
      return Vec3{0, -p.z, p.y} * shares[v];
    };
    double sum = 0;
    for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
      const uint32_t* c = mesh.triangles.data + t;
      if (!mesh.is_skin[c[0]]) continue;
      const Vec3 p = mesh.positions[c[0]] - joint, q = mesh.positions[c[1]] - joint,
                 r = mesh.positions[c[2]] - joint;
      sum +=
          dot(nod(c[0]), cross(q, r)) + dot(nod(c[1]), cross(r, p)) + dot(nod(c[2]), cross(p, q));
    }
    return sum;
  };
  const double step = cut.half_width / 2;
  const double here = growth(head), there = growth(head + Vec3{0, 0, step});
  if (!(std::abs(there - here) > 0)) return true;
  const double shift = std::min(std::max(step * here / (here - there), -step), step);
  std::copy(placement.bones.begin(), placement.bones.end(), bones.begin());
  // The base of the neck stays.
  const uint32_t first = placement.bones[chain.bones[0]].kind == BoneKind::kChest ? 1 : 0;
  const double links = chain.count - 1 - first;
  for (uint32_t n = first; n < chain.count; ++n) {
    bones[chain.bones[n]].position.z += links > 0 ? shift * (n - first) / links : shift;
  }
  placement.bones = bones;
  return true;
}

}  // namespace mien::author
