// SPDX-License-Identifier: MIT
#include "author/fit/joint_tree.h"

#include <gtest/gtest.h>

#include "author/base/joint_motion.h"
#include "author/fit/fit_shapes.h"
#include "author/fit/targets.h"
#include "tests/support/author_setup.h"

namespace mien::author {
namespace {

/// Three rows of points, each with a facial bone: one goes with the jaw, one by half, one not at all.
struct Rows : AuthorSetup {
  Affine opened;

  Rows() {
    const double angles[3] = {20, 0, 0};
    opened = motion(angles, {0, 0, 0}, {});
    add_trunk();
    add_bone("jaw", {0, 0, 0}, BoneKind::kJaw, 3);
    for (int row = 0; row < 3; ++row) {
      for (int i = 0; i < 30; ++i) {
        add_vertex({(i % 6) - 2.5, -6.0 + 4 * row + 0.1 * (i / 6), 8 + 0.2 * (i % 3)});
      }
      add_bone("facial" + std::to_string(row), {0, -6.0 + 4 * row, 8}, BoneKind::kFacial, 3);
    }
    for (uint32_t v = 0; v + 2 < positions.size(); ++v) add_face({v, v + 1, v + 2});
    add_shape("jawOpen", [this](uint32_t v) {
      const double share[3] = {1, 0.4, 0};
      return (opened(positions[v]) - positions[v]) * share[v / 30];
    });
    finish(1);
  }
};

TEST(JointTree, FacialBonesThatGoWithTheJawHangBelowIt) {
  Rows rows;
  Arena arena(default_allocator());
  ASSERT_TRUE(hang_on_jaw(rows.mesh, rows.mesh.shapes[0], rows.opened, rows.weights, arena,
                          rows.placement));
  const Span<const Bone> bones = rows.placement.bones;
  EXPECT_EQ(bones[5].parent, 4u);
  EXPECT_EQ(bones[6].parent, 3u);
  EXPECT_EQ(bones[7].parent, 3u);
}

TEST(JointTree, AJawThatIsMissingChangesNothing) {
  Rows rows;
  rows.bones[4].kind = BoneKind::kFace;
  rows.finish(1);
  Arena arena(default_allocator());
  const Bone* before = rows.placement.bones.data;
  ASSERT_TRUE(hang_on_jaw(rows.mesh, rows.mesh.shapes[0], rows.opened, rows.weights, arena,
                          rows.placement));
  EXPECT_EQ(rows.placement.bones.data, before);
}

TEST(JointTree, TheJawMovesAndWhatHangsBelowItStoresNothing) {
  Rows rows;
  Arena arena(default_allocator());
  ASSERT_TRUE(hang_on_jaw(rows.mesh, rows.mesh.shapes[0], rows.opened, rows.weights, arena,
                          rows.placement));
  Fitter fitter;
  Motions motions;
  ASSERT_TRUE(make_fitter(rows.mesh.positions, rows.placement, 1, {}, arena, fitter));
  ASSERT_TRUE(make_motions(1, rows.placement.bones.count, arena, motions));
  fit_all(fitter, rows.mesh, rows.weights, false, {}, motions);
  ASSERT_TRUE(motions.active_in(0)[4]);
  JointDeltas deltas;
  deltas.joint_count = static_cast<uint32_t>(rows.placement.bones.count);
  std::vector<JointDelta> items(rows.placement.bones.count);
  deltas.items = {items.data(), items.size()};
  deltas_of_motions(rows.placement, rows.mesh.frame, motions, deltas);
  EXPECT_NEAR(items[4].rotation[0], 20, 1e-3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(items[4].translation[k], 0, 1e-4);
    EXPECT_NEAR(items[5].rotation[k], 0, 1e-2) << "it goes with the jaw";
    EXPECT_NEAR(items[5].translation[k], 0, 1e-2);
  }
  EXPECT_GT(items[6].rotation[0], 3) << "it goes with the head, and by itself";
  // What is stored means what was fitted, parents before children.
  const uint32_t control = 0;
  std::vector<Affine> pose(rows.placement.bones.count);
  pose_bones(rows.placement, rows.mesh.frame, deltas, {&control, 1}, {pose.data(), pose.size()});
  const Vec3 chin = rows.positions[0];
  EXPECT_LT(length(pose[5](chin) - rows.opened(chin)), 0.01);
}

}  // namespace
}  // namespace mien::author
