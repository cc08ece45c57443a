// SPDX-License-Identifier: MIT
// Matrices of derivatives: each has the entries of the products of single directions, and its pattern has all that are
// not 0 in any of many poses, through all layers and on golden rigs.
#include "runtime/derive/jacobian.h"

#include <thread>

#include "tests/derive/derivatives_handle.h"
#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"
#include "tests/support/golden.h"
#include "tests/support/plain_rig.h"
#include "tests/support/random_layer_rig.h"

namespace mien {
namespace {

struct DestroyJacobian {
  void operator()(MienJacobian* jacobian) const { mien_jacobian_destroy(jacobian); }
};
using JacobianHandle = std::unique_ptr<MienJacobian, DestroyJacobian>;

struct ChosenNumbers {
  std::vector<uint32_t> inputs, outputs;  // empty: all
};

MienJacobianDesc jacobian_desc(uint32_t from, uint32_t to, uint32_t lod = 0) {
  MienJacobianDesc desc = mien_jacobian_desc_default();
  desc.from_point = from;
  desc.to_point = to;
  desc.lod = lod;
  return desc;
}

JacobianHandle create_matrix(const DerivativesHandle& d, const MienJacobianDesc& desc) {
  MienJacobian* made = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_jacobian_create(d.get(), &desc, &made, &error), MIEN_OK) << error.message;
  return JacobianHandle(made);
}

MienJacobianPattern pattern_of(const JacobianHandle& jacobian) {
  MienJacobianPattern pattern = mien_jacobian_pattern_default();
  EXPECT_EQ(mien_jacobian_pattern(jacobian.get(), &pattern), MIEN_OK);
  return pattern;
}

std::vector<float> values_of(const DerivativesHandle& d, const JacobianHandle& jacobian) {
  const size_t count = pattern_of(jacobian).rows.count;
  std::vector<float> values(count + 1, -7.0f);
  EXPECT_EQ(mien_derivatives_jacobian(d.get(), jacobian.get(), nullptr, 0, values.data(), count),
            MIEN_OK);
  EXPECT_EQ(values.back(), -7.0f);
  values.pop_back();
  return values;
}

/// The products of the directions that are 1 at one number, of the columns of a matrix: [column][number at `to`].
std::vector<float> unit_products(const DerivativesHandle& d, const MienJacobianDesc& desc) {
  const size_t width = size_of(d, desc.from_point, desc.mesh);
  const size_t count = desc.inputs ? desc.input_count : width;
  std::vector<float> directions(count * width);
  for (size_t c = 0; c < count; ++c) directions[c * width + (desc.inputs ? desc.inputs[c] : c)] = 1;
  return forward(d, desc.from_point, desc.to_point, directions, static_cast<uint32_t>(count),
                 desc.mesh);
}

struct Seen {
  size_t entries = 0, nonzeros = 0, columns = 0, directions = 0;
};

/// The matrix at the values that were linearized against the products of single directions.
void compare_matrix(const DerivativesHandle& d, const JacobianHandle& jacobian,
                    const MienJacobianDesc& desc, Seen& seen) {
  SCOPED_TRACE(testing::Message() << "from " << desc.from_point << " to " << desc.to_point
                                  << ", LOD " << desc.lod);
  const std::vector<float> expected = unit_products(d, desc), values = values_of(d, jacobian);
  const MienJacobianPattern pattern = pattern_of(jacobian);
  const size_t numbers = size_of(d, desc.to_point, desc.mesh);
  const size_t rows = desc.outputs ? desc.output_count : numbers;
  ASSERT_EQ(pattern.row_count, rows);
  ASSERT_EQ(pattern.columns.count, pattern.rows.count);
  const auto product = [&](size_t r, size_t c) {
    return expected[c * numbers + (desc.outputs ? desc.outputs[r] : r)];
  };
  size_t entry = 0, columns = 0;
  for (uint32_t c = 0; c < pattern.column_count; ++c) {
    const size_t before = entry;
    for (uint32_t r = 0; r < rows; ++r) {
      const bool has = entry < pattern.rows.count && pattern.columns.data[entry] == c &&
                       pattern.rows.data[entry] == r;
      if (!has) {
        ASSERT_EQ(product(r, c), 0.0f)
            << "row " << r << ", column " << c << " is not in the pattern";
        continue;
      }
      ASSERT_EQ(values[entry], product(r, c)) << "row " << r << ", column " << c;
      seen.nonzeros += values[entry++] != 0;
    }
    columns += entry != before;
  }
  ASSERT_EQ(entry, pattern.rows.count);
  ASSERT_LE(pattern.direction_count, columns);
  seen.entries += entry;
  seen.columns += columns;
  seen.directions += pattern.direction_count;
}

void compare_new_matrix(const DerivativesHandle& d, MienJacobianDesc desc, Seen& seen,
                        const ChosenNumbers& chosen = {}) {
  desc.inputs = chosen.inputs.empty() ? nullptr : chosen.inputs.data();
  desc.input_count = chosen.inputs.size();
  desc.outputs = chosen.outputs.empty() ? nullptr : chosen.outputs.data();
  desc.output_count = chosen.outputs.size();
  compare_matrix(d, create_matrix(d, desc), desc, seen);
}

/// Some of the numbers of a point, ascending, or in any order with some of them twice.
std::vector<uint32_t> some_numbers(Random& random, size_t size, bool ascending) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < size; ++i) {
    if (random.chance(0.4)) numbers.push_back(i);
  }
  if (ascending) return numbers;
  for (size_t i = numbers.size(); i-- > 0;) {
    std::swap(numbers[i], numbers[random.below(static_cast<uint32_t>(i) + 1)]);
  }
  if (numbers.size() > 2) numbers.push_back(numbers[1]);
  return numbers;
}

