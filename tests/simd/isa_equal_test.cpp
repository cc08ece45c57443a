// SPDX-License-Identifier: MIT
// Whole rigs evaluated by every instruction set present. Those that fuse multiply-add (AVX2,
// AVX-512, NEON) agree bit for bit, and so do those that do not (scalar, SSE2). Between the two
// families a joint value may differ by what rounding does to a sum of n products: each of the two
// is within (n + 1) half units of the last place of sum |products| of the exact sum, so they are
// within n + 1 units of each other. Nothing else differs at all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {
namespace {

const std::vector<std::vector<uint32_t>> kFamilies = {
    {MIEN_ISA_SCALAR, MIEN_ISA_SSE2}, {MIEN_ISA_AVX2, MIEN_ISA_AVX512, MIEN_ISA_NEON}};

/// One rig for several instruction sets, each with a character.
struct Side {
  uint32_t isa;
  RigHandle rig;
  Character character;

  Side(const DnaHandle& dna, uint32_t of, uint32_t arithmetic)
      : isa(of), rig(create_rig(dna.get(), desc(of, arithmetic))), character(rig) {}

  static MienRigDesc desc(uint32_t isa, uint32_t arithmetic) {
    MienRigDesc made = sized<MienRigDesc>();
    made.isa = isa;
    made.arithmetic = arithmetic;
    return made;
  }
};

std::vector<Side> sides_of(const DnaHandle& dna, const std::vector<uint32_t>& isas,
                           uint32_t arithmetic = MIEN_ARITHMETIC_FAST) {
  std::vector<Side> sides;
  for (uint32_t isa : isas) {
    if (mien_isa_available(isa)) sides.emplace_back(dna, isa, arithmetic);
  }
  return sides;
}

/// Frame 0: nothing; 1: all on; 2: a few; then all, in and beyond 0..1.
std::vector<float> random_controls(Random& random, size_t count, int frame) {
  std::vector<float> raw(count, frame == 1 ? 1.0f : 0.0f);
  for (float& value : raw) {
    if (frame == 2 && random.chance(0.9)) continue;
    if (frame >= 2) value = static_cast<float>(random.between(-0.6, 1.6));
  }
  return raw;
}
constexpr int kFrames = 5;

void evaluate(Side& side, const std::vector<float>& raw, uint32_t lod) {
  ASSERT_EQ(side.character.raw.count, raw.size());
  std::copy(raw.begin(), raw.end(), side.character.raw.begin());
  side.character.evaluate(lod);
}

void expect_equal_families(const DnaHandle& dna, uint64_t seed,
                           uint32_t arithmetic = MIEN_ARITHMETIC_FAST) {
  const bool portable = arithmetic == MIEN_ARITHMETIC_PORTABLE;
  for (const std::vector<uint32_t>& family :
       portable ? std::vector<std::vector<uint32_t>>{present_isas()} : kFamilies) {
    std::vector<Side> sides = sides_of(dna, family, arithmetic);
    if (sides.size() < 2) continue;
    Random random = Random::from_seed(seed, 1);
    const uint32_t lods = info_of(sides[0].rig).lod_count;
    for (uint32_t lod = 0; lod < lods; ++lod) {
      for (int frame = 0; frame < kFrames; ++frame) {
        const auto raw = random_controls(random, sides[0].character.raw.count, frame);
        for (Side& side : sides) evaluate(side, raw, lod);
        const std::vector<float> expected = sides[0].character.results();
        for (size_t s = 1; s < sides.size(); ++s) {
          EXPECT_TRUE(same_bits(span_of(sides[s].character.results()), span_of(expected)))
              << mien_isa_name(sides[s].isa) << " and " << mien_isa_name(sides[0].isa)
              << " differ at LOD " << lod << ", frame " << frame;
        }
      }
    }
  }
}

/// How far the families may be apart in each joint value.
std::vector<double> joint_tolerance(const dna::DnaView& view, Span<const float> controls,
                                    uint32_t lod) {
  constexpr double kUlp = 1.0 / (1 << 23);
  std::vector<double> tolerance(9 * size_t{view.defn.joint_names.count});
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    const uint32_t columns = group.input_indices.count;
    for (uint32_t r = 0; r < (lod < group.lods.count ? group.lods[lod] : 0u); ++r) {
      double products = 0;
      for (uint32_t c = 0; c < columns; ++c) {
        products += std::fabs(double{group.values[size_t{r} * columns + c]} *
                              controls[group.input_indices[c]]);
      }
      tolerance[group.output_indices[r]] = (columns + 1) * kUlp * products;
    }
  }
  return tolerance;
}

