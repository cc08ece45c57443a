// SPDX-License-Identifier: MIT
// Learned behavior against a plain model (integrations/program/model/ml_model.h): networks, operations, masks,
// and the joints that follow, on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "integrations/program/model/ml_model.h"
#include "tests/support/same_joints.h"

namespace mien {
namespace {

constexpr uint16_t kRaw = 12;  // four plain controls, two quaternions

const uint32_t kOutputs[] = {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION};

struct Options {
  uint32_t isa = MIEN_ISA_ENVIRONMENT, masks = MIEN_ML_MASKS_SWITCH,
           output = MIEN_ROTATION_OUTPUT_EULER;
  uint32_t storage = MIEN_STORAGE_32_BIT;
};

RigHandle make_neural_rig(const LayerFile& file, const Options& options) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.isa = options.isa;
  desc.ml_masks = options.masks;
  desc.rotation_output = options.output;
  desc.storage = options.storage;
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_create(file.dna.get(), &desc, &rig, &error), MIEN_OK) << error.message;
  return RigHandle(rig);
}

std::vector<float> random_floats(size_t count, double range, Random& random) {
  std::vector<float> all(count);
  for (float& value : all) value = static_cast<float>(random.between(-range, range));
  return all;
}

PlainNetwork random_network(uint32_t inputs, const std::vector<uint32_t>& widths, uint16_t function,
                            Random& random) {
  PlainNetwork network;
  for (uint32_t i = 0; i < inputs; ++i) {
    network.inputs.push_back(static_cast<uint16_t>(random.below(kRaw)));
  }
  for (uint32_t width : widths) {
    PlainNetworkLayer layer;
    layer.biases = random_floats(width, 0.5, random);
    layer.weights = random_floats(size_t{width} * inputs, 1.5 / std::sqrt(inputs), random);
    layer.function = width == widths.back() ? 0 : function;
    if (function == 2) layer.parameters = {0.125f};
    network.layers.push_back(layer);
    inputs = width;
  }
  return network;
}

/// A rig of networks that write the ML controls one behind the other.
LayerRig network_rig(const std::vector<PlainNetwork>& networks) {
  LayerRig rig;
  rig.base.raw_count = kRaw;
  rig.base.joint_count = 2;
  rig.networks = networks;
  for (PlainNetwork& network : rig.networks) {
    for (size_t i = 0; i < network.layers.back().biases.size(); ++i) {
      network.outputs.push_back(static_cast<uint16_t>(kRaw + rig.ml_count++));
    }
  }
  return rig;
}

void expect_model(const LayerRig& rig, Random& random, int frames, double tolerance = 1e-5) {
  const LayerFile file(rig);
  for (uint32_t isa : present_isas()) {
    for (uint32_t masks : {MIEN_ML_MASKS_SWITCH, MIEN_ML_MASKS_BLEND}) {
      for (uint32_t output : kOutputs) {
        const RigHandle handle = make_neural_rig(file, {isa, masks, output});
        ASSERT_TRUE(handle);
        for (int frame = 0; frame < frames; ++frame) {
          Character character(handle);
          const std::vector<float> raw = random_raw(rig, {4, 8}, random);
          std::copy(raw.begin(), raw.end(), character.raw.begin());
          std::vector<double> mask_values;
          for (float& mask : character.masks) {
            const float masked[] = {0, 1, static_cast<float>(random.between(-0.2, 1.2))};
            mask = masked[random.below(3)];
            mask_values.push_back(mask);
          }
          for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
            std::vector<double> expected = initial_controls(rig);
            std::copy(raw.begin(), raw.end(), expected.begin());
            model_ml(rig, lod, mask_values, masks == MIEN_ML_MASKS_BLEND, expected);
            character.evaluate(lod);
            const bool quaternions = output == MIEN_ROTATION_OUTPUT_QUATERNION;
            const bool converts = rig.ml_parameters.size() > 3;
            for (size_t i = 0; i < expected.size() && !converts; ++i) {
              ASSERT_NEAR(character.controls[i], expected[i], tolerance)
                  << mien_isa_name(isa) << ", LOD " << lod << ", control " << i;
            }
            ASSERT_TRUE(same_joints(joints_of(rig, character.joints, quaternions),
                                    model_joints(rig, expected, lod, quaternions), 2e-5, 1e-4))
                << mien_isa_name(isa) << ", LOD " << lod << ", output form " << output;
          }
        }
      }
    }
  }
}

