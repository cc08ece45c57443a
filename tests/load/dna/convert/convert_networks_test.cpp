// SPDX-License-Identifier: MIT
// Networks in another coordinate system: inputs that are parts of a quaternion change their sign,
// outputs that move joints their unit. Where one set of weights cannot do both, the call refuses.
#include "runtime/load/dna/convert/convert_networks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/layer_rig.h"
#include "tests/support/other_system.h"

namespace mien {
namespace {

using Operation = OperationType;

// Controls: 0 and 1 are plain, 2 3 4 5 the quaternion x y z w that a twist reads, 6 to 9 are learned.
class ConvertNetworks : public testing::Test {
 protected:
  LayerRig rig;
  MienCoordinateSystem mirrored = sized<MienCoordinateSystem>(), meters;
  std::vector<std::vector<uint8_t>> files;  // what has been converted points into them

  void SetUp() override {
    rig.base.lod_count = 1;
    rig.base.raw_count = 6;
    rig.base.joint_count = 2;
    rig.ml_count = 4;
    rig.raw_w = {5};
    rig.twists = {{0, {2, 3, 4, 5}, {1}, {0.5f}}};
    rig.regions = {{0}};
    ASSERT_EQ(mien_coordinate_system_find("opengl", &mirrored), MIEN_OK);
  }

  static PlainNetwork network(const std::vector<uint16_t>& inputs,
                              const std::vector<uint16_t>& outputs) {
    PlainNetworkLayer layer;
    layer.biases.assign(outputs.size(), 0.25f);
    layer.weights.assign(inputs.size() * outputs.size(), 0.5f);
    return {inputs, outputs, {layer}};
  }
  /// Gathers `first` and `second`, and runs network 0 with each.
  void run_twice(const std::vector<uint32_t>& first, const std::vector<uint32_t>& second) {
    rig.networks[0].inputs = rig.networks[0].outputs = {};
    rig.operations = {{{Operation::kGather, first, {}}, {Operation::kGather, second, {}}},
                      {{Operation::kMlp, {0}, {{0, 0}}}, {Operation::kMlp, {0}, {{0, 1}}}}};
  }
  /// Controls 6, 7 and 8 are the translation of joint 0; in meters it is a hundredth.
  void move_joint() {
    const LayerFile file(rig);
    meters = system_of(file.dna.get());
    meters.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
    rig.ml_parameters = {{0, 0}, {1, 0}, {2, 0}};
    rig.ml_joints = {{6, 0}, {7, 1}, {8, 2}};
  }

