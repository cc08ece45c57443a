// SPDX-License-Identifier: MIT
// Generated rigs with the counts, versions and names of exported characters.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "author/generate/synthetic/rig.h"
#include "tests/support/dna_bytes.h"
#include "tests/support/rig_handles.h"

namespace mien {
namespace {

std::set<std::string> names_of(const dna::List<dna::String>& list) {
  std::set<std::string> names;
  for (const dna::String& name : list) EXPECT_TRUE(names.insert(text(name)).second) << text(name);
  return names;
}

TEST(MetaHumanHead, HasThePublishedCounts) {
  for (uint32_t preset : {MIEN_PRESET_METAHUMAN_HEAD, MIEN_PRESET_ARCHETYPE}) {
    const DnaHandle dna = generate_dna(preset, 0);
    const MienDnaInfo info = info_of(dna);
    EXPECT_EQ(info.version, 5u);
    EXPECT_EQ(info.lod_count, 8u);
    EXPECT_EQ(info.joint_count, 870u);
    EXPECT_EQ(info.joint_group_count, 122u);
    EXPECT_EQ(info.gui_control_count, 174u);
    EXPECT_EQ(info.raw_control_count, 263u);
    EXPECT_EQ(info.psd_control_count, 545u);
    EXPECT_EQ(info.ml_control_count, 0u);
    EXPECT_EQ(info.rbf_control_count, 18u);
    EXPECT_EQ(info.rbf_solver_count, 1u);
    EXPECT_EQ(info.blend_shape_channel_count, preset == MIEN_PRESET_ARCHETYPE ? 0u : 782u);
  }
}

TEST(MetaHumanBody, HasThePublishedCountsIn25And27) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_METAHUMAN_BODY, 0);
  EXPECT_EQ(info_of(dna).version, 7u);
  MienWriteDesc write = sized<MienWriteDesc>();
  write.version = 5;
  size_t size = 0;
  ASSERT_EQ(mien_dna_write_memory(dna.get(), &write, nullptr, 0, &size, nullptr), MIEN_OK);
  std::vector<uint8_t> bytes(size);
  ASSERT_EQ(mien_dna_write_memory(dna.get(), &write, bytes.data(), size, &size, nullptr), MIEN_OK);
  MienDna* opened = nullptr;
  ASSERT_EQ(mien_dna_open_memory(bytes.data(), size, nullptr, &opened, nullptr), MIEN_OK);
  const DnaHandle older(opened);
  for (const DnaHandle* file : {&dna, &older}) {
    const MienDnaInfo info = info_of(*file);
    EXPECT_EQ(info.joint_count, 342u);
    EXPECT_EQ(info.rbf_solver_count, 72u);
    EXPECT_GT(info.twist_count, 0u);
    EXPECT_GT(info.swing_count, 0u);
  }
  EXPECT_EQ(info_of(older).version, 5u);
}

TEST(MetaHumanHead, HasNamesInItsConventions) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_METAHUMAN_HEAD, 0);
  const dna::Definition& defn = dna->view.defn;
  const std::set<std::string> joints = names_of(defn.joint_names);
  for (const char* name : {"neck_01", "head", "FACIAL_C_FacialRoot", "FACIAL_C_Jaw", "FACIAL_L_Eye",
                           "FACIAL_R_Eye", "FACIAL_L_EyelidUpperA", "FACIAL_L_LipCorner"}) {
    EXPECT_EQ(joints.count(name), 1u) << name;
  }
  const std::set<std::string> raw = names_of(defn.raw_control_names);
  for (const char* name :
       {"CTRL_expressions.jawOpen", "CTRL_expressions.eyeBlinkL",
        "CTRL_expressions.mouthCornerPullR", "CTRL_expressions.mouthLipsTogetherUL",
        "CTRL_expressions.tongueBendUp", "neck_01.qx", "neck_02.qw", "head.qw"}) {
    EXPECT_EQ(raw.count(name), 1u) << name;
  }
  uint32_t expressions = 0;
  for (const std::string& name : raw) expressions += name.rfind("CTRL_expressions.", 0) == 0;
  EXPECT_EQ(expressions, 251u);
  for (const char* name : {"CTRL_expressions.headTurnUpU", "CTRL_expressions.headTiltRightD"}) {
    EXPECT_EQ(names_of(dna->view.rbfe.pose_control_names).count(name), 1u) << name;
  }
  EXPECT_EQ(names_of(defn.mesh_names).count("head_lod0_mesh"), 1u);
  names_of(defn.channel_names);
}