TEST(Networks, EveryActivationAndWidth) {
  Random random = Random::from_seed(33, 1);
  for (uint16_t function = 0; function < 5; ++function) {
    std::vector<PlainNetwork> networks;
    for (uint32_t width : {1u, 2u, 15u, 16u, 17u, 33u, 100u}) {
      networks.push_back(random_network(1 + random.below(40), {width, 3}, function, random));
      networks.push_back(random_network(width, {7, 1 + random.below(20), 5}, function, random));
      networks.push_back(random_network(3, {width}, function, random));
    }
    expect_model(network_rig(networks), random, 3, 2e-5);
  }
}

TEST(Networks, OfEachLod) {
  Random random = Random::from_seed(33, 2);
  std::vector<PlainNetwork> networks;
  for (int i = 0; i < 4; ++i) networks.push_back(random_network(6, {9, 5}, 3, random));
  LayerRig rig = network_rig(networks);
  rig.base.lod_count = 3;
  rig.lod_networks = {{0, 1, 2, 3}, {2, 0}, {}};
  rig.ml_w = {3, 19};
  expect_model(rig, random, 5);
}

// docs/rig-evaluation.md, 12.12 "Masks may blend": 0 and 1 switch as ever; in between the output
// blends with its default.
TEST(RegionMasks, SwitchOrBlend) {
  Random random = Random::from_seed(33, 3);
  std::vector<PlainNetwork> networks;
  for (int i = 0; i < 5; ++i) networks.push_back(random_network(6, {9, 5}, 3, random));
  LayerRig rig = network_rig(networks);
  rig.regions = {{0, 2}, {2, 1}, {3}};  // 2 belongs to the first, 4 to none
  expect_model(rig, random, 20);
}

TEST(Operations, GatherRunSumScatterAndRunAgain) {
  Random random = Random::from_seed(33, 4);
  for (int round = 0; round < 20; ++round) {
    LayerRig rig;
    rig.base.raw_count = kRaw;
    rig.base.joint_count = 1;
    rig.base.lod_count = 2;
    rig.ml_count = 24;
    rig.networks = {random_network(5, {11, 6}, 3, random), random_network(3, {6}, 4, random),
                    random_network(12, {8, 7}, 1, random), random_network(8, {9}, 2, random)};
    rig.regions = {{0}, {2, 3}};
    const auto gather = [&](uint32_t count) {
      PlainOperation operation = {OperationType::kGather, {}, {}};
      for (uint32_t i = 0; i < count; ++i) operation.parameters.push_back(random.below(kRaw));
      return operation;
    };
    const auto scatter = [&](uint32_t first, uint32_t count,
                             std::vector<std::pair<uint16_t, uint16_t>> from) {
      PlainOperation operation = {OperationType::kScatter, {}, std::move(from)};
      for (uint32_t i = 0; i < count; ++i) operation.parameters.push_back(kRaw + first + i);
      return operation;
    };
    PlainOperation sum = {OperationType::kWeightedSum, {6}, {{1, 0}, {1, 1}, {0, 2}}};
    for (int d = 0; d < 3; ++d) {
      const auto weight = static_cast<float>(random.between(-1, 1));
      uint32_t bits;
      memcpy(&bits, &weight, sizeof(bits));
      sum.parameters.push_back(bits);
    }
    // Row limits [layer][lod]: of the last layer they say how much is scattered.
    rig.operations = {
        {gather(2), gather(3), gather(6)},
        {{OperationType::kMlp, {0}, {{0, 0}, {0, 1}}}, {OperationType::kMlp, {1}, {{0, 1}}}},
        {sum},
        {{OperationType::kMlp, {2, 8, 8, 7, 4}, {{1, 0}, {2, 0}}}},
        {scatter(0, 4, {{3, 0}}), scatter(4, 3, {{3, 0}}), scatter(7, 4, {{1, 1}})},
        // Reads what was scattered: a gather stands before what it is for.
        {{OperationType::kGather, {kRaw, kRaw + 1, kRaw + 2, kRaw + 7, kRaw + 8, 0, 1, 2}, {}}},
        {{OperationType::kMlp, {3, 5, 2}, {{5, 0}}}},
        {scatter(14, 9, {{6, 0}})}};
    expect_model(rig, random, 3, 2e-5);
  }
}

// ML joints ---------------------------------------------------------------------------------------

