// SPDX-License-Identifier: MIT
// An expression that opens the jaw, for meshes that have a mouth but no shape that opens it.
#pragma once

#include "author/place/place.h"

namespace mien::author {

/// Adds jawOpen, or MetaHuman's control of that name, to a mesh whose jaw was placed by landmarks: everything
/// below the jaw turns with it, by `weights`. `mesh` gets a new list of shapes in `arena`, other meshes stay as they
/// are. False if memory ran out.
bool add_jaw_shape(const Placement& placement, const SkinWeights& weights, bool metahuman_names,
                   Arena& arena, AuthorMesh& mesh, PlaceReport& report);

}  // namespace mien::author
