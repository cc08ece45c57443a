// SPDX-License-Identifier: MIT
#include "integrations/program/render/skin_texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mien::render {
namespace {

/// Skin of 16 x 16 cm, flat, that fills the texture; below v = 1/2 + `gap` and above 1/2 - `gap` if there is one.
struct Sheet {
  std::vector<float> positions, coordinates;
  std::vector<uint8_t> colors;
  std::vector<uint32_t> triangles;

  explicit Sheet(float gap = 0) {
    const auto quad = [&](float low, float high) {
      const auto first = uint32_t(positions.size() / 3);
      for (const auto& [u, v] : {std::pair{0.0f, low}, {1.0f, low}, {1.0f, high}, {0.0f, high}}) {
        positions.insert(positions.end(), {16 * u, 16 * v, 0});
        coordinates.insert(coordinates.end(), {u, v});
        colors.insert(colors.end(), {200, 150, 130});
      }
      for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) triangles.push_back(first + k);
    };
    quad(0, 0.5f - gap);
    quad(0.5f + gap, 1);
  }
  Surface surface() const {
    Surface s;
    s.positions = positions.data();
    s.position_count = s.vertex_count = positions.size() / 3;
    s.triangles = triangles.data();
    s.triangle_count = triangles.size() / 3;
    s.colors = colors.data();
    s.texture_coordinates = coordinates.data();
    return s;
  }
};

SkinLayout plain_layout() {
  SkinLayout layout;
  layout.skin_u = 0.5f, layout.skin_v = 0.5f;
  layout.plain_u = 0.5f, layout.plain_v = 1;
  return layout;
}

/// Mean red of the pixels around a place, and how far apart they are.
struct Spread {
  double mean, deviation;
};
Spread around(const Image& image, double u, double v, int half = 10) {
  const int x = int(u * image.width), y = int((1 - v) * image.height);
  double sum = 0, squares = 0, count = 0;
  for (int j = -half; j < half; ++j) {
    for (int i = -half; i < half; ++i) {
      const double value = image.at(x + i, y + j).r;
      sum += value, squares += value * value, ++count;
    }
  }
  return {sum / count, std::sqrt(std::max(squares / count - sum * sum / count / count, 0.0))};
}

TEST(SkinTexture, ZonesShineAndHavePores) {
  const Sheet sheet;
  SkinLayout layout = plain_layout();
  layout.zones = {{0.25f, 0.5f, 0.15f, 0.3f, 0.2f, 0.5f}};
  const SkinMaps maps = make_skin_maps(sheet.surface(), layout, 512, 512);
  for (const double u : {0.25, 0.75}) {  // and its mirror image
    EXPECT_LT(around(maps.roughness, u, 0.5).mean, around(maps.roughness, 0.5, 0.5).mean - 30);
    EXPECT_GT(around(maps.normal, u, 0.5, 30).deviation,
              1.15 * around(maps.normal, 0.5, 0.5, 30).deviation);
  }
  EXPECT_EQ(make_skin_maps(sheet.surface(), layout, 512, 512).normal.pixels, maps.normal.pixels);
}

TEST(SkinTexture, BlotchesAreFaintAndSkinUnderHairHasNoPores) {
  const Sheet sheet;
  SkinLayout layout = plain_layout();
  layout.plain_u = 0.2f;
  const SkinMaps maps = make_skin_maps(sheet.surface(), layout, 512, 512);
  // Means over 6 mm, which is what is seen from afar, differ by about a hundredth.
  double least = 255, most = 0;
  for (double u = 0.1; u < 0.95; u += 0.1) {
    for (double v = 0.1; v < 0.95; v += 0.1) {
      const double mean = around(maps.base_color, u, v).mean;
      least = std::min(least, mean), most = std::max(most, mean);
    }
  }
  EXPECT_LT(most / least, 1.05);
  EXPECT_GT(most / least, 1.002);
  EXPECT_LT(around(maps.normal, 0.95, 0.5).deviation,
            0.5 * around(maps.normal, 0.5, 0.5).deviation);
}

TEST(SkinTexture, RimsOfLidsAreWet) {
  const Sheet sheet(0.02f);
  SkinLayout layout = plain_layout();
  layout.lids_low_u = 0.6f, layout.lids_high_u = 0.9f;
  layout.lids_low_v = 0.4f, layout.lids_high_v = 0.6f;
  const Image rough = make_skin_maps(sheet.surface(), layout, 512, 512).roughness;
  for (const double u : {0.25, 0.75}) {
    EXPECT_LT(around(rough, u, 0.5, 2).mean, 60);  // in the slit and on its rims
    EXPECT_GT(around(rough, u, 0.56, 2).mean, 100);
  }
  EXPECT_GT(around(rough, 0.5, 0.5, 2).mean, 100);  // no eye
}

TEST(SkinTexture, PapillaeAreOnTopOfTheTongue) {
  const Image normals = make_tongue_normals(192, 256);
  EXPECT_LT(around(normals, 0.5, 0.5).deviation, 0.5 * around(normals, 0.1, 0.5).deviation);
  // Both halves are mirror images.
  for (int x = 0; x < 96; ++x) {
    EXPECT_NEAR(normals.at(x, 100).r, 255 - normals.at(191 - x, 100).r, 1);
    EXPECT_NEAR(normals.at(x, 100).g, normals.at(191 - x, 100).g, 1);
  }
}

}  // namespace
}  // namespace mien::render
