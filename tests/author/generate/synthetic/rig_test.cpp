// SPDX-License-Identifier: MIT
#include "author/generate/synthetic/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "author/base/random.h"
#include "runtime/load/dna/check/dna_check.h"
#include "runtime/load/dna/format/dna_writer.h"

namespace mien {
namespace {

using dna::Array;
using dna::DnaView;
using dna::List;

constexpr SyntheticPreset kPresets[] = {SyntheticPreset::kTiny, SyntheticPreset::kSmall,
                                        SyntheticPreset::kMedium, SyntheticPreset::kLarge};

struct Made {
  Arena arena{default_allocator()};
  DnaView view;

  Made(SyntheticPreset preset, uint64_t seed, bool learned = false) {
    EXPECT_TRUE(make_synthetic_rig(preset, seed, arena, view, learned));
  }
};

/// FNV-1a over all that a layer says: the bytes of its arrays as a file holds them, the counts of
/// its lists, and its numbers.
struct Hasher {
  uint64_t hash = 14695981039346656037u;

  void bytes(const uint8_t* at, size_t count) {
    for (size_t i = 0; i < count; ++i) hash = (hash ^ at[i]) * 1099511628211u;
  }
  void number(uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) {
      const uint8_t byte = static_cast<uint8_t>(value >> shift);
      bytes(&byte, 1);
    }
  }

  static bool has_face_winding() { return true; }
  template <class T>
  void operator()(const char*, const Array<T>& array) {
    number(array.count);
    bytes(array.data, array.byte_count());
  }
  void operator()(const char*, const dna::String& string) {
    number(string.count);
    bytes(string.data, string.count);
  }
  template <class T>
  void operator()(const char* name, const List<T>& list) {
    number(list.count);
    for (const T& item : list) (*this)(name, item);
  }
  template <class T>
  std::enable_if_t<std::is_integral<T>::value> operator()(const char*, T value) {
    number(static_cast<uint64_t>(value));
  }
  void operator()(const char*, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof(bits));
    number(bits);
  }
  template <class T>
  std::enable_if_t<std::is_class<T>::value> operator()(const char*, const T& record) {
    T::fields(record, *this);
  }
};

uint64_t hash_of(const DnaView& view) {
  Hasher hasher;
  for (const dna::LayerKind& kind : dna::kLayerKinds) {
    dna::with_layer(view, kind.id, [&](const auto& layer) { hasher(kind.name, layer); });
  }
  return hasher.hash;
}

size_t distinct(const List<dna::String>& names) {
  std::set<std::string> set;
  for (const dna::String& name : names) set.insert(text(name));
  return set.size();
}

struct MatrixTotals {
  size_t rows = 0, entries = 0, zeros = 0;
};

MatrixTotals matrix_totals(const DnaView& view) {
  MatrixTotals totals;
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    totals.rows += group.output_indices.count;
    totals.entries += group.values.count;
    for (size_t i = 0; i < group.values.count; ++i) totals.zeros += group.values[i] == 0;
  }
  return totals;
}

/// Large rigs take a while, and no test changes one.
const DnaView& rig_of(SyntheticPreset preset, uint64_t seed) {
  static std::map<std::pair<SyntheticPreset, uint64_t>, std::unique_ptr<Made>> made;
  std::unique_ptr<Made>& rig = made[{preset, seed}];
  if (!rig) rig = std::make_unique<Made>(preset, seed);
  return rig->view;
}

// Numbers that the generator stands on ------------------------------------------------------------

