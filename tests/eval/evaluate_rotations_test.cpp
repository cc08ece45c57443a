// SPDX-License-Identifier: MIT
// Rotations of joints against a plain model (integrations/program/model/rotation_model.h): every convention,
// form of outputs and representation, twists and swings, on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/same_joints.h"

namespace mien {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Raw controls: four plain ones, then two quaternions.
constexpr uint16_t kRotationRaw = 12;

const uint32_t kRotationOutputs[] = {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION};

/// Every joint of the rig, at every LOD, in both forms, on every instruction set.
void expect_rotation_model(const LayerRig& rig, Random& random, int frames, double radians = 2e-6) {
  const LayerFile file(rig);
  for (uint32_t isa : present_isas()) {
    for (uint32_t output : kRotationOutputs) {
      const RigHandle handle = create_rig(file.dna.get(), isa, MIEN_OK, output);
      ASSERT_TRUE(handle);
      Character character(handle);
      for (int frame = 0; frame < frames; ++frame) {
        const std::vector<float> raw = random_raw(rig, {4, 8}, random);
        std::copy(raw.begin(), raw.end(), character.raw.begin());
        for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
          character.evaluate(lod);
          const std::vector<double> controls(character.controls.begin(), character.controls.end());
          const bool quaternions = output == MIEN_ROTATION_OUTPUT_QUATERNION;
          ASSERT_TRUE(same_joints(joints_of(rig, character.joints, quaternions),
                                  model_joints(rig, controls, lod, quaternions), radians, 5e-5))
              << mien_isa_name(isa) << ", LOD " << lod << ", output form " << output;
        }
      }
    }
  }
}

/// A group of all nine values of some joints, with random numbers and angles of up to half a turn
/// for all controls together.
PlainGroup random_group(const LayerRig& rig, std::vector<uint16_t> joints, Random& random) {
  PlainGroup group;
  for (uint16_t c = 0; c < 4; ++c) group.inputs.push_back(c);
  for (uint16_t joint : joints) {
    for (uint16_t k = 0; k < 9; ++k) group.outputs.push_back(static_cast<uint16_t>(9 * joint + k));
  }
  // In any order.
  for (size_t i = group.outputs.size(); i > 1; --i) {
    std::swap(group.outputs[i - 1], group.outputs[random.below(static_cast<uint32_t>(i))]);
  }
  const double scale = rig.rotation_unit == 0 ? 30 : 30 * kPi / 180;
  for (uint16_t output : group.outputs) {
    const uint32_t k = output % 9;
    for (size_t c = 0; c < group.inputs.size(); ++c) {
      const double range = k >= 3 && k < 6 ? scale : 1;
      group.values.push_back(static_cast<float>(random.between(-range, range)));
    }
  }
  group.lods.assign(rig.base.lod_count, static_cast<uint16_t>(group.outputs.size()));
  return group;
}

LayerRig joint_rig(uint16_t joint_count) {
  LayerRig rig;
  rig.base.raw_count = kRotationRaw;
  rig.base.joint_count = joint_count;
  rig.rotations.assign(joint_count, 0);
  return rig;
}

TEST(Rotations, EverySequenceSignUnitFormAndRepresentation) {
  Random random = Random::from_seed(32, 1);
  for (uint16_t sequence = 0; sequence < 6; ++sequence) {
    for (int signs = 0; signs < 8; ++signs) {
      for (uint16_t unit = 0; unit < 2; ++unit) {
        LayerRig rig = joint_rig(4);
        rig.sequence = sequence;
        rig.rotation_unit = unit;
        for (int i = 0; i < 3; ++i) rig.signs[i] = signs >> i & 1 ? -1 : 1;
        rig.rotations = {0, 1, 0, 1};
        rig.base.groups = {random_group(rig, {0, 1, 2, 3}, random)};
        SCOPED_TRACE("sequence " + std::to_string(sequence) + ", signs " + std::to_string(signs) +
                     ", unit " + std::to_string(unit));
        expect_rotation_model(rig, random, 3);
      }
    }
  }
}

// Rows of zeros, and rows that no LOD reaches: they neither turn a joint nor undo what another group
// turned.
TEST(Rotations, RowsThatCountForNothingTurnNoQuaternionJoint) {
  Random random = Random::from_seed(32, 10);
  LayerRig rig = joint_rig(3);
  rig.base.lod_count = 2;
  rig.rotations = {1, 1, 1};
  const PlainGroup turned = {{6, 6},
                             {0, 1},
                             {3, 4, 5, 12, 13, 14},
                             {5, 9, -7, 3, 2, 8,  //
                              4, 1, 6, -2, 9, 5}};
  const PlainGroup zeros = {{3, 3}, {2}, {3, 4, 5}, {0, 0, 0}};
  const PlainGroup zero_first = {
      {6, 4}, {0, 3}, {21, 12, 13, 14, 22, 23}, {0, 0, 3, 4, 5, 6, 7, 8, 20, 1, 30, 2}};
  const PlainGroup no_lod = {{2, 1}, {1}, {21, 22, 23}, {15, 12, 90}};
  for (const std::vector<PlainGroup>& groups :
       {std::vector<PlainGroup>{turned, zeros}, {turned, zero_first}, {no_lod}}) {
    rig.base.groups = groups;
    expect_rotation_model(rig, random, 5);
  }
}

// More joints than one block of the kernel has, and columns that LODs leave out: their order counts.
TEST(Rotations, QuaternionJointsOfEveryLod) {
  Random random = Random::from_seed(32, 2);
  for (int round = 0; round < 20; ++round) {
    LayerRig rig = joint_rig(20);
    rig.base.lod_count = 4;
    rig.rotations.assign(20, 1);
    std::vector<uint16_t> joints;
    for (uint16_t j = 0; j < 20; ++j) joints.push_back(j);
    PlainGroup group = random_group(rig, joints, random);
    for (uint16_t c = 0; c < 8; ++c) group.inputs.push_back(static_cast<uint16_t>(4 + c));
    // Joint by joint, as files have them, and columns that begin late.
    std::sort(group.outputs.begin(), group.outputs.end());
    group.values.clear();
    for (size_t r = 0; r < group.outputs.size(); ++r) {
      for (size_t c = 0; c < group.inputs.size(); ++c) {
        const bool late = c % 3 == 1 && r < 60;
        group.values.push_back(late ? 0.0f : static_cast<float>(random.between(-15, 15)));
      }
    }
    const auto rows = static_cast<uint16_t>(group.outputs.size());
    group.lods = {rows, static_cast<uint16_t>(9 * (10 + random.below(5))),
                  static_cast<uint16_t>(9 * (1 + random.below(6))), 0};
    rig.base.groups = {group};
    expect_rotation_model(rig, random, 3, 4e-6);
  }
}

// Joints of different groups share a block: each has its own columns, and its own LODs. Of two groups
// that turn one joint the later one counts, where a LOD reaches it.
TEST(Rotations, QuaternionJointsOfManyGroups) {
  Random random = Random::from_seed(32, 11);
  for (int round = 0; round < 10; ++round) {
    LayerRig rig = joint_rig(40);
    rig.base.lod_count = 4;
    rig.rotations.assign(40, 1);
    for (uint32_t g = 0; g < 17; ++g) {
      std::vector<uint16_t> joints;
      for (uint32_t j = 0; j <= random.below(4); ++j) {
        const auto joint = static_cast<uint16_t>(g < 14 ? g + 14 * (j % 2) : 39 - random.below(30));
        if (std::find(joints.begin(), joints.end(), joint) == joints.end()) joints.push_back(joint);
      }
      PlainGroup group = random_group(rig, joints, random);
      const uint32_t columns = 1 + random.below(4),
                     rows = static_cast<uint32_t>(group.outputs.size());
      group.inputs.clear();
      for (uint32_t c = 0; c < columns; ++c) {
        group.inputs.push_back(static_cast<uint16_t>((g + 3 * c) % kRotationRaw));
      }
      group.values.resize(size_t{rows} * columns);
      for (float& value : group.values) {
        if (random.chance(0.4)) value = 0;
      }
      uint32_t reached = rows;
      for (uint16_t& lod : group.lods) {
        lod = static_cast<uint16_t>(reached);
        if (random.chance(0.6)) reached = random.below(reached + 1);
      }
      rig.base.groups.push_back(group);
    }
    expect_rotation_model(rig, random, 3, 4e-6);
  }
}

TEST(Twists, EveryAxisBlendAndLod) {
  Random random = Random::from_seed(32, 3);
  for (uint16_t axis = 0; axis < 3; ++axis) {
    LayerRig rig = joint_rig(12);
    rig.base.lod_count = 2;
    rig.lod_joints = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, {0, 2, 4, 6, 8, 10}};
    rig.raw_w = {7, 11};
    rig.base.groups = {random_group(rig, {0, 4, 11}, random)};
    rig.twists = {{axis, {4, 5, 6, 7}, {0, 1, 2}, {0, 0.25f, 1}},
                  {static_cast<uint16_t>((axis + 1) % 3), {8, 9, 10, 11}, {3, 4}, {0.5f, 1.5f}},
                  {static_cast<uint16_t>((axis + 2) % 3), {8, 9, 10, 11}, {5}, {-0.25f}}};
    rig.swings = {{axis, {8, 9, 10, 11}, {6, 7, 8, 9}, {0, 0.3f, 0.75f, 1}}};
    expect_rotation_model(rig, random, 30, 4e-6);
  }
}

