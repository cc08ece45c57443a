// SPDX-License-Identifier: MIT
// Neutral tangents: the direction of the texture, its orientation, and what happens without one.
#include <cmath>

#include "runtime/load/compile/compile_deformer.h"
#include "tests/support/deform_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using namespace dna;

Deformed with_tangents(const std::vector<uint8_t>& file) {
  MienDeformerDesc desc = {};
  desc.with_tangents = 1;
  return Deformed(file, desc);
}

Span<const float> tangents_of(const Deformed& d, uint32_t mesh) {
  const MienFloatView view = mesh_of(d.deformer.get(), mesh).tangents;
  return {view.data, view.count};
}

/// The mesh of the tiny rig: 3 x 2 positions in the plane z = 0, seen from +z; texture coordinates
/// grow with x and y.
template <class Change>
Deformed changed_sheet(Change&& change) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  change(arena, view, view.geom.meshes[0]);
  return with_tangents(write_view(view));
}

void expect_tangent(const Deformed& d, uint32_t v, const Vec4d& expected) {
  for (uint32_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(tangents_of(d, 0)[v * 4 + k], expected[k], 1e-6) << "vertex " << v << " part " << k;
  }
}
void expect_tangents(const Deformed& d, const Vec4d& expected) {
  for (uint32_t v = 0; v < 6; ++v) expect_tangent(d, v, expected);
}

TEST(Tangents, PointWhereUGrows) {
  expect_tangents(changed_sheet([](Arena&, DnaView&, Mesh&) {}), {1, 0, 0, 1});
  // u along y, v along -x: rotated, not mirrored.
  expect_tangents(changed_sheet([](Arena& arena, DnaView&, Mesh& mesh) {
                    mesh.texture_coordinates = {be<float>(arena, {0, 0, 0, 1, 1, 1}),
                                                be<float>(arena, {1, 0.5f, 0, 1, 0.5f, 0})};
                  }),
                  {0, 1, 0, 1});
}

TEST(Tangents, WIsNegativeWhereTheTextureIsMirrored) {
  expect_tangents(changed_sheet([](Arena& arena, DnaView&, Mesh& mesh) {
                    mesh.texture_coordinates.us = be<float>(arena, {1, 0.5f, 0, 1, 0.5f, 0});
                  }),
                  {-1, 0, 0, -1});
  expect_tangents(changed_sheet([](Arena& arena, DnaView&, Mesh& mesh) {
                    mesh.texture_coordinates.vs = be<float>(arena, {1, 1, 1, 0, 0, 0});
                  }),
                  {1, 0, 0, -1});
}

TEST(Tangents, DoNotDependOnTheWinding) {
  for (bool with_normals : {false, true}) {
    expect_tangents(changed_sheet([&](Arena& arena, DnaView& view, Mesh& mesh) {
                      view.dsce.face_winding_order = 1;
                      mesh.faces = list<Face>(arena, {{be<uint32_t>(arena, {3, 4, 1, 0})},
                                                      {be<uint32_t>(arena, {4, 5, 2, 1})}});
                      if (!with_normals) mesh.normals = {};
                    }),
                    {1, 0, 0, 1});
  }
}

// Vertex 0 is moved up or down, so that at vertex 1 the first face has an angle of 45 or 135 degrees,
// and the second one of 90.
TEST(Tangents, AreWeightedByAngles) {
  for (float height : {1.0f, -1.0f}) {
    const Deformed d = changed_sheet([&](Arena& arena, DnaView&, Mesh& mesh) {
      mesh.positions.ys = be<float>(arena, {height, 0, 0, 2, 1, 1});
      // v is y in the first face, y - x in the second.
      mesh.texture_coordinates.vs = be<float>(arena, {height, 0, -1, 2, 1, 0});
    });
    const double root = std::sqrt(0.5);
    expect_tangent(d, 0, {1, 0, 0, 1});
    expect_tangent(d, 2, {root, root, 0, 1});
    const double angle = height > 0 ? 45 : 135, x = angle + 90 * root, y = 90 * root;
    expect_tangent(d, 1, {x / std::hypot(x, y), y / std::hypot(x, y), 0, 1});
  }
}

