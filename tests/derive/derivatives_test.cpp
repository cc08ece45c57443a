// SPDX-License-Identifier: MIT
// Products in reverse are the transposed ones, and their bits depend neither on the number of directions nor on threads
// nor on the instruction set of a family. duals_test.cpp compares their values with the model.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "tests/derive/derivatives_handle.h"
#include "tests/derive/random_skeleton.h"
#include "tests/support/deform_rig.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/rig_files.h"

namespace mien {
namespace {

std::vector<float> random_row(Random& random, size_t count) {
  std::vector<float> row(count);
  for (float& v : row) v = static_cast<float>(random.between(-1, 1));
  return row;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}
double length(const std::vector<float>& a) { return std::sqrt(dot(a, a)); }

// For random u and v: (J u) v = u (J^T v), of which float sums lose a little of |J u| |v| + |u| |J^T v|.
void expect_transposed(const DerivativesHandle& d, Random& random, uint32_t from, uint32_t to,
                       uint32_t mesh = 0) {
  const std::vector<float> u = random_row(random, size_of(d, from, mesh));
  const std::vector<float> v = random_row(random, size_of(d, to, mesh));
  const std::vector<float> ju = forward(d, from, to, u, 1, mesh);
  const std::vector<float> jv = reverse(d, from, to, v, 1, mesh);
  const double norm = length(ju) * length(v) + length(u) * length(jv);
  EXPECT_LE(std::fabs(dot(ju, v) - dot(u, jv)), 1e-4 * norm + 1e-30)
      << "from " << from << " to " << to << ": " << dot(ju, v) << " and " << dot(u, jv);
}

// The same for each entry of the matrix, of which each is found once more as a column and as a row.
void expect_transposed_matrix(const DerivativesHandle& d, uint32_t from, uint32_t to) {
  const size_t in = size_of(d, from), out = size_of(d, to);
  const auto identity = [](size_t size) {
    std::vector<float> rows(size * size);
    for (size_t i = 0; i < size; ++i) rows[i * size + i] = 1;
    return rows;
  };
  const std::vector<float> columns = forward(d, from, to, identity(in), static_cast<uint32_t>(in)),
                           rows = reverse(d, from, to, identity(out), static_cast<uint32_t>(out));
  double largest = 0;
  for (const float v : columns) largest = std::fmax(largest, std::fabs(v));
  for (size_t c = 0; c < in; ++c) {
    for (size_t r = 0; r < out; ++r) {
      ASSERT_NEAR(columns[c * out + r], rows[r * in + c], 1e-5 * largest)
          << "from " << from << " to " << to << ", row " << r << ", column " << c;
    }
  }
}

// Many directions have the bits of single ones: where all of them move all controls, where each moves few, and where only
// one number counts. Rows beyond 32 are too few to be multiplied together, or enough.
void expect_same_bits(const DerivativesHandle& d, Random& random, uint32_t from, uint32_t to,
                      uint32_t mesh = 0) {
  constexpr uint32_t kCount = 64;
  for (const double share : {1.0, 0.1, 0.0}) {
    for (const bool back : {false, true}) {
      const auto run = back ? reverse : forward;
      const size_t in = size_of(d, back ? to : from, mesh),
                   out = size_of(d, back ? from : to, mesh);
      std::vector<float> rows = random_row(random, in * kCount), singles;
      for (size_t i = 0; i < rows.size(); ++i) {
        if (i % in != 0 && !random.chance(share)) rows[i] = 0;
      }
      for (uint32_t k = 0; k < kCount; ++k) {
        const auto first = rows.begin() + static_cast<long>(k * in);
        const std::vector<float> one =
            run(d, from, to, {first, first + static_cast<long>(in)}, 1, mesh);
        singles.insert(singles.end(), one.begin(), one.end());
      }
      for (const uint32_t count : {2u, 5u, 32u, 34u, 37u, 64u}) {
        const std::vector<float> all = run(d, from, to, rows, count, mesh);
        ASSERT_TRUE(same_bits(span_of(all), {singles.data(), count * out}))
            << (back ? "reverse" : "forward") << " from " << from << " to " << to << ", " << count;
      }
    }
  }
}

// Two products after each other have the bits of one over both.
void expect_composed(const DerivativesHandle& d, Random& random, uint32_t from, uint32_t between,
                     uint32_t to) {
  const std::vector<float> u = random_row(random, size_of(d, from));
  const std::vector<float> first = forward(d, from, between, u);
  EXPECT_TRUE(same_bits(span_of(forward(d, between, to, first)), span_of(forward(d, from, to, u))))
      << "from " << from << " over " << between << " to " << to;
}

const uint32_t kChain[] = {MIEN_POINT_GUI,    MIEN_POINT_RAW,      MIEN_POINT_CONTROLS,
                           MIEN_POINT_JOINTS, MIEN_POINT_LOCALS,   MIEN_POINT_MODELS,
                           MIEN_POINT_SKINS,  MIEN_POINT_POSITIONS};

void expect_transposed_everywhere(const DerivativesHandle& d, Random& random, bool geometry) {
  for (size_t i = 0; i < (geometry ? 8u : 4u); ++i) {
    for (size_t k = i + 1; k < (geometry ? 8u : 4u); ++k) {
      expect_transposed(d, random, kChain[i], kChain[k]);
    }
    if (kChain[i] > MIEN_POINT_CONTROLS) continue;
    expect_transposed(d, random, kChain[i], MIEN_POINT_CHANNELS);
    expect_transposed(d, random, kChain[i], MIEN_POINT_MAPS);
  }
  if (geometry) expect_transposed(d, random, MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS);
}

void expect_consistent(const DerivativesHandle& d, Random& random, bool geometry) {
  expect_transposed_everywhere(d, random, geometry);
  for (size_t i = 1; i < (geometry ? 6u : 3u); ++i) {
    expect_composed(d, random, kChain[i - 1], kChain[i], kChain[i + 1]);
  }
  expect_same_bits(d, random, MIEN_POINT_GUI, MIEN_POINT_JOINTS);
  expect_same_bits(d, random, MIEN_POINT_RAW, MIEN_POINT_MAPS);
  if (!geometry) return;
  expect_same_bits(d, random, MIEN_POINT_RAW, MIEN_POINT_POSITIONS);
  expect_same_bits(d, random, MIEN_POINT_JOINTS, MIEN_POINT_SKINS);
}

TEST(Derivatives, InReverseAreTheTransposedOnes) {
  Random random = Random::from_seed(71, 2);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const LayerRig rig = random_layer_rig(random, round % 4 == 3, round % 5 == 4);
    const LayerFile file(rig);
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = present_isas()[static_cast<size_t>(round) % present_isas().size()];
    desc.rotation_output = round % 2 ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
    desc.storage = round % 3 == 1 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
    desc.ml_masks = round % 3 == 2 ? MIEN_ML_MASKS_BLEND : MIEN_ML_MASKS_SWITCH;
    const RigHandle handle = create_rig(file.dna.get(), desc);
    Character character(handle);
    const DerivativesHandle d = create_derivatives(handle.get());
    for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
      const std::vector<float> raw = random_raw(rig, {4, 8}, random);
      std::copy(raw.begin(), raw.end(), character.raw.begin());
      for (float& mask : character.masks) mask = static_cast<float>(random.below(3)) / 2;
      for (float& gui : character.gui) gui = static_cast<float>(random.between(-1, 1));
      character.evaluate(lod);
      linearize(d, character);
      if (round % 4 == 3) continue;  // wild numbers overflow
      expect_consistent(d, random, false);
      for (const uint32_t to : {MIEN_POINT_CONTROLS, MIEN_POINT_JOINTS, MIEN_POINT_MAPS}) {
        expect_transposed_matrix(d, MIEN_POINT_GUI, to);
        expect_transposed_matrix(d, MIEN_POINT_RAW, to);
      }
      if (HasFailure()) return;
    }
  }
}

