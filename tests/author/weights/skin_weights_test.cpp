// SPDX-License-Identifier: MIT
#include "author/weights/skin_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "author/place/place.h"
#include "author/weights/body_weights.h"
#include "author/weights/carriers.h"
#include "tests/support/mesh_source.h"

namespace mien::author {
namespace {

struct Weighed {
  Arena arena{default_allocator()};
  ReadMesh read;
  Placement placement;
  PlaceReport place;
  SkinWeights weights;
  WeightReport report;

  explicit Weighed(TestMesh mesh, uint32_t joints, uint32_t influences, uint32_t kept = kNone) {
    Error error;
    PlaceOptions options;
    options.facial_joints = joints;
    EXPECT_EQ(read_mesh(mesh.source(), arena, default_allocator(), read, error), Status::kOk)
        << error.message;
    EXPECT_EQ(
        place_bones(read.mesh, options, {}, arena, default_allocator(), placement, place, error),
        Status::kOk)
        << error.message;
    WeightOptions weigh;
    weigh.influences = influences;
    weigh.facial_bones = kept;
    EXPECT_TRUE(
        make_skin_weights(read.mesh, placement, weigh, arena, default_allocator(), weights));
    EXPECT_TRUE(measure_weights(read.mesh, placement, weights, default_allocator(), report));
  }
  double weight(uint32_t v, uint32_t bone) const {
    double sum = 0;
    for (uint32_t i = 0; i < weights.m; ++i) {
      if (weights.joints[v * weights.m + i] == bone)
        sum += double{weights.weights[v * weights.m + i]};
    }
    return sum;
  }
};

TEST(SkinWeights, SumToOneAndStayWithinTheInfluences) {
  for (const uint32_t m : {1u, 2u, 4u, 8u, 12u}) {
    const Weighed made(procedural_mesh(4, false), 60, m);
    EXPECT_LE(made.report.worst_sum, 1e-6) << m;
    EXPECT_LE(made.report.max_influences, m);
    EXPECT_EQ(made.report.split_supports, 0u) << m;
    for (uint32_t v = 0; v < made.read.mesh.positions.count; ++v) {
      std::set<uint16_t> joints;
      for (uint32_t i = 0; i < m; ++i) {
        const float weight = made.weights.weights[v * m + i];
        ASSERT_TRUE(weight >= 0 && weight <= 1);
        if (weight > 0) {
          EXPECT_TRUE(joints.insert(made.weights.joints[v * m + i]).second);
          EXPECT_GE(weight, 0.9e-4f);
        }
        EXPECT_LE(weight, i > 0 ? made.weights.weights[v * m + i - 1] + 1e-6f : 1);
      }
    }
  }
}

TEST(SkinWeights, ChangeSlowlyAlongTheSurface) {
  for (const uint32_t joints : {40u, 120u}) {
    const Weighed made(procedural_mesh(2, true), joints, 8);
    EXPECT_LT(made.report.roughness, 2) << joints;
    EXPECT_GT(made.report.roughness, 0.5) << joints;
  }
}

TEST(SkinWeights, OfAFewBonesReachEveryVertex) {
  const Weighed made(procedural_mesh(4, false), 60, 8, 6);
  for (uint32_t v = 0; v < made.read.mesh.positions.count; ++v) {
    for (uint32_t i = 0; i < 8; ++i) {
      if (!(made.weights.weights[v * 8 + i] > 0)) continue;
      const uint32_t joint = made.weights.joints[v * 8 + i];
      EXPECT_LT(joint, made.placement.first_facial + 6) << v;
    }
  }
  EXPECT_LE(made.report.worst_sum, 1e-6);
}

TEST(SkinWeights, FadeToTheHeadBehindTheFaceAndToTheNeckBelowIt) {
  const Weighed made(procedural_mesh(3, false), 100, 8);
  const AuthorMesh& mesh = made.read.mesh;
  uint32_t back = 0, low = 0;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (mesh.positions[v].z < mesh.positions[back].z) back = v;
    if (mesh.positions[v].y < mesh.positions[low].y) low = v;
  }
  const uint32_t head = bone_of_kind(made.placement, BoneKind::kHead, 0);
  EXPECT_EQ(made.placement.bones[1].kind, BoneKind::kChest);
  EXPECT_NEAR(made.weight(back, head), 1, 1e-6);
  EXPECT_NEAR(made.weight(low, 1), 1, 1e-6);
  for (uint32_t v : made.placement.mask) {
    for (uint32_t b = 1; b <= head; ++b) EXPECT_EQ(made.weight(v, b), 0) << v;
  }
}

TEST(SkinWeights, OfWhatShapesMoveBelowTheThroatTheChinGetsTheShareOfTheHead) {
  TestMesh mesh = procedural_mesh(3, true);
  const Weighed before(mesh, 100, 12);
  const AuthorMesh& still = before.read.mesh;
  const Placement& placement = before.placement;
  ASSERT_TRUE(placement.neck_cut.exists);
  // A place in front on the neck, and the highest one on the chest: now both follow the jaw.
  uint32_t neck = kNone, chest = kNone;
  for (uint32_t v = 0; v < still.positions.count; ++v) {
    const Vec3 p = still.positions[v];
    const double height = height_in_neck(placement, p);
    if (p.z < 0) continue;
    if (height == 0 && (chest == kNone || p.y > still.positions[chest].y)) chest = v;
    if (height > 0.5 && height < 0.9) neck = v;
  }
  ASSERT_NE(neck, kNone);
  ASSERT_NE(chest, kNone);
  for (const uint32_t v : {neck, chest}) {
    for (std::vector<double>& shape : mesh.displacements) shape[3 * v + 1] = 0;
    mesh.displacements[0][3 * v + 1] = -1;
  }
  // With room for all of the body beside facial joints.
  const Weighed after(mesh, 100, 12);
  EXPECT_NEAR(after.weight(chest, 1), 1, 1e-6);
  const BodyChain chain = body_chain(placement);
  const double share = head_share(placement, chain, still.positions[neck]);
  double body = 0;
  for (uint32_t i = 0; i + 1 < chain.count; ++i) body += after.weight(neck, chain.bones[i]);
  EXPECT_EQ(after.weight(neck, chain.bones[chain.count - 1]), 0);
  EXPECT_NEAR(body, 1 - share, 1.5e-2);  // the least facial weights beyond 12 influences are gone
  EXPECT_LE(after.report.worst_sum, 1e-6);
}

TEST(SkinWeights, OfTheBodySumToOneAndRiseFromChestToHead) {
  Bone bones[5];
  const BoneKind kinds[] = {BoneKind::kRoot, BoneKind::kChest, BoneKind::kNeck, BoneKind::kNeck,
                            BoneKind::kHead};
  for (uint32_t b = 0; b < 5; ++b) bones[b].kind = kinds[b];
  Placement placement;
  placement.bones = {bones, 5};
  const BodyChain chain = body_chain(placement);
  ASSERT_EQ(chain.count, 4u);
  for (const double front : {0.0, 0.5, 1.0}) {
    double before[] = {-1, -1, -1};
    for (double height = 0; height <= 1; height += 0.125) {
      double shares[BodyChain::kCapacity], sum = 0;
      share_body(chain, height, front, shares);
      for (uint32_t i = 0; i < chain.count; ++i) {
        EXPECT_GE(shares[i], 0);
        sum += shares[i];
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      EXPECT_NEAR(shares[3], height * (height + front * (1 - height)), 1e-12);
      EXPECT_EQ(shares[1], shares[2]);
      // What a joint moves together with those above it.
      const double moved[] = {1 - shares[0], shares[2] + shares[3], shares[3]};
      for (uint32_t i = 0; i < 3; ++i) {
        EXPECT_GT(moved[i], before[i]);
        before[i] = moved[i];
      }
    }
  }
  // Without a cut all is head; a place far to the side is a shoulder.
  EXPECT_EQ(height_in_neck(placement, {0, -100, 0}), 1);
  placement.neck_cut.exists = true;
  placement.neck_cut.base = -10;
  placement.neck_cut.half_width = 5;
  EXPECT_EQ(height_in_neck(placement, {0, -10, 0}), 0);
  EXPECT_EQ(height_in_neck(placement, {0, 1, 0}), 1);
  EXPECT_NEAR(height_in_neck(placement, {0, -5, 0}), 0.5, 1e-12);
  EXPECT_EQ(height_in_neck(placement, {14, -5, 0}), 0);
  placement.neck_cut.z = 3;
  EXPECT_EQ(front_of_neck(placement, {0, 0, 3}), 1);
  EXPECT_NEAR(front_of_neck(placement, {0, 0, 0.5}), 0.5, 1e-12);
  EXPECT_EQ(front_of_neck(placement, {0, 0, -2}), 0);
}

/// Two sheets that touch nowhere but at one edge far away: the air between them is a hair wide.
TEST(SkinWeights, FollowTheSurfaceAndNotTheAir) {
  TestMesh mesh;
  const uint32_t kRows = 16, kColumns = 33;
  for (uint32_t r = 0; r < kRows; ++r) {
    for (uint32_t c = 0; c < kColumns; ++c) {
      // Folded in the middle: there and back, a tenth apart.
      const double t = c <= 16 ? c : 32.0 - c;
      mesh.vertex(t, r, c < 16 ? 0 : c == 16 ? 0.05 : 0.1);
    }
  }
  for (uint32_t r = 0; r + 1 < kRows; ++r) {
    for (uint32_t c = 0; c + 1 < kColumns; ++c) {
      mesh.face({r * kColumns + c, r * kColumns + c + 1, (r + 1) * kColumns + c + 1,
                 (r + 1) * kColumns + c});
    }
  }
  const Weighed made(mesh, 24, 4);
  EXPECT_TRUE(made.place.face_only);
  EXPECT_EQ(made.report.split_supports, 0u);
  // A bone near the open edge has vertices of one sheet only, though the other is nearer than its
  // neighbors.
  uint32_t checked = 0;
  for (uint32_t b = made.placement.first_facial; b < made.placement.bones.count; ++b) {
    const Vec3 at = made.placement.bones[b].position;
    if (made.placement.bones[b].kind != BoneKind::kFacial || at.x > 5) continue;
    bool front = false, back = false;
    for (uint32_t v = 0; v < made.read.mesh.positions.count; ++v) {
      if (!(made.weight(v, b) > 0) || made.read.mesh.positions[v].x > 5) continue;
      (made.read.mesh.positions[v].z < 0.05 ? back : front) = true;
    }
    EXPECT_FALSE(front && back) << b;
    ++checked;
  }
  EXPECT_GT(checked, 2u);
}

TEST(SkinWeights, KeepTouchingLipsApartIfAShapePartsThem) {
  const TestMesh closed = procedural_mesh(3, true);
  const Weighed made(closed, 60, 8);
  // Vertices at one place that the jaw moves apart are two places.
  uint32_t touching = 0;
  const AuthorMesh& mesh = made.read.mesh;
  for (uint32_t v = 1; v < mesh.positions.count; ++v) {
    for (uint32_t other = 0; other < v; ++other) {
      if (length(mesh.positions[v] - mesh.positions[other]) > 1e-9) continue;
      bool same = true;
      for (const Shape& shape : mesh.shapes) {
        const Vec3f p = shape.displacements[v], q = shape.displacements[other];
        same = same && std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z) < 1e-5f;
      }
      if (same) continue;
      ++touching;
      EXPECT_NE(mesh.welded[v], mesh.welded[other]);
    }
  }
  EXPECT_GT(touching, 0u);
}

TEST(SkinWeights, OfCopiesOfAVertexAreTheSame) {
  TestMesh mesh = procedural_mesh(4, false);
  // Every face gets vertices of its own, as at UV seams.
  TestMesh split;
  for (const uint32_t corner : mesh.corners) {
    split.corners.push_back(split.vertex(mesh.positions[3 * corner], mesh.positions[3 * corner + 1],
                                         mesh.positions[3 * corner + 2]));
  }
  split.face_sizes = mesh.face_sizes;
  const Weighed made(mesh, 60, 6), copied(split, 60, 6);
  EXPECT_EQ(copied.read.mesh.component_count, made.read.mesh.component_count);
  for (size_t c = 0; c < mesh.corners.size(); ++c) {
    const uint32_t v = mesh.corners[c], copy = split.corners[c];
    for (uint32_t i = 0; i < 6; ++i) {
      const uint32_t joint = made.weights.joints[v * 6 + i];
      EXPECT_NEAR(made.weight(v, joint), copied.weight(copy, joint), 1e-4);
    }
  }
}

TEST(SkinWeights, OfEyesAndTeethAreRigidAndOfLashesThoseOfTheSkin) {
  TestMesh mesh = procedural_mesh(3, true);
  const uint32_t skin = static_cast<uint32_t>(mesh.positions.size() / 3);
  add_sphere(mesh, 3.2, 1, 7.15, 1.22);
  add_sphere(mesh, -3.2, 1, 7.15, 1.22);
  const uint32_t teeth = static_cast<uint32_t>(mesh.positions.size() / 3);
  for (int row = 0; row < 2; ++row) {  // upper, then lower: bars behind the lips
    const double y = row == 0 ? -5 : -7;
    const uint32_t at = static_cast<uint32_t>(mesh.positions.size() / 3);
    for (int i = 0; i < 8; ++i) {
      mesh.vertex(i & 1 ? 2 : -2, y + (i & 2 ? 0.5 : -0.5), i & 4 ? 7 : 5);
    }
    mesh.face({at, at + 2, at + 3, at + 1});
    mesh.face({at + 4, at + 5, at + 7, at + 6});
    mesh.face({at, at + 1, at + 5, at + 4});
    mesh.face({at + 2, at + 6, at + 7, at + 3});
  }
  const uint32_t lash = static_cast<uint32_t>(mesh.positions.size() / 3);
  for (int i = 0; i < 3; ++i) mesh.vertex(2.5 + 0.5 * i, 1.4, 8.6);
  mesh.face({lash, lash + 1, lash + 2});
  mesh.positions[3 * lash + 4] += 0.1;
  for (size_t s = 0; s < mesh.displacements.size(); ++s) {
    std::vector<double>& shape = mesh.displacements[s];
    shape.resize(mesh.positions.size());
    if (mesh.shape_names[s] == "jawOpen") {
      for (uint32_t v = teeth + 8; v < lash; ++v) shape[3 * v + 1] = -2.5;
    }
    if (mesh.shape_names[s].rfind("eyeBlink", 0) == 0) {
      for (uint32_t i = 0; i < 3; ++i) shape[3 * (lash + i) + 1] = -0.3 * (i + 1.0);
    }
  }
  const Weighed made(mesh, 60, 8);
  const auto bone_named = [&](const std::string& name) {
    for (uint32_t b = 0; b < made.placement.bones.count; ++b) {
      const Name& n = made.placement.bones[b].name;
      if (std::string(n.data, n.count) == name) return b;
    }
    ADD_FAILURE() << name;
    return 0u;
  };
  EXPECT_EQ(made.weight(skin, bone_named("eye_l")), 1);
  EXPECT_EQ(made.weight(teeth - 1, bone_named("eye_r")), 1);
  EXPECT_EQ(made.weight(teeth, bone_named("head")), 1);
  EXPECT_EQ(made.weight(teeth + 8, bone_named("jaw")), 1);
  EXPECT_EQ(made.weight(lash, bone_named("head")) + made.weight(lash, bone_named("jaw")), 0);
  const Weighed bare(procedural_mesh(3, true), 60, 8);
  EXPECT_EQ(made.report.following_components, bare.report.following_components + 1);
  EXPECT_EQ(made.report.rigid_components, bare.report.rigid_components + 4);
  EXPECT_LE(made.report.worst_sum, 1e-6);
}

}  // namespace
}  // namespace mien::author
