// SPDX-License-Identifier: MIT
// The motion of space with a surface, against the same sums over all points sorted by distance.
#include "author/document/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "author/base/random.h"
#include "author/fit/procrustes.h"

namespace mien::author {
namespace {

double number(Random& random) { return static_cast<double>(random.below(20001)) / 10000 - 1; }
Vec3 vector(Random& random) { return {number(random), number(random), number(random)}; }

Similarity by_definition(const std::vector<Vec3>& before, const std::vector<Vec3>& after,
                         Vec3 place) {
  std::vector<std::pair<double, size_t>> order;
  for (size_t i = 0; i < before.size(); ++i)
    order.push_back({squared_distance(before[i], place), i});
  std::sort(order.begin(), order.end());
  order.resize(std::min<size_t>(order.size(), 96));
  const double radius = order.back().first * 1.0001 + 1e-300;
  std::vector<double> weights;
  double sum = 0;
  Similarity out;
  for (const auto& [distance, point] : order) {
    const double fall = 1 - distance / radius;
    weights.push_back(std::max(fall * fall, 1e-6) / (distance + radius * 1e-4));
    sum += weights.back();
    out.from = out.from + before[point] * weights.back();
    out.to = out.to + after[point] * weights.back();
  }
  out.from = out.from * (1 / sum);
  out.to = out.to * (1 / sum);
  Vec3 map[3], rows[3];
  double old_size = 0, new_size = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    const Vec3 x = before[order[i].second] - out.from, y = after[order[i].second] - out.to;
    map[0] = map[0] + x * (weights[i] * y.x);
    map[1] = map[1] + x * (weights[i] * y.y);
    map[2] = map[2] + x * (weights[i] * y.z);
    old_size += weights[i] * dot(x, x);
    new_size += weights[i] * dot(y, y);
  }
  closest_rotation(map, 1, rows);
  for (int r = 0; r < 3; ++r) {
    out.turn.m[0][r] = rows[r].x;
    out.turn.m[1][r] = rows[r].y;
    out.turn.m[2][r] = rows[r].z;
  }
  out.scale = std::sqrt(new_size / old_size);
  return out;
}

// On a bent sheet, on a line (which does not fix a rotation about it), and in a cloud.
TEST(Warp, IsTheSimilarityOfTheNearestPoints) {
  for (int shape = 0; shape < 3; ++shape) {
    for (size_t count : {size_t{5}, size_t{96}, size_t{97}, size_t{2000}}) {
      Random random(count, static_cast<uint64_t>(shape));
      std::vector<Vec3> before, after;
      for (size_t i = 0; i < count; ++i) {
        Vec3 p = vector(random);
        if (shape == 0) p.z = p.x * p.x;
        if (shape == 1) p = {p.x, 0.1 * number(random) * p.x, 0};
        before.push_back(p);
        after.push_back(Vec3{p.y * 2, p.x * -2 + 0.3 * p.z, p.z * 2 + 7} + vector(random) * 0.01);
      }
      Arena arena(default_allocator());
      Warp warp;
      ASSERT_TRUE(warp.build({before.data(), count}, {after.data(), count}, arena));
      WarpHint hint;
      Vec3 place;
      for (int i = 0; i < 200; ++i) {
        place = i % 10 == 0 ? vector(random) : place + vector(random) * 0.02;
        const Similarity found = warp.at(place, hint), wanted = by_definition(before, after, place);
        EXPECT_NEAR(found.scale, wanted.scale, 1e-9);
        EXPECT_LT(length(found(place) - wanted(place)), 1e-7) << shape << " " << count;
        EXPECT_EQ(length(found(place) - warp.at(place)(place)), 0) << "depends on the hint";
      }
    }
  }
}

TEST(Warp, LeavesSpaceAloneWhereNoNearPointMoves) {
  Random random(1, 2);
  std::vector<Vec3> before, after;
  for (int i = 0; i < 4000; ++i) {
    before.push_back(vector(random));
    after.push_back(before.back());
    if (before.back().x > 0.7) after.back().y += 0.5;
  }
  Arena arena(default_allocator());
  Warp warp;
  ASSERT_TRUE(warp.build({before.data(), before.size()}, {after.data(), after.size()}, arena));
  WarpHint hint;
  int known = 0, still = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 place = vector(random) * 1.2;
    const bool stays = warp.stays(place, hint), same = warp.at(place, hint).is_identity();
    EXPECT_TRUE(!stays || same) << i;
    known += stays;
    still += same;
  }
  EXPECT_GT(known, 100);
  EXPECT_LT(still, 2900);
  ASSERT_TRUE(warp.build({before.data(), before.size()}, {before.data(), before.size()}, arena));
  EXPECT_TRUE(warp.stays({5, 5, 5}, hint));
}

}  // namespace
}  // namespace mien::author
