// SPDX-License-Identifier: MIT
// Weights for LODs that keep some of the bones. All LODs share one joint matrix, so only weights
// can compensate for dropped bones.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// Copies weights over the first `kept` facial bones and all others: the weight of
/// each dropped bone goes to the nearest kept one. `to` may be `from`. False if memory ran out.
bool collapse_weights(const Placement& placement, uint32_t kept, const SkinWeights& from,
                      Arena& scratch, SkinWeights& to);

/// Allocates weights of the same size. False if memory ran out.
bool make_weights_like(const SkinWeights& other, Arena& arena, SkinWeights& out);

}  // namespace mien::author
