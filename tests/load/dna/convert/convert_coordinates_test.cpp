// SPDX-License-Identifier: MIT
// Rigs opened in another coordinate system: they move the same, in its numbers; they come back as
// they were; and what cannot follow is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/bytes.h"
#include "tests/support/golden.h"
#include "tests/support/layer_rig.h"
#include "tests/support/long_run.h"
#include "tests/support/other_system.h"
#include "tests/support/random_space_rig.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

MienCoordinateSystem named(const char* name) {
  MienCoordinateSystem system = sized<MienCoordinateSystem>();
  EXPECT_EQ(mien_coordinate_system_find(name, &system), MIEN_OK) << name;
  return system;
}

MienCoordinateSystem to_public(const CoordinateSystem& system) {
  MienCoordinateSystem out = sized<MienCoordinateSystem>();
  std::copy(system.axes, system.axes + 3, out.axes);
  std::copy(system.rotation_signs, system.rotation_signs + 3, out.rotation_signs);
  out.translation_unit = system.translation_unit;
  out.rotation_unit = system.rotation_unit;
  out.rotation_rule = static_cast<uint32_t>(system.rotation_rule);
  out.rotation_sequence = system.rotation_sequence;
  out.face_winding = system.face_winding;
  return out;
}

std::vector<const char*> all_names() {
  std::vector<const char*> names;
  MienStringView name;
  for (uint32_t i = 0; mien_coordinate_system_name(i, &name) == MIEN_OK; ++i) {
    names.push_back(name.data);
  }
  return names;
}

// The same movements ---------------------------------------------------------------------------

double difference(const Mat3& a, const Mat3& b) {
  double most = 0;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) most = std::max(most, std::fabs(a.m[r][c] - b.m[r][c]));
  }
  return most;
}

struct Tolerance {
  double length = 2e-5, rotation = 2e-5, number = 2e-5;
};

/// Two rigs of the same file, one converted, side by side.
class Pair {
 public:
  Pair(const MienDna* original, const MienDna* converted, uint32_t rotation)
      : change_(original, converted),
        view_(capi::object(original)->view), rigs_{create_rig(original, MIEN_ISA_ENVIRONMENT,
                                                              MIEN_OK, rotation),
                                                   create_rig(converted, MIEN_ISA_ENVIRONMENT,
                                                              MIEN_OK, rotation)},
        quaternions_(rotation == MIEN_ROTATION_OUTPUT_QUATERNION),
        inputs_(quaternion_inputs(view_)) {}

  bool made() const { return rigs_[0] && rigs_[1]; }

  /// Values in -1 ... 1; quaternions of unit length.
  void set_random(Random& random) {
    raw_.resize(view_.defn.raw_control_names.count);
    for (float& value : raw_) value = static_cast<float>(random.between(-0.2, 1));
    for (const std::vector<uint16_t>& four : inputs_) {
      double q[4], length = 0;
      for (double& part : q) {
        part = random.normal();
        length += part * part;
      }
      for (int i = 0; i < 4; ++i) raw_[four[i]] = static_cast<float>(q[i] / std::sqrt(length));
    }
  }
  std::vector<float>& raw() { return raw_; }

  void compare(uint32_t lod, const Tolerance& tolerance, bool sums_follow = true) {
    Character one(rigs_[0]), other(rigs_[1]);
    std::copy(raw_.begin(), raw_.end(), one.raw.begin());
    std::vector<float> turned = raw_;
    for (const std::vector<uint16_t>& four : inputs_) {
      float q[4] = {raw_[four[0]], raw_[four[1]], raw_[four[2]], raw_[four[3]]};
      change_.quaternion(q);
      for (int i = 0; i < 4; ++i) turned[four[i]] = q[i];
    }
    std::copy(turned.begin(), turned.end(), other.raw.begin());
    for (int frame = 0; frame < 2; ++frame) {  // the second one starts where the first one ended
      one.evaluate(lod);
      other.evaluate(lod);
    }
    compare_numbers("corrective", one.psd, other.psd, tolerance.number);
    compare_numbers("pose control", one.rbf, other.rbf, tolerance.number);
    compare_numbers("channel", one.channels, other.channels, tolerance.number);
    compare_numbers("map", one.maps, other.maps, tolerance.number);
    const size_t width = quaternions_ ? 10 : 9;
    MienFloatView neutral[2];
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(mien_rig_neutral_joint_values(rigs_[i].get(), &neutral[i]), MIEN_OK);
    }
    for (size_t j = 0; j * width < one.joints.count; ++j) {
      SCOPED_TRACE("joint " + std::to_string(j));
      const float zeros[10] = {};
      compare_joint(neutral[0].data + j * width, neutral[1].data + j * width, zeros, zeros,
                    tolerance);
      compare_joint(one.joints.data + j * width, other.joints.data + j * width, zeros, zeros,
                    tolerance);
      if (quaternions_ || !sums_follow) continue;
      compare_joint(one.joints.data + j * width, other.joints.data + j * width,
                    neutral[0].data + j * width, neutral[1].data + j * width, tolerance);
    }
  }

 private:
  static void compare_numbers(const char* what, Span<const float> a, Span<const float> b,
                              double tolerance) {
    ASSERT_EQ(a.count, b.count);
    double largest = 1;
    for (float value : a) largest = std::max(largest, std::fabs(double{value}));
    for (size_t i = 0; i < a.count; ++i) {
      EXPECT_NEAR(a[i], b[i], tolerance * largest) << what << " " << i;
    }
  }

  /// a and b are deltas of a joint, on top of what is added to them.
  void compare_joint(const float* a, const float* b, const float* under_a, const float* under_b,
                     const Tolerance& tolerance) {
    double moved[3], expected[3];
    for (int i = 0; i < 3; ++i) moved[i] = double{a[i]} + double{under_a[i]};
    change_.vector(moved, expected);
    const double large =
        1 + std::fabs(expected[0]) + std::fabs(expected[1]) + std::fabs(expected[2]);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(double{b[i]} + double{under_b[i]}, expected[i], tolerance.length * large)
          << "translation " << i;
    }
    if (quaternions_) {
      const Mat3 turned = change_.rotation(rotation_of_quaternion(a + 3));
      EXPECT_LE(difference(turned, rotation_of_quaternion(b + 3)), tolerance.rotation);
    } else {
      double angles[2][3];
      for (int i = 0; i < 3; ++i) {
        angles[0][i] = double{a[3 + i]} + double{under_a[3 + i]};
        angles[1][i] = double{b[3 + i]} + double{under_b[3 + i]};
      }
      const Mat3 turned = change_.rotation(change_.from.rotation(angles[0]));
      EXPECT_LE(difference(turned, change_.to.rotation(angles[1])), tolerance.rotation);
    }
    const float* scale_a = a + (quaternions_ ? 7 : 6);
    const float* scale_b = b + (quaternions_ ? 7 : 6);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (change_.change.m[r][c] == 0) continue;
        EXPECT_NEAR(scale_a[r], scale_b[c], tolerance.number) << "scale " << c;
      }
    }
  }

  SpaceChange change_;
  const dna::DnaView& view_;
  RigHandle rigs_[2];
  bool quaternions_;
  std::set<std::vector<uint16_t>> inputs_;
  std::vector<float> raw_;
};

