// SPDX-License-Identifier: MIT
// A file opened with some of its LODs: which things remain, and that every number points at what it
// pointed at before. What comes out of such a file: lod_selection_results_test.cpp.
#include "runtime/load/dna/convert/lod_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "tests/support/layer_rig.h"
#include "tests/support/lod_cuts.h"

namespace mien {
namespace {

using dna::Array;
using dna::DnaView;
using dna::LodMap;
using dna::String;

std::string string_of(const String& s) { return std::string(s.chars(), s.count); }

// Names behind numbers ----------------------------------------------------------------------------

std::vector<std::string> strings_of(const dna::List<String>& list) {
  std::vector<std::string> strings;
  for (const String& s : list) strings.push_back(string_of(s));
  return strings;
}

/// Names of what `numbers` point at; a number past the end fails the test.
std::vector<std::string> named(const Array<uint16_t>& numbers, const dna::List<String>& names) {
  std::vector<std::string> found;
  for (uint32_t i = 0; i < numbers.count; ++i) {
    EXPECT_LT(numbers[i], names.count);
    if (numbers[i] < names.count) found.push_back(string_of(names[numbers[i]]));
  }
  return found;
}

uint32_t rows_at(const Array<uint16_t>& lods, uint32_t lod) {
  return lod < lods.count ? lods[lod] : 0;
}

void mark(const Array<uint16_t>& numbers, std::vector<uint8_t>& marks) {
  for (uint32_t i = 0; i < numbers.count; ++i) marks[numbers[i]] = 1;
}
std::vector<uint8_t> listed(const LodMap& map, uint64_t mask, uint32_t count) {
  std::vector<uint8_t> marks(count);
  for (uint32_t lod : lods_of(mask)) mark(map.at(lod), marks);
  return marks;
}
std::vector<std::string> names_of_marked(const std::vector<uint8_t>& marks,
                                         const dna::List<String>& names) {
  std::vector<std::string> found;
  for (uint32_t i = 0; i < marks.size(); ++i) {
    if (marks[i]) found.push_back(string_of(names[i]));
  }
  return found;
}

/// docs/dna-format.md, 10.2 "Definition", and what the kept LODs still write.
void expect_survivors(const DnaView& whole, uint64_t mask, const DnaView& cut) {
  const dna::Definition& d = whole.defn;
  const uint32_t finest = lods_of(mask)[0];
  std::vector<uint8_t> joints = listed(d.lod_joints, mask, d.joint_names.count);
  const std::vector<uint8_t> at_zero = listed(d.lod_joints, 1, d.joint_names.count);
  for (size_t j = 0; j < joints.size(); ++j) joints[j] |= !at_zero[j];
  for (const dna::JointGroup& group : whole.bhvr.joints.groups) {
    for (uint32_t r = 0; r < rows_at(group.lods, finest); ++r)
      joints[group.output_indices[r] / 9] = 1;
  }
  std::vector<uint8_t> channels = listed(d.lod_channels, mask, d.channel_names.count);
  mark(whole.bhvr.channels.output_indices.first(rows_at(whole.bhvr.channels.lods, finest)),
       channels);
  std::vector<uint8_t> maps = listed(d.lod_maps, mask, d.map_names.count);
  mark(whole.bhvr.maps.conditionals.output_indices.first(rows_at(whole.bhvr.maps.lods, finest)),
       maps);

  EXPECT_EQ(strings_of(cut.defn.joint_names), names_of_marked(joints, d.joint_names));
  EXPECT_EQ(strings_of(cut.defn.channel_names), names_of_marked(channels, d.channel_names));
  EXPECT_EQ(strings_of(cut.defn.map_names), names_of_marked(maps, d.map_names));
  EXPECT_EQ(strings_of(cut.defn.mesh_names),
            names_of_marked(listed(d.lod_meshes, mask, d.mesh_names.count), d.mesh_names));
  EXPECT_EQ(strings_of(cut.defn.gui_control_names), strings_of(d.gui_control_names));
  EXPECT_EQ(strings_of(cut.defn.raw_control_names), strings_of(d.raw_control_names));
}

void expect_lists(const DnaView& whole, uint64_t mask, const DnaView& cut) {
  const std::vector<uint32_t> lods = lods_of(mask);
  ASSERT_EQ(cut.desc.lod_count, lods.size());
  EXPECT_EQ(cut.desc.max_lod, whole.desc.max_lod + lods[0]);
  const dna::Definition &a = whole.defn, &b = cut.defn;
  for (uint32_t l = 0; l < lods.size(); ++l) {
    EXPECT_EQ(named(b.lod_joints.at(l), b.joint_names),
              named(a.lod_joints.at(lods[l]), a.joint_names));
    EXPECT_EQ(named(b.lod_channels.at(l), b.channel_names),
              named(a.lod_channels.at(lods[l]), a.channel_names));
    EXPECT_EQ(named(b.lod_maps.at(l), b.map_names), named(a.lod_maps.at(lods[l]), a.map_names));
    EXPECT_EQ(named(b.lod_meshes.at(l), b.mesh_names),
              named(a.lod_meshes.at(lods[l]), a.mesh_names));
  }
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// Pairs of mesh and channel of which both survive.
Pairs mesh_channels(const DnaView& view, const DnaView& cut) {
  const std::vector<std::string> from = named(view.defn.mesh_channels.from, view.defn.mesh_names);
  const std::vector<std::string> to = named(view.defn.mesh_channels.to, view.defn.channel_names);
  const auto has = [](const dna::List<String>& list, const std::string& name) {
    const std::vector<std::string> names = strings_of(list);
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  Pairs pairs;
  for (size_t i = 0; i < from.size() && i < to.size(); ++i) {
    if (has(cut.defn.mesh_names, from[i]) && has(cut.defn.channel_names, to[i])) {
      pairs.push_back({from[i], to[i]});
    }
  }
  return pairs;
}

/// Neutral pose and parent of each joint, by name. A parent that is gone becomes joint 0.
void expect_skeleton(const DnaView& whole, const DnaView& cut) {
  std::map<std::string, uint32_t> old;
  for (uint32_t j = 0; j < whole.defn.joint_names.count; ++j) {
    old[string_of(whole.defn.joint_names[j])] = j;
  }
  ASSERT_EQ(old.size(), whole.defn.joint_names.count) << "the test needs joints of unique names";
  const std::vector<std::string> names = strings_of(cut.defn.joint_names);
  const std::set<std::string> present(names.begin(), names.end());
  ASSERT_EQ(cut.defn.joint_hierarchy.count, names.size());
  ASSERT_EQ(cut.defn.neutral_rotations.zs.count, names.size());
  for (uint32_t j = 0; j < names.size(); ++j) {
    const uint32_t before = old.at(names[j]);
    const std::string parent =
        string_of(whole.defn.joint_names[whole.defn.joint_hierarchy[before]]);
    EXPECT_EQ(names.at(cut.defn.joint_hierarchy[j]), present.count(parent) ? parent : names[0]);
    EXPECT_EQ(cut.defn.neutral_translations.ys[j], whole.defn.neutral_translations.ys[before]);
    EXPECT_EQ(cut.defn.neutral_rotations.zs[j], whole.defn.neutral_rotations.zs[before]);
    if (before < whole.jbmd.joints.count) {
      ASSERT_LT(j, cut.jbmd.joints.count);
      EXPECT_EQ(cut.jbmd.joints[j].rotation, whole.jbmd.joints[before].rotation);
    }
  }
}

/// Meshes are told by their vertices' place in the file, targets by their deltas'.
void expect_geometry(const DnaView& whole, const DnaView& cut) {
  if (whole.geom.meshes.count == 0) return;
  ASSERT_EQ(cut.geom.meshes.count, cut.defn.mesh_names.count);
  const std::vector<std::string> old_names = strings_of(whole.defn.mesh_names);
  for (uint32_t m = 0; m < cut.geom.meshes.count; ++m) {
    const auto old =
        std::find(old_names.begin(), old_names.end(), string_of(cut.defn.mesh_names[m])) -
        old_names.begin();
    const dna::Mesh &before = whole.geom.meshes[old], &after = cut.geom.meshes[m];
    EXPECT_EQ(after.positions.xs.data, before.positions.xs.data);
    std::map<const uint8_t*, std::string> channel_of;
    for (const dna::BlendShapeTarget& target : before.blend_shape_targets) {
      channel_of[target.vertex_indices.data] =
          string_of(whole.defn.channel_names[target.channel_index]);
    }
    const std::vector<std::string> channels = strings_of(cut.defn.channel_names);
    const std::set<std::string> present(channels.begin(), channels.end());
    size_t expected = 0;
    for (const auto& [place, name] : channel_of) expected += present.count(name);
    EXPECT_EQ(after.blend_shape_targets.count, expected);
    for (const dna::BlendShapeTarget& target : after.blend_shape_targets) {
      ASSERT_LT(target.channel_index, channels.size());
      EXPECT_EQ(channels[target.channel_index], channel_of[target.vertex_indices.data]);
    }

    ASSERT_EQ(after.skin_weights.count, before.skin_weights.count);
    for (uint32_t v = 0; v < after.skin_weights.count; ++v) {
      const dna::VertexSkinWeights& vertex = after.skin_weights[v];
      float sum = 0;
      for (uint32_t i = 0; i < vertex.weights.count; ++i) sum += vertex.weights[i];
      if (before.skin_weights[v].weights.count) {
        ASSERT_NEAR(sum, 1, 1e-3) << "vertex " << v;
      }
      const size_t joints = named(vertex.joint_indices, cut.defn.joint_names).size();
      ASSERT_EQ(joints, vertex.weights.count);
    }
  }
}

/// Networks and solvers are told by where their inputs stand in the file.
void expect_learned(const DnaView& whole, uint64_t mask, const DnaView& cut) {
  const std::vector<uint32_t> lods = lods_of(mask);
  const auto networks_at = [](const DnaView& view, uint32_t lod) {
    std::vector<const uint8_t*> places;
    const Array<uint16_t> list = view.mlbh.lod_networks.at(lod);
    for (uint32_t i = 0; i < list.count; ++i) {
      EXPECT_LT(list[i], view.mlbh.networks.count);
      places.push_back(view.mlbh.networks[list[i]].input_indices.data);
    }
    return places;
  };
  const auto solvers_at = [](const DnaView& view, uint32_t lod) {
    std::vector<const uint8_t*> places;
    const Array<uint16_t> list = view.rbfb.lod_solvers.at(lod);
    for (uint32_t i = 0; i < list.count; ++i) {
      EXPECT_LT(list[i], view.rbfb.solvers.count);
      places.push_back(view.rbfb.solvers[list[i]].raw_control_values.data);
    }
    return places;
  };
  // Per set, the networks that its operations run: [set][operation listed at the LOD].
  const auto operations_at = [](const DnaView& view, uint32_t lod) {
    std::vector<const uint8_t*> places;
    for (const dna::MlType& type : view.mlbe.types) {
      for (uint32_t s = 0; s < type.operations.count; ++s) {
        const Array<uint16_t> list = type.lod_operations[s].at(lod);
        for (uint32_t i = 0; i < list.count; ++i) {
          EXPECT_LT(list[i], type.operations[s].count);
          const dna::MlOperation& operation = type.operations[s][list[i]];
          const bool runs = operation.type == uint16_t(dna::MlOperationType::kMlp);
          places.push_back(runs ? view.mlbh.networks[operation.parameters[0]].input_indices.data
                                : operation.parameters.data);
        }
      }
    }
    return places;
  };
  for (uint32_t l = 0; l < lods.size(); ++l) {
    EXPECT_EQ(networks_at(cut, l), networks_at(whole, lods[l]));
    EXPECT_EQ(solvers_at(cut, l), solvers_at(whole, lods[l]));
    EXPECT_EQ(operations_at(cut, l), operations_at(whole, lods[l]));
  }
  for (const dna::List<Array<uint16_t>>& regions : cut.mlbh.mesh_regions.indices) {
    for (const Array<uint16_t>& networks : regions) {
      for (uint32_t i = 0; i < networks.count; ++i) {
        EXPECT_LT(networks[i], cut.mlbh.networks.count);
      }
    }
  }
}

void expect_numbers(const MienDna& whole, uint64_t mask, const MienDna& cut) {
  expect_survivors(capi::object(&whole)->view, mask, capi::object(&cut)->view);
  expect_lists(capi::object(&whole)->view, mask, capi::object(&cut)->view);
  EXPECT_EQ(mesh_channels(capi::object(&cut)->view, capi::object(&cut)->view),
            mesh_channels(capi::object(&whole)->view, capi::object(&cut)->view));
  expect_skeleton(capi::object(&whole)->view, capi::object(&cut)->view);
  expect_geometry(capi::object(&whole)->view, capi::object(&cut)->view);
  expect_learned(capi::object(&whole)->view, mask, capi::object(&cut)->view);
}

TEST(LodSelection, GeneratedRigsKeepTheirNumbers) {
  for_each_cut(generated_sources(), expect_numbers);
}
TEST(LodSelection, GoldenFilesKeepTheirNumbers) { for_each_cut(golden_sources(), expect_numbers); }
void expect_all_lods_change_nothing(const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    SCOPED_TRACE(source.name);
    const DnaHandle whole = open_dna(source.bytes);
    ASSERT_TRUE(whole);
    const Bytes expected = write_dna(whole.get());
    const uint64_t all = (uint64_t{1} << whole->view.desc.lod_count) - 1;
    for (uint64_t mask : {all, ~uint64_t{0}}) {
      EXPECT_TRUE(write_dna(open_dna(source.bytes, mask).get()) == expected);
    }
  }
}

TEST(LodSelection, AllLodsChangeNothing) {
  expect_all_lods_change_nothing(generated_sources());
  for (const Source& source : generated_sources()) {
    EXPECT_TRUE(write_dna(open_dna(source.bytes).get()) == source.bytes) << source.name;
  }
}

TEST(LodSelection, AllLodsOfGoldenFilesChangeNothing) {
  expect_all_lods_change_nothing(golden_sources());
}

TEST(LodSelection, LodsPastTheEndDoNotCount) {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));  // two LODs
  for (uint64_t mask : {uint64_t{4}, uint64_t{0xF0}, uint64_t{1} << 63}) {
    EXPECT_FALSE(open_dna(bytes, mask, MIEN_ERROR_LOD)) << mask;
  }
  EXPECT_EQ(write_dna(open_dna(bytes, 2 | 0x100).get()), write_dna(open_dna(bytes, 2).get()));
}

// What the comment of tiny_rig.h says of LOD 1, number by number.
TEST(LodSelection, TinyRigAtItsCoarseLod) {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));
  const DnaHandle cut = open_dna(bytes, 2);
  const DnaView& view = cut->view;
  EXPECT_EQ(view.desc.max_lod, 1);
  EXPECT_EQ(strings_of(view.defn.joint_names), (std::vector<std::string>{"head", "jaw"}));
  EXPECT_EQ(strings_of(view.defn.channel_names), (std::vector<std::string>{"jawOpen"}));
  EXPECT_EQ(view.defn.map_names.count, 0u);
  EXPECT_EQ(view.mlbh.networks.count, 0u);
  EXPECT_EQ(view.mlbh.control_names.count, 4u) << "controls keep their numbers";
  EXPECT_EQ(view.rbfb.solvers.count, 0u);
  EXPECT_EQ(view.rbfe.pose_control_names.count, 2u);
  EXPECT_EQ(view.twsw.twists.count, 1u);
  ASSERT_EQ(view.twsw.swings.count, 1u)
      << "the twist of its inputs would turn the other way without it";
  EXPECT_EQ(view.twsw.swings[0].output_joint_indices.count, 0u) << "its only joint is gone";
  EXPECT_EQ(view.mlbe.joints.input_indices.count, 0u);
  ASSERT_EQ(view.bhvr.joints.groups.count, 2u) << "groups keep their numbers";
  EXPECT_EQ(view.bhvr.joints.groups[0].values.count, 2u);
  EXPECT_EQ(view.bhvr.joints.groups[1].input_indices.count, 0u);
  EXPECT_EQ(view.bhvr.joints.row_count, 18);
}

