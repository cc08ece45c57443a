// SPDX-License-Identifier: MIT
// Conditional tables and correctives: each rule of docs/rig-evaluation.md, 2 "Conditional tables"
// and 3 "Correctives" on the smallest table that shows it, then random tables against the same
// rules in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/plain_rig.h"

namespace mien {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void set(Span<float> to, const Floats& values) {
  ASSERT_EQ(to.count, values.size());
  for (size_t i = 0; i < values.size(); ++i) to[i] = values[i];
}
// GUI -> raw ------------------------------------------------------------------------------------

/// Raw controls that a table gives for GUI controls; raw controls held 0.5 before.
Floats forward(const PlainTable& table, const Floats& gui, uint16_t raw_count) {
  PlainRig plain;
  plain.gui_count = static_cast<uint16_t>(gui.size());
  plain.raw_count = raw_count;
  plain.gui_to_raw = table;
  Character character(make_rig(plain));
  set(character.gui, gui);
  set(character.raw, Floats(raw_count, 0.5f));
  character.map_gui_to_raw();
  EXPECT_TRUE(same_bits(character.gui, span_of(gui))) << "the mapping wrote its input";
  return copy_of(character.raw);
}

TEST(GuiToRaw, RowAppliesSlopeAndCutWithinItsInterval) {
  const PlainTable table = {{0, 0, 0.25f, 0.75f, 0.5f, 0.125f}};
  EXPECT_EQ(forward(table, {0.5f}, 1), Floats{0.375f});
  EXPECT_EQ(forward(table, {0.25f}, 1), Floats{0.25f}) << "the lower end is included";
  EXPECT_EQ(forward(table, {0.75f}, 1), Floats{0.5f}) << "the upper end is included";
  EXPECT_EQ(forward(table, {std::nextafter(0.25f, 0.0f)}, 1), Floats{0});
  EXPECT_EQ(forward(table, {std::nextafter(0.75f, 1.0f)}, 1), Floats{0});
}

TEST(GuiToRaw, SwappedEndsAreExchanged) {
  const PlainTable table = {{0, 0, 0.75f, 0.25f, 0.5f, 0.125f}};
  EXPECT_EQ(forward(table, {0.5f}, 1), Floats{0.375f});
  EXPECT_EQ(forward(table, {0.25f}, 1), Floats{0.25f});
  EXPECT_EQ(forward(table, {0.75f}, 1), Floats{0.5f});
  EXPECT_EQ(forward(table, {0.125f}, 1), Floats{0});
}

TEST(GuiToRaw, OnlyTheFirstOfARunFires) {
  const PlainTable table = {{0, 0, 0, 0.25f, 0, 0.125f},
                            {0, 0, 0, 1, 0, 0.25f},
                            {0, 0, 0, 1, 0, 0.5f},
                            {0, 1, 0, 1, 0, 1}};
  EXPECT_EQ(forward(table, {0.125f}, 2), (Floats{0.125f, 1}));
  EXPECT_EQ(forward(table, {0.5f}, 2), (Floats{0.25f, 1}));
}

TEST(GuiToRaw, EarlierRowWinsAtASharedBoundary) {
  const PlainTable table = {{0, 0, 0, 0.5f, 0, 0.25f}, {0, 0, 0.5f, 1, 0, 0.75f}};
  EXPECT_EQ(forward(table, {0.5f}, 1), Floats{0.25f});
  EXPECT_EQ(forward(table, {std::nextafter(0.5f, 1.0f)}, 1), Floats{0.75f});
}

TEST(GuiToRaw, SeparateRunsAdd) {
  // The same pair twice, parted by another output, then by another input.
  const PlainTable by_output = {
      {0, 0, 0, 1, 0, 0.25f}, {0, 1, 0, 1, 0, 0.5f}, {0, 0, 0, 1, 0, 0.125f}};
  EXPECT_EQ(forward(by_output, {0.5f}, 2), (Floats{0.375f, 0.5f}));
  const PlainTable by_input = {
      {0, 0, 0, 1, 0, 0.25f}, {1, 0, 0.5f, 1, 0, 0.5f}, {0, 0, 0, 1, 0, 0.125f}};
  EXPECT_EQ(forward(by_input, {0.5f, 0.5f}, 1), Floats{0.875f});
  EXPECT_EQ(forward(by_input, {0.5f, 0}, 1), Floats{0.375f})
      << "a row of another pair parts a run even if it does not fire";
}

TEST(GuiToRaw, SumIsClampedNotItsParts) {
  const PlainTable table = {{0, 0, 0, 1, 0, 3},
                            {1, 0, 0, 1, 0, -2.5f},
                            {0, 1, 0, 1, 0, -3},
                            {1, 1, 0, 1, 0, 2},
                            {0, 2, 0, 1, 0, 3}};
  EXPECT_EQ(forward(table, {0, 0}, 3), (Floats{0.5f, 0, 1}));
}

TEST(GuiToRaw, InputsAreNotClamped) {
  EXPECT_EQ(forward({{0, 0, -4, 4, 0.125f, 0}}, {3}, 1), Floats{0.375f});
  EXPECT_EQ(forward({{0, 0, -4, 4, -0.125f, 0}}, {-3}, 1), Floats{0.375f});
}

TEST(GuiToRaw, NaNNeverFires) {
  const PlainTable table = {{0, 0, -kInfinity, kInfinity, 1, 0.25f}, {1, 1, 0, 1, 1, 0}};
  EXPECT_EQ(forward(table, {kNaN, 0.5f}, 2), (Floats{0, 0.5f}));
  EXPECT_EQ(forward(table, {0.5f, kNaN}, 2), (Floats{0.75f, 0}));
}

TEST(GuiToRaw, UndrivenRawControlsKeepWhatTheyHold) {
  EXPECT_EQ(forward({{0, 1, 0, 1, 1, 0}}, {0.25f}, 3), (Floats{0.5f, 0.25f, 0.5f}));
  EXPECT_EQ(forward({{0, 1, 2, 3, 1, 0}}, {0.25f}, 3), (Floats{0.5f, 0, 0.5f}))
      << "a driven control whose rows do not fire is 0";
  EXPECT_EQ(forward({}, {0.25f}, 2), (Floats{0.5f, 0.5f}));
}

// Raw -> GUI ------------------------------------------------------------------------------------

/// GUI controls that explain raw controls; they held 7 before.
Floats backward(const PlainTable& table, const Floats& raw, uint16_t gui_count) {
  PlainRig plain;
  plain.gui_count = gui_count;
  plain.raw_count = static_cast<uint16_t>(raw.size());
  plain.gui_to_raw = table;
  Character character(make_rig(plain));
  set(character.raw, raw);
  set(character.gui, Floats(gui_count, 7.0f));
  character.map_raw_to_gui();
  EXPECT_TRUE(same_bits(character.raw, span_of(raw))) << "the mapping wrote its input";
  return copy_of(character.gui);
}

TEST(RawToGui, InvertsARow) {
  EXPECT_EQ(backward({{0, 0, 0, 1, 0.5f, 0.25f}}, {0.5f}, 1), Floats{0.5f});
  EXPECT_EQ(backward({{0, 0, 1, 0, 0.5f, 0.25f}}, {0.5f}, 1), Floats{0.5f}) << "swapped ends";
  EXPECT_EQ(backward({{0, 0, 0, 0.25f, 0.5f, 0.25f}}, {0.5f}, 1), Floats{0}) << "not within";
}

TEST(RawToGui, RoundTrip) {
  // One slider, left and right of its middle, and one in three pieces.
  const PlainTable table = {{0, 0, 0, 1, 1, 0},
                            {0, 1, -1, 0, -1, 0},
                            {1, 2, 0, 0.25f, 2, 0},
                            {1, 2, 0.25f, 0.5f, 1, 0.25f},
                            {1, 2, 0.5f, 1, 0.5f, 0.5f}};
  for (int i = -8; i <= 8; ++i) {
    const Floats gui = {static_cast<float>(i) / 8, static_cast<float>(i + 8) / 16};
    EXPECT_EQ(backward(table, forward(table, gui, 3), 2), gui);
  }
}

TEST(RawToGui, GroupWithTheMostConsistentRowsWins) {
  // [0, 1]: one row fits. [0, 2]: two do, so its first value counts.
  const PlainTable table = {
      {0, 0, 0, 1, 1, 0}, {0, 1, 0, 2, 1, -1}, {0, 2, 0, 2, 1, 0}, {0, 3, 0, 1, 1, 5}};
  EXPECT_EQ(backward(table, {0.5f, 0.25f, 1.5f, 0.5f}, 1), Floats{1.25f});
  EXPECT_EQ(backward(table, {0.5f, 0.25f, 0, 0.5f}, 1), Floats{0.5f})
      << "a raw control at 0 speaks for no group, and the first group wins a tie";
}

TEST(RawToGui, FirstGroupCountsIfNoRowIsConsistent) {
  // All raw controls are 0: no row is consistent, yet the first group may tell the value.
  const PlainTable table = {{0, 0, 0, 1, 1, -0.5f}, {0, 1, 0, 2, 1, -1.5f}};
  EXPECT_EQ(backward(table, {0, 0}, 1), Floats{0.5f});
  const PlainTable outside = {{0, 0, 0, 1, 1, -3}, {0, 1, 0, 2, 1, -1.5f}};
  EXPECT_EQ(backward(outside, {0, 0}, 1), Floats{0}) << "the second group is not asked";
}

TEST(RawToGui, FirstRowOfTheGroupThatFitsCounts) {
  const PlainTable table = {{0, 0, 0, 1, 1, 5}, {0, 1, 0, 1, 1, -0.25f}, {0, 2, 0, 1, 1, 0}};
  EXPECT_EQ(backward(table, {0.5f, 0, 0.75f}, 1), Floats{0.25f})
      << "the first row that fits, though its raw control is 0";
}

TEST(RawToGui, FlatRowsExplainNothing) {
  EXPECT_EQ(backward({{0, 0, 0, 1, 0, 0.5f}}, {0.5f}, 1), Floats{0}) << "0 / 0";
  EXPECT_EQ(backward({{0, 0, 0, 1, 0, 0.25f}}, {0.5f}, 1), Floats{0}) << "infinite";
  EXPECT_EQ(backward({{0, 0, -kInfinity, kInfinity, 0, 0.25f}}, {0.5f}, 1), Floats{0});
  EXPECT_EQ(backward({{0, 0, 0, 1, 0, 0.5f}, {0, 1, 0, 1, 2, 0}}, {0.5f, 0.5f}, 1), Floats{0.25f});
}

TEST(RawToGui, ControlsWithoutRowsAreZero) {
  EXPECT_EQ(backward({{1, 0, 0, 1, 1, 0}}, {0.5f}, 3), (Floats{0, 0.5f, 0}));
  EXPECT_EQ(backward({}, {0.5f}, 2), (Floats{0, 0}));
}

// A file may hold anything. Such rows never fire and explain nothing; the others do as before.
TEST(ConditionalTables, RowsWithoutAnInterval) {
  PlainTable table;
  for (uint16_t i = 0; i < 200; ++i) {
    const bool broken = i % 3 != 0;
    table.push_back({0, i, i % 3 == 1 ? kNaN : 0.0f, i % 3 == 2 ? kNaN : 1 + i / 64.0f, 1,
                     broken ? 0.5f : 0.25f});
  }
  const Floats raw = forward(table, {0.5f}, 200);
  for (uint16_t i = 0; i < 200; ++i) EXPECT_EQ(raw[i], i % 3 ? 0 : 0.75f) << i;
  EXPECT_EQ(backward(table, Floats(200, 0.5f), 1), Floats{0.25f});
}

TEST(ConditionalTables, RandomTablesFollowTheRules) {
  Random random = Random::from_seed(1, 1);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const PlainRig plain = random_rig(random);
    Character character(make_rig(plain));
    std::vector<double> gui;
    for (float& value : character.gui) {
      value = static_cast<float>(random.below(25)) / 8 - 1.5f;
      gui.push_back(value);
    }
    for (float& value : character.raw) value = 0.5f;
    character.map_gui_to_raw();
    std::vector<uint8_t> driven(plain.raw_count);
    for (const PlainRow& row : plain.gui_to_raw) driven[row.output] = 1;
    const std::vector<double> expected =
        forward_plain(plain.gui_to_raw, plain.gui_to_raw.size(), gui, plain.raw_count);
    for (uint16_t i = 0; i < plain.raw_count; ++i) {
      EXPECT_EQ(character.raw[i], driven[i] ? expected[i] : 0.5) << "raw control " << i;
    }

    for (float& value : character.gui) value = 7;
    const Floats back = backward_plain(plain.gui_to_raw, copy_of(character.raw), plain.gui_count);
    character.map_raw_to_gui();
    EXPECT_EQ(copy_of(character.gui), back);
  }
}

