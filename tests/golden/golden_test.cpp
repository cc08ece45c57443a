// SPDX-License-Identifier: MIT
// The golden files, through the C interface: every file, every LOD, every instruction set present,
// both forms of rotations. Nothing is left out.
#include "tests/support/golden.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/support/rig_handles.h"

namespace mien::golden {
namespace {

// Order of the numbers in meta.counts and meta.tolerance.
enum { kGeneration, kVersion, kLods, kGui, kRaw, kPsd, kMl, kRbf, kJoints, kChannels, kMaps };
enum { kMasks = kMaps + 1, kFrames };
enum { kPsdTolerance, kMlTolerance, kRbfTolerance, kEulerTolerance, kQuaternionTolerance };
enum { kChannelTolerance = kQuaternionTolerance + 1, kMapTolerance };

constexpr double kRelative = 1e-5;
constexpr double kMappedRaw = 2e-6;  // raw controls of a GUI frame
constexpr double kHalf = 5e-4;       // 16-bit storage, of the largest value
constexpr double kHalfNetworks = 2e-3;

/// A file, its rig for one instruction set, and what the comparison has seen so far.
class Golden : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string name = GetParam();
    if (name == kHead && !has_head()) GTEST_SKIP() << no_head();
    ASSERT_EQ(parse(read_bytes(path_of(name, ".golden.bin")), file), "") << name;
    bytes = read_rig(name);
    counts = record("meta.counts").integers;
    tolerance = record("meta.tolerance").floats;
    ASSERT_EQ(counts.size(), size_t{kFrames} + 1);
    ASSERT_EQ(tolerance.size(), size_t{kMapTolerance} + 1);
    dna = open_dna(bytes);
    ASSERT_TRUE(dna);
  }

  const Record& record(const std::string& name) const {
    static const Record kNothing;
    const Record* found = file.find(name);
    EXPECT_TRUE(found) << "no record " << name;
    return found ? *found : kNothing;
  }
  Span<const float> row(const std::string& name, uint32_t frame) const {
    return record(name).row(frame);
  }
  bool is_gui_frame(uint32_t frame) const { return record("in.mode").integers[frame] == 0; }

  /// README, "How a frame is evaluated". The instance may have evaluated other frames before: raw
  /// controls that no GUI control drives keep what they hold, so those start anew.
  void run(Character& character, uint32_t frame, uint32_t lod) const {
    copy(row("in.mlMask", frame), character.masks);
    if (is_gui_frame(frame)) {
      MienFloatView initial;
      ASSERT_EQ(mien_rig_initial_raw_controls(character.rig, &initial), MIEN_OK);
      copy({initial.data, initial.count}, character.raw);
      copy(row("in.gui", frame), character.gui);
      character.map_gui_to_raw();
      for (uint32_t i : record("in.quatRaw").integers) {
        character.raw[i] = row("in.raw", frame)[i];
      }
    } else {
      copy(row("in.raw", frame), character.raw);
    }
    character.evaluate(lod);
  }

  static void copy(Span<const float> from, Span<float> to) {
    ASSERT_EQ(from.count, to.count);
    for (size_t i = 0; i < to.count; ++i) to[i] = from[i];
  }

  /// Arrays that the joint matrix or networks write may differ by `of_largest` of their largest
  /// value, if that is more.
  void compare(const Character& character, uint32_t frame, uint32_t lod, const MienRigInfo& info,
               double of_largest = kRelative) {
    const std::string at = "lod" + std::to_string(lod) + ".";
    const auto check = [&](const char* name, Span<const float> mine, double absolute,
                           double relative, Rotations rotations = Rotations::kNone) {
      const Rule rule = {absolute, relative, rotations};
      EXPECT_TRUE(matches(mine, row(at + name, frame), rule, worst[name]))
          << at << name << ", frame " << frame;
    };
    check("raw", character.raw, is_gui_frame(frame) ? kMappedRaw : 0, 0);
    check("psd", character.psd, tolerance[kPsdTolerance], of_largest);
    check("ml", character.ml, tolerance[kMlTolerance], of_largest);
    check("rbf", character.rbf, tolerance[kRbfTolerance], of_largest);
    if (info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION) {
      check("joints.quat", character.joints, tolerance[kQuaternionTolerance], of_largest,
            Rotations::kQuaternions);
    } else {
      check("joints.euler", character.joints, tolerance[kEulerTolerance], of_largest,
            info.rotation_unit == MIEN_ROTATION_UNIT_DEGREES ? Rotations::kDegrees
                                                             : Rotations::kRadians);
    }
    check("blendShapes", character.channels, tolerance[kChannelTolerance], of_largest);
    check("animatedMaps", character.maps, tolerance[kMapTolerance], of_largest);
  }