// docs/rig-evaluation.md, 12.4 "Angles at the poles": at the poles the angles describe the
// rotation, whatever leads there.
TEST(EulerAngles, DescribeTheRotationNearAndAtThePoles) {
  Random random = Random::from_seed(32, 4);
  constexpr double kOffsets[] = {0, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1};
  for (uint16_t sequence = 0; sequence < 6; ++sequence) {
    for (int signs = 0; signs < 8; ++signs) {
      LayerRig rig = joint_rig(1);
      rig.sequence = sequence;
      for (int i = 0; i < 3; ++i) rig.signs[i] = signs >> i & 1 ? -1 : 1;
      // A swing without blend turns as the inverse of its input.
      rig.swings = {{0, {4, 5, 6, 7}, {0}, {0}}};
      const LayerFile file(rig);
      const RigHandle euler = create_rig(file.dna.get());
      const RigHandle quaternion = create_rig(file.dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK,
                                              MIEN_ROTATION_OUTPUT_QUATERNION);
      Character a(euler), b(quaternion);
      const ModelConvention convention = convention_of(rig);
      const int second[6] = {1, 2, 0, 2, 0, 1};
      for (double pole : {-90.0, 90.0}) {
        for (double offset : kOffsets) {
          for (int i = 0; i < 20; ++i) {
            std::array<double, 3> angles = {random.between(-180, 180), random.between(-180, 180),
                                            random.between(-180, 180)};
            angles[second[sequence]] = pole + (i % 2 ? offset : -offset);
            if (i == 0) angles = {0, 0, 0}, angles[second[sequence]] = pole;
            const ModelQuaternion q = model_quaternion(convention, angles);
            const float input[4] = {static_cast<float>(-q.x), static_cast<float>(-q.y),
                                    static_cast<float>(-q.z), static_cast<float>(q.w)};
            std::copy(input, input + 4, a.raw.begin() + 4);
            std::copy(input, input + 4, b.raw.begin() + 4);
            a.evaluate(0);
            b.evaluate(0);
            for (float value : a.joints) ASSERT_TRUE(std::isfinite(value));
            const auto mine = joints_of(rig, a.joints, false);
            const auto expected = joints_of(rig, b.joints, true);
            ASSERT_LT(angle_between(mine[0].rotation, expected[0].rotation), 3e-6)
                << "sequence " << sequence << ", signs " << signs << ", " << offset
                << " from the pole";
          }
        }
      }
    }
  }
}

// docs/rig-evaluation.md, 12.5 "Quaternion joints keep unit length": an estimate of the root would
// let the length drift by 1e-4 per column.
TEST(QuaternionJoints, StayUnitOnEveryInstructionSet) {
  Random random = Random::from_seed(32, 5);
  LayerRig rig = joint_rig(16);
  rig.base.raw_count = 64;
  rig.rotations.assign(16, 1);
  PlainGroup group;
  for (uint16_t c = 0; c < 64; ++c) group.inputs.push_back(c);
  for (uint16_t j = 0; j < 16; ++j) {
    for (uint16_t k = 3; k < 6; ++k) group.outputs.push_back(static_cast<uint16_t>(9 * j + k));
  }
  for (size_t i = 0; i < 64 * group.outputs.size(); ++i) {
    group.values.push_back(static_cast<float>(random.between(-20, 20)));
  }
  group.lods = {static_cast<uint16_t>(group.outputs.size())};
  rig.base.groups = {group};
  const LayerFile file(rig);
  for (uint32_t isa : present_isas()) {
    Character character(create_rig(file.dna.get(), isa, MIEN_OK, MIEN_ROTATION_OUTPUT_QUATERNION));
    for (float& value : character.raw) value = static_cast<float>(random.between(0.2, 0.9));
    character.evaluate(0);
    for (size_t j = 0; j < 16; ++j) {
      const float* q = character.joints.data + j * 10 + 3;
      const double length = std::sqrt(double{q[0]} * q[0] + double{q[1]} * q[1] +
                                      double{q[2]} * q[2] + double{q[3]} * q[3]);
      EXPECT_NEAR(length, 1, 5e-6) << mien_isa_name(isa) << ", joint " << j;
    }
  }
}

