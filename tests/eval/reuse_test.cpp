// SPDX-License-Identifier: MIT
// Results that are kept because their inputs did not change have the bits of evaluation anew, after
// any sequence of calls.
//
// Twins: two instances of the same file, one on a rig that keeps results and one on a rig that keeps
// nothing, go through the same random calls and are compared after each. Some calls evaluate the
// first ones of several pairs as a batch. Rigs that keep sums are compared within their bound.
//
//     MIEN_LONG_TESTS=1 eval_tests --gtest_filter='Reuse.*'                   10^6 sequences
//     MIEN_TWIN_FIRST=12345 MIEN_TWIN_SEQUENCES=1 eval_tests ...              one that failed
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "tests/support/golden.h"
#include "tests/support/long_run.h"
#include "tests/support/many_rigs.h"
#include "tests/support/random_layer_rig.h"
#include "tests/support/sums_bound.h"

namespace mien {
namespace {

// Twins -------------------------------------------------------------------------------------------

struct Twins {
  Character kept, plain;
  SumsBound bound;  // with MIEN_REUSE_SUMS
};

/// Pairs of instances of one file, and what happens to them.
class TwinRun {
 public:
  TwinRun(const MienDna* dna, MienRigDesc desc)
      : kept_rig_(create_rig(dna, desc)), sums_(desc.reuse == MIEN_REUSE_SUMS) {
    desc.reuse = MIEN_REUSE_NOTHING;
    plain_rig_ = create_rig(dna, desc);
    for (uint32_t i = 0; i < kPairs; ++i)
      pairs_.push_back({Character(kept_rig_), Character(plain_rig_), SumsBound()});
    MienBatch* batch = nullptr;
    const MienBatchDesc batch_description = batch_desc(kPairs);
    EXPECT_EQ(mien_batch_create(kept_rig_.get(), &batch_description, &batch, nullptr), MIEN_OK);
    batch_.reset(batch);
    lod_count_ = info_of(kept_rig_).lod_count;
    groups_ = count_of(kept_rig_, MIEN_KIND_JOINT_GROUP);
    solvers_ = count_of(kept_rig_, MIEN_KIND_RBF_SOLVER);
    setups_ = count_of(kept_rig_, MIEN_KIND_TWIST_SWING);
  }

  /// A sequence of calls, chosen by `random`. Each begins where the last one ended.
  void run(Random random) {
    calls_.clear();
    const uint32_t length = 2 + random.below(8);
    for (uint32_t i = 0; i < length && !testing::Test::HasFailure(); ++i) {
      if (random.below(3) == 0) {
        evaluate_batch(random);
      } else {
        Twins& twins = pairs_[random.below(kPairs)];
        act(random, twins);
        evaluate(random, twins);
      }
    }
  }

 private:
  static constexpr uint32_t kPairs = 4;

  void note(const char* call) { calls_ += std::string(calls_.empty() ? "" : ", ") + call; }

  template <class F>
  void both(Twins& twins, F&& f) {
    f(kept_rig_.get(), twins.kept);
    f(plain_rig_.get(), twins.plain);
  }

  static float draw_value(Random& random) {
    constexpr float kValues[] = {0, 0, 0, -0.0f, 1, 0.5f, 0.25f, 1.5f, -0.5f};
    return random.below(4) ? kValues[random.below(9)]
                           : static_cast<float>(random.between(-0.2, 1.2));
  }

