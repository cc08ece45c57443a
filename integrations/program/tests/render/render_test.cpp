// SPDX-License-Identifier: MIT
// Whole pictures, compared by structural similarity with references that the test makes itself.
#include "integrations/program/render/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrations/program/render/light.h"
#include "integrations/program/render/occlusion.h"
#include "integrations/program/render/scene.h"
#include "integrations/program/render/texture.h"

namespace mien::render {
namespace {

using namespace math;

struct Mesh {
  std::vector<float> positions, normals;
  std::vector<uint32_t> triangles;
  std::vector<uint8_t> colors;

  Surface surface() const {
    Surface s;
    s.positions = positions.data();
    s.position_count = s.vertex_count = positions.size() / 3;
    s.triangles = triangles.data();
    s.triangle_count = triangles.size() / 3;
    if (!normals.empty()) s.normals = normals.data();
    if (!colors.empty()) s.colors = colors.data();
    return s;
  }
  std::vector<Vec3> points() const {
    std::vector<Vec3> all;
    for (size_t i = 0; i < positions.size() / 3; ++i) all.push_back(load3(positions.data(), i));
    return all;
  }
};

/// Unit sphere. `turn` turns it about the y axis.
Mesh sphere(uint32_t rows, uint32_t columns, float turn = 0) {
  Mesh mesh;
  for (uint32_t r = 0; r <= rows; ++r) {
    for (uint32_t c = 0; c <= columns; ++c) {
      const float down = 3.14159265f * float(r) / float(rows);
      const float around = turn + 6.2831853f * float(c) / float(columns);
      const float p[3] = {std::sin(down) * std::sin(around), std::cos(down),
                          std::sin(down) * std::cos(around)};
      mesh.positions.insert(mesh.positions.end(), p, p + 3);
      if (r < rows && c < columns) {
        const uint32_t a = r * (columns + 1) + c, b = a + columns + 1;
        for (const uint32_t i : {a, b, b + 1, a, b + 1, a + 1}) mesh.triangles.push_back(i);
      }
    }
  }
  mesh.normals = mesh.positions;
  return mesh;
}

Camera camera_of(const Mesh& mesh, int size, View view = {}) {
  return frame_points({}, view, mesh.points(), size, size, 0.12f);
}

std::vector<double> gray(const Image& image) {
  std::vector<double> values;
  for (size_t i = 0; i + 2 < image.pixels.size(); i += 3) {
    values.push_back(0.299 * image.pixels[i] + 0.587 * image.pixels[i + 1] +
                     0.114 * image.pixels[i + 2]);
  }
  return values;
}

/// Mean structural similarity (Wang et al. 2004) over windows of 8x8.
double similarity(const Image& a, const Image& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  const std::vector<double> x = gray(a), y = gray(b);
  constexpr int kWindow = 8;
  constexpr double kC1 = 6.5025, kC2 = 58.5225;
  double sum = 0;
  int windows = 0;
  for (int top = 0; top + kWindow <= a.height; top += 2) {
    for (int left = 0; left + kWindow <= a.width; left += 2, ++windows) {
      double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
      for (int j = top; j < top + kWindow; ++j) {
        for (int i = left; i < left + kWindow; ++i) {
          const double u = x[size_t(j * a.width + i)], v = y[size_t(j * a.width + i)];
          mx += u;
          my += v;
          xx += u * u;
          yy += v * v;
          xy += u * v;
        }
      }
      constexpr double n = kWindow * kWindow;
      mx /= n;
      my /= n;
      const double vx = xx / n - mx * mx, vy = yy / n - my * my, cov = xy / n - mx * my;
      sum += (2 * mx * my + kC1) * (2 * cov + kC2) / ((mx * mx + my * my + kC1) * (vx + vy + kC2));
    }
  }
  return sum / windows;
}

/// Every pixel is the mean light of factor x factor pixels.
Image smaller(const Image& image, int factor) {
  Image out(image.width / factor, image.height / factor, {});
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      Vec3 sum;
      for (int j = 0; j < factor; ++j) {
        for (int i = 0; i < factor; ++i) sum += to_linear(image.at(x * factor + i, y * factor + j));
      }
      out.set(x, y, to_srgb(sum * (1 / float(factor * factor))));
    }
  }
  return out;
}

