// SPDX-License-Identifier: MIT
#include "author/weights/body_weights.h"

#include <algorithm>

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

void share_body(const BodyChain& chain, double height, double (&shares)[BodyChain::kCapacity]) {
  // De Casteljau's steps: each adds a bone on top.
  shares[0] = 1;
  for (uint32_t n = 1; n < chain.count; ++n) {
    shares[n] = shares[n - 1] * height;
    for (uint32_t k = n - 1; k > 0; --k) {
      shares[k] = shares[k] * (1 - height) + shares[k - 1] * height;
    }
    shares[0] *= 1 - height;
  }
}

}  // namespace mien::author