  /// The worst of each record, for those who read the log.
  void report() {
    std::printf("  %s\n", GetParam());
    for (const auto& [name, w] : worst) {
      std::printf("    %-13s worst error %.3g, %zu compared\n", name.c_str(), w.error, w.compared);
      char text[80];
      std::snprintf(text, sizeof(text), "worst %.3g compared %zu", w.error, w.compared);
      RecordProperty(name, text);
    }
  }

  File file;
  std::vector<uint8_t> bytes;
  std::vector<uint32_t> counts;
  std::vector<float> tolerance;
  DnaHandle dna;
  std::map<std::string, Worst> worst;
};

std::string name_of(const testing::TestParamInfo<const char*>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(Files, Golden, testing::ValuesIn(kNames), name_of);
INSTANTIATE_TEST_SUITE_P(Shared, Golden, testing::Values(kHead), name_of);

TEST_P(Golden, DnaIsTheOneThatWasEvaluated) {
  const std::vector<uint32_t> hash = record("meta.dnaFnv1a64").integers;
  ASSERT_EQ(hash.size(), 2u);
  EXPECT_EQ(fnv1a64(bytes), uint64_t{hash[1]} << 32 | hash[0]);
  EXPECT_EQ(bytes.size(), record("meta.dnaBytes").integers.at(0));

  const RigHandle rig = create_rig(dna.get());
  MienDnaInfo info = sized<MienDnaInfo>();
  ASSERT_EQ(mien_dna_info(dna.get(), &info), MIEN_OK);
  const uint32_t mine[] = {info.generation,         info.version,
                           info.lod_count,          info.gui_control_count,
                           info.raw_control_count,  info.psd_control_count,
                           info.ml_control_count,   info.rbf_control_count,
                           info.joint_count,        info.blend_shape_channel_count,
                           info.animated_map_count, count_of(rig, MIEN_KIND_ML_MASK)};
  EXPECT_EQ(std::vector<uint32_t>(std::begin(mine), std::end(mine)),
            std::vector<uint32_t>(counts.begin(), counts.begin() + kFrames));
}

TEST_P(Golden, FreshInstancesGiveTheExpectedOutputs) {
  for (uint32_t isa : present_isas()) {
    for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
      SCOPED_TRACE(mien_isa_name(isa));
      const RigHandle rig = create_rig(dna.get(), isa, MIEN_OK, rotation);
      ASSERT_TRUE(rig);
      const MienRigInfo info = info_of(rig);
      for (uint32_t lod = 0; lod < counts[kLods]; ++lod) {
        for (uint32_t frame = 0; frame < counts[kFrames]; ++frame) {
          Character character(rig);
          run(character, frame, lod);
          compare(character, frame, lod, info);
        }
      }
    }
  }
  report();
}

TEST_P(Golden, SixteenBitStorageIsClose) {
  for (uint32_t isa : present_isas()) {
    for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
      SCOPED_TRACE(mien_isa_name(isa));
      MienRigDesc desc = sized<MienRigDesc>();
      desc.isa = isa;
      desc.rotation_output = rotation;
      desc.storage = MIEN_STORAGE_16_BIT;
      const RigHandle rig = create_rig(dna.get(), desc);
      ASSERT_TRUE(rig);
      const MienRigInfo info = info_of(rig);
      const double of_largest = counts[kMl] > 0 ? kHalfNetworks : kHalf;
      for (uint32_t lod = 0; lod < counts[kLods]; ++lod) {
        for (uint32_t frame = 0; frame < counts[kFrames]; ++frame) {
          Character character(rig);
          run(character, frame, lod);
          compare(character, frame, lod, info, of_largest);
        }
      }
    }
  }
  report();
}

TEST_P(Golden, OneInstanceGivesTheBitsOfFreshOnes) {
  for (uint32_t isa : present_isas()) {
    SCOPED_TRACE(mien_isa_name(isa));
    const uint32_t rotation =
        isa % 2 ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
    const RigHandle rig = create_rig(dna.get(), isa, MIEN_OK, rotation);
    ASSERT_TRUE(rig);
    // All frames of a LOD, then a change of LOD with every frame.
    Character used(rig), jumping(rig);
    for (uint32_t lod = 0; lod < counts[kLods]; ++lod) {
      for (uint32_t frame = 0; frame < counts[kFrames]; ++frame) {
        Character fresh(rig);
        run(fresh, frame, lod);
        run(used, frame, lod);
        run(jumping, (frame + 1) % counts[kFrames], (lod + 1) % counts[kLods]);
        run(jumping, frame, lod);
        const std::vector<float> expected = fresh.results();
        EXPECT_TRUE(same_bits(span_of(used.results()), span_of(expected)))
            << "LOD " << lod << ", frame " << frame << " after the frame before";
        EXPECT_TRUE(same_bits(span_of(jumping.results()), span_of(expected)))
            << "LOD " << lod << ", frame " << frame << " after another LOD";
      }
    }
  }
}