TEST(Render, SimilarityTellsPicturesApart) {
  const Mesh mesh = sphere(24, 32);
  RenderOptions options;
  options.width = options.height = 96;
  const Image a = render_image({mesh.surface()}, camera_of(mesh, 96), options);
  EXPECT_DOUBLE_EQ(similarity(a, a), 1);
  View view;
  view.zoom = 0.9f;
  EXPECT_LT(similarity(a, render_image({mesh.surface()}, camera_of(mesh, 96, view), options)),
            0.97);
}

TEST(Render, FewSamplesLookLikeMany) {
  const Mesh mesh = sphere(40, 64);
  RenderOptions options;
  options.width = options.height = 96;
  const Image picture = render_image({mesh.surface()}, camera_of(mesh, 96), options);
  RenderOptions large = options;
  large.width = large.height = 768;
  large.samples = 1;
  const Image reference = smaller(render_image({mesh.surface()}, camera_of(mesh, 768), large), 8);
  EXPECT_GE(similarity(picture, reference), 0.98);
}

TEST(Render, SphereLooksLikeOneThatIsTraced) {
  constexpr int kSize = 96, kSub = 6;
  const Mesh mesh = sphere(96, 128);
  const Surface surface = mesh.surface();
  RenderOptions options;
  options.width = options.height = kSize;
  const Camera camera = camera_of(mesh, kSize);
  const Image picture = render_image({surface}, camera, options);

  // Rays against the sphere; the background is where the picture shows it.
  const Scene scene({surface}, camera, 0.01f);
  const Vec3 center = camera.to_view({});
  const float focal = kSize / 2.0f / std::tan(camera.field_of_view * 0.00872664626f);
  Image traced(kSize, kSize, {});
  RenderOptions empty = options;
  const Image background = render_image({}, camera, empty);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      Vec3 sum;
      for (int s = 0; s < kSub * kSub; ++s) {
        const float px = float(x) + (float(s % kSub) + 0.5f) / kSub;
        const float py = float(y) + (float(s / kSub) + 0.5f) / kSub;
        const Vec3 ray = normalized(
            Vec3{(px - kSize / 2.0f) / focal, (kSize / 2.0f - py) / focal, -1}, {0, 0, -1});
        const float along = dot(ray, center);
        const float under = along * along - dot(center, center) + 1;
        if (under <= 0) {
          sum += to_linear(background.at(x, y));
          continue;
        }
        Fragment f{};
        f.on = &scene.surfaces()[0];
        f.place = ray * (along - std::sqrt(under));
        f.normal = f.smooth = f.place - center;
        f.to_eye = -ray;
        f.color = to_linear(surface.material.color);
        f.roughness = surface.material.roughness;
        Arriving arriving;
        arriving.key = dot(f.normal, key_direction()) > 0 ? 1.0f : 0.0f;
        sum += tone(light(f, 1, arriving));
      }
      traced.set(x, y, to_srgb(sum * (1.0f / (kSub * kSub))));
    }
  }
  EXPECT_GE(similarity(picture, traced), 0.98);
}

TEST(Render, TurningEverythingChangesNothing) {
  const Mesh mesh = sphere(48, 64), turned = sphere(48, 64, 0.05f);
  RenderOptions options;
  options.width = options.height = 96;
  const Image a = render_image({mesh.surface()}, camera_of(mesh, 96), options);
  EXPECT_GE(similarity(a, render_image({turned.surface()}, camera_of(turned, 96), options)), 0.99);

  // The same shape in other axes: z up, -y to the front.
  Mesh other = mesh;
  for (size_t i = 0; i < other.positions.size(); i += 3) {
    for (std::vector<float>* v : {&other.positions, &other.normals}) {
      const float y = (*v)[i + 1], z = (*v)[i + 2];
      (*v)[i + 1] = -z;
      (*v)[i + 2] = y;
    }
  }
  const Axes stand = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  const Camera camera = frame_points(stand, {}, other.points(), 96, 96, 0.12f);
  EXPECT_GE(similarity(a, render_image({other.surface()}, camera, options)), 0.99);
}

