// SPDX-License-Identifier: MIT
// Styles of hair of the generated head, at every LOD.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "author/generate/head/mesh.h"

namespace mien::head {
namespace {

constexpr HairStyle kStyles[] = {HairStyle::kParted, HairStyle::kCropped, HairStyle::kCurly,
                                 HairStyle::kReceding, HairStyle::kBob};

struct Hair {
  Arena arena{default_allocator()};
  HalfMesh mesh{arena};

  Hair(HairStyle style, uint32_t lod) {
    Person person;
    person.style = style;
    person.hair = {40, 30, 20}, person.skin = {200, 160, 140};
    EXPECT_TRUE(make_hairs(Form(person), Part::kHair, lod, mesh));
  }

  /// Height of the lowest vertex at an angle from the front, on both sides.
  double lowest(double from, double to) const {
    double low = 100;
    for (const Vertex& v : mesh.vertices.span()) {
      const double angle = std::abs(std::atan2(v.position.x, v.position.z + 0.4)) * 180 / 3.14159;
      if (angle >= from && angle <= to) low = std::min(low, v.position.y);
    }
    return low;
  }
};

TEST(Hair, KeepsItsLineDownToTheCoarsestLod) {
  for (const HairStyle style : kStyles) {
    const Hair fine(style, 0);
    for (uint32_t lod = 0; lod < kLodCount; ++lod) {
      const Hair hair(style, lod);
      const int number = static_cast<int>(style);
      const double forehead = hair.lowest(0, 12);
      EXPECT_NEAR(forehead, fine.lowest(0, 12), 0.6) << number << " LOD " << lod;
      EXPECT_GT(forehead, 5.6) << number << " LOD " << lod << ": over the brows";
      // Down to the sideburns and the nape.
      EXPECT_LT(hair.lowest(70, 95), 0.5) << number << " LOD " << lod;
      EXPECT_LT(hair.lowest(160, 180), -4.5) << number << " LOD " << lod;
      EXPECT_GT(hair.lowest(160, 180), -9) << number << " LOD " << lod;
    }
  }
}

TEST(Hair, StylesAreWhatTheirNamesSay) {
  const Hair parted(HairStyle::kParted, 0), cropped(HairStyle::kCropped, 0),
      curly(HairStyle::kCurly, 0), receding(HairStyle::kReceding, 0), bob(HairStyle::kBob, 0);
  // Temples that are bare, and a line that is higher.
  EXPECT_GT(receding.lowest(32, 40), cropped.lowest(32, 40) + 1.2);
  EXPECT_GT(receding.lowest(0, 12), cropped.lowest(0, 12) + 0.4);
  // Over the ears down to the jaw.
  EXPECT_LT(bob.lowest(85, 110), -6);
  EXPECT_GT(cropped.lowest(92, 110), -1.5);
  const auto top = [](const Hair& hair) {
    double y = 0;
    for (const Vertex& v : hair.mesh.vertices.span()) y = std::max(y, v.position.y);
    return y;
  };
  EXPECT_GT(top(parted), top(cropped));
  EXPECT_GT(top(curly), top(cropped) + 0.3);
  EXPECT_GT(top(cropped), top(receding) + 0.2);
}

/// Roots at the skin, the body above it, and nothing that stands off.
TEST(Hair, LiesOnTheSkull) {
  for (const HairStyle style : kStyles) {
    for (const uint32_t lod : {0u, 3u, 7u}) {
      const Hair hair(style, lod);
      for (const Vertex& v : hair.mesh.vertices.span()) {
        const Vec3 p = v.position;
        ASSERT_TRUE(std::isfinite(p.x + p.y + p.z) && std::isfinite(v.normal.x));
        ASSERT_TRUE(v.u >= 0 && v.u <= 1 && v.v >= 0.2 && v.v <= 1) << v.u << " " << v.v;
        const double x = p.x / 8.0, y = (p.y - 2.5) / 10.2, z = (p.z + 0.6) / 9.6;
        EXPECT_TRUE(p.y < 0 || x * x + y * y + z * z < 1.75) << static_cast<int>(style);
      }
    }
  }
}

/// Whether a segment goes through a triangle.
bool pierces(Vec3 from, Vec3 to, const Vec3* corners) {
  const Vec3 n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double before = dot(n, from - corners[0]), behind = dot(n, to - corners[0]);
  if (before * behind >= 0) return false;
  const Vec3 at = from + (to - from) * (before / (before - behind));
  for (int k = 0; k < 3; ++k) {
    const Vec3 edge = corners[(k + 1) % 3] - corners[k];
    if (dot(n, cross(edge, at - corners[k])) <= 0) return false;
  }
  return true;
}

/// Pairs of locks whose triangles cut each other. Thin hairs at the line and shells are left out.
size_t cuts(const Hair& hair) {
  const HalfMesh& mesh = hair.mesh;
  std::vector<uint32_t> card(mesh.vertices.count()), faces(card.size());
  for (uint32_t v = 0; v < card.size(); ++v) card[v] = v;
  const auto of = [&card](uint32_t v) {
    while (card[v] != v) v = card[v] = card[card[v]];
    return v;
  };
  for (const Face& f : mesh.faces.span()) {
    for (uint32_t k = 1; k < f.count; ++k) card[of(f.corners[k])] = of(f.corners[0]);
  }
  for (const Face& f : mesh.faces.span()) ++faces[of(f.corners[0])];
  struct Triangle {
    Vec3 corners[3];
    Vec3 low, high;
    uint32_t card;
  };
  std::vector<Triangle> all;
  for (const Face& f : mesh.faces.span()) {
    const uint32_t number = of(f.corners[0]);
    if (faces[number] <= 2 || faces[number] > 20) continue;
    for (uint32_t k = 2; k < f.count; ++k) {
      Triangle t{};
      const uint32_t corners[3] = {f.corners[0], f.corners[k - 1], f.corners[k]};
      for (int i = 0; i < 3; ++i) t.corners[i] = mesh.vertices[corners[i]].position;
      const auto [a, b, c] = t.corners;
      t.low = {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
      t.high = {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
      t.card = number;
      all.push_back(t);
    }
  }
  std::sort(all.begin(), all.end(),
            [](const Triangle& a, const Triangle& b) { return a.low.x < b.low.x; });
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (size_t i = 0; i < all.size(); ++i) {
    const Triangle& a = all[i];
    for (size_t j = i + 1; j < all.size() && all[j].low.x <= a.high.x; ++j) {
      const Triangle& b = all[j];
      if (a.card == b.card || a.low.y > b.high.y || b.low.y > a.high.y || a.low.z > b.high.z ||
          b.low.z > a.high.z) {
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        if (pierces(a.corners[k], a.corners[(k + 1) % 3], b.corners) ||
            pierces(b.corners[k], b.corners[(k + 1) % 3], a.corners)) {
          pairs.insert(std::minmax(a.card, b.card));
        }
      }
    }
  }
  return pairs.size();
}

/// 204 locks lie on each other; a few cut each other where they come together, at the temples and the crown.
TEST(Hair, LayersOfTheBobDoNotCutEachOther) {
  EXPECT_LE(cuts(Hair(HairStyle::kBob, 0)), 60u);
  EXPECT_GT(cuts(Hair(HairStyle::kCurly, 0)), 100u);  // others may
}

}  // namespace
}  // namespace mien::head
