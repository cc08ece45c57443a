// SPDX-License-Identifier: MIT
// Which places of a mesh are mirror images of each other.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// Pairs the vertices that are the first at their place, `places[v] == v`, across the plane x = c in the middle of the
/// skin. `mirror` has the partner of each, the vertex itself on the plane, or kNone. Empty if fewer than 19 of 20 have
/// a partner: then the mesh is not symmetric. False if memory ran out.
bool find_mirror(const AuthorMesh& mesh, Span<const uint32_t> places, Arena& arena, Arena& scratch,
                 Span<uint32_t>& mirror);

}  // namespace mien::author
