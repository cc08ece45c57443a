// SPDX-License-Identifier: MIT
// Rigs of real heads, whole: how well they follow the expressions, and what the files do. Without the
// meshes these tests are skipped.
#include "tests/support/real_meshes.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "author/rigging/rigging.h"
#include "runtime/load/dna/format/dna_writer.h"
#include "tests/support/mesh_source.h"
#include "tests/support/played_rig.h"

namespace mien::author {
namespace {

struct RealRig {
  Arena arena{default_allocator()};
  Rigging rigging;
  std::vector<uint8_t> bytes;

  RealRig(TestMesh mesh, const RiggingOptions& options) {
    Error error;
    EXPECT_EQ(make_rig(mesh.source(), options, arena, default_allocator(), rigging, error),
              Status::kOk)
        << error.message;
    bytes.resize(dna::encoded_size(rigging.dna, {}));
    dna::encode(rigging.dna, {}, bytes.data());
  }
};

/// Tasks in another order, as threads would take them.
void run_backwards(void*, uint32_t count, void (*task)(void*, uint32_t), void* context) {
  for (uint32_t i = count; i-- > 0;) task(context, i);
}

class RealMeshes : public ::testing::Test {
 protected:
  void SetUp() override {
    if (real_mesh_folder().empty())
      GTEST_SKIP() << "NOT TESTED: rigs of real heads; there is no $MIEN_SHARED/data/meshes";
  }
  RealMeshes() {
    options_.place.facial_joints = ladder_[0];
    options_.place.lods = 3;
    options_.place.lod_joints = {ladder_, 3};
    options_.influences = 8;
  }

  /// Bounds of the errors of the joints, of the file, and of LOD 1, which has half of the joints.
  void expect_good_rig(const TestMesh& mesh, double joints, double file, double half) {
    const RealRig made(mesh, options_);
    const RigReport& rig = made.rigging.rig;
    printf(
        "translations %.1f %%, rotations %.1f %%, joints %.2f %%, file %.2f %%, LODs %.1f %%, "
        "%.1f %%\n",
        100 * rig.translations.error, 100 * rig.rotations.error, 100 * rig.joints.error,
        100 * rig.rig.error, 100 * rig.lods[1].joints_error, 100 * rig.lods[2].joints_error);
    EXPECT_LT(rig.rotations.error, rig.translations.error);
    EXPECT_LE(rig.joints.error, joints);
    EXPECT_LE(rig.rig.error, file);
    EXPECT_LE(rig.rig.max, 1.05e-3);
    EXPECT_LE(rig.lods[1].joints_error, half);
    EXPECT_LT(rig.lods[1].joints_error, rig.lods[1].new_error);
    EXPECT_LT(rig.lods[1].joints_error, rig.lods[1].collapsed_error);
    EXPECT_LE(rig.groups.refitted.error, rig.groups.before.error + 0.015);
    EXPECT_GT(rig.groups.nonzeros, rig.groups.stored * 98 / 100);
    EXPECT_LT(rig.groups.stored, rig.groups.full * 7 / 10);
    EXPECT_LE(made.rigging.fitted_weights.worst_sum, 1e-6);
    EXPECT_LE(made.rigging.fitted_weights.max_influences, 8u);
    EXPECT_EQ(made.rigging.fitted_weights.split_supports, 0u);

    EXPECT_EQ(findings(made.bytes), 0u);
    EXPECT_TRUE(write_dna(open_dna(made.bytes).get()) == made.bytes) << "round trip";
    RiggingOptions threads = options_;
    threads.parallel.run = run_backwards;
    EXPECT_TRUE(RealRig(mesh, threads).bytes == made.bytes);
    expect_file_does_as_told(made);
    expect_full_residual_reconstructs(made);
  }

 private:
  void expect_file_does_as_told(const RealRig& made) {
    const AuthorMesh& read = made.rigging.read.mesh;
    Played played(made.bytes);
    played.set(kNone);
    const std::vector<Vec3> neutral = played.deform(0);
    ASSERT_EQ(neutral.size(), read.positions.count);
    for (size_t v = 0; v < neutral.size(); ++v) {
      ASSERT_LT(length(neutral[v] - read.positions[v]), 1e-6 * read.diagonal);
    }
    EXPECT_NEAR(played.error(read, 0), made.rigging.rig.rig.error, 1e-4);
    played.set(17);
    const std::vector<Vec3> posed = played.deform(0);
    for (const uint32_t isa : present_isas()) {
      Played other(made.bytes, isa);
      other.set(17);
      const std::vector<Vec3> points = other.deform(0);
      for (size_t v = 0; v < points.size(); ++v) {
        ASSERT_LT(length(points[v] - posed[v]), 2e-6 * read.diagonal) << isa;
      }
    }
  }
  static void expect_full_residual_reconstructs(const RealRig& made) {
    RigOptions options;
    options.residual_threshold = 0;
    options.keep_weights = true;
    Arena arena(default_allocator());
    RigReport report;
    dna::DnaView view;
    SkinWeights weights = made.rigging.weights;
    ASSERT_TRUE(author_rig(made.rigging.read.mesh, made.rigging.placement, {&weights, 1}, options,
                           arena, default_allocator(), report, view));
    EXPECT_LE(report.rig.max, 1e-5);
  }

  const uint32_t ladder_[3] = {120, 60, 30};

 protected:
  RiggingOptions options_;
};

TEST_F(RealMeshes, IctIsFollowed) {
  AuthorSetup head;
  ASSERT_TRUE(load_ict(head));
  EXPECT_EQ(head.positions.size(), 11248u);
  expect_good_rig(mesh_of(head, true), 0.065, 0.045, 0.19);
}

TEST_F(RealMeshes, MakeHumanIsFollowed) {
  AuthorSetup head;
  ASSERT_TRUE(load_makehuman(head));
  EXPECT_EQ(head.positions.size(), 4490u);
  EXPECT_EQ(head.displacements.size(), 34u);
  expect_good_rig(mesh_of(head, true), 0.13, 0.05, 0.25);
}

TEST_F(RealMeshes, AFaceWithoutExpressionsIsRigged) {
  AuthorSetup face;
  ASSERT_TRUE(load_mediapipe(face));
  const RealRig made(mesh_of(face, false), options_);
  EXPECT_TRUE(made.rigging.place.face_only);
  EXPECT_EQ(made.rigging.made_weights.split_supports, 0u);
  EXPECT_EQ(findings(made.bytes), 0u);
  Played played(made.bytes);
  EXPECT_EQ(played.deform(0).size(), 468u);
}

}  // namespace
}  // namespace mien::author