void expect_same_movements(const MienDna* original, const MienDna* converted, Random& random,
                           uint32_t frames, const Tolerance& tolerance = {},
                           bool sums_follow = true) {
  for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
    SCOPED_TRACE(rotation == MIEN_ROTATION_OUTPUT_EULER ? "Euler angles" : "quaternions");
    Pair pair(original, converted, rotation);
    ASSERT_TRUE(pair.made());
    for (uint32_t frame = 0; frame < frames; ++frame) {
      SCOPED_TRACE("frame " + std::to_string(frame));
      pair.set_random(random);
      for (uint32_t lod = 0; lod < capi::object(original)->view.desc.lod_count; ++lod) {
        SCOPED_TRACE("LOD " + std::to_string(lod));
        pair.compare(lod, tolerance, sums_follow);
      }
      if (testing::Test::HasFailure()) return;
    }
  }
}

Bytes random_file(Random& random, const dna::SpaceRigOptions& options) {
  Arena arena(default_allocator());
  return write_view(dna::random_space_rig(random, options, arena));
}

/// A last layer of tanh does not let units through; random rigs end in a linear one.
TEST(CoordinateConversion, RandomRigsMoveTheSame) {
  Random random = Random::from_seed(5, 1);
  uint32_t mirrored = 0, permuted = 0;
  for (uint32_t round = 0; round < 300; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Bytes bytes = random_file(random, {});
    const DnaHandle original = open_dna(bytes);
    ASSERT_TRUE(original);
    CoordinateSystem target = dna::random_system(random);
    if (random.chance(0.3)) std::fill(target.rotation_signs, target.rotation_signs + 3, 0);
    const DnaHandle converted = open_in_system(bytes, to_public(target));
    ASSERT_TRUE(converted);
    const SpaceChange change(original.get(), converted.get());
    mirrored += change.determinant() < 0;
    permuted += change.change.m[0][0] == 0;
    EXPECT_EQ(change.to.winding, target.face_winding);
    expect_same_movements(original.get(), converted.get(), random, 2);
    if (HasFailure()) return;
  }
  EXPECT_GT(mirrored, 50u);
  EXPECT_GT(permuted, 50u);
}

// Rotations follow into another order where there are no sums of Euler angles.
TEST(CoordinateConversion, QuaternionJointsFollowIntoAnyOrder) {
  Random random = Random::from_seed(5, 2);
  dna::SpaceRigOptions options;
  options.euler_rows = false;
  for (uint32_t round = 0; round < 150; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Bytes bytes = random_file(random, options);
    const DnaHandle original = open_dna(bytes);
    CoordinateSystem target = dna::random_system(random);
    target.rotation_rule = RotationRule::kExact;
    const DnaHandle converted = open_in_system(bytes, to_public(target));
    ASSERT_TRUE(converted);
    EXPECT_EQ(converted->view.dsce.rotation_sequence, target.rotation_sequence);
    expect_same_movements(original.get(), converted.get(), random, 2, {}, false);
    if (HasFailure()) return;
  }
}

// Column by column: right while one control is 1, and quaternion joints for any.
TEST(CoordinateConversion, ColumnsFollowIntoAnyOrder) {
  Random random = Random::from_seed(5, 3);
  dna::SpaceRigOptions options;
  options.networks = false;
  uint32_t changed = 0;
  for (uint32_t round = 0; round < 150; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Bytes bytes = random_file(random, options);
    const DnaHandle original = open_dna(bytes);
    CoordinateSystem target = dna::random_system(random);
    target.rotation_rule = RotationRule::kPerColumn;
    const DnaHandle converted = open_in_system(bytes, to_public(target));
    ASSERT_TRUE(converted);
    for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
      Pair pair(original.get(), converted.get(), rotation);
      ASSERT_TRUE(pair.made());
      for (uint32_t control = 0; control < dna::kSpaceRigPlainControls; ++control) {
        pair.raw().assign(original->view.defn.raw_control_names.count, 0.0f);
        for (uint32_t q = 0; q < dna::kSpaceRigQuaternions; ++q) {
          pair.raw()[dna::kSpaceRigPlainControls + 4 * q] = 1e-30f;  // silent, but not zero
        }
        pair.raw()[control] = 1;
        Character probe(create_rig(original.get()));
        std::copy(pair.raw().begin(), pair.raw().end(), probe.raw.begin());
        probe.evaluate(0);
        bool alone = true;
        for (float value : probe.rbf) alone &= value == 0;
        if (!alone) continue;
        ++changed;
        pair.compare(0, {}, false);
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(changed, 100u);
}

// Each direction by itself, with nothing else changed, is another system.
TEST(CoordinateConversion, OneAxisMirrored) {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));
  const DnaHandle original = open_dna(bytes);
  for (int axis = 0; axis < 3; ++axis) {
    MienCoordinateSystem system = system_of(original.get());
    system.axes[axis] ^= 1;
    const DnaHandle converted = open_in_system(bytes, system);
    ASSERT_TRUE(converted);
    EXPECT_EQ(system_of(converted.get()).axes[axis], system.axes[axis]);
    const dna::Vec3Array &before = original->view.geom.meshes[0].positions,
                         &after = converted->view.geom.meshes[0].positions;
    const dna::Array<float> from[3] = {before.xs, before.ys, before.zs};
    const dna::Array<float> to[3] = {after.xs, after.ys, after.zs};
    for (int a = 0; a < 3; ++a) {
      for (uint32_t v = 0; v < from[a].count; ++v) {
        EXPECT_EQ(to[a][v], a == axis ? -from[a][v] : from[a][v]) << axis << ", vertex " << v;
      }
    }
  }
}

