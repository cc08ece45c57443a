// SPDX-License-Identifier: MIT
// Meshes of further LODs that are the caller's.
#pragma once

#include "author/mesh/lod_mesh.h"
#include "author/mesh/mesh_input.h"

namespace mien::author {

/// The triangles of a LOD, in numbers of the source.
struct LodSource {
  Span<const uint32_t> corners;     // positions, 3 each
  Span<const uint32_t> corner_uvs;  // empty: found
};

/// The mesh at each LOD: LOD 0 is that of `read`, `lods[0]` is LOD 1, and so on. Objects without
/// triangles are not in the LOD. A triangle whose corners are in several objects belongs to the first
/// of these. Fails with kAuthorMesh for what is no triangle of one object.
Status take_lod_meshes(const MeshSource& source, const ReadMesh& read, Span<const LodSource> lods,
                       Arena& arena, const Allocator& allocator, Span<LodMesh>& out, Error& error);

}  // namespace mien::author
