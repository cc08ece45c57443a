// SPDX-License-Identifier: MIT
// Validation through mien.h: what a report lists, how it stays short, and that it calls an error
// exactly what opening or making a rig refuses.
#include <algorithm>
#include <cmath>
#include <set>

#include "tests/support/dna_bytes.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

struct Found {
  uint32_t severity;
  MienStatus status;
  uint64_t byte_offset;
  std::string field, message;
};

struct Report {
  std::vector<Found> findings;
  uint32_t errors = 0, warnings = 0;

  explicit Report(const Bytes& file) {
    MienReport* report = nullptr;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_dna_validate_memory(file.data(), file.size(), nullptr, &report, &error), MIEN_OK)
        << error.message;
    EXPECT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
    for (uint32_t i = 0; i < errors + warnings; ++i) {
      MienFinding f = sized<MienFinding>();
      EXPECT_EQ(mien_report_finding(report, i, &f), MIEN_OK);
      findings.push_back({f.severity, f.status, f.byte_offset,
                          std::string(f.field.data, f.field.count),
                          std::string(f.message.data, f.message.count)});
    }
    mien_report_destroy(report);
    check_sums(file);
  }

  /// What holds for every report.
  void check_sums(const Bytes& file) const {
    uint32_t counted = 0;
    for (const Found& f : findings) {
      counted += f.severity == MIEN_SEVERITY_ERROR;
      EXPECT_EQ(f.severity == MIEN_SEVERITY_WARNING, f.status == MIEN_OK) << f.message;
      EXPECT_TRUE(f.byte_offset == MIEN_NO_OFFSET || f.byte_offset <= file.size()) << f.message;
      EXPECT_FALSE(f.message.empty());
    }
    EXPECT_EQ(counted, errors);
    EXPECT_LE(findings.size(), 1000u);
  }
  bool has(MienStatus status, const std::string& field) const {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const Found& f) { return f.status == status && f.field == field; });
  }
  std::vector<Found> of(const std::string& field) const {
    std::vector<Found> some;
    for (const Found& f : findings) {
      if (f.field == field) some.push_back(f);
    }
    return some;
  }
  std::string text() const {
    std::string all = std::to_string(errors) + " errors\n";
    for (const Found& f : findings) {
      all += std::string(mien_status_name(f.status)) + " " + f.field + ": " + f.message + "\n";
    }
    return all;
  }
};

/// What opening a file and making a rig of it says; MIEN_OK if nothing.
struct Refusal {
  MienError error = sized<MienError>();
  bool opened = false;

  explicit Refusal(const Bytes& file) {
    MienDna* dna = nullptr;
    MienRig* rig = nullptr;
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = MIEN_ISA_SCALAR;
    opened = mien_dna_open_memory(file.data(), file.size(), nullptr, &dna, &error) == MIEN_OK;
    if (opened) (void)mien_rig_create(dna, &desc, &rig, &error);
    if (rig) evaluate(rig);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
  }
  bool refused() const { return error.status != MIEN_OK; }

 private:
  // What was not refused has nothing left that could go wrong: the sanitizers watch.
  static void evaluate(const MienRig* rig) {
    MienInstance* instance = nullptr;
    MienRigInfo info = sized<MienRigInfo>();
    MienMutableFloatView raw = {};
    EXPECT_EQ(mien_rig_info(rig, &info), MIEN_OK);
    EXPECT_EQ(mien_instance_create(rig, nullptr, &instance, nullptr), MIEN_OK);
    EXPECT_EQ(mien_instance_raw_controls(instance, &raw), MIEN_OK);
    std::fill(raw.data, raw.data + raw.count, 0.5f);
    for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
      EXPECT_EQ(mien_rig_evaluate(rig, instance, lod), MIEN_OK);
    }
    mien_instance_destroy(instance);
  }
};