// Results of a batch are in its instances, so these are linearized like others.
TEST(Derivatives, OfInstancesOfABatchAreThoseOfInstancesAlone) {
  constexpr uint32_t kInstances = 9;
  Random random = Random::from_seed(71, 6);
  for (int round = 0; round < 24; ++round) {
    SCOPED_TRACE(round);
    const LayerRig layers = random_layer_rig(random, false, round % 5 == 4);
    const LayerFile file(layers);
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = present_isas()[static_cast<size_t>(round) % present_isas().size()];
    desc.rotation_output = round % 2 ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
    const RigHandle rig = create_rig(file.dna.get(), desc);
    const BatchHandle batch = create_batch(rig, kInstances);
    const uint32_t lod = random.below(layers.base.lod_count);
    std::vector<Character> together, alone;
    std::vector<MienInstance*> handles;
    for (uint32_t i = 0; i < kInstances; ++i) {
      together.emplace_back(rig);
      alone.emplace_back(rig);
      handles.push_back(together.back().instance.get());
      const std::vector<float> raw = random_raw(layers, {4, 8}, random);
      for (Character* c : {&together.back(), &alone.back()}) {
        std::copy(raw.begin(), raw.end(), c->raw.begin());
      }
      alone.back().evaluate(lod);
    }
    const std::vector<uint32_t> lods(kInstances, lod);
    ASSERT_EQ(mien_rig_evaluate_batch(rig.get(), batch.get(), handles.data(), lods.data(),
                                      kInstances, MIEN_STAGE_ALL, nullptr),
              MIEN_OK);
    const DerivativesHandle of_batch = create_derivatives(rig.get());
    const DerivativesHandle of_one = create_derivatives(rig.get());
    for (uint32_t i = 0; i < kInstances; ++i) {
      linearize(of_batch, together[i]);
      linearize(of_one, alone[i]);
      for (const uint32_t to : {MIEN_POINT_JOINTS, MIEN_POINT_CHANNELS, MIEN_POINT_MAPS}) {
        const std::vector<float> u = random_row(random, size_of(of_one, MIEN_POINT_RAW));
        const std::vector<float> v = random_row(random, size_of(of_one, to));
        EXPECT_EQ(forward(of_batch, MIEN_POINT_RAW, to, u), forward(of_one, MIEN_POINT_RAW, to, u));
        EXPECT_EQ(reverse(of_batch, MIEN_POINT_RAW, to, v), reverse(of_one, MIEN_POINT_RAW, to, v));
      }
    }
  }
}

