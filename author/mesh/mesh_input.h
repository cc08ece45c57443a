// SPDX-License-Identifier: MIT
// From the caller's arrays to a checked AuthorMesh.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"
#include "runtime/base/status.h"

namespace mien::author {

/// An object: a range of faces.
struct ObjectSource {
  Name name;
  uint32_t first_face = 0, face_count = 0;
};

/// Displacements of some vertices of the source; or of all in their order, if `vertices` is empty.
struct ShapeSource {
  Name name;
  Span<const uint32_t> vertices;
  Span<const double> displacements;  // 3 each
};

/// As in MienAuthorMesh of capi/include/mien_author.h, in the caller's frame and unit. Nothing is
/// checked.
struct MeshSource {
  Span<const double> positions;      // 3 each
  Span<const uint32_t> face_sizes;   // corners of each face
  Span<const uint32_t> corners;      // vertices
  Span<const double> uvs;            // 2 each; may be empty
  Span<const uint32_t> corner_uvs;   // empty: no UVs
  Span<const ObjectSource> objects;  // in the order of their faces; empty: one object
  Span<const ShapeSource> shapes;
  Span<const char> skin_object;  // name of the object with the face; empty: chosen automatically
  double unit = 1;               // centimeters
  Frame frame;
};

/// A mesh and where its vertices came from.
struct ReadMesh {
  AuthorMesh mesh;
  Span<const uint32_t> source_vertices;  // per vertex, the number in the source
  uint32_t loose_vertices = 0;  // vertices of the source that are in no face; they are left out
  uint32_t dropped_faces = 0;   // without area or with the same vertex twice
};

/// Checks the arrays and copies them. Vertices without a face are left out; a vertex that two
/// objects use is doubled. Fails with kAuthorMesh or kAuthorRefused.
Status read_mesh(const MeshSource& source, Arena& arena, const Allocator& allocator, ReadMesh& out,
                 Error& error);

}  // namespace mien::author