TEST(Render, UnitsAndWindingDoNotMatter) {
  const Mesh mesh = sphere(24, 32);
  RenderOptions options;
  options.width = options.height = 64;
  const Image a = render_image({mesh.surface()}, camera_of(mesh, 64), options);
  Mesh meters = mesh;
  for (float& v : meters.positions) v *= 0.01f;
  EXPECT_GE(similarity(a, render_image({meters.surface()}, camera_of(meters, 64), options)), 0.995);
  Mesh wound = mesh;
  for (size_t t = 0; t < wound.triangles.size(); t += 3)
    std::swap(wound.triangles[t], wound.triangles[t + 1]);
  EXPECT_GE(similarity(a, render_image({wound.surface()}, camera_of(wound, 64), options)), 0.995);
  // Normals made from the triangles are those that were left out.
  Mesh bare = mesh;
  bare.normals.clear();
  EXPECT_GE(similarity(a, render_image({bare.surface()}, camera_of(bare, 64), options)), 0.98);
}

TEST(Render, SamePictureEveryTime) {
  const Mesh mesh = sphere(24, 32);
  RenderOptions options;
  options.width = 80;
  options.height = 60;
  const Camera camera = camera_of(mesh, 60);
  const Image first = render_image({mesh.surface()}, camera, options);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(render_image({mesh.surface()}, camera, options).pixels, first.pixels);
  }
}

TEST(Render, ColorsAreInterpolatedInPerspective) {
  // A plane that leads away from the viewer, black at its near end and white at the far one.
  Mesh plane;
  plane.positions = {-1, -1, -2, 1, -1, -2, 1, -1, -10, -1, -1, -10};
  plane.triangles = {0, 1, 2, 0, 2, 3};
  plane.colors = {0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 255, 255};
  const Scene scene({plane.surface()}, Camera{}, 0.01f);
  for (const float distance : {2.5f, 4.0f, 6.0f, 9.0f}) {
    // Both triangles, left and right of their common edge.
    for (const uint32_t number : {1u, 2u}) {
      const float share = (distance - 2) / 8;
      const float x = number == 1 ? share * 2 - 1 + 0.1f : share * 2 - 1 - 0.1f;
      const Fragment f = scene.fragment(number, {x / distance, -1 / distance, -1});
      EXPECT_NEAR(-f.place.z, distance, 1e-4f * distance);
      EXPECT_NEAR(f.color.x, share, 1e-4f);
      EXPECT_NEAR(f.normal.y, 1, 1e-5f);
    }
  }
}

TEST(Render, NearerSurfacesHideFartherOnes) {
  Mesh front = sphere(16, 24), back = sphere(16, 24);
  for (size_t i = 0; i < back.positions.size(); i += 3) back.positions[i + 2] -= 5;
  Surface red = front.surface(), green = back.surface();
  red.material.color = {220, 30, 30};
  green.material.color = {30, 220, 30};
  RenderOptions options;
  options.width = options.height = 48;
  const Camera camera = camera_of(front, 48);
  for (const auto& surfaces : {std::vector<Surface>{red, green}, {green, red}}) {
    const Color middle = render_image(surfaces, camera, options).at(24, 24);
    EXPECT_GT(middle.r, 2 * middle.g);
  }
}

