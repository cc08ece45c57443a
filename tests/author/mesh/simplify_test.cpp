// SPDX-License-Identifier: MIT
#include "author/mesh/simplify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "author/mesh/surface_tree.h"
#include "tests/support/simplified_mesh.h"

namespace mien::author {
namespace {

Vec3 normal_of(const AuthorMesh& mesh, size_t triangle) {
  const uint32_t* c = &mesh.triangles[3 * triangle];
  const Vec3 a = mesh.positions[c[0]];
  return cross(mesh.positions[c[1]] - a, mesh.positions[c[2]] - a);
}

/// A box without a lid, from 0 to 1, of `n` times `n` quads on each of its five sides. Sides share the
/// vertices of their edges.
struct OpenBox {
  TestMesh mesh;
  std::vector<double> uvs;
  std::vector<uint32_t> corner_uvs;
  std::map<std::array<int, 3>, uint32_t> vertices;

  explicit OpenBox(int n) {
    const auto at = [&](int x, int y, int z) {
      const auto [it, added] = vertices.emplace(std::array<int, 3>{x, y, z}, 0);
      if (added) it->second = mesh.vertex(double(x) / n, double(y) / n, double(z) / n);
      return it->second;
    };
    for (int side = 0; side < 5; ++side) {
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          std::vector<uint32_t> face;
          constexpr int kAround[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
          for (int corner = 0; corner < 4; ++corner) {
            const auto& step = kAround[side < 3 ? 3 - corner : corner];  // outward
            const int a = i + step[0], b = k + step[1];
            face.push_back(side == 0   ? at(b, 0, a)
                           : side == 1 ? at(0, a, b)
                           : side == 2 ? at(n, b, a)
                           : side == 3 ? at(b, a, 0)
                                       : at(a, b, n));
            // Each side has a square of its own, and each corner a coordinate of its own.
            uvs.insert(uvs.end(), {2.0 * side + double(a) / n, double(b) / n});
            corner_uvs.push_back(static_cast<uint32_t>(corner_uvs.size()));
          }
          mesh.face(face);
        }
      }
    }
  }
};

TEST(Simplify, EachLodKeepsItsShareOfTheTriangles) {
  const Lods made(procedural_mesh(4, true), 0.5, 5);
  const double all = static_cast<double>(made.triangles(0));
  for (size_t lod = 1; lod < 5; ++lod) {
    EXPECT_NEAR(made.triangles(lod), all * std::pow(0.5, lod), 2) << lod;
    EXPECT_EQ(made.at(lod).face_starts.count, made.triangles(lod) + 1);
    EXPECT_GE(made.lods[lod].rms, made.lods[lod - 1].rms);
    EXPECT_LT(made.lods[lod].rms, 0.01 * made.at(0).diagonal);
    EXPECT_LT(made.lods[lod].max, 0.06 * made.at(0).diagonal);
  }
}

TEST(Simplify, AShareOfOneKeepsAll) {
  const Lods made(procedural_mesh(5, false), 1, 3);
  for (const LodMesh& lod : made.lods) {
    EXPECT_TRUE(lod.vertices.empty());
    EXPECT_EQ(lod.mesh.triangles.count, made.at(0).triangles.count);
    EXPECT_EQ(lod.max, 0);
  }
}

TEST(Simplify, VerticesOfALodAreAmongThoseOfTheLodBefore) {
  const Lods made(procedural_mesh(4, true));
  for (size_t l = 1; l < made.lods.count; ++l) {
    const LodMesh& lod = made.lods[l];
    ASSERT_EQ(lod.mesh.positions.count, lod.vertices.count);
    std::set<uint32_t> before;
    if (l > 1) {
      before.insert(made.lods[l - 1].vertices.begin(), made.lods[l - 1].vertices.end());
    }
    std::vector<uint8_t> used(lod.vertices.count);
    for (const uint32_t v : lod.mesh.corners) used[v] = 1;
    for (size_t v = 0; v < lod.vertices.count; ++v) {
      const Vec3 from = made.at(0).positions[lod.vertices[v]], to = lod.mesh.positions[v];
      EXPECT_TRUE(is_zero(from - to));
      EXPECT_TRUE(v == 0 || lod.vertices[v] > lod.vertices[v - 1]);
      EXPECT_TRUE(l == 1 || before.count(lod.vertices[v]));
      EXPECT_TRUE(used[v]) << "a vertex in no face";
    }
  }
}

TEST(Simplify, ASphereStaysClosedAndFacesOutward) {
  TestMesh sphere;
  add_sphere(sphere, 1, 2, 3, 2, 48, 64);
  const Lods made(sphere, 0.4);
  for (size_t lod = 1; lod < made.lods.count; ++lod) {
    const AuthorMesh& mesh = made.at(lod);
    for (size_t t = 0; t < made.triangles(lod); ++t) {
      const Vec3 out = mesh.positions[mesh.triangles[3 * t]] - Vec3{1, 2, 3};
      EXPECT_GT(dot(normal_of(mesh, t), out), 0) << lod;
    }
    const auto edges = edges_of(mesh);
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << "a hole";
    }
    EXPECT_EQ(mesh.positions.count, made.triangles(lod) / 2 + 2) << "not a sphere any more";
  }
  EXPECT_NEAR(made.triangles(4), made.triangles(0) * std::pow(0.4, 4), 2);
}

