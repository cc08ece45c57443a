// SPDX-License-Identifier: MIT
// What mien.h tells about an open file: counts and units, the table of layers, fields and their
// place, and what is chosen when it is opened.
#include <algorithm>
#include <cmath>

#include "tests/support/dna_bytes.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

using dna::layer;
using dna::layers_of;

class CapiDna : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  dna::DnaView view = dna::tiny_rig(arena);
  Bytes file = dna::written(view);

  static DnaHandle open(const Bytes& bytes, uint32_t layers, uint32_t unknown = 0) {
    MienDnaDesc desc = sized<MienDnaDesc>();
    desc.layers = layers;
    desc.unknown_layers = unknown;
    MienError error = sized<MienError>();
    MienDna* dna = nullptr;
    EXPECT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, &error), MIEN_OK)
        << error.message;
    return DnaHandle(dna);
  }
};

MienDnaLayer layer_of(const DnaHandle& dna, uint32_t index) {
  MienDnaLayer layer = sized<MienDnaLayer>();
  EXPECT_EQ(mien_dna_layer(dna.get(), index, &layer), MIEN_OK);
  return layer;
}

MienDnaField field_of(const DnaHandle& dna, const char* path) {
  MienDnaField field = sized<MienDnaField>();
  EXPECT_EQ(mien_dna_field(dna.get(), path, &field, nullptr), MIEN_OK) << path;
  return field;
}

TEST_F(CapiDna, Info) {
  view.desc.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
  view.desc.rotation_unit = MIEN_ROTATION_UNIT_RADIANS;
  view.desc.max_lod = 3;
  view.dsce = {MIEN_ROTATION_SEQUENCE_ZXY, {1, -1, 1}, 1};
  file = dna::written(view);
  const DnaHandle dna = open_dna(file);
  const MienDnaInfo info = info_of(dna);
  EXPECT_EQ(info.generation, 2u);
  EXPECT_EQ(info.version, 8u);
  EXPECT_EQ(info.layers, uint32_t{MIEN_LAYER_ALL});
  EXPECT_EQ(info.file_bytes, file.size());
  EXPECT_EQ(info.is_mapped, 0u);
  EXPECT_EQ(info.layer_count, 11u);
  EXPECT_EQ(info.translation_unit, uint32_t{MIEN_TRANSLATION_UNIT_METERS});
  EXPECT_EQ(info.rotation_unit, uint32_t{MIEN_ROTATION_UNIT_RADIANS});
  EXPECT_EQ(info.axes[0], uint32_t{MIEN_DIRECTION_RIGHT});
  EXPECT_EQ(info.axes[1], uint32_t{MIEN_DIRECTION_UP});
  EXPECT_EQ(info.axes[2], uint32_t{MIEN_DIRECTION_FRONT});
  EXPECT_EQ(info.rotation_sequence, uint32_t{MIEN_ROTATION_SEQUENCE_ZXY});
  EXPECT_EQ(info.rotation_signs[0], 1);
  EXPECT_EQ(info.rotation_signs[1], -1);
  EXPECT_EQ(info.rotation_signs[2], 1);
  EXPECT_EQ(info.face_winding, 1u);
  EXPECT_EQ(info.lod_count, 2u);
  EXPECT_EQ(info.max_lod, 3u);
  EXPECT_EQ(info.gui_control_count, 2u);
  EXPECT_EQ(info.raw_control_count, 3u);
  EXPECT_EQ(info.psd_control_count, 2u);
  EXPECT_EQ(info.ml_control_count, 4u);
  EXPECT_EQ(info.rbf_control_count, 2u);
  EXPECT_EQ(info.joint_count, 3u);
  EXPECT_EQ(info.joint_group_count, 2u);
  EXPECT_EQ(info.blend_shape_channel_count, 2u);
  EXPECT_EQ(info.animated_map_count, 1u);
  EXPECT_EQ(info.mesh_count, 1u);
  EXPECT_EQ(info.neural_network_count, 1u);
  EXPECT_EQ(info.rbf_solver_count, 1u);
  EXPECT_EQ(info.rbf_pose_count, 2u);
  EXPECT_EQ(info.twist_count, 1u);
  EXPECT_EQ(info.swing_count, 1u);
  EXPECT_EQ(info.metadata_count, 1u);
}

// Layers ------------------------------------------------------------------------------------------

TEST_F(CapiDna, LayersInFileOrder) {
  std::vector<dna::Layer> layers = layers_of(file);
  layers.insert(layers.begin() + 2, layer("desc 3.4", {1, 2, 3}));
  std::swap(layers[0], layers[5]);
  file = file_of(8, layers);
  const uint32_t all = MIEN_LAYER_DESCRIPTOR | MIEN_LAYER_DEFINITION;
  for (uint32_t chosen : {uint32_t{MIEN_LAYER_ALL}, uint32_t{MIEN_LAYER_BEHAVIOR}}) {
    const DnaHandle dna = open(file, chosen);
    ASSERT_EQ(info_of(dna).layer_count, layers.size());
    uint64_t end = 11 + 16 * layers.size();
    for (uint32_t i = 0; i < layers.size(); ++i) {
      const MienDnaLayer found = layer_of(dna, i);
      EXPECT_EQ(found.code, layers[i].code);
      EXPECT_EQ(found.version_major << 16 | found.version_minor, layers[i].layer_version);
      EXPECT_EQ(found.byte_offset, end);
      EXPECT_EQ(found.byte_count, layers[i].bytes.size());
      EXPECT_EQ(found.layer == 0, found.version_major == 3) << "only one is of no known kind";
      const uint32_t loaded = chosen == MIEN_LAYER_ALL ? ~0u : all | chosen;
      EXPECT_EQ(found.is_loaded, (found.layer & loaded) != 0) << found.code;
      end += found.byte_count;
    }
    EXPECT_EQ(end, file.size());
  }
  EXPECT_EQ(info_of(open(file, 0, MIEN_UNKNOWN_LAYERS_DROP)).layer_count, 11u);
}

TEST_F(CapiDna, AnArrayOfOneNumberIsNotANumber) {
  const DnaHandle dna = open_dna(file);
  EXPECT_EQ(field_of(dna, "desc.lodCount").is_array, 0u);
  EXPECT_EQ(field_of(dna, "desc.name").is_array, 0u);
  EXPECT_EQ(field_of(dna, "defn.jointNames").is_array, 0u);
  EXPECT_EQ(field_of(dna, "defn.jointHierarchy").is_array, 1u);
  EXPECT_EQ(field_of(dna, "defn.jointHierarchy[0]").is_array, 0u);
  EXPECT_EQ(field_of(dna, "defn.neutralJointTranslations.xs").is_array, 1u);
}

TEST_F(CapiDna, LayersNameTheBitThatLoadsThem) {
  const DnaHandle dna = open_dna(file);
  const uint32_t bits[11] = {MIEN_LAYER_DESCRIPTOR,
                             MIEN_LAYER_DEFINITION,
                             MIEN_LAYER_BEHAVIOR,
                             MIEN_LAYER_GEOMETRY,
                             MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR,
                             MIEN_LAYER_RBF_BEHAVIOR,
                             MIEN_LAYER_RBF_BEHAVIOR,
                             MIEN_LAYER_JOINT_BEHAVIOR_METADATA,
                             MIEN_LAYER_TWIST_SWING_BEHAVIOR,
                             MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR,
                             MIEN_LAYER_DESCRIPTOR};
  for (uint32_t i = 0; i < 11; ++i) EXPECT_EQ(layer_of(dna, i).layer, bits[i]);
}

// "A layer brings along what it needs"
TEST_F(CapiDna, ChosenLayers) {
  const uint32_t d = MIEN_LAYER_DESCRIPTOR, defn = d | MIEN_LAYER_DEFINITION;
  const struct {
    uint32_t chosen, loaded;
  } cases[] = {{0, MIEN_LAYER_ALL},
               {MIEN_LAYER_ALL, MIEN_LAYER_ALL},
               {d, d},
               {MIEN_LAYER_DEFINITION, defn},
               {MIEN_LAYER_BEHAVIOR, defn | MIEN_LAYER_BEHAVIOR},
               {MIEN_LAYER_GEOMETRY, defn | MIEN_LAYER_GEOMETRY},
               {MIEN_LAYER_RBF_BEHAVIOR, defn | MIEN_LAYER_BEHAVIOR | MIEN_LAYER_RBF_BEHAVIOR},
               {MIEN_LAYER_TWIST_SWING_BEHAVIOR, defn | MIEN_LAYER_TWIST_SWING_BEHAVIOR},
               {MIEN_LAYER_UNKNOWN, MIEN_LAYER_ALL}};
  for (const auto& c : cases) EXPECT_EQ(info_of(open(file, c.chosen)).layers, c.loaded);
}

// "what is not chosen is never touched": it may as well be nonsense.
TEST_F(CapiDna, LayersNotChosenAreNotLookedAt) {
  std::vector<dna::Layer> layers = layers_of(file);
  for (dna::Layer& l : layers) {
    if (l.code != "desc" && l.code != "dsce" && l.code != "defn" && l.code != "bhvr") {
      std::fill(l.bytes.begin(), l.bytes.end(), 0xFF);
    }
  }
  file = file_of(8, layers);
  const DnaHandle dna = open(file, MIEN_LAYER_BEHAVIOR);
  create_rig(dna.get());
  MienDna* none = nullptr;
  EXPECT_EQ(mien_dna_open_memory(file.data(), file.size(), nullptr, &none, nullptr),
            MIEN_ERROR_DNA_TRUNCATED);
}