// Correctives -----------------------------------------------------------------------------------

/// Correctives for raw controls, each read by a channel of its own number (if `read`).
Floats correctives(const std::vector<PlainPsd>& psds, uint16_t count, const Floats& raw,
                   const std::vector<uint16_t>& read) {
  PlainRig plain;
  plain.raw_count = static_cast<uint16_t>(raw.size());
  plain.psd_count = plain.channel_count = count;
  plain.psds = psds;
  for (uint16_t psd : read) {
    plain.channel_inputs.push_back(static_cast<uint16_t>(plain.raw_count + psd));
    plain.channel_outputs.push_back(psd);
  }
  plain.channel_lods = {static_cast<uint16_t>(read.size())};
  Character character(make_rig(plain));
  set(character.raw, raw);
  character.evaluate(0);
  EXPECT_TRUE(same_bits(character.raw, span_of(raw))) << "raw controls are the caller's";
  for (uint16_t psd : read) EXPECT_EQ(character.channels[psd], character.psd[psd]);
  return copy_of(character.psd);
}

TEST(Correctives, ProductOfWeightsAndInputs) {
  EXPECT_EQ(correctives({{2, 0, 0.5f}, {2, 1, 0.75f}}, 1, {0.5f, 0.25f}, {0}),
            Floats{0.5f * 0.75f * 0.5f * 0.25f});
}

TEST(Correctives, TriplesComeInAnyOrder) {
  EXPECT_EQ(correctives({{3, 1, 1}, {2, 0, 1}, {3, 0, 1}, {2, 0, 0.5f}}, 2, {0.5f, 0.25f}, {0, 1}),
            (Floats{0.125f, 0.125f}));
}

TEST(Correctives, DuplicateInputsCountSquared) {
  EXPECT_EQ(correctives({{1, 0, 1}, {1, 0, 1}}, 1, {0.5f}, {0}), Floats{0.25f});
}

TEST(Correctives, InputsAreClamped) {
  EXPECT_EQ(correctives({{2, 0, 1}, {2, 1, 1}}, 1, {5, 0.25f}, {0}), Floats{0.25f});
  EXPECT_EQ(correctives({{2, 0, 1}, {2, 1, 1}}, 1, {-5, 0.25f}, {0}), Floats{0});
  EXPECT_EQ(correctives({{1, 0, 1}}, 1, {kInfinity}, {0}), Floats{1});
}

TEST(Correctives, ValueIsLimitedAboveOnly) {
  EXPECT_EQ(correctives({{1, 0, 4}}, 1, {0.5f}, {0}), Floats{1});
  EXPECT_EQ(correctives({{1, 0, 4}}, 1, {0.125f}, {0}), Floats{0.5f});
  EXPECT_EQ(correctives({{1, 0, -4}}, 1, {0.5f}, {0}), Floats{-2});
  EXPECT_EQ(correctives({{1, 0, -4}, {1, 0, -1}}, 1, {0.5f}, {0}), Floats{1});
}