TEST(Tangents, TheMoreFrequentOrientationWins) {
  for (float height : {1.0f, -1.0f}) {
    const Deformed d = changed_sheet([&](Arena& arena, DnaView&, Mesh& mesh) {
      mesh.positions.ys = be<float>(arena, {height, 0, 0, 2, 1, 1});
      mesh.texture_coordinates = {be<float>(arena, {0, 1, 0, 0, 1, 0}),  // mirrored in the second
                                  be<float>(arena, {height, 0, 0, 2, 1, 1})};
    });
    const Vec4d plain = {1, 0, 0, 1}, mirrored = {-1, 0, 0, -1};
    expect_tangent(d, 0, plain);
    expect_tangent(d, 2, mirrored);
    expect_tangent(d, 1, height > 0 ? mirrored : plain);
  }
}

TEST(Tangents, WithoutADirectionArePerpendicularToTheNormal) {
  for (int lacking = 0; lacking < 7; ++lacking) {
    SCOPED_TRACE(lacking);
    const Deformed d = changed_sheet([&](Arena& arena, DnaView&, Mesh& mesh) {
      auto& uvs = mesh.texture_coordinates;
      switch (lacking) {
        case 0: uvs = {}; break;
        case 1: uvs.us = be<float>(arena, {2, 2, 2, 2, 2, 2}); break;
        case 2: mesh.faces = {}; break;
        case 3: uvs.us = be<float>(arena, {NAN, NAN, NAN, NAN, NAN, NAN}); break;
        case 4: uvs.vs = be<float>(arena, {INFINITY, 0, INFINITY, 0, INFINITY, 0}); break;
        case 5: mesh.positions.xs = be<float>(arena, {0, 0, 0, 0, 0, 0}); break;  // no area
        case 6: uvs.vs = uvs.us; break;
      }
      mesh.normals.xs = be<float>(arena, {1, 1, 1, 1, 1, 1});
      mesh.normals.zs = be<float>(arena, {-1, 1, 0, -3, 5, 0});
    });
    const MienMesh mesh = mesh_of(d.deformer.get(), 0);
    for (uint32_t v = 0; v < 6; ++v) {
      const float* t = tangents_of(d, 0).data + v * 4;
      const float* n = mesh.normals.data + v * 3;
      EXPECT_NEAR(t[0] * t[0] + t[1] * t[1] + t[2] * t[2], 1, 1e-6);
      EXPECT_NEAR(t[0] * n[0] + t[1] * n[1] + t[2] * n[2], 0, 1e-6);
      EXPECT_EQ(t[3], 1);
    }
  }
  // Neither a face nor a normal: the x axis.
  expect_tangents(changed_sheet([](Arena&, DnaView&, Mesh& mesh) {
                    mesh.faces = {};
                    mesh.normals = {};
                  }),
                  {1, 0, 0, 1});
}

TEST(Tangents, AgreeWithDoublePrecision) {
  for (uint32_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    DeformRigOptions options;
    options.rows = 20;
    options.clockwise = seed % 2;
    options.normals = seed % 4 != 3;
    options.height = seed % 3 == 0 ? 150 : 0;
    const Deformed d = with_tangents(random_deform_rig(seed, options));
    const PlainDeformer plain = {d.dna->view};
    for (uint32_t m = 0; m < options.meshes; ++m) {
      const MienMesh mesh = mesh_of(d.deformer.get(), m);
      const std::vector<Vec4d> expected =
          plain.neutral_tangents(m, {mesh.normals.data, mesh.normals.count});
      const Span<const float> made = tangents_of(d, m);
      ASSERT_EQ(made.count, expected.size() * 4);
      uint32_t compared = 0;
      for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        const Vec4d& e = expected[v];
        if (e[0] == 0 && e[1] == 0 && e[2] == 0) continue;  // no triangle: an arbitrary one
        ++compared;
        for (uint32_t k = 0; k < 4; ++k) EXPECT_NEAR(made[v * 4 + k], e[k], 1e-5) << v;
      }
      EXPECT_GT(compared, mesh.vertex_count / 2);
    }
  }
}

}  // namespace
}  // namespace mien
