// SPDX-License-Identifier: MIT
// Which triangle is seen where, against plain geometry in double precision.
#include "integrations/program/render/visibility.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace mien::render {
namespace {

using namespace math;

/// One unit is one pixel, x right, y up from the lower left corner.
Lens flat_lens(int height) {
  Lens lens;
  lens.perspective = false;
  lens.center_y = float(height);
  return lens;
}

Lens wide_lens(int size) {
  Lens lens;
  lens.focal = float(size) / 2;
  lens.center_x = lens.center_y = float(size) / 2;
  lens.near = 0.1f;
  return lens;
}

TriangleList list(const std::vector<Vec3>& corners, const std::vector<uint32_t>& indices,
                  uint32_t first = 1) {
  return {corners.data(), corners.size(),     nullptr, corners.size(),
          indices.data(), indices.size() / 3, first};
}

Visibility draw_one(const std::vector<Vec3>& corners, const Lens& lens, int size, int samples) {
  Visibility out;
  out.reset(size, size, samples);
  std::vector<uint32_t> indices(corners.size() / 3 * 3);
  for (size_t i = 0; i < indices.size(); ++i) indices[i] = uint32_t(i);
  draw(list(corners, indices), lens, out);
  return out;
}

size_t count(const Visibility& v, uint32_t number) {
  size_t n = 0;
  for (const Seen& seen : v.seen) n += seen.triangle == number;
  return n;
}

double side(Vec3 a, Vec3 b, double x, double y) {
  return (double(b.x) - a.x) * (y - a.y) - (double(b.y) - a.y) * (x - a.x);
}

TEST(Visibility, CoversWhatGeometrySays) {
  constexpr int kSize = 64;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-20, 84);
  for (int round = 0; round < 200; ++round) {
    const std::vector<Vec3> t = {{place(random), place(random), 1},
                                 {place(random), place(random), 1},
                                 {place(random), place(random), 1}};
    for (const int samples : {1, 4, 16}) {
      const Visibility seen = draw_one(t, flat_lens(kSize), kSize, samples);
      const SamplePattern pattern = sample_pattern(samples);
      for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
          for (int s = 0; s < samples; ++s) {
            const double px = x + pattern.places[s][0] / 256.0;
            const double py = kSize - (y + pattern.places[s][1] / 256.0);
            const double a = side(t[0], t[1], px, py), b = side(t[1], t[2], px, py),
                         c = side(t[2], t[0], px, py);
            // Corners are rounded to 1/256: what is that near to an edge may go either way.
            const double near = 130.0 / 256;
            if (std::fabs(a) < near || std::fabs(b) < near || std::fabs(c) < near) continue;
            const bool inside = (a > 0) == (b > 0) && (b > 0) == (c > 0);
            ASSERT_EQ(seen.at(x, y, s).triangle, inside ? 1u : 0u) << x << ", " << y;
          }
        }
      }
    }
  }
}

TEST(Visibility, NeighborsShareEverySampleOfTheirEdge) {
  constexpr int kSize = 48;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(8, 40);
  for (int round = 0; round < 50; ++round) {
    // A fan around a place within a square, some corners on samples exactly.
    const Vec3 middle = round % 2 ? Vec3{place(random), place(random), 1} : Vec3{24.5f, 24.5f, 1};
    const std::vector<Vec3> rim = {{2, 2, 1}, {46, 2, 1}, {46, 46, 1}, {2, 46, 1}};
    std::vector<int> covered(size_t{kSize} * kSize * 4);
    for (size_t i = 0; i < 4; ++i) {
      // Every other one wound the other way.
      const Vec3 a = rim[i], b = rim[(i + 1) % 4];
      const std::vector<Vec3> t =
          i % 2 ? std::vector<Vec3>{middle, a, b} : std::vector<Vec3>{middle, b, a};
      const Visibility seen = draw_one(t, flat_lens(kSize), kSize, 4);
      for (size_t s = 0; s < covered.size(); ++s) covered[s] += seen.seen[s].triangle != 0;
    }
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const int expected = x >= 2 && x < 46 && y >= 2 && y < 46;
        for (size_t s = 0; s < 4; ++s) {
          ASSERT_EQ(covered[(size_t(y) * kSize + size_t(x)) * 4 + s], expected) << x << ", " << y;
        }
      }
    }
  }
}

TEST(Visibility, EdgesAreSmooth) {
  // An edge at x = 10 + k/16 leaves k of 16 samples of its pixel to the left of it.
  for (int k = 0; k <= 16; ++k) {
    const float x = 10 + float(k) / 16;
    const Visibility seen =
        draw_one({{-50, -50, 1}, {x, -50, 1}, {x, 90, 1}}, flat_lens(32), 32, 16);
    int covered = 0;
    for (int s = 0; s < 16; ++s) covered += seen.at(10, 20, s).triangle != 0;
    EXPECT_EQ(covered, k);
  }
}

TEST(Visibility, NearestShowsWhateverTheOrder) {
  const std::vector<Vec3> near = {{0, 0, 2}, {32, 0, 2}, {0, 32, 2}};
  const std::vector<Vec3> far = {{0, 0, 1}, {32, 0, 1}, {0, 32, 1}};
  for (const bool near_first : {true, false}) {
    std::vector<Vec3> both = near_first ? near : far;
    const std::vector<Vec3>& second = near_first ? far : near;
    both.insert(both.end(), second.begin(), second.end());
    const Visibility seen = draw_one(both, flat_lens(32), 32, 4);
    EXPECT_GT(count(seen, near_first ? 1 : 2), 1900u);
    EXPECT_EQ(count(seen, near_first ? 2 : 1), 0u);
  }
  // Of equal ones the first stays.
  std::vector<Vec3> same = near;
  same.insert(same.end(), near.begin(), near.end());
  EXPECT_EQ(count(draw_one(same, flat_lens(32), 32, 4), 2), 0u);
}