TEST(Simplify, NoTriangleOfAHeadTurnsOver) {
  const Lods made(procedural_mesh(4, true), 0.5, 4);
  for (size_t lod = 1; lod < made.lods.count; ++lod) {
    const AuthorMesh& mesh = made.at(lod);
    std::vector<Vec3> normals(made.at(0).positions.count);
    for (size_t t = 0; t < made.triangles(0); ++t) {
      for (int k = 0; k < 3; ++k) {
        Vec3& n = normals[made.at(0).triangles[3 * t + static_cast<size_t>(k)]];
        n = n + normal_of(made.at(0), t);
      }
    }
    size_t turned = 0;
    for (size_t t = 0; t < made.triangles(lod); ++t) {
      Vec3 sum;
      for (int k = 0; k < 3; ++k) {
        sum = sum +
              normalized(
                  normals[made.lods[lod].vertices[mesh.triangles[3 * t + static_cast<size_t>(k)]]]);
      }
      turned += dot(normal_of(mesh, t), sum) <= 0;
    }
    // Inside folds, as nostrils, normals of vertices tell little.
    EXPECT_LE(turned, made.triangles(lod) / 25) << lod;
    for (const auto& edge : edges_of(mesh)) EXPECT_EQ(edge.second, 1);
  }
}

TEST(Simplify, BordersAndEdgesOfABoxStay) {
  const OpenBox box(16);
  const Lods made(box.mesh, 0.25, 4);
  for (size_t lod = 1; lod < made.lods.count; ++lod) {
    double area = 0;
    for (size_t t = 0; t < made.triangles(lod); ++t)
      area += 0.5 * length(normal_of(made.at(lod), t));
    EXPECT_NEAR(area, 5, 1e-9) << lod;
    EXPECT_NEAR(made.lods[lod].max, 0, 1e-9);
  }
  EXPECT_LE(made.triangles(3), 42u);
}

TEST(Simplify, TextureCoordinatesStayInTheirCharts) {
  const OpenBox box(16);
  const Lods made(box.mesh, 0.25, 4, box.uvs, box.corner_uvs);
  EXPECT_LE(made.triangles(3), 60u) << "coordinates of one value are one, whatever their numbers";
  for (size_t lod = 1; lod < made.lods.count; ++lod) {
    const AuthorMesh& mesh = made.at(lod);
    for (size_t t = 0; t < made.triangles(lod); ++t) {
      std::set<int> sides;
      for (size_t c = 3 * t; c < 3 * t + 3; ++c) {
        const Uv uv = mesh.uvs[mesh.corner_uvs[c]];
        const int side = static_cast<int>(uv.u / 2);
        const double a = double{uv.u} - 2 * side, b = double{uv.v};
        sides.insert(side);
        const Vec3 expected = side == 0   ? Vec3{b, 0, a}
                              : side == 1 ? Vec3{0, a, b}
                              : side == 2 ? Vec3{1, b, a}
                              : side == 3 ? Vec3{b, a, 0}
                                          : Vec3{a, b, 1};
        EXPECT_LT(length(mesh.positions[mesh.corners[c]] - expected), 1e-6);
      }
      EXPECT_EQ(sides.size(), 1u) << "a triangle across charts";
    }
  }
}

