// SPDX-License-Identifier: MIT
// A mesh with its LODs, and what tests measure on them.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "author/mesh/simplify.h"
#include "tests/support/mesh_source.h"

namespace mien::author {

struct Lods {
  Arena arena{default_allocator()};
  ReadMesh read;
  Span<LodMesh> lods;

  explicit Lods(TestMesh mesh, double share = 0.5, uint32_t count = 5,
                const std::vector<double>& uvs = {}, const std::vector<uint32_t>& corner_uvs = {}) {
    MeshSource source = mesh.source();
    source.uvs = {uvs.data(), uvs.size()};
    source.corner_uvs = {corner_uvs.data(), corner_uvs.size()};
    Error error;
    EXPECT_EQ(read_mesh(source, arena, default_allocator(), read, error), Status::kOk)
        << error.message;
    SimplifyOptions options;
    options.share = share;
    options.lods = count;
    EXPECT_TRUE(make_lod_meshes(read.mesh, options, arena, default_allocator(), lods));
  }
  const AuthorMesh& at(size_t lod) const { return lods[lod].mesh; }
  size_t triangles(size_t lod) const { return at(lod).triangles.count / 3; }
};

/// How many triangles run along each edge, in its direction.
inline std::map<std::pair<uint32_t, uint32_t>, int> edges_of(const AuthorMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (size_t c = 0; c < mesh.triangles.count; ++c) {
    const size_t next = c % 3 == 2 ? c - 2 : c + 1;
    ++edges[{mesh.welded[mesh.triangles[c]], mesh.welded[mesh.triangles[next]]}];
  }
  return edges;
}

/// The share of the vertices of a LOD that have no mirror image in it across x = 0.
inline double without_mirror(const AuthorMesh& mesh) {
  size_t alone = 0;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    const Vec3 p = mesh.positions[v];
    bool found = false;
    for (uint32_t w = 0; w < mesh.positions.count && !found; ++w) {
      found = length(mesh.positions[w] - Vec3{-p.x, p.y, p.z}) < 1e-6;
    }
    alone += !found;
  }
  return static_cast<double>(alone) / static_cast<double>(mesh.positions.count);
}

}  // namespace mien::author