TEST(Derivatives, OfMatricesAndPositionsInReverseAreTheTransposedOnes) {
  Random random = Random::from_seed(71, 3);
  for (uint32_t round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const RandomSkeleton skeleton(round,
                                  round % 4 == 3 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT);
    const DerivativesHandle& d = skeleton.d;
    expect_consistent(d, random, true);
    expect_transposed(d, random, MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS, 1);
    expect_transposed_matrix(d, MIEN_POINT_JOINTS, MIEN_POINT_SKINS);
    expect_transposed_matrix(d, MIEN_POINT_SKINS, MIEN_POINT_POSITIONS);
    expect_transposed_matrix(d, MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS);
    if (HasFailure()) return;
  }
}

TEST(Derivatives, OfSomeStagesTakeTheOthersAsConstant) {
  PlainRig plain;
  plain.raw_count = 2;
  plain.psd_count = 1;
  plain.psds = {{2, 0, 1}, {2, 1, 1}};
  plain.joint_count = 1;
  plain.groups = {{{2}, {0, 2}, {0, 1}, {1, 0, 0, 1}}};
  Character character(make_rig(plain));
  character.raw[0] = character.raw[1] = 0.5f;
  character.evaluate(0);
  const DerivativesHandle d = create_derivatives(character.rig);
  linearize(d, character, MIEN_STAGE_JOINTS);
  std::vector<float> moved = forward(d, MIEN_POINT_RAW, MIEN_POINT_JOINTS, {1, 1});
  EXPECT_EQ(moved[0], 1.0f);
  EXPECT_EQ(moved[1], 0.0f);
  linearize(d, character);
  moved = forward(d, MIEN_POINT_RAW, MIEN_POINT_JOINTS, {1, 1});
  EXPECT_EQ(moved[1], 1.0f);
}

/// A character in a random pose, and its derivatives.
struct Posed {
  RigHandle rig;
  DeformerHandle deformer;
  Character character;
  DerivativesHandle d;

  Posed(const DnaHandle& dna, uint32_t isa, uint64_t seed)
      : rig(create_rig(dna.get(), isa)), deformer(create_deformer(dna.get(), rig.get())),
        character(rig), d(create_derivatives(rig.get(), deformer.get())) {
    Random random = Random::from_seed(71, seed);
    for (float& v : character.raw) {
      v = random.chance(0.5) ? 0.0f : static_cast<float>(random.between(0, 1));
    }
    for (float& v : character.gui) v = static_cast<float>(random.between(-1, 1));
    character.evaluate(0);
    linearize(d, character);
  }
};

TEST(Derivatives, OfRigsOfEveryOriginInReverseAreTheTransposedOnes) {
  Random random = Random::from_seed(71, 4);
  for (const NamedRig& file : rigs_of_every_origin()) {
    SCOPED_TRACE(file.name);
    const Posed posed(file.dna, MIEN_ISA_ENVIRONMENT, 5);
    expect_transposed_everywhere(posed.d, random, file.dna->view.geom.meshes.count != 0);
    expect_same_bits(posed.d, random, MIEN_POINT_RAW, MIEN_POINT_JOINTS);
  }
}

