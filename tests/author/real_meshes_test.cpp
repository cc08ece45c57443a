// SPDX-License-Identifier: MIT
// How well rigs follow the expressions of real heads. Without the meshes these tests are skipped.
#include "tests/support/real_meshes.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "runtime/author/rig_dna/author_rig.h"
#include "tests/support/rig_handles.h"

namespace mien::author {
namespace {

/// A bound of each step's error.
struct Bounds {
  double joints, rig;
};

void expect_good_rig(AuthorSetup& head, const Bounds& bounds) {
  add_bones_and_weights(120, 8, head);
  Arena arena(default_allocator());
  RigReport report;
  dna::DnaView view;
  ASSERT_TRUE(author_rig(head.mesh, head.placement, {&head.weights, 1}, {}, arena,
                         default_allocator(), report, view));
  printf(
      "%zu vertices, %zu shapes: translations %.1f %%, rotations %.1f %%, joints %.2f %%, rig "
      "%.2f %%\n",
      head.positions.size(), head.shapes.size(), 100 * report.translations.error,
      100 * report.rotations.error, 100 * report.joints.error, 100 * report.rig.error);
  EXPECT_LT(report.rotations.error, report.translations.error);
  EXPECT_LE(report.joints.error, bounds.joints);
  EXPECT_LE(report.rig.error, bounds.rig);
  EXPECT_LE(report.rig.max, 1.05e-3);
  EXPECT_LE(report.groups.refitted.error, report.groups.before.error + 0.015);
  EXPECT_GT(report.groups.nonzeros, report.groups.stored * 99 / 100);
  EXPECT_LT(report.groups.stored, report.groups.full * 6 / 10);
  EXPECT_TRUE(open_dna(write_view(view)));
}

TEST(RealMeshes, IctIsFollowed) {
  if (real_mesh_folder().empty())
    GTEST_SKIP() << "NOT TESTED: rigs from real heads; there is no $MIEN_SHARED/data/meshes";
  AuthorSetup head;
  ASSERT_TRUE(load_ict(head));
  EXPECT_EQ(head.positions.size(), 11248u);
  expect_good_rig(head, {0.065, 0.045});
}

TEST(RealMeshes, MakeHumanIsFollowed) {
  if (real_mesh_folder().empty())
    GTEST_SKIP() << "NOT TESTED: rigs from real heads; there is no $MIEN_SHARED/data/meshes";
  AuthorSetup head;
  ASSERT_TRUE(load_makehuman(head));
  EXPECT_EQ(head.positions.size(), 4490u);
  EXPECT_EQ(head.displacements.size(), 34u);
  expect_good_rig(head, {0.13, 0.05});
}

}  // namespace
}  // namespace mien::author
