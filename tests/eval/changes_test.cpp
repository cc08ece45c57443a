// SPDX-License-Identifier: MIT
// Joint values of instances that keep sums (MIEN_REUSE_SUMS) stay within the bound of mien/rig.h, however
// long only little changes; everything else has the bits of a full evaluation. Any sequence of calls:
// reuse_test.cpp.
#include "runtime/eval/changes.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/golden.h"
#include "tests/support/long_run.h"
#include "tests/support/many_rigs.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/sums_bound.h"

namespace mien {
namespace {

/// A character on a rig that keeps sums, and one on a rig that keeps nothing.
struct Pair {
  explicit Pair(const MienDna* dna, MienRigDesc desc = sized<MienRigDesc>())
      : kept(with(dna, desc, MIEN_REUSE_SUMS)), full(with(dna, desc, MIEN_REUSE_NOTHING)) {}

  static RigHandle with(const MienDna* dna, MienRigDesc desc, uint32_t reuse) {
    desc.reuse = reuse;
    return create_rig(dna, desc);
  }

  const Changes& changes() const { return *capi::object(kept.instance.get())->changes; }

  void evaluate(uint32_t lod) {
    std::copy(kept.raw.begin(), kept.raw.end(), full.raw.begin());
    kept.evaluate(lod);
    full.evaluate(lod);
    bound.note(kept, true);
  }

