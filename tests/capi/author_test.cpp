// SPDX-License-Identifier: MIT
// mien_author_rig() with meshes of LODs that are the caller's: what is taken, and which counts and
// pointers are refused.
#include <gtest/gtest.h>
#include <mien_author.h>

#include <string>
#include <vector>

#include "tests/support/mesh_source.h"

namespace mien {
namespace {

class AuthorLods : public ::testing::Test {
 protected:
  AuthorLods() : source_(author::procedural_mesh(6, false)) {
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
  }

  /// Whether a rig is made, and what is said if not.
  MienStatus make() {
    error_ = mien_error_default();
    MienDna* dna = nullptr;
    MienAuthorReport* report = nullptr;
    const MienStatus status = mien_author_rig(&mesh_, &desc_, &dna, &report, &error_);
    EXPECT_EQ(dna != nullptr, status == MIEN_OK);
    EXPECT_EQ(report != nullptr, status == MIEN_OK);
    MienStringView json = {};
    if (report) {
      EXPECT_EQ(mien_author_report_json(report, &json), MIEN_OK);
      report_.assign(json.data, json.count);
    }
    mien_author_report_close(report);
    mien_dna_close(dna);
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
  MienError error_ = mien_error_default();
  std::string report_;
};

TEST_F(AuthorLods, AreThoseOfTheCaller) {
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  EXPECT_NE(report_.find("\"own_lod_meshes\":true"), std::string::npos);
  EXPECT_NE(report_.find("\"triangles\":10,"), std::string::npos);
  desc_.lod_meshes = nullptr;
  desc_.lod_mesh_count = 0;
  ASSERT_EQ(make(), MIEN_OK) << error_.message;
  EXPECT_NE(report_.find("\"own_lod_meshes\":false"), std::string::npos);
}

TEST_F(AuthorLods, NoneAreNeededForOneLod) {
  desc_.lods = 1;
  desc_.lod_mesh_count = 0;
  EXPECT_EQ(make(), MIEN_OK) << error_.message;
}

TEST_F(AuthorLods, CountsAndPointersThatDoNotFitAreNamed) {
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

}  // namespace
}  // namespace mien