  DnaHandle converted(const MienCoordinateSystem& system) {
    const LayerFile file(rig);
    if (!file.dna) return nullptr;
    files.push_back(file.bytes);
    return open_in_system(files.back(), system);
  }
  void expect_refused(const MienCoordinateSystem& system, const char* words) {
    const LayerFile file(rig);
    ASSERT_TRUE(file.dna);
    std::string message;
    EXPECT_FALSE(open_in_system(file.bytes, system, MIEN_ERROR_DNA_VALUE, &message));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
  static std::vector<float> floats(const DnaHandle& dna, const char* field, size_t count) {
    std::vector<float> values(count);
    EXPECT_EQ(mien_dna_read_floats(dna.get(), field, 0, count, values.data(), nullptr), MIEN_OK);
    return values;
  }
};

constexpr char kWeights[] = "mlbh.neuralNetworks[0].layers[0].weights";
constexpr char kBiases[] = "mlbh.neuralNetworks[0].layers[0].biases";

TEST_F(ConvertNetworks, InputsOfNetworksWithoutOperationsTakeTheirSigns) {
  rig.networks = {network({0, 2, 3, 4, 5, 1}, {6, 7})};
  const DnaHandle dna = converted(mirrored);
  ASSERT_TRUE(dna);
  const std::vector<float> weights = floats(dna, kWeights, 12);
  int negative = 0;
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(std::fabs(weights[i]), 0.5f);
    const bool turns = i % 6 >= 1 && i % 6 <= 3;  // x, y or z
    EXPECT_TRUE(turns || weights[i] > 0) << i;
    negative += weights[i] < 0;
  }
  EXPECT_EQ(negative, 4) << "two of three, in both rows";
}

TEST_F(ConvertNetworks, WithoutLayersOrOutputsNothingIsDone) {
  rig.networks = {{{2, 3}, {}, {}}, {{2, 3}, {}, {PlainNetworkLayer{}}}};
  EXPECT_TRUE(converted(mirrored));
}

TEST_F(ConvertNetworks, OutputsMayBePlainControlsButNoPartOfAQuaternion) {
  rig.networks = {network({0}, {1})};
  EXPECT_TRUE(converted(mirrored));
  rig.networks = {network({0}, {2})};
  expect_refused(mirrored, "writes a control that is part of a quaternion input");
}

TEST_F(ConvertNetworks, RunTwiceInputsChangeTheirSignsInOneWay) {
  rig.networks = {network({2, 0}, {6, 7})};
  run_twice({2, 0}, {2, 1});
  EXPECT_TRUE(converted(mirrored));
  // x, y and z do not all change, and plain controls never do.
  bool refused = false;
  for (const uint32_t part : {2u, 3u, 4u}) {
    run_twice({part, 0}, {1, 0});
    const LayerFile file(rig);
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.system = &mirrored;
    MienError error = sized<MienError>();
    MienDna* dna = nullptr;
    const MienStatus status =
        mien_dna_open_memory(file.bytes.data(), file.bytes.size(), &desc, &dna, &error);
    mien_dna_close(dna);
    if (status == MIEN_OK) continue;
    EXPECT_EQ(status, MIEN_ERROR_DNA_VALUE);
    EXPECT_NE(std::string(error.message).find("inputs that change their signs in different ways"),
              std::string::npos)
        << error.message;
    refused = true;
  }
  EXPECT_TRUE(refused);
}

TEST_F(ConvertNetworks, SumsReadPlainControlsOnly) {
  rig.networks = {network({}, {})};
  const auto sum_of = [&](const std::vector<uint32_t>& controls) {
    rig.operations = {{{Operation::kGather, controls, {}}},
                      {{Operation::kWeightedSum, {1, 0}, {{0, 0}}}},
                      {{Operation::kScatter, {6}, {{1, 0}}}}};
  };
  sum_of({0, 1});
  EXPECT_TRUE(converted(mirrored));
  sum_of({0, 2, 3, 4});
  expect_refused(mirrored, "a weighted sum reads control");
}

TEST_F(ConvertNetworks, OutputsTakeTheUnitOfWhatTheyMove) {
  rig.networks = {network({0, 1}, {6, 7, 8, 9})};
  move_joint();
  const DnaHandle dna = converted(meters);
  ASSERT_TRUE(dna);
  const std::vector<float> weights = floats(dna, kWeights, 8), biases = floats(dna, kBiases, 4);
  for (size_t i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(weights[i], i < 6 ? 0.005f : 0.5f) << i;
  for (size_t i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(biases[i], i < 3 ? 0.0025f : 0.25f) << i;
}

TEST_F(ConvertNetworks, ANetworkOfBiasesAloneTakesUnits) {
  rig.networks = {network({}, {6, 7, 8})};
  move_joint();
  const DnaHandle dna = converted(meters);
  ASSERT_TRUE(dna);
  for (const float bias : floats(dna, kBiases, 3)) EXPECT_FLOAT_EQ(bias, 0.0025f);
}

TEST_F(ConvertNetworks, WhatIsScatteredNowhereKeepsItsUnit) {
  rig.networks = {network({0}, {6, 7, 8, 9})};
  rig.networks[0].inputs = rig.networks[0].outputs = {};
  rig.operations = {{{Operation::kGather, {0}, {}}},
                    {{Operation::kMlp, {0}, {{0, 0}}}},
                    {{Operation::kScatter, {6, 7, 8}, {{1, 0}, {0, 0}}}}};
  move_joint();
  const DnaHandle dna = converted(meters);
  ASSERT_TRUE(dna);
  const std::vector<float> biases = floats(dna, kBiases, 4);
  for (size_t i = 0; i < 4; ++i) EXPECT_FLOAT_EQ(biases[i], i < 3 ? 0.0025f : 0.25f) << i;
}

TEST_F(ConvertNetworks, RunTwiceAnOutputHasOneUnit) {
  rig.networks = {network({0}, {6, 7, 8})};
  move_joint();
  run_twice({0}, {1});
  rig.operations.push_back(
      {{Operation::kScatter, {6, 7, 8}, {{1, 0}}}, {Operation::kScatter, {6, 7, 8}, {{1, 1}}}});
  EXPECT_TRUE(converted(meters));
  rig.operations[2][1].parameters = {6, 7, 9};
  expect_refused(meters, "writes one output in two units");
}

TEST_F(ConvertNetworks, WhatMovesJointsIsReadByNoOtherOperation) {
  rig.networks = {network({0}, {6, 7, 8}), network({0, 1, 2}, {9})};
  for (PlainNetwork& n : rig.networks) n.inputs = n.outputs = {};
  rig.operations = {{{Operation::kGather, {0}, {}}},
                    {{Operation::kMlp, {0}, {{0, 0}}}},
                    {{Operation::kMlp, {1}, {{1, 0}}}, {Operation::kScatter, {9, 1, 9}, {{1, 0}}}}};
  move_joint();
  EXPECT_TRUE(converted(meters));
  rig.operations[2][1].parameters = {6, 7, 8};
  expect_refused(meters, "moves joints, and other operations read it too");
}

// What moves a joint is in the joint's own system as long as networks run.
TEST_F(ConvertNetworks, WhatMovesJointsIsReadAsItIs) {
  rig.networks = {network({6, 0}, {9})};
  move_joint();
  const DnaHandle dna = converted(mirrored);
  ASSERT_TRUE(dna);
  for (const float weight : floats(dna, kWeights, 2)) EXPECT_EQ(weight, 0.5f);
}

TEST_F(ConvertNetworks, TheFirstThatCannotFollowIsTold) {
  rig.networks = {network({0}, {2}), network({0}, {3})};
  expect_refused(mirrored, "mlbh.neuralNetworks[0]");
}

// More is scattered than the network gives.
TEST_F(ConvertNetworks, WhatNoOutputWritesHasNoUnit) {
  rig.networks = {network({0}, {6, 7})};
  rig.networks[0].inputs = rig.networks[0].outputs = {};
  rig.operations = {{{Operation::kGather, {0}, {}}},
                    {{Operation::kMlp, {0}, {{0, 0}}}},
                    {{Operation::kScatter, {6, 7, 8}, {{1, 0}}}}};
  move_joint();
  const DnaHandle dna = converted(meters);
  ASSERT_TRUE(dna);
  for (const float bias : floats(dna, kBiases, 2)) EXPECT_FLOAT_EQ(bias, 0.0025f);
}

}  // namespace
}  // namespace mien
