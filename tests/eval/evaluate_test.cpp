// SPDX-License-Identifier: MIT
// Joint groups, channels, maps, LODs, stages and the state of an instance: each rule on a small
// rig, then random rigs against a model in double precision (integrations/program/model/plain_rig.h).
#include "runtime/eval/evaluate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/plain_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

/// Sets the raw controls and evaluates.
void pose(Character& character, const Floats& raw, uint32_t lod = 0) {
  ASSERT_EQ(character.raw.count, raw.size());
  std::copy(raw.begin(), raw.end(), character.raw.begin());
  character.evaluate(lod);
}

// Joint groups ----------------------------------------------------------------------------------

/// A rig with `raw_count` controls, one LOD, and these groups on two joints.
PlainRig joint_rig(uint16_t raw_count, const std::vector<PlainGroup>& groups) {
  PlainRig plain;
  plain.raw_count = raw_count;
  plain.joint_count = 2;
  plain.groups = groups;
  return plain;
}

TEST(JointGroups, RowsTimesControls) {
  Character character(make_rig(
      joint_rig(3, {{{3}, {2, 0}, {4, 17, 0}, {1, 2, 0.5f, -1, 0, 4}}})));  // raw 2 and raw 0
  pose(character, {0.5f, 7, 0.25f});
  Floats expected(18, 0.0f);
  expected[4] = 1.25f;
  expected[17] = -0.375f;
  expected[0] = 2;
  EXPECT_EQ(copy_of(character.joints), expected);
}

TEST(JointGroups, InputsAreNotClamped) {
  Character character(make_rig(joint_rig(2, {{{1}, {0, 1}, {0}, {2, 3}}})));
  pose(character, {-4, 5});
  EXPECT_EQ(character.joints[0], 7);
}

TEST(JointGroups, AControlMayHaveSeveralColumns) {
  Character character(make_rig(joint_rig(1, {{{1}, {0, 0}, {0}, {2, 3}}})));
  pose(character, {2});
  EXPECT_EQ(character.joints[0], 10);
}

TEST(JointGroups, LastRowOfAValueWins) {
  Character between(make_rig(joint_rig(1, {{{1}, {0}, {5}, {1}}, {{1}, {0}, {5}, {2}}})));
  pose(between, {1});
  EXPECT_EQ(between.joints[5], 2) << "groups assign, they do not add";
  Character within(make_rig(joint_rig(1, {{{2}, {0}, {5, 5}, {1, 2}}})));
  pose(within, {1});
  EXPECT_EQ(within.joints[5], 2);
}

TEST(JointGroups, RowsOfZerosWriteNothing) {
  Character character(make_rig(joint_rig(
      1, {{{1}, {0}, {5}, {1}}, {{1}, {0}, {5}, {0}}, {{1}, {}, {5}, {}}, {{0}, {0}, {5}, {3}}})));
  pose(character, {1});
  EXPECT_EQ(character.joints[5], 1) << "not by zeros, no columns, or a row past the LOD";
  pose(character, {0});
  EXPECT_EQ(character.joints[5], 0) << "a row that is zero by its controls does write";
}

TEST(JointGroups, EveryCountOfRowsAndColumns) {
  for (uint16_t count = 1; count <= 40; ++count) {
    SCOPED_TRACE(count);
    PlainRig plain;
    plain.raw_count = count;
    plain.joint_count = 5;
    PlainGroup group;
    for (uint16_t c = 0; c < count; ++c) group.inputs.push_back(c);
    for (uint16_t r = 0; r < count; ++r) {
      group.outputs.push_back(static_cast<uint16_t>(44 - r));
      for (uint16_t c = 0; c < count; ++c) group.values.push_back(static_cast<float>(r * 64 + c));
    }
    group.lods = {count};
    plain.groups = {group};
    for (uint32_t isa : present_isas()) {
      Character character(make_rig(plain, isa));
      for (uint16_t c = 0; c < count; ++c) {
        Floats one(count, 0.0f);
        one[c] = 1;
        pose(character, one);
        for (uint16_t r = 0; r < 45; ++r) {
          EXPECT_EQ(character.joints[44 - r], r < count ? r * 64 + c : 0) << mien_isa_name(isa);
        }
      }
    }
  }
}

// All of it, then what one control after the other changes.
TEST(JointGroups, OfSeveralTiles) {
  const PlainRig plain = tall_rig();
  for (uint32_t isa : present_isas()) {
    SCOPED_TRACE(mien_isa_name(isa));
    const RigHandle rig = make_rig(plain, isa);
    const JointMatrix& joints = reinterpret_cast<const Rig*>(rig.get())->joints;
    ASSERT_LT(joints.tile_end(joints.tile_end(0)), joints.panel_count()) << "three tiles";
    Character character(rig);
    Floats raw(plain.raw_count, 1.0f);
    for (uint32_t frame = 0; frame < 40; ++frame) {
      const uint32_t lod = frame < 30 ? 0 : 1;
      pose(character, raw, lod);
      const std::vector<double> expected = evaluate_plain(plain, raw, lod).joints;
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), character.joints.begin(),
                             character.joints.end()))
          << "frame " << frame;
      raw[frame * 17 % plain.raw_count] = static_cast<float>(frame % 3);
    }
  }
}

// LODs ------------------------------------------------------------------------------------------

/// Three LODs. Corrective p (control 2 + p) is raw 0 times raw 1 for every p, and read by:
/// 0: a joint row of LOD 0; 1: a joint row of LODs 0, 1; 2: a channel of LOD 0; 3: a map row of
/// LODs 0, 1; 4: a column of zeros; 5: a joint row of no LOD.
PlainRig lod_rig() {
  PlainRig plain;
  plain.lod_count = 3;
  plain.raw_count = 2;
  plain.psd_count = 6;
  plain.joint_count = 2;
  plain.channel_count = plain.map_count = 2;
  for (uint16_t p = 2; p < 8; ++p) {
    plain.psds.push_back({p, 0, 1});
    plain.psds.push_back({p, 1, 1});
  }
  plain.groups = {{{3, 2, 1}, {0, 3, 2, 6, 7}, {1, 10, 3, 4}, {1, 0, 0, 0, 0, 1, 1, 0, 0, 0,
                                                               1, 1, 1, 0, 0, 1, 1, 1, 0, 1}}};
  plain.channel_lods = {2, 1, 0};
  plain.channel_inputs = {0, 4};
  plain.channel_outputs = {1, 0};
  plain.map_lods = {2, 2, 0};
  plain.maps = {{0, 1, 0, 1, 1, 0}, {5, 0, 0, 1, 1, 0}};
  return plain;
}

TEST(Lods, CorrectivesThatALodReads) {
  Character character(make_rig(lod_rig()));
  const Floats expected[] = {
      {0.375f, 0.375f, 0.375f, 0.375f, 0, 0}, {0, 0.375f, 0, 0.375f, 0, 0}, {0, 0, 0, 0, 0, 0}};
  for (uint32_t lod : {0, 1, 2, 1, 0}) {
    pose(character, {0.5f, 0.75f}, lod);
    EXPECT_EQ(copy_of(character.psd), expected[lod]) << "LOD " << lod;
  }
}

TEST(Lods, OutputsThatALodDoesNotReachAreZero) {
  Character character(make_rig(lod_rig()));
  Floats joints(18, 0.0f);
  pose(character, {0.5f, 0.75f}, 0);
  joints[1] = 0.5f;
  joints[10] = 0.875f;
  joints[3] = 1.25f;
  EXPECT_EQ(copy_of(character.joints), joints);
  EXPECT_EQ(copy_of(character.channels), (Floats{0.375f, 0.5f}));
  EXPECT_EQ(copy_of(character.maps), (Floats{0.375f, 0.5f}));

  character.evaluate(1);
  joints[3] = 0;
  EXPECT_EQ(copy_of(character.joints), joints);
  EXPECT_EQ(copy_of(character.channels), (Floats{0, 0.5f}));
  EXPECT_EQ(copy_of(character.maps), (Floats{0.375f, 0.5f}));

  character.evaluate(2);
  joints[10] = 0;
  EXPECT_EQ(copy_of(character.joints), joints);
  EXPECT_EQ(copy_of(character.channels), (Floats{0, 0}));
  EXPECT_EQ(copy_of(character.maps), (Floats{0, 0}));
  EXPECT_EQ(copy_of(character.raw), (Floats{0.5f, 0.75f})) << "raw controls are the caller's";
}

TEST(Lods, VariableJointValues) {
  const RigHandle rig = make_rig(lod_rig());
  const std::vector<uint16_t> expected[] = {{1, 3, 10}, {1, 10}, {1}};
  for (uint32_t lod = 0; lod < 3; ++lod) {
    MienIndex16View indices;
    ASSERT_EQ(mien_rig_variable_joint_values(rig.get(), lod, &indices), MIEN_OK);
    EXPECT_EQ(std::vector<uint16_t>(indices.data, indices.data + indices.count), expected[lod]);
  }
  MienIndex16View indices;
  EXPECT_EQ(mien_rig_variable_joint_values(rig.get(), 3, &indices), MIEN_ERROR_LOD);
  EXPECT_EQ(indices.count, 0u);
}

TEST(Lods, Statistics) {
  const RigHandle rig = make_rig(lod_rig());
  const uint32_t expected[3][5] = {{4, 2, 3, 2, 2}, {2, 2, 2, 1, 2}, {0, 2, 1, 0, 0}};
  for (uint32_t lod = 0; lod < 3; ++lod) {
    MienRigStatistics s = sized<MienRigStatistics>();
    ASSERT_EQ(mien_rig_statistics(rig.get(), lod, &s), MIEN_OK);
    const uint32_t mine[] = {s.psd_count, s.joint_count, s.joint_row_count, s.blend_shape_count,
                             s.animated_map_row_count};
    for (int i = 0; i < 5; ++i) EXPECT_EQ(mine[i], expected[lod][i]) << "LOD " << lod << ", " << i;
    // Three rows are one block; each of the columns that move them has one piece of 8 rows.
    EXPECT_EQ(s.joint_entry_count % 8, 0u);
    EXPECT_GE(s.joint_entry_count, 8u);
    EXPECT_LE(s.joint_entry_count, 5u * 8u);
    EXPECT_EQ(s.joint_byte_count, s.joint_entry_count / 8 * (8 * sizeof(float) + 2));
  }
  MienRigStatistics s = sized<MienRigStatistics>();
  EXPECT_EQ(mien_rig_statistics(rig.get(), 3, &s), MIEN_ERROR_LOD);

  // Half as many bytes are fetched for values of 16 bits.
  Arena arena(default_allocator());
  const std::vector<uint8_t> file = write_view(to_view(lod_rig(), arena));
  const DnaHandle dna = open_dna(file);
  MienRigDesc desc = sized<MienRigDesc>();
  desc.storage = MIEN_STORAGE_16_BIT;
  const RigHandle half = create_rig(dna.get(), desc);
  ASSERT_EQ(mien_rig_statistics(half.get(), 0, &s), MIEN_OK);
  EXPECT_GE(s.joint_entry_count, 8u);
  EXPECT_EQ(s.joint_byte_count, s.joint_entry_count / 8 * (8 * sizeof(int16_t) + 2));
}

