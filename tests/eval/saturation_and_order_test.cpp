// SPDX-License-Identifier: MIT
// Some rules of docs/rig-evaluation.md, 12 "Rules that keep results meaningful". The others are
// tested beside their subject.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/layer_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

LayerRig one_joint(uint16_t raw_count) {
  LayerRig rig;
  rig.base.raw_count = raw_count;
  rig.base.joint_count = 1;
  return rig;
}

TEST(CorrectiveChains, AreRightInTheSameFrame) {
  LayerRig rig = one_joint(1);
  rig.base.psd_count = 3;
  // The last reads the first, which reads the one between: three frames late, if evaluated in
  // order.
  rig.base.psds = {{1, 2, 0.5f}, {2, 0, 0.5f}, {3, 1, 2}};
  rig.base.groups = {{{1}, {3}, {0}, {1}}};
  const LayerFile file(rig);
  for (uint32_t isa : present_isas()) {
    Character character(create_rig(file.dna.get(), isa));
    character.raw[0] = 1;
    character.evaluate(0);
    EXPECT_EQ(character.psd[1], 0.5f);
    EXPECT_EQ(character.psd[0], 0.25f);
    EXPECT_EQ(character.psd[2], 0.5f);
    EXPECT_EQ(character.joints[0], 0.5f) << mien_isa_name(isa);
  }
}

TEST(CorrectiveChains, CirclesAreRefused) {
  LayerRig rig = one_joint(1);
  rig.base.psd_count = 2;
  rig.base.psds = {{1, 2, 1}, {2, 1, 1}};
  rig.base.groups = {{{1}, {1}, {0}, {1}}};
  const LayerFile file(rig);
  EXPECT_EQ(create_rig(file.dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_ERROR_DNA_VALUE), nullptr);
}

TEST(QuaternionControls, OfTheUserStayAsTheyAre) {
  LayerRig rig = one_joint(6);
  rig.base.lod_count = 2;
  rig.base.gui_count = 1;
  rig.base.gui_to_raw = {{0, 0, 0, 1, 1, 0}};
  rig.raw_w = {5};
  rig.twists = {{0, {2, 3, 4, 5}, {0}, {0}}};
  const LayerFile file(rig);
  Character character(create_rig(file.dna.get()));
  EXPECT_EQ(character.raw[5], 1) << "w begins at 1";
  const float input[4] = {0.6f, 0, 0, 0.8f};
  std::copy(input, input + 4, character.raw.begin() + 2);
  character.raw[1] = 0.25f;
  character.gui[0] = 0.75f;
  character.map_gui_to_raw();
  character.evaluate(0);
  character.evaluate(1);
  character.evaluate(0);
  EXPECT_EQ(character.raw[0], 0.75f);
  EXPECT_EQ(character.raw[1], 0.25f) << "no row drives it";
  EXPECT_TRUE(std::equal(input, input + 4, character.raw.begin() + 2));
}

TEST(GuiControls, WithoutRowsAreZero) {
  LayerRig rig = one_joint(2);
  rig.base.gui_count = 3;
  for (bool empty : {false, true}) {
    if (!empty) rig.base.gui_to_raw = {{1, 0, 0, 1, 1, 0}};
    if (empty) rig.base.gui_to_raw.clear();
    const LayerFile file(rig);
    Character character(create_rig(file.dna.get()));
    std::fill(character.gui.begin(), character.gui.end(), 7.0f);
    character.raw[0] = 0.5f;
    character.map_raw_to_gui();
    EXPECT_EQ(character.gui[0], 0);
    EXPECT_EQ(character.gui[1], empty ? 0 : 0.5f);
    EXPECT_EQ(character.gui[2], 0);
  }
}

// Each with a number that is one too large.
TEST(Indices, PastTheEndAreRefused) {
  using dna::be;
  Arena arena(default_allocator());
  const auto refused = [&](const char* expected, auto change,
                           MienStatus status = MIEN_ERROR_DNA_REFERENCE) {
    dna::DnaView view = dna::tiny_rig(arena);
    change(view);
    const std::vector<uint8_t> bytes = write_view(view);
    MienDna* dna = nullptr;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), nullptr, &dna, &error), status);
    EXPECT_STREQ(error.message, expected);
    mien_dna_close(dna);
  };
  refused("rbfb.solvers[0].poseIndices: element 1 is 2, but there are 2 poses",
          [&](dna::DnaView& v) {
            v.rbfb.solvers[0].pose_indices = be<uint16_t>(arena, {0, 2});
          });
  refused(
      "rbfe.poses[0].outputControlIndices: element 0 is 11, but there are 11 controls",
      [&](dna::DnaView& v) { v.rbfe.poses[0].output_control_indices = be<uint16_t>(arena, {11}); });
  refused(
      "twsw.twists[0].twistOutputJointIndices: element 0 is 3, but there are 3 joints",
      [&](dna::DnaView& v) { v.twsw.twists[0].output_joint_indices = be<uint16_t>(arena, {3}); });
  refused("twsw.swings[0].swingInputControlIndices: element 3 is 11, but there are 11 controls",
          [&](dna::DnaView& v) {
            v.twsw.swings[0].input_control_indices = be<uint16_t>(arena, {0, 1, 2, 11});
          });
  refused("mlbh.neuralNetworks[0].outputIndices: element 3 is 11, but there are 11 controls",
          [&](dna::DnaView& v) {
            v.mlbh.networks[0].output_indices = be<uint16_t>(arena, {5, 6, 7, 11});
          });
  refused(
      "mlbe.mlbTypeData[0].operations[1][0].parameters: "
      "element 0 is 1, but there are 1 networks",
      [&](dna::DnaView& v) {
        v.mlbe.types[0].operations[1][0].parameters = be<uint32_t>(arena, {1, 3, 3, 4, 4});
      });
  refused(
      "mlbe.mlbTypeData[0].operations[2][0].mlOperationDependencyIndices: "
      "element 0 is 1, but set 1 has 1 operations",
      [&](dna::DnaView& v) {
        v.mlbe.types[0].operations[2][0].operation_dependencies = be<uint16_t>(arena, {1});
      });
  refused(
      "mlbe.mlbTypeData[0].operations[1][0].mlOperationSetDependencyIndices: "
      "element 0 is 2, but an operation of set 1 can only depend on earlier sets",
      [&](dna::DnaView& v) {
        v.mlbe.types[0].operations[1][0].set_dependencies = be<uint16_t>(arena, {2});
      },
      MIEN_ERROR_DNA_VALUE);
  refused("mlbe.mlbJoints.outputIndices: element 3 is 30, but there are 30 joint values",
          [&](dna::DnaView& v) {
            v.mlbe.joints.output_indices = be<uint16_t>(arena, {23, 24, 25, 30});
          });
  refused("mlbh.neuralNetworkToMeshRegion.indices[0][0]: element 0 is 1, but there are 1 networks",
          [&](dna::DnaView& v) { v.mlbh.mesh_regions.indices[0][0] = be<uint16_t>(arena, {1}); });
}

}  // namespace
}  // namespace mien
