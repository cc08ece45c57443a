// SPDX-License-Identifier: MIT
// What meshes are by their names: one table for images and exported files.
#include "integrations/program/io/mesh_appearance.h"

#include <gtest/gtest.h>

#include <utility>

namespace mien::cli {
namespace {

TEST(MeshClass, NamesOfProductionMeshesAreKnown) {
  const std::pair<const char*, MeshClass> kExpected[] = {
      {"head_lod0_mesh", MeshClass::kSkin},           {"teeth_lod0_mesh", MeshClass::kTeeth},
      {"saliva_lod0_mesh", MeshClass::kFilm},         {"eyeLeft_lod0_mesh", MeshClass::kEye},
      {"eyeRight_lod0_mesh", MeshClass::kEye},        {"eyeshell_lod0_mesh", MeshClass::kFilm},
      {"eyelashes_lod0_mesh", MeshClass::kLash},      {"eyeEdge_lod0_mesh", MeshClass::kFilm},
      {"cartilage_lod0_mesh", MeshClass::kCartilage},
  };
  for (const auto& [name, expected] : kExpected) {
    EXPECT_EQ(static_cast<int>(mesh_class(name)), static_cast<int>(expected)) << name;
  }
}

TEST(MeshClass, LongerWordsDecideBeforeTheirParts) {
  EXPECT_EQ(mesh_class("eyelid_upper"), MeshClass::kSkin);
  EXPECT_EQ(mesh_class("eyebrows"), MeshClass::kBrow);
  EXPECT_EQ(mesh_class("Eyelash_cards"), MeshClass::kLash);
  EXPECT_EQ(mesh_class("eye_tearline"), MeshClass::kFilm);
  EXPECT_EQ(mesh_class("upper_teeth_gum"), MeshClass::kTeeth);
  EXPECT_EQ(mesh_class("gum_upper"), MeshClass::kGums);
}

TEST(MeshClass, CaseDoesNotMatter) {
  EXPECT_EQ(mesh_class("TONGUE"), MeshClass::kTongue);
  EXPECT_EQ(mesh_class("Iris_L"), MeshClass::kEye);
}

TEST(MeshClass, UnknownNamesAreSkin) {
  EXPECT_EQ(mesh_class(""), MeshClass::kSkin);
  EXPECT_EQ(mesh_class("polySurface12"), MeshClass::kSkin);
}

TEST(MeshClass, OnlyCoversNeedTextures) {
  EXPECT_TRUE(needs_textures(mesh_class("eyeshell")));
  EXPECT_TRUE(needs_textures(mesh_class("lashes")));
  EXPECT_TRUE(needs_textures(mesh_class("cartilage")));
  EXPECT_FALSE(needs_textures(mesh_class("eyelid")));
  EXPECT_FALSE(needs_textures(mesh_class("hair")));
  EXPECT_FALSE(needs_textures(mesh_class("mouth_socket")));
}

}  // namespace
}  // namespace mien::cli