// Joints that LOD 0 does not list belong to no LOD in particular.
TEST(LodSelection, LooseJointsStay) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.defn.lod_joints.indices[0] = dna::be<uint16_t>(arena, {0, 1});
  const Bytes bytes = write_view(view);
  const DnaHandle cut = open_dna(bytes, 2);
  EXPECT_EQ(strings_of(cut->view.defn.joint_names),
            (std::vector<std::string>{"head", "jaw", "tongue"}));
}

// Joints without a parent hang from joint 0, but not those that it hangs from itself.
TEST(LodSelection, NoJointBecomesItsOwnAncestor) {
  Arena arena(default_allocator());
  const struct {
    std::vector<uint16_t> parents, kept, expected;
  } cases[] = {
      {{1, 2, 2}, {0, 1}, {1, 1}},           // 0 hangs from 1, whose parent is gone
      {{1, 2, 3, 3}, {0, 1, 2}, {1, 2, 2}},  // further up
      {{2, 2, 3, 3}, {0, 1, 2}, {2, 2, 2}},  // with a sibling
      {{1, 3, 3, 3}, {0, 1, 2}, {1, 1, 0}},  // another joint without parent is no ancestor
      {{3, 3, 3, 3}, {0, 1, 2}, {0, 0, 0}},  // joint 0 is the first of them
      {{3, 2, 2, 1}, {1, 3}, {0, 0}},        // joint 0 is gone: its number is that of joint 1
      {{1, 1, 1}, {0, 1}, {1, 1}},           // nothing that counts is gone
      {{0, 0, 1, 2}, {0, 3}, {0, 0}},        // the common case
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(testing::PrintToString(c.parents));
    const auto count = static_cast<uint32_t>(c.parents.size());
    DnaView view = {};
    view.loaded = dna::kLayersAll;
    view.desc.lod_count = 2;
    view.dsce.rotation_sign = {1, 1, 1};
    Array<uint16_t> all = dna::new_array<uint16_t>(arena, count);
    const dna::NewArray<uint16_t> numbers = dna::new_array<uint16_t>(arena, count);
    const dna::NewArray<uint16_t> parents = dna::new_array<uint16_t>(arena, count);
    const dna::NewArray<uint16_t> kept = dna::new_array<uint16_t>(arena, c.kept.size());
    const dna::NewArray<float> zeros = dna::new_array<float>(arena, count);
    Span<String> names = arena.array<String>(count);
    for (uint32_t j = 0; j < count; ++j) {
      numbers.set(j, static_cast<uint16_t>(j));
      parents.set(j, c.parents[j]);
      zeros.set(j, 0);
    }
    for (uint32_t k = 0; k < c.kept.size(); ++k) kept.set(k, c.kept[k]);
    all = numbers;
    Span<Array<uint16_t>> lists = arena.array<Array<uint16_t>>(2);
    lists[0] = all;
    lists[1] = kept;
    view.defn.lod_joints = {dna::be<uint16_t>(arena, {0, 1}), {lists.data, 2}};
    const Array<uint16_t> none = dna::be<uint16_t>(arena, {0, 0});
    const dna::List<Array<uint16_t>> empty = {arena.array<Array<uint16_t>>(1).data, 1};
    view.defn.lod_channels = view.defn.lod_maps = view.defn.lod_meshes = {none, empty};
    view.defn.joint_names = {names.data, count};
    view.defn.joint_hierarchy = parents;
    view.defn.neutral_translations = {zeros, zeros, zeros};
    view.defn.neutral_rotations = view.defn.neutral_translations;
    const Bytes bytes = write_view(view);
    const DnaHandle cut = open_dna(bytes, 2);
    ASSERT_TRUE(cut);
    const Array<uint16_t>& found = cut->view.defn.joint_hierarchy;
    ASSERT_EQ(found.count, c.expected.size());
    for (uint32_t j = 0; j < found.count; ++j) EXPECT_EQ(found[j], c.expected[j]) << j;
  }
}

