// SPDX-License-Identifier: MIT
// mien_author_rig() with results of the caller in place of each stage: what is taken, and which counts
// and pointers are refused. And canceling.
#include <gtest/gtest.h>
#include <mien_author.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "capi/dna_handle.h"
#include "tests/support/mesh_source.h"
#include "tests/support/rig_handles.h"

namespace mien {
namespace {

class AuthorStages : public ::testing::Test {
 protected:
  AuthorStages() : source_(author::procedural_mesh(6, true)) {
    mesh_.positions = source_.positions.data();
    mesh_.position_count = source_.positions.size() / 3;
    mesh_.face_sizes = source_.face_sizes.data();
    mesh_.face_count = source_.face_sizes.size();
    mesh_.corners = source_.corners.data();
    mesh_.corner_count = source_.corners.size();
    desc_.facial_joints = 8;
    desc_.lods = 3;
    size_t first = 0;
    for (const uint32_t size : source_.face_sizes) {
      const uint32_t* face = source_.corners.data() + first;
      for (uint32_t k = 2; k < size; ++k)
        triangles_.insert(triangles_.end(), {face[0], face[k - 1], face[k]});
      first += size;
    }
    lods_[0].corners = lods_[1].corners = triangles_.data();
    lods_[0].corner_count = triangles_.size();
    lods_[1].corner_count = 30;
    desc_.lod_meshes = lods_;
    desc_.lod_mesh_count = 2;
    for (int s = 0; s < 2; ++s) {
      shapes_[s].name = {source_.shape_names[s].data(), source_.shape_names[s].size()};
      shapes_[s].position_count = mesh_.position_count;
      shapes_[s].displacements = source_.displacements[s].data();
    }
  }
  void make_lods_as_usual() {
    desc_.lod_meshes = nullptr;
    desc_.lod_mesh_count = 0;
  }
  void add_shapes() {
    mesh_.shapes = shapes_;
    mesh_.shape_count = 2;
  }
  void add_bones() {
    desc_.bones = bones_;
    desc_.bone_count = 4;
  }
  const dna::DnaView& file() const { return dna_->view; }
  static std::string text(const dna::String& name) { return {name.chars(), name.count}; }

  /// Whether a rig is made, and what is said if not.
  MienStatus make() {
    error_ = mien_error_default();
    MienDna* dna = nullptr;
    MienAuthorReport* report = nullptr;
    const MienStatus status = mien_author_rig(&mesh_, &desc_, &dna, &report, &error_);
    EXPECT_EQ(dna != nullptr, status == MIEN_OK);
    dna_.reset(dna);
    EXPECT_EQ(report != nullptr, status == MIEN_OK);
    MienStringView json = {};
    if (report) {
      EXPECT_EQ(mien_author_report_json(report, &json), MIEN_OK);
      report_.clear();  // without the layout
      std::copy_if(json.data, json.data + json.count, std::back_inserter(report_),
                   [](char c) { return c != ' ' && c != '\n'; });
    }
    mien_author_report_close(report);
    return status;
  }
  void expect_refused(MienStatus status, const char* words) {
    EXPECT_EQ(make(), status) << words;
    EXPECT_NE(std::string(error_.message).find(words), std::string::npos) << error_.message;
  }