void set_pose(Character& character, Random& random, double share) {
  for (float& v : character.raw) {
    v = random.chance(share) ? static_cast<float>(random.between(0, 1)) : 0.0f;
  }
}

TEST(Jacobian, HasTheEntriesOfTheProductsThroughAllLayers) {
  Random random = Random::from_seed(72, 1);
  Seen seen;
  for (int round = 0; round < 48; ++round) {
    SCOPED_TRACE(round);
    const LayerRig rig = random_layer_rig(random, false, round % 3 == 2);
    const LayerFile file(rig);
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = present_isas()[static_cast<size_t>(round) % present_isas().size()];
    desc.rotation_output = round % 2 ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
    desc.storage = round % 3 == 1 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
    desc.ml_masks = round % 4 == 2 ? MIEN_ML_MASKS_BLEND : MIEN_ML_MASKS_SWITCH;
    const RigHandle handle = create_rig(file.dna.get(), desc);
    Character character(handle);
    const DerivativesHandle d = create_derivatives(handle.get());
    for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
      for (const bool sparse : {false, true}) {
        const std::vector<float> raw = random_raw(rig, {4, 8}, random);
        std::copy(raw.begin(), raw.end(), character.raw.begin());
        if (sparse) set_pose(character, random, 0.3);
        for (float& mask : character.masks) mask = static_cast<float>(random.below(3)) / 2;
        for (float& gui : character.gui) gui = static_cast<float>(random.between(-1, 1));
        character.evaluate(lod);
        linearize(d, character,
                  sparse && round % 5 == 0 ? MIEN_STAGE_ALL & ~MIEN_STAGE_RBF : MIEN_STAGE_ALL);
        for (uint32_t from = MIEN_POINT_GUI; from <= MIEN_POINT_CONTROLS; ++from) {
          for (const uint32_t to : {MIEN_POINT_RAW, MIEN_POINT_CONTROLS, MIEN_POINT_JOINTS,
                                    MIEN_POINT_CHANNELS, MIEN_POINT_MAPS}) {
            if (to <= from) continue;
            compare_new_matrix(d, jacobian_desc(from, to, lod), seen);
            compare_new_matrix(d, jacobian_desc(from, to, lod), seen,
                               {some_numbers(random, size_of(d, from), false),
                                some_numbers(random, size_of(d, to), true)});
            if (HasFatalFailure()) return;
          }
        }
      }
    }
  }
  printf("%zu entries, %zu not 0; %zu columns by %zu directions\n", seen.entries, seen.nonzeros,
         seen.columns, seen.directions);
  EXPECT_GT(seen.nonzeros, seen.entries / 10);
  EXPECT_LT(seen.directions, seen.columns);
}