TEST(MetaHumanHead, TurningTheNeckDrivesItsPoseControlsAndJoints) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_METAHUMAN_HEAD, 3);
  const RigHandle rig = create_rig(dna.get());
  MienInstance* instance = nullptr;
  ASSERT_EQ(mien_instance_create(rig.get(), nullptr, &instance, nullptr), MIEN_OK);
  MienMutableFloatView raw{};
  ASSERT_EQ(mien_instance_raw_controls(instance, &raw), MIEN_OK);
  MienFloatView all{}, joints{};
  const auto evaluate = [&] {
    EXPECT_EQ(mien_rig_evaluate(rig.get(), instance, 0), MIEN_OK);
    EXPECT_EQ(mien_instance_controls(instance, &all), MIEN_OK);
    EXPECT_EQ(mien_instance_joints(instance, &joints), MIEN_OK);
  };
  evaluate();
  const std::vector<float> rest(joints.data, joints.data + joints.count);
  const size_t first_pose = 263 + 545;
  ASSERT_EQ(all.count, first_pose + 18);

  // The 12 inputs stand behind 251 expressions: neck_01, neck_02, head. Each pose once.
  const float sine = 0.258819f, cosine = 0.965926f;
  const struct {
    int axis;
    float sine;
  } turns[] = {{0, -sine}, {0, sine}, {1, sine}, {1, -sine}, {2, -sine}, {2, sine}};
  for (size_t pose = 0; pose < 18; ++pose) {
    for (int joint = 0; joint < 3; ++joint) {
      for (int part = 0; part < 4; ++part)
        raw.data[251 + joint * 4 + part] = part == 3 ? 1.0f : 0.0f;
    }
    float* turned = raw.data + 251 + (2 - pose % 3) * 4;
    turned[turns[pose / 3].axis] = turns[pose / 3].sine;
    turned[3] = cosine;
    evaluate();
    for (size_t other = 0; other < 18; ++other) {
      if (other == pose) {
        EXPECT_GT(all.data[first_pose + other], 0.9f) << pose;
      } else {
        EXPECT_LT(all.data[first_pose + other], all.data[first_pose + pose])
            << pose << " " << other;
      }
    }
    double moved = 0;
    for (size_t i = 0; i < joints.count; ++i) moved += std::abs(joints.data[i] - rest[i]);
    EXPECT_GT(moved, 1.0) << pose;
  }
  mien_instance_destroy(instance);
}

TEST(MetaHumanRigs, PassAllChecksAndRepeat) {
  for (uint32_t preset :
       {MIEN_PRESET_METAHUMAN_HEAD, MIEN_PRESET_METAHUMAN_BODY, MIEN_PRESET_ARCHETYPE}) {
    const std::vector<uint8_t> bytes = write_dna(generate_dna(preset, 9).get());
    EXPECT_EQ(bytes, write_dna(generate_dna(preset, 9).get()));
    EXPECT_NE(bytes, write_dna(generate_dna(preset, 10).get()));
    MienReport* report = nullptr;
    ASSERT_EQ(mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &report, nullptr),
              MIEN_OK);
    uint32_t errors = 0, warnings = 0;
    EXPECT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
    EXPECT_EQ(errors + warnings, 0u) << preset;
    mien_report_destroy(report);
  }
}

TEST(MetaHumanRigs, HaveNoMachineLearnedBehavior) {
  for (uint32_t preset :
       {MIEN_PRESET_METAHUMAN_HEAD, MIEN_PRESET_METAHUMAN_BODY, MIEN_PRESET_ARCHETYPE}) {
    MienGenerateDesc desc = sized<MienGenerateDesc>();
    desc.preset = preset;
    desc.flags = MIEN_GENERATE_ML;
    MienDna* dna = nullptr;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_generate(&desc, &dna, &error), MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(error.message).find("flags"), std::string::npos);
  }
}

}  // namespace
}  // namespace mien
