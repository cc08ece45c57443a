// SPDX-License-Identifier: MIT
// A file opened with some of its LODs evaluates to the bits of the whole file, and writing it gives
// a file of the same meaning.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "runtime/load/dna/convert/lod_selection.h"
#include "tests/support/lod_cuts.h"

namespace mien {
namespace {

/// Bits of a character by name. Things that only one of the two has do not count here.
std::map<std::string, std::vector<float>> by_name(const RigHandle& rig, uint32_t kind,
                                                  Span<const float> values, size_t width) {
  std::map<std::string, std::vector<float>> found;
  const std::vector<std::string> names = names_of(rig, kind);
  EXPECT_EQ(values.count, names.size() * width);
  for (size_t i = 0; i < names.size(); ++i) {
    const Span<const float> own = values.slice(i * width, width);
    EXPECT_TRUE(found.emplace(names[i], std::vector<float>(own.begin(), own.end())).second);
  }
  return found;
}

/// Joints represented by quaternions multiply their columns in an order that depends on the LODs
/// present, so their angles agree within 1e-4 degrees only.
std::set<std::string> quaternion_joints(const MienDna& dna) {
  std::set<std::string> names;
  const auto& joints = capi::object(&dna)->view.jbmd.joints;
  for (uint32_t j = 0; j < joints.count; ++j) {
    const dna::String& name = capi::object(&dna)->view.defn.joint_names[j];
    if (joints[j].rotation == 1) names.emplace(name.chars(), name.count);
  }
  return names;
}

testing::AssertionResult same_turns(const std::vector<float>& a, const std::vector<float>& b,
                                    double full_turn) {
  for (size_t i = 0; i < a.size(); ++i) {
    const bool angle = i >= 3 && i < 6;
    const double error = std::fabs(std::remainder(double{a[i]} - double{b[i]}, full_turn));
    if (angle ? error > 1e-4 * full_turn / 360 : a[i] != b[i]) {
      return testing::AssertionFailure() << "[" << i << "] " << a[i] << " and " << b[i];
    }
  }
  return testing::AssertionSuccess();
}

void expect_same(const RigHandle& whole, const RigHandle& cut, uint32_t kind,
                 Span<const float> expected, Span<const float> mine, size_t width,
                 const std::set<std::string>& turned = {}) {
  const double full_turn =
      info_of(whole).rotation_unit == MIEN_ROTATION_UNIT_DEGREES ? 360 : 6.283185307179586476925;
  const auto old = by_name(whole, kind, expected, width);
  const auto left = by_name(cut, kind, mine, width);
  for (const auto& [name, values] : left) {
    ASSERT_EQ(old.count(name), 1u) << name;
    if (turned.count(name)) {
      EXPECT_TRUE(same_turns(values, old.at(name), full_turn)) << name;
    } else {
      EXPECT_TRUE(same_bits(span_of(values), span_of(old.at(name)))) << name;
    }
  }
  for (const auto& [name, values] : old) {
    if (left.count(name)) continue;
    for (float value : values) EXPECT_EQ(value, 0) << name << " moves, but is gone";
  }
}

/// LOD l of the cut rig against LOD lods[l] of the whole one.
void expect_same_results(const MienDna& whole_dna, const std::vector<uint32_t>& lods,
                         const MienDna& cut_dna) {
  const RigHandle whole = create_rig(&whole_dna), cut = create_rig(&cut_dna);
  ASSERT_TRUE(whole && cut);
  ASSERT_EQ(info_of(cut).lod_count, lods.size());
  Character a(whole), b(cut);
  Random random = Random::from_seed(6, 1);
  for (uint32_t l = 0; l < lods.size(); ++l) {
    SCOPED_TRACE("LOD " + std::to_string(lods[l]));
    ASSERT_EQ(a.raw.count, b.raw.count);
    for (size_t i = 0; i < a.raw.count; ++i) {
      a.raw[i] = b.raw[i] = static_cast<float>(random.between(-0.3, 1.3));
    }
    a.evaluate(lods[l]);
    b.evaluate(l);
    EXPECT_TRUE(same_bits(a.controls, b.controls));
    expect_same(whole, cut, MIEN_KIND_JOINT, a.joints, b.joints, 9, quaternion_joints(whole_dna));
    expect_same(whole, cut, MIEN_KIND_BLEND_SHAPE_CHANNEL, a.channels, b.channels, 1);
    expect_same(whole, cut, MIEN_KIND_ANIMATED_MAP, a.maps, b.maps, 1);
  }
}

/// The cut file, written and read again.
void expect_round_trip(const MienDna& cut) {
  const Bytes bytes = write_dna(&cut);
  MienReport* report = nullptr;
  ASSERT_EQ(mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &report, nullptr),
            MIEN_OK);
  uint32_t errors = 0, warnings = 0;
  EXPECT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
  mien_report_destroy(report);
  EXPECT_EQ(errors, 0u);

  const DnaHandle again = open_dna(bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(write_dna(again.get()), bytes);
  std::vector<uint32_t> lods(capi::object(&cut)->view.desc.lod_count);
  for (uint32_t l = 0; l < lods.size(); ++l) lods[l] = l;
  expect_same_results(cut, lods, *again);
}

void expect_evaluation(const MienDna& whole, uint64_t mask, const MienDna& cut) {
  expect_same_results(whole, lods_of(mask), cut);
}
void expect_writing(const MienDna&, uint64_t, const MienDna& cut) { expect_round_trip(cut); }

TEST(LodSelectionResults, OfGeneratedRigs) { for_each_cut(generated_sources(), expect_evaluation); }

TEST(LodSelectionResults, OfGoldenFiles) { for_each_cut(golden_sources(), expect_evaluation); }

TEST(LodSelectionResults, GeneratedRigsCanBeWritten) {
  for_each_cut(generated_sources(), expect_writing);
}

TEST(LodSelectionResults, GoldenFilesCanBeWritten) {
  for_each_cut(golden_sources(), expect_writing);
}

}  // namespace
}  // namespace mien