TEST(Simplify, EveryComponentKeepsTriangles) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 10, 40, 60);
  for (int i = 0; i < 6; ++i) add_sphere(mesh, 20.0 + 3 * i, 0, 0, 0.1, 6, 8);
  const Lods made(mesh, 0.3, 6);
  for (size_t lod = 1; lod < made.lods.count; ++lod) {
    std::map<uint32_t, size_t> counts;
    for (size_t t = 0; t < made.triangles(lod); ++t) {
      ++counts[made.at(lod).component[made.at(lod).triangles[3 * t]]];
    }
    EXPECT_EQ(counts.size(), 7u);
    for (const auto& [component, count] : counts) EXPECT_GE(count, 8u) << component;
  }
}

TEST(Simplify, ShellsThatTouchDoNotHoldEachOther) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 1, 24, 32);
  add_sphere(mesh, 0, 0, 0, 1, 24, 32);
  const Lods made(mesh, 0.5, 5);
  EXPECT_NEAR(made.triangles(4), made.triangles(0) / 16.0, 2);
}

TEST(Simplify, CopiesOfVerticesAlongSeamsStayTogether) {
  // A tube whose first and last column are at one place.
  TestMesh mesh;
  for (uint32_t r = 0; r <= 20; ++r) {
    for (uint32_t c = 0; c <= 32; ++c) {
      const double turn = c == 32 ? 0 : 2 * 3.14159265358979 * c / 32;
      mesh.vertex(std::cos(turn), 0.2 * r, std::sin(turn));
    }
  }
  for (uint32_t r = 0; r < 20; ++r) {
    for (uint32_t c = 0; c < 32; ++c) {
      const uint32_t v = r * 33 + c;
      mesh.face({v, v + 33, v + 34, v + 1});
    }
  }
  const Lods made(mesh, 0.4, 4);
  for (size_t lod = 0; lod < made.lods.count; ++lod) {
    const auto edges = edges_of(made.at(lod));
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      if (edges.count({edge.second, edge.first})) continue;
      const double y = made.at(lod).positions[edge.first].y;
      EXPECT_TRUE(y < 1e-9 || y > 4 - 1e-9) << "a gap at " << y;
    }
  }
}

TEST(Simplify, FollowsExpressionsToo) {
  TestMesh plain;
  add_sphere(plain, 0, 0, 0, 1, 40, 60);
  TestMesh bent = plain;
  bent.shape_names = {"crease"};
  bent.displacements.resize(1);
  for (size_t v = 0; v < plain.positions.size(); v += 3) {
    const double y = plain.positions[v + 1];
    bent.displacements[0].insert(bent.displacements[0].end(),
                                 {0, 0, std::max(0.0, 0.5 - 2 * std::abs(y))});
  }
  const auto at = [&](uint32_t v) {
    const double* p = &plain.positions[3 * v];
    return Vec3{p[0], p[1], p[2] + bent.displacements[0][3 * v + 2]};
  };
  // How far the crease, or all of it, is from the surface that is left, where both are posed.
  const auto error = [&](const Lods& made, bool only_crease) {
    const LodMesh& lod = made.lods[3];
    std::vector<Vec3> posed;
    for (const uint32_t v : lod.vertices) posed.push_back(at(v));
    Arena arena{default_allocator()};
    SurfaceTree tree;
    EXPECT_TRUE(tree.build({posed.data(), posed.size()}, lod.mesh.triangles, arena));
    double squares = 0;
    for (uint32_t v = 0; v < plain.positions.size() / 3; ++v) {
      if (only_crease && bent.displacements[0][3 * v + 2] == 0) continue;
      squares += std::pow(tree.distance(at(v)), 2);
    }
    return std::sqrt(squares);
  };
  const Lods with(bent, 0.5, 4), without(plain, 0.5, 4);
  printf("crease %.3f of the error without, all %.3f\n", error(with, true) / error(without, true),
         error(with, false) / error(without, false));
  EXPECT_LT(error(with, true), 0.18 * error(without, true));
  EXPECT_LT(error(with, false), 0.65 * error(without, false));
}