TEST(Jacobian, HasTheEntriesOfMatricesAndPositions) {
  Random random = Random::from_seed(72, 2);
  Seen seen;
  for (uint32_t round = 0; round < 8; ++round) {
    SCOPED_TRACE(round);
    DeformRigOptions options;
    options.rotation_sequence = round % 6;
    options.max_influences = 4;
    options.one_root = round % 2 != 0;
    MienDeformerDesc desc = sized<MienDeformerDesc>();
    desc.compose = round % 6 == 1 ? MIEN_COMPOSE_EULER_ADD : MIEN_COMPOSE_PRODUCT;
    desc.storage = round % 4 == 3 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
    const bool quaternions = round % 3 == 2;
    const Deformed made(random_deform_rig(round, options), desc,
                        quaternions ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER);
    Character character(made.rig);
    character.evaluate(0);
    const DeformValues values = random_values(made.rig.get(), round);
    Instance& instance = *reinterpret_cast<Instance*>(character.instance.get());
    std::copy(values.joints.begin(), values.joints.end(), instance.joints.begin());
    std::copy(values.channels.begin(), values.channels.end(), instance.channels.begin());
    const DerivativesHandle d = create_derivatives(made.rig.get(), made.deformer.get());
    linearize(d, character);
    for (uint32_t from = MIEN_POINT_RAW; from <= MIEN_POINT_SKINS; ++from) {
      for (uint32_t to = std::max<uint32_t>(from + 1, MIEN_POINT_LOCALS);
           to <= MIEN_POINT_POSITIONS; ++to) {
        compare_new_matrix(d, jacobian_desc(from, to), seen);
        compare_new_matrix(d, jacobian_desc(from, to), seen,
                           {some_numbers(random, size_of(d, from), false),
                            some_numbers(random, size_of(d, to), true)});
      }
    }
    MienJacobianDesc of_channels = jacobian_desc(MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS);
    compare_new_matrix(d, of_channels, seen);
    of_channels.mesh = 1;
    compare_new_matrix(d, of_channels, seen);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(seen.nonzeros, seen.entries / 2);
  EXPECT_LT(seen.directions, seen.columns);
}

// One matrix in many poses: the pattern does not depend on the pose it was made at.
TEST(Jacobian, PatternHoldsInAllPosesOfGoldenRigs) {
  if (!golden::has_head()) printf("%s\n", golden::no_head().c_str());
  Random random = Random::from_seed(72, 3);
  for (const std::string& name : golden::present_names()) {
    SCOPED_TRACE(name);
    const std::vector<uint8_t> bytes = golden::read_rig(name);
    const DnaHandle dna = open_dna(bytes);
    const RigHandle rig = create_rig(dna.get());
    const DeformerHandle deformer = create_deformer(dna.get(), rig.get());
    Character character(rig);
    const DerivativesHandle d = create_derivatives(rig.get(), deformer.get());
    std::vector<uint32_t> mesh_rows;
    MienMesh mesh = mien_mesh_default();
    if (mien_deformer_mesh(deformer.get(), 0, &mesh) == MIEN_OK) {
      const uint32_t step = std::max(1u, mesh.position_count / 100);
      for (uint32_t p = 0; p < mesh.position_count; p += step) {
        mesh_rows.insert(mesh_rows.end(), {3 * p, 3 * p + 1, 3 * p + 2});
      }
    }
    Seen seen;
    std::vector<std::pair<MienJacobianDesc, JacobianHandle>> matrices;
    for (const uint32_t to : {MIEN_POINT_CONTROLS, MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS}) {
      MienJacobianDesc desc = jacobian_desc(MIEN_POINT_RAW, to);
      if (to == MIEN_POINT_POSITIONS) {
        if (mesh_rows.empty()) continue;
        desc.outputs = mesh_rows.data();
        desc.output_count = mesh_rows.size();
      }
      matrices.emplace_back(desc, create_matrix(d, desc));
    }
    for (const double share : {1.0, 0.5, 0.1}) {
      set_pose(character, random, share);
      character.evaluate(0);
      linearize(d, character);
      for (const auto& matrix : matrices) compare_matrix(d, matrix.second, matrix.first, seen);
      if (HasFatalFailure()) return;
    }
    printf("%s: %zu entries, %zu not 0; %zu columns by %zu directions\n", name.c_str(),
           seen.entries, seen.nonzeros, seen.columns, seen.directions);
    EXPECT_GT(seen.nonzeros, 0u);
  }
}

TEST(Jacobian, OfABodyTakesFewDirections) {
  Random random = Random::from_seed(72, 4);
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 3);
  for (const uint32_t isa : present_isas()) {
    const RigHandle rig = create_rig(dna.get(), isa);
    Character character(rig);
    set_pose(character, random, 0.5);
    character.evaluate(0);
    const DerivativesHandle d = create_derivatives(rig.get());
    linearize(d, character);
    Seen seen;
    compare_new_matrix(d, jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_JOINTS), seen);
    EXPECT_LT(seen.directions * 4, seen.columns);
    EXPECT_GT(seen.nonzeros, 0u);
  }
}

TEST(Jacobian, ComputesTheWantedColumnsOnly) {
  Random random = Random::from_seed(72, 5);
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 5);
  const RigHandle rig = create_rig(dna.get());
  Character character(rig);
  set_pose(character, random, 0.7);
  character.evaluate(0);
  const DerivativesHandle d = create_derivatives(rig.get());
  linearize(d, character);
  const JacobianHandle jacobian =
      create_matrix(d, jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_JOINTS));
  const MienJacobianPattern pattern = pattern_of(jacobian);
  const std::vector<float> all = values_of(d, jacobian);
  for (const double share : {0.0, 0.1, 0.5, 1.0}) {
    std::vector<uint8_t> wanted(pattern.column_count);
    for (uint8_t& w : wanted)
      w = random.chance(share) ? static_cast<uint8_t>(1 + random.below(255)) : 0;
    std::vector<float> values(all.size(), -7.0f);
    ASSERT_EQ(mien_derivatives_jacobian(d.get(), jacobian.get(), wanted.data(), wanted.size(),
                                        values.data(), values.size()),
              MIEN_OK);
    for (size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(values[i], wanted[pattern.columns.data[i]] ? all[i] : -7.0f) << i;
    }
  }
}

TEST(Jacobian, OfColumnsThatShareARowTakesADirectionEach) {
  PlainRig plain;
  plain.raw_count = 200;
  plain.joint_count = 1;
  plain.groups = {{{1}, {}, {4}, {}}};
  for (uint16_t c = 0; c < plain.raw_count; ++c) {
    plain.groups[0].inputs.push_back(c);
    plain.groups[0].values.push_back(static_cast<float>(c + 1));
  }
  Character character(make_rig(plain));
  character.evaluate(0);
  const DerivativesHandle d = create_derivatives(character.rig);
  linearize(d, character);
  const MienJacobianDesc desc = jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_JOINTS);
  const JacobianHandle jacobian = create_matrix(d, desc);
  Seen seen;
  compare_matrix(d, jacobian, desc, seen);
  EXPECT_EQ(seen.entries, 200u);
  EXPECT_EQ(pattern_of(jacobian).direction_count, 200u);
}

TEST(Jacobian, MayBeUsedByThreadsAtTheSameTime) {
  Random random = Random::from_seed(72, 6);
  const DnaHandle dna = generate_dna(MIEN_PRESET_BODY, 4);
  const RigHandle rig = create_rig(dna.get());
  std::vector<DerivativesHandle> derivatives;
  for (int t = 0; t < 3; ++t) {
    Character character(rig);
    set_pose(character, random, 0.6);
    character.evaluate(0);
    derivatives.push_back(create_derivatives(rig.get()));
    linearize(derivatives.back(), character);
  }
  const JacobianHandle jacobian =
      create_matrix(derivatives[0], jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_JOINTS));
  std::vector<std::vector<float>> alone, together(derivatives.size());
  for (const DerivativesHandle& d : derivatives) alone.push_back(values_of(d, jacobian));
  std::vector<std::thread> threads;
  for (size_t t = 0; t < derivatives.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20; ++i) together[t] = values_of(derivatives[t], jacobian);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, together);
  EXPECT_NE(alone[0], alone[1]);
}

TEST(Jacobian, GivesMemoryBackWhereItEnds) {
  const Deformed made(random_deform_rig(3, {}));
  const DerivativesHandle d = create_derivatives(made.rig.get(), made.deformer.get());
  MienJacobianDesc desc = jacobian_desc(MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS);
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  desc.allocator = &allocator;
  MienJacobian* jacobian = nullptr;
  ASSERT_EQ(mien_jacobian_create(d.get(), &desc, &jacobian, nullptr), MIEN_OK);
  EXPECT_EQ(counting.live, 1u) << "one block";
  const size_t requests = counting.requests;
  mien_jacobian_destroy(jacobian);
  EXPECT_TRUE(counting.clean()) << counting.first_wrong;
  for (size_t n = 1; n <= requests; ++n) {
    counting.restart();
    counting.fail_at = n;
    jacobian = reinterpret_cast<MienJacobian*>(&counting);
    MienError error = sized<MienError>();
    ASSERT_EQ(mien_jacobian_create(d.get(), &desc, &jacobian, &error), MIEN_ERROR_MEMORY) << n;
    EXPECT_EQ(jacobian, nullptr);
    EXPECT_TRUE(counting.clean()) << counting.first_wrong;
  }
}

TEST(Jacobian, KeepsItsRigAndDeformer) {
  JacobianHandle jacobian;
  {
    const Deformed made(random_deform_rig(3, {}));
    const DerivativesHandle d = create_derivatives(made.rig.get(), made.deformer.get());
    jacobian = create_matrix(d, jacobian_desc(MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS));
  }
  const MienJacobianPattern pattern = pattern_of(jacobian);
  size_t sum = 0;
  for (size_t i = 0; i < pattern.rows.count; ++i) sum += pattern.rows.data[i];
  EXPECT_GT(sum, 0u);
}

