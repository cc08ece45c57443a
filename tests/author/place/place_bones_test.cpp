// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "author/place/rank.h"
#include "tests/support/placed_bones.h"

namespace mien::author {
namespace {

TEST(PlaceBones, PutsNeckHeadAndFaceWhereTheyAreOnAHead) {
  const Placed placed(procedural_mesh(3, false), with_joints(60));
  ASSERT_EQ(placed.status, Status::kOk) << placed.error.message;
  EXPECT_EQ(placed.placement.facial_count, 60u);
  ASSERT_TRUE(placed.report.throat.found);
  const double throat = placed.report.throat.y;
  EXPECT_LT(placed.bone(BoneKind::kNeck).position.y, throat);
  EXPECT_GE(placed.bone(BoneKind::kHead).position.y, throat);
  EXPECT_LT(placed.bone(BoneKind::kHead).position.y, placed.report.head_mean.y + 1e-9);
  EXPECT_EQ(length(placed.bone(BoneKind::kFace).position - placed.bone(BoneKind::kHead).position),
            0);
  // Parents: root, chest, neck, head, face, then the face's bones.
  const Span<const Bone> bones = placed.placement.bones;
  const uint32_t face = placed.placement.first_facial - 1;
  EXPECT_EQ(bones[1].kind, BoneKind::kChest);
  EXPECT_EQ(bones[2].kind, BoneKind::kNeck);
  EXPECT_EQ(bones[face].kind, BoneKind::kFace);
  EXPECT_LE(face, 6u);
  for (uint32_t b = 0; b <= face; ++b) EXPECT_EQ(bones[b].parent, b == 0 ? 0 : b - 1) << b;
  for (const Bone& bone : placed.facial()) EXPECT_EQ(bone.parent, face);
  // The face: in front of the border, above the throat.
  for (uint32_t v : placed.placement.mask) {
    const Vec3 p = placed.read.mesh.positions[v];
    EXPECT_GE(p.z, placed.report.borders[0]);
    EXPECT_GE(placed.placement.neck_cut.above(p), 0);
  }
}

TEST(PlaceBones, SwapsOfMeansOnlyLowerTheObjective) {
  bool lower = false;
  for (const uint32_t count : {60u, 120u, 240u}) {
    const Placed placed(procedural_mesh(4, true), with_joints(count));
    const PlaceReport& report = placed.report;
    double best = 1e300;
    for (uint32_t r = 0; r + 1 < report.run_count; ++r) {
      best = std::min(best, report.runs[r].objective);
    }
    const KMeansRun& swaps = report.runs[report.run_count - 1];
    EXPECT_LE(swaps.objective, best);
    lower = lower || swaps.objective < 0.99 * best;
    EXPECT_NEAR(swaps.objective, report.lod_objectives[0], 1e-6 * best) << "that of its bones";
  }
  EXPECT_TRUE(lower);
}

TEST(PlaceBones, NumbersFollowTheRankAndNamesAreDifferent) {
  const Placed placed(procedural_mesh(4, false), with_joints(40));
  std::map<std::string, int> seen;
  for (const Bone& bone : placed.placement.bones) {
    ++seen[std::string(bone.name.data, bone.name.count)];
  }
  EXPECT_EQ(seen.size(), placed.placement.bones.count);
  uint32_t last = 0;
  for (const Bone& bone : placed.facial()) {
    const std::string name(bone.name.data, bone.name.count);
    const uint32_t number =
        static_cast<uint32_t>(std::stoul(name.substr(name.find_last_not_of("0123456789") + 1)));
    EXPECT_GE(number, last);
    last = number;
    const char side = name[7];
    const double x = bone.position.x - placed.placement.symmetry_plane;
    EXPECT_TRUE(side == 'L' ? x > 0 : side == 'R' ? x < 0 : x == 0) << name;
  }
}

TEST(PlaceBones, FindsJawAndEyes) {
  TestMesh mesh = procedural_mesh(3, true);
  const size_t skin = mesh.positions.size();
  add_sphere(mesh, 3.2, 1, 7.15, 1.22);
  add_sphere(mesh, -3.2, 1, 7.15, 1.22);
  for (std::vector<double>& shape : mesh.displacements) shape.resize(mesh.positions.size());
  ASSERT_GT(mesh.positions.size(), skin);
  const Placed placed(mesh, with_joints(40));
  ASSERT_EQ(placed.status, Status::kOk) << placed.error.message;
  // The head opens its jaw about (0, -1, 0.3).
  ASSERT_TRUE(placed.report.jaw_joint);
  const Vec3 jaw = placed.bone(BoneKind::kJaw).position;
  EXPECT_EQ(jaw.x, placed.placement.symmetry_plane);
  EXPECT_LT(std::hypot(jaw.y + 1, jaw.z - 0.3), 3);
  ASSERT_EQ(placed.report.eye_joints, 2u);
  const Vec3 eye = placed.bone(BoneKind::kEye).position;
  EXPECT_NEAR(std::abs(eye.x), 3.2, 0.01);
  EXPECT_NEAR(eye.y, 1, 0.01);
  EXPECT_NEAR(eye.z, 7.15, 0.01);

  PlaceOptions paper = with_joints(40);
  paper.paper = true;
  const Placed published(mesh, paper);
  EXPECT_FALSE(published.report.jaw_joint);
  EXPECT_EQ(published.report.eye_joints, 0u);
  EXPECT_FALSE(published.placement.symmetric);
}

TEST(PlaceBones, RigsAFaceWithoutABack) {
  TestMesh mesh;  // a shallow dome with a nose
  for (int j = 0; j <= 20; ++j) {
    for (int i = 0; i <= 20; ++i) {
      const double x = (i - 10) * 0.8, y = (j - 10) * 1.0;
      mesh.vertex(x, y, 5 - 0.03 * (x * x + y * y) + 2 * std::exp(-(x * x + y * y) / 2));
    }
  }
  for (uint32_t j = 0; j < 20; ++j) {
    for (uint32_t i = 0; i < 20; ++i) {
      mesh.face({j * 21 + i, j * 21 + i + 1, (j + 1) * 21 + i + 1, (j + 1) * 21 + i});
    }
  }
  const Placed placed(mesh, with_joints(30));
  ASSERT_EQ(placed.status, Status::kOk) << placed.error.message;
  EXPECT_TRUE(placed.report.face_only);
  EXPECT_EQ(placed.placement.mask.count, 441u);
  EXPECT_LT(placed.bone(BoneKind::kHead).position.z, 0);
  EXPECT_LT(placed.bone(BoneKind::kNeck).position.y, placed.bone(BoneKind::kHead).position.y);
}

TEST(PlaceBones, RigsWhatIsNoHumanHead) {
  TestMesh mesh;
  add_sphere(mesh, 10, 20, 30, 7, 24, 32);
  const Placed placed(mesh, with_joints(30));
  ASSERT_EQ(placed.status, Status::kOk) << placed.error.message;
  EXPECT_FALSE(placed.report.throat.found);
  for (const Bone& bone : placed.facial()) {
    EXPECT_LT(length(bone.position - Vec3{10, 20, 30}), 7);
    EXPECT_GT(bone.position.z, 30);
  }
}

TEST(PlaceBones, AHeadWithoutNeckTurnsAboutALowPlace) {
  const TestMesh whole = procedural_mesh(3, false);
  TestMesh cropped;
  cropped.positions = whole.positions;
  size_t corner = 0;
  for (const uint32_t size : whole.face_sizes) {
    const std::vector<uint32_t> face(whole.corners.begin() + static_cast<ptrdiff_t>(corner),
                                     whole.corners.begin() + static_cast<ptrdiff_t>(corner + size));
    corner += size;
    // The chin ends at -10.6.
    if (std::all_of(face.begin(), face.end(),
                    [&](uint32_t v) { return whole.positions[3 * v + 1] > -9; })) {
      cropped.face(face);
    }
  }
  const Placed placed(cropped, with_joints(30));
  ASSERT_EQ(placed.status, Status::kOk) << placed.error.message;
  EXPECT_FALSE(placed.report.throat.found);
  const double head = placed.bone(BoneKind::kHead).position.y;
  EXPECT_LT(head, 0) << "below the eyes";
  EXPECT_GT(head, placed.bone(BoneKind::kNeck).position.y);
}

TEST(PlaceBones, HasNoMoreBonesThanPlaces) {
  TestMesh mesh;
  add_sphere(mesh, 0, 0, 0, 5, 4, 6);
  const Placed placed(mesh, with_joints(240));
  ASSERT_EQ(placed.status, Status::kOk) << placed.error.message;
  EXPECT_LE(placed.placement.facial_count, placed.report.mask_positions);
  EXPECT_GE(placed.placement.facial_count, 1u);
}

TEST(PlaceBones, RefusesWhatHasNoFaceOrNoShapes) {
  PlaceOptions options = with_joints(30);
  options.mask_from_shapes = true;
  const Placed placed(procedural_mesh(5, false), options);
  EXPECT_EQ(placed.status, Status::kAuthorRefused);
  EXPECT_NE(std::string(placed.error.message).find("shapes"), std::string::npos);
}

TEST(JointLadder, FallsInEveryLodAndEndsWithSixOrMore) {
  for (uint32_t top : {1u, 5u, 6u, 13u, 60u, 120u, 240u, 2000u}) {
    for (size_t lods = 1; lods <= 8; ++lods) {
      std::vector<uint32_t> counts(lods);
      joint_ladder(top, {counts.data(), lods});
      EXPECT_EQ(counts[0], top);
      for (size_t l = 1; l < lods; ++l) {
        EXPECT_TRUE(counts[l] < counts[l - 1] || counts[l] == 1) << top << " " << l;
      }
      EXPECT_GE(counts.back(), top >= 5 + lods ? 6u : 1u) << top << " " << lods;
    }
  }
}

}  // namespace
}  // namespace mien::author