// An instance tells what its controls make evaluation fetch.
TEST(Lods, InstanceStatistics) {
  const RigHandle rig = make_rig(lod_rig());
  Character character(rig);
  const auto statistics_of = [&] {
    MienInstanceStatistics s = sized<MienInstanceStatistics>();
    EXPECT_EQ(mien_instance_statistics(character.instance.get(), &s), MIEN_OK);
    return s;
  };
  EXPECT_EQ(statistics_of().active_control_count, 0u);
  EXPECT_EQ(statistics_of().joint_byte_count, 0u);
  for (uint32_t lod = 0; lod < 3; ++lod) {
    MienRigStatistics all = sized<MienRigStatistics>();
    ASSERT_EQ(mien_rig_statistics(rig.get(), lod, &all), MIEN_OK);
    // A control for itself fetches its part; all of them fetch all that there is.
    uint64_t sum = 0;
    MienFloatView row = {};
    ASSERT_EQ(mien_instance_controls(character.instance.get(), &row), MIEN_OK);
    const Span<float> controls = {const_cast<float*>(row.data), row.count};
    for (float& control : controls) {
      std::fill(controls.begin(), controls.end(), 0.0f);
      character.evaluate(lod);
      std::fill(controls.begin(), controls.end(), 0.0f);
      control = 0.5f;
      const MienInstanceStatistics s = statistics_of();
      EXPECT_EQ(s.lod, lod);
      EXPECT_EQ(s.active_control_count, 1u);
      EXPECT_LE(s.joint_column_count, 1u);
      EXPECT_EQ(s.joint_column_count == 0, s.joint_byte_count == 0);
      EXPECT_EQ(s.joint_byte_count, s.joint_entry_count / 8 * (8 * sizeof(float) + 2));
      sum += s.joint_byte_count;
    }
    EXPECT_EQ(sum, all.joint_byte_count) << "LOD " << lod;
    std::fill(controls.begin(), controls.end(), -1.0f);
    EXPECT_EQ(statistics_of().active_control_count, controls.count);
    EXPECT_EQ(statistics_of().joint_byte_count, all.joint_byte_count);
    EXPECT_EQ(statistics_of().joint_entry_count, all.joint_entry_count);
  }
}

