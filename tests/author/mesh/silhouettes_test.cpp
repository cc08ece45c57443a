// SPDX-License-Identifier: MIT
// Silhouettes of the LODs of heads, and their borders, lips and symmetry.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "author/mesh/surface_tree.h"
#include "tests/support/real_meshes.h"
#include "tests/support/simplified_mesh.h"

namespace mien::author {
namespace {

constexpr int kCells = 400;

/// Which cells of a square image the skin covers, seen along a horizontal direction.
std::vector<bool> covered(const AuthorMesh& mesh, const AuthorMesh& whole, Vec3 view) {
  const Vec3 right = cross({0, 1, 0}, view);
  std::vector<bool> cells(kCells * kCells);
  const auto flat = [&](Vec3 p) {
    p = (p - whole.positions[0]) * (0.5 * kCells / whole.diagonal);
    return Vec3{dot(p, right) + kCells / 2, p.y + kCells / 2, 0};
  };
  for (size_t t = 0; t < mesh.triangles.count; t += 3) {
    if (!mesh.is_skin[mesh.triangles[t]]) continue;
    Vec3 p[3];
    for (size_t k = 0; k < 3; ++k) p[k] = flat(mesh.positions[mesh.triangles[t + k]]);
    const auto at = [](double v) { return std::clamp(static_cast<int>(v), 0, kCells - 1); };
    const int x_end = at(std::max({p[0].x, p[1].x, p[2].x}));
    const int y_end = at(std::max({p[0].y, p[1].y, p[2].y}));
    for (int y = at(std::min({p[0].y, p[1].y, p[2].y})); y <= y_end; ++y) {
      for (int x = at(std::min({p[0].x, p[1].x, p[2].x})); x <= x_end; ++x) {
        const Vec3 middle = {x + 0.5, y + 0.5, 0};
        double sides[3];
        for (size_t k = 0; k < 3; ++k) sides[k] = cross(p[(k + 1) % 3] - p[k], middle - p[k]).z;
        const bool inside = (sides[0] >= 0 && sides[1] >= 0 && sides[2] >= 0) ||
                            (sides[0] <= 0 && sides[1] <= 0 && sides[2] <= 0);
        if (inside) cells[static_cast<size_t>(y * kCells + x)] = true;
      }
    }
  }
  return cells;
}

/// The area between the silhouettes of a LOD and of the whole mesh, as a share of the latter.
double silhouette_error(const AuthorMesh& mesh, const AuthorMesh& whole, Vec3 view) {
  const std::vector<bool> a = covered(mesh, whole, view), b = covered(whole, whole, view);
  size_t between = 0, all = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    between += a[i] != b[i];
    all += b[i];
  }
  return static_cast<double>(between) / static_cast<double>(all);
}

/// Places on the borders of the skin.
size_t border_places(const AuthorMesh& mesh) {
  const auto edges = edges_of(mesh);
  std::set<uint32_t> places;
  for (const auto& [edge, count] : edges) {
    if (edges.count({edge.second, edge.first}) == 0 && mesh.is_skin[edge.first])
      places.insert(edge.first);
  }
  return places.size();
}

/// Prints the silhouettes of LODs, and compares those from the front and the side with bounds.
void expect_silhouettes(const Lods& made, const double (&most)[8]) {
  printf("LOD, triangles, silhouette from the front, the side and between in %%, rms in %%\n");
  for (size_t lod = 1; lod < 8; ++lod) {
    const auto error = [&](Vec3 view) { return silhouette_error(made.at(lod), made.at(0), view); };
    const double front = error({0, 0, 1}), side = error({1, 0, 0}), between = error({0.6, 0, 0.8});
    printf("%zu, %zu, %.2f, %.2f, %.2f, %.3f\n", lod, made.triangles(lod), 100 * front, 100 * side,
           100 * between, 100 * made.lods[lod].rms / made.at(0).diagonal);
    EXPECT_LT(std::max(front, side), most[lod]) << lod;
  }
}

TEST(Silhouettes, AHeadKeepsThemItsBordersAndItsSymmetry) {
  const Lods made(procedural_mesh(0, true), 0.5, 8);
  expect_silhouettes(made, {0, 0.001, 0.001, 0.003, 0.005, 0.012, 0.026, 0.06});
  for (size_t lod = 1; lod < 8; ++lod) {
    EXPECT_LT(without_mirror(made.at(lod)), 0.03) << lod;
    EXPECT_GE(border_places(made.at(lod)), std::min<size_t>(10, border_places(made.at(0)))) << lod;
  }
}

/// The LODs that the generator makes of its head.
TEST(Silhouettes, LodsOfTheGeneratedHeadKeepThem) {
  const Lods whole(procedural_mesh(0, false), 0.5, 1);
  constexpr double kMost[8] = {0, 0.001, 0.0015, 0.0025, 0.004, 0.005, 0.008, 0.015};
  for (uint32_t lod = 1; lod < 8; ++lod) {
    const Lods made(procedural_mesh(lod, false), 0.5, 1);
    for (const Vec3 view : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, 0, 0.8}}) {
      const double error = silhouette_error(made.at(0), whole.at(0), view);
      printf("LOD %u: %.2f %%\n", lod, 100 * error);
      EXPECT_LT(error, view.x > 0 && view.z > 0 ? 1.5 * kMost[lod] : kMost[lod]) << lod;
    }
  }
}

/// How far the lips, which the expression moves most, are from the surface of a LOD at rest: root mean square, in shares
/// of the diagonal.
double lip_error(const Lods& made, size_t lod, const std::string& expression) {
  const AuthorMesh& whole = made.at(0);
  const Shape* moves = nullptr;
  for (const Shape& shape : whole.shapes) {
    if (std::string(shape.name.data, shape.name.count) == expression) moves = &shape;
  }
  if (!moves) return HUGE_VAL;
  double longest = 0;
  for (const Vec3f d : moves->displacements) longest = std::max(longest, length(as_vec3(d)));
  Arena arena{default_allocator()};
  SurfaceTree tree;
  EXPECT_TRUE(tree.build(made.at(lod).positions, made.at(lod).triangles, arena));
  double squares = 0, count = 0;
  for (const uint32_t v : moves->moving) {
    if (length(as_vec3(moves->displacements[v])) < 0.6 * longest) continue;
    squares += std::pow(tree.distance(whole.positions[v]), 2);
    ++count;
  }
  return std::sqrt(squares / count) / whole.diagonal;
}

TEST(Silhouettes, IctKeepsThemAndItsLips) {
  AuthorSetup head;
  if (real_mesh_folder().empty() || !load_ict(head))
    GTEST_SKIP() << "NOT TESTED: silhouettes of a real head; there is no $MIEN_SHARED/data/meshes";
  const Lods made(mesh_of(head, true), 0.5, 8);
  expect_silhouettes(made, {0, 0.001, 0.0015, 0.0037, 0.0075, 0.016, 0.042, 0.08});
  constexpr double kLips[] = {0, 0.0002, 0.00043, 0.00061, 0.0013, 0.00215, 0.0048, 0.0052};
  for (size_t lod = 1; lod < 8; ++lod) {
    const double lips = lip_error(made, lod, "mouthFunnel");
    printf("LOD %zu: lips off by %.3f %% at rest\n", lod, 100 * lips);
    EXPECT_LT(lips, kLips[lod]) << lod;
  }
}

}  // namespace
}  // namespace mien::author
