// SPDX-License-Identifier: MIT
// Operations on skin weights.
#pragma once

#include "author/document/document.h"

namespace mien::author {

// All begin with the checks of a file, fail with kIndex if there is no such mesh, and set
// maximumInfluencePerVertex to the largest number of influences where that changes.

/// The weights of all `positions` vertices: `influences` joints and weights for each, of which those with
/// weight 0 are left out. kInvalidArgument unless weights are finite and not below 0, joints exist, and
/// no vertex has a joint twice or no weight.
Status set_skin_weights(Document& document, uint32_t mesh, const uint16_t* joints,
                        const float* weights, size_t positions, uint32_t influences, Error& error);

/// Scales the weights of each vertex to a sum of 1. Sums within 1e-6 of 1 do not change.
Status normalize_skin_weights(Document& document, uint32_t mesh, Error& error);

/// Keeps the `influences` largest weights of each vertex that has more (of equal ones the first), in their
/// order, and scales them to the previous sum.
Status limit_influences(Document& document, uint32_t mesh, uint32_t influences, Error& error);

/// `iterations` times: the weights of each vertex become (1 - strength) of its own plus strength of the
/// mean of its neighbors along edges of faces. Vertices at the same place count as one. Keeps at most
/// `influences` weights per vertex, with a sum of 1.
Status smooth_skin_weights(Document& document, uint32_t mesh, uint32_t iterations, float strength,
                           uint32_t influences, Error& error);

}  // namespace mien::author