TEST_P(Golden, NeutralPose) {
  for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
    const RigHandle rig = create_rig(dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK, rotation);
    MienFloatView neutral;
    ASSERT_EQ(mien_rig_neutral_joint_values(rig.get(), &neutral), MIEN_OK);
    const bool quaternions = rotation == MIEN_ROTATION_OUTPUT_QUATERNION;
    const Record& expected = record(quaternions ? "neutral.quat" : "neutral.euler");
    const Rule rule = {quaternions ? 1e-6 : 0, 0,
                       quaternions ? Rotations::kQuaternions : Rotations::kNone};
    Worst seen;
    EXPECT_TRUE(matches({neutral.data, neutral.count},
                        {expected.floats.data(), expected.floats.size()}, rule, seen));
  }
}

TEST_P(Golden, GuiControlsFromRawControls) {
  if (counts[kGui] == 0) return;
  const RigHandle rig = create_rig(dna.get());
  Worst seen;
  for (uint32_t frame = 0; frame < counts[kFrames]; ++frame) {
    if (!is_gui_frame(frame)) continue;
    Character character(rig);
    run(character, frame, 0);
    for (float& value : character.gui) value = 7;  // all of them have to be written
    character.map_raw_to_gui();
    EXPECT_TRUE(matches(character.gui, row("out.guiReverse", frame), {kMappedRaw, kRelative}, seen))
        << "frame " << frame;
  }
  EXPECT_GT(seen.compared, 0u);
}

TEST(GoldenFiles, AllAreTested) {
  std::set<std::string> present, tested;
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    const std::string name = entry.path().filename().string();
    const size_t end = name.find(".golden.bin");
    if (end != std::string::npos) present.insert(name.substr(0, end));
  }
  tested.insert(std::begin(kNames), std::end(kNames));
  EXPECT_EQ(present, tested);
}

// The comparison itself ---------------------------------------------------------------------------

TEST(GoldenFiles, DamagedFilesAreRefused) {
  std::vector<uint8_t> bytes = read_bytes(path_of("tiny_v21", ".golden.bin"));
  File file;
  ASSERT_EQ(parse(bytes, file), "");
  for (size_t size = 0; size < bytes.size(); size += size < 2000 ? 1 : 997) {
    EXPECT_NE(parse({bytes.begin(), bytes.begin() + size}, file), "") << size << " bytes";
  }
  bytes.push_back(0);
  EXPECT_NE(parse(bytes, file), "");
  bytes[0] = 'r';
  EXPECT_NE(parse(bytes, file), "");
}

TEST(GoldenFiles, ComparisonFollowsTheRule) {
  const std::vector<float> golden = {0, 100, 0, 359.9f, 0, 0, 1, 1, 1};
  Worst worst;
  const auto close = [&](std::vector<float> mine, const Rule& rule) {
    return bool(matches(span_of(mine), span_of(golden), rule, worst));
  };
  std::vector<float> mine = golden;
  EXPECT_TRUE(close(mine, {}));
  mine[0] = 0.5f;
  EXPECT_FALSE(close(mine, {0.4, 0}));
  EXPECT_TRUE(close(mine, {0.6, 0}));
  EXPECT_TRUE(close(mine, {0, 0.006}));  // of the largest value, 359.9
  EXPECT_FALSE(close(mine, {0, 0.001}));
  mine = golden;
  mine[3] = -0.1f;  // a full turn away
  EXPECT_FALSE(close(mine, {1e-3, 0}));
  EXPECT_TRUE(close(mine, {1e-3, 0, Rotations::kDegrees}));
  mine = golden;
  mine[1] = 460;  // a translation does not turn
  EXPECT_FALSE(close(mine, {1e-3, 0, Rotations::kDegrees}));
  mine[1] = NAN;
  EXPECT_FALSE(close(mine, {1000, 0}));
  EXPECT_FALSE(matches({golden.data(), 8}, span_of(golden), {}, worst));

  mine = golden;
  mine[2] = 3;
  mine[8] = 11;
  const std::string message = matches(span_of(mine), span_of(golden), {}, worst).message();
  EXPECT_EQ(message,
            "2 of 9 values differ by more than 0; first [2]: 3, expected 0, off by 3; worst [8]: "
            "11, expected 1, off by 10");
}

}  // namespace
}  // namespace mien::golden
