// SPDX-License-Identifier: MIT
// Meshes with fewer triangles: edges collapse onto one of their ends, those first that change the surface
// least (M. Garland, P. S. Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997), at rest
// and in some of the expressions together (A. Mohr, M. Gleicher, "Deformation Sensitive Decimation", 2003).
// The remaining vertices are a subset, at unchanged positions.
#pragma once

#include "author/mesh/lod_mesh.h"

namespace mien::author {

struct SimplifyOptions {
  double share = 0.5;      // of the triangles that each LOD keeps of the one before
  uint32_t lods = 1;       // with LOD 0, which keeps all
  uint32_t max_poses = 8;  // expressions that count beside the mesh at rest
};

/// The mesh at each LOD. LOD 0 is `mesh`; further ones have triangles only, and the vertices of each are
/// among those of the one before. Borders and texture seams collapse only along themselves, no triangle
/// flips, an edge of two triangles stays one, and every component keeps its share, but at least eight
/// triangles. Borders of the skin, such as lips and lids, keep ten vertices where they bend, moving the
/// outline that the mesh has from the front or the side costs more, and symmetric meshes stay symmetric.
/// Teeth, lashes and other small components that are not round are removed as a whole if fewer than twelve
/// triangles would be left. A LOD has more triangles than asked for if no more can be removed. False if
/// memory ran out.
bool make_lod_meshes(const AuthorMesh& mesh, const SimplifyOptions& options, Arena& arena,
                     const Allocator& allocator, Span<LodMesh>& out);

/// The displacements of some vertices of each shape. False if memory ran out.
bool take_shapes(Span<const Shape> shapes, Span<const uint32_t> vertices, Arena& arena,
                 Span<const Shape>& out);

}  // namespace mien::author