/// True if report and refusal agree: that there is an error, and, but for the rig, at which place.
testing::AssertionResult agree(const Bytes& file, int* refused = nullptr) {
  const Report report(file);
  const Refusal refusal(file);
  const MienError& error = refusal.error;
  if (refused) *refused += refusal.refused();
  if (refusal.refused() != (report.errors != 0)) {
    return testing::AssertionFailure() << mien_status_name(error.status) << " (" << error.message
                                       << ") but the report has " << report.text();
  }
  if (!refusal.refused()) return testing::AssertionSuccess();
  for (const Found& f : report.findings) {
    const bool same_place = refusal.opened || f.byte_offset == error.byte_offset;
    if (f.status == error.status && same_place) return testing::AssertionSuccess();
  }
  return testing::AssertionFailure()
         << mien_status_name(error.status) << " at " << error.byte_offset << " (" << error.message
         << ") is not in the report: " << report.text();
}

class ReportTest : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  DnaView view = tiny_rig(arena);
};

// What it lists -----------------------------------------------------------------------------------

TEST_F(ReportTest, CleanFilesHaveNone) {
  EXPECT_EQ(Report(written(view)).text(), "0 errors\n");
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL}) {
    EXPECT_EQ(Report(write_dna(generate_dna(preset, 3).get())).text(), "0 errors\n");
  }
}

TEST_F(ReportTest, NoDna) {
  for (const Bytes& file : {Bytes(), Bytes({'P', 'N', 'G'}), Bytes({'D', 'N', 'A', 0, 3, 0, 1})}) {
    const Report report(file);
    EXPECT_EQ(report.errors, 1u);
    EXPECT_EQ(report.warnings, 0u);
    EXPECT_EQ(report.findings[0].status, Refusal(file).error.status);
  }
}

TEST_F(ReportTest, SeveralFindingsInSeveralLayers) {
  view.defn.joint_hierarchy = be<uint16_t>(arena, {0, 0, 7});
  view.dsce.rotation_sign.y = 0;
  const Report definition(written(view));
  EXPECT_TRUE(definition.has(MIEN_ERROR_DNA_VALUE, "dsce.rotationSign.y")) << definition.text();
  EXPECT_TRUE(definition.has(MIEN_ERROR_DNA_REFERENCE, "defn.jointHierarchy"));

  view = tiny_rig(arena);
  view.bhvr.joints.groups[0].joint_indices = be<uint16_t>(arena, {3});
  view.bhvr.controls.psds.values = be<float>(arena, {1});
  view.geom.meshes[0].layouts.normals = be<uint32_t>(arena, {0, 1, 2, 3, 4, 6});
  view.rbfb.solvers[0].pose_indices = be<uint16_t>(arena, {0, 2});
  view.twsw.twists[0].output_joint_indices = be<uint16_t>(arena, {9});
  view.mlbh.networks[0].layers[1].weights = be<float>(arena, {1, 2, 3});
  view.geom.meshes[0].positions.xs = be<float>(arena, {0, 1, 2, 3, 4, std::stof("nan")});
  view.desc.archetype = 9;
  const Bytes file = written(view);
  const Report report(file);
  for (const char* field :
       {"bhvr.joints.jointGroups[0].jointIndices", "bhvr.controls.psds.values",
        "geom.meshes[0].layouts.normals", "rbfb.solvers[0].poseIndices",
        "twsw.twists[0].twistOutputJointIndices", "mlbh.neuralNetworks[0].layers[1].weights"}) {
    ASSERT_GE(report.of(field).size(), 1u) << report.text();
    const Found found = report.of(field)[0];
    EXPECT_EQ(found.severity, uint32_t{MIEN_SEVERITY_ERROR});
    // The place is the field's, to the byte of the element.
    EXPECT_NE(found.byte_offset, MIEN_NO_OFFSET) << field;
  }
  EXPECT_TRUE(report.has(MIEN_OK, "desc.archetype"));
  ASSERT_TRUE(report.has(MIEN_OK, "geom.meshes[0].positions.xs"));
  const uint64_t nan = report.of("geom.meshes[0].positions.xs")[0].byte_offset;
  EXPECT_EQ(number32(file, nan) & 0x7F800000, 0x7F800000u) << "the offset is that of the NaN";
  EXPECT_EQ(number32(file, report.of("geom.meshes[0].layouts.normals")[0].byte_offset), 6u);
  EXPECT_GE(report.errors, 6u);
}

