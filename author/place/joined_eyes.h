// SPDX-License-Identifier: MIT
// Eyeballs that are connected with the skin or with each other, as in meshes whose parts were merged.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// Makes a component of its own of every part of a larger component that covers much of a sphere of the size of
/// an eye, so that it is an eyeball like any other. Places where it is joined to the rest stay with the rest.
/// The new arrays are in `arena`. False if memory ran out.
bool separate_eyeballs(AuthorMesh& mesh, Arena& arena, const Allocator& allocator);

}  // namespace mien::author
