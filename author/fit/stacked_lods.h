// SPDX-License-Identifier: MIT
// All LODs share one joint matrix. Motions fitted to the vertices of LOD 0 alone suit small
// footprints; the few bones of a coarse LOD would move the whole face badly with them. So the
// vertices of every LOD, with their weights there, are rows of one least squares problem.
#pragma once

#include "author/fit/targets.h"

namespace mien::author {

/// A LOD while its weights are fitted, and as it is written.
struct FittedLod {
  AuthorMesh mesh;                // its vertices with their displacements
  Span<const uint32_t> vertices;  // of LOD 0; empty: all of them
  SkinWeights weights;            // of its vertices
  Span<const Target> targets;     // by control; empty: none
};

struct StackedLods {
  Span<uint32_t> rows;      // vertices of their LOD, LOD after LOD
  Span<uint32_t> starts;    // LODs + 1, into `rows`
  Span<Vec3> positions;     // of each row
  Span<uint32_t> vertices;  // of LOD 0, of each row
  Span<double> scales;      // of each row
  SkinWeights weights;      // of each row, times its scale
};

/// Rows are all vertices of LOD 0, and at most about a quarter as many of each other LOD. False if
/// memory ran out.
bool stack_lods(Span<const FittedLod> lods, Arena& arena, StackedLods& out);

/// Copies the current weights of the LODs.
void fill_weights(Span<const FittedLod> lods, const StackedLods& out);

}  // namespace mien::author
