// SPDX-License-Identifier: MIT
#include "author/place/linkage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "author/base/random.h"

namespace mien::author {
namespace {

/// Average linkage by its definition: the matrix of all distances, two closest groups merged, the
/// distances to the others averaged. Keeps the group of each point when as many are left as asked for.
struct General {
  std::map<uint32_t, std::vector<uint32_t>> groups;  // by how many are left
  std::vector<double> merges;

  template <class Apart>
  General(const Apart& apart, const std::vector<double>& weights,
          const std::vector<uint32_t>& counts) {
    const size_t n = weights.size();
    std::vector<uint32_t> group(n);
    std::vector<std::vector<double>> distance(n, std::vector<double>(n));
    std::vector<double> size = weights;
    std::vector<bool> alive(n, true);
    for (size_t a = 0; a < n; ++a) {
      group[a] = static_cast<uint32_t>(a);
      for (size_t b = 0; b < n; ++b) distance[a][b] = apart(a, b);
    }
    // The nearest other group of each, so that a step is O(n).
    std::vector<size_t> near(n);
    const auto find = [&](size_t a) {
      near[a] = a;
      for (size_t b = 0; b < n; ++b) {
        if (b == a || !alive[b]) continue;
        if (near[a] == a || distance[a][b] < distance[a][near[a]]) near[a] = b;
      }
    };
    for (size_t a = 0; a < n; ++a) find(a);
    for (size_t left = n;; --left) {
      if (std::count(counts.begin(), counts.end(), left)) {
        groups[static_cast<uint32_t>(left)] = group;
      }
      if (left == 1) break;
      size_t a = n;
      for (size_t c = 0; c < n; ++c) {
        if (alive[c] && (a == n || distance[c][near[c]] < distance[a][near[a]])) a = c;
      }
      const size_t b = near[a];
      merges.push_back(distance[a][b]);
      alive[b] = false;
      for (size_t c = 0; c < n; ++c) {
        if (!alive[c] || c == a) continue;
        distance[a][c] = distance[c][a] =
            (size[a] * distance[a][c] + size[b] * distance[b][c]) / (size[a] + size[b]);
      }
      size[a] += size[b];
      for (uint32_t& g : group) g = g == b ? static_cast<uint32_t>(a) : g;
      for (size_t c = 0; c < n; ++c) {
        if (alive[c] && (c == a || near[c] == a || near[c] == b)) find(c);
        if (alive[c] && c != a && distance[c][a] < distance[c][near[c]]) near[c] = a;
      }
    }
  }
};

std::vector<uint32_t> groups_of(const Linkage& linkage, uint32_t count) {
  uint32_t starts[64];
  std::vector<uint32_t> group(linkage.order.count);
  linkage.group_starts(count, starts);
  for (uint32_t g = 0; g < count; ++g) {
    const size_t end = g + 1 < count ? starts[g + 1] : linkage.order.count;
    for (size_t i = starts[g]; i < end; ++i) group[linkage.order[i]] = g;
  }
  return group;
}

bool same_partition(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  std::map<uint32_t, uint32_t> to, from;
  for (size_t i = 0; i < a.size(); ++i) {
    if (to.emplace(a[i], b[i]).first->second != b[i]) return false;
    if (from.emplace(b[i], a[i]).first->second != a[i]) return false;
  }
  return true;
}

struct Values {
  std::vector<double> values, weights;