TEST_F(CapiDna, OldestVersionHasFourLayers) {
  view.bhvr.joints.groups.count = 1;  // the other one reads layers that 2.1 lacks
  file = dna::written(view, 1);
  const DnaHandle dna = open_dna(file);
  ASSERT_EQ(info_of(dna).layer_count, 4u);
  const char* const codes[] = {"desc", "defn", "bhvr", "geom"};
  uint64_t end = 0x27;
  for (uint32_t i = 0; i < 4; ++i) {
    const MienDnaLayer found = layer_of(dna, i);
    EXPECT_STREQ(found.code, codes[i]);
    EXPECT_EQ(found.byte_offset, end);
    EXPECT_EQ(found.is_loaded, 1u);
    end += found.byte_count;
  }
  EXPECT_EQ(end, file.size() - 3);
}

TEST_F(CapiDna, LaterVersionsKeepTheirNumber) {
  file[6] = 77;
  const DnaHandle dna = open_dna(file);
  EXPECT_EQ(info_of(dna).version, 77u);
  EXPECT_EQ(write_dna(dna.get()), file);
}

// Fields ------------------------------------------------------------------------------------------

TEST_F(CapiDna, NumbersOfEveryWidthWiden) {
  view.dsce.rotation_sign = {-1, 1, -1};
  view.dsce.face_winding_order = 1;
  view.bhvr.controls.conditionals.from_values = dna::be<float>(arena, {0, -0.0f, -1.5f});
  file = dna::written(view);
  const DnaHandle dna = open_dna(file);
  int64_t n[6] = {};
  auto read = [&](const char* path, uint64_t first, uint64_t count) {
    EXPECT_EQ(mien_dna_read_integers(dna.get(), path, first, count, n, nullptr), MIEN_OK) << path;
  };
  read("dsce.rotationSign.x", 0, 1);
  EXPECT_EQ(n[0], -1);
  read("dsce.faceWindingOrder", 0, 1);
  EXPECT_EQ(n[0], 1);
  read("desc.age", 0, 1);
  EXPECT_EQ(n[0], 30);
  read("geom.meshes[0].faces[1].layoutIndices", 1, 3);
  EXPECT_EQ(n[0], 2);
  EXPECT_EQ(n[1], 5);
  EXPECT_EQ(n[2], 4);
  read("bhvr.joints.jointGroups[1].outputIndices[3]", 0, 1);
  EXPECT_EQ(n[0], 24);
  float f[3];
  const char* path = "bhvr.controls.conditionals.fromValues";
  EXPECT_EQ(mien_dna_read_floats(dna.get(), path, 0, 3, f, nullptr), MIEN_OK);
  EXPECT_TRUE(f[1] == 0.0f && std::signbit(f[1]));
  EXPECT_EQ(f[2], -1.5f);
  EXPECT_EQ(mien_dna_read_floats(dna.get(), "rbfb.solvers[0].radius", 0, 1, f, nullptr), MIEN_OK);
  EXPECT_EQ(f[0], 60.0f);
}

TEST_F(CapiDna, StringsPointIntoTheFile) {
  const DnaHandle dna = open_dna(file);
  MienStringView name = {};
  ASSERT_EQ(mien_dna_read_string(dna.get(), "desc.metadata[0].value", &name, nullptr), MIEN_OK);
  EXPECT_EQ(std::string(name.data, name.count), "made for tests");
  const uint64_t offset = field_of(dna, "desc.metadata[0].value").byte_offset;
  EXPECT_EQ(reinterpret_cast<const uint8_t*>(name.data), file.data() + offset);
}

TEST_F(CapiDna, OffsetsAreWhereTheBytesBegin) {
  const DnaHandle dna = open_dna(file);
  const uint64_t values = field_of(dna, "bhvr.joints.jointGroups[0].values").byte_offset;
  ASSERT_LT(values, file.size());
  EXPECT_EQ(dna::number32(file, values - 4), 6u) << "the count stands before them";
  EXPECT_EQ(dna::number32(file, values), 0x41A00000u) << "20.0";
  for (const char* path : {"", "desc", "desc.metadata", "desc.metadata[0]", "desc.age",
                           "defn.lodJointMapping.indices", "rbfb.solvers[0].radius"}) {
    EXPECT_EQ(field_of(dna, path).byte_offset, MIEN_NO_OFFSET) << path;
  }
}

// Pose controls are numbered behind the ML controls: without those a file could not be written
// right.
TEST_F(CapiDna, RbfWithoutTheControlsBeforeItIsNotWritten) {
  size_t size = 1;
  MienError error = sized<MienError>();
  const DnaHandle part = open(file, MIEN_LAYER_RBF_BEHAVIOR);
  EXPECT_EQ(mien_dna_write_memory(part.get(), nullptr, nullptr, 0, &size, &error),
            MIEN_ERROR_DNA_LAYER);
  EXPECT_EQ(size, 0u);
  EXPECT_NE(std::string(error.message).find("machine-learned"), std::string::npos);

  const DnaHandle both = open(file, MIEN_LAYER_RBF_BEHAVIOR | MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR);
  EXPECT_EQ(mien_dna_write_memory(both.get(), nullptr, nullptr, 0, &size, &error), MIEN_OK);
}

}  // namespace
}  // namespace mien