/// Products between all points, forward and in reverse.
std::vector<float> products(const DerivativesHandle& d, uint64_t seed) {
  Random random = Random::from_seed(71, seed);
  std::vector<float> all;
  const auto add = [&](uint32_t from, uint32_t to) {
    constexpr uint32_t kCount = 3;
    for (const std::vector<float>& rows :
         {forward(d, from, to, random_row(random, size_of(d, from) * kCount), kCount),
          reverse(d, from, to, random_row(random, size_of(d, to) * kCount), kCount)}) {
      all.insert(all.end(), rows.begin(), rows.end());
    }
  };
  for (size_t i = 1; i < 8; ++i) add(kChain[i - 1], kChain[i]);
  add(MIEN_POINT_GUI, MIEN_POINT_POSITIONS);
  add(MIEN_POINT_GUI, MIEN_POINT_MAPS);
  add(MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS);
  return all;
}

TEST(Derivatives, HaveTheSameBitsOnTheInstructionSetsOfAFamily) {
  const std::vector<std::vector<uint32_t>> families = {
      {MIEN_ISA_SCALAR, MIEN_ISA_SSE2}, {MIEN_ISA_AVX2, MIEN_ISA_AVX512, MIEN_ISA_NEON}};
  for (const NamedRig& file : rigs_of_every_origin()) {
    if (file.name == golden::kHead || file.dna->view.geom.meshes.count == 0) continue;
    for (const std::vector<uint32_t>& family : families) {
      std::vector<float> first;
      for (const uint32_t isa : family) {
        if (!mien_isa_available(isa)) continue;
        const std::vector<float> mine = products(Posed(file.dna, isa, 6).d, 7);
        if (first.empty()) first = mine;
        EXPECT_TRUE(same_bits(span_of(mine), span_of(first)))
            << file.name << ", " << mien_isa_name(isa);
      }
    }
  }
}

// Each has derivatives of its own; the rig and the deformer are shared.
TEST(Derivatives, HaveTheSameBitsOnManyThreads) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  const Posed posed(dna, MIEN_ISA_ENVIRONMENT, 8);
  const std::vector<float> alone = products(posed.d, 9);
  std::vector<std::vector<float>> together(4);
  std::vector<std::thread> threads;
  for (std::vector<float>& result : together) {
    threads.emplace_back([&] {
      const DerivativesHandle d = create_derivatives(posed.rig.get(), posed.deformer.get());
      for (int i = 0; i < 10; ++i) {
        linearize(d, posed.character);
        result = products(d, 9);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<float>& result : together) {
    EXPECT_TRUE(same_bits(span_of(result), span_of(alone)));
  }
}

TEST(Derivatives, RefuseWrongArguments) {
  PlainRig plain;
  plain.raw_count = 1;
  plain.joint_count = 1;
  const RigHandle rig = make_rig(plain);
  Character character(rig);
  const Character other(make_rig(plain));
  const DerivativesHandle d = create_derivatives(rig.get());
  float in[9] = {}, out[16] = {};
  const auto run = [&](uint32_t from, uint32_t to, const float* row = nullptr) {
    return mien_derivatives_forward(d.get(), from, to, 0, 1, row ? row : in, out);
  };
  EXPECT_EQ(run(MIEN_POINT_RAW, MIEN_POINT_JOINTS), MIEN_ERROR_INVALID_ARGUMENT)
      << "not linearized";
  linearize(d, character);
  EXPECT_EQ(run(MIEN_POINT_RAW, MIEN_POINT_JOINTS), MIEN_OK);
  EXPECT_EQ(run(MIEN_POINT_JOINTS, MIEN_POINT_RAW), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(run(MIEN_POINT_JOINTS, MIEN_POINT_CHANNELS), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(run(MIEN_POINT_RAW, MIEN_POINT_SKINS), MIEN_ERROR_INDEX) << "no deformer";
  EXPECT_EQ(run(MIEN_POINT_RAW, 10), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(
      mien_derivatives_forward(d.get(), MIEN_POINT_RAW, MIEN_POINT_JOINTS, 0, 1, nullptr, out),
      MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(
      mien_derivatives_forward(d.get(), MIEN_POINT_RAW, MIEN_POINT_JOINTS, 0, 0, nullptr, nullptr),
      MIEN_OK);
  EXPECT_EQ(mien_derivatives_linearize(d.get(), other.instance.get(), MIEN_STAGE_ALL),
            MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_derivatives_linearize(d.get(), character.instance.get(), 64),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_derivatives_linearize(nullptr, character.instance.get(), 0),
            MIEN_ERROR_NULL_ARGUMENT);
  MienDerivatives* made = nullptr;
  EXPECT_EQ(mien_derivatives_create(nullptr, nullptr, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien
