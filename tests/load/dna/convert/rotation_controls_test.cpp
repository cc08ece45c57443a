// SPDX-License-Identifier: MIT
// Which controls are parts of a quaternion: names, solvers, twists, swings and ML joints tell. What two of
// them tell differently, or what reads a part alone, is refused.
#include "runtime/load/dna/convert/rotation_controls.h"

#include <gtest/gtest.h>

#include "tests/support/layer_rig.h"
#include "tests/support/other_system.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

// Controls: 0 to 11 are raw, 12 to 19 are learned.
class RotationControls : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  LayerRig rig;
  dna::DnaView view;
  std::vector<uint8_t> bytes_;                                    // of the file that is open
  MienCoordinateSystem mirrored = sized<MienCoordinateSystem>();  // back instead of front
  MienCoordinateSystem turned = sized<MienCoordinateSystem>();    // axes in another order

  void SetUp() override {
    rig.base.raw_count = 12;
    rig.base.joint_count = 3;
    rig.ml_count = 8;
    ASSERT_EQ(mien_coordinate_system_find("opengl", &mirrored), MIEN_OK);
    ASSERT_EQ(mien_coordinate_system_find("unreal", &turned), MIEN_OK);
    make();
  }
  void make() { view = to_view(rig, arena); }
  void name(uint16_t control, const char* text) {
    view.defn.raw_control_names[control] = dna::text(text);
  }
  void name_quaternion(uint16_t first, const char* x, const char* y, const char* z, const char* w) {
    for (const char* text : {x, y, z, w}) name(first++, text);
  }
  DnaHandle converted(const MienCoordinateSystem& system) {
    bytes_ = write_view(view);
    return open_in_system(bytes_, system);
  }
  MienCoordinateSystem own_system() {
    bytes_ = write_view(view);
    return system_of(open_dna(bytes_).get());
  }
  void expect_refused(const MienCoordinateSystem& system, const std::string& words) {
    const std::vector<uint8_t> bytes = write_view(view);
    std::string message;
    EXPECT_FALSE(open_in_system(bytes, system, MIEN_ERROR_DNA_VALUE, &message));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
  /// True if x (control `first`) is read as part of a quaternion: a channel may not read its sign.
  bool is_part(uint16_t first) {
    const dna::DnaView before = view;
    view.defn.channel_names = dna::list<dna::String>(arena, {dna::text("c"), dna::text("d")});
    view.bhvr.channels = {dna::be<uint16_t>(arena, {2}),
                          dna::be<uint16_t>(arena, {first, uint16_t(first + 1)}),
                          dna::be<uint16_t>(arena, {0, 1})};
    const std::vector<uint8_t> bytes = write_view(view);
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.system = &mirrored;
    MienDna* dna = nullptr;
    const MienStatus status =
        mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, nullptr);
    mien_dna_close(dna);
    EXPECT_TRUE(status == MIEN_OK || status == MIEN_ERROR_DNA_VALUE);
    view = before;
    return status != MIEN_OK;
  }
  PlainRbfSolver solver(const std::vector<uint16_t>& inputs, uint16_t distance) {
    PlainRbfSolver made;
    made.inputs = inputs;
    made.poses = {0};
    made.targets.assign(inputs.size(), 0.5f);
    made.distance = distance;
    return made;
  }
  void set_solver(const std::vector<uint16_t>& inputs, uint16_t distance) {
    rig.poses = {PlainRbfPose()};
    rig.solvers = {solver(inputs, distance)};
    make();
  }
  /// Learned quaternions of joints 0 and 1: controls 12 to 15 and 16 to 19.
  void turn_joints() {
    rig.ml_parameters = {{0, 0}, {1, 1}, {2, 0}};
    rig.ml_joints.clear();
    for (uint16_t i = 0; i < 4; ++i) rig.ml_joints.push_back({uint16_t(12 + i), uint16_t(3 + i)});
    for (uint16_t i = 0; i < 4; ++i) rig.ml_joints.push_back({uint16_t(16 + i), uint16_t(13 + i)});
  }
};

TEST_F(RotationControls, FourNeighborsOfOneName) {
  EXPECT_FALSE(is_part(4));
  name_quaternion(4, "neck.qx", "neck.qy", "neck.qz", "neck.qw");
  EXPECT_TRUE(is_part(4));
  for (const char* other : {"neck.ry", "necks.qy", "back.qy", "neck.y", "qy"}) {
    name_quaternion(4, "neck.qx", other, "neck.qz", "neck.qw");
    EXPECT_FALSE(is_part(4)) << other;
  }
  name_quaternion(4, "neck.rx", "neck.qy", "neck.qz", "neck.qw");
  EXPECT_FALSE(is_part(4));
  name_quaternion(4, "neck.x", "neck.y", "neck.z", "neck.w");
  EXPECT_FALSE(is_part(4)) << "a solver has to read them";
}

TEST_F(RotationControls, SolversOfPlainDistancesGoByNames) {
  set_solver({4, 5, 6, 7}, 0);
  EXPECT_FALSE(is_part(4));
  name_quaternion(4, "neck.x", "neck.y", "neck.z", "neck.w");
  EXPECT_TRUE(is_part(4));
  name_quaternion(4, "neck.qx", "neck.y", "neck.z", "neck.w");
  EXPECT_FALSE(is_part(4));
  set_solver({4, 5, 6, 7}, 1);
  EXPECT_TRUE(is_part(4)) << "distances of quaternions need no names";
}

