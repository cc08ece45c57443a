// SPDX-License-Identifier: MIT
// Meshes that the caller supplies for the other LODs.
#pragma once

#include "author/mesh/lod_mesh.h"
#include "author/mesh/mesh_input.h"

namespace mien::author {

/// The triangles of a LOD, as indices into the source.
struct LodSource {
  Span<const uint32_t> corners;     // positions, 3 each
  Span<const uint32_t> corner_uvs;  // empty: taken from LOD 0
};

/// The mesh at each LOD: LOD 0 is that of `read`, `lods[0]` is LOD 1, and so on. Objects without
/// triangles are not in the LOD. A triangle whose corners are in several objects belongs to the
/// first of these. Fails with kAuthorMesh if the corners of a triangle have no object in common.
Status take_lod_meshes(const MeshSource& source, const ReadMesh& read, Span<const LodSource> lods,
                       Arena& arena, const Allocator& allocator, Span<LodMesh>& out, Error& error);

}  // namespace mien::author