/// Joint 0 and 1 follow the ML controls, which a network of one layer gives. Joint 0 is moved by a
/// group besides.
LayerRig ml_joint_rig(bool quaternions, bool translations, bool scales, Random& random) {
  const uint32_t rotation = quaternions ? 4 : 3;
  const uint32_t width = (translations ? 3 : 0) + rotation + (scales ? 3 : 0);
  PlainNetwork network = random_network(4, {2 * width}, 0, random);
  for (uint32_t i = 0; i < 4; ++i) network.inputs[i] = static_cast<uint16_t>(i);
  // Angles of tens of degrees; quaternions that are far from none.
  for (size_t i = 0; i < network.layers[0].biases.size(); ++i) {
    if (!quaternions) {
      network.layers[0].biases[i] *= 40;
      for (size_t c = 0; c < 4; ++c) network.layers[0].weights[i * 4 + c] *= 15;
    }
  }
  LayerRig rig = network_rig({network});
  rig.ml_parameters = {};
  if (translations) rig.ml_parameters.push_back({uint16_t{0}, uint16_t{0}});
  rig.ml_parameters.push_back({uint16_t{1}, static_cast<uint16_t>(quaternions)});
  if (scales) rig.ml_parameters.push_back({uint16_t{2}, uint16_t{0}});
  for (uint16_t i = 0; i < 2 * width; ++i) {
    rig.ml_joints.push_back({static_cast<uint16_t>(kRaw + i), i});
  }
  if (quaternions) {
    const uint32_t w = (translations ? 3 : 0) + 3;
    rig.ml_w = {static_cast<uint16_t>(w), static_cast<uint16_t>(width + w)};
    for (uint32_t joint = 0; joint < 2; ++joint) {
      network.layers[0].biases[joint * width + w] += 3;
    }
    rig.networks[0].layers = network.layers;
  }
  rig.rotations = {0, 0};
  PlainGroup group;
  group.inputs = {0, 1};
  for (uint16_t k = 0; k < 9; ++k) {
    group.outputs.push_back(k);
    for (int c = 0; c < 2; ++c) {
      group.values.push_back(
          static_cast<float>(random.between(-1, 1) * (k >= 3 && k < 6 ? 20 : 1)));
    }
  }
  group.lods = {9};
  rig.base.groups = {group};
  return rig;
}

// docs/rig-evaluation.md, 12.3 "ML joints in every combination": all four combinations of what
// networks give and what comes out, Euler angles on both sides and rotations alone among them.
TEST(MlJoints, InEveryCombination) {
  Random random = Random::from_seed(33, 5);
  for (bool quaternions : {false, true}) {
    for (bool translations : {false, true}) {
      for (bool scales : {false, true}) {
        for (uint16_t sequence = 0; sequence < 6; ++sequence) {
          LayerRig rig = ml_joint_rig(quaternions, translations, scales, random);
          rig.sequence = sequence;
          rig.signs = {sequence % 2 ? -1 : 1, 1, sequence % 3 ? 1 : -1};
          SCOPED_TRACE("quaternions " + std::to_string(quaternions) + ", sequence " +
                       std::to_string(sequence));
          expect_model(rig, random, 3, 1e-3);
        }
      }
    }
  }
}

// The default of the w of a quaternion joint is 1: a mask blends towards no rotation, not to none.
TEST(RegionMasks, BringQuaternionJointsToRest) {
  Random random = Random::from_seed(33, 10);
  for (bool scales : {false, true}) {
    LayerRig rig = ml_joint_rig(true, true, scales, random);
    rig.regions = {{0}};
    expect_model(rig, random, 20, 1e-4);
  }
}

TEST(MlJoints, EulerOntoEulerAddsTheAngles) {
  LayerRig rig;
  rig.base.raw_count = kRaw;
  rig.base.joint_count = 1;
  rig.ml_count = 3;
  PlainNetwork network;
  network.inputs = {0};
  network.outputs = {kRaw, kRaw + 1, kRaw + 2};
  network.layers = {{{1, 2, 3}, {10, 20, 30}, 0, {}}};
  rig.networks = {network};
  rig.ml_parameters = {{uint16_t{1}, uint16_t{0}}};  // nothing but rotations
  for (uint16_t k = 0; k < 3; ++k) {
    rig.ml_joints.push_back({static_cast<uint16_t>(kRaw + k), k});
  }
  rig.base.groups = {{{3}, {0}, {3, 4, 5}, {5, 6, 7}}};
  const LayerFile file(rig);
  Character character(make_neural_rig(file, {}));
  character.raw[0] = 0.5f;
  character.evaluate(0);
  EXPECT_FLOAT_EQ(character.joints[3], 6 + 2.5f);
  EXPECT_FLOAT_EQ(character.joints[4], 12 + 3);
  EXPECT_FLOAT_EQ(character.joints[5], 18 + 3.5f);
}