/// A ball whose front opens along a slit that is no border, as the lips of skin that goes on into the mouth do.
TEST(Simplify, LipsAndLidsWithoutABorderStay) {
  TestMesh plain;
  add_sphere(plain, 0, 0, 0, 1, 60, 90);
  TestMesh opening = plain;
  opening.shape_names = {"open"};
  opening.displacements.resize(1);
  std::vector<uint32_t> lips;
  for (uint32_t v = 0; v < plain.positions.size() / 3; ++v) {
    const double* p = &plain.positions[3 * v];
    const double wide = std::max(0.0, 1 - p[0] * p[0] / 0.16);
    const bool near = p[2] > 0 && std::abs(p[1]) < 0.3;
    const double up = near ? 0.3 * wide * (1 - std::abs(p[1]) / 0.3) : 0;
    opening.displacements[0].insert(opening.displacements[0].end(), {0, p[1] < 0 ? -up : up, 0});
    if (up > 0.15) lips.push_back(v);
  }
  ASSERT_GT(lips.size(), 20u);
  const auto error = [&](const Lods& made, size_t l) {
    const LodMesh& lod = made.lods[l];
    const auto at = [&](uint32_t v) {
      const double* p = &plain.positions[3 * v];
      return Vec3{p[0], p[1] + opening.displacements[0][3 * v + 1], p[2]};
    };
    std::vector<Vec3> posed;
    for (const uint32_t v : lod.vertices) posed.push_back(at(v));
    Arena arena{default_allocator()};
    SurfaceTree tree;
    EXPECT_TRUE(tree.build({posed.data(), posed.size()}, lod.mesh.triangles, arena));
    double squares = 0;
    for (const uint32_t v : lips) squares += std::pow(tree.distance(at(v)), 2);
    return std::sqrt(squares / static_cast<double>(lips.size()));
  };
  const Lods with(opening, 0.5, 7), without(plain, 0.5, 7);
  constexpr double kMost[] = {0.0085, 0.02, 0.025};
  for (size_t lod = 4; lod < 7; ++lod) {
    printf("LOD %zu: lips off by %.4f, %.4f without the expression\n", lod, error(with, lod),
           error(without, lod));
    EXPECT_LT(error(with, lod), kMost[lod - 4]) << lod;
  }
}

TEST(Simplify, ASymmetricMeshStaysSymmetric) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 1, 40, 60);
  // A smile of one side, and quads that are split alike by no fan.
  mesh.shape_names = {"smileLeft"};
  mesh.displacements.resize(1);
  for (size_t v = 0; v < mesh.positions.size(); v += 3) {
    const bool moves = mesh.positions[v] > 0.3 && mesh.positions[v + 2] > 0.3;
    mesh.displacements[0].insert(mesh.displacements[0].end(), {0, moves ? 0.2 : 0, 0});
  }
  const Lods made(mesh, 0.5, 7);
  for (size_t lod = 1; lod < 7; ++lod) {
    EXPECT_NEAR(made.triangles(lod), made.triangles(0) * std::pow(0.5, lod), 2) << lod;
    EXPECT_LT(without_mirror(made.at(lod)), 0.03) << lod;
  }
}

TEST(Simplify, AMeshWithoutMirrorImagesIsNotHeldBack) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 1, 40, 60);
  mesh.transform([](double x, double y, double z) {
    return std::array<double, 3>{x + 0.2 * y * (x > 0 ? x : 0), y, z};
  });
  const Lods made(mesh, 0.5, 6);
  EXPECT_NEAR(made.triangles(5), made.triangles(0) / 32.0, 2);
}