// A third row is added where a column turns about two axes, not where two columns turn about one each.
TEST(CoordinateConversion, RowsAreAddedWhereTheyAreNotZero) {
  LayerRig rig;
  rig.base.raw_count = 2;
  rig.base.joint_count = 1;
  const auto rows_of = [&](const std::vector<uint16_t>& outputs, const std::vector<float>& values) {
    rig.base.groups = {{{static_cast<uint16_t>(outputs.size())}, {0, 1}, outputs, values}};
    const LayerFile file(rig);
    MienCoordinateSystem reordered = system_of(file.dna.get());
    reordered.rotation_sequence = MIEN_ROTATION_SEQUENCE_YXZ;
    reordered.rotation_rule = MIEN_ROTATION_RULE_PER_COLUMN;
    const DnaHandle dna = open_in_system(file.bytes, reordered);
    return dna ? dna->view.bhvr.joints.groups[0].output_indices.count : 0;
  };
  EXPECT_EQ(rows_of({3, 4, 0}, {0, 10, 10, 0, 5, 5}), 3u);
  EXPECT_EQ(rows_of({3, 4, 0}, {10, 0, 10, 0, 5, 5}), 4u);
  rig.base.joint_count = 2;  // whose rows come in any order
  EXPECT_EQ(rows_of({12, 13, 3, 4}, {10, 0, 10, 0, 10, 0, 10, 0}), 6u);
}

TEST(CoordinateConversion, GeneratedRigsMoveTheSameInEveryNamedSystem) {
  Random random = Random::from_seed(5, 4);
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL}) {
    const Bytes bytes = write_dna(generate_dna(preset, 3).get());
    const DnaHandle original = open_dna(bytes);
    for (const char* name : all_names()) {
      SCOPED_TRACE(name);
      const DnaHandle converted = open_in_system(bytes, named(name));
      ASSERT_TRUE(converted);
      expect_same_movements(original.get(), converted.get(), random, 1);
    }
  }
}

TEST(CoordinateConversion, AGeneratedBodyMovesTheSame) {
  Random random = Random::from_seed(5, 6);
  const Bytes bytes = write_dna(generate_dna(MIEN_PRESET_BODY, 3, MIEN_GENERATE_ML).get());
  const DnaHandle original = open_dna(bytes);
  for (const char* name : {"unreal", "unity", "blender", "opengl"}) {
    SCOPED_TRACE(name);
    const DnaHandle converted = open_in_system(bytes, named(name));
    ASSERT_TRUE(converted);
    // Distances of rotations lose half of their digits where rotations are nearly equal.
    expect_same_movements(original.get(), converted.get(), random, 2, {1e-3, 1e-3, 2e-3});
  }
}

constexpr const char* kGolden[] = {"tiny",      "tiny_v21", "tiny_v24", "small",
                                   "small_rot", "body",     "ml",       "ml_ext"};

TEST(CoordinateConversion, GoldenRigsMoveTheSame) {
  Random random = Random::from_seed(5, 5);
  for (const char* file : kGolden) {
    SCOPED_TRACE(file);
    const Bytes bytes = golden::read_rig(file);
    const DnaHandle original = open_dna(bytes);
    ASSERT_TRUE(original);
    for (const char* name : {"unreal", "unity", "blender", "opengl"}) {
      SCOPED_TRACE(name);
      const DnaHandle converted = open_in_system(bytes, named(name));
      ASSERT_TRUE(converted);
      // Distances of rotations lose half of their digits where rotations are nearly equal.
      expect_same_movements(original.get(), converted.get(), random, 2, {1e-3, 1e-3, 2e-3});
    }
  }
}

