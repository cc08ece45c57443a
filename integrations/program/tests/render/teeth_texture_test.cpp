// SPDX-License-Identifier: MIT
#include "integrations/program/render/teeth_texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mien::render {
namespace {

constexpr int kWidth = 512, kHeight = 256;

struct Mean {
  double r = 0, g = 0, b = 0, deviation = 0;  // the deviation is that of green
};
/// Over a box of the texture, in u and v.
Mean mean_of(const Image& image, double u0, double u1, double v0, double v1) {
  Mean mean;
  double squares = 0, count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double u = (x + 0.5) / image.width, v = 1 - (y + 0.5) / image.height;
      if (u < u0 || u > u1 || v < v0 || v > v1) continue;
      const Color c = image.at(x, y);
      mean.r += c.r, mean.g += c.g, mean.b += c.b;
      squares += double(c.g) * c.g;
      ++count;
    }
  }
  mean.r /= count, mean.g /= count, mean.b /= count;
  mean.deviation = std::sqrt(std::max(squares / count - mean.g * mean.g, 0.0));
  return mean;
}

const TeethMaps& maps() {
  static const TeethMaps made = make_teeth_maps(kWidth, kHeight);
  return made;
}

/// u of places of the first upper incisor, which is 0.86 of 10.92 cm wide.
double incisor(double share) { return 0.5 + 0.86 / 10.92 * share; }

TEST(TeethTexture, EnamelIsWarmAtTheNeckAndBluishAtTheEdge) {
  const Image& image = maps().base_color;
  const double u0 = incisor(0.3), u1 = incisor(0.7);
  const Mean neck = mean_of(image, u0, u1, 0.24, 0.27), middle = mean_of(image, u0, u1, 0.34, 0.38),
             edge = mean_of(image, u0, u1, 0.455, 0.467);
  EXPECT_GT(middle.g, neck.g);
  EXPECT_GT(middle.g, edge.g);
  EXPECT_GT(neck.r / neck.b, 1.1 * middle.r / middle.b);
  EXPECT_LT(edge.r / edge.b, 0.97 * middle.r / middle.b);
}

TEST(TeethTexture, StriaeRunUpAndDown) {
  const Image& image = maps().base_color;
  double across = 0, along = 0;
  const int x0 = int(incisor(0.3) * kWidth), x1 = int(incisor(0.7) * kWidth);
  for (int y = int(0.62 * kHeight); y < int(0.66 * kHeight); ++y) {
    for (int x = x0; x < x1; ++x) {
      across += std::abs(image.at(x + 1, y).g - image.at(x, y).g);
      along += std::abs(image.at(x, y + 1).g - image.at(x, y).g);
    }
  }
  EXPECT_GT(across, 1.3 * along);
}

TEST(TeethTexture, NoTwoTeethAreAlike) {
  const Image& image = maps().base_color;
  const Mean right = mean_of(image, 1 - incisor(0.7), 1 - incisor(0.3), 0.32, 0.40);
  const Mean left = mean_of(image, incisor(0.3), incisor(0.7), 0.32, 0.40);
  const Mean canine = mean_of(image, incisor(1.94), incisor(2.5), 0.32, 0.40);
  EXPECT_GT(std::abs(right.g - left.g) + std::abs(right.b - left.b), 0.5);
  EXPECT_LT(std::abs(right.g - left.g), 12);
  EXPECT_GT(canine.r / canine.b, 1.04 * left.r / left.b);
}

TEST(TeethTexture, GumsAreRedStippledAndSmoothWhereTheyAreLoose) {
  const Mean attached = mean_of(maps().base_color, 0.5, 0.6, 0.08, 0.11),
             loose = mean_of(maps().base_color, 0.5, 0.6, 0.0, 0.02);
  EXPECT_GT(attached.r, 1.3 * attached.g);
  EXPECT_GT(loose.r / loose.g, 1.2 * attached.r / attached.g);
  EXPECT_GT(mean_of(maps().normal, 0.5, 0.7, 0.08, 0.11).deviation,
            1.5 * mean_of(maps().normal, 0.5, 0.7, 0.0, 0.02).deviation);
}

TEST(TeethTexture, AllIsWetAndWhatIsFarBackIsDark) {
  EXPECT_EQ(maps().roughness.width, kWidth / 2);
  EXPECT_EQ(maps().roughness.height, kHeight / 2);
  EXPECT_LT(mean_of(maps().roughness, 0, 1, 0, 1).g, 80);
  for (const double jaw : {0.0, 0.5}) {
    const double low = jaw + 0.30, high = jaw + 0.40;
    EXPECT_LT(mean_of(maps().base_color, 0.02, 0.06, low, high).g,
              0.6 * mean_of(maps().base_color, 0.42, 0.48, low, high).g);
  }
}

}  // namespace
}  // namespace mien::render