TEST(Simplify, BordersOfTheSkinKeepTenPlaces) {
  // A plate with a hole, as a mask of a face has for an eye.
  TestMesh mesh;
  constexpr int kSide = 30;
  for (int y = 0; y <= kSide; ++y) {
    for (int x = 0; x <= kSide; ++x) mesh.vertex(x, y, 0.01 * x * y);
  }
  const auto at = [](int x, int y) { return static_cast<uint32_t>(y * (kSide + 1) + x); };
  const auto in_hole = [](int x, int y) { return std::hypot(x + 0.5 - 18, y + 0.5 - 14) < 5; };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (!in_hole(x, y)) mesh.face({at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  const Lods made(mesh, 0.5, 7);
  std::map<std::pair<uint32_t, uint32_t>, int> edges = edges_of(made.at(6));
  size_t around = 0;
  for (const auto& [edge, count] : edges) {
    const Vec3 p = made.at(6).positions[edge.first];
    const bool is_border = edges.count({edge.second, edge.first}) == 0;
    around += is_border && std::hypot(p.x - 18, p.y - 14) < 8;
  }
  EXPECT_GE(around, 10u);
  EXPECT_LE(around, 20u) << "where few triangles are left";
}

TEST(Simplify, TeethGoWholeAndEyesStay) {
  TestMesh mesh = OpenBox(5).mesh;  // 250 triangles, a tooth
  const size_t tooth = mesh.positions.size() / 3;
  add_sphere(mesh, 0, 0, -30, 20, 40, 60);  // a head
  add_sphere(mesh, 5, 5, -8, 0.6, 8, 12);   // an eye
  const Lods made(mesh, 0.5, 8);
  size_t gone_at = 0;
  for (size_t lod = 1; lod < 8; ++lod) {
    std::map<uint32_t, size_t> counts;
    for (size_t t = 0; t < made.triangles(lod); ++t) {
      ++counts[made.at(lod).component[made.at(lod).triangles[3 * t]]];
    }
    const uint32_t of_tooth = made.at(0).component[0];
    const uint32_t of_eye = made.at(0).component[made.at(0).positions.count - 1];
    EXPECT_NE(made.at(0).component[tooth], of_tooth);
    EXPECT_GE(counts[of_eye], 8u) << lod;
    if (counts[of_tooth] == 0 && gone_at == 0) gone_at = lod;
    if (gone_at == 0) {
      EXPECT_GE(counts[of_tooth], 8u) << lod;
    }
    if (gone_at != 0) {
      EXPECT_EQ(counts[of_tooth], 0u) << lod;
    }
  }
  EXPECT_EQ(gone_at, 5u) << "250 / 32 are less than twelve";
}

TEST(Simplify, TakesWhatIsNoSurface) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 1, 12, 16);
  Random random = Random::from_seed(5, 0);
  const uint32_t n = static_cast<uint32_t>(mesh.positions.size() / 3);
  for (int i = 0; i < 300; ++i) mesh.face({random.below(n), random.below(n), random.below(n)});
  for (int i = 0; i < 3; ++i) mesh.face({mesh.corners[0], mesh.corners[1], mesh.corners[2]});
  for (uint32_t v = 0; v + 2 < n; ++v) mesh.face({0, v + 1, v + 2});  // a place of many triangles
  const Lods made(mesh, 0.5, 6);
  for (size_t lod = 1; lod < made.lods.count; ++lod) {
    EXPECT_LE(made.triangles(lod), made.triangles(lod - 1));
    for (size_t t = 0; t < made.triangles(lod); ++t) {
      const uint32_t* c = &made.at(lod).triangles[3 * t];
      EXPECT_TRUE(c[0] != c[1] && c[1] != c[2] && c[2] != c[0]);
    }
  }
}

TEST(Simplify, APartOfFacesOnALineIsKeptAsItIs) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 1, 12, 16);
  const uint32_t faces = static_cast<uint32_t>(mesh.face_sizes.size());
  const uint32_t a = mesh.vertex(3, 0, 0), b = mesh.vertex(3, 0, 0), c = mesh.vertex(4, 0, 0);
  mesh.face({a, b, c});
  mesh.objects = {{{"ball", 4}, 0, faces}, {{"line", 4}, faces, 1}};
  const Lods made(mesh, 0.5, 3);
  EXPECT_EQ(made.at(2).parts[1].face_count, 1u);
  EXPECT_EQ(made.at(2).parts[1].vertex_count, 3u);
}

TEST(SurfaceTree, FindsTheDistanceThatEveryTriangleTells) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 1, 10, 12);
  const Lods made(mesh, 1, 1);
  Arena arena{default_allocator()};
  SurfaceTree tree, single;
  ASSERT_TRUE(tree.build(made.at(0).positions, made.at(0).triangles, arena));
  Random random = Random::from_seed(9, 0);
  for (int i = 0; i < 200; ++i) {
    const auto coordinate = [&] { return 4 * (random.below(1000) / 1000.0) - 2; };
    const Vec3 p = {coordinate(), coordinate(), coordinate()};
    double nearest = HUGE_VAL;
    for (size_t t = 0; t < made.triangles(0); ++t) {
      Arena one{default_allocator()};
      ASSERT_TRUE(single.build(made.at(0).positions, made.at(0).triangles.slice(3 * t, 3), one));
      nearest = std::min(nearest, single.distance(p));
    }
    EXPECT_EQ(tree.distance(p), nearest);
    EXPECT_NEAR(nearest, std::abs(length(p) - 1), 0.06);
  }
  const uint32_t needle[] = {0, 1, 2};
  const Vec3 line[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  ASSERT_TRUE(tree.build({line, 3}, {needle, 3}, arena));
  EXPECT_DOUBLE_EQ(tree.distance({3, 1, 0}), std::sqrt(2.0));
}

}  // namespace
}  // namespace mien::author
