// SPDX-License-Identifier: MIT
#include "author/fit/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "author/base/random.h"
#include "tests/support/author_setup.h"

namespace mien::author {
namespace {

/// Merges the closest groups by their definition, the mean over all pairs of members.
std::vector<uint16_t> plain_linkage(const std::vector<double>& matrix, size_t n, size_t groups) {
  std::vector<std::vector<size_t>> sets;
  for (size_t i = 0; i < n; ++i) sets.push_back({i});
  const auto mean = [&](const std::vector<size_t>& a, const std::vector<size_t>& b) {
    double sum = 0;
    for (size_t i : a) {
      for (size_t k : b) sum += matrix[i * n + k];
    }
    return sum / static_cast<double>(a.size() * b.size());
  };
  while (sets.size() > groups) {
    size_t x = 0, y = 1;
    for (size_t i = 0; i < sets.size(); ++i) {
      for (size_t k = i + 1; k < sets.size(); ++k) {
        if (mean(sets[i], sets[k]) < mean(sets[x], sets[y])) x = i, y = k;
      }
    }
    sets[x].insert(sets[x].end(), sets[y].begin(), sets[y].end());
    sets.erase(sets.begin() + static_cast<ptrdiff_t>(y));
  }
  for (std::vector<size_t>& set : sets) std::sort(set.begin(), set.end());
  std::sort(sets.begin(), sets.end());
  std::vector<uint16_t> labels(n);
  for (size_t g = 0; g < sets.size(); ++g) {
    for (size_t i : sets[g]) labels[i] = static_cast<uint16_t>(g);
  }
  return labels;
}

TEST(LinkByDistance, IsAverageLinkage) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Random random = Random::from_seed(seed, 1);
    const size_t n = 3 + random.below(40);
    std::vector<Vec3> points;
    for (size_t i = 0; i < n; ++i) points.push_back({random.real(), random.real(), random.real()});
    std::vector<double> matrix;
    for (const Vec3& a : points) {
      for (const Vec3& b : points) matrix.push_back(length(a - b));
    }
    for (uint32_t groups : {1u, 2u, 3u}) {
      Arena arena(default_allocator());
      std::vector<double> used = matrix;
      std::vector<uint16_t> labels(n);
      ASSERT_TRUE(link_by_distance({used.data(), used.size()}, static_cast<uint32_t>(n), groups,
                                   arena, labels.data()));
      EXPECT_EQ(labels, plain_linkage(matrix, n, groups)) << n << " points, seed " << seed;
    }
  }
}

/// Two rows of bones, mirrored, which move side by side; seven on the plane; one control for each side.
struct TwoSides : AuthorSetup {
  Arena arena{default_allocator()};
  Fitter fitter;
  Motions motions;
  JointRegions regions;

  explicit TwoSides(bool symmetric = true) {
    add_trunk();
    for (int i = 0; i < 8; ++i) {
      for (double side : {1.0, -1.0}) {
        add_bone("f", {side * (4 + 0.3 * i), double(i < 4 ? 5 : -5) + 0.2 * i, 0},
                 BoneKind::kFacial, 3);
        const uint32_t j = static_cast<uint32_t>(bones.size() - 1);
        bones[j].mirror = side > 0 ? j + 1 : j - 1;
      }
    }
    for (int i = 0; i < 7; ++i) add_bone("m", {0, double(i), 2}, BoneKind::kFacial, 3);
    for (uint32_t j = 4; j < bones.size(); ++j) {
      add_vertex(bones[j].position + Vec3{0, 0, 0.1});
      add_vertex(bones[j].position + Vec3{0.1, 0, -0.1});
      for (int k = 0; k < 2; ++k) {
        joints.push_back(static_cast<uint16_t>(j));
        weight_values.push_back(1);
      }
    }
    add_shape("left", [&](uint32_t v) { return Vec3{0, positions[v].x > 1 ? 1.0 : 0.0, 0}; });
    add_shape("right", [&](uint32_t v) { return Vec3{0, positions[v].x < -1 ? 1.0 : 0.0, 0}; });
    finish(1);
    placement.symmetric = symmetric;
    FitOptions options;
    EXPECT_TRUE(make_fitter(mesh.positions, placement, 1, options, arena, fitter));
    EXPECT_TRUE(make_motions(2, bones.size(), arena, motions));
    fit_all(fitter, mesh, weights, false, {}, motions);
  }
  void find(uint32_t wanted) {
    EXPECT_TRUE(find_regions(placement, fitter.footprints, motions, wanted, arena,
                             default_allocator(), regions));
  }
};