TEST(Lods, NumbersPastTheEndAreRefusedAndChangeNothing) {
  Character character(make_rig(lod_rig()));
  pose(character, {0.5f, 0.75f}, 1);
  const Floats before = character.results();
  MienInstance* instance = character.instance.get();
  EXPECT_EQ(mien_rig_evaluate(character.rig, instance, 3), MIEN_ERROR_LOD);
  EXPECT_EQ(mien_rig_evaluate_stages(character.rig, instance, 3, 0), MIEN_ERROR_LOD);
  EXPECT_EQ(mien_rig_evaluate_joint_group(character.rig, instance, 3, 0), MIEN_ERROR_LOD);
  EXPECT_EQ(mien_rig_evaluate_joint_group(character.rig, instance, 0, 1), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_rig_evaluate_stages(character.rig, instance, 0, 1u << 31),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(character.results(), before);
}

// Channels and maps -----------------------------------------------------------------------------

TEST(Channels, CopyControlsUnclamped) {
  PlainRig plain;
  plain.raw_count = 3;
  plain.channel_count = 4;
  plain.channel_lods = {4};
  plain.channel_inputs = {2, 0, 1, 2};
  plain.channel_outputs = {3, 1, 0, 0};
  Character character(make_rig(plain));
  pose(character, {-2, 0.5f, 3});
  EXPECT_EQ(copy_of(character.channels), (Floats{3, -2, 0, 3})) << "the last to write 0 wins";
}

TEST(Maps, AreTablesOfControls) {
  PlainRig plain;
  plain.raw_count = plain.map_count = 3;
  plain.map_lods = {5};
  plain.maps = {{0, 0, 0, 0.5f, 1, 0.25f},
                {0, 0, 1, 0.5f, 0, 0.75f},  // swapped ends; shares 0.5 with the row before
                {1, 1, -4, 4, 1, 0},
                {2, 1, 0, 1, 0, -0.5f},
                {2, 1, 0, 1, 0, 1}};  // the row before fires first
  Character character(make_rig(plain));
  pose(character, {0.5f, 0.75f, 0.5f});
  EXPECT_EQ(copy_of(character.maps), (Floats{0.75f, 0.25f, 0}));
  pose(character, {0.75f, 3, 2});
  EXPECT_EQ(copy_of(character.maps), (Floats{0.75f, 1, 0})) << "clamped";
  pose(character, {NAN, -3, 0});
  EXPECT_EQ(copy_of(character.maps), (Floats{0, 0, 0})) << "written anew each time";
}

// Partial evaluation ----------------------------------------------------------------------------

TEST(Stages, EachWritesItsOwnAndKeepsTheOthers) {
  const RigHandle rig = make_rig(lod_rig());
  const Floats first = {0.5f, 0.75f}, second = {0.25f, 0.5f};
  Character before(rig), after(rig);
  pose(before, first);
  pose(after, second);
  constexpr uint32_t kStages[] = {MIEN_STAGE_PSD, MIEN_STAGE_JOINTS, MIEN_STAGE_BLEND_SHAPES,
                                  MIEN_STAGE_ANIMATED_MAPS};
  for (uint32_t stage : kStages) {
    SCOPED_TRACE(stage);
    Character character(rig);
    pose(character, first);
    std::copy(second.begin(), second.end(), character.raw.begin());
    // Correctives first, so that the stages after them read the new ones.
    character.evaluate(0, MIEN_STAGE_PSD);
    character.evaluate(0, stage);
    const auto from = [&](uint32_t of) -> const Character& { return stage == of ? after : before; };
    EXPECT_EQ(copy_of(character.psd), copy_of(after.psd));
    EXPECT_EQ(copy_of(character.joints), copy_of(from(MIEN_STAGE_JOINTS).joints));
    EXPECT_EQ(copy_of(character.channels), copy_of(from(MIEN_STAGE_BLEND_SHAPES).channels));
    EXPECT_EQ(copy_of(character.maps), copy_of(from(MIEN_STAGE_ANIMATED_MAPS).maps));
  }
}

TEST(Stages, WithoutCorrectivesTheLastOnesCount) {
  Character character(make_rig(lod_rig()));
  pose(character, {0.5f, 0.75f});
  character.raw[0] = 0.25f;
  character.evaluate(0, MIEN_STAGE_BLEND_SHAPES);
  EXPECT_EQ(copy_of(character.channels), (Floats{0.375f, 0.25f}));
}

TEST(Stages, AfterAChangeOfLodTheOthersAreZero) {
  Character character(make_rig(lod_rig()));
  pose(character, {0.5f, 0.75f});
  character.evaluate(1, MIEN_STAGE_BLEND_SHAPES);
  EXPECT_EQ(copy_of(character.psd), Floats(6, 0.0f));
  EXPECT_EQ(copy_of(character.joints), Floats(18, 0.0f));
  EXPECT_EQ(copy_of(character.channels), (Floats{0, 0.5f}));
  EXPECT_EQ(copy_of(character.maps), (Floats{0, 0}));
  character.evaluate(0, 0);
  EXPECT_EQ(copy_of(character.channels), (Floats{0, 0}));
}

TEST(Stages, InAnySplitGiveTheWhole) {
  const RigHandle rig = make_rig(lod_rig());
  for (uint32_t split = 0; split <= MIEN_STAGE_ALL; ++split) {
    // What comes first in the order has to be evaluated first.
    if (split != 0 && (split & MIEN_STAGE_PSD) == 0) continue;
    Character whole(rig), parts(rig);
    pose(whole, {0.5f, 0.75f}, 1);
    std::copy(whole.raw.begin(), whole.raw.end(), parts.raw.begin());
    parts.evaluate(1, split);
    parts.evaluate(1, MIEN_STAGE_ALL & ~split);
    EXPECT_EQ(parts.results(), whole.results()) << split;
  }
}

TEST(Stages, OneJointGroup) {
  PlainRig plain = joint_rig(1, {{{1}, {0}, {5}, {1}}, {{2}, {0, 1}, {6, 0}, {2, 0, 0, 1}}});
  plain.psd_count = 1;
  plain.psds = {{1, 0, 1}};
  Character character(make_rig(plain));
  pose(character, {0.5f});
  character.raw[0] = 0.25f;
  ASSERT_EQ(mien_rig_evaluate_joint_group(character.rig, character.instance.get(), 0, 1), MIEN_OK);
  EXPECT_EQ(character.joints[5], 0.5f) << "another group's";
  EXPECT_EQ(character.joints[6], 0.5f);
  EXPECT_EQ(character.joints[0], 0.5f) << "by the corrective as it was";
  EXPECT_EQ(character.psd[0], 0.5f);
}

TEST(Stages, JointGroupsOneByOneGiveTheStage) {
  Random random = Random::from_seed(3, 1);
  for (int round = 0; round < 50; ++round) {
    const RigHandle rig = make_rig(random_rig(random));
    const uint32_t lod = random.below(info_of(rig).lod_count);
    Character whole(rig), single(rig);
    for (size_t i = 0; i < whole.raw.count; ++i) {
      whole.raw[i] = single.raw[i] = static_cast<float>(random.between(-1, 2));
    }
    whole.evaluate(lod);
    single.evaluate(lod, MIEN_STAGE_ALL & ~uint32_t{MIEN_STAGE_JOINTS});
    for (uint32_t g = 0; g < count_of(rig, MIEN_KIND_JOINT_GROUP); ++g) {
      EXPECT_EQ(mien_rig_evaluate_joint_group(rig.get(), single.instance.get(), lod, g), MIEN_OK);
    }
    EXPECT_TRUE(same_bits(span_of(whole.results()), span_of(single.results()))) << round;
  }
}

// State -----------------------------------------------------------------------------------------

TEST(InstanceState, ResetIsAsAfterCreation) {
  Arena arena(default_allocator());
  const std::vector<uint8_t> bytes = write_view(dna::tiny_rig(arena));
  const RigHandle rig = create_rig(open_dna(bytes).get());
  const Character fresh(rig);
  Character used(rig);
  for (Span<float> inputs : {used.gui, used.raw, used.masks}) {
    std::fill(inputs.begin(), inputs.end(), 0.5f);
  }
  used.evaluate(1);
  used.evaluate(0);
  EXPECT_NE(used.results(), fresh.results());
  ASSERT_EQ(mien_instance_reset(used.instance.get()), MIEN_OK);
  EXPECT_EQ(used.results(), fresh.results());
  EXPECT_EQ(copy_of(used.gui), copy_of(fresh.gui));
  EXPECT_EQ(copy_of(used.masks), Floats(used.masks.count, 1.0f));
}

// A quaternion input starts as the rotation by nothing: its w, known by its name, is 1.
TEST(InstanceState, QuaternionInputsStartAtOne) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.defn.raw_control_names = dna::list<dna::String>(
      arena, {dna::text("head.w"), dna::text("jaw.qw"), dna::text("loose.w")});
  view.twsw.twists[0].input_control_indices = dna::be<uint16_t>(arena, {1, 1, 1, 0});
  view.rbfb.solvers[0].raw_control_indices = dna::be<uint16_t>(arena, {1, 1});
  const std::vector<uint8_t> bytes = write_view(view);
  const RigHandle rig = create_rig(open_dna(bytes).get());
  MienFloatView initial;
  ASSERT_EQ(mien_rig_initial_raw_controls(rig.get(), &initial), MIEN_OK);
  EXPECT_EQ(copy_of({initial.data, initial.count}), (Floats{1, 1, 0})) << "loose.w is no input";

  Character character(rig);
  EXPECT_EQ(copy_of(character.raw), (Floats{1, 1, 0}));
  EXPECT_EQ(copy_of(character.ml), (Floats{0, 0, 0, 1})) << "a learned control ending in .qw";
  EXPECT_EQ(copy_of(character.rbf), (Floats{0, 0}));
  character.raw[0] = 0.25f;
  character.evaluate(1);
  EXPECT_EQ(character.raw[0], 0.25f) << "a change of LOD leaves the caller's controls alone";
  EXPECT_EQ(character.ml[3], 1) << "nothing learned at LOD 1";
}

}  // namespace
}  // namespace mien
