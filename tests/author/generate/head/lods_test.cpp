// SPDX-License-Identifier: MIT
// LODs of the generated head: what is left of LOD 0 by collapsing edges.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tests/support/head_lods.h"

namespace mien::head {
namespace {

constexpr Part kCollapsed[] = {Part::kHead, Part::kTeeth, Part::kTongue, Part::kEyeLeft};

std::array<double, 5> key_of(const Vertex& v) {
  return {v.closed.x, v.closed.y, v.closed.z, v.lid, v.depth};
}

TEST(HeadLods, KeepVerticesOfTheFinest) {
  for (const Part part : kCollapsed) {
    const PartLods& lods = head_lods(part);
    std::set<std::array<double, 5>> finer;
    for (const Vertex& v : lods.at[0].vertices.span()) finer.insert(key_of(v));
    for (uint32_t lod = 1; lod < kLodCount; ++lod) {
      const HalfMesh& mesh = lods.at[lod];
      EXPECT_LT(mesh.vertices.count(), lods.at[lod - 1].vertices.count());
      EXPECT_EQ(mesh.mirrored, lods.at[0].mirrored);
      std::set<std::array<double, 5>> here;
      for (const Vertex& v : mesh.vertices.span()) {
        if (part != Part::kEyeLeft) {  // shrinks, or would touch the flat faces of lids
          EXPECT_TRUE(finer.count(key_of(v)));
        }
        here.insert(key_of(v));
      }
      finer = here;
    }
  }
}

/// Both halves together, with the twins of vertices beside the plane after all others.
TEST(HeadLods, AreManifoldsWhenMirrored) {
  for (const Part part : kCollapsed) {
    for (uint32_t lod = 0; lod < kLodCount; ++lod) {
      const HalfMesh& mesh = head_lods(part).at[lod];
      const uint32_t n = mesh.vertices.count();
      std::map<std::array<uint32_t, 2>, int> edges;
      const auto twin = [&](uint32_t v) { return mesh.on_plane(v) ? v : v + n; };
      for (const Face& f : mesh.faces.span()) {
        for (uint32_t i = 0; i < f.count; ++i) {
          const uint32_t a = f.corners[i], b = f.corners[(i + 1) % f.count];
          ++edges[{a, b}];
          if (mesh.mirrored) ++edges[{twin(b), twin(a)}];
        }
      }
      for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1) << static_cast<int>(part) << " LOD " << lod << ": " << edge[0] << " "
                            << edge[1];
      }
    }
  }
}

/// Triangles that look away from the surface of LOD 0 at their corners. There are some where it is bent most.
uint32_t turned_over(const HalfMesh& mesh) {
  uint32_t over = 0;
  for (const Face& f : mesh.faces.span()) {
    for (uint32_t k = 2; k < f.count; ++k) {
      const Vertex &a = mesh.vertices[f.corners[0]], &b = mesh.vertices[f.corners[k - 1]],
                   &c = mesh.vertices[f.corners[k]];
      const Vec3 n = cross(b.position - a.position, c.position - a.position);
      over += dot(n, a.normal + b.normal + c.normal) <= 0;
    }
  }
  return over;
}

TEST(HeadLods, TurnNoTriangleOver) {
  for (const Part part : kCollapsed) {
    const PartLods& lods = head_lods(part);
    const uint32_t at_first = turned_over(lods.at[0]);
    for (uint32_t lod = 1; lod < kLodCount; ++lod) {
      EXPECT_LE(turned_over(lods.at[lod]), at_first) << static_cast<int>(part) << " LOD " << lod;
    }
  }
}

/// Lips, lids, nostrils, the tip of the nose and the ears.
TEST(HeadLods, KeepFeaturesDownToTheCoarsest) {
  double nose_0 = 0, ear_0 = 0;
  for (uint32_t lod = 0; lod < kLodCount; ++lod) {
    const HalfMesh& mesh = head_lods(Part::kHead).at[lod];
    double nose = 0, ear = 0;
    uint32_t lips = 0, lids = 0, nostril = 0;
    for (const Vertex& v : mesh.vertices.span()) {
      const Vec3 p = v.position;
      if (v.edge && v.depth == 0) ++(v.lid != 0 ? lids : lips);
      if (p.x < 0.5 && p.y < -2 && p.y > -5) nose = std::max(nose, p.z);
      // Inside a nostril what is seen is behind what moves it.
      nostril += v.lid == 0 && v.depth == 0 && v.look.z > 6 && p.y > v.look.y + 0.15;
      if (p.y > -4 && p.y < 3) ear = std::max(ear, p.x);
    }
    EXPECT_GE(lips, 8u) << lod;
    EXPECT_GE(lids, 8u) << lod;
    EXPECT_GE(nostril, 1u) << lod;
    if (lod == 0) nose_0 = nose, ear_0 = ear;
    EXPECT_NEAR(nose, nose_0, 0.1) << lod;
    EXPECT_NEAR(ear, ear_0, 0.1) << lod;
  }
}

}  // namespace
}  // namespace mien::head
