// SPDX-License-Identifier: MIT
#include "author/fit/stacked_lods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "author/rig_dna/author_rig.h"
#include "tests/support/author_setup.h"

namespace mien::author {
namespace {

/// The small head and a LOD of a tenth of its vertices, with the weights of LOD 0.
struct TwoLods {
  AuthorSetup head;
  Arena arena{default_allocator()};
  FittedLod lods[2];
  Span<uint32_t> vertices;

  TwoLods() {
    make_author_head(5, 24, 6, 2, head);
    lods[0].mesh = lods[1].mesh = head.mesh;
    lods[0].weights = lods[1].weights = head.weights;
    const size_t count = head.positions.size() / 10;
    vertices = arena.array<uint32_t>(count);
    Span<Vec3> positions = arena.array<Vec3>(count);
    SkinWeights& weights = lods[1].weights;
    weights.joints = arena.array<uint16_t>(count * weights.m);
    weights.weights = arena.array<float>(count * weights.m);
    for (uint32_t v = 0; v < count; ++v) {
      vertices[v] = 10 * v + 3;
      positions[v] = head.positions[vertices[v]];
      for (uint32_t i = 0; i < weights.m; ++i) {
        weights.joints[v * weights.m + i] = head.weights.joints[vertices[v] * weights.m + i];
        weights.weights[v * weights.m + i] = head.weights.weights[vertices[v] * weights.m + i];
      }
    }
    lods[1].mesh.positions = positions;
    lods[1].vertices = vertices;
  }
};

TEST(StackLods, EveryLodFollowsTheOneBeforeWithWhatItHas) {
  TwoLods two;
  StackedLods stacked;
  ASSERT_TRUE(stack_lods({two.lods, 2}, two.arena, stacked));
  fill_weights({two.lods, 2}, stacked);
  const uint32_t finest = static_cast<uint32_t>(two.head.positions.size());
  ASSERT_EQ(stacked.starts[1], finest);
  ASSERT_EQ(stacked.rows.count, finest + two.vertices.count);
  double shares[2] = {};
  for (uint32_t row = 0; row < stacked.rows.count; ++row) {
    const bool further = row >= finest;
    const uint32_t v = further ? two.vertices[row - finest] : row;
    EXPECT_EQ(stacked.vertices[row], v);
    EXPECT_EQ(length(stacked.positions[row] - two.head.positions[v]), 0);
    double sum = 0;
    for (uint32_t i = 0; i < stacked.weights.m; ++i) {
      const size_t slot = row * stacked.weights.m + i;
      EXPECT_EQ(stacked.weights.joints[slot], two.head.weights.joints[v * stacked.weights.m + i]);
      sum += double{stacked.weights.weights[slot]};
    }
    EXPECT_NEAR(sum, stacked.scales[row], 1e-6);
    shares[further] += stacked.scales[row] * stacked.scales[row];
  }
  EXPECT_NEAR(shares[0], finest, 1e-6);
  EXPECT_LT(shares[1], 0.2 * shares[0]) << "LOD 0 counts most";
  EXPECT_GT(shares[1], 0.01 * shares[0]);
}

TEST(StackLods, LodsWithAllVerticesHaveAQuarterOfTheRows) {
  TwoLods two;
  two.lods[1] = two.lods[0];
  StackedLods stacked;
  ASSERT_TRUE(stack_lods({two.lods, 2}, two.arena, stacked));
  const size_t finest = two.head.positions.size(), further = stacked.rows.count - finest;
  EXPECT_NEAR(static_cast<double>(further), static_cast<double>(finest) / 4, 1);
  std::set<uint32_t> places, all;
  for (size_t row = finest; row < stacked.rows.count; ++row) {
    EXPECT_TRUE(all.insert(stacked.rows[row]).second) << "a vertex twice";
    EXPECT_LT(stacked.rows[row], finest);
    places.insert(stacked.rows[row] % 4);
  }
  EXPECT_EQ(places.size(), 4u) << "an order of the vertices by fours would show";
}

TEST(StackLods, ThoseOfLodZeroAloneAreFittedAsTheMeshIs) {
  TwoLods two;
  StackedLods stacked;
  ASSERT_TRUE(stack_lods({two.lods, 1}, two.arena, stacked));
  fill_weights({two.lods, 1}, stacked);
  const AuthorSetup& head = two.head;
  Fitter fitters[2];
  Motions motions[2];
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(make_fitter(head.mesh.positions, head.placement, head.weights.m, {}, two.arena,
                            fitters[i]));
    ASSERT_TRUE(make_motions(head.shapes.size(), head.bones.size(), two.arena, motions[i]));
  }
  fitters[1].positions = stacked.positions;
  fitters[1].vertices = stacked.vertices;
  fitters[1].scales = stacked.scales;
  fit_all(fitters[0], head.mesh, head.weights, false, {}, motions[0]);
  fit_all(fitters[1], head.mesh, stacked.weights, false, {}, motions[1]);
  double moved = 0;
  for (size_t i = 0; i < motions[0].items.count; ++i) {
    const Affine &a = motions[0].items[i], &b = motions[1].items[i];
    EXPECT_EQ(length(a.shift - b.shift), 0);
    for (int r = 0; r < 3; ++r) EXPECT_EQ(length(a.rows[r] - b.rows[r]), 0);
    moved += length(a.shift);
  }
  EXPECT_GT(moved, 1);
}

TEST(FitShapes, GivenMotionsAreImproved) {
  AuthorSetup head;
  make_author_head(5, 24, 6, 1, head);
  Arena arena(default_allocator());
  Fitter fitter;
  Motions motions;
  FitOptions options;
  options.sweeps = 1;
  ASSERT_TRUE(
      make_fitter(head.mesh.positions, head.placement, head.weights.m, options, arena, fitter));
  ASSERT_TRUE(make_motions(head.shapes.size(), head.bones.size(), arena, motions));
  double before = HUGE_VAL;
  const std::vector<uint8_t> active = [&] {
    fit_all(fitter, head.mesh, head.weights, false, {}, motions);
    return std::vector<uint8_t>(motions.active.begin(), motions.active.end());
  }();
  for (int i = 0; i < 4; ++i) {
    FitError error;
    ASSERT_TRUE(measure_fit(head.mesh, head.weights, motions, {}, {}, arena, error));
    EXPECT_LT(error.error, before);
    before = error.error;
    fit_all(fitter, head.mesh, head.weights, true, {}, motions);
  }
  EXPECT_TRUE(std::equal(active.begin(), active.end(), motions.active.begin()));
}

TEST(AuthorRig, MotionsThatAllLodsShareDoBetterAtCoarseOnes) {
  double ratios[4] = {};  // means over numbers of joints
  for (const uint32_t joints : {30u, 40u, 50u}) {
    double errors[2][4];
    for (uint32_t shared : {0u, 1u}) {
      AuthorSetup head;
      make_author_head(5, joints, 6, 4, head);
      Arena arena(default_allocator());
      RigOptions options;
      options.fit.shared_rounds = 2 * shared;
      dna::DnaView view;
      RigReport report;
      ASSERT_TRUE(author_rig(head.mesh, head.placement, {&head.weights, 1}, options, arena,
                             default_allocator(), report, view));
      for (uint32_t lod = 0; lod < 4; ++lod) errors[shared][lod] = report.lods[lod].joints_error;
    }
    for (uint32_t lod = 0; lod < 4; ++lod) ratios[lod] += errors[1][lod] / errors[0][lod] / 3;
  }
  EXPECT_LT(ratios[0], 1.3);  // what joints that serve all LODs cost the finest
  for (uint32_t lod = 1; lod < 4; ++lod) EXPECT_LT(ratios[lod], 0.75) << lod;
}

}  // namespace
}  // namespace mien::author