TEST_F(RotationControls, GuiControlsMayNotDriveASign) {
  rig.base.gui_count = 1;
  rig.base.gui_to_raw = {{0, 4, 0, 1, 1, 0}, {0, 5, 0, 1, 1, 0}};
  make();
  EXPECT_TRUE(converted(mirrored));
  name_quaternion(4, "neck.qx", "neck.qy", "neck.qz", "neck.qw");
  expect_refused(mirrored, "bhvr.controls.conditionals.outputIndices[");
}

TEST_F(RotationControls, PartsInAnotherOrderContradict) {
  rig.twists = {{0, {2, 3, 4, 5}, {1}, {0.5f}}};
  rig.swings = {{0, {2, 4, 3, 5}, {2}, {0.5f}}};
  make();
  expect_refused(turned, "is part of two rotations");
  rig.swings = {{0, {2, 3, 4, 5}, {2}, {0.5f}}};
  make();
  EXPECT_TRUE(converted(turned));
}

// x is what it was, but the axes of the others have changed places.
TEST_F(RotationControls, PartsThatBecomeOthersContradict) {
  rig.twists = {{0, {2, 3, 4, 5}, {1}, {0.5f}}};
  rig.swings = {{0, {2, 6, 7, 8}, {2}, {0.5f}}};
  make();
  expect_refused(turned, "is part of two rotations");
  const std::string name = std::string(100, 'n') + ".z";
  view.defn.raw_control_names[2] = dna::text(name.c_str());
  expect_refused(turned, "is part of two rotations");
}

TEST_F(RotationControls, SwingsReadRotationsOfInputsOrOfJoints) {
  rig.swings = {{0, {12, 13, 14, 15}, {1}, {0.5f}}};
  make();
  expect_refused(mirrored, "twsw.swings[0]");
  turn_joints();
  make();
  EXPECT_TRUE(converted(mirrored));
  for (const std::vector<uint16_t>& mixed :
       {std::vector<uint16_t>{12, 13, 14, 19}, {12, 14, 13, 15}, {12, 13, 14, 0}}) {
    rig.swings[0].inputs = mixed;
    make();
    expect_refused(mirrored, "twsw.swings[0]");
  }
}

TEST_F(RotationControls, SolversReadWholeRotations) {
  turn_joints();
  set_solver({12, 13, 14, 15, 0, 1, 2, 12}, 1);
  expect_refused(mirrored, "rbfb.solvers[0]");
  // What the rig computes stays as it is, but no axis can be both.
  const std::vector<uint16_t> computed = {12, 13, 14, 15, 20, 20, 20, 20};
  rig.rbf_count = 1;
  for (const uint16_t distance : {1, 2, 3}) {
    set_solver(computed, distance);
    if (distance == 1) {
      EXPECT_TRUE(converted(mirrored));
    } else {
      expect_refused(mirrored, "rbfb.solvers[0]");
      MienCoordinateSystem meters = own_system();
      meters.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
      EXPECT_TRUE(converted(meters));
    }
  }
  set_solver({12, 13, 14, 15, 0}, 1);  // one that is no part of four
  EXPECT_TRUE(converted(mirrored));
}

TEST_F(RotationControls, SolversOfPlainDistancesReadNoParts) {
  rig.ml_parameters = {{0, 0}, {1, 0}, {2, 0}};
  rig.ml_joints = {{12, 0}, {13, 1}, {14, 2}};
  set_solver({0, 1}, 0);
  EXPECT_TRUE(converted(turned));
  set_solver({0, 13}, 0);
  expect_refused(turned, "rbfb.solvers[0]");
}

TEST_F(RotationControls, UnknownParametersOfMlJointsStay) {
  turn_joints();
  rig.ml_parameters.push_back({12, 7});
  make();
  const DnaHandle dna = converted(mirrored);
  ASSERT_TRUE(dna);
  const dna::MlJoints& joints = dna->view.mlbe.joints;
  ASSERT_EQ(joints.parameter_keys.count, 12u)
      << "the system behind them, and that scales have signs";
  EXPECT_EQ(joints.parameter_keys[3], 12u);
  EXPECT_EQ(joints.parameter_values[3], 7u);
  EXPECT_EQ(joints.parameter_keys[11], 0x8000u);
  EXPECT_EQ(joints.parameter_values[11], 0u);
  const std::vector<uint8_t> again = write_dna(dna.get());
  const DnaHandle back = open_in_system(again, turned);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->view.mlbe.joints.parameter_values[3], 7u);
}

// Rows without columns have no numbers to convert.
TEST_F(RotationControls, GroupsWithoutColumnsStayEmpty) {
  rig.base.groups = {{{2}, {}, {0, 1}, {}}, {{1}, {0}, {0}, {1.0f}}};
  make();
  MienCoordinateSystem meters = own_system();
  meters.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
  const DnaHandle dna = converted(meters);
  ASSERT_TRUE(dna);
  EXPECT_EQ(dna->view.bhvr.joints.groups[0].values.count, 0u);
  EXPECT_FLOAT_EQ(dna->view.bhvr.joints.groups[1].values[0], 0.01f);
}

TEST_F(RotationControls, AnglesOfOneAxisHaveOneRow) {
  rig.base.groups = {{{1}, {0}, {0}, {1.0f}},            // no rotation
                     {{2}, {0}, {3, 3}, {1.0f, 2.0f}}};  // an angle twice
  make();
  const std::string joint(70, 'j');
  view.defn.joint_names[0] = dna::text(joint.c_str());
  MienCoordinateSystem reordered = turned;
  reordered.rotation_sequence = MIEN_ROTATION_SEQUENCE_ZXY;
  reordered.rotation_rule = MIEN_ROTATION_RULE_PER_COLUMN;
  expect_refused(reordered, "has two rows for one angle");
}

}  // namespace
}  // namespace mien
