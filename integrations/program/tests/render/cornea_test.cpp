// SPDX-License-Identifier: MIT
#include "integrations/program/render/cornea.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrations/program/render/scene.h"
#include "integrations/program/render/texture.h"

namespace mien::render {
namespace {

using namespace math;

constexpr float kIris = 0.2f, kRadius = 6,
                kDepth = 0.5f;  // of the iris: in the texture, in space; 3 deep

/// The front of an eye that looks along z: a bowl with the apex at (1, 2, 10), its texture seen from the front. With
/// `mirrored`, u runs the other way.
struct Front {
  std::vector<Vec3> places;
  std::vector<float> positions, coordinates;
  std::vector<uint32_t> triangles;
  Texture texture = Texture(Image(2, 2, {90, 90, 90}));

  explicit Front(bool mirrored = false) {
    constexpr int kSide = 13;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const float dx = float(x - 6) * 2, dy = float(y - 6) * 2;
        places.push_back({1 + dx, 2 + dy, 10 - 0.04f * (dx * dx + dy * dy)});
        positions.insert(positions.end(), {places.back().x, places.back().y, places.back().z});
        coordinates.push_back(0.5f + (mirrored ? -dx : dx) * (kIris / kRadius));
        coordinates.push_back(0.5f + dy * (kIris / kRadius));
        if (x == 0 || y == 0) continue;
        const auto at = uint32_t(y * kSide + x), below = at - kSide;
        triangles.insert(triangles.end(), {below - 1, below, at, below - 1, at, at - 1});
      }
    }
  }
  Surface surface() const {
    Surface s;
    s.positions = positions.data();
    s.position_count = s.vertex_count = places.size();
    s.triangles = triangles.data();
    s.triangle_count = triangles.size() / 3;
    s.texture_coordinates = coordinates.data();
    s.color_texture = &texture;
    s.cornea = {kDepth, kIris};
    return s;
  }
};

TEST(Cornea, FindsThePlaneOfTheIris) {
  for (const bool mirrored : {false, true}) {
    const Front front(mirrored);
    const IrisPlane iris = find_iris(front.surface(), front.places);
    ASSERT_EQ(iris.radius, kIris);
    EXPECT_NEAR(iris.axis.z, 1, 1e-5f);
    EXPECT_NEAR(iris.middle.x, 1, 1e-4f);
    EXPECT_NEAR(iris.middle.y, 2, 1e-4f);
    EXPECT_NEAR(iris.middle.z, 10 - kDepth * kRadius, 1e-4f);
    EXPECT_NEAR(iris.to_u.x, (mirrored ? -1 : 1) * kIris / kRadius, 1e-6f);
    EXPECT_NEAR(iris.to_v.y, kIris / kRadius, 1e-6f);
  }
}

TEST(Cornea, TurnsWithTheEye) {
  Front front;
  for (Vec3& p : front.places) p = {p.z, p.y, -p.x};
  const IrisPlane iris = find_iris(front.surface(), front.places);
  EXPECT_NEAR(iris.axis.x, 1, 1e-5f);
  EXPECT_NEAR(iris.middle.x, 10 - kDepth * kRadius, 1e-4f);
  EXPECT_NEAR(iris.to_u.z, -kIris / kRadius, 1e-6f);
}

TEST(Cornea, SurfacesWithoutOneHaveNoPlane) {
  Front front;
  Surface s = front.surface();
  s.cornea.depth = 0;
  EXPECT_EQ(find_iris(s, front.places).radius, 0);
  s = front.surface();
  s.color_texture = nullptr;
  EXPECT_EQ(find_iris(s, front.places).radius, 0);
  s = front.surface();
  s.texture_coordinates = nullptr;
  EXPECT_EQ(find_iris(s, front.places).radius, 0);
  s = front.surface();
  const std::vector<float> one_place(front.coordinates.size(), 0.5f);
  s.texture_coordinates = one_place.data();
  EXPECT_EQ(find_iris(s, front.places).radius, 0);
  for (Vec3& p : front.places) p.x = std::nanf("");
  EXPECT_EQ(find_iris(front.surface(), front.places).radius, 0);
}