TEST(Render, HollowsAreDarker) {
  // A plate with a deep pit: its floor gets less of the sky than the plate.
  Mesh mesh;
  constexpr int kGrid = 60;
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const float x = float(i) / kGrid * 2 - 1, y = float(j) / kGrid * 2 - 1;
      const float r = std::sqrt(x * x + y * y) / 0.12f;
      mesh.positions.insert(mesh.positions.end(), {x, y, -0.3f * std::exp(-r * r * r * r)});
      if (i < kGrid && j < kGrid) {
        const auto a = uint32_t(j * (kGrid + 1) + i), b = a + kGrid + 1;
        for (const uint32_t k : {a, a + 1, b + 1, a, b + 1, b}) mesh.triangles.push_back(k);
      }
    }
  }
  RenderOptions options;
  options.width = options.height = 96;
  const Image image = render_image({mesh.surface()}, camera_of(mesh, 96), options);
  EXPECT_LT(image.at(48, 48).g, image.at(20, 48).g * 0.75);
}

/// Beyond the edge of a ball of hair the cards are seen from behind, their normals turned away.
TEST(Render, CardsSeenFromBehindAreLitAsTheBodyTheyArePartOf) {
  Mesh card;
  card.positions = {-1, -1, -5, 1, -1, -5, 1, 1, -5, -1, 1, -5};
  card.triangles = {0, 2, 1, 0, 3, 2};  // faces away
  for (int i = 0; i < 4; ++i) card.normals.insert(card.normals.end(), {0, 0.8f, -0.6f});
  const std::vector<float> coordinates(8, 0.5f);
  const Texture opaque(Image(1, 1, {255, 255, 255})), cut(Image(1, 1, {255, 255, 255}), {200});
  const auto normal_with = [&](const Texture& texture) {
    Surface surface = card.surface();
    surface.texture_coordinates = coordinates.data();
    surface.color_texture = &texture;
    return Scene({surface}, Camera{}, 0.01f).fragment(1, {0.1f, 0.1f, -1}).normal;
  };
  EXPECT_LT(normal_with(opaque).y, -0.7f) << "the other side";
  EXPECT_GT(normal_with(cut).y, 0.6f);
  EXPECT_GT(normal_with(cut).z, 0.4f);
}

/// The brightest pixel of the ball's right border: what the rim light from behind makes of it.
int brightest_at_the_right(const Image& image) {
  int most = 0;
  for (int y = image.height / 4; y < image.height * 3 / 4; ++y) {
    for (int x = image.width * 3 / 4; x < image.width * 86 / 100; ++x)
      most = std::max(most, int(image.at(x, y).g));
  }
  return most;
}

TEST(Render, RimLightDoesNotReachWhatStandsInItsShadow) {
  const Mesh ball = sphere(48, 64);
  Surface dark = ball.surface();
  dark.material.color = {40, 40, 40};
  // A plate between the ball and the lamp behind it, turned towards both.
  Mesh plate = sphere(2, 4);
  plate.positions.clear();
  plate.normals.clear();
  const Vec3 to_lamp = rim_direction(0), aside = normalized(cross({0, 1, 0}, to_lamp), {});
  const Vec3 up = cross(to_lamp, aside);
  for (int i = 0; i < 4; ++i) {
    const Vec3 p = to_lamp * 4.0f + aside * (i % 2 ? 2.0f : -2.0f) + up * (i / 2 ? 2.0f : -2.0f);
    plate.positions.insert(plate.positions.end(), {p.x, p.y, p.z});
  }
  plate.triangles = {0, 1, 3, 0, 3, 2};
  RenderOptions options;
  options.width = options.height = 96;
  options.scale = 3;
  options.backdrop = {{0, 0, 0}, {0, 0, 0}};
  const Camera camera = camera_of(ball, 96);
  Surface wall = plate.surface();
  wall.material.color = {0, 0, 0};
  const int open = brightest_at_the_right(render_image({dark}, camera, options));
  const int shadowed = brightest_at_the_right(render_image({dark, wall}, camera, options));
  EXPECT_GT(open, 50);
  EXPECT_LT(shadowed, open * 0.85);
}