/// Distance along the viewing direction at which a ray meets a triangle; 0 if it does not.
double meet(const std::vector<Vec3>& t, double dx, double dy, double margin) {
  const auto vector = [](Vec3 a) { return std::array<double, 3>{a.x, a.y, a.z}; };
  using D3 = std::array<double, 3>;
  const auto crossed = [](D3 a, D3 b) {
    return D3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto dotted = [](D3 a, D3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const D3 a = vector(t[0]), b = vector(t[1]), c = vector(t[2]), ray = {dx, dy, -1};
  double u = dotted(ray, crossed(b, c)), v = dotted(ray, crossed(c, a)),
         w = dotted(ray, crossed(a, b));
  const double sum = u + v + w;
  u /= sum;
  v /= sum;
  w /= sum;
  if (u < margin || v < margin || w < margin) return 0;
  return -(a[2] * u + b[2] * v + c[2] * w);
}

TEST(Visibility, PerspectiveIsThatOfRaysEvenThroughTheNearPlane) {
  constexpr int kSize = 48;
  const Lens lens = wide_lens(kSize);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-4, 4), depth(-6, 2);
  int seen_some = 0, crossing = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3> t;
    for (int k = 0; k < 3; ++k) t.push_back({place(random), place(random), depth(random)});
    crossing += t[0].z > -lens.near || t[1].z > -lens.near || t[2].z > -lens.near;
    const Visibility seen = draw_one(t, lens, kSize, 1);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const double dx = (x + 0.5 - lens.center_x) / lens.focal;
        const double dy = (lens.center_y - y - 0.5) / lens.focal;
        const double inside = meet(t, dx, dy, 0.03), around = meet(t, dx, dy, -0.03);
        const Seen& at = seen.at(x, y, 0);
        if (inside > lens.near * 1.05) {
          ASSERT_EQ(at.triangle, 1u) << "round " << round << " at " << x << ", " << y;
          // Steep planes change much within the 1/256 that corners are rounded to.
          ASSERT_NEAR(at.depth * inside, 1, 0.1);
          ++seen_some;
        } else if (around == 0) {
          ASSERT_EQ(at.triangle, 0u) << "round " << round << " at " << x << ", " << y;
        }
      }
    }
  }
  EXPECT_GT(seen_some, 10000);
  EXPECT_GT(crossing, 50);
}

TEST(Visibility, DepthIsPerspectiveCorrect) {
  // A floor that goes from 2 to 40 away.
  constexpr int kSize = 64;
  const Lens lens = wide_lens(kSize);
  const std::vector<Vec3> floor = {{-90, -1, -2}, {90, -1, -2}, {0, -1, -40}};
  const Visibility seen = draw_one(floor, lens, kSize, 1);
  int rows = 0;
  for (int y = 0; y < kSize; ++y) {
    const Seen& at = seen.at(kSize / 2, y, 0);
    if (at.triangle == 0) continue;
    const float slope = (float(y) + 0.5f - lens.center_y) / lens.focal;
    EXPECT_NEAR(1 / at.depth, 1 / slope, 0.01f / slope);
    ++rows;
  }
  EXPECT_GT(rows, 12);
}

TEST(Visibility, SurvivesAnything) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const float values[] = {0, 1, -1, 1e-38f, 1e9f, -1e9f, 3e38f, -3e38f, nan, infinity, -infinity};
  std::mt19937 random(5);
  std::uniform_int_distribution<size_t> pick(0, std::size(values) - 1);
  for (int round = 0; round < 20000; ++round) {
    std::vector<Vec3> t;
    bool finite = true;
    for (int k = 0; k < 3; ++k) {
      t.push_back({values[pick(random)], values[pick(random)], values[pick(random)]});
      finite &= is_finite(t.back());
    }
    const Visibility seen =
        draw_one(t, round % 2 ? flat_lens(8) : wide_lens(8), 8, round % 3 ? 4 : 1);
    if (!finite) {
      ASSERT_EQ(count(seen, 1), 0u);
    }
    for (const Seen& at : seen.seen) ASSERT_TRUE(std::isfinite(at.depth));
  }
}

TEST(Visibility, HugeTrianglesCoverAll) {
  // From about 1e7 times the distance on, 32-bit floats cannot tell where such a triangle is.
  for (const float size : {100.0f, 1e4f, 1e6f}) {
    const Visibility seen =
        draw_one({{-size, -size, -3}, {size, -size, -3}, {0, 2 * size, -3}}, wide_lens(32), 32, 4);
    EXPECT_EQ(count(seen, 1), 32u * 32 * 4) << size;
  }
}

TEST(Visibility, LeavesOutWhatIsNotThere) {
  Visibility out;
  out.reset(16, 16, 1);
  const std::vector<Vec3> corners = {{0, 0, 1}, {16, 0, 1}, {0, 16, 1}};
  draw(list(corners, {0, 1, 3, 0, 1, 0xffffffffu}), flat_lens(16), out);
  EXPECT_EQ(count(out, 0), 256u);
  const uint32_t positions_of[] = {0, 1, 9};
  const uint32_t indices[] = {0, 1, 2, 0, 1, 5};
  draw({corners.data(), 3, positions_of, 3, indices, 2, 1}, flat_lens(16), out);
  EXPECT_EQ(count(out, 0), 256u);
  // No area.
  draw(list(corners, {0, 0, 1, 1, 1, 1}), flat_lens(16), out);
  EXPECT_EQ(count(out, 0), 256u);
}

}  // namespace
}  // namespace mien::render