  /// Something that a caller does between evaluations.
  void act(Random& random, Twins& twins) {
    const auto raw_count = static_cast<uint32_t>(twins.kept.raw.count);
    const auto mask_count = static_cast<uint32_t>(twins.kept.masks.count);
    switch (random.below(10)) {
      case 0:  // all controls of a new frame
        note("new frame");
        draw_controls(random, random.below(101), twins.kept.raw);
        break;
      case 1:  // a frame that comes up again and again
        note("known frame");
        for (uint32_t i = 0; i < raw_count; ++i) twins.kept.raw[i] = i % 3 ? 0.0f : 0.5f;
        break;
      case 2:  // a caller who writes the whole array for each frame, mostly the same
        note("same array");
        if (frame_.size() != raw_count) frame_.assign(raw_count, 0.0f);
        if (raw_count && random.below(2)) frame_[random.below(raw_count)] = draw_value(random);
        std::copy(frame_.begin(), frame_.end(), twins.kept.raw.begin());
        break;
      case 3:
        note("reset");
        both(twins, [](const MienRig*, Character& c) {
          EXPECT_EQ(mien_instance_reset(c.instance.get()), MIEN_OK);
        });
        break;
      case 4:
        note("GUI");
        for (float& value : twins.kept.gui) value = random.below(3) ? value : draw_value(random);
        std::copy(twins.kept.gui.begin(), twins.kept.gui.end(), twins.plain.gui.begin());
        both(twins, [](const MienRig*, Character& c) { c.map_gui_to_raw(); });
        if (random.below(2)) both(twins, [](const MienRig*, Character& c) { c.map_raw_to_gui(); });
        break;
      case 5:
        note("mask");
        if (mask_count) twins.kept.masks[random.below(mask_count)] = draw_value(random);
        break;
      default:  // some controls, which most things do not depend on
        note("controls");
        for (uint32_t i = 0, n = random.below(4); i < n && raw_count; ++i) {
          twins.kept.raw[random.below(raw_count)] = draw_value(random);
        }
    }
    std::copy(twins.kept.raw.begin(), twins.kept.raw.end(), twins.plain.raw.begin());
    std::copy(twins.kept.masks.begin(), twins.kept.masks.end(), twins.plain.masks.begin());
  }

  uint32_t draw_lod(Random& random) { return random.below(4) ? 0 : random.below(lod_count_); }

  static uint32_t draw_stages(Random& random) {
    return random.below(3) ? uint32_t{MIEN_STAGE_ALL} : random.below(64);
  }

  void evaluate(Random& random, Twins& twins) {
    const uint32_t lod = draw_lod(random);
    switch (random.below(8)) {
      case 0:
        if (groups_ == 0) break;
        note("joint group");
        both(twins, [&, group = random.below(groups_)](const MienRig* rig, Character& c) {
          EXPECT_EQ(mien_rig_evaluate_joint_group(rig, c.instance.get(), lod, group), MIEN_OK);
        });
        break;
      case 1:
        if (solvers_ == 0) break;
        note("RBF solver");
        both(twins, [&, solver = random.below(solvers_)](const MienRig* rig, Character& c) {
          EXPECT_EQ(mien_rig_evaluate_rbf_solver(rig, c.instance.get(), lod, solver), MIEN_OK);
        });
        break;
      case 2:
        if (setups_ == 0) break;
        note("twist or swing");
        both(twins, [&, setup = random.below(setups_)](const MienRig* rig, Character& c) {
          EXPECT_EQ(mien_rig_evaluate_twist_swing(rig, c.instance.get(), lod, setup), MIEN_OK);
        });
        break;
      default: {
        const uint32_t stages = draw_stages(random);
        note(stages == MIEN_STAGE_ALL ? "evaluate" : "some stages");
        both(twins, [&](const MienRig*, Character& c) { c.evaluate(lod, stages); });
        note_sums(twins, stages);
      }
    }
    note_sums(twins, 0);
    compare(twins);
  }

  void evaluate_batch(Random& random) {
    MienInstance* instances[kPairs];
    Twins* evaluated[kPairs];
    uint32_t lods[kPairs], count = 0;
    const uint32_t stages = draw_stages(random), lod = draw_lod(random);
    for (Twins& twins : pairs_) {
      if (random.below(5) == 0) continue;
      if (random.below(2)) act(random, twins);
      evaluated[count] = &twins;
      instances[count] = twins.kept.instance.get();
      lods[count++] = random.below(4) ? lod : random.below(lod_count_);
      twins.plain.evaluate(lods[count - 1], stages);
    }
    note(stages == MIEN_STAGE_ALL ? "batch" : "some stages of a batch");
    EXPECT_EQ(mien_rig_evaluate_batch(kept_rig_.get(), batch_.get(), instances, lods, count, stages,
                                      nullptr),
              MIEN_OK);
    for (uint32_t i = 0; i < count; ++i) note_sums(*evaluated[i], stages);
    for (const Twins& twins : pairs_) compare(twins);
  }

  void note_sums(Twins& twins, uint32_t stages) const {
    if (sums_) twins.bound.note(twins.kept, (stages & MIEN_STAGE_JOINTS) != 0);
  }