// docs/rig-evaluation.md, 12.6 "Rotation rows in any order"
TEST(Rotations, RowsInAnyOrderAndSpreadOverGroups) {
  Random random = Random::from_seed(32, 6);
  for (int round = 0; round < 30; ++round) {
    LayerRig rig = joint_rig(3);
    rig.rotation_unit = static_cast<uint16_t>(round % 2);
    const PlainGroup whole = random_group(rig, {0, 1, 2}, random);  // in any order
    for (uint32_t g = 0; g < 3; ++g) {
      PlainGroup part;
      part.inputs = whole.inputs;
      for (size_t r = 0; r < whole.outputs.size(); ++r) {
        if ((whole.outputs[r] * 7u + static_cast<uint32_t>(round)) % 3 != g) continue;
        part.outputs.push_back(whole.outputs[r]);
        for (size_t c = 0; c < 4; ++c) part.values.push_back(whole.values[r * 4 + c]);
      }
      part.lods = {static_cast<uint16_t>(part.outputs.size())};
      rig.base.groups.push_back(part);
    }
    expect_rotation_model(rig, random, 3);
  }
}

TEST(Rotations, EvaluatingAGroupTwiceChangesNothing) {
  Random random = Random::from_seed(32, 7);
  LayerRig rig = joint_rig(3);
  rig.rotations = {0, 1, 0};
  PlainGroup group = random_group(rig, {0, 1, 2}, random);
  group.lods = {static_cast<uint16_t>(group.outputs.size() - 5)};  // not all angles have rows
  rig.base.groups = {group};
  const LayerFile file(rig);
  for (uint32_t output : kRotationOutputs) {
    Character character(create_rig(file.dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK, output));
    for (float& value : character.raw) value = 0.7f;
    character.evaluate(0);
    const std::vector<float> before(character.joints.begin(), character.joints.end());
    for (int i = 0; i < 3; ++i) {
      ASSERT_EQ(mien_rig_evaluate_joint_group(character.rig, character.instance.get(), 0, 0),
                MIEN_OK);
    }
    EXPECT_TRUE(same_bits(character.joints, span_of(before)));
  }
}

// docs/rig-evaluation.md, 12.8 "Several twists of one swing"
TEST(Twists, OfOneSwingKeepTheirOwnWeights) {
  Random random = Random::from_seed(32, 8);
  LayerRig rig = joint_rig(6);
  rig.swings = {{1, {4, 5, 6, 7}, {0, 1}, {0.25f, 0.5f}}};
  rig.twists = {{1, {4, 5, 6, 7}, {2, 3}, {0.1f, 0.9f}},
                {1, {4, 5, 6, 7}, {4}, {0.6f}},
                {1, {4, 5, 6, 7}, {5}, {0.3f}}};
  expect_rotation_model(rig, random, 50);
}

// docs/rig-evaluation.md, 12.13 "Twists and swings obey LODs"
TEST(Twists, AndSwingsObeyLodsAndRunAlone) {
  LayerRig rig = joint_rig(4);
  rig.base.lod_count = 2;
  rig.lod_joints = {{0, 1, 2, 3}, {0, 2}};
  rig.twists = {{0, {4, 5, 6, 7}, {0, 1}, {0, 0}}, {0, {8, 9, 10, 11}, {2, 3}, {0, 0}}};
  const LayerFile file(rig);
  const RigHandle handle = create_rig(file.dna.get());
  EXPECT_EQ(count_of(handle, MIEN_KIND_TWIST_SWING), 2u);
  Character character(handle);
  for (uint16_t first : {4, 8}) {
    character.raw[first] = 0.6f;
    character.raw[first + 3] = 0.8f;
  }
  const double angle = 2 * std::asin(0.6) * 180 / kPi;
  const auto about_x = [&](size_t joint) { return character.joints[joint * 9 + 3]; };
  character.evaluate(1);
  EXPECT_NEAR(about_x(0), angle, 1e-4);
  EXPECT_EQ(about_x(1), 0) << "not at this LOD";
  EXPECT_EQ(about_x(3), 0) << "not at this LOD";

  ASSERT_EQ(mien_instance_reset(character.instance.get()), MIEN_OK);
  for (uint16_t part : {8, 11}) character.raw[part] = part == 8 ? 0.6f : 0.8f;
  ASSERT_EQ(mien_rig_evaluate_twist_swing(handle.get(), character.instance.get(), 0, 1), MIEN_OK);
  EXPECT_EQ(about_x(0), 0) << "of another set-up";
  EXPECT_NEAR(about_x(2), angle, 1e-4);
  EXPECT_NEAR(about_x(3), angle, 1e-4);
}

}  // namespace
}  // namespace mien