// Lists may lack what the rows of their LOD write.
TEST(LodSelection, WhatRemainingRowsWriteStays) {
  Arena arena(default_allocator());
  using Strings = std::vector<std::string>;
  const std::pair<Array<uint16_t>, Strings> lists[] = {
      {dna::be<uint16_t>(arena, {0}), {"head", "jaw"}}, {{}, {"jaw"}}};
  for (const auto& [listed, joints] : lists) {
    dna::DnaView view = dna::tiny_rig(arena);
    view.defn.lod_joints.indices[1] = listed;
    view.defn.lod_channels.indices[1] = {};
    const Bytes bytes = write_view(view);
    const DnaHandle cut = open_dna(bytes, 2);
    EXPECT_EQ(strings_of(cut->view.defn.joint_names), joints);
    EXPECT_EQ(strings_of(cut->view.defn.channel_names), Strings{"jawOpen"});
    const Array<uint16_t> outputs = cut->view.bhvr.joints.groups[0].output_indices;
    ASSERT_EQ(outputs.count, 1u);
    EXPECT_EQ(outputs[0], 9 * (joints.size() - 1) + 3) << "the jaw's rx";
  }
}

// As long as a list of all, but not one.
TEST(LodSelection, ListsThatRepeatElements) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.defn.lod_channels.indices[0] = dna::be<uint16_t>(arena, {1, 1});
  view.bhvr.channels.lods = dna::be<uint16_t>(arena, {0, 0});
  const Bytes bytes = write_view(view);
  const DnaHandle cut = open_dna(bytes, 1);
  EXPECT_EQ(strings_of(cut->view.defn.channel_names), std::vector<std::string>{"smile"});
}

