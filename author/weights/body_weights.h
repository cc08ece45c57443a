// SPDX-License-Identifier: MIT
// How head, neck and chest share a place, before shapes are considered. Facial bones take their
// weights from the share of the head, so a turning head moves no more than this, whatever the fit
// does.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// From the chest up to the head. Without a chest or neck bones the chain is shorter.
struct BodyChain {
  static constexpr uint32_t kCapacity = 6;
  uint32_t bones[kCapacity];
  uint32_t count = 0;  // at least 1
};
BodyChain body_chain(const Placement& placement);

/// 0 at the chest and below, 1 in the head. By height above the base of the neck, and by distance
/// from its axis: shoulders do not count as neck, however high they are.
double height_in_neck(const Placement& placement, Vec3 p);

/// 0 from the middle of the neck backward, 1 at the throat.
double front_of_neck(const Placement& placement, Vec3 p);

/// Shares of the chain's bones at a height in the neck, which sum to 1. Weights and slopes of all but the chest are 0
/// at the base, and each joint bends the whole neck. The share of the head grows with the square of the height, which
/// keeps the volume of a neck that turns; in front with the height itself, so that the skin below the chin does not
/// fold when the head nods.
void share_body(const BodyChain& chain, double height, double front,
                double (&shares)[BodyChain::kCapacity]);

/// The share of the head at the place.
double head_share(const Placement& placement, const BodyChain& chain, Vec3 p);

/// Moves the joint of the head to the front or the back, and joints of the neck with it, so that the neck neither
/// grows nor shrinks when the head begins to nod. `placement` gets a new list of bones in `arena`. False if memory
/// ran out.
bool balance_head(const AuthorMesh& mesh, Arena& arena, Placement& placement);

}  // namespace mien::author