TEST(Random, IsSplitMixAndPcg32) {
  uint64_t state = 0;
  EXPECT_EQ(split_mix(state), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(split_mix(state), 0x6E789E6AA1B965F4u);
  Random random(42, 54);  // the example of the PCG authors
  for (uint32_t expected : {0xA15C02B7u, 0x7B47F409u, 0xBA1D3330u, 0x83D2F293u, 0xBFA4784Bu}) {
    EXPECT_EQ(random.bits(), expected);
  }
}

TEST(Random, DrawsEvenlyAndNormally) {
  Random random = Random::from_seed(1, 2);
  constexpr int kDraws = 60000;
  int seen[6] = {};
  double sum = 0, squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    ++seen[random.below(6)];
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  for (int n : seen) EXPECT_NEAR(n, kDraws / 6, 400);  // over four deviations
  EXPECT_NEAR(sum / kDraws, 0, 0.02);
  EXPECT_NEAR(squares / kDraws, 1, 0.03);
}

// Sizes -------------------------------------------------------------------------------------------

struct Expected {
  uint32_t lods, joints, gui, raw, psds, groups, channels, maps, meshes;
};

void expect_sizes(const DnaView& v, const Expected& e) {
  EXPECT_EQ(v.desc.lod_count, e.lods);
  EXPECT_EQ(v.defn.joint_names.count, e.joints);
  EXPECT_EQ(v.defn.gui_control_names.count, e.gui);
  EXPECT_EQ(v.defn.raw_control_names.count, e.raw);
  EXPECT_EQ(v.bhvr.controls.psd_count, e.psds);
  EXPECT_EQ(v.bhvr.joints.groups.count, e.groups);
  EXPECT_EQ(v.defn.channel_names.count, e.channels);
  EXPECT_EQ(v.bhvr.channels.output_indices.count, e.channels);
  EXPECT_EQ(v.defn.map_names.count, e.maps);
  EXPECT_EQ(v.defn.mesh_names.count, e.meshes);
  EXPECT_EQ(v.geom.meshes.count, e.meshes);
  EXPECT_EQ(v.bhvr.joints.row_count, 9 * e.joints);
  EXPECT_EQ(v.bhvr.joints.col_count, e.raw + e.psds);
}

TEST(SyntheticRig, HasTheSizesOfItsPreset) {
  expect_sizes(rig_of(SyntheticPreset::kTiny, 0), {3, 14, 6, 12, 7, 3, 8, 5, 5});
  expect_sizes(rig_of(SyntheticPreset::kSmall, 0), {4, 100, 27, 40, 60, 24, 90, 20, 6});
  expect_sizes(rig_of(SyntheticPreset::kMedium, 0), {5, 300, 68, 100, 300, 45, 360, 40, 7});
  expect_sizes(rig_of(SyntheticPreset::kLarge, 0), {8, 870, 174, 260, 600, 120, 780, 82, 10});
}

TEST(SyntheticRig, LargeHasAMillionEntriesAndManyZeros) {
  for (uint64_t seed : {0, 1, 2, 99}) {
    const MatrixTotals totals = matrix_totals(rig_of(SyntheticPreset::kLarge, seed));
    EXPECT_NEAR(static_cast<double>(totals.entries), 1e6, 1e5);
    EXPECT_NEAR(static_cast<double>(totals.zeros) / static_cast<double>(totals.entries), 0.4, 0.03);
    EXPECT_NEAR(static_cast<double>(totals.rows), 4800, 400);
  }
}

TEST(SyntheticRig, ShareOfGuiRowsIsNotIdentity) {
  const DnaView& view = rig_of(SyntheticPreset::kLarge, 0);
  const dna::ConditionalTable& t = view.bhvr.controls.conditionals;
  size_t odd = 0, negative = 0;
  std::set<uint16_t> driven, drivers;
  for (size_t i = 0; i < t.input_indices.count; ++i) {
    const bool identity = t.from_values[i] == 0 && t.to_values[i] == 1 && t.slope_values[i] == 1 &&
                          t.cut_values[i] == 0;
    odd += !identity;
    negative += t.from_values[i] < 0;
    driven.insert(t.output_indices[i]);
    drivers.insert(t.input_indices[i]);
  }
  EXPECT_EQ(t.input_indices.count, 267u);
  EXPECT_EQ(odd, 96u);
  EXPECT_EQ(negative, 78u);
  EXPECT_EQ(driven.size(), 260u);
  EXPECT_EQ(drivers.size(), 174u);
}

// What must hold for every preset and seed --------------------------------------------------------

class EveryRig : public ::testing::TestWithParam<std::tuple<SyntheticPreset, uint64_t>> {
 protected:
  const DnaView& view = rig_of(std::get<0>(GetParam()), std::get<1>(GetParam()));
  const dna::Definition& defn = view.defn;
  const dna::Behavior& bhvr = view.bhvr;
};

TEST_P(EveryRig, PassesAllChecksInSilence) {
  std::string found;
  const auto report = [](void* user, const dna::Finding& f) {
    *static_cast<std::string*>(user) += std::string(f.field) + ": " + f.message + "\n";
    return true;
  };
  const dna::FindingSink sink = {&found, report, true};
  EXPECT_TRUE(dna::check_definition(view, sink));
  EXPECT_TRUE(dna::check_layers(view, sink));
  EXPECT_EQ(found, "");
}

TEST_P(EveryRig, IsACompleteFileOfVersion28) {
  EXPECT_EQ(view.version, 8);
  EXPECT_EQ(view.loaded, uint32_t{dna::kLayersAll});
  ASSERT_EQ(view.index.count, dna::kLayerIdCount);
  for (size_t i = 0; i < dna::kLayerIdCount; ++i) {
    EXPECT_EQ(view.index[i].code, dna::kLayerKinds[i].code);
    EXPECT_EQ(view.index[i].layer_version, dna::kLayerKinds[i].layer_version);
  }
  EXPECT_EQ(view.control_count(), defn.raw_control_names.count + bhvr.controls.psd_count);
  EXPECT_EQ(view.rbfb.solvers.count + view.mlbh.networks.count + view.twsw.twists.count, 0u);
}

TEST_P(EveryRig, NamesAreUnique) {
  for (const auto* names : {&defn.gui_control_names, &defn.raw_control_names, &defn.joint_names,
                            &defn.channel_names, &defn.map_names, &defn.mesh_names}) {
    EXPECT_EQ(distinct(*names), names->count);
  }
}

TEST_P(EveryRig, JointSetsShrinkFromLodToLodAndKeepParents) {
  std::set<uint16_t> finer;
  for (uint16_t j = 0; j < defn.joint_names.count; ++j) finer.insert(j);
  for (size_t lod = 0; lod < view.desc.lod_count; ++lod) {
    const Array<uint16_t> list = defn.lod_joints.at(lod);
    std::set<uint16_t> joints;
    for (size_t i = 0; i < list.count; ++i) {
      EXPECT_TRUE(finer.count(list[i]));
      EXPECT_TRUE(joints.count(defn.joint_hierarchy[list[i]]) || list[i] == 0);
      joints.insert(list[i]);
    }
    EXPECT_EQ(joints.size(), list.count);
    EXPECT_TRUE(lod == 0 ? joints == finer : joints.size() < finer.size());
    finer = joints;
  }
  EXPECT_GE(finer.size(), 7u);
}

TEST_P(EveryRig, EachJointRowStandsInOneGroupAndLodsArePrefixes) {
  std::set<uint16_t> rows;
  size_t row_count = 0;
  for (const dna::JointGroup& group : bhvr.joints.groups) {
    ASSERT_EQ(group.lods.count, view.desc.lod_count);
    EXPECT_EQ(group.lods[0], group.output_indices.count);
    EXPECT_GT(group.output_indices.count, 0u);
    EXPECT_GT(group.input_indices.count, 0u);
    std::set<uint16_t> joints;
    for (size_t j = 0; j < group.joint_indices.count; ++j) joints.insert(group.joint_indices[j]);
    for (size_t r = 0; r < group.output_indices.count; ++r) {
      rows.insert(group.output_indices[r]);
      EXPECT_TRUE(joints.count(group.output_indices[r] / 9));
    }
    row_count += group.output_indices.count;

    for (size_t lod = 0; lod < group.lods.count; ++lod) {
      EXPECT_LE(group.lods[lod], group.lods[lod > 0 ? lod - 1 : 0]);
      const Array<uint16_t> list = defn.lod_joints.at(lod);
      std::set<uint16_t> at_lod;
      for (size_t i = 0; i < list.count; ++i) at_lod.insert(list[i]);
      for (size_t r = 0; r < group.output_indices.count; ++r) {
        EXPECT_EQ(r < group.lods[lod], at_lod.count(group.output_indices[r] / 9) == 1);
      }
    }
  }
  EXPECT_EQ(rows.size(), row_count);
}

TEST_P(EveryRig, CorrectivesReadDistinctRawControlsOfOneFace) {
  const dna::PsdTable& psds = bhvr.controls.psds;
  const dna::ConditionalTable& table = bhvr.controls.conditionals;
  std::vector<uint16_t> gui_of(defn.raw_control_names.count);
  for (size_t i = 0; i < table.input_indices.count; ++i) {
    gui_of[table.output_indices[i]] = table.input_indices[i];
  }
  std::vector<std::vector<uint16_t>> members(bhvr.controls.psd_count);
  for (size_t i = 0; i < psds.rows.count; ++i) {
    ASSERT_LT(psds.columns[i], view.first_psd()) << "a corrective reads a corrective";
    members[psds.rows[i] - view.first_psd()].push_back(psds.columns[i]);
    EXPECT_GE(psds.values[i], 1.0f);
  }
  for (const std::vector<uint16_t>& m : members) {
    EXPECT_GE(m.size(), 2u);
    EXPECT_LE(m.size(), 5u);
    std::set<uint16_t> guis;
    for (uint16_t raw : m) guis.insert(gui_of[raw]);
    EXPECT_EQ(guis.size(), m.size()) << "two ways of one GUI control never meet";
  }
  const std::set<std::vector<uint16_t>> different(members.begin(), members.end());
  EXPECT_EQ(different.size(), members.size());
}

TEST_P(EveryRig, MapsAreConnectedPiecesWithinOne) {
  const dna::ConditionalTable& t = bhvr.maps.conditionals;
  size_t with_cut = 0;
  for (size_t i = 0; i < t.input_indices.count; ++i) {
    const float start = t.slope_values[i] * t.from_values[i] + t.cut_values[i];
    const float end = t.slope_values[i] * t.to_values[i] + t.cut_values[i];
    if (t.from_values[i] == 0) {
      EXPECT_EQ(start, 0);
    } else {
      const float before = t.slope_values[i - 1] * t.to_values[i - 1] + t.cut_values[i - 1];
      EXPECT_EQ(t.from_values[i], t.to_values[i - 1]);
      EXPECT_NEAR(start, before, 1e-6);
    }
    EXPECT_LE(end, 1.000001f);
    with_cut += t.cut_values[i] != 0;
  }
  EXPECT_GT(with_cut, 0u);
  for (size_t lod = 0; lod < view.desc.lod_count; ++lod) {
    std::set<uint16_t> driven;
    for (size_t i = 0; i < bhvr.maps.lods[lod]; ++i) driven.insert(t.output_indices[i]);
    const Array<uint16_t> list = defn.lod_maps.at(lod);
    EXPECT_EQ(driven.size(), list.count);
    for (size_t i = 0; i < list.count; ++i) EXPECT_TRUE(driven.count(list[i]));
  }
}

TEST_P(EveryRig, ChannelsOfALodAreThoseThatItsEntriesWrite) {
  for (size_t lod = 0; lod < view.desc.lod_count; ++lod) {
    std::set<uint16_t> written;
    for (size_t i = 0; i < bhvr.channels.lods[lod]; ++i) {
      written.insert(bhvr.channels.output_indices[i]);
    }
    const Array<uint16_t> list = defn.lod_channels.at(lod);
    EXPECT_EQ(written.size(), list.count);
    for (size_t i = 0; i < list.count; ++i) EXPECT_TRUE(written.count(list[i]));
  }
}

struct DoublePoint {
  double x, y, z;
};

DoublePoint minus(DoublePoint a, DoublePoint b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
DoublePoint cross(DoublePoint a, DoublePoint b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(DoublePoint a, DoublePoint b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DoublePoint point_of(const dna::Vec3Array& v, size_t i) { return {v.xs[i], v.ys[i], v.zs[i]}; }

TEST_P(EveryRig, MeshesAreClosedAndFaceOutward) {
  for (const dna::Mesh& mesh : view.geom.meshes) {
    std::set<std::pair<uint32_t, uint32_t>> edges;
    size_t corners = 0;
    for (const dna::Face& face : mesh.faces) {
      const size_t n = face.layout_indices.count;
      std::vector<uint32_t> at(n);
      for (size_t i = 0; i < n; ++i) at[i] = mesh.layouts.positions[face.layout_indices[i]];
      for (size_t i = 0; i < n; ++i) edges.insert({at[i], at[(i + 1) % n]});
      corners += n;
      const DoublePoint a = point_of(mesh.positions, at[0]);
      const DoublePoint normal = cross(minus(point_of(mesh.positions, at[1]), a),
                                       minus(point_of(mesh.positions, at[2]), a));
      const uint32_t n0 = mesh.layouts.normals[face.layout_indices[0]];
      EXPECT_GT(dot(normal, point_of(mesh.normals, n0)), 0);
    }
    EXPECT_EQ(edges.size(), corners) << "an edge is walked twice in one direction";
    for (const auto& edge : edges) EXPECT_TRUE(edges.count({edge.second, edge.first}));
    for (size_t i = 0; i < mesh.normals.xs.count; ++i) {
      EXPECT_NEAR(dot(point_of(mesh.normals, i), point_of(mesh.normals, i)), 1, 1e-6);
    }
  }
}

TEST_P(EveryRig, SkinWeightsSumToOneWithJointsOfTheirLod) {
  const size_t lod_count = view.desc.lod_count;
  uint16_t most = 0;
  for (size_t m = 0; m < view.geom.meshes.count; ++m) {
    const dna::Mesh& mesh = view.geom.meshes[m];
    const Array<uint16_t> list = defn.lod_joints.at(m < lod_count ? m : lod_count - 1);
    std::set<uint16_t> joints;
    for (size_t i = 0; i < list.count; ++i) joints.insert(list[i]);
    ASSERT_EQ(mesh.skin_weights.count, mesh.positions.xs.count);
    for (const dna::VertexSkinWeights& skin : mesh.skin_weights) {
      ASSERT_EQ(skin.weights.count, skin.joint_indices.count);
      EXPECT_LE(skin.weights.count, mesh.maximum_influence_per_vertex);
      double sum = 0;
      std::set<uint16_t> used;
      for (size_t i = 0; i < skin.weights.count; ++i) {
        sum += skin.weights[i];
        EXPECT_GT(skin.weights[i], 0);
        EXPECT_TRUE(joints.count(skin.joint_indices[i]));
        used.insert(skin.joint_indices[i]);
      }
      EXPECT_NEAR(sum, 1, 1e-7);
      EXPECT_EQ(used.size(), skin.weights.count);
    }
    most = std::max(most, mesh.maximum_influence_per_vertex);
  }
  EXPECT_LE(most, 8);
  EXPECT_GE(most, 2);
}

TEST_P(EveryRig, LodZeroHasATargetForEachChannel) {
  const List<dna::BlendShapeTarget> targets = view.geom.meshes[0].blend_shape_targets;
  ASSERT_EQ(targets.count, defn.channel_names.count);
  for (uint32_t c = 0; c < targets.count; ++c) {
    EXPECT_EQ(targets[c].channel_index, c);
    EXPECT_GT(targets[c].vertex_indices.count, 0u);
    EXPECT_EQ(targets[c].deltas.xs.count, targets[c].vertex_indices.count);
  }
  EXPECT_EQ(view.geom.meshes[1].blend_shape_targets.count, defn.lod_channels.at(1).count);
  EXPECT_EQ(defn.mesh_channels.from.count,
            targets.count + view.geom.meshes[1].blend_shape_targets.count);
}

TEST_P(EveryRig, SameSeedSameBytesOtherSeedOthers) {
  const SyntheticPreset preset = std::get<0>(GetParam());
  const uint64_t seed = std::get<1>(GetParam());
  EXPECT_EQ(hash_of(Made(preset, seed).view), hash_of(view));
  EXPECT_NE(hash_of(Made(preset, seed + 1).view), hash_of(view));
}

INSTANTIATE_TEST_SUITE_P(Presets, EveryRig,
                         ::testing::Combine(::testing::ValuesIn(kPresets),
                                            ::testing::Values(0, 1, 12345678901234u)));

// Platforms ---------------------------------------------------------------------------------------

TEST(SyntheticRig, IsTheSameOnEveryPlatform) {
  const uint64_t expected[] = {0xBE3E2C63A2D11315u, 0x678B74B8CAEFD2F8u, 0xB942D4231C14653Bu,
                               0x92A28016EF652DEBu};
  for (size_t p = 0; p < 4; ++p) {
    EXPECT_EQ(hash_of(Made(kPresets[p], 7).view), expected[p])
        << "preset " << p << ": if the generator was meant to change, record the new number";
  }
  EXPECT_EQ(hash_of(Made(SyntheticPreset::kBody, 7).view), 0x9A60B076413D4029u);
  EXPECT_EQ(hash_of(Made(SyntheticPreset::kBody, 7, true).view), 0x59307BA9F00B38A8u);
  EXPECT_EQ(hash_of(Made(SyntheticPreset::kTiny, 7, true).view), 0x766992727F4A3E90u);
  EXPECT_EQ(hash_of(Made(SyntheticPreset::kMetaHumanHead, 7).view), 0xD74CFCEBC097A90Au);
}

TEST(SyntheticRig, WritesAsAFileOfProductionSize) {
  const uint64_t size = dna::encoded_size(rig_of(SyntheticPreset::kLarge, 0), {});
  EXPECT_GT(size, 8u << 20);
  EXPECT_LT(size, 16u << 20);
}

// Neutral pose ------------------------------------------------------------------------------------

/// Where a joint stands on the head, from the neutral values of its ancestors.
DoublePoint index_of(const dna::Definition& defn, uint16_t joint) {
  const double kPi = 3.14159265358979323846;
  DoublePoint at = {0, 0, 0};
  for (;; joint = defn.joint_hierarchy[joint]) {
    const DoublePoint t = point_of(defn.neutral_translations, joint);
    at = {at.x + t.x, at.y + t.y, at.z + t.z};
    const uint16_t parent = defn.joint_hierarchy[joint];
    if (parent == joint) return at;
    const DoublePoint degrees = point_of(defn.neutral_rotations, parent);
    const double angles[3] = {degrees.x * kPi / 180, degrees.y * kPi / 180, degrees.z * kPi / 180};
    double p[3] = {at.x, at.y, at.z};
    for (int axis = 0; axis < 3; ++axis) {  // about fixed axes, x first
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      const double c = std::cos(angles[axis]), s = std::sin(angles[axis]), old = p[a];
      p[a] = c * old - s * p[b];
      p[b] = s * old + c * p[b];
    }
    at = {p[0], p[1], p[2]};
  }
}

TEST_P(EveryRig, JointsStandOnTheHeadMirroredInSpiteOfTurnedParents) {
  size_t turned = 0, pairs = 0;
  for (uint16_t j = 0; j < defn.joint_names.count; ++j) {
    const std::string name = text(defn.joint_names[j]);
    turned += defn.neutral_rotations.xs[j] != 0 && defn.neutral_rotations.ys[j] != 0;
    const DoublePoint p = index_of(defn, j);
    EXPECT_LT(std::abs(p.x), 8.5) << name;
    EXPECT_LT(std::abs(p.y + 3.5), 16) << name;
    EXPECT_LT(std::abs(p.z), 10) << name;
    if (name.rfind("FACIAL_C_", 0) == 0) {
      EXPECT_NEAR(p.x, 0, 1e-5) << name;
    }
    if (name.rfind("FACIAL_L_", 0) != 0) continue;
    ASSERT_EQ(text(defn.joint_names[j + 1u]), "FACIAL_R_" + name.substr(9));
    const DoublePoint q = index_of(defn, static_cast<uint16_t>(j + 1));
    EXPECT_NEAR(p.x, -q.x, 1e-5) << name;
    EXPECT_NEAR(p.y, q.y, 1e-5) << name;
    EXPECT_NEAR(p.z, q.z, 1e-5) << name;
    EXPECT_GT(p.x, 0) << name;
    ++pairs;
  }
  EXPECT_GT(turned, 0u);
  EXPECT_GT(pairs, 0u);
}

// Memory ------------------------------------------------------------------------------------------

/// Gives `left` blocks, then none; keeps account.
struct MeanAllocator {
  size_t left = 0, given = 0, outstanding = 0;

  static void* allocate(void* user, size_t size, size_t alignment) {
    MeanAllocator& self = *static_cast<MeanAllocator*>(user);
    if (self.left == 0) return nullptr;
    --self.left;
    ++self.given;
    ++self.outstanding;
    return default_allocator().get(size, alignment);
  }
  static void release(void* user, void* block, size_t size, size_t alignment) {
    --static_cast<MeanAllocator*>(user)->outstanding;
    default_allocator().put(block, size, alignment);
  }
  Allocator allocator() { return {this, allocate, release}; }
};

TEST(SyntheticRig, ReportsThatMemoryRanOut) {
  std::vector<SyntheticPreset> presets(std::begin(kPresets), std::end(kPresets));
  presets.insert(presets.end(), {SyntheticPreset::kBody, SyntheticPreset::kMetaHumanHead,
                                 SyntheticPreset::kArchetype});
  for (SyntheticPreset preset : presets) {
    const bool learned = preset == SyntheticPreset::kBody;
    bool made = false;
    size_t n = 0;
    for (; !made; ++n) {
      MeanAllocator mean;
      mean.left = n;
      {
        Arena arena(mean.allocator());
        DnaView view;
        made = make_synthetic_rig(preset, 3, arena, view, learned);
        EXPECT_EQ(mean.given, n);
        EXPECT_EQ(view.loaded, made ? uint32_t{dna::kLayersAll} : 0u);
        const bool newest = preset <= SyntheticPreset::kBody;  // 2.5 has two layers less
        EXPECT_EQ(view.index.count, made ? dna::kLayerIdCount - (newest ? 0u : 2u) : 0u);
      }
      EXPECT_EQ(mean.outstanding, 0u);
      ASSERT_LT(n, 100u);
    }
    EXPECT_GT(n, 2u);
  }
}

/// An arena asks for few blocks, so only the requests that happen to end one can fail. Shifting all
/// of them by what is already in the arena lets others end it.
TEST(SyntheticRig, StopsWhereverMemoryRunsOut) {
  size_t refused = 0;
  for (size_t used = 0; used < 16 * 1024; used += 53) {
    const bool learned = used % 2 == 1;
    bool made = false;
    for (size_t blocks = 1; !made; ++blocks) {
      MeanAllocator mean;
      mean.left = blocks;
      {
        Arena arena(mean.allocator());
        ASSERT_NE(arena.allocate(used, 1), nullptr);
        DnaView view;
        made = make_synthetic_rig(SyntheticPreset::kTiny, 3, arena, view, learned);
        refused += !made;
      }
      ASSERT_EQ(mean.outstanding, 0u);
      ASSERT_LT(blocks, 20u);
    }
  }
  EXPECT_GT(refused, 600u);
}

}  // namespace
}  // namespace mien