// A layer that cannot be read does not keep the others from being examined.
// Whatever crosses the interface as an enumeration is one: files with other values do not open.
TEST_F(ReportTest, EnumerationsOfTheDescriptorAreInRange) {
  constexpr uint16_t kBad = 0x80;
  const struct {
    const char* field;
    void (*damage)(DnaView& view);
    size_t bytes;
    uint16_t since;  // version
  } cases[] = {
      {"desc.translationUnit", [](DnaView& v) { v.desc.translation_unit = kBad; }, 2, 1},
      {"desc.rotationUnit", [](DnaView& v) { v.desc.rotation_unit = kBad; }, 2, 1},
      {"desc.coordinateSystem.xAxis", [](DnaView& v) { v.desc.coordinate_system.x_axis = kBad; }, 2,
       1},
      {"desc.coordinateSystem.yAxis", [](DnaView& v) { v.desc.coordinate_system.y_axis = kBad; }, 2,
       1},
      {"desc.coordinateSystem.zAxis", [](DnaView& v) { v.desc.coordinate_system.z_axis = kBad; }, 2,
       1},
      {"dsce.rotationSequence", [](DnaView& v) { v.dsce.rotation_sequence = kBad; }, 4, 7},
      {"dsce.rotationSign.x", [](DnaView& v) { v.dsce.rotation_sign.x = kBad; }, 4, 7},
      {"dsce.rotationSign.y", [](DnaView& v) { v.dsce.rotation_sign.y = kBad; }, 4, 7},
      {"dsce.rotationSign.z", [](DnaView& v) { v.dsce.rotation_sign.z = kBad; }, 4, 7},
      {"dsce.faceWindingOrder", [](DnaView& v) { v.dsce.face_winding_order = kBad; }, 1, 8},
  };
  for (const auto& c : cases) {
    for (const uint16_t version : {1, 2, 7, 8}) {
      if (version < c.since) continue;
      DnaView damaged = view;
      c.damage(damaged);
      const Bytes file = written(damaged, version);
      const Report report(file);
      ASSERT_EQ(report.errors, 1u) << c.field << ", 2." << version << ": " << report.text();
      const std::vector<Found> found = report.of(c.field);
      ASSERT_EQ(found.size(), 1u) << report.text();
      EXPECT_EQ(found[0].status, MIEN_ERROR_DNA_VALUE);
      ASSERT_LE(found[0].byte_offset + c.bytes, file.size()) << c.field;
      uint32_t stored = 0;  // big-endian
      for (size_t i = 0; i < c.bytes; ++i) stored = stored << 8 | file[found[0].byte_offset + i];
      EXPECT_EQ(stored, kBad) << c.field << " is not at byte " << found[0].byte_offset;

      const Refusal refusal(file);
      EXPECT_FALSE(refusal.opened) << c.field;
      EXPECT_EQ(refusal.error.status, MIEN_ERROR_DNA_VALUE);
      EXPECT_EQ(refusal.error.byte_offset, found[0].byte_offset);
      EXPECT_NE(std::string(refusal.error.message).find(c.field), std::string::npos)
          << refusal.error.message;
    }
  }
}

// Archetype and gender describe the character; no other number depends on them.
TEST_F(ReportTest, UnknownArchetypeAndGenderAreKept) {
  view.desc.archetype = 6;
  view.desc.gender = 3;
  const Bytes file = written(view);
  const Report report(file);
  EXPECT_EQ(report.errors, 0u) << report.text();
  for (const auto& [field, value] : {std::pair{"desc.archetype", 6}, {"desc.gender", 3}}) {
    const std::vector<Found> found = report.of(field);
    ASSERT_EQ(found.size(), 1u) << report.text();
    EXPECT_EQ(file[found[0].byte_offset + 1], value) << field;
  }
  EXPECT_FALSE(Refusal(file).refused());
}

TEST_F(ReportTest, DamageInOneLayerLeavesTheOthers) {
  view.bhvr.joints.groups[0].output_indices = be<uint16_t>(arena, {12, 10, 27});
  std::vector<Layer> layers = layers_of(written(view));
  layers[3].bytes.resize(layers[3].bytes.size() - 1);  // geometry
  set32(layers[5].bytes, 0, 0xFFFFFFFF);               // solvers
  const Report report(file_of(8, layers));
  std::set<std::string> fields;
  for (const Found& f : report.findings) fields.insert(f.field.substr(0, 4));
  EXPECT_TRUE(fields.count("geom")) << report.text();
  EXPECT_TRUE(fields.count("rbfb")) << report.text();
  EXPECT_TRUE(fields.count("bhvr")) << report.text();
}

