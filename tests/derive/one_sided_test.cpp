// SPDX-License-Identifier: MIT
// Each row of the table in docs/derivatives.md, 1: where a function has no derivative, the product is the difference of
// two evaluations to the side that the row names.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/derive/derivatives_handle.h"
#include "tests/support/deform_rig.h"
#include "tests/support/layer_rig.h"

namespace mien {
namespace {

constexpr double kStep = 1.0 / 4096;

Floats evaluated(const RigHandle& rig, uint32_t from, const Floats& inputs, uint32_t to) {
  Character character(rig);
  Span<float> row = from == MIEN_POINT_GUI ? character.gui : character.raw;
  std::copy(inputs.begin(), inputs.end(), row.begin());
  if (from == MIEN_POINT_GUI) character.map_gui_to_raw();
  character.evaluate(0);
  switch (to) {
    case MIEN_POINT_RAW: return copy_of({character.raw.data, character.raw.count});
    case MIEN_POINT_CONTROLS: return copy_of(character.controls);
    case MIEN_POINT_JOINTS: return copy_of(character.joints);
    case MIEN_POINT_CHANNELS: return copy_of(character.channels);
    default: return copy_of(character.maps);
  }
}

Floats product_at(const RigHandle& rig, uint32_t from, const Floats& inputs, uint32_t to,
                  const Floats& direction) {
  Character character(rig);
  Span<float> row = from == MIEN_POINT_GUI ? character.gui : character.raw;
  std::copy(inputs.begin(), inputs.end(), row.begin());
  character.evaluate(0);
  const DerivativesHandle d = create_derivatives(rig.get());
  linearize(d, character);
  return forward(d, from, to, direction);
}

/// From the inputs to those a step along the direction, forward (side 1) or back (-1).
Floats one_sided(const RigHandle& rig, uint32_t from, const Floats& inputs, uint32_t to,
                 const Floats& direction, int side) {
  Floats moved = inputs;
  const double step = side * kStep;
  for (size_t i = 0; i < moved.size(); ++i) moved[i] += static_cast<float>(step * direction[i]);
  const Floats here = evaluated(rig, from, inputs, to), there = evaluated(rig, from, moved, to);
  Floats slopes;
  for (size_t i = 0; i < here.size(); ++i) {
    slopes.push_back(static_cast<float>((double{there[i]} - here[i]) / step));
  }
  return slopes;
}

void expect_equal(const Floats& made, const Floats& expected, double tolerance) {
  ASSERT_EQ(made.size(), expected.size());
  double largest = 0;
  for (const float v : expected) largest = std::fmax(largest, std::fabs(v));
  EXPECT_GT(largest, 0) << "nothing moves";
  for (size_t i = 0; i < made.size(); ++i) {
    EXPECT_NEAR(made[i], expected[i], tolerance * largest) << "number " << i;
  }
}

/// Along one input.
void expect_one_sided(const RigHandle& rig, uint32_t from, const Floats& inputs, uint32_t to,
                      size_t input, int side, double tolerance = 1e-3) {
  SCOPED_TRACE(testing::Message() << "input " << input << " of " << inputs[input]);
  Floats direction(inputs.size());
  direction[input] = 1;
  expect_equal(product_at(rig, from, inputs, to, direction),
               one_sided(rig, from, inputs, to, direction, side), tolerance);
}

/// Correctives of two raw controls, each read by a channel.
RigHandle corrective_rig() {
  PlainRig plain;
  plain.raw_count = 2;
  plain.psd_count = 2;
  plain.channel_count = 2;
  plain.psds = {{2, 0, 2}, {2, 1, 0.5f}, {3, 0, 4}};
  plain.channel_lods = {2};
  plain.channel_inputs = {2, 3};
  plain.channel_outputs = {0, 1};
  return make_rig(plain);
}

TEST(OneSided, CorrectivesLeadIntoTheIntervalOfTheirControls) {
  const RigHandle rig = corrective_rig();
  expect_one_sided(rig, MIEN_POINT_RAW, {0, 0.25f}, MIEN_POINT_CHANNELS, 0, 1);
  expect_one_sided(rig, MIEN_POINT_RAW, {1, 0.25f}, MIEN_POINT_CHANNELS, 0, -1);
  expect_one_sided(rig, MIEN_POINT_RAW, {0.125f, 0}, MIEN_POINT_CHANNELS, 1, 1);
  expect_one_sided(rig, MIEN_POINT_RAW, {0.125f, 1}, MIEN_POINT_CHANNELS, 1, -1);
  EXPECT_EQ(product_at(rig, MIEN_POINT_RAW, {0.125f, 1.5f}, MIEN_POINT_CHANNELS, {0, 1}),
            (Floats{0, 0}))
      << "beyond";
}

TEST(OneSided, CorrectivesOfOneMoveAsBelowOne) {
  const RigHandle rig = corrective_rig();
  ASSERT_EQ(evaluated(rig, MIEN_POINT_RAW, {0.25f, 0.5f}, MIEN_POINT_CHANNELS)[1], 1.0f);
  expect_one_sided(rig, MIEN_POINT_RAW, {0.25f, 0.5f}, MIEN_POINT_CHANNELS, 0, -1);
  EXPECT_EQ(product_at(rig, MIEN_POINT_RAW, {0.5f, 0.5f}, MIEN_POINT_CHANNELS, {1, 0})[1], 0.0f)
      << "beyond";
}

/// The same table for raw controls by GUI controls, and for maps by raw controls.
void expect_table(const PlainTable& rows, float input, int side) {
  PlainRig plain;
  plain.gui_count = plain.raw_count = plain.map_count = 1;
  plain.gui_to_raw = plain.maps = rows;
  plain.map_lods = {static_cast<uint16_t>(rows.size())};
  const RigHandle rig = make_rig(plain);
  expect_one_sided(rig, MIEN_POINT_GUI, {input}, MIEN_POINT_RAW, 0, side);
  expect_one_sided(rig, MIEN_POINT_RAW, {input}, MIEN_POINT_MAPS, 0, side);
}

TEST(OneSided, SumsOfTablesLeadIntoTheirInterval) {
  const PlainTable rows = {{0, 0, -1, 2, 1, 0}};
  expect_table(rows, 0, 1);
  expect_table(rows, 1, -1);
}

TEST(OneSided, WhereIntervalsMeetTheSteeperRowCounts) {
  expect_table({{0, 0, -1, 0, 0, 0.25f}, {0, 0, 0, 1, 0.5f, 0.25f}}, 0, 1);
  expect_table({{0, 0, -1, 0, -0.5f, 0.25f}, {0, 0, 0, 1, 0.125f, 0.25f}}, 0, -1);
}

/// A network with one layer of one neuron, the difference of two raw controls.
LayerRig neuron(uint16_t function) {
  LayerRig rig;
  rig.base.raw_count = 2;
  rig.base.joint_count = 1;
  rig.ml_count = 1;
  PlainNetwork network;
  network.inputs = {0, 1};
  network.outputs = {2};
  network.layers = {{{0}, {2, -2}, function, {0.25f}}};
  rig.networks = {network};
  return rig;
}

TEST(OneSided, RectifiersAtZeroMoveAsAboveIt) {
  for (const uint16_t function : {1, 2}) {
    const LayerFile file(neuron(function));
    const RigHandle rig = create_rig(file.dna.get());
    expect_one_sided(rig, MIEN_POINT_RAW, {0.5f, 0.5f}, MIEN_POINT_CONTROLS, 0, 1);
    expect_one_sided(rig, MIEN_POINT_RAW, {0.5f, 0.5f}, MIEN_POINT_CONTROLS, 1, -1);
  }
}

/// A solver over all raw controls, with a pose per target, each of which drives a control. In radians.
LayerRig solver_rig(PlainRbfSolver solver, uint16_t inputs, const std::vector<Floats>& targets) {
  LayerRig rig;
  rig.base.raw_count = inputs;
  rig.base.joint_count = 1;
  rig.rotation_unit = 1;
  for (uint16_t i = 0; i < inputs; ++i) solver.inputs.push_back(i);
  for (const Floats& target : targets) {
    solver.targets.insert(solver.targets.end(), target.begin(), target.end());
    solver.poses.push_back(rig.rbf_count);
    rig.poses.push_back({1, {}, {static_cast<uint16_t>(inputs + rig.rbf_count)}, {1}});
    ++rig.rbf_count;
  }
  rig.solvers = {solver};
  return rig;
}

// It is the largest there: the differences to both sides are opposite.
TEST(OneSided, DistanceOfAStoredPoseDoesNotMove) {
  for (const uint16_t function : {0, 1, 2, 3, 4}) {
    SCOPED_TRACE(function);
    PlainRbfSolver solver;
    solver.radius = 2;
    solver.function = function;
    const LayerFile file(solver_rig(solver, 1, {{0.5f}}));
    const RigHandle rig = create_rig(file.dna.get());
    Floats both = one_sided(rig, MIEN_POINT_RAW, {0.5f}, MIEN_POINT_CONTROLS, {1}, 1);
    const Floats back = one_sided(rig, MIEN_POINT_RAW, {0.5f}, MIEN_POINT_CONTROLS, {1}, -1);
    for (size_t i = 0; i < both.size(); ++i) both[i] = (both[i] + back[i]) / 2;
    expect_equal(product_at(rig, MIEN_POINT_RAW, {0.5f}, MIEN_POINT_CONTROLS, {1}), both, 1e-6);
  }
}

TEST(OneSided, WeightsBelowTheThresholdMoveAsWithoutOne) {
  PlainRbfSolver solver;
  solver.radius = 2;
  solver.function = 2;
  solver.threshold = 0.5f;
  const LayerFile file(solver_rig(solver, 1, {{0}, {1}}));
  solver.threshold = 0;
  const LayerFile without(solver_rig(solver, 1, {{0}, {1}}));
  const RigHandle rig = create_rig(file.dna.get()), free = create_rig(without.dna.get());
  const Floats at = {0.9f};
  ASSERT_EQ(evaluated(rig, MIEN_POINT_RAW, at, MIEN_POINT_CONTROLS)[1], 0.0f);
  expect_equal(product_at(rig, MIEN_POINT_RAW, at, MIEN_POINT_CONTROLS, {1}),
               one_sided(free, MIEN_POINT_RAW, at, MIEN_POINT_CONTROLS, {1}, 1), 1e-3);
}

// Numbers whose interpolated weights are exact. The kernel of two poses 1 apart, with a radius of 2, is ((1, 1/2),
// (1/2, 1)); the first weight is 4/3 (k1 - k2/2). At distances of 5/4 and 1/2 that is 0.
TEST(OneSided, InterpolatedWeightsOfZeroLeadIntoTheInterval) {
  PlainRbfSolver solver;
  solver.type = 1;
  solver.function = 2;
  solver.radius = 2;
  solver.threshold = 0;
  const LayerFile file(solver_rig(solver, 5, {{0, 0, 0, 0, 0}, {1, 0, 0, 0, 0}}));
  const RigHandle rig = create_rig(file.dna.get());
  const Floats at = {37 / 32.0f, 15 / 32.0f, 2 / 32.0f, 1 / 32.0f, 1 / 32.0f};
  ASSERT_EQ(evaluated(rig, MIEN_POINT_RAW, at, MIEN_POINT_CONTROLS)[5], 0.0f);
  expect_one_sided(rig, MIEN_POINT_RAW, at, MIEN_POINT_CONTROLS, 0, -1);
  expect_one_sided(rig, MIEN_POINT_RAW, at, MIEN_POINT_CONTROLS, 1, 1);
}

// With a radius of -1 the kernel of two poses 2 apart is ((1, 3), (3, 1)), whose inverse is exact: the first weight is
// (3 k2 - k1) / 8. At distances of 6 and 4 that is 1; the second one is beyond.
TEST(OneSided, InterpolatedWeightsOfOneLeadIntoTheInterval) {
  PlainRbfSolver solver;
  solver.type = 1;
  solver.function = 2;
  solver.radius = -1;
  const LayerFile file(solver_rig(solver, 1, {{0}, {2}}));
  const RigHandle rig = create_rig(file.dna.get());
  EXPECT_EQ(evaluated(rig, MIEN_POINT_RAW, {6}, MIEN_POINT_CONTROLS), (Floats{6, 0.5f, 0.5f}));
  expect_one_sided(rig, MIEN_POINT_RAW, {6}, MIEN_POINT_CONTROLS, 0, -1);
}

TEST(OneSided, HalfATurnMovesByTheFormula) {
  LayerRig rig;
  rig.base.raw_count = 4;
  rig.base.joint_count = 2;
  rig.twists = {{0, {0, 1, 2, 3}, {0}, {0.25f}}};
  rig.swings = {{1, {0, 1, 2, 3}, {1}, {0.25f}}};
  const LayerFile file(rig);
  const RigHandle quaternions =
      create_rig(file.dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK, MIEN_ROTATION_OUTPUT_QUATERNION);
  // About x: w = 0 counts as above.
  expect_one_sided(quaternions, MIEN_POINT_RAW, {1, 0, 0, 0}, MIEN_POINT_JOINTS, 3, 1);
  const RigHandle angles = create_rig(file.dna.get());
  expect_one_sided(angles, MIEN_POINT_RAW, {1, 0, 0, 0}, MIEN_POINT_JOINTS, 3, 1);
}

// A joint that is turned by 90 degrees about y, the second axis, and then about z, the third one. Only the third angle
// tells of the second turn; nothing tells of the first one, whose angle is the largest.
TEST(OneSided, AnglesAtAPoleMoveWhereTheFormulaIsFinite) {
  LayerRig rig;
  rig.base.raw_count = 2;
  rig.base.joint_count = 1;
  rig.rotations = {1};
  rig.base.groups = {{{2}, {0, 1}, {4, 5}, {90, 0, 0, 30}}};
  const LayerFile file(rig);
  const RigHandle handle = create_rig(file.dna.get());
  ASSERT_NEAR(evaluated(handle, MIEN_POINT_RAW, {1, 0}, MIEN_POINT_JOINTS)[4], 90, 0.01);
  expect_one_sided(handle, MIEN_POINT_RAW, {1, 0}, MIEN_POINT_JOINTS, 1, 1, 0.01);
  for (const float v : product_at(handle, MIEN_POINT_RAW, {1, 0}, MIEN_POINT_JOINTS, {1, 0})) {
    EXPECT_TRUE(std::isfinite(v));
  }
}

// Deformation ignores weights below 1e-5.
TEST(OneSided, ChannelsOfZeroMovePositions) {
  Deformed made(random_deform_rig(5, {}));
  const Character character(made.rig);
  const DerivativesHandle d = create_derivatives(made.rig.get(), made.deformer.get());
  linearize(d, character);
  DeformValues values = {copy_of(character.joints), copy_of(character.channels)};
  made.update(values);
  made.deform(0);
  const Floats here = copy_of(made.positions(0));
  const Floats direction(values.channels.size(), 1);
  values.channels.assign(values.channels.size(), 0.5f);
  made.update(values);
  made.deform(0);
  Floats slopes = copy_of(made.positions(0));
  for (size_t i = 0; i < slopes.size(); ++i) slopes[i] = (slopes[i] - here[i]) / 0.5f;
  slopes.resize(size_of(d, MIEN_POINT_POSITIONS));
  expect_equal(forward(d, MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS, direction), slopes, 1e-4);
}

TEST(OneSided, SaturationIsIgnored) {
  PlainRig plain;
  plain.raw_count = plain.joint_count = 1;
  plain.groups = {{{1}, {0}, {0}, {3e38f}}};
  const RigHandle rig = make_rig(plain);
  constexpr float kLargest = std::numeric_limits<float>::max();
  ASSERT_EQ(evaluated(rig, MIEN_POINT_RAW, {2}, MIEN_POINT_JOINTS)[0], kLargest);
  EXPECT_EQ(product_at(rig, MIEN_POINT_RAW, {2}, MIEN_POINT_JOINTS, {1})[0], 3e38f);
  EXPECT_EQ(product_at(rig, MIEN_POINT_RAW, {2}, MIEN_POINT_JOINTS, {2})[0], kLargest);
}

// A network reads a corrective, which is computed after it: it sees that of the frame before.
TEST(OneSided, WhatIsComputedLaterIsConstant) {
  LayerRig rig = neuron(0);
  rig.base.psd_count = 1;
  rig.base.psds = {{2, 0, 1}};
  rig.base.channel_count = 1;
  rig.base.channel_lods = {1};
  rig.base.channel_inputs = {2};
  rig.base.channel_outputs = {0};
  rig.networks[0].inputs = {2, 1};
  rig.networks[0].outputs = {3};
  const LayerFile file(rig);
  const RigHandle handle = create_rig(file.dna.get());
  const auto frames = [&](const Floats& before, const Floats& now) {
    Character character(handle);
    for (const Floats* raw : {&before, &before, &now}) {
      std::copy(raw->begin(), raw->end(), character.raw.begin());
      character.evaluate(0);
    }
    return copy_of(character.controls);
  };
  const Floats here = {0.5f, 0.25f};
  Character character(handle);
  for (int frame = 0; frame < 2; ++frame) {
    std::copy(here.begin(), here.end(), character.raw.begin());
    character.evaluate(0);
  }
  const DerivativesHandle d = create_derivatives(handle.get());
  linearize(d, character);
  for (const Floats& direction : {Floats{1, 0}, Floats{0, 1}}) {
    Floats moved = here, slopes = frames(here, here);
    for (size_t i = 0; i < 2; ++i) moved[i] += static_cast<float>(kStep) * direction[i];
    const Floats there = frames(here, moved);
    for (size_t i = 0; i < slopes.size(); ++i) {
      slopes[i] = (there[i] - slopes[i]) / static_cast<float>(kStep);
    }
    expect_equal(forward(d, MIEN_POINT_RAW, MIEN_POINT_CONTROLS, direction), slopes, 1e-3);
  }
}

}  // namespace
}  // namespace mien