TEST(Cornea, RefractsTheLineOfSight) {
  const Front front;
  const IrisPlane iris = find_iris(front.surface(), front.places);
  const Vec3 apex = {1, 2, 10}, out = {0, 0, 1};
  const SeenIris straight = seen_iris(iris, apex, out, out, out);
  EXPECT_NEAR(straight.u, 0.5f, 1e-5f);
  EXPECT_NEAR(straight.v, 0.5f, 1e-5f);
  // From the right, the line goes on to the left, at the angle that Snell's law gives.
  for (const float angle : {0.3f, 0.8f, 1.3f}) {
    const SeenIris seen = seen_iris(iris, apex, out, {std::sin(angle), 0, std::cos(angle)}, out);
    const float inside = std::asin(std::sin(angle) / 1.336f);
    EXPECT_NEAR(seen.u, 0.5f - 1.09f * kDepth * kIris * std::tan(inside), 1e-4f) << angle;
    EXPECT_NEAR(seen.v, 0.5f, 1e-5f);
  }
}

TEST(Cornea, ShowsNothingBesideTheIris) {
  const Front front;
  const IrisPlane iris = find_iris(front.surface(), front.places);
  const Vec3 at_border = {1 - 5.8f, 2, 10}, right = normalized(Vec3{1, 0, 0.05f}, {});
  const SeenIris seen = seen_iris(iris, at_border, {0, 0, 1}, right, {0, 0, 1});
  EXPECT_NEAR(seen.u, 0.5f - 0.97f * kIris, 1e-5f);
}

TEST(Cornea, GathersLightAwayFromTheLamp) {
  const Front front;
  const IrisPlane iris = find_iris(front.surface(), front.places);
  const Vec3 lamp = normalized(Vec3{-1, 1, 1}, {});
  const auto light = [&](float x, float y) {
    return seen_iris(iris, {1 + x, 2 + y, 9.5f}, {0, 0, 1}, {0, 0, 1}, lamp).light;
  };
  EXPECT_NEAR(light(0, 0), 1, 1e-4f);
  EXPECT_GT(light(3, -3), 1.2f);
  EXPECT_LT(light(-3, 3), 0.8f);
  EXPECT_NEAR(light(3, 3), 1, 1e-4f);
}

TEST(Cornea, IsClearUpToTheLimbus) {
  const Front front;
  const IrisPlane iris = find_iris(front.surface(), front.places);
  EXPECT_EQ(clearness(iris, 0.5f, 0.5f), 1);
  EXPECT_EQ(clearness(iris, 0.5f + 0.9f * kIris, 0.5f), 1);
  EXPECT_NEAR(clearness(iris, 0.5f, 0.5f - 0.99f * kIris), 0.5f, 0.01f);
  EXPECT_EQ(clearness(iris, 0.5f + 1.1f * kIris, 0.5f), 0);
}

/// A picture with a green pupil: from the side it is seen where the line of sight goes, not on the surface.
TEST(Cornea, FragmentsShowTheIrisBehindTheSurface) {
  Front front;
  Image image(200, 200, {200, 30, 30});
  for (int y = 90; y < 110; ++y) {
    for (int x = 90; x < 110; ++x) image.set(x, y, {30, 200, 30});
  }
  front.texture = Texture(std::move(image));
  Surface s = front.surface();
  const auto is_green = [&](float x, float yaw) {
    const Vec3 place = {1 + x, 2, 10 - 0.04f * x * x};
    const Camera camera = look_at({}, View{yaw}, place, 60);
    const Scene scene({s}, camera, 1e-3f);
    const Vec3 at = camera.to_view(place), ray = at * (-1 / at.z);
    // The triangle at the place: of the two of its square, either is as flat.
    const auto column = uint32_t((x + 12) / 2);
    const Fragment f = scene.fragment(1 + 2 * (6 * 12 + column), ray);
    return f.color.y > f.color.x;
  };
  EXPECT_TRUE(is_green(0.1f, 0));
  EXPECT_FALSE(is_green(2.9f, 0));
  s.cornea = {};
  EXPECT_TRUE(is_green(0.1f, 55));
  EXPECT_FALSE(is_green(2.9f, 55));
  s.cornea = {kDepth, kIris};
  EXPECT_FALSE(is_green(0.1f, 55));
  EXPECT_TRUE(is_green(2.3f, 55));
}

}  // namespace
}  // namespace mien::render