void expect_close_families(const DnaHandle& dna, uint64_t seed) {
  std::vector<Side> plain = sides_of(dna, {MIEN_ISA_SCALAR});
  std::vector<Side> fused = sides_of(dna, kFamilies[1]);
  ASSERT_EQ(plain.size(), 1u);
  if (fused.empty()) GTEST_SKIP() << "NOT TESTED: no instruction set here fuses multiply-add";
  Character& a = plain[0].character;
  Character& b = fused[0].character;
  Random random = Random::from_seed(seed, 2);
  size_t differences = 0;
  for (uint32_t lod = 0; lod < info_of(plain[0].rig).lod_count; ++lod) {
    for (int frame = 0; frame < kFrames; ++frame) {
      SCOPED_TRACE("LOD " + std::to_string(lod) + ", frame " + std::to_string(frame));
      const auto raw = random_controls(random, a.raw.count, frame);
      evaluate(plain[0], raw, lod);
      evaluate(fused[0], raw, lod);
      EXPECT_TRUE(same_bits(a.controls, b.controls));
      EXPECT_TRUE(same_bits(a.channels, b.channels));
      EXPECT_TRUE(same_bits(a.maps, b.maps));
      const std::vector<double> tolerance = joint_tolerance(dna->view, a.controls, lod);
      ASSERT_EQ(a.joints.count, tolerance.size());
      for (size_t i = 0; i < tolerance.size(); ++i) {
        differences += a.joints[i] != b.joints[i];
        EXPECT_LE(std::fabs(double{a.joints[i]} - b.joints[i]), tolerance[i])
            << "joint value " << i << ": " << a.joints[i] << " and " << b.joints[i];
      }
    }
  }
  EXPECT_GT(differences, 0u) << "the fused family does not fuse: the wrong kernels ran";
}

class GeneratedRigs : public testing::TestWithParam<uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Presets, GeneratedRigs,
                         testing::Values(MIEN_PRESET_TINY, MIEN_PRESET_SMALL, MIEN_PRESET_MEDIUM,
                                         MIEN_PRESET_LARGE));

TEST_P(GeneratedRigs, AreEqualWithinAFamily) {
  for (uint64_t seed : {1, 2}) expect_equal_families(generate_dna(GetParam(), seed), seed);
}

TEST_P(GeneratedRigs, AreEqualEverywhereWithPortableArithmetic) {
  expect_equal_families(generate_dna(GetParam(), 4), 5, MIEN_ARITHMETIC_PORTABLE);
}

TEST_P(GeneratedRigs, AreCloseBetweenFamilies) {
  expect_close_families(generate_dna(GetParam(), 3), 3);
}

// All kinds of behavior in one small rig.
TEST(TinyRig, IsEqualWithinAFamily) {
  Arena arena(default_allocator());
  const std::vector<uint8_t> bytes = write_view(dna::tiny_rig(arena));
  expect_equal_families(open_dna(bytes), 4);
}

TEST(TinyRig, IsEqualEverywhereWithPortableArithmetic) {
  Arena arena(default_allocator());
  const std::vector<uint8_t> bytes = write_view(dna::tiny_rig(arena));
  expect_equal_families(open_dna(bytes), 6, MIEN_ARITHMETIC_PORTABLE);
}

// All layers in any combination.
TEST(RandomRigs, AreEqualWithinAFamily) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random = Random::from_seed(51, seed);
    expect_equal_families(LayerFile(random_layer_rig(random, false)).dna, seed);
  }
}

// What is neither fused nor comes from networks is equal on all: RBF solvers, above all.
TEST(RandomRigs, PoseControlsAreEqualOnAllInstructionSets) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    Random random = Random::from_seed(52, seed);
    const LayerRig rig = random_layer_rig(random, seed % 2);
    const LayerFile file(rig);
    std::vector<float> first;
    for (uint32_t isa : present_isas()) {
      Character character(create_rig(file.dna.get(), isa));
      Random inputs = Random::from_seed(53, seed);
      const std::vector<float> raw = random_raw(rig, {4, 8}, inputs);
      std::copy(raw.begin(), raw.end(), character.raw.begin());
      character.evaluate(0, MIEN_STAGE_RBF);
      const std::vector<float> mine(character.rbf.begin(), character.rbf.end());
      if (first.empty()) first = mine;
      EXPECT_TRUE(same_bits(span_of(mine), span_of(first))) << mien_isa_name(isa) << ", " << seed;
    }
  }
}

TEST(Rigs, ReportTheInstructionSetAskedFor) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 0);
  const std::vector<uint32_t> isas = present_isas();
  ASSERT_FALSE(isas.empty());
  EXPECT_EQ(isas[0], uint32_t{MIEN_ISA_SCALAR}) << "plain C++ runs everywhere";
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (mien_isa_available(isa)) {
      EXPECT_EQ(info_of(create_rig(dna.get(), isa)).isa, isa);
    } else {
      EXPECT_FALSE(create_rig(dna.get(), isa, MIEN_ERROR_ISA)) << "never replaced silently";
    }
  }
}

// A rig is packed the same for all: it does not depend on the machine that made it.
TEST(Rigs, AreAsLargeForEveryInstructionSet) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 0);
  const MienRigInfo scalar = info_of(create_rig(dna.get(), MIEN_ISA_SCALAR));
  for (uint32_t isa : present_isas()) {
    const MienRigInfo info = info_of(create_rig(dna.get(), isa));
    EXPECT_EQ(info.rig_bytes, scalar.rig_bytes);
    EXPECT_EQ(info.instance_bytes, scalar.instance_bytes);
  }
}

}  // namespace
}  // namespace mien