TEST_F(ReportTest, CirclesOfCorrectives) {
  // 3 needs 4 and 4 needs 3: opening allows it, a rig cannot be made.
  view.bhvr.controls.psds.columns = be<uint16_t>(arena, {0, 4, 0, 3});
  const Bytes file = written(view);
  const DnaHandle opened = open_dna(file);
  create_rig(opened.get(), MIEN_ISA_SCALAR, MIEN_ERROR_DNA_VALUE);
  const Report report(file);
  EXPECT_EQ(report.errors, 1u) << report.text();
  EXPECT_TRUE(report.has(MIEN_ERROR_DNA_VALUE, "bhvr.controls.psds")) << report.text();
}

TEST_F(ReportTest, WarningsRefuseNothing) {
  view.bhvr.joints.row_count = 5;
  view.defn.joint_hierarchy = be<uint16_t>(arena, {0, 1, 1});
  std::vector<Layer> layers = layers_of(written(view));
  layers[2].bytes.push_back(0);
  layers.push_back(layer("more 1.0", {1, 2, 3}));
  Bytes file = file_of(8, layers);
  file.push_back(0);
  const Report report(file);
  EXPECT_EQ(report.errors, 0u) << report.text();
  EXPECT_GE(report.warnings, 4u) << report.text();
  EXPECT_FALSE(Refusal(file).refused());
}

// How it stays short ------------------------------------------------------------------------------

TEST_F(ReportTest, AtMost32ForOneField) {
  for (uint32_t count : {31u, 32u, 33u, 500u}) {
    const NewArray<float> numbers = new_array<float>(arena, count);
    for (uint32_t i = 0; i < count; ++i) numbers.set(i, HUGE_VALF);
    DnaView flooded = view;
    Mesh mesh = view.geom.meshes[0];
    mesh.texture_coordinates = {numbers, numbers};
    flooded.geom.meshes = {&mesh, 1};
    const Report report(written(flooded));
    EXPECT_EQ(report.errors, 0u) << report.text();
    for (const char* field :
         {"geom.meshes[0].textureCoordinates.us", "geom.meshes[0].textureCoordinates.vs"}) {
      const std::vector<Found> found = report.of(field);
      ASSERT_EQ(found.size(), std::min(count, 32u));
      const bool summary = found.back().message.find("more findings") != std::string::npos;
      EXPECT_EQ(summary, count > 32);
      if (count > 32) {
        const std::string more = " " + std::to_string(count - 31) + " more";
        EXPECT_NE(found.back().message.find(more), std::string::npos) << found.back().message;
      }
    }
  }
}

// One of those that are held back is an error, so the one that stands for them is.
TEST_F(ReportTest, ErrorsAreNotHeldBack) {
  const NewArray<uint16_t> outputs = new_array<uint16_t>(arena, 100);
  for (uint32_t i = 0; i < 100; ++i) outputs.set(i, 12);
  JointGroup& flooded = view.bhvr.joints.groups[0];
  flooded.output_indices = outputs;
  flooded.values = new_array<float>(arena, 200);
  flooded.lods = be<uint16_t>(arena, {100, 1});
  view.bhvr.joints.groups[1].output_indices = be<uint16_t>(arena, {21, 22, 23, 27});
  const Bytes file = written(view);
  const Report report(file);
  EXPECT_GE(report.warnings, 31u);
  EXPECT_TRUE(report.has(MIEN_ERROR_DNA_REFERENCE, "bhvr.joints.jointGroups[0].outputIndices"))
      << report.text();
  EXPECT_EQ(Refusal(file).error.status, MIEN_ERROR_DNA_REFERENCE);
}

// Blocks whose last bytes are of no use, layers that lie apart: warnings of the reader itself.
TEST_F(ReportTest, ManyMeshesAreOneField) {
  std::vector<Layer> layers = layers_of(written(view));
  Bytes geometry;
  put32(geometry, 1200);
  for (int i = 0; i < 1200; ++i) {
    put32(geometry, 59);
    geometry.insert(geometry.end(), 59, 0);
  }
  layers[3].bytes = geometry;
  const Report report(file_of(8, layers));
  size_t meshes = 0;
  for (const Found& f : report.findings) meshes += f.field.compare(0, 11, "geom.meshes") == 0;
  EXPECT_LE(meshes, 64u) << "32 for geom.meshes[], 32 for geom.meshes";
}

