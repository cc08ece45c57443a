// SPDX-License-Identifier: MIT
#include "integrations/program/render/eye_texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mien::render {
namespace {

constexpr int kSize = 256;
constexpr double kPi = 3.14159265358979;

/// Mean color of a ring at an angle from the pupil in radians, over the turns between two.
struct Mean {
  double r = 0, g = 0, b = 0;
  double brightness() const { return (r + g + b) / 3; }
};
Mean ring(const Image& image, double angle, double from = 0, double to = 2 * kPi) {
  Mean mean;
  constexpr int kSteps = 180;
  for (int i = 0; i < kSteps; ++i) {
    const double turn = from + (to - from) * i / kSteps, radius = 0.45 * angle / 1.25 * image.width;
    const Color c = image.at(int(image.width * 0.5 + radius * std::cos(turn)),
                             int(image.height * 0.5 - radius * std::sin(turn)));
    mean.r += c.r / double(kSteps), mean.g += c.g / double(kSteps), mean.b += c.b / double(kSteps);
  }
  return mean;
}

TEST(EyeTexture, HasPupilIrisLimbusAndWhite) {
  const EyeMaps blue = make_eye_maps({62, 122, 138}, kSize),
                brown = make_eye_maps({98, 62, 34}, kSize);
  for (const EyeMaps* maps : {&blue, &brown}) {
    const Image& image = maps->base_color;
    EXPECT_LT(ring(image, 0.08).brightness(), 20);
    EXPECT_GT(ring(image, 0.30).brightness(), 2 * ring(image, 0.08).brightness());
    EXPECT_LT(ring(image, 0.43).brightness(), 0.8 * ring(image, 0.33).brightness());
    // The white is not white, and is redder where it goes back into the corners.
    const Mean white = ring(image, 0.60, -0.3, 0.3), corner = ring(image, 1.0, -0.3, 0.3);
    EXPECT_GT(white.brightness(), 150);
    EXPECT_LT(white.brightness(), 225);
    EXPECT_GT(corner.r / corner.g, 1.1 * white.r / white.g);
    // The upper lid shades it.
    EXPECT_LT(ring(image, 0.6, 0.4 * kPi, 0.6 * kPi).brightness(),
              0.95 * ring(image, 0.6, 1.4 * kPi, 1.6 * kPi).brightness());
  }
  const Mean of_blue = ring(blue.base_color, 0.33), of_brown = ring(brown.base_color, 0.33);
  EXPECT_GT(of_blue.b, of_blue.r);
  EXPECT_LT(of_brown.b, of_brown.r);
}

TEST(EyeTexture, NormalsLeanOutwardsOnTheCornea) {
  const Image normals = make_eye_maps({62, 122, 138}, 2 * kSize).normal;
  EXPECT_EQ(normals.width, kSize);
  const auto at = [&](double angle, double turn) {
    const double radius = 0.45 * angle / 1.25 * kSize;
    return normals.at(int(kSize * 0.5 + radius * std::cos(turn)),
                      int(kSize * 0.5 - radius * std::sin(turn)));
  };
  EXPECT_NEAR(at(0, 0).b, 255, 1);
  EXPECT_GT(at(0.40, 0).r, 140);          // right of the pupil, to the right
  EXPECT_LT(at(0.40, kPi).r, 115);        // left of it, to the left
  EXPECT_GT(at(0.40, 0.5 * kPi).g, 140);  // above, upwards
  EXPECT_LT(at(0.40, 1.5 * kPi).g, 115);
  EXPECT_NEAR(at(0.70, 0).r, 127.5, 1);  // the ball has its own
}

}  // namespace
}  // namespace mien::render