// The converted rig gives the golden results, turned into its axes. The networks of this one give scales
// below 0.
TEST(CoordinateConversion, GoldenMlExtGivesItsResultsInOtherSystems) {
  golden::File golden;
  ASSERT_EQ(golden::parse(golden::read_bytes(golden::path_of("ml_ext", ".golden.bin")), golden),
            "");
  const Bytes bytes = golden::read_rig("ml_ext");
  const DnaHandle original = open_dna(bytes);
  const size_t width = 10, joints = original->view.defn.joint_names.count;
  const golden::Record &raw = *golden.find("in.raw"), &mode = *golden.find("in.mode"),
                       &masks = *golden.find("in.mlMask"),
                       &expected = *golden.find("lod0.joints.quat");
  uint32_t negative_scales = 0;
  for (const char* name : all_names()) {
    SCOPED_TRACE(name);
    const DnaHandle converted = open_in_system(bytes, named(name));
    ASSERT_TRUE(converted);
    const SpaceChange change(original.get(), converted.get());
    const RigHandle rig =
        create_rig(converted.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK, MIEN_ROTATION_OUTPUT_QUATERNION);
    for (uint32_t frame = 0; frame < mode.integers.size(); ++frame) {
      if (mode.integers[frame] == 0) continue;
      Character character(rig);
      const Span<const float> row = raw.row(frame), mask = masks.row(frame);
      std::copy(row.begin(), row.end(), character.raw.begin());
      std::copy(mask.begin(), mask.end(), character.masks.begin());
      character.evaluate(0);
      for (size_t j = 0; j < joints; ++j) {
        const float* from = expected.row(frame).data + j * width;
        const float* to = character.joints.data + j * width;
        const double old[3] = {from[0], from[1], from[2]};
        double moved[3];
        change.vector(old, moved);
        for (int i = 0; i < 3; ++i) {
          ASSERT_NEAR(to[i], moved[i], 1e-4 * (1 + std::fabs(moved[i]))) << "joint " << j;
        }
        EXPECT_LE(difference(change.rotation(rotation_of_quaternion(from + 3)),
                             rotation_of_quaternion(to + 3)),
                  1e-4);
        for (int r = 0; r < 3; ++r) {
          negative_scales += from[7 + r] < -0.01f;
          for (int c = 0; c < 3; ++c) {
            if (change.change.m[r][c] == 0) continue;
            EXPECT_NEAR(from[7 + r], to[7 + c], 1e-4) << "joint " << j;
          }
        }
      }
    }
  }
  EXPECT_GT(negative_scales, 1000u);
}

// There and back -------------------------------------------------------------------------------

/// Written as 2.8, so that files of older versions can be compared.
Bytes as_latest(const MienDna* dna) {
  MienWriteDesc desc = sized<MienWriteDesc>();
  desc.version = 8;
  size_t size = 0;
  EXPECT_EQ(mien_dna_write_memory(dna, &desc, nullptr, 0, &size, nullptr), MIEN_OK);
  Bytes bytes(size);
  EXPECT_EQ(mien_dna_write_memory(dna, &desc, bytes.data(), size, &size, nullptr), MIEN_OK);
  return bytes;
}

void expect_same_bytes(const Bytes& mine, const Bytes& expected) {
  ASSERT_EQ(mine.size(), expected.size());
  const auto apart = std::mismatch(mine.begin(), mine.end(), expected.begin());
  EXPECT_TRUE(apart.first == mine.end()) << "at byte " << apart.first - mine.begin();
}

void expect_exact_return(const Bytes& bytes, MienCoordinateSystem system) {
  const DnaHandle original = open_dna(bytes);
  ASSERT_TRUE(original);
  const MienCoordinateSystem own = system_of(original.get());
  system.translation_unit = own.translation_unit;
  system.rotation_unit = own.rotation_unit;
  const DnaHandle there = open_in_system(bytes, system);
  ASSERT_TRUE(there);
  const Bytes between = write_dna(there.get());
  const DnaHandle back = open_in_system(between, own);
  ASSERT_TRUE(back);
  expect_same_bytes(as_latest(back.get()), as_latest(original.get()));
}

TEST(CoordinateConversion, AxesAndSignsReturnExactly) {
  for (uint32_t preset = MIEN_PRESET_TINY; preset <= largest_preset(); ++preset) {
    const Bytes bytes = write_dna(generate_dna(preset, 3).get());
    for (const char* name : {"unreal", "unity", "opengl"}) expect_exact_return(bytes, named(name));
  }
  for (const char* name : {"unreal", "unity", "opengl"}) {
    const DnaHandle body = generate_dna(MIEN_PRESET_BODY, 3, MIEN_GENERATE_ML);
    expect_exact_return(write_dna(body.get()), named(name));
  }
  Random random = Random::from_seed(6, 1);
  for (uint32_t round = 0; round < 200; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Bytes bytes = random_file(random, {});
    expect_exact_return(bytes, to_public(dna::random_system(random)));
    if (HasFailure()) return;
  }
  Arena arena(default_allocator());
  expect_exact_return(write_view(dna::tiny_rig(arena)), named("unreal"));
}

TEST(CoordinateConversion, GoldenRigsReturnExactly) {
  for (const char* file : kGolden) {
    SCOPED_TRACE(file);
    const Bytes bytes = golden::read_rig(file);
    for (const char* name : all_names()) {
      SCOPED_TRACE(name);
      expect_exact_return(bytes, named(name));
    }
  }
}

