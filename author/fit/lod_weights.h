// SPDX-License-Identifier: MIT
// Weights for LODs that keep some of the bones. All LODs share one joint matrix, so only weights can
// make up for bones that are gone.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// Copies weights over the first `kept` facial bones and all others: each dropped bone hands its
/// weight to the nearest one that is kept. `to` may be `from`. False if memory ran out.
bool collapse_weights(const Placement& placement, uint32_t kept, const SkinWeights& from,
                      Arena& scratch, SkinWeights& to);

/// Memory for weights of the same size. False if it ran out.
bool make_weights_like(const SkinWeights& other, Arena& arena, SkinWeights& out);

}  // namespace mien::author