TEST(Render, LightGoesFartherUnderSkinTheRedderItIsAndTheMoreTheSkinIsBent) {
  const Mesh mesh = sphere(8, 12);
  Surface skin = mesh.surface(), chalk = mesh.surface();
  chalk.material.softness = 0;
  const Scene scene({skin, chalk}, Camera{}, 0.01f);
  // What skin has more than chalk at some degrees from the direction of the key light.
  const auto scattered = [&](float degrees, float bend) {
    const Vec3 key = key_direction(), aside = normalized(cross(key, {0, 0, 1}), {});
    const float turn = degrees * 0.0174532925f;
    Fragment f{};
    f.normal = f.smooth = key * std::cos(turn) + aside * std::sin(turn);
    f.to_eye = {0, 0, 1};
    f.color = {0.5f, 0.5f, 0.5f};
    f.roughness = 1;
    f.bend = bend;
    Vec3 of[2];
    for (size_t i = 0; i < 2; ++i) {
      f.on = &scene.surfaces()[i];
      of[i] = light(f, 1, {1, {0, 0}});
    }
    return of[0] - of[1];
  };
  const Vec3 flat = scattered(105, 0), bent = scattered(105, 0.05f);
  EXPECT_GT(flat.x, 1e-3f);
  EXPECT_GT(flat.x, 3 * flat.y);
  EXPECT_GT(flat.y, flat.z);
  EXPECT_GT(bent.x, 1.5f * flat.x);
  // It is missing before the terminator, not made.
  EXPECT_LT(scattered(60, 0.05f).x, 0);
}

TEST(Render, CurvatureIsThatOfTheSurfaceInUnitsOfAHead) {
  // A ball in a scene of 600 mm across, whose radius is 1 of 2 * sqrt(3).
  const Mesh mesh = sphere(48, 64);
  const Scene scene({mesh.surface()}, Camera{}, 0.01f);
  const std::vector<float>& bends = scene.surfaces()[0].bends;
  ASSERT_EQ(bends.size(), mesh.positions.size() / 3);
  EXPECT_NEAR(bends[24 * 65 + 7], 2 * std::sqrt(3.0f) / 600, 2e-4f);
  Surface chalk = mesh.surface();
  chalk.material.softness = 0.05f;
  EXPECT_TRUE(Scene({chalk}, Camera{}, 0.01f).surfaces()[0].bends.empty());
}

TEST(Render, ShadowsAreSofterTheFartherTheyFall) {
  // The border of the shadow of a plate on a plane, at right angles to the light.
  const auto width = [](float height) {
    Mesh mesh;
    const Vec3 key = key_direction(), u = normalized(cross({0, 1, 0}, key), {}), v = cross(key, u);
    const auto add = [&](Vec3 p) { mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z}); };
    const auto quad = [&](float left, float right, float up) {
      const auto first = uint32_t(mesh.positions.size() / 3);
      add(u * left + v * -2.0f + key * up), add(u * right + v * -2.0f + key * up);
      add(u * right + v * 2.0f + key * up), add(u * left + v * 2.0f + key * up);
      for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.triangles.push_back(first + k);
    };
    quad(-2, 2, 0);
    quad(-2, 0, height);
    const Scene scene({mesh.surface()}, Camera{}, 0.01f);
    const Vec3 eye = Camera{}.to_view({});
    const ShadowMap map(scene, key, 1024, 0.15f);
    float first = 2, last = -2;
    for (float x = -1; x < 1; x += 0.005f) {
      float lit = 0;
      for (int turn = 0; turn < 16; ++turn) lit += map.light_at(u * x + eye, key, turn) / 16;
      if (lit > 0.1f && first > 1) first = x;
      if (lit < 0.9f) last = x;
    }
    EXPECT_LT(std::fabs(first + last), 0.02f) << "the middle is below the edge";
    return last - first;
  };
  const float near = width(0.2f), far = width(0.6f);
  EXPECT_LT(near, 0.1f);
  EXPECT_GT(far, 2 * near);
}

