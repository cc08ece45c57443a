// SPDX-License-Identifier: MIT
#include "author/rigging/metahuman_names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace mien::author {
namespace {

TEST(MetahumanNames, AreThoseOfBonesWithACounterpart) {
  struct Wanted {
    BoneKind kind;
    double x;
    const char* name;
  };
  const Wanted wanted[] = {
      {BoneKind::kRoot, 0, "own"},         {BoneKind::kChest, 0, "spine_05"},
      {BoneKind::kNeck, 0, "neck_01"},     {BoneKind::kNeck, 0, "neck_02"},
      {BoneKind::kHead, 0, "head"},        {BoneKind::kFace, 0, "FACIAL_C_FacialRoot"},
      {BoneKind::kFacial, 3, "own"},       {BoneKind::kJaw, 0, "FACIAL_C_Jaw"},
      {BoneKind::kEye, 3, "FACIAL_L_Eye"}, {BoneKind::kEye, -3, "FACIAL_R_Eye"},
      {BoneKind::kEye, 4, "FACIAL_L_Eye2"}};
  std::vector<Bone> bones;
  for (const Wanted& of : wanted) {
    Bone bone;
    bone.kind = of.kind;
    bone.position.x = of.x + 1;
    bone.name = {"own", 3};
    bones.push_back(bone);
  }
  Placement placement;
  placement.symmetry_plane = 1;
  placement.bones = {bones.data(), bones.size()};
  Arena arena(default_allocator());
  ASSERT_TRUE(name_as_metahuman(placement, arena));
  for (size_t b = 0; b < bones.size(); ++b) {
    const Name name = placement.bones[b].name;
    EXPECT_EQ(std::string(name.data, name.count), wanted[b].name);
  }
}

}  // namespace
}  // namespace mien::author