// A file whose networks give scales in another system: magnitudes, whatever it is converted to, the
// networks' system included, and after it was written and read.
TEST(CoordinateConversion, MagnitudesOfScalesStayMagnitudes) {
  Arena arena(default_allocator());
  const Bytes plain = golden::read_rig("ml_ext");
  const DnaHandle dna = open_dna(plain);
  dna::DnaView view = dna->view;
  dna::MlJoints& joints = view.mlbe.joints;
  // As of Unreal, where the rig is as of Maya.
  joints.parameter_keys = dna::be<uint16_t>(arena, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  joints.parameter_values = dna::be<uint16_t>(arena, {0, 1, 0, 4, 1, 2, 65535, 65535, 1, 0});
  const Bytes bytes = write_view(view);
  const DnaHandle original = open_dna(bytes);
  ASSERT_TRUE(original);
  Random random = Random::from_seed(5, 7);
  for (const char* name : {"unreal", "unity", "gltf"}) {
    SCOPED_TRACE(name);
    const DnaHandle converted = open_in_system(bytes, named(name));
    ASSERT_TRUE(converted);
    expect_same_movements(original.get(), converted.get(), random, 2, {1e-3, 1e-3, 2e-3});
    const Bytes written = write_dna(converted.get());
    expect_same_movements(original.get(), open_dna(written).get(), random, 1, {1e-3, 1e-3, 2e-3});
  }
  expect_exact_return(bytes, named("unreal"));
}

/// All floats of a file that were changed and changed back.
void expect_near_return(const Bytes& bytes, const MienCoordinateSystem& system) {
  const DnaHandle original = open_dna(bytes);
  const DnaHandle there = open_in_system(bytes, system);
  ASSERT_TRUE(there);
  const Bytes between = write_dna(there.get());
  const DnaHandle back = open_in_system(between, system_of(original.get()));
  ASSERT_TRUE(back);
  const Bytes a = as_latest(original.get()), b = as_latest(back.get());
  ASSERT_EQ(a.size(), b.size());
  const auto near = [](const dna::Array<float>& x, const dna::Array<float>& y) {
    ASSERT_EQ(x.count, y.count);
    for (uint32_t i = 0; i < x.count; ++i) EXPECT_NEAR(x[i], y[i], 2.4e-7 * std::fabs(x[i]));
  };
  const dna::DnaView &v = original->view, &w = back->view;
  near(v.defn.neutral_translations.xs, w.defn.neutral_translations.xs);
  near(v.defn.neutral_rotations.zs, w.defn.neutral_rotations.zs);
  for (uint32_t g = 0; g < v.bhvr.joints.groups.count; ++g) {
    near(v.bhvr.joints.groups[g].values, w.bhvr.joints.groups[g].values);
  }
  for (uint32_t m = 0; m < v.geom.meshes.count; ++m) {
    near(v.geom.meshes[m].positions.ys, w.geom.meshes[m].positions.ys);
  }
}

TEST(CoordinateConversion, UnitsReturnWithinRounding) {
  expect_near_return(write_dna(generate_dna(MIEN_PRESET_SMALL, 3).get()), named("godot"));
  Random random = Random::from_seed(6, 2);
  for (uint32_t round = 0; round < 20; ++round) {
    expect_near_return(random_file(random, {}), to_public(dna::random_system(random)));
  }
}

TEST(CoordinateConversion, TheOwnSystemChangesNothing) {
  Random random = Random::from_seed(6, 3);
  for (uint32_t round = 0; round < 20; ++round) {
    const Bytes bytes = random_file(random, {});
    const DnaHandle original = open_dna(bytes);
    MienCoordinateSystem own = system_of(original.get());
    for (uint32_t rule :
         {MIEN_ROTATION_RULE_CARRIED, MIEN_ROTATION_RULE_EXACT, MIEN_ROTATION_RULE_PER_COLUMN}) {
      own.rotation_rule = rule;
      const DnaHandle same = open_in_system(bytes, own);
      ASSERT_TRUE(same);
      expect_same_bytes(write_dna(same.get()), bytes);
      MienDnaInfo infos[2] = {sized<MienDnaInfo>(), sized<MienDnaInfo>()};
      EXPECT_EQ(mien_dna_info(original.get(), &infos[0]), MIEN_OK);
      EXPECT_EQ(mien_dna_info(same.get(), &infos[1]), MIEN_OK);
      EXPECT_EQ(infos[0].memory_bytes, infos[1].memory_bytes);
    }
  }
}

// What is stated ---------------------------------------------------------------------------------

TEST(CoordinateConversion, WrittenFilesAreValidAndStateTheSystem) {
  Random random = Random::from_seed(6, 4);
  for (uint32_t round = 0; round < 30; ++round) {
    const Bytes bytes = random_file(random, {});
    const MienCoordinateSystem target = to_public(dna::random_system(random));
    const Bytes written = write_dna(open_in_system(bytes, target).get());
    MienReport* report = nullptr;
    ASSERT_EQ(mien_dna_validate_memory(written.data(), written.size(), nullptr, &report, nullptr),
              MIEN_OK);
    uint32_t errors = 1, warnings = 0;
    EXPECT_EQ(mien_report_counts(report, &errors, &warnings), MIEN_OK);
    EXPECT_EQ(errors, 0u);
    mien_report_destroy(report);
    const MienCoordinateSystem now = system_of(open_dna(written).get());
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(now.axes[i], target.axes[i]);
      EXPECT_EQ(now.rotation_signs[i], target.rotation_signs[i]);
    }
    EXPECT_EQ(now.translation_unit, target.translation_unit);
    EXPECT_EQ(now.rotation_unit, target.rotation_unit);
    EXPECT_EQ(now.face_winding, target.face_winding);
  }
}

// 2.1 to 2.6 have no place for rotation sequences, 2.7 none for winding; no more is raised.
TEST(CoordinateConversion, TheVersionIsRaisedOnlyIfItHasTo) {
  Arena arena(default_allocator());
  dna::DnaView tiny = dna::tiny_rig(arena);
  tiny.desc.coordinate_system = {0, 2, 4};
  tiny.twsw = {};  // 2.1 has no controls beyond its own
  tiny.bhvr.joints.groups[1].input_indices = dna::be<uint16_t>(arena, {0, 4, 2});
  const Bytes latest = write_view(tiny);
  for (uint32_t version = 1; version <= 8; ++version) {
    MienWriteDesc desc = sized<MienWriteDesc>();
    desc.version = version;
    const DnaHandle dna = open_dna(latest);
    size_t size = 0;
    ASSERT_EQ(mien_dna_write_memory(dna.get(), &desc, nullptr, 0, &size, nullptr), MIEN_OK);
    Bytes bytes(size);
    EXPECT_EQ(mien_dna_write_memory(dna.get(), &desc, bytes.data(), size, &size, nullptr), MIEN_OK);
    const auto version_in = [&](const MienCoordinateSystem& system) {
      MienDnaInfo info = sized<MienDnaInfo>();
      const Bytes written = write_dna(open_in_system(bytes, system).get());
      const DnaHandle converted = open_dna(written);
      EXPECT_EQ(mien_dna_info(converted.get(), &info), MIEN_OK);
      EXPECT_EQ(info.axes[0], system.axes[0]);
      return info.version;
    };
    EXPECT_EQ(version_in(named("gltf")), version);
    MienCoordinateSystem blender = named("blender");  // xzy, once carried
    EXPECT_EQ(version_in(blender), version < 7 ? 8 : version);
    EXPECT_EQ(version_in(named("godot")), 8u);  // clockwise
  }
}

