// SPDX-License-Identifier: MIT
// What mien.h tells about a rig: names and numbers, the control vector, the neutral pose.
#include <cmath>

#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using Names = std::vector<std::string>;

class CapiRig : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  dna::DnaView view = dna::tiny_rig(arena);

  RigHandle rig() {
    const std::vector<uint8_t> file = write_view(view);
    return create_rig(open_dna(file).get());
  }
};

MienStatus find(const RigHandle& rig, uint32_t kind, const std::string& name, uint32_t* index) {
  return mien_rig_find_n(rig.get(), kind, name.data(), name.size(), index);
}

TEST_F(CapiRig, NamesOfEveryKind) {
  const RigHandle made = rig();
  EXPECT_EQ(names_of(made, MIEN_KIND_GUI_CONTROL), Names({"CTRL_jaw.ty", "CTRL_smile.tx"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_RAW_CONTROL), Names({"jawOpen", "smileL", "smileR"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_PSD_CONTROL), Names({"psd0", "psd1"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_ML_CONTROL),
            Names({"tongue.qx", "tongue.qy", "tongue.qz", "tongue.qw"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_RBF_CONTROL), Names({"rest", "open"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_JOINT), Names({"head", "jaw", "tongue"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_BLEND_SHAPE_CHANNEL), Names({"jawOpen", "smile"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_ANIMATED_MAP), Names({"wrinkle"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_MESH), Names({"face"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_ML_MASK), Names({"face/mouth"}));
  EXPECT_EQ(names_of(made, MIEN_KIND_JOINT_GROUP), Names({"", ""}));
  EXPECT_EQ(names_of(made, MIEN_KIND_RBF_SOLVER), Names({""}));
  EXPECT_EQ(names_of(made, MIEN_KIND_TWIST_SWING), Names({""})) << "a swing with its twist";
}

TEST_F(CapiRig, FindsExactlyTheFirst) {
  view.defn.raw_control_names =
      dna::list<dna::String>(arena, {dna::text("b"),
                                     dna::text("ab"),
                                     dna::text("a"),
                                     dna::text("a"),
                                     dna::text(""),
                                     {reinterpret_cast<const uint8_t*>("a\0b"), 3},
                                     dna::text("\xFF"),
                                     dna::text("")});
  view.bhvr.joints.groups.count = 0;
  view.bhvr.controls.psds = {};
  view.bhvr.controls.psd_count = 0;
  view.mlbh = {};
  view.mlbe = {};
  view.twsw = {};
  view.rbfb = {};
  view.rbfe = {};
  view.bhvr.maps = {};
  const RigHandle made = rig();
  const struct {
    std::string name;
    uint32_t index;
  } there[] = {{"b", 0}, {"ab", 1}, {"a", 2}, {"", 4}, {std::string("a\0b", 3), 5}, {"\xFF", 6}};
  for (const auto& n : there) {
    uint32_t index = 77;
    EXPECT_EQ(find(made, MIEN_KIND_RAW_CONTROL, n.name, &index), MIEN_OK) << n.name;
    EXPECT_EQ(index, n.index) << n.name;
  }
  for (const std::string& name : {std::string("A"), std::string("abc"), std::string("a", 2),
                                  std::string("\xFF\xFF"), std::string("jawOpen")}) {
    uint32_t index = 77;
    EXPECT_EQ(find(made, MIEN_KIND_RAW_CONTROL, name, &index), MIEN_ERROR_NAME) << name;
    EXPECT_EQ(index, 0u);
  }
  // "`name` needs no terminator"
  uint32_t index = 77;
  const char unterminated[] = {'a', 'b'};
  EXPECT_EQ(mien_rig_find_n(made.get(), MIEN_KIND_RAW_CONTROL, unterminated, 2, &index), MIEN_OK);
  EXPECT_EQ(index, 1u);
}

TEST_F(CapiRig, Info) {
  view.desc.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
  view.desc.rotation_unit = MIEN_ROTATION_UNIT_RADIANS;
  view.dsce = {MIEN_ROTATION_SEQUENCE_YZX, {-1, 1, 1}, 0};
  const RigHandle made = rig();
  const MienRigInfo info = info_of(made);
  EXPECT_EQ(info.lod_count, 2u);
  EXPECT_EQ(info.translation_unit, uint32_t{MIEN_TRANSLATION_UNIT_METERS});
  EXPECT_EQ(info.rotation_unit, uint32_t{MIEN_ROTATION_UNIT_RADIANS});
  EXPECT_EQ(info.axes[0], uint32_t{MIEN_DIRECTION_RIGHT});
  EXPECT_EQ(info.axes[2], uint32_t{MIEN_DIRECTION_FRONT});
  EXPECT_EQ(info.rotation_sequence, uint32_t{MIEN_ROTATION_SEQUENCE_YZX});
  EXPECT_EQ(info.rotation_signs[0], -1);
  EXPECT_EQ(info.control_count, 11u);
  EXPECT_EQ(info.joint_value_count, 27u);
}

TEST_F(CapiRig, PoseAndHierarchy) {
  const RigHandle made = rig();
  MienIndex16View parents = {};
  MienFloatView neutral = {};
  ASSERT_EQ(mien_rig_joint_parents(made.get(), &parents), MIEN_OK);
  ASSERT_EQ(mien_rig_neutral_joint_values(made.get(), &neutral), MIEN_OK);
  EXPECT_EQ(std::vector<uint16_t>(parents.data, parents.data + parents.count),
            std::vector<uint16_t>({0, 0, 1}));
  EXPECT_EQ(std::vector<float>(neutral.data, neutral.data + neutral.count),
            std::vector<float>({0, 150, 0, 0,  0, 0, 1, 1, 1,  //
                                0, -4,  2, 10, 0, 0, 1, 1, 1,  //
                                0, 1,   3, 0,  0, 5, 1, 1, 1}));
}

TEST_F(CapiRig, QuaternionOutputs) {
  view.twsw = {};  // else a twist has the last word about the jaw
  view.defn.neutral_rotations.xs = dna::be<float>(arena, {0, 90, 0});
  view.defn.neutral_rotations.ys = dna::be<float>(arena, {0, 0, 0});
  const std::vector<uint8_t> file = write_view(view);
  MienRigDesc desc = sized<MienRigDesc>();
  desc.rotation_output = MIEN_ROTATION_OUTPUT_QUATERNION;
  MienRig* quaternions = nullptr;
  ASSERT_EQ(mien_rig_create(open_dna(file).get(), &desc, &quaternions, nullptr), MIEN_OK);
  const RigHandle made(quaternions);
  EXPECT_EQ(info_of(made).rotation_output, uint32_t{MIEN_ROTATION_OUTPUT_QUATERNION});
  EXPECT_EQ(info_of(made).joint_value_count, 30u);
  MienFloatView neutral = {};
  ASSERT_EQ(mien_rig_neutral_joint_values(made.get(), &neutral), MIEN_OK);
  ASSERT_EQ(neutral.count, 30u);
  const float half = std::sqrt(0.5f), jaw[10] = {0, -4, 2, half, 0, 0, half, 1, 1, 1};
  for (size_t i = 0; i < 10; ++i) EXPECT_NEAR(neutral.data[10 + i], jaw[i], 1e-6f) << i;
  Character character(made);
  for (size_t i = 0; i < 30; ++i) EXPECT_EQ(character.joints[i], i % 10 == 6 ? 1.0f : 0.0f);
  character.raw[0] = 1;
  character.evaluate(1);  // turns the jaw by 20 degrees
  EXPECT_NEAR(character.joints[13], std::sin(std::acos(-1.0) / 18), 1e-6);
  EXPECT_NEAR(character.joints[16], std::cos(std::acos(-1.0) / 18), 1e-6);
  EXPECT_EQ(character.joints[26], 1.0f) << "the tongue does not exist at LOD 1";
}

TEST_F(CapiRig, LodLists) {
  const RigHandle made = rig();
  const struct {
    uint32_t kind, lod;
    std::vector<uint16_t> indices;
  } cases[] = {{MIEN_KIND_JOINT, 0, {0, 1, 2}},
               {MIEN_KIND_JOINT, 1, {0, 1}},
               {MIEN_KIND_BLEND_SHAPE_CHANNEL, 0, {0, 1}},
               {MIEN_KIND_BLEND_SHAPE_CHANNEL, 1, {0}},
               {MIEN_KIND_ANIMATED_MAP, 0, {0}},
               {MIEN_KIND_ANIMATED_MAP, 1, {}},
               {MIEN_KIND_MESH, 0, {0}},
               {MIEN_KIND_MESH, 1, {0}},
               {MIEN_KIND_RBF_SOLVER, 0, {0}},
               {MIEN_KIND_RBF_SOLVER, 1, {}}};
  for (const auto& c : cases) {
    MienIndex16View found = {};
    ASSERT_EQ(mien_rig_lod_indices(made.get(), c.kind, c.lod, &found), MIEN_OK);
    EXPECT_EQ(std::vector<uint16_t>(found.data, found.data + found.count), c.indices)
        << "kind " << c.kind << ", LOD " << c.lod;
  }
}

TEST_F(CapiRig, ControlRow) {
  view.defn.raw_control_names[1] = dna::text("eye.w");  // the solver reads it
  const RigHandle made = rig();
  MienFloatView initial = {};
  ASSERT_EQ(mien_rig_initial_raw_controls(made.get(), &initial), MIEN_OK);
  EXPECT_EQ(std::vector<float>(initial.data, initial.data + initial.count),
            std::vector<float>({0, 1, 0}));
  const Character character(made);
  EXPECT_EQ(character.controls.count, 11u);
  EXPECT_EQ(character.raw.data, character.controls.data);
  EXPECT_EQ(character.psd.data, character.controls.data + 3);
  EXPECT_EQ(character.ml.data, character.controls.data + 5);
  EXPECT_EQ(character.rbf.data, character.controls.data + 9);
  EXPECT_EQ(character.raw[1], 1.0f);
  EXPECT_EQ(character.masks.count, 1u);
  EXPECT_EQ(character.masks[0], 1.0f) << "initially 1";

  MienIndex16View inputs = {};
  ASSERT_EQ(mien_rig_psd_inputs(made.get(), 1, &inputs), MIEN_OK);
  EXPECT_EQ(std::vector<uint16_t>(inputs.data, inputs.data + inputs.count),
            std::vector<uint16_t>({0, 2}));
}

// The controls of a layer that was not loaded keep their place in the row.
TEST_F(CapiRig, OfPartOfTheLayers) {
  const std::vector<uint8_t> file = write_view(view);
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_BEHAVIOR;
  MienDna* part = nullptr;
  ASSERT_EQ(mien_dna_open_memory(file.data(), file.size(), &desc, &part, nullptr), MIEN_OK);
  const DnaHandle opened(part);
  const RigHandle made = create_rig(part);
  EXPECT_EQ(count_of(made, MIEN_KIND_ML_CONTROL), 0u);
  Character character(made);
  character.raw[0] = 1;
  character.evaluate(0);
  EXPECT_EQ(character.joints[12], 20.0f);
}

}  // namespace
}  // namespace mien
