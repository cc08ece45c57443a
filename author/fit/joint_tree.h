// SPDX-License-Identifier: MIT
// Finds the facial bones that belong below the jaw: those that move with it in the shape that opens it.
#pragma once

#include "author/base/joint_motion.h"
#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// The smallest share of the jaw's motion in which a bone below it takes part.
constexpr double kWithJaw = 0.5;

/// Hangs facial bones below the jaw: those whose skin, by `weights`, takes at least kWithJaw of the
/// jaw's rigid motion `opened` when `shape` is at 1. A bone and its mirror image hang below the same
/// one. `placement` gets a new list of bones in `arena`; one without a jaw stays as it is. False if
/// memory ran out.
bool hang_on_jaw(const AuthorMesh& mesh, const Shape& shape, const Affine& opened,
                 const SkinWeights& weights, Arena& arena, Placement& placement);

}  // namespace mien::author