TEST_F(ReportTest, FloodsDoNotHideErrors) {
  view.defn.joint_hierarchy = be<uint16_t>(arena, {0, 0, 7});
  std::vector<Layer> layers = layers_of(written(view));
  for (int i = 0; i < 1100; ++i) {
    Layer more = layer("more 1.0", {1});
    more.layer_version = static_cast<uint32_t>(i);
    layers.push_back(more);
  }
  Bytes file = file_of(8, layers);
  // A gap in front of each.
  const size_t first = 11 + 16 * layers.size();
  Bytes data;
  for (size_t i = 0; i < layers.size(); ++i) {
    data.push_back(0xA5);
    set32(file, 11 + 16 * i + 8, static_cast<uint32_t>(first + data.size()));
    data.insert(data.end(), layers[i].bytes.begin(), layers[i].bytes.end());
  }
  file.resize(first);
  file.insert(file.end(), data.begin(), data.end());
  EXPECT_TRUE(agree(file));
}

// Errors are what is refused ----------------------------------------------------------------------

TEST_F(ReportTest, AgreesOnTruncatedFiles) {
  view.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 2});
  for (uint16_t version : {1, 8}) {
    const Bytes file = written(view, version, false);
    ASSERT_TRUE(agree(file));
    int refused = 0;
    for (size_t size = 0; size < file.size(); ++size) {
      EXPECT_TRUE(agree(Bytes(file.begin(), file.begin() + static_cast<ptrdiff_t>(size)), &refused))
          << size << " bytes of 2." << version;
    }
    EXPECT_EQ(refused, static_cast<int>(file.size()));
  }
}

TEST_F(ReportTest, AgreesOnDamagedFiles) {
  view.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {0, 4, 2});
  int refused = 0, examined = 0;
  for (uint16_t version : {1, 8}) {
    const Bytes file = written(view, version, false);
    for (size_t at = 0; at < file.size(); ++at) {
      for (uint8_t flip : {0x04, 0xFF}) {
        Bytes damaged = file;
        damaged[at] ^= flip;
        ++examined;
        EXPECT_TRUE(agree(damaged, &refused))
            << "byte " << at << " ^ " << int{flip} << " of 2." << version;
      }
    }
  }
  EXPECT_GT(refused, examined / 4);
  EXPECT_LT(refused, examined - examined / 4);
}

// Several at a time, so that errors hide each other.
TEST_F(ReportTest, AgreesOnBadlyDamagedFiles) {
  const Bytes file = written(view);
  uint32_t random = 1;
  for (int round = 0; round < 2000; ++round) {
    Bytes damaged = file;
    for (int i = 0; i < 1 + round % 8; ++i) {
      random = random * 1664525 + 1013904223;
      damaged[(random >> 8) % file.size()] = static_cast<uint8_t>(random % 3 ? random >> 4 : 0xFF);
    }
    EXPECT_TRUE(agree(damaged)) << "round " << round;
  }
}