TEST(Correctives, WithoutTriplesIsZero) {
  EXPECT_EQ(correctives({{2, 0, 1}}, 2, {0.5f}, {0, 1}), (Floats{0, 0.5f}));
}

TEST(Correctives, WhatNothingReadsIsNotComputed) {
  EXPECT_EQ(correctives({{1, 0, 1}, {2, 0, 1}, {3, 0, 1}}, 3, {0.5f}, {1}), (Floats{0, 0.5f, 0}));
}

TEST(Correctives, ChainsAreRightInTheSameFrame) {
  // 4 <- 2 <- 3 <- raw 0, 1: neither in the order of numbers nor of triples.
  const std::vector<PlainPsd> chain = {{4, 2, 1}, {2, 3, 0.5f}, {2, 0, 1},
                                       {3, 0, 1}, {3, 1, 1},    {4, 1, 1}};
  const float third = 0.5f * 0.75f, second = 0.5f * third * 0.5f, first = second * 0.75f;
  EXPECT_EQ(correctives(chain, 3, {0.5f, 0.75f}, {0, 1, 2}), (Floats{second, third, first}));
  EXPECT_EQ(correctives(chain, 3, {0.5f, 0.75f}, {2}), (Floats{second, third, first}))
      << "what a corrective reads is computed even if nothing else reads it";
  EXPECT_EQ(correctives(chain, 3, {0.5f, 0.75f}, {1}), (Floats{0, third, 0}));
}

