// SPDX-License-Identifier: MIT
#include "author/mesh/own_lods.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/support/counting_allocator.h"
#include "tests/support/mesh_source.h"

namespace mien::author {
namespace {

/// Two boxes of two objects, the second one on top; the vertices where they touch are of both.
/// Each side is a quad, with a square of its own in the texture.
struct Boxes {
  TestMesh mesh;
  std::vector<double> uvs;
  std::vector<uint32_t> corner_uvs;

  Boxes() {
    mesh.vertex(50, 50, 50);  // in no face: numbers of the source are not those of the mesh
    for (int y = 0; y < 3; ++y) {
      for (int i = 0; i < 4; ++i) mesh.vertex(i % 2, y, i / 2);
    }
    for (uint32_t box = 0; box < 2; ++box) {
      const uint32_t o = 1 + 4 * box;
      const uint32_t sides[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                    {1, 5, 7, 3}, {3, 7, 6, 2}, {2, 6, 4, 0}};
      for (const auto& side : sides) {
        mesh.face({o + side[0], o + side[1], o + side[2], o + side[3]});
        const double u = static_cast<double>(corner_uvs.size());
        uvs.insert(uvs.end(), {u, 0, u + 1, 0, u + 1, 1, u, 1});
        for (int k = 0; k < 4; ++k) corner_uvs.push_back(static_cast<uint32_t>(corner_uvs.size()));
      }
      mesh.objects.push_back({box ? Name{"above", 5} : Name{"below", 5}, 6 * box, 6});
    }
  }
  MeshSource source() {
    MeshSource out = mesh.source();
    out.uvs = {uvs.data(), uvs.size()};
    out.corner_uvs = {corner_uvs.data(), corner_uvs.size()};
    return out;
  }
};

struct Taken {
  Arena arena{default_allocator()};
  ReadMesh read;
  Span<LodMesh> lods;
  Error error;
  Status status;

