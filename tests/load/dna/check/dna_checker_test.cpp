// SPDX-License-Identifier: MIT
// How findings are told: where, in which words, how many at most, and when to stop.
#include "runtime/load/dna/check/dna_checker.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/kept_findings.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {
namespace {

TEST(DnaCheckerTest, TellsOffsetAndNumbers) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  std::vector<uint8_t> file(100);
  const uint16_t outputs[] = {21, 22, 27, 24};
  for (size_t i = 0; i < 4; ++i) store_big_endian(&file[60 + 2 * i], outputs[i]);
  view.file = file.data();
  view.file_size = file.size();
  view.bhvr.joints.groups[1].output_indices = {&file[60], 4};

  KeptFindings report;
  check(view, report, false);
  ASSERT_EQ(report.findings.size(), 1u) << report.text();
  EXPECT_EQ(report.findings[0].byte_offset, 64u);
  EXPECT_EQ(report.findings[0].field, "bhvr.joints.jointGroups[1].outputIndices");
  EXPECT_EQ(report.findings[0].message, "element 2 is 27, but there are 27 joint values");
}

TEST(DnaCheckerTest, OffsetsOfSingleNumbers) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  std::vector<uint8_t> file(100);
  view.file = file.data();
  view.file_size = file.size();
  view.index[10].data = &file[70];
  view.index[10].offset = 70;  // dsce: rotationSequence, then the signs
  view.dsce.rotation_sign.z = 7;
  view.desc.complexity.data = &file[30];  // preceded by lodCount, maxLOD, its own count
  view.desc.lod_count = 34;
  KeptFindings report;
  check(view, report, false);
  ASSERT_EQ(report.findings.size(), 2u) << report.text();
  EXPECT_EQ(report.findings[0].field, "desc.lodCount");
  EXPECT_EQ(report.findings[0].byte_offset, 22u);
  EXPECT_EQ(report.findings[1].field, "dsce.rotationSign.z");
  EXPECT_EQ(report.findings[1].byte_offset, 82u);
}

TEST(DnaCheckerTest, OffsetsBehindArraysAndNames) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  std::vector<uint8_t> file(100);
  view.file = file.data();
  view.file_size = file.size();
  Twist& twist = view.twsw.twists[0];
  for (size_t i = 0; i < twist.input_control_indices.count; ++i) {
    store_big_endian(&file[40 + 2 * i], uint16_t{twist.input_control_indices[i]});
  }
  twist.input_control_indices.data = &file[40];
  twist.twist_axis = 3;
  view.desc.name = {&file[10], 5};
  view.desc.archetype = 9;
  KeptFindings report;
  check(view, report, true);
  uint64_t axis = 0, archetype = 0;
  for (const auto& finding : report.findings) {
    if (finding.field == "twsw.twists[0].twistAxis") axis = finding.byte_offset;
    if (finding.field == "desc.archetype") archetype = finding.byte_offset;
  }
  EXPECT_EQ(axis, 40 + 2 * twist.input_control_indices.count) << report.text();
  EXPECT_EQ(archetype, 15u) << report.text();
}

// Of chosen LODs, too. Behind the only list lies one that would be told of.
TEST(DnaCheckerTest, ListsThatAreNotThereAreNotLookedAt) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  LodMap& map = view.defn.lod_channels;
  const Span<Array<uint16_t>> lists = arena.array<Array<uint16_t>>(8);
  lists[0] = map.indices[0];
  lists[7] = be<uint16_t>(arena, {500});
  map.indices = {lists.data, 1};
  map.lods = be<uint16_t>(arena, {0, 7});
  for (const uint64_t lods : {0, 1, 2, 3}) {
    KeptFindings report;
    check_definition(view, report.sink(false), lods);
    ASSERT_EQ(report.findings.size(), 1u) << report.text();
    EXPECT_EQ(report.findings[0].field, "defn.lodBlendShapeMapping.lods");
  }
}

// More fields than findings are counted for.
TEST(DnaCheckerTest, EveryFieldIsToldOfOnce) {
  DnaView view;
  KeptFindings report;
  const FindingSink sink = report.sink(false);
  Checker checker(view, sink, 0);
  std::vector<std::string> names;
  for (int i = 0; i < 120; ++i) names.push_back("field" + std::to_string(i));
  for (const std::string& name : names) {
    checker.error(Field{nullptr, name.c_str()}, Status::kDnaValue, kNoOffset, "is wrong");
  }
  EXPECT_TRUE(checker.finish());
  ASSERT_EQ(report.findings.size(), names.size());
  for (size_t i = 0; i < names.size(); ++i) EXPECT_EQ(report.findings[i].field, names[i]);
}

TEST(DnaCheckerTest, LongPathsAreCut) {
  DnaView view;
  KeptFindings report;
  const FindingSink sink = report.sink(false);
  Checker checker(view, sink, 0);
  const std::string part(150, 'p');
  const Field outer{nullptr, part.c_str(), 7}, inner{&outer, part.c_str(), 8};
  checker.error(Field{&inner, "values", 9}, Status::kDnaValue, kNoOffset, "is wrong");
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].field, (part + "[7]." + part).substr(0, 199));
}

// One array or a thousand records: what is the same field but for list numbers fills no report.
TEST(DnaCheckerTest, FloodsAreCut) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  const NewArray<uint16_t> bad = new_array<uint16_t>(arena, 100);
  for (size_t i = 0; i < 100; ++i) bad.set(i, 500);
  view.defn.lod_joints.indices[0] = bad;
  KeptFindings report;
  EXPECT_TRUE(check_definition(view, report.sink(true)));
  size_t of_joints = 0;
  for (const auto& f : report.findings) of_joints += f.field == "defn.lodJointMapping.indices[0]";
  EXPECT_EQ(of_joints, 32u);
  // 100 that are missing, 99 that are there twice, and LOD 1 has two joints that LOD 0 lacks.
  EXPECT_EQ(report.findings.size(), 32u);
  EXPECT_EQ(report.findings.back().message, "from here on 170 more findings for this field");
  EXPECT_EQ(report.findings.back().status, Status::kDnaReference);

  DnaView meshes = tiny_rig(arena);
  const Span<Face> faces = arena.array<Face>(1000);
  meshes.geom.meshes[0].faces = {faces.data, 1000};
  KeptFindings corners;
  EXPECT_TRUE(check(meshes, corners, true));
  ASSERT_EQ(corners.findings.size(), 32u);
  EXPECT_EQ(corners.findings[31].field, "geom.meshes[0].faces[31].layoutIndices");
  EXPECT_EQ(corners.findings[31].message, "from here on 969 more findings for this field");
  EXPECT_EQ(corners.errors(), 0u);
}

TEST(DnaCheckerTest, ThirtyTwoAreNotCut) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  view.geom.meshes[0].faces = {arena.array<Face>(32).data, 32};
  KeptFindings report;
  check(view, report, true);
  ASSERT_EQ(report.findings.size(), 32u);
  EXPECT_EQ(report.findings[31].field, "geom.meshes[0].faces[31].layoutIndices");
  EXPECT_EQ(report.findings[31].message, "a face with 0 corners");
}

TEST(DnaCheckerTest, StopsWhenTheSinkHasEnough) {
  for (size_t enough : {1u, 2u, 5u}) {
    Arena arena(default_allocator());
    DnaView view = tiny_rig(arena);
    view.bhvr.joints.groups[0].input_indices = be<uint16_t>(arena, {99, 98});
    view.bhvr.joints.groups[1].output_indices = be<uint16_t>(arena, {99, 98, 97, 96});
    view.twsw.twists[0].twist_axis = 9;
    view.rbfe.poses.count = 1;
    view.geom.meshes[0].skin_weights.count = 1;
    KeptFindings report;
    report.enough = enough;  // KeptFindings::keep expects no call after that
    EXPECT_FALSE(check_layers(view, report.sink(true)));
    EXPECT_EQ(report.findings.size(), enough);
  }
}

// Within a list, too.
TEST(DnaCheckerTest, StopsWithinALoop) {
  const auto expect = [](void (*damage)(DnaView&, Arena&), const char* field, size_t all) {
    for (const size_t enough : {SIZE_MAX, size_t{1}}) {
      Arena arena(default_allocator());
      DnaView view = tiny_rig(arena);
      damage(view, arena);
      KeptFindings report;
      report.enough = enough;
      EXPECT_EQ(check(view, report, true), enough != 1);
      ASSERT_EQ(report.findings.size(), std::min(all, enough)) << report.text();
      EXPECT_EQ(report.findings[0].field, field);
    }
  };
  // Controls of a layer that is not loaded.
  expect(
      [](DnaView& view, Arena& arena) {
        view.bhvr.joints.groups[1].input_indices = be<uint16_t>(arena, {9, 4, 10});
        view.loaded &= ~uint32_t{kLayerRbf};
        view.rbfb = {};
        view.rbfe = {};
      },
      "bhvr.joints.jointGroups[1].inputIndices", 2);
  expect(
      [](DnaView& view, Arena& arena) {
        MlOperation& scatter = view.mlbe.types[0].operations[2][0];
        scatter.set_dependencies = be<uint16_t>(arena, {7, 8});
        scatter.operation_dependencies = be<uint16_t>(arena, {0, 0});
      },
      "mlbe.mlbTypeData[0].operations[2][0].mlOperationSetDependencyIndices", 2);
}

}  // namespace
}  // namespace mien::dna