// Inputs are clamped wherever they come from: -2 enters the next product as 0.
TEST(Correctives, NegativeCorrectiveIsClampedAsAnInput) {
  EXPECT_EQ(correctives({{1, 0, -4}, {2, 1, 1}}, 2, {0.5f}, {0, 1}), (Floats{-2, 0}));
}

TEST(Correctives, CirclesAreRefused) {
  const auto refuse = [](const std::vector<PlainPsd>& psds) {
    PlainRig plain;
    plain.raw_count = 1;
    plain.psd_count = 3;
    plain.psds = psds;
    EXPECT_FALSE(make_rig(plain, MIEN_ISA_ENVIRONMENT, MIEN_ERROR_DNA_VALUE));
  };
  refuse({{1, 1, 1}});
  refuse({{1, 2, 1}, {2, 1, 1}});
  refuse({{1, 0, 1}, {1, 2, 1}, {2, 3, 1}, {3, 1, 1}});
  refuse({{1, 0, 1}, {2, 3, 1}, {3, 2, 1}});
}

TEST(Correctives, InputsCanBeAskedFor) {
  PlainRig plain;
  plain.raw_count = 3;
  plain.psd_count = 3;
  plain.psds = {{5, 3, 1}, {3, 2, 1}, {5, 1, 1}, {3, 0, 1}, {3, 2, 1}};
  const RigHandle rig = make_rig(plain);
  const std::vector<uint16_t> expected[] = {{2, 0, 2}, {}, {3, 1}};
  for (uint32_t psd = 0; psd < 3; ++psd) {
    MienIndex16View inputs;
    ASSERT_EQ(mien_rig_psd_inputs(rig.get(), psd, &inputs), MIEN_OK);
    EXPECT_EQ(std::vector<uint16_t>(inputs.data, inputs.data + inputs.count), expected[psd]);
  }
}

}  // namespace
}  // namespace mien