TEST(CoordinateConversion, NamedSystems) {
  const std::vector<const char*> names = all_names();
  EXPECT_EQ(names.size(), kNamedSystemCount);
  const std::set<std::string> left_handed = {"unreal", "unreal-mesh", "unity", "directx"};
  for (const char* name : names) {
    SCOPED_TRACE(name);
    const MienCoordinateSystem system = named(name);
    const auto direction = [&](int axis) { return system.axes[axis] / 2; };
    EXPECT_EQ((1 << direction(0)) | (1 << direction(1)) | (1 << direction(2)), 7);
    // Left, up, front is right-handed; each exchange and each reversal changes hands.
    int hand = 1;
    for (int i = 0; i < 3; ++i) hand *= system.axes[i] % 2 ? -1 : 1;
    if ((direction(0) + 1) % 3 != direction(1)) hand = -hand;
    EXPECT_EQ(hand < 0, left_handed.count(name) == 1);
  }
  MienCoordinateSystem system = sized<MienCoordinateSystem>();
  EXPECT_EQ(mien_coordinate_system_find("softimage", &system), MIEN_ERROR_NAME);
  EXPECT_EQ(system.axes[1], 0u);
  EXPECT_EQ(mien_coordinate_system_find_n("unity", 4, &system), MIEN_ERROR_NAME);
  EXPECT_EQ(mien_coordinate_system_find_n("unity5", 5, &system), MIEN_OK);
  EXPECT_EQ(mien_coordinate_system_find(nullptr, &system), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_coordinate_system_find_n(nullptr, 0, &system), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_coordinate_system_find("unity", nullptr), MIEN_ERROR_NULL_ARGUMENT);
  system.struct_size = 8;
  EXPECT_EQ(mien_coordinate_system_find("unity", &system), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(mien_coordinate_system_name(0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  MienStringView name;
  EXPECT_EQ(mien_coordinate_system_name(1000, &name), MIEN_ERROR_INDEX);
}

// What the engines say of themselves, by the numbers of a point in front of the character, above
// and to its left.
TEST(CoordinateConversion, PointsOfNamedSystems) {
  Arena arena(default_allocator());
  dna::DnaView tiny = dna::tiny_rig(arena);
  tiny.desc.coordinate_system = {0, 2, 4};  // left, up, front, in centimeters
  tiny.defn.neutral_translations = {dna::be<float>(arena, {100, 0, 0}),
                                    dna::be<float>(arena, {200, 0, 0}),
                                    dna::be<float>(arena, {300, 0, 0})};
  const Bytes bytes = write_view(tiny);
  const struct {
    const char* name;
    float point[3];
  } expected[] = {
      {"maya", {100, 200, 300}}, {"unreal", {300, -100, 200}}, {"unreal-mesh", {100, 300, 200}},
      {"unity", {-1, 2, 3}},     {"godot", {1, 2, 3}},         {"blender", {1, -3, 2}},
      {"gltf", {1, 2, 3}},       {"opengl", {-1, 2, -3}},      {"directx", {-1, 2, 3}},
      {"houdini", {1, 2, 3}},
  };
  EXPECT_EQ(std::size(expected), kNamedSystemCount);
  for (const auto& [name, point] : expected) {
    SCOPED_TRACE(name);
    const DnaHandle dna = open_in_system(bytes, named(name));
    const dna::Vec3Array& translations = dna->view.defn.neutral_translations;
    EXPECT_EQ(translations.xs[0], point[0]);
    EXPECT_EQ(translations.ys[0], point[1]);
    EXPECT_EQ(translations.zs[0], point[2]);
  }
}

// Geometry ---------------------------------------------------------------------------------------

TEST(CoordinateConversion, GeometryFollows) {
  Random random = Random::from_seed(6, 5);
  for (uint32_t round = 0; round < 100; ++round) {
    const Bytes bytes = random_file(random, {});
    const DnaHandle original = open_dna(bytes);
    const DnaHandle converted = open_in_system(bytes, to_public(dna::random_system(random)));
    const SpaceChange change(original.get(), converted.get());
    const dna::Mesh &a = original->view.geom.meshes[0], &b = converted->view.geom.meshes[0];
    const auto expect_turned = [&](const dna::Vec3Array& x, const dna::Vec3Array& y, double unit) {
      ASSERT_EQ(x.xs.count, y.zs.count);
      for (uint32_t i = 0; i < x.xs.count; ++i) {
        const double in[3] = {x.xs[i], x.ys[i], x.zs[i]};
        double out[3];
        change.vector(in, out);
        EXPECT_NEAR(y.xs[i], out[0] * unit, 1e-4);
        EXPECT_NEAR(y.ys[i], out[1] * unit, 1e-4);
        EXPECT_NEAR(y.zs[i], out[2] * unit, 1e-4);
      }
    };
    expect_turned(a.positions, b.positions, 1);
    expect_turned(a.normals, b.normals, change.to.centimeters / change.from.centimeters);
    expect_turned(a.blend_shape_targets[0].deltas, b.blend_shape_targets[0].deltas, 1);
    EXPECT_EQ(a.texture_coordinates.us[1], b.texture_coordinates.us[1]);

    // The side that a face shows by the rule of the winding stays the same side.
    const auto side = [](const dna::Mesh& mesh, const dna::Face& face, uint32_t winding) {
      double p[3][3];
      for (int i = 0; i < 3; ++i) {
        const uint32_t v = face.layout_indices[i];
        p[i][0] = mesh.positions.xs[v], p[i][1] = mesh.positions.ys[v];
        p[i][2] = mesh.positions.zs[v];
      }
      double u[3], w[3];
      for (int i = 0; i < 3; ++i) u[i] = p[1][i] - p[0][i], w[i] = p[2][i] - p[0][i];
      const double sign = winding == 0 ? 1 : -1;
      return std::vector<double>{sign * (u[1] * w[2] - u[2] * w[1]),
                                 sign * (u[2] * w[0] - u[0] * w[2]),
                                 sign * (u[0] * w[1] - u[1] * w[0])};
    };
    const uint32_t corners = b.faces[1].layout_indices.count;
    ASSERT_EQ(corners, 3u);
    EXPECT_EQ(b.faces[0].layout_indices[0], a.faces[0].layout_indices[0]);
    const std::vector<double> before = side(a, a.faces[1], change.from.winding);
    const std::vector<double> after = side(b, b.faces[1], change.to.winding);
    double turned[3];
    change.vector(before.data(), turned);
    double along = 0;
    for (int i = 0; i < 3; ++i) along += turned[i] * after[i];
    EXPECT_GT(along, 0);
  }
}

// What is refused ---------------------------------------------------------------------------------

class ConversionRefused : public testing::Test {
 protected:
  Arena arena{default_allocator()};
  dna::DnaView tiny = dna::tiny_rig(arena);
  MienCoordinateSystem mirrored = named("opengl");  // back instead of front

  void expect(const MienCoordinateSystem& system, const char* words) {
    std::string message;
    const Bytes bytes = write_view(tiny);
    EXPECT_FALSE(open_in_system(bytes, system, MIEN_ERROR_DNA_VALUE, &message));
    EXPECT_NE(message.find(words), std::string::npos) << message;
  }
};

TEST_F(ConversionRefused, TheFilesAxesDoNotSpanSpace) {
  tiny.desc.coordinate_system = {0, 1, 4};
  expect(mirrored, "do not span space");
}

TEST_F(ConversionRefused, AControlIsTwoPartsOfARotation) {
  tiny.twsw.twists[0].input_control_indices = dna::be<uint16_t>(arena, {0, 1, 2, 0});
  expect(mirrored, "is part of two rotations");
}

TEST_F(ConversionRefused, ASolverReadsAControlAsTwoParts) {
  tiny.twsw = {};
  dna::RbfSolver& solver = tiny.rbfb.solvers[0];
  solver.distance_method = 1;  // of quaternions
  solver.raw_control_indices = dna::be<uint16_t>(arena, {0, 1, 2, 0});
  const dna::NewArray<float> values = dna::new_array<float>(arena, 4 * solver.pose_indices.count);
  for (uint32_t i = 0; i < values.count; ++i) values.set(i, i % 4 == 3 ? 1.0f : 0.0f);
  solver.raw_control_values = values;
  expect(mirrored, "is part of two rotations");
}

TEST_F(ConversionRefused, ACorrectiveReadsASign) {
  tiny.bhvr.controls.psds.columns = dna::be<uint16_t>(arena, {0, 5, 0, 6});
  expect(mirrored, "bhvr.controls.psds.columns[");
}

TEST_F(ConversionRefused, AChannelReadsASign) {
  tiny.bhvr.channels.input_indices = dna::be<uint16_t>(arena, {5, 6});
  expect(mirrored, "bhvr.blendShapeChannels.inputIndices[");
}

TEST_F(ConversionRefused, AQuaternionJointIsTurnedByASign) {
  tiny.bhvr.joints.groups[1].input_indices = dna::be<uint16_t>(arena, {5, 6, 7});
  expect(mirrored, "bhvr.joints.jointGroups[1].inputIndices[");
}

TEST_F(ConversionRefused, ATwistReadsARotationThatIsComputed) {
  tiny.mlbe.joints = {};
  expect(mirrored, "reads a rotation that the rig computes itself");
}

TEST_F(ConversionRefused, AnglesInAnotherOrder) {
  // The jaw turns about one axis only and follows; one more axis, and it does not.
  MienCoordinateSystem reordered = named("maya");
  reordered.rotation_rule = MIEN_ROTATION_RULE_EXACT;
  reordered.rotation_sequence = MIEN_ROTATION_SEQUENCE_ZXY;
  const Bytes bytes = write_view(tiny);
  EXPECT_TRUE(open_in_system(bytes, reordered));
  tiny.bhvr.joints.groups[0].output_indices = dna::be<uint16_t>(arena, {12, 13, 11});
  expect(reordered, "joint jaw adds Euler angles about several axes");
  reordered.rotation_rule = MIEN_ROTATION_RULE_PER_COLUMN;
  expect(reordered, "keeps only some of its angles at a LOD");
}

TEST_F(ConversionRefused, ATanhHasNoUnit) {
  tiny.mlbe.joints.output_indices = dna::be<uint16_t>(arena, {20, 21, 22, 27});  // tx ty tz, sx
  tiny.twsw = {};
  tiny.mlbh.networks[0].layers[1].function_id = 3;
  const Bytes bytes = write_view(tiny);
  MienCoordinateSystem meters = system_of(open_dna(bytes).get());
  meters.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
  expect(meters, "ends in tanh or sigmoid");
  tiny.mlbh.networks[0].layers[1].function_id = 1;
  const Bytes rectified = write_view(tiny);
  EXPECT_TRUE(open_in_system(rectified, meters));
}

TEST_F(ConversionRefused, PartOfAVector) {
  tiny.mlbe.joints.output_indices = dna::be<uint16_t>(arena, {20, 21, 27, 28});
  tiny.twsw = {};
  expect(named("unreal"), "joint 2 gets only a part of its translation");
  tiny.mlbe.joints.output_indices = dna::be<uint16_t>(arena, {0, 1, 7, 8});
  expect(named("unreal"), "joint 0 gets only a part of its translation");
  tiny.mlbe.joints.output_indices = dna::be<uint16_t>(arena, {7, 8, 17, 18});
  expect(named("unreal"), "joint 0 gets only a part of its scale");
}

// Controls 5, 6 and 7 are a translation of their own here: to other axes they have no equivalent.
class LostControls : public ConversionRefused {
 protected:
  void SetUp() override {
    tiny.mlbe.joints.output_indices = dna::be<uint16_t>(arena, {20, 21, 22, 27});
    tiny.twsw = {};
    const Bytes bytes = write_view(tiny);
    ASSERT_TRUE(open_in_system(bytes, mirrored));
  }
};

TEST_F(LostControls, AMapReadsOne) {
  tiny.bhvr.maps.conditionals.input_indices = dna::be<uint16_t>(arena, {5});
  expect(mirrored, "bhvr.animatedMaps.conditionals.inputIndices[0]");
}

TEST_F(LostControls, AJointGroupReadsOne) {
  tiny.bhvr.joints.groups[1].input_indices = dna::be<uint16_t>(arena, {0, 1, 6});
  expect(mirrored, "bhvr.joints.jointGroups[1].inputIndices[2]");
}

TEST_F(LostControls, APoseReadsOne) {
  tiny.rbfe.poses[1].input_control_indices = dna::be<uint16_t>(arena, {7});
  expect(mirrored, "rbfe.poses[1].inputControlIndices[0]");
}

TEST_F(LostControls, APoseWritesOne) {
  tiny.rbfe.poses[1].output_control_indices = dna::be<uint16_t>(arena, {5});
  tiny.rbfe.poses[1].output_control_weights = dna::be<float>(arena, {1});
  expect(mirrored, "rbfe.poses[1].outputControlIndices[0]");
}

TEST_F(LostControls, TwoJointsFollowOne) {
  tiny.mlbe.joints.input_indices = dna::be<uint16_t>(arena, {5, 6, 7, 7});
  expect(mirrored, "moves another joint too");
}

TEST_F(LostControls, AJointFollowsARawControl) {
  tiny.mlbe.joints.input_indices = dna::be<uint16_t>(arena, {5, 6, 7, 1});
  expect(mirrored, "is not an ML control");
}

// Arrays that were converted are no longer in the file; what is wrong with them is.
TEST(CoordinateConversion, MessagesNameTheByteOfTheFile) {
  Arena arena(default_allocator());
  dna::DnaView tiny = dna::tiny_rig(arena);
  const float nan = std::nanf("");
  tiny.geom.meshes[0].positions.xs = dna::be<float>(arena, {0, 1, 2, 0, nan, 2});
  const Bytes bytes = write_view(tiny);
  const DnaHandle original = open_dna(bytes);
  MienCoordinateSystem meters = system_of(original.get());
  meters.translation_unit = MIEN_TRANSLATION_UNIT_METERS;
  const DnaHandle converted = open_in_system(bytes, meters);
  ASSERT_TRUE(original && converted);
  EXPECT_NE(converted->view.geom.meshes[0].positions.xs[1],
            original->view.geom.meshes[0].positions.xs[1]);
  const auto offset = [](const DnaHandle& dna) {
    MienError error = sized<MienError>();
    MienDeformer* deformer = nullptr;
    EXPECT_EQ(
        mien_deformer_create(dna.get(), create_rig(dna.get()).get(), nullptr, &deformer, &error),
        MIEN_ERROR_DNA_VALUE);
    return error.byte_offset;
  };
  EXPECT_EQ(offset(converted), offset(original));
  uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits = bits << 8 | bytes.at(offset(converted) + i);
  EXPECT_EQ(bits & 0x7FC00000, 0x7FC00000u) << "the NaN";
}

TEST(CoordinateConversion, WrongArguments) {
  Arena arena(default_allocator());
  const Bytes bytes = write_view(dna::tiny_rig(arena));
  const auto expect = [&](MienCoordinateSystem system, MienStatus status) {
    EXPECT_FALSE(open_in_system(bytes, system, status));
  };
  MienCoordinateSystem system = named("unity");
  system.axes[0] = MIEN_DIRECTION_DOWN;
  expect(system, MIEN_ERROR_INVALID_ARGUMENT);
  system.axes[0] = 6;
  expect(system, MIEN_ERROR_INVALID_ARGUMENT);
  expect(sized<MienCoordinateSystem>(), MIEN_ERROR_INVALID_ARGUMENT);
  for (size_t field = 0; field < 8; ++field) {
    system = named("unity");
    uint32_t* fields[] = {&system.translation_unit, &system.rotation_unit, &system.rotation_rule,
                          &system.rotation_sequence, &system.face_winding};
    if (field < 5) {
      *fields[field] = 6;
    } else {
      system.rotation_signs[field - 5] = 2;
    }
    expect(system, MIEN_ERROR_INVALID_ARGUMENT);
  }
  system = named("unity");
  system.struct_size = 8;
  expect(system, MIEN_ERROR_STRUCT_SIZE);
}

// Translations of 1e37 meters have no number in centimeters: the largest there is stands for them.
TEST(CoordinateConversion, UnitsSaturate) {
  Arena arena(default_allocator());
  dna::DnaView tiny = dna::tiny_rig(arena);
  tiny.desc.coordinate_system = {0, 2, 4};
  tiny.desc.translation_unit = 1;
  tiny.defn.neutral_translations.xs = dna::be<float>(arena, {1e37f, -1e37f, 1});
  const Bytes bytes = write_view(tiny);
  const DnaHandle dna = open_in_system(bytes, named("maya"));
  ASSERT_TRUE(dna);
  const dna::Array<float>& xs = dna->view.defn.neutral_translations.xs;
  EXPECT_EQ(xs[0], FLT_MAX);
  EXPECT_EQ(xs[1], -FLT_MAX);
  EXPECT_EQ(xs[2], 100.0f);
}

}  // namespace
}  // namespace mien