TEST(Jacobian, RefusesWrongArguments) {
  PlainRig plain;
  plain.raw_count = 2;
  plain.joint_count = 1;
  plain.lod_count = 2;
  plain.groups = {{{2, 1}, {0, 1}, {0, 1}, {1, 0, 0, 1}}};
  const RigHandle rig = make_rig(plain), other = make_rig(plain);
  Character character(rig);
  const DerivativesHandle d = create_derivatives(rig.get()),
                          of_other = create_derivatives(other.get());
  MienError error = sized<MienError>();
  const auto create = [&](const MienJacobianDesc& desc) {
    MienJacobian* made = nullptr;
    const MienStatus status = mien_jacobian_create(d.get(), &desc, &made, &error);
    EXPECT_EQ(made, nullptr);
    return status;
  };
  const MienJacobianDesc good = jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_JOINTS);
  EXPECT_EQ(create(jacobian_desc(MIEN_POINT_JOINTS, MIEN_POINT_RAW)), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(create(jacobian_desc(MIEN_POINT_RAW, 10)), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(create(jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_SKINS)), MIEN_ERROR_INDEX);
  EXPECT_EQ(create(jacobian_desc(MIEN_POINT_RAW, MIEN_POINT_JOINTS, 2)), MIEN_ERROR_LOD);
  const uint32_t wrong[] = {0, 9}, descending[] = {1, 0}, twice[] = {1, 1};
  MienJacobianDesc desc = good;
  desc.inputs = wrong;
  desc.input_count = 2;
  EXPECT_EQ(create(desc), MIEN_ERROR_INDEX);
  EXPECT_STREQ(error.message, "MienJacobianDesc.inputs[1] is 9 of 2");
  for (const uint32_t* outputs : {wrong, descending, twice}) {
    desc = good;
    desc.outputs = outputs;
    desc.output_count = 2;
    EXPECT_EQ(create(desc), outputs == wrong ? MIEN_ERROR_INDEX : MIEN_ERROR_INVALID_ARGUMENT);
  }
  desc = good;
  desc.output_count = 1;
  EXPECT_EQ(create(desc), MIEN_ERROR_NULL_ARGUMENT);
  desc = good;
  desc.struct_size = 3;
  EXPECT_EQ(create(desc), MIEN_ERROR_STRUCT_SIZE);
  EXPECT_EQ(mien_jacobian_create(d.get(), &good, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  MienJacobian* made = nullptr;
  EXPECT_EQ(mien_jacobian_create(nullptr, &good, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);

  const JacobianHandle jacobian = create_matrix(d, good);
  float values[8] = {};
  ASSERT_EQ(pattern_of(jacobian).rows.count, 2u);
  const auto compute = [&](const DerivativesHandle& with, float* out) {
    return mien_derivatives_jacobian(with.get(), jacobian.get(), nullptr, 0, out, 2);
  };
  EXPECT_EQ(compute(d, values), MIEN_ERROR_INVALID_ARGUMENT) << "nothing was linearized";
  character.evaluate(1);
  linearize(d, character);
  EXPECT_EQ(compute(d, values), MIEN_ERROR_MISMATCH) << "another LOD";
  character.evaluate(0);
  linearize(d, character);
  EXPECT_EQ(compute(d, values), MIEN_OK);
  EXPECT_EQ(compute(d, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(compute(of_other, values), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_derivatives_jacobian(d.get(), nullptr, nullptr, 0, values, 2),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_derivatives_jacobian(d.get(), reinterpret_cast<MienJacobian*>(d.get()), nullptr, 0,
                                      values, 2),
            MIEN_ERROR_HANDLE);
  const uint8_t wanted[] = {1, 1};
  const auto sized_as = [&](const uint8_t* columns, size_t column_count, size_t value_count) {
    return mien_derivatives_jacobian(d.get(), jacobian.get(), columns, column_count, values,
                                     value_count);
  };
  EXPECT_EQ(sized_as(wanted, 2, 2), MIEN_OK);
  EXPECT_EQ(sized_as(wanted, 1, 2), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(sized_as(nullptr, 2, 2), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(sized_as(nullptr, 0, 1), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(sized_as(nullptr, 0, 3), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_jacobian_pattern(jacobian.get(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  MienJacobianPattern small = mien_jacobian_pattern_default();
  small.struct_size = 8;
  EXPECT_EQ(mien_jacobian_pattern(jacobian.get(), &small), MIEN_ERROR_STRUCT_SIZE);
  mien_jacobian_destroy(nullptr);
}

}  // namespace
}  // namespace mien