TEST(MlJoints, ConvertFromASystemOfTheirOwn) {
  Random random = Random::from_seed(33, 6);
  for (int round = 0; round < 60; ++round) {
    LayerRig rig = ml_joint_rig(round % 2, true, true, random);
    rig.rotation_unit = 0;
    rig.sequence = static_cast<uint16_t>(random.below(6));
    for (int& sign : rig.signs) sign = random.chance(0.5) ? 1 : -1;
    const auto random_axes = [&](auto set) {
      uint32_t order[3] = {0, 1, 2};  // left-right, up-down, front-back
      for (uint32_t i = 3; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
      for (uint32_t i = 0; i < 3; ++i)
        set(i, static_cast<uint16_t>(2 * order[i] + random.below(2)));
    };
    random_axes([&](uint32_t i, uint16_t axis) { rig.axes[i] = axis; });
    random_axes([&](uint32_t i, uint16_t axis) {
      rig.ml_parameters.push_back({static_cast<uint16_t>(3 + i), axis});
    });
    for (uint16_t key = 6; key < 9; ++key) {
      rig.ml_parameters.push_back({key, static_cast<uint16_t>(random.below(2))});
    }
    rig.ml_parameters.push_back({uint16_t{9}, static_cast<uint16_t>(random.below(6))});
    if (round % 3) rig.ml_parameters.push_back({uint16_t{0x8000}, uint16_t(round % 3 - 1)});
    SCOPED_TRACE(round);
    expect_model(rig, random, 3, 1e-3);
  }
}

// Mien's key says whether they do, where the systems do not.
TEST(MlJoints, ScalesOfAnotherSystemLoseTheirSigns) {
  const auto scales_of = [](const std::vector<std::pair<uint16_t, uint16_t>>& parameters) {
    LayerRig rig;
    rig.base.raw_count = kRaw;
    rig.base.joint_count = 1;
    rig.ml_count = 3;
    rig.axes = {0, 2, 4};
    rig.signs = {1, 1, 1};
    PlainNetwork network;
    network.inputs = {0};
    network.outputs = {kRaw, kRaw + 1, kRaw + 2};
    network.layers = {{{0, 0, 0}, {1, -1, 0.5f}, 0, {}}};
    rig.networks = {network};
    rig.ml_parameters = {{uint16_t{2}, uint16_t{0}}};
    rig.ml_parameters.insert(rig.ml_parameters.end(), parameters.begin(), parameters.end());
    for (uint16_t k = 0; k < 3; ++k) rig.ml_joints.push_back({static_cast<uint16_t>(kRaw + k), k});
    const LayerFile file(rig);
    Character character(make_neural_rig(file, {}));
    character.raw[0] = -0.5f;
    character.evaluate(0);
    return std::vector<float>(&character.joints[6], &character.joints[6] + 3);
  };
  using Scales = std::vector<float>;
  std::vector<std::pair<uint16_t, uint16_t>> stated = {{3, 0}, {4, 2}, {5, 4}, {6, 1},
                                                       {7, 1}, {8, 1}, {9, 0}};
  EXPECT_EQ(scales_of({}), (Scales{-0.5f, 0.5f, -0.25f}));
  EXPECT_EQ(scales_of(stated), (Scales{-0.5f, 0.5f, -0.25f})) << "the rig's own system";
  EXPECT_EQ(scales_of({{0x8000, 1}}), (Scales{0.5f, 0.5f, 0.25f}));
  stated[0].second = 1;  // x to the right
  EXPECT_EQ(scales_of(stated), (Scales{0.5f, 0.5f, 0.25f}));
  stated[0].second = 2, stated[1].second = 0;  // x and y change places
  EXPECT_EQ(scales_of(stated), (Scales{0.5f, 0.5f, 0.25f}));
  stated.push_back({0x8000, 0});
  EXPECT_EQ(scales_of(stated), (Scales{0.5f, -0.5f, -0.25f}));
}

// docs/rig-evaluation.md, 12.10 "Missing data has a default"
TEST(Networks, LeakyReluWithoutParameterLeaksAHundredth) {
  LayerRig rig;
  rig.base.raw_count = kRaw;
  rig.base.joint_count = 1;
  rig.ml_count = 1;
  PlainNetwork network;
  network.inputs = {0};
  network.outputs = {kRaw};
  network.layers = {{{0}, {1}, 2, {}}};
  rig.networks = {network};
  const LayerFile file(rig);
  for (uint32_t isa : present_isas()) {
    Character character(make_neural_rig(file, {isa}));
    character.raw[0] = -2;
    character.evaluate(0);
    EXPECT_FLOAT_EQ(character.ml[0], -0.02f);
  }
}

// Half storage ------------------------------------------------------------------------------------

// Each weight and each part of a quaternion is off by at most 2^-11 of itself.
TEST(HalfStorage, NetworksWithinTheirBoundAndFamiliesEqual) {
  Random random = Random::from_seed(33, 7);
  std::vector<PlainNetwork> networks;
  for (uint16_t function = 0; function < 5; ++function) {
    networks.push_back(random_network(40, {50, 30, 20}, function, random));
  }
  const LayerRig rig = network_rig(networks);
  const LayerFile file(rig);
  double worst = 0;
  std::vector<std::vector<float>> fused, plain;
  for (uint32_t isa : present_isas()) {
    Options halves = {isa};
    halves.storage = MIEN_STORAGE_16_BIT;
    const RigHandle whole = make_neural_rig(file, {isa}), half = make_neural_rig(file, halves);
    MienRigInfo info = info_of(half);
    EXPECT_EQ(info.storage, uint32_t{MIEN_STORAGE_16_BIT});
    EXPECT_LT(info.rig_bytes, info_of(whole).rig_bytes * 3 / 4);
    Character a(whole), b(half);
    Random inputs = Random::from_seed(33, 8);
    std::vector<float> all;
    for (int frame = 0; frame < 20; ++frame) {
      const std::vector<float> raw = random_raw(rig, {4, 8}, inputs);
      std::copy(raw.begin(), raw.end(), a.raw.begin());
      std::copy(raw.begin(), raw.end(), b.raw.begin());
      a.evaluate(0);
      b.evaluate(0);
      for (size_t i = 0; i < a.ml.count; ++i) {
        worst = std::fmax(worst, std::fabs(a.ml[i] - b.ml[i]));
      }
      all.insert(all.end(), b.ml.begin(), b.ml.end());
    }
    (isa == MIEN_ISA_SCALAR || isa == MIEN_ISA_SSE2 ? plain : fused).push_back(all);
  }
  std::printf("  networks of three layers: worst difference %.2g\n", worst);
  EXPECT_GT(worst, 0);
  EXPECT_LT(worst, 4e-3);
  for (const auto* family : {&fused, &plain}) {
    for (const auto& one : *family) EXPECT_EQ(one, family->front());
  }
}

TEST(HalfStorage, QuaternionJointsWithinTheirBound) {
  Random random = Random::from_seed(33, 9);
  LayerRig rig;
  rig.base.raw_count = 8;
  rig.base.joint_count = 20;
  rig.rotations.assign(20, 1);
  PlainGroup group;
  for (uint16_t c = 0; c < 8; ++c) group.inputs.push_back(c);
  for (uint16_t j = 0; j < 20; ++j) {
    for (uint16_t k = 3; k < 6; ++k) {
      group.outputs.push_back(static_cast<uint16_t>(9 * j + k));
      for (int c = 0; c < 8; ++c) {
        group.values.push_back(static_cast<float>(random.between(-30, 30)));
      }
    }
  }
  group.lods = {60};
  rig.base.groups = {group};
  const LayerFile file(rig);
  double worst = 0;
  for (uint32_t isa : present_isas()) {
    Options halves = {isa, MIEN_ML_MASKS_SWITCH, MIEN_ROTATION_OUTPUT_QUATERNION,
                      MIEN_STORAGE_16_BIT};
    Character b(make_neural_rig(file, halves));
    halves.storage = MIEN_STORAGE_32_BIT;
    Character a(make_neural_rig(file, halves));
    for (size_t i = 0; i < a.raw.count; ++i) {
      a.raw[i] = b.raw[i] = static_cast<float>(random.between(0, 1));
    }
    a.evaluate(0);
    b.evaluate(0);
    const auto mine = joints_of(rig, b.joints, true), whole = joints_of(rig, a.joints, true);
    for (size_t j = 0; j < mine.size(); ++j) {
      worst = std::fmax(worst, angle_between(mine[j].rotation, whole[j].rotation));
    }
  }
  std::printf("  quaternion joints of 8 columns: worst difference %.2g radians\n", worst);
  EXPECT_GT(worst, 0);
  EXPECT_LT(worst, 8 * 3 * 4.9e-4);
}

}  // namespace
}  // namespace mien
