// SPDX-License-Identifier: MIT
// The mesh of a further LOD: triangles over a subset of the vertices of LOD 0.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

struct LodMesh {
  AuthorMesh mesh;                // without shapes; texture coordinates are those of LOD 0
  Span<const uint32_t> vertices;  // of LOD 0, ascending; empty: all of them
  double rms = 0, max = 0;        // distances of the vertices of LOD 0 to the surface
};

/// The triangles of a LOD, part after part.
struct LodTriangles {
  Span<const uint32_t> corners;     // vertices of LOD 0, 3 each
  Span<const uint32_t> corner_uvs;  // one for each of `corners`; empty: no UVs
  Span<const uint32_t> starts;      // parts + 1: where in `corners` each part begins
  Span<const uint8_t>
      whole_parts;  // of parts without triangles, which keep all faces of LOD 0; empty: none
};

/// The mesh of these triangles, which are of `whole`. False if memory ran out.
bool make_lod_mesh(const AuthorMesh& whole, const LodTriangles& triangles, Arena& arena,
                   const Allocator& allocator, LodMesh& out);

}  // namespace mien::author