TEST(Render, WireframesLeaveOutInnerEdges) {
  Mesh quad;
  quad.positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  quad.triangles = {0, 1, 2, 0, 2, 3};
  Surface surface = quad.surface();
  RenderOptions options;
  options.width = options.height = 64;
  const Camera camera = camera_of(quad, 64);
  const auto diagonal = [&] { return render_image({surface}, camera, options).at(32, 31).g; };
  const int plain = diagonal();
  options.wireframe = true;
  EXPECT_LT(diagonal(), plain * 0.85);
  const uint8_t inner[] = {4, 1};
  surface.inner_edges = inner;
  // Both triangles are shaded on their own then, at places that differ by parts of a pixel.
  EXPECT_NEAR(diagonal(), plain, 1);
}

TEST(Render, SurvivesBrokenSurfaces) {
  Mesh mesh = sphere(8, 12);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.positions[3] = nan;
  mesh.positions[40] = std::numeric_limits<float>::infinity();
  mesh.positions[70] = 3e38f;
  for (size_t i = 30; i < 60; ++i) mesh.normals[i] = i % 2 ? nan : 0;
  mesh.triangles[5] = 4000000000u;
  Surface surface = mesh.surface();
  RenderOptions options;
  for (const int size : {1, 2, 33}) {
    options.width = size;
    options.height = 1 + size / 2;
    for (const int samples : {1, 4, 16}) {
      options.samples = samples;
      options.wireframe = samples == 4;
      const Image image = render_image({surface, Surface{}}, camera_of(mesh, size), options);
      EXPECT_EQ(image.pixels.size(), size_t(image.width) * size_t(image.height) * 3);
    }
  }
  surface.normals = nullptr;
  render_image({surface}, camera_of(mesh, 16), options);
  render_image({}, Camera{}, options);
  Camera inside;
  inside.distance = 0;
  render_image({surface}, inside, options);
}

TEST(Camera, FramesAllPointsFromAnywhere) {
  const std::vector<Vec3> points = {{-3, 0, 1}, {2, 9, 0}, {0, -4, 5}, {1, 2, -6}};
  for (const float yaw : {0.0f, 35.0f, 90.0f, 180.0f, -120.0f}) {
    for (const float pitch : {-80.0f, 0.0f, 30.0f}) {
      const Camera camera = frame_points({}, {yaw, pitch, 30, 1}, points, 400, 200, 0.05f);
      const float half = std::tan(15 * 0.0174532925f);
      Box seen;
      for (const Vec3& point : points) {
        const Vec3 p = camera.to_view(point);
        ASSERT_LT(p.z, 0);
        seen.add({p.x / -p.z / (2 * half), p.y / -p.z / half, 0});
      }
      const float most = std::max({seen.max.x, seen.max.y, -seen.min.x, -seen.min.y});
      EXPECT_LT(most, 0.93f);
      EXPECT_GT(most, 0.80f);
      EXPECT_NEAR(dot(camera.right, camera.up), 0, 1e-6f);
      EXPECT_NEAR(length(cross(camera.right, camera.up) - camera.back), 0, 1e-5f);
    }
  }
  // From the front, the subject's left is on the right; from its left, its front is on the left.
  EXPECT_GT(look_at({}, {0, 0, 22, 1}, {}, 5).to_view({1, 0, 0}).x, 0);
  EXPECT_LT(look_at({}, {90, 0, 22, 1}, {}, 5).to_view({0, 0, 1}).x, 0);
  // Nothing, and what is nothing, to frame.
  EXPECT_GT(frame_points({}, {}, {}, 10, 10).distance, 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_GT(frame_points({}, {}, {{nan, 0, 0}, {1, 1, 1}}, 10, 10).distance, 0);
  EXPECT_GT(frame_turning({}, {}, {}, points, 100, 100).distance, 9);
}

}  // namespace
}  // namespace mien::render