  Character kept, full;
  SumsBound bound;
};

struct Walk {
  uint32_t frames = 0, added = 0, anew = 0;
  double worst = 0;  // error by its bound
};

/// A few controls change in each frame.
Walk walk(Pair& pair, uint32_t frames) {
  Walk walk;
  Random random = Random::from_seed(5, 1);
  draw_controls(random, 25, pair.kept.raw);
  pair.evaluate(0);
  const auto count = static_cast<uint32_t>(pair.kept.raw.count);
  for (; walk.frames < frames && !testing::Test::HasFailure(); ++walk.frames) {
    for (uint32_t i = 0, n = 1 + random.below(3); i < n; ++i) {
      float& control = pair.kept.raw[random.below(count)];
      control = random.below(4) ? static_cast<float>(random.between(-0.1, 1.2)) : 0.0f;
    }
    const uint32_t before = pair.changes().roundings;
    pair.evaluate(0);
    const uint32_t now = pair.changes().roundings;
    walk.added += now > before;
    walk.anew += now < before;
    if (now == 0) {
      EXPECT_TRUE(same_results(pair.kept, pair.full)) << "new sums are those of a full evaluation";
    }
    EXPECT_TRUE(same_bits(pair.kept.controls, pair.full.controls));
    EXPECT_TRUE(same_bits(pair.kept.channels, pair.full.channels));
    EXPECT_TRUE(same_bits(pair.kept.maps, pair.full.maps));
    walk.worst = std::max(walk.worst, pair.bound.expect_within(pair.kept, pair.full));
  }
  return walk;
}

TEST(Changes, LongWalksStayWithinTheBound) {
  double worst = 0;
  uint32_t frames = 0;
  for_each_rig_desc([&](const MienRigDesc& desc) {
    Pair pair(generate_dna(MIEN_PRESET_SMALL, 3).get(), desc);
    const Walk walked = walk(pair, rounds(400, 20000));
    EXPECT_GT(walked.added, walked.frames / 2) << "it evaluates everything";
    EXPECT_GT(walked.anew, 0u) << "sums are never computed anew";
    worst = std::max(worst, walked.worst);
    frames += walked.frames;
  });
  std::printf("  %u frames, largest error %.2g of its bound\n", frames, worst);
}

TEST(Changes, OfGoldenRigs) {
  for (const std::string& name : golden::present_names()) {
    SCOPED_TRACE(name);
    const std::vector<uint8_t> bytes = golden::read_rig(name);
    const DnaHandle dna = open_dna(bytes);
    if (info_of(dna).raw_control_count == 0) continue;
    for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
      MienRigDesc desc = sized<MienRigDesc>();
      desc.rotation_output = rotation;
      Pair pair(dna.get(), desc);
      walk(pair, rounds(40, 4000));
    }
  }
}

/// Few controls change in most frames; some of them are not finite. Resets, other LODs and frames in which
/// everything changes come between.
void walk_anywhere(const MienDna* dna, const MienRigDesc& desc, uint32_t frames) {
  Pair pair(dna, desc);
  const uint32_t lods = capi::object(pair.kept.rig)->lod_count;
  const auto count = static_cast<uint32_t>(pair.kept.raw.count);
  if (count == 0) return;
  Random random = Random::from_seed(6, 1);
  uint32_t lod = 0, added = 0;
  for (uint32_t frame = 0; frame < frames && !testing::Test::HasFailure(); ++frame) {
    SCOPED_TRACE("frame " + std::to_string(frame));
    if (random.below(16) == 0) lod = random.below(lods);
    if (random.below(32) == 0) {
      for (Character* c : {&pair.kept, &pair.full}) {
        EXPECT_EQ(mien_instance_reset(c->instance.get()), MIEN_OK);
      }
    }
    if (frame == 0 || random.below(32) == 0) draw_controls(random, 25, pair.kept.raw);
    for (uint32_t i = 0, n = random.below(4); i < n; ++i) {
      constexpr float kAwkward[] = {NAN, INFINITY, -INFINITY, 3e38f, 1e-42f, -0.0f};
      pair.kept.raw[random.below(count)] = random.below(12)
                                               ? static_cast<float>(random.between(-0.1, 1.2))
                                               : kAwkward[random.below(6)];
    }
    for (float& control : pair.kept.raw) {
      if (!(std::fabs(control) < 2) && random.below(3) == 0) control = 0.5f;
    }
    pair.evaluate(lod);
    added += pair.changes().roundings > 0;
    EXPECT_TRUE(same_bits(pair.kept.controls, pair.full.controls));
    EXPECT_TRUE(same_bits(pair.kept.channels, pair.full.channels));
    EXPECT_TRUE(same_bits(pair.kept.maps, pair.full.maps));
    pair.bound.expect_within(pair.kept, pair.full);
  }
  EXPECT_TRUE(added > 0 || capi::object(pair.kept.rig)->joints.columns.empty());
}

TEST(Changes, OfAnyControlsAfterResetsAndLods) {
  const auto walk_all = [](const MienDna* dna) {
    for_each_rig_desc([&](const MienRigDesc& desc) { walk_anywhere(dna, desc, rounds(60, 4000)); });
  };
  walk_all(generate_dna(MIEN_PRESET_SMALL, 5).get());
  walk_all(generate_dna(MIEN_PRESET_SMALL, 6, MIEN_GENERATE_ML).get());
  walk_all(generate_dna(MIEN_PRESET_BODY, 7).get());
  Random random = Random::from_seed(7, 1);
  for (uint32_t i = 0; i < 3; ++i) {
    const LayerFile file(random_layer_rig(random, false));
    walk_all(file.dna.get());
  }
}

// A value that a caller puts into the results stays where nothing is computed.
TEST(Changes, WriteOnlyWhatTheyReach) {
  Pair pair(generate_dna(MIEN_PRESET_SMALL, 1).get());
  Character& c = pair.kept;
  std::fill(c.raw.begin(), c.raw.end(), 0.25f);
  c.evaluate(0);
  const std::vector<float> before(c.joints.begin(), c.joints.end());
  for (const float& value : c.joints) const_cast<float&>(value) = 12345.0f;
  c.raw[0] = 0.26f;
  c.evaluate(0);
  ASSERT_GT(pair.changes().roundings, 0u);
  size_t written = 0;
  for (const float value : c.joints) written += value != 12345.0f;
  EXPECT_GT(written, 0u);
  EXPECT_LT(written, c.joints.count / 2);
  // After a reset everything is.
  ASSERT_EQ(mien_instance_reset(c.instance.get()), MIEN_OK);
  std::fill(c.raw.begin(), c.raw.end(), 0.25f);
  c.evaluate(0);
  EXPECT_TRUE(same_bits(c.joints, span_of(before)));
}

TEST(Changes, NewSumsAfterResetsLodsAndManyChanges) {
  Pair pair(generate_dna(MIEN_PRESET_SMALL, 2).get());
  Random random = Random::from_seed(8, 1);
  const auto add = [&] {
    pair.kept.raw[random.below(8)] += 0.125f;
    pair.evaluate(0);
    return pair.changes().roundings;
  };
  draw_controls(random, 50, pair.kept.raw);
  pair.evaluate(0);
  ASSERT_GT(add(), 0u);
  draw_controls(random, 50, pair.kept.raw);
  pair.evaluate(0);
  EXPECT_EQ(pair.changes().roundings, 0u) << "all controls changed";
  EXPECT_TRUE(same_results(pair.kept, pair.full));
  ASSERT_GT(add(), 0u);
  pair.evaluate(1);
  EXPECT_EQ(pair.changes().roundings, 0u) << "another LOD";
  EXPECT_TRUE(same_results(pair.kept, pair.full));
  pair.evaluate(0);
  ASSERT_GT(add(), 0u);
  for (Character* c : {&pair.kept, &pair.full}) {
    ASSERT_EQ(mien_instance_reset(c->instance.get()), MIEN_OK);
  }
  pair.evaluate(0);
  EXPECT_EQ(pair.changes().roundings, 0u) << "reset";
  EXPECT_TRUE(same_results(pair.kept, pair.full));
}

// Sums that overflowed would stay infinite.
TEST(Changes, SumsThatAreNotFiniteAreComputedAnew) {
  Pair pair(generate_dna(MIEN_PRESET_SMALL, 1).get());
  pair.evaluate(0);
  for (const float value : {3e38f, -3e38f, 0.5f, INFINITY, 0.25f, NAN, 0.75f}) {
    pair.kept.raw[0] = value;
    pair.evaluate(0);
    if (std::fabs(value) < 1) {
      EXPECT_TRUE(same_results(pair.kept, pair.full)) << value;
      EXPECT_EQ(pair.changes().roundings, 0u) << value;
    }
  }
  pair.kept.raw[0] = 0.5f;
  pair.evaluate(0);
  EXPECT_GT(pair.changes().roundings, 0u) << "differences are added again";
}

// Correctives that are 0 and stay so are skipped.
TEST(Changes, OfCorrectivesWhoseInputsChangeTogether) {
  Pair pair(generate_dna(MIEN_PRESET_SMALL, 1).get());
  const Rig& rig = *capi::object(pair.kept.rig);
  const PsdTable& psds = rig.psds;
  pair.evaluate(0);
  uint32_t changed = 0;
  for (uint32_t e = 0; e < psds.count_at_lod[0]; ++e) {
    const Span<uint16_t> inputs =
        psds.inputs.slice(psds.first_input[e], psds.first_input[e + 1] - psds.first_input[e]);
    if (std::any_of(inputs.begin(), inputs.end(), [&](uint32_t i) { return i >= rig.raw_count; })) {
      continue;
    }
    const float values[][2] = {{0.5f, 0.25f}, {0.0f, 0.0f}, {0.75f, 0.5f},    {-1.0f, 0.5f},
                               {0.5f, 0.0f},  {0.5f, 1.0f}, {1e-30f, 1e-30f}, {1e-10f, 1e-10f},
                               {NAN, 0.5f},   {0.5f, 0.5f}, {0.0f, 0.0f}};
    for (const float* value : values) {
      for (size_t i = 0; i < inputs.count; ++i) pair.kept.raw[inputs[i]] = value[i != 0];
      const uint32_t before = bits_of(pair.full.controls[psds.outputs[e]]);
      pair.evaluate(0);
      changed += bits_of(pair.full.controls[psds.outputs[e]]) != before;
      ASSERT_TRUE(same_bits(pair.kept.controls, pair.full.controls)) << e << ' ' << value[0];
    }
  }
  EXPECT_GT(changed, 100u);
}

TEST(Changes, OfBatchesAndOfSingleCharacters) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 4);
  const RigHandle rig = Pair::with(dna.get(), sized<MienRigDesc>(), MIEN_REUSE_SUMS);
  const RigHandle plain = Pair::with(dna.get(), sized<MienRigDesc>(), MIEN_REUSE_NOTHING);
  constexpr uint32_t kCount = 8;
  std::vector<Character> characters;
  std::vector<SumsBound> bounds(kCount);
  MienInstance* instances[kCount];
  const uint32_t lods[kCount] = {};
  Random random = Random::from_seed(9, 1);
  for (uint32_t i = 0; i < kCount; ++i) {
    characters.emplace_back(rig);
    instances[i] = characters[i].instance.get();
    draw_controls(random, 50, characters[i].raw);
  }
  const BatchHandle batch = create_batch(rig, kCount);
  Character full(plain);
  uint32_t added = 0;
  for (uint32_t frame = 0; frame < 20; ++frame) {
    for (Character& c : characters) {
      if (frame % 7 == 6) draw_controls(random, 50, c.raw);
      c.raw[random.below(8)] += 0.125f;
    }
    ASSERT_EQ(mien_rig_evaluate_batch(rig.get(), batch.get(), instances, lods, kCount,
                                      MIEN_STAGE_ALL, nullptr),
              MIEN_OK);
    for (uint32_t i = 0; i < kCount; ++i) {
      std::copy(characters[i].raw.begin(), characters[i].raw.end(), full.raw.begin());
      full.evaluate(0);
      bounds[i].note(characters[i], true);
      bounds[i].expect_within(characters[i], full);
      EXPECT_TRUE(same_bits(characters[i].controls, full.controls));
      EXPECT_TRUE(same_bits(characters[i].channels, full.channels));
      added += capi::object(instances[i])->changes->roundings > 0;
    }
  }
  EXPECT_GT(added, 0u);
}

TEST(Changes, MemoryIsThatOfTheInfo) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
  const RigHandle plain = create_rig(dna.get());
  const RigHandle rig = Pair::with(dna.get(), sized<MienRigDesc>(), MIEN_REUSE_SUMS);
  const Rig& of = *capi::object(rig.get());
  EXPECT_EQ(info_of(rig).rig_bytes, info_of(plain).rig_bytes + of.changes->block_size);
  const Character c(rig);
  EXPECT_EQ(info_of(rig).instance_bytes, capi::object(c.instance.get())->block_size);
  const size_t sums = of.joints.panels[of.joints.panel_count()].first_block_row * 32;
  EXPECT_LT(info_of(rig).instance_bytes,
            info_of(plain).instance_bytes + sums + 5 * of.control_count + 1024);
}

}  // namespace
}  // namespace mien