// A 99 is put everywhere in a file, then a NaN. Those who tell that they found it have to tell where.
TEST_F(ReportTest, SingleNumbersAreToldWhereTheyStand) {
  const Bytes good = written(tiny_rig(arena));
  std::set<std::string> found;
  const auto expect_place = [&](const Bytes& bad, const char* message, size_t at) {
    for (const Found& f : Report(bad).findings) {
      if (f.message.rfind(message, 0) != 0 || f.byte_offset == MIEN_NO_OFFSET) continue;
      // dsce has four bytes for a number, or one.
      const bool is_wide = f.field.rfind("dsce.rotationS", 0) == 0;
      const bool is_byte = f.field == "dsce.faceWindingOrder";
      EXPECT_EQ(f.byte_offset, is_wide ? at - 2 : is_byte ? at + 1 : at) << f.field;
      found.insert(f.field);
    }
  };
  for (size_t at = 0; at + 2 <= good.size(); ++at) {
    Bytes bad = good;
    bad[at] = 0;
    bad[at + 1] = 99;
    expect_place(bad, "is 99", at);
    if (at + 4 > good.size()) continue;
    bad = good;
    set32(bad, at, 0x7FC00000);
    expect_place(bad, "is nan", at);
  }
  const std::set<std::string> expected = {
      "desc.archetype",
      "desc.coordinateSystem.xAxis",
      "desc.coordinateSystem.yAxis",
      "desc.coordinateSystem.zAxis",
      "desc.gender",
      "desc.lodCount",
      "desc.rotationUnit",
      "desc.translationUnit",
      "dsce.rotationSequence",
      "dsce.rotationSign.x",
      "dsce.rotationSign.y",
      "dsce.rotationSign.z",
      "dsce.faceWindingOrder",
      "geom.meshes[0].blendShapeTargets[0].blendShapeChannelIndex",
      "mlbe.mlbJoints.parameterValues[0]",
      "mlbe.mlbJoints.parameterValues[1]",
      "mlbe.mlbJoints.parameterValues[2]",
      "mlbe.mlbTypeData[0].operations[0][0].operationType",
      "mlbe.mlbTypeData[0].operations[1][0].operationType",
      "mlbe.mlbTypeData[0].operations[2][0].operationType",
      "mlbh.neuralNetworks[0].layers[0].functionId",
      "mlbh.neuralNetworks[0].layers[1].functionId",
      "rbfb.poses[0].scale",
      "rbfb.poses[1].scale",
      "rbfb.solvers[0].automaticRadius",
      "rbfb.solvers[0].distanceMethod",
      "rbfb.solvers[0].functionType",
      "rbfb.solvers[0].normalizeMethod",
      "rbfb.solvers[0].radius",
      "rbfb.solvers[0].solverType",
      "rbfb.solvers[0].twistAxis",
      "rbfb.solvers[0].weightThreshold",
      "twsw.swings[0].twistAxis",
      "twsw.twists[0].twistAxis"};
  EXPECT_EQ(found, expected);
}

// Version 2.1: behavior has no bytes of its own, and the descriptor may come behind everything else.
TEST_F(ReportTest, SectionsOfTheOldestVersion) {
  const Bytes good = written(view, 1);
  const size_t usual = Report(good).findings.size();  // of controls whose layers it cannot have
  Bytes bad = good;
  set32(bad, 7 + 4 * 2, number32(good, 7));
  const Report elsewhere(bad);
  ASSERT_EQ(elsewhere.findings.size(), usual + 1) << elsewhere.text();
  EXPECT_EQ(elsewhere.findings[0].byte_offset, 15u);
  EXPECT_EQ(elsewhere.findings[0].status, MIEN_OK);

  const size_t begin = number32(good, 7), end = number32(good, 7 + 4);
  bad = good;
  set32(bad, 7, static_cast<uint32_t>(good.size()));
  bad.insert(bad.end(), good.begin() + static_cast<ptrdiff_t>(begin),
             good.begin() + static_cast<ptrdiff_t>(end));
  bad.insert(bad.end(), {'A', 'N', 'D'});
  const Report behind(bad);
  EXPECT_EQ(behind.errors, 0u) << behind.text();
  ASSERT_EQ(behind.of("geom").size(), 1u) << behind.text();
  EXPECT_EQ(behind.of("geom")[0].message, "3 bytes at the end of this layer are of no known use");
}

// The code of a layer is whatever four bytes the file has.
TEST_F(ReportTest, MessagesArePrintable) {
  std::vector<Layer> layers = layers_of(written(view));
  layers.push_back(layer("\x1B[2\xFF 1.0", {1}));
  Bytes file = file_of(8, layers);
  const size_t entry = 11 + 16 * (layers.size() - 1);
  ASSERT_EQ(memcmp(file.data() + entry, "\x1B[2\xFF", 4), 0);
  set32(file, entry + 8, 3);  // within the header
  const Report report(file);
  ASSERT_EQ(report.errors, 1u);
  EXPECT_NE(report.findings[0].message.find("(?[2?)"), std::string::npos) << report.text();
  EXPECT_NE(std::string(Refusal(file).error.message).find("(?[2?)"), std::string::npos);
}

}  // namespace
}  // namespace mien::dna