  author::TestMesh source_;
  std::vector<uint32_t> triangles_;
  MienAuthorMesh mesh_ = mien_author_mesh_default();
  MienAuthorDesc desc_ = mien_author_desc_default();
  MienAuthorLod lods_[2] = {};
  MienAuthorShape shapes_[2] = {};
  const MienAuthorBone bones_[4] = {{{"base", 4}, {0, 0, 0}, 0, MIEN_BONE_ROOT},
                                    {{"left", 4}, {3, -5, 8}, 0, MIEN_BONE_FACIAL},
                                    {{"right", 5}, {-3, -5, 8}, 0, MIEN_BONE_FACIAL},
                                    {{"chin", 4}, {0, -9, 8}, 0, MIEN_BONE_FACIAL}};
  DnaHandle dna_;
  MienError error_ = mien_error_default();
  std::string report_;
};

TEST_F(AuthorStages, MeshesOfLodsAreThoseOfTheCaller) {
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  EXPECT_NE(report_.find("\"own_lod_meshes\":true"), std::string::npos);
  EXPECT_NE(report_.find("\"triangles\":10,"), std::string::npos);
  desc_.lod_meshes = nullptr;
  desc_.lod_mesh_count = 0;
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  EXPECT_NE(report_.find("\"own_lod_meshes\":false"), std::string::npos);
}

TEST_F(AuthorStages, NoMeshesAreNeededForOneLod) {
  desc_.lods = 1;
  desc_.lod_mesh_count = 0;
  EXPECT_EQ(make(), MIEN_OK) << error_.message;
}

TEST_F(AuthorStages, CountsAndPointersOfMeshesThatDoNotFitAreNamed) {
  const MienStatus wrong = MIEN_ERROR_INVALID_ARGUMENT;
  desc_.lod_mesh_count = 1;
  expect_refused(wrong, "lod_meshes has 1 meshes: 3 LODs need 2");
  desc_.lod_mesh_count = 2;
  desc_.lods = 0;
  expect_refused(wrong, "lod_meshes has 2 meshes: 8 LODs need 7");
  desc_.lods = 3;
  desc_.lod_meshes = nullptr;
  expect_refused(MIEN_ERROR_NULL_ARGUMENT, "lod_meshes is NULL");
  desc_.lod_meshes = lods_;
  lods_[1].corners = nullptr;
  expect_refused(MIEN_ERROR_NULL_ARGUMENT, "corners of LOD 2 is NULL");
  lods_[1].corner_count = 0;
  expect_refused(MIEN_ERROR_AUTHOR_MESH, "LOD 2 has 0 corners");
  lods_[1] = lods_[0];
  lods_[1].corner_uvs = lods_[1].corners;
  expect_refused(MIEN_ERROR_AUTHOR_MESH, "the mesh has none");
  triangles_[5] = UINT32_MAX;
  expect_refused(MIEN_ERROR_AUTHOR_MESH, "corner 5 of LOD 1 names position 4294967295");
}

TEST_F(AuthorStages, GroupsInDepthAreThoseOfTheCaller) {
  make_lods_as_usual();
  std::vector<uint8_t> groups;
  std::string counts;
  size_t sizes[3] = {};
  for (size_t v = 0; v < mesh_.position_count; ++v) {
    const double z = source_.positions[3 * v + 2];
    groups.push_back(z > 5 ? 0 : z > -4 ? 1 : 2);
  }
  desc_.depth_groups = groups.data();
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  EXPECT_NE(report_.find("\"borders\":[]"), std::string::npos) << "none were looked for";
  // Copies of a place count once.
  std::set<std::array<double, 3>> places[3];
  for (size_t v = 0; v < mesh_.position_count; ++v) {
    const double* p = &source_.positions[3 * v];
    places[groups[v]].insert({p[0], p[1], p[2]});
  }
  for (int g = 0; g < 3; ++g) sizes[g] = places[g].size();
  counts = "\"counts\":[" + std::to_string(sizes[0]) + "," + std::to_string(sizes[1]) + "," +
           std::to_string(sizes[2]) + "]";
  EXPECT_NE(report_.find(counts), std::string::npos)
      << counts << " is not in " << report_.substr(report_.find("\"counts\""), 40);
  groups[3] = 3;
  expect_refused(MIEN_ERROR_AUTHOR_MESH, "group 3");
}

TEST_F(AuthorStages, TheMaskIsThatOfTheCaller) {
  make_lods_as_usual();
  add_shapes();
  std::vector<uint8_t> mask;
  std::string list;
  for (size_t v = 0; v < mesh_.position_count; ++v) {
    mask.push_back(source_.positions[3 * v + 1] > 2 && source_.positions[3 * v + 2] > 4);
    if (mask[v]) list += (list.empty() ? "" : ",") + std::to_string(v);
  }
  desc_.mask = mask.data();
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  EXPECT_NE(report_.find("\"mask\":[" + list + "]"), std::string::npos);
  std::fill(mask.begin(), mask.end(), uint8_t{0});
  expect_refused(MIEN_ERROR_AUTHOR_REFUSED, "mask");
}

TEST_F(AuthorStages, JointsOfLodsAreThoseOfTheCaller) {
  make_lods_as_usual();
  const uint32_t ladder[] = {8, 5, 5};
  desc_.lod_joints = ladder;
  desc_.symmetry = MIEN_SYMMETRY_OFF;
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  // And those of the body and the head, which stay at all LODs.
  const size_t others = file().defn.joint_names.count - ladder[0];
  EXPECT_GE(others, 3u);
  for (uint32_t lod = 0; lod < 3; ++lod) {
    EXPECT_EQ(file().defn.lod_joints.at(lod).count, others + ladder[lod]) << lod;
  }
}

TEST_F(AuthorStages, BonesAndWeightsAreThoseOfTheCaller) {
  make_lods_as_usual();
  add_bones();
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  ASSERT_EQ(file().defn.joint_names.count, 4u);
  for (uint32_t b = 0; b < 4; ++b) {
    EXPECT_EQ(text(file().defn.joint_names[b]), std::string(bones_[b].name.data));
  }
  EXPECT_EQ(file().defn.neutral_translations.ys[3], -9);

  std::vector<uint16_t> joints(2 * mesh_.position_count);
  std::vector<float> weights(2 * mesh_.position_count);
  for (size_t v = 0; v < mesh_.position_count; ++v) {
    joints[2 * v] = source_.positions[3 * v] > 0 ? 1 : 2;
    weights[2 * v] = 0.75f;
    joints[2 * v + 1] = 3;
    weights[2 * v + 1] = 0.25f;
  }
  desc_.influences = 2;
  desc_.weight_joints = joints.data();
  desc_.weights = weights.data();
  add_shapes();  // which leave given weights alone
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  const dna::Mesh& mesh = file().geom.meshes[0];
  ASSERT_EQ(mesh.skin_weights.count, mesh_.position_count);
  for (uint32_t v = 0; v < mesh.skin_weights.count; ++v) {
    const dna::VertexSkinWeights& given = mesh.skin_weights[v];
    ASSERT_EQ(given.weights.count, 2u);
    EXPECT_EQ(given.weights[0], 0.75f);
    EXPECT_EQ(given.joint_indices[0], joints[2 * v]);
    EXPECT_EQ(given.joint_indices[1], 3);
  }
  desc_.bones = nullptr;
  desc_.bone_count = 0;
  EXPECT_NE(make(), MIEN_OK) << "weights of bones that are not given";
}

TEST_F(AuthorStages, MotionsAndJointGroupsAreThoseOfTheCaller) {
  make_lods_as_usual();
  add_bones();
  add_shapes();
  std::vector<double> motions(2 * 4 * 6);
  motions[(0 * 4 + 1) * 6 + 1] = 0.5;  // left goes up in the first shape
  motions[(1 * 4 + 3) * 6 + 3] = 12;   // the chin turns in the second
  const uint32_t groups[] = {0, 4, 4, 9};
  desc_.bone_motions = motions.data();
  desc_.bone_groups = groups;
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  ASSERT_EQ(file().bhvr.joints.groups.count, 2u);
  const dna::JointGroup& left = file().bhvr.joints.groups[0];
  const dna::JointGroup& chin = file().bhvr.joints.groups[1];
  ASSERT_EQ(left.values.count, 1u);
  EXPECT_EQ(left.output_indices[0], 1 * 9 + 1);
  EXPECT_EQ(left.input_indices[0], 0);
  EXPECT_EQ(left.values[0], 0.5f);
  ASSERT_EQ(chin.values.count, 1u);
  EXPECT_EQ(chin.output_indices[0], 3 * 9 + 3);
  EXPECT_EQ(chin.values[0], 12.0f);
}

TEST_F(AuthorStages, CancelingAtAnyStepLeavesNothing) {
  struct Steps {
    int left;
    static int32_t MIEN_CALLBACK report(void* user, const char*, double) {
      return static_cast<Steps*>(user)->left-- == 0;
    }
  };
  make_lods_as_usual();
  add_shapes();
  MienStatus status = MIEN_ERROR_AUTHOR_CANCELED;
  int step = 0;
  for (; status == MIEN_ERROR_AUTHOR_CANCELED; ++step) {
    ASSERT_LT(step, 100);
    Steps steps = {step};
    desc_.progress = Steps::report;
    desc_.progress_user = &steps;
    status = make();  // which checks that there is no file and no report
  }
  EXPECT_EQ(status, MIEN_OK) << error_.message;
  EXPECT_GT(step, 8);
}

}  // namespace
}  // namespace mien