TEST(FindRegions, MirroredBonesHaveMirroredRegions) {
  TwoSides face;
  face.find(5);
  EXPECT_EQ(face.regions.count, 5u);
  for (uint32_t j = 0; j < 4; ++j) EXPECT_EQ(face.regions.region[j], JointRegions::kNoRegion);
  std::set<uint16_t> left, right;
  for (uint32_t j = 4; j < 20; j += 2) {
    left.insert(face.regions.region[j]);
    right.insert(face.regions.region[j + 1]);
    for (uint32_t k = 4; k < 20; k += 2) {
      EXPECT_EQ(face.regions.region[j] == face.regions.region[k],
                face.regions.region[j + 1] == face.regions.region[k + 1]);
    }
    // The upper four of a side, and the lower four.
    EXPECT_EQ(face.regions.region[j], face.regions.region[j < 12 ? 4 : 12]);
  }
  EXPECT_EQ(left.size(), 2u);
  EXPECT_EQ(right.size(), 2u);
  for (uint16_t r : left) EXPECT_EQ(right.count(r), 0u);
  for (uint32_t j = 20; j < 27; ++j) EXPECT_EQ(face.regions.region[j], 4) << "on the plane";
}

TEST(FindRegions, FewRowsMakeOneRegion) {
  TwoSides face;
  face.find(0);  // 23 bones have 138 rows
  EXPECT_EQ(face.regions.count, 1u);
  face.find(2);
  EXPECT_GE(face.regions.count, 2u);
}

TEST(FindRegions, MoreRegionsThanBonesGiveOneEach) {
  TwoSides face(false);
  face.find(24);
  std::set<uint16_t> used;
  for (uint32_t j = 4; j < 27; ++j) used.insert(face.regions.region[j]);
  EXPECT_EQ(used.size(), 23u);
  EXPECT_EQ(face.regions.count, 23u);
}

TEST(Prune, ControlsKeepToTheirRegions) {
  TwoSides face;
  face.find(5);
  // An outlier: a bone of the other side, and a faint entry of this one.
  face.motions.of(0)[5].shift = {0, 0.01, 0};
  face.motions.active_in(0)[5] = 1;
  face.motions.of(0)[4] = Affine::identity();
  face.motions.of(0)[4].shift = {0, 1e-6, 0};
  const PruneReport report =
      prune(face.placement, face.fitter.footprints, face.regions, 1e-4, false, 0, face.motions);
  EXPECT_EQ(report.outliers, 1u);
  EXPECT_EQ(report.faint, 1u);
  for (uint32_t j : {4u, 5u}) {
    EXPECT_EQ(face.motions.active_in(0)[j], 0);
    EXPECT_EQ(length(face.motions.of(0)[j].shift), 0);
  }
  EXPECT_EQ(face.motions.active_in(0)[6], 1);
  // Full blocks take in all bones of owned regions, and no others.
  prune(face.placement, face.fitter.footprints, face.regions, 1e-4, true, 0, face.motions);
  for (uint32_t j = 4; j < 27; ++j) {
    EXPECT_EQ(face.motions.active_in(0)[j], j < 20 && j % 2 == 0) << j;
  }
}

TEST(EffectOf, IsTheLengthOfSmallMotions) {
  Bone bone;
  bone.position = {1, 2, 3};
  Moments moments;
  moments.mass = 2;
  moments.center = {1, 2, 3};
  moments.spread[0] = {8, 0, 0};  // root mean square arm 2
  Affine shifted = Affine::identity();
  shifted.shift = {3, 0, 4};
  EXPECT_NEAR(effect_of(bone, moments, shifted), 5, 1e-12);
  const double angles[3] = {0, 0, 1};
  EXPECT_NEAR(effect_of(bone, moments, motion(angles, bone.position, {})), 2 * kPi / 180, 1e-5);
  EXPECT_EQ(effect_of(bone, moments, Affine::identity()), 0);
}

}  // namespace
}  // namespace mien::author