  Taken(const MeshSource& source, const std::vector<LodSource>& given) {
    status = read_mesh(source, arena, default_allocator(), read, error);
    EXPECT_EQ(status, Status::kOk) << error.message;
    status = take_lod_meshes(source, read, {given.data(), given.size()}, arena, default_allocator(),
                             lods, error);
  }
  std::string why() const { return error.message; }
};

LodSource lod_of(const std::vector<uint32_t>& corners) {
  LodSource out;
  out.corners = {corners.data(), corners.size()};
  return out;
}

TEST(OwnLods, TrianglesAreThoseOfTheCallerObjectByObject) {
  Boxes boxes;
  const std::vector<uint32_t> mixed = {9, 10, 11, 1, 2, 3, 5, 7, 6, 10, 12, 11};
  const Taken taken(boxes.source(), {lod_of(mixed)});
  ASSERT_EQ(taken.status, Status::kOk) << taken.why();
  ASSERT_EQ(taken.lods.count, 2u);
  const AuthorMesh& mesh = taken.lods[1].mesh;
  ASSERT_EQ(mesh.parts.count, 2u);
  EXPECT_EQ(mesh.parts[0].face_count, 2u) << "both have 5, 6 and 7: the first one takes them";
  EXPECT_EQ(mesh.parts[1].first_face, 2u);
  EXPECT_EQ(mesh.parts[1].face_count, 2u);
  const std::vector<uint32_t> expected = {1, 2, 3, 5, 7, 6, 9, 10, 11, 10, 12, 11};
  ASSERT_EQ(mesh.corners.count, expected.size());
  ASSERT_EQ(mesh.triangles.count, expected.size());
  for (size_t c = 0; c < expected.size(); ++c) {
    const uint32_t vertex = taken.lods[1].vertices[mesh.corners[c]];
    EXPECT_EQ(taken.read.source_vertices[vertex], expected[c]) << c;
    EXPECT_EQ(mesh.triangles[c], mesh.corners[c]);
    const Vec3 p = mesh.positions[mesh.corners[c]], q = taken.read.mesh.positions[vertex];
    EXPECT_EQ(p.x, q.x);
    EXPECT_EQ(p.y, q.y);
    EXPECT_EQ(p.z, q.z);
  }
  for (size_t f = 0; f < mesh.face_starts.count; ++f) EXPECT_EQ(mesh.face_starts[f], 3 * f);
  EXPECT_EQ(mesh.parts[0].vertex_count, 6u);
  EXPECT_EQ(mesh.parts[1].first_vertex, 6u);
  EXPECT_EQ(mesh.parts[1].vertex_count, 4u);
}

TEST(OwnLods, ObjectsWithoutTrianglesAreEmpty) {
  Boxes boxes;
  const std::vector<uint32_t> above = {9, 10, 11};
  const Taken taken(boxes.source(), {lod_of(above)});
  ASSERT_EQ(taken.status, Status::kOk) << taken.why();
  EXPECT_EQ(taken.lods[1].mesh.parts[0].face_count, 0u);
  EXPECT_EQ(taken.lods[1].mesh.parts[0].vertex_count, 0u);
  EXPECT_EQ(taken.lods[1].mesh.parts[1].vertex_count, 3u);
}

TEST(OwnLods, DistancesAreThoseToTheSurfaceThatIsLeft) {
  Boxes boxes;
  // The floor: the middle is 1 above it, the top 2.
  const std::vector<uint32_t> floor = {1, 2, 4, 1, 4, 3};
  const Taken taken(boxes.source(), {lod_of(floor)});
  ASSERT_EQ(taken.status, Status::kOk) << taken.why();
  EXPECT_DOUBLE_EQ(taken.lods[1].max, 2);
  EXPECT_NEAR(taken.lods[1].rms, std::sqrt((4 * 1.0 + 4 * 4.0) / 12), 1e-12);
}

TEST(OwnLods, TextureCoordinatesOfATriangleAreOfOneChart) {
  Boxes boxes;
  const std::vector<uint32_t> front = {1, 5, 6, 2, 6, 8};  // of the third and fourth side
  const Taken taken(boxes.source(), {lod_of(front)});
  ASSERT_EQ(taken.status, Status::kOk) << taken.why();
  const AuthorMesh& mesh = taken.lods[1].mesh;
  const uint32_t expected[] = {8, 9, 10, 12, 13, 14};
  ASSERT_EQ(mesh.corner_uvs.count, 6u);
  for (size_t c = 0; c < 6; ++c) EXPECT_EQ(mesh.corner_uvs[c], expected[c]) << c;

  const std::vector<uint32_t> own = {3, 0, 47, 1, 2, 3};
  LodSource with_uvs = lod_of(front);
  with_uvs.corner_uvs = {own.data(), own.size()};
  const Taken given(boxes.source(), {with_uvs});
  ASSERT_EQ(given.status, Status::kOk) << given.why();
  for (size_t c = 0; c < 6; ++c) EXPECT_EQ(given.lods[1].mesh.corner_uvs[c], own[c]) << c;
}

TEST(OwnLods, NamesWhatIsWrong) {
  Boxes boxes;
  const std::vector<uint32_t> good = {1, 2, 3};
  const auto refused = [&](const std::vector<uint32_t>& corners, const char* words,
                           const std::vector<uint32_t>& uvs = {}) {
    LodSource lod = lod_of(corners);
    lod.corner_uvs = {uvs.data(), uvs.size()};
    const Taken taken(boxes.source(), {lod_of(good), lod});
    EXPECT_EQ(taken.status, Status::kAuthorMesh) << words;
    EXPECT_NE(taken.why().find(words), std::string::npos) << words << ": " << taken.why();
  };
  refused({}, "LOD 2 has 0 corners");
  refused({1, 2, 3, 4}, "LOD 2 has 4 corners");
  refused({1, 2, 3, 1, 2, 13}, "corner 5 of LOD 2 names position 13, but there are 13");
  refused({1, 2, ~0u}, "corner 2 of LOD 2 names position 4294967295");
  refused({1, 2, 0}, "corner 2 of LOD 2 names position 0, which is in no face");
  refused({1, 2, 3, 2, 4, 2}, "triangle 1 of LOD 2 has position 2 twice");
  refused({1, 5, 9}, "triangle 0 of LOD 2 has positions 1, 5 and 9: no object has all three");
  refused({1, 2, 3}, "corner 1 of LOD 2 names UV 48, but there are 48", {1, 48, 1});
  refused({1, 2, 3}, "LOD 2 has 3 corners, but UVs for 2", {1, 1});
  boxes.uvs.clear();
  boxes.corner_uvs.clear();
  refused({1, 2, 3}, "the mesh has none", {0, 0, 0});
}

TEST(OwnLods, MemoryMayRunOutAnywhere) {
  Boxes boxes;
  const MeshSource source = boxes.source();
  const std::vector<uint32_t> corners = {1, 2, 3, 9, 10, 11};
  const LodSource lods[] = {lod_of(corners), lod_of(corners)};
  Arena for_read(default_allocator());
  ReadMesh read;
  Error error;
  ASSERT_EQ(read_mesh(source, for_read, default_allocator(), read, error), Status::kOk);
  for (size_t fail_at = 1; fail_at < 100; ++fail_at) {
    CountingAllocator counting;
    counting.fail_at = fail_at;
    const MienAllocator given = counting.get();
    const Allocator allocator = {given.user, given.allocate, given.release};
    Status status;
    {
      Arena arena(allocator);
      Span<LodMesh> out;
      status = take_lod_meshes(source, read, {lods, 2}, arena, allocator, out, error);
    }
    EXPECT_TRUE(counting.clean()) << fail_at << " " << counting.first_wrong;
    EXPECT_EQ(status, counting.failed ? Status::kMemory : Status::kOk) << fail_at;
    if (status == Status::kOk) {
      EXPECT_GT(fail_at, 5u);
      return;
    }
  }
  ADD_FAILURE() << "it never ended";
}

}  // namespace
}  // namespace mien::author