  void compare(const Twins& twins) const {
    const auto same = [&](const char* what, Span<const float> kept, Span<const float> plain) {
      if (same_bits(kept, plain)) return;
      size_t i = 0;
      while (same_bits(kept.slice(i, 1), plain.slice(i, 1))) ++i;
      ADD_FAILURE() << what << "[" << i << "] is kept as " << kept[i] << ", evaluated anew it is "
                    << plain[i] << ", after: " << calls_;
    };
    same("controls", twins.kept.controls, twins.plain.controls);
    if (sums_) {
      SCOPED_TRACE("sums, after: " + calls_);
      twins.bound.expect_within(twins.kept, twins.plain);
    } else {
      same("joints", twins.kept.joints, twins.plain.joints);
    }
    same("blend shapes", twins.kept.channels, twins.plain.channels);
    same("animated maps", twins.kept.maps, twins.plain.maps);
  }

  RigHandle kept_rig_, plain_rig_;
  bool sums_;
  std::vector<Twins> pairs_;
  BatchHandle batch_;
  std::vector<float> frame_;
  std::string calls_;
  uint32_t lod_count_ = 0, groups_ = 0, solvers_ = 0, setups_ = 0;
};

MienRigDesc random_desc(Random& random) {
  const std::vector<uint32_t> isas = present_isas();
  MienRigDesc desc = sized<MienRigDesc>();
  desc.isa = isas[random.below(static_cast<uint32_t>(isas.size()))];
  desc.rotation_output =
      random.below(2) ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
  desc.ml_masks = random.below(2) ? MIEN_ML_MASKS_BLEND : MIEN_ML_MASKS_SWITCH;
  desc.storage = random.below(4) ? MIEN_STORAGE_32_BIT : MIEN_STORAGE_16_BIT;
  desc.arithmetic = random.below(4) ? MIEN_ARITHMETIC_FAST : MIEN_ARITHMETIC_PORTABLE;
  desc.reuse = random.below(3) ? MIEN_REUSE_UNCHANGED : MIEN_REUSE_SUMS;
  return desc;
}

uint64_t number_from(const char* variable, uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text && *text ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// `share` of the sequences of the long form, at least `least`, in runs of 64 on one pair of rigs.
/// Calls make_file(random, run) for each run.
template <class MakeFile>
void run_twins(uint64_t stream, double share, uint64_t least, MakeFile&& make_file) {
  constexpr uint64_t kSequences = 64;
  const auto wanted = static_cast<uint64_t>(
      share * static_cast<double>(number_from("MIEN_TWIN_SEQUENCES", rounds(0, 1000000))));
  const uint64_t first = number_from("MIEN_TWIN_FIRST", 0);
  const uint64_t runs = (std::max(wanted, least) + kSequences - 1) / kSequences;
  for (uint64_t run = first; run < first + runs; ++run) {
    Random random = Random::from_seed(run + 1, stream);
    const std::vector<uint8_t> bytes = make_file(random, run);
    const DnaHandle dna = open_dna(bytes);
    const MienRigDesc desc = random_desc(random);
    SCOPED_TRACE("MIEN_TWIN_FIRST=" + std::to_string(run) + ", " + mien_isa_name(desc.isa));
    TwinRun twins(dna.get(), desc);
    for (uint64_t i = 0; i < kSequences; ++i) {
      twins.run(Random::from_seed(run + 1, stream + 1 + i));
      if (testing::Test::HasFailure()) return;
    }
  }
  std::printf("  %llu sequences of calls\n", static_cast<unsigned long long>(runs * kSequences));
}

std::vector<uint8_t> layer_file(Random& random, bool wild, bool tangled) {
  return LayerFile(random_layer_rig(random, wild, tangled)).bytes;
}

TEST(Reuse, TwinsOfRigsWithAllLayers) {
  run_twins(100, 0.3, 3000,
            [](Random& random, uint64_t) { return layer_file(random, false, false); });
}

TEST(Reuse, TwinsOfRigsWithWildNumbers) {
  run_twins(200, 0.1, 1000,
            [](Random& random, uint64_t) { return layer_file(random, true, false); });
}

// Networks and poses read and write any control: raw ones, correctives, each other's.
TEST(Reuse, TwinsOfTangledRigs) {
  run_twins(300, 0.3, 3000,
            [](Random& random, uint64_t) { return layer_file(random, random.chance(0.2), true); });
}

TEST(Reuse, TwinsOfRigsWithoutExtensions) {
  run_twins(400, 0.1, 1000, [](Random& random, uint64_t) {
    Arena arena(default_allocator());
    return write_view(to_view(random_rig(random), arena));
  });
}

TEST(Reuse, TwinsOfGeneratedFaces) {
  run_twins(500, 0.05, 300, [](Random& random, uint64_t) {
    const uint32_t preset = random.below(2) ? MIEN_PRESET_TINY : MIEN_PRESET_SMALL;
    return write_dna(generate_dna(preset, random.below(1000)).get());
  });
}

TEST(Reuse, TwinsOfGoldenRigs) {
  const std::vector<std::string> names = golden::present_names();
  run_twins(600, 0.15, 64 * names.size(),
            [&](Random&, uint64_t run) { return golden::read_rig(names[run % names.size()]); });
}

// More panels of the joint matrix than there are marks for: several share one.
TEST(Reuse, TwinsOfPanelsThatShareMarks) {
  Random random = Random::from_seed(700, 1);
  LayerRig layers;
  layers.base.lod_count = 33;
  layers.base.raw_count = 6;
  layers.base.joint_count = 220;
  PlainGroup group;
  for (uint16_t c = 0; c < layers.base.raw_count; ++c) group.inputs.push_back(c);
  for (uint16_t r = 0; r < 9 * layers.base.joint_count; ++r) group.outputs.push_back(r);
  for (uint16_t l = 0; l < layers.base.lod_count; ++l) {
    group.lods.push_back(static_cast<uint16_t>(group.outputs.size() - 56 * l));
  }
  for (size_t i = 0; i < group.inputs.size() * group.outputs.size(); ++i) {
    group.values.push_back(static_cast<float>(random.between(-1, 1)));
  }
  layers.base.groups = {group};
  const LayerFile file(layers);
  const RigHandle rig = create_rig(file.dna.get());
  ASSERT_TRUE(rig);
  EXPECT_GT(capi::object(rig.get())->joints.panel_shift, 0u);
  TwinRun twins(file.dna.get(), sized<MienRigDesc>());
  for (uint64_t i = 0; i < 100 && !testing::Test::HasFailure(); ++i) {
    twins.run(Random::from_seed(701, i));
  }
}

// Calls that once kept what they should not ------------------------------------------------------

/// Evaluates everything on `c` and on a new instance with the same inputs.
void expect_as_new(const RigHandle& rig, Character& c, uint32_t lod) {
  Character fresh(rig);
  std::copy(c.raw.begin(), c.raw.end(), fresh.raw.begin());
  std::copy(c.masks.begin(), c.masks.end(), fresh.masks.begin());
  fresh.evaluate(lod);
  c.evaluate(lod);
  EXPECT_TRUE(same_results(c, fresh));
}

/// Joints of a new state are evaluated before the controls of networks, poses and correctives that
/// they read.
void expect_joints_before_controls_do_no_harm(const RigHandle& rig) {
  for (uint32_t stages = 0; stages < MIEN_STAGE_ALL; ++stages) {
    SCOPED_TRACE("stages " + std::to_string(stages));
    Character c(rig);
    std::fill(c.raw.begin(), c.raw.end(), 0.75f);
    const std::vector<float> raw(c.raw.begin(), c.raw.end());
    c.evaluate(0);
    ASSERT_EQ(mien_instance_reset(c.instance.get()), MIEN_OK);
    std::copy(raw.begin(), raw.end(), c.raw.begin());
    c.evaluate(0, stages);
    expect_as_new(rig, c, 0);
    const uint32_t last = info_of(rig).lod_count - 1;
    c.evaluate(last, stages);
    expect_as_new(rig, c, last);
  }
}

TEST(Reuse, SomeStagesAfterAResetOrAnotherLodDoNoHarm) {
  Random random = Random::from_seed(31, 1);
  for (int i = 0; i < 8; ++i) {
    const std::vector<uint8_t> bytes = layer_file(random, false, false);
    expect_joints_before_controls_do_no_harm(create_rig(open_dna(bytes).get()));
  }
  for (const char* name : {"tiny", "ml", "ml_ext"}) {
    SCOPED_TRACE(name);
    const std::vector<uint8_t> bytes = golden::read_rig(name);
    expect_joints_before_controls_do_no_harm(create_rig(open_dna(bytes).get()));
  }
}

/// A network y = x + 0.5 from one control to another one, and a channel that shows the latter.
LayerRig network_rig(uint16_t input, uint16_t output) {
  LayerRig rig;
  rig.base.raw_count = 2;
  rig.base.psd_count = 1;
  rig.base.psds = {{2, 0, 1}};
  rig.base.channel_count = 1;
  rig.base.channel_inputs = {output};
  rig.base.channel_outputs = {0};
  rig.base.channel_lods = {1};
  rig.networks = {{{input}, {output}, {{{0.5f}, {1}, 0, {}}}}};
  rig.regions = {{0}};
  return rig;
}

TEST(Reuse, ARawControlThatANetworkWritesIsWrittenAgain) {
  const LayerFile file(network_rig(0, 1));
  const RigHandle rig = create_rig(file.dna.get());
  Character c(rig);
  for (int frame = 0; frame < 3; ++frame) {
    c.raw[0] = 0.25f;
    c.raw[1] = 0;  // the caller writes its whole array
    c.evaluate(0);
    EXPECT_EQ(c.raw[1], 0.75f);
    EXPECT_EQ(c.channels[0], 0.75f);
  }
}

TEST(Reuse, ACorrectiveHasTheLastWord) {
  const LayerFile file(network_rig(0, 2));
  const RigHandle rig = create_rig(file.dna.get());
  Character c(rig);
  for (int frame = 0; frame < 3; ++frame) {
    c.raw[0] = 0.25f;
    c.evaluate(0);
    EXPECT_EQ(c.channels[0], 0.25f) << "the network writes 0.75 first";
  }
}

TEST(Reuse, ANetworkThatReadsWhatItWritesRunsEachTime) {
  const LayerFile file(network_rig(1, 1));
  const RigHandle rig = create_rig(file.dna.get());
  Character c(rig);
  for (int frame = 1; frame < 4; ++frame) {
    c.evaluate(0);
    EXPECT_EQ(c.channels[0], 0.5f * static_cast<float>(frame));
  }
}

TEST(Reuse, ANetworkThatReadsACorrectiveSeesThatOfTheLastFrame) {
  LayerRig layers = network_rig(2, 1);
  layers.base.channel_count =
      2;  // the second one shows the corrective, so that the LOD computes it
  layers.base.channel_inputs.push_back(2);
  layers.base.channel_outputs.push_back(1);
  layers.base.channel_lods = {2};
  const LayerFile file(layers);
  const RigHandle rig = create_rig(file.dna.get());
  Character c(rig);
  c.raw[0] = 0.25f;
  c.evaluate(0);
  EXPECT_EQ(c.channels[0], 0.5f);
  c.evaluate(0);
  EXPECT_EQ(c.channels[0], 0.75f);
  c.evaluate(0);
  EXPECT_EQ(c.channels[0], 0.75f);
}

// That anything is kept at all --------------------------------------------------------------------

// The caller must not write outputs. A value that it puts there stays as long as nothing is computed.
TEST(Reuse, KeepsWhatDidNotChange) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 1);
  MienRigDesc desc = sized<MienRigDesc>();
  for (uint32_t reuse : {MIEN_REUSE_UNCHANGED, MIEN_REUSE_NOTHING}) {
    desc.reuse = reuse;
    const RigHandle rig = create_rig(dna.get(), desc);
    Character c(rig);
    std::fill(c.raw.begin(), c.raw.end(), 0.5f);
    c.evaluate(0);
    MienIndex16View variable;
    ASSERT_EQ(mien_rig_variable_joint_values(rig.get(), 0, &variable), MIEN_OK);
    const float before = c.joints[variable.data[0]];
    const_cast<float&>(c.joints[variable.data[0]]) = 12345.0f;
    c.evaluate(0);
    EXPECT_EQ(c.joints[variable.data[0]], reuse == MIEN_REUSE_UNCHANGED ? 12345.0f : before);
  }
}

// The same for stages that do not depend on a control that changed.
TEST(Reuse, KeepsStagesThatDoNotReadWhatChanged) {
  LayerRig layers = network_rig(0, 1);
  layers.base.raw_count = 3;
  layers.base.psds = {{3, 0, 1}};
  const LayerFile file(layers);
  const RigHandle rig = create_rig(file.dna.get());
  Character c(rig);
  c.evaluate(0);
  const_cast<float&>(c.channels[0]) = 12345.0f;
  c.raw[2] = 1;
  c.evaluate(0);
  EXPECT_EQ(c.channels[0], 12345.0f);
  c.raw[0] = 1;
  c.evaluate(0);
  EXPECT_EQ(c.channels[0], 1.5f);
}

TEST(Reuse, IsOneOfItsValues) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_TINY, 1);
  MienRigDesc desc = sized<MienRigDesc>();
  desc.reuse = MIEN_REUSE_SUMS + 1;
  MienRig* rig = nullptr;
  EXPECT_EQ(mien_rig_create(dna.get(), &desc, &rig, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace mien