TEST(LodSelection, VerticesWithoutInfluencesFollowTheRoot) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  view.geom.meshes[0].skin_weights[3] = {};
  const Bytes bytes = write_view(view);
  for (uint64_t mask : {1, 2}) {
    const DnaHandle cut = open_dna(bytes, mask);
    const dna::VertexSkinWeights& vertex = cut->view.geom.meshes[0].skin_weights[3];
    ASSERT_EQ(vertex.weights.count, 1u) << mask;
    EXPECT_EQ(vertex.weights[0], 1.0f);
    EXPECT_EQ(vertex.joint_indices[0], 0);
  }
}

TEST(LodSelection, FilesWithoutJoints) {
  Arena arena(default_allocator());
  LayerRig rig;
  rig.base.lod_count = 2;
  rig.base.raw_count = 1;
  dna::DnaView view = to_view(rig, arena);
  ASSERT_EQ(view.defn.joint_names.count, 0u);
  dna::Mesh mesh;
  const dna::Array<float> zero = dna::be<float>(arena, {0});
  mesh.positions = {zero, zero, zero};
  mesh.skin_weights = dna::list<dna::VertexSkinWeights>(arena, {{}});
  view.geom.meshes = dna::list<dna::Mesh>(arena, {mesh});
  view.defn.mesh_names = dna::list<dna::String>(arena, {dna::text("m")});
  view.defn.lod_meshes = {dna::be<uint16_t>(arena, {0, 0}),
                          dna::list<dna::Array<uint16_t>>(arena, {dna::be<uint16_t>(arena, {0})})};
  const Bytes bytes = write_view(view);
  for (const uint64_t mask : {1, 2}) {
    const DnaHandle cut = open_dna(bytes, mask);
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->view.defn.joint_hierarchy.count, 0u);
    ASSERT_EQ(cut->view.geom.meshes.count, 1u);
    EXPECT_EQ(cut->view.geom.meshes[0].skin_weights[0].weights.count, 0u);
  }
}

// More entries than a file can have LODs: a report warns of them, nothing else reads them.
TEST(LodSelection, ListsOfMoreLodsThanThereAre) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  const Bytes sound = write_view(view);
  const dna::NewArray<uint16_t> channels = dna::new_array<uint16_t>(arena, 100);
  for (uint32_t l = 0; l < 100; ++l) channels.set(l, l != 0);
  view.defn.lod_channels.lods = channels;
  const Bytes bytes = write_view(view);
  for (const uint64_t mask : {1, 2}) {
    const DnaHandle cut = open_dna(bytes, mask), expected = open_dna(sound, mask);
    ASSERT_TRUE(cut);
    EXPECT_EQ(strings_of(cut->view.defn.channel_names),
              strings_of(expected->view.defn.channel_names));
  }
  LayerRig rig;  // of which LODs 0 and 2 are kept
  rig.base.lod_count = 3;
  rig.base.raw_count = rig.base.channel_count = 1;
  rig.base.channel_inputs = rig.base.channel_outputs = {0};
  rig.base.channel_lods.assign(100, 0);
  rig.base.channel_lods[0] = rig.base.channel_lods[1] = 1;
  const DnaHandle cut = open_dna(write_view(to_view(rig, arena)), 5);
  ASSERT_TRUE(cut);
  const dna::Array<uint16_t>& rows = cut->view.bhvr.channels.lods;
  ASSERT_EQ(rows.count, 2u);
  EXPECT_EQ(rows[0], 1);
  EXPECT_EQ(rows[1], 0);
}

// What is left makes up for what is gone, also where the weights of the file have another sum than 1.
TEST(LodSelection, WeightsThatAreLeftAreScaled) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  dna::VertexSkinWeights& given = view.geom.meshes[0].skin_weights[3];
  given.joint_indices = dna::be<uint16_t>(arena, {2, 0, 1});  // 2, the tongue, has LOD 0 only
  const std::vector<std::vector<float>> cases[] = {{{0.5f, 0.125f, 0.375f}, {0.25f, 0.75f}},
                                                   {{1.5f, 0.25f, 0.25f}, {0.5f, 0.5f}}};
  for (const auto& c : cases) {
    given.weights = dna::be<float>(arena, {c[0][0], c[0][1], c[0][2]});
    const Bytes bytes = write_view(view);
    const DnaHandle cut = open_dna(bytes, 2);
    const dna::VertexSkinWeights& vertex = cut->view.geom.meshes[0].skin_weights[3];
    ASSERT_EQ(vertex.weights.count, 2u);
    for (uint32_t i = 0; i < 2; ++i) {
      EXPECT_EQ(vertex.joint_indices[i], i);
      EXPECT_EQ(vertex.weights[i], c[1][i]);
    }
  }
}

// Each kind of damage refuses a file, unless no kept LOD uses what is damaged.
TEST(LodSelection, WhatOnlyDroppedLodsUseIsNotLookedAt) {
  Arena arena(default_allocator());
  const auto expect = [&](const char* what, auto&& damage, uint64_t good_mask) {
    SCOPED_TRACE(what);
    dna::DnaView view = dna::tiny_rig(arena);
    const Bytes sound = write_view(view);
    damage(view);
    const Bytes bytes = write_view(view);
    for (uint64_t mask : {0, 1, 2, 3}) {
      SCOPED_TRACE(mask);
      MienError error = sized<MienError>();
      MienDnaDesc desc = sized<MienDnaDesc>();
      desc.lods = mask;
      MienDna* dna = nullptr;
      const MienStatus status =
          mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, &error);
      const DnaHandle opened(dna);
      EXPECT_EQ(status == MIEN_OK, mask != 0 && mask == good_mask) << error.message;
      if (opened) {
        EXPECT_TRUE(write_dna(dna) == write_dna(open_dna(sound, mask).get()));
      }
    }
  };
  const Array<uint16_t> past_the_end = dna::be<uint16_t>(arena, {0, 7});
  const Array<uint16_t> too_many = dna::be<uint16_t>(arena, {1, 9});
  const Array<uint16_t> too_many_first = dna::be<uint16_t>(arena, {9, 1});
  expect(
      "channels of LOD 0", [&](DnaView& v) { v.defn.lod_channels.indices[0] = past_the_end; }, 0);
  expect(
      "channels of LOD 1", [&](DnaView& v) { v.defn.lod_channels.indices[1] = past_the_end; }, 1);
  expect(
      "joints of LOD 1", [&](DnaView& v) { v.defn.lod_joints.indices[1] = past_the_end; }, 1);
  // LOD 0 tells which joints belong to LODs at all.
  expect(
      "joints of LOD 0", [&](DnaView& v) { v.defn.lod_joints.indices[0] = past_the_end; }, 0);
  expect(
      "rows of LOD 1", [&](DnaView& v) { v.bhvr.maps.lods = too_many; }, 1);
  expect(
      "rows of LOD 0", [&](DnaView& v) { v.bhvr.joints.groups[0].lods = too_many_first; }, 2);
}

// A second network, the only one of LOD 1, with operations and row limits of its own.
TEST(LodSelection, NetworksOperationsAndRowLimits) {
  Arena arena(default_allocator());
  dna::DnaView view = dna::tiny_rig(arena);
  const auto add_second = [&](auto& list) {
    list = dna::list<std::remove_reference_t<decltype(list[0])>>(arena, {list[0], list[0]});
  };
  const Array<uint16_t> both = dna::be<uint16_t>(arena, {0, 1});
  const Array<uint16_t> second = dna::be<uint16_t>(arena, {1});
  add_second(view.mlbh.networks);
  view.mlbh.lod_networks.indices[0] = both;
  view.mlbh.lod_networks.indices[1] = second;
  view.mlbh.mesh_regions.indices[0][0] = both;
  for (uint32_t s = 0; s < 3; ++s) {
    const dna::MlType& type = view.mlbe.types[0];
    add_second(type.operations[s]);
    type.lod_operations[s].indices[0] = both;
    type.lod_operations[s].indices[1] = second;
    if (s > 0) type.operations[s][1].operation_dependencies = second;
  }
  // Network 1; layer 0: 3 rows, 2 at LOD 1; layer 1: 4 rows, 1 at LOD 1.
  view.mlbe.types[0].operations[1][1].parameters = dna::be<uint32_t>(arena, {1, 3, 2, 4, 1});
  const Bytes bytes = write_view(view);

  const auto numbers = [](const auto& array) {
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < array.count; ++i) found.push_back(array[i]);
    return found;
  };
  using Numbers = std::vector<uint32_t>;
  const DnaHandle fine = open_dna(bytes, 1), coarse = open_dna(bytes, 2);
  EXPECT_EQ(fine->view.mlbh.networks.count, 2u);
  EXPECT_EQ(numbers(fine->view.mlbe.types[0].operations[1][1].parameters), (Numbers{1, 3, 4}));

  const DnaView& cut = coarse->view;
  EXPECT_EQ(cut.mlbh.networks.count, 1u);
  EXPECT_EQ(numbers(cut.mlbh.lod_networks.at(0)), Numbers{0});
  EXPECT_EQ(numbers(cut.mlbh.mesh_regions.indices[0][0]), Numbers{0});
  for (uint32_t s = 0; s < 3; ++s) {
    ASSERT_EQ(cut.mlbe.types[0].operations[s].count, 1u);
    EXPECT_EQ(numbers(cut.mlbe.types[0].lod_operations[s].at(0)), Numbers{0});
    const Numbers dependencies = s ? Numbers{0} : Numbers{};
    EXPECT_EQ(numbers(cut.mlbe.types[0].operations[s][0].operation_dependencies), dependencies);
  }
  EXPECT_EQ(numbers(cut.mlbe.types[0].operations[1][0].parameters), (Numbers{0, 2, 1}));
}

}  // namespace
}  // namespace mien