  Values(uint64_t seed, size_t count, bool weighted) {
    Random random = Random::from_seed(seed, 1);
    for (size_t i = 0; i < count; ++i) {
      // Lumps, as of depth, and far from the origin.
      values.push_back(100 + 10 * random.below(4) + 3 * random.normal());
      weights.push_back(weighted ? random.between(0.1, 4) : 1);
    }
  }
};

TEST(Linkage, GivesThePartitionsOfTheGeneralMethod) {
  const size_t n = 1500;
  const std::vector<uint32_t> counts = {2, 3, 5, 10, 50};
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Values made(seed, n, seed % 2 == 1);
    Arena arena(default_allocator());
    Linkage linkage;
    ASSERT_TRUE(
        link_on_line({made.values.data(), n}, {made.weights.data(), n}, arena, arena, linkage));
    ASSERT_EQ(linkage.merges.count, n - 1);
    const auto apart = [&](size_t a, size_t b) {
      return std::abs(made.values[a] - made.values[b]);
    };
    General general(apart, made.weights, counts);
    for (const uint32_t count : counts) {
      EXPECT_TRUE(same_partition(groups_of(linkage, count), general.groups[count]))
          << seed << " " << count;
    }
    for (size_t m = 0; m < n - 1; ++m) {
      EXPECT_NEAR(linkage.merges[m].distance, general.merges[m], 1e-9) << seed << " " << m;
    }
  }
}

TEST(Linkage, MergesEqualValuesFirstAndAtNoDistance) {
  const double values[] = {3, 1, 1, 3, 2, 1};
  Arena arena(default_allocator());
  Linkage linkage;
  ASSERT_TRUE(link_on_line({values, 6}, {}, arena, arena, linkage));
  for (size_t m = 0; m < 3; ++m) EXPECT_EQ(linkage.merges[m].distance, 0) << m;
  EXPECT_EQ(groups_of(linkage, 3), (std::vector<uint32_t>{2, 0, 0, 2, 1, 0}));
}

TEST(Linkage, OfOnePointHasNoMerges) {
  const double value = 4;
  Arena arena(default_allocator());
  Linkage linkage;
  ASSERT_TRUE(link_on_line({&value, 1}, {}, arena, arena, linkage));
  EXPECT_EQ(linkage.merges.count, 0u);
  EXPECT_EQ(groups_of(linkage, 1)[0], 0u);
}

TEST(Linkage, DoesNotDependOnTheOrderOfPoints) {
  const Values made(7, 400, true);
  std::vector<double> values(made.values.rbegin(), made.values.rend());
  std::vector<double> weights(made.weights.rbegin(), made.weights.rend());
  Arena arena(default_allocator());
  Linkage one, other;
  ASSERT_TRUE(
      link_on_line({made.values.data(), 400}, {made.weights.data(), 400}, arena, arena, one));
  ASSERT_TRUE(link_on_line({values.data(), 400}, {weights.data(), 400}, arena, arena, other));
  std::vector<uint32_t> turned = groups_of(other, 7);
  std::reverse(turned.begin(), turned.end());
  EXPECT_EQ(groups_of(one, 7), turned);
}

struct InSpace {
  Arena arena{default_allocator()}, scratch{default_allocator()};
  Linkage linkage;
  std::vector<uint8_t> group;

  InSpace(const std::vector<Vec3>& points, const std::vector<double>& weights, uint32_t groups)
      : group(points.size()) {
    EXPECT_TRUE(link_in_space({points.data(), points.size()}, {weights.data(), weights.size()},
                              groups, arena, scratch, linkage, {group.data(), group.size()}));
  }
  std::vector<uint32_t> numbers() const { return {group.begin(), group.end()}; }
};

TEST(LinkInSpace, GivesThePartitionOfTheGeneralMethod) {
  for (uint64_t seed = 0; seed < 10; ++seed) {
    Random random = Random::from_seed(seed, 3);
    std::vector<Vec3> points(300);
    std::vector<double> weights;
    for (Vec3& p : points) {
      p = {random.real(), 2 * random.real(), 3 * random.real()};
      weights.push_back(seed % 2 ? 1 : 0.1 + random.real());
    }
    const auto apart = [&](size_t a, size_t b) { return length(points[a] - points[b]); };
    const std::vector<uint32_t> counts = {1, 2, 3, 5, 16};
    General general(apart, weights, counts);
    for (const uint32_t count : counts) {
      const InSpace ours(points, weights, count);
      EXPECT_TRUE(same_partition(ours.numbers(), general.groups[count])) << seed << " " << count;
      ASSERT_EQ(ours.linkage.merges.count, general.merges.size());
      for (size_t m = 0; m < general.merges.size(); ++m) {
        EXPECT_NEAR(ours.linkage.merges[m].distance, general.merges[m], 1e-9);
      }
      // Front first.
      std::vector<double> depth(count), size(count);
      for (size_t i = 0; i < points.size(); ++i) {
        depth[ours.group[i]] += points[i].z;
        size[ours.group[i]] += 1;
      }
      for (uint32_t g = 1; g < count; ++g) {
        EXPECT_GE(depth[g - 1] / size[g - 1], depth[g] / size[g]);
      }
    }
  }
}

TEST(LinkInSpace, FindsClustersAmongMorePointsThanAreLinked) {
  Random random = Random::from_seed(1, 1);
  std::vector<Vec3> points;
  for (uint32_t i = 0; i < kMaxLinked + 1000; ++i) {
    const double at = i % 3;
    points.push_back({10 * at + random.real(), random.real(), -20 * at + random.real()});
  }
  const InSpace ours(points, {}, 3);
  EXPECT_EQ(ours.linkage.merges.count, kMaxLinked - 1);
  uint32_t wrong = 0;
  for (uint32_t i = 0; i < points.size(); ++i) wrong += ours.group[i] != i % 3;
  EXPECT_LE(wrong, 2u) << "two cells may reach from one cluster to the next";
}

TEST(LinkInSpace, TakesPointsAtOnePlace) {
  const InSpace ours(std::vector<Vec3>(5, Vec3{1, 2, 3}), {}, 3);
  EXPECT_EQ(ours.linkage.merges.count, 4u);
  for (const uint8_t group : ours.group) EXPECT_LT(group, 3);
}

}  // namespace
}  // namespace mien::author
