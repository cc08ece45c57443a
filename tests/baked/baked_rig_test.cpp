// SPDX-License-Identifier: MIT
// Baked rigs: what is opened is what was baked, and whatever else is opened does no harm.
#include <gtest/gtest.h>

#include "tests/support/baked_bytes.h"
#include "tests/support/bytes.h"
#include "tests/support/long_run.h"
#include "tests/support/many_rigs.h"
#include "tests/support/random_layer_rig.h"

namespace mien {
namespace {

/// A rig that keeps the file alive.
RigHandle open_rig(const AlignedBytes& bytes, uint32_t isa = MIEN_ISA_BEST) {
  return rig_of(open_baked(bytes), isa);
}

/// With networks.
Bytes ml_baked() {
  return bake(create_rig(generate_dna(MIEN_PRESET_TINY, 1, MIEN_GENERATE_ML).get()).get());
}

// What is opened is what was baked ---------------------------------------------------------------

void expect_same(const MienDna* dna, const MienRigDesc& desc) {
  RigHandle rig = create_rig(dna, desc);
  const Bytes bytes = bake(rig.get());
  const AlignedBytes file(bytes);
  RigHandle opened = open_rig(file, desc.isa);
  ASSERT_TRUE(opened);
  EXPECT_TRUE(bake(opened.get()) == bytes) << "baked again, but with other bytes";

  MienRigInfo info = info_of(rig), again = info_of(opened);
  EXPECT_EQ(info.instance_bytes, again.instance_bytes);
  info.rig_bytes = again.rig_bytes = 0;
  EXPECT_EQ(memcmp(&info, &again, sizeof(info)), 0);
  for (uint32_t kind = 0; kind <= MIEN_KIND_TWIST_SWING; ++kind) {
    EXPECT_EQ(names_of(rig, kind), names_of(opened, kind));
  }

  Character a(rig), b(opened);
  Random random = Random::from_seed(5, 1);
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    for (uint32_t percent : {0u, 20u, 100u}) {
      draw_controls(random, percent, a.raw);
      std::copy(a.raw.begin(), a.raw.end(), b.raw.begin());
      for (size_t m = 0; m < a.masks.count; ++m) {
        a.masks[m] = b.masks[m] = static_cast<float>(random.below(5)) / 4;
      }
      a.evaluate(lod);
      b.evaluate(lod);
      EXPECT_TRUE(same_results(a, b)) << "LOD " << lod;
    }
    for (size_t i = 0; i < a.gui.count; ++i) {
      a.gui[i] = b.gui[i] = static_cast<float>(random.below(100)) / 50 - 1;
    }
    a.map_gui_to_raw();
    b.map_gui_to_raw();
    EXPECT_TRUE(same_bits(a.controls, b.controls));
    a.map_raw_to_gui();
    b.map_raw_to_gui();
    EXPECT_TRUE(same_bits(a.gui, b.gui));
  }
}

TEST(BakedRig, EvaluatesAsTheRigThatWasBaked) {
  for_each_dna(8, [](const DnaHandle& dna) {
    for_each_rig_desc([&](MienRigDesc desc) {
      for (uint32_t masks : {MIEN_ML_MASKS_SWITCH, MIEN_ML_MASKS_BLEND}) {
        desc.ml_masks = masks;
        desc.arithmetic = masks;  // each of them once
        expect_same(dna.get(), desc);
      }
    });
  });
}

TEST(BakedRig, NetworksBodiesAndOtherSystems) {
  const DnaHandle rigs[] = {generate_dna(MIEN_PRESET_TINY, 1, MIEN_GENERATE_ML),
                            generate_dna(MIEN_PRESET_BODY, 1, MIEN_GENERATE_ML),
                            generate_dna(MIEN_PRESET_HEAD, 0), generate_dna(MIEN_PRESET_LARGE, 2)};
  for (const DnaHandle& dna : rigs) {
    for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
      MienRigDesc desc = sized<MienRigDesc>();
      desc.rotation_output = desc.storage = rotation;
      expect_same(dna.get(), desc);
    }
  }
  MienCoordinateSystem system = sized<MienCoordinateSystem>();
  ASSERT_EQ(mien_coordinate_system_find("unreal", &system), MIEN_OK);
  const Bytes bytes = write_dna(rigs[0].get());
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.system = &system;
  MienDna* dna = nullptr;
  ASSERT_EQ(mien_dna_open_memory(bytes.data(), bytes.size(), &desc, &dna, nullptr), MIEN_OK);
  const DnaHandle converted(dna);
  expect_same(converted.get(), sized<MienRigDesc>());
}

TEST(BakedRig, DoesNotDependOnTheInstructionSet) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  const Bytes expected = bake(create_rig(dna.get()).get());
  for (uint32_t isa : present_isas()) {
    EXPECT_TRUE(bake(create_rig(dna.get(), isa).get()) == expected) << mien_isa_name(isa);
  }
}

TEST(BakedRig, ReuseIsChosenWhenItIsOpened) {
  const AlignedBytes file(tiny_baked());
  MienBakedRigDesc desc = sized<MienBakedRigDesc>();
  desc.reuse = MIEN_REUSE_NOTHING;
  MienRig* rig = nullptr;
  ASSERT_EQ(mien_rig_from_baked(open_baked(file).get(), &desc, &rig, nullptr), MIEN_OK);
  const RigHandle opened(rig);
  EXPECT_TRUE(reinterpret_cast<const Rig*>(rig)->always_evaluate);
  EXPECT_TRUE(bake(rig) == tiny_baked());
}

TEST(BakedRig, KeepsSumsAsTheRigThatWasBaked) {
  const DnaHandle dna = generate_dna(MIEN_PRESET_SMALL, 3);
  MienRigDesc of_dna = sized<MienRigDesc>();
  of_dna.reuse = MIEN_REUSE_SUMS;
  const RigHandle made = create_rig(dna.get(), of_dna);
  const AlignedBytes file(bake(made.get()));
  MienBakedRigDesc desc = sized<MienBakedRigDesc>();
  desc.reuse = MIEN_REUSE_SUMS;
  MienRig* rig = nullptr;
  ASSERT_EQ(mien_rig_from_baked(open_baked(file).get(), &desc, &rig, nullptr), MIEN_OK);
  const RigHandle opened(rig);
  Character a(made), b(opened);
  for (uint32_t frame = 0; frame < 30; ++frame) {
    a.raw[frame] = b.raw[frame] = 0.3f;
    a.evaluate(0);
    b.evaluate(0);
    EXPECT_TRUE(same_bits(a.joints, b.joints)) << frame;
  }
  EXPECT_GT(capi::object(a.instance.get())->changes->roundings, 0u);
}

// Damage where it would hurt --------------------------------------------------------------------

// Each byte of what is not mere numbers: one bit of it, all of it, and the largest value.
TEST(BakedRig, AnyChangeIsRefusedOrDoesNoHarm) {
  size_t refused = 0, survived = 0;
  for (const Bytes& whole : {tiny_baked(), ml_baked()}) {
    const AlignedBytes file(whole);
    for (size_t at = 0; at < whole.size(); at += byte_stride()) {
      for (const int change : {1 << at % 8, 0xFF, -1}) {
        const auto byte = static_cast<uint8_t>(change < 0 ? 0xFF : whole[at] ^ change);
        file.data()[at] = byte;
        const ExerciseBaked life = exercise_baked(file.data(), file.size());
        ++(life.opened == MIEN_OK ? survived : refused);
        EXPECT_EQ(life.broken, "") << "byte " << at << " is " << unsigned{byte};
      }
      file.data()[at] = whole[at];
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(refused, survived / 4);
  EXPECT_GT(survived, 0u);
}

TEST(BakedRig, BlocksStayInTheirTiles) {
  OpenBaked tiny(tiny_baked()), tall(bake(make_rig(tall_rig()).get()));
  for (OpenBaked* file : {&tiny, &tall}) {
    const JointMatrix& joints = file->arrays().joints;
    const uint32_t panels = joints.panel_count();
    const uint32_t blocks = joints.panels[panels].first_block_row;
    for (size_t p : {size_t{0}, joints.block_rows.count / 2, joints.block_rows.count - 1}) {
      for (uint32_t value : {joints.block_rows[p] + 1u, joints.block_rows[p] + 2u,
                             blocks * kBlockRowUnit, 0xFFFCu}) {
        EXPECT_EQ(file->status_with(joints.block_rows, p, value), MIEN_ERROR_BAKED_STRUCTURE);
      }
    }

    // What of a column stands before a panel.
    const size_t column = joints.columns.count / 2 * joints.panels.count;
    for (uint16_t ColumnPart::*kind : {&ColumnPart::pairs, &ColumnPart::singles}) {
      const auto refused = [&](size_t panel, uint32_t value) {
        EXPECT_EQ(
            file->status_with(Span<uint16_t>{&(joints.parts[column + panel].*kind), 1}, 0, value),
            MIEN_ERROR_BAKED_STRUCTURE)
            << "panel " << panel << ": " << value;
      };
      const uint32_t count = joints.parts[column + panels].*kind;
      refused(0, 1);
      for (uint32_t value : {count - 1, count + 1, 0xFFFFu}) refused(panels, value);
      for (uint32_t panel = 1; panel < panels; ++panel) {
        refused(panel, count + 1);
        const uint32_t before = joints.parts[column + panel - 1].*kind;
        if (before != 0) refused(panel, before - 1);
      }
    }
  }

  // Another block of the tile gives nonsense and does no harm; one of another tile would.
  const JointMatrix& joints = tall.arrays().joints;
  uint32_t last_tile = 0;
  while (joints.tile_end(last_tile) < joints.panel_count()) last_tile = joints.tile_end(last_tile);
  const uint32_t end_of_first = joints.panels[joints.tile_end(0)].first_block_row;
  const uint32_t first_of_last = joints.panels[last_tile].first_block_row;
  const uint32_t last = joints.panels[joints.panel_count()].first_block_row - 1;
  const size_t early = 0, late = joints.starts[1].pair_entry - 1;  // of the first column
  ASSERT_LT(joints.block_rows[early], end_of_first * kBlockRowUnit);
  ASSERT_GE(joints.block_rows[late], first_of_last * kBlockRowUnit);
  const auto status_with = [&](size_t piece, uint32_t block) {
    return tall.status_with(joints.block_rows, piece, block * kBlockRowUnit);
  };
  for (uint32_t block : {0u, end_of_first - 1}) EXPECT_EQ(status_with(early, block), MIEN_OK);
  for (uint32_t block : {first_of_last, last}) EXPECT_EQ(status_with(late, block), MIEN_OK);
  EXPECT_EQ(status_with(early, end_of_first), MIEN_ERROR_BAKED_STRUCTURE);
  EXPECT_EQ(status_with(late, first_of_last - 1), MIEN_ERROR_BAKED_STRUCTURE);
}

/// What a packet gives, and what each of it gives alone.
struct Results {
  std::vector<std::vector<float>> together, alone;
};

/// Everybody moves the first `common` controls, and hardly anybody one of the last ones: columns of
/// those are summed together, of these apart.
Results results_of(const RigHandle& rig, uint32_t lod, uint32_t common) {
  constexpr uint32_t kCount = 32, kLast = 15;
  MienBatch* made = nullptr;
  const MienBatchDesc desc = batch_desc(kCount);
  EXPECT_EQ(mien_batch_create(rig.get(), &desc, &made, nullptr), MIEN_OK);
  const BatchHandle batch(made);
  Random random = Random::from_seed(15, common);
  std::vector<Character> together, alone;
  std::vector<MienInstance*> handles;
  for (uint32_t i = 0; i < kCount; ++i) {
    together.emplace_back(rig);
    alone.emplace_back(rig);
    handles.push_back(together.back().instance.get());
    const Span<float>& raw = alone.back().raw;
    for (size_t c = 0; c < raw.count; ++c) {
      const bool moves = c < common || (c + kLast >= raw.count && (c + i) % 16 == 0);
      raw[c] = moves ? static_cast<float>(1 + random.below(8)) : 0;
    }
    std::copy(alone.back().raw.begin(), alone.back().raw.end(), together.back().raw.begin());
  }
  const std::vector<uint32_t> lods(kCount, lod);
  EXPECT_EQ(mien_rig_evaluate_batch(rig.get(), made, handles.data(), lods.data(), kCount,
                                    MIEN_STAGE_ALL, nullptr),
            MIEN_OK);
  Results results;
  for (uint32_t i = 0; i < kCount; ++i) {
    alone[i].evaluate(lod);
    results.together.push_back(together[i].results());
    results.alone.push_back(alone[i].results());
  }
  return results;
}

// What is said to be of a LOD, but adds to blocks that it does not have, is lost: it reaches
// neither another character nor what is behind.
TEST(BakedRig, SumsOutsideOfTheLodReachNobody) {
  OpenBaked file(bake(make_rig(tall_rig()).get()));
  const JointMatrix& joints = file.arrays().joints;
  const uint32_t panels = joints.panels_at_lod[1];
  const uint32_t first = joints.panels[panels].first_block_row;
  const uint32_t end = joints.panels[joints.tile_end(0)].first_block_row;
  ASSERT_LT(first + 2, end);
  size_t moved = 0;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    const uint32_t pairs = joints.part(k, panels).pairs;
    if (pairs == 0) continue;
    const uint32_t block = first + (k % 2 ? 0 : (end - first) / 4 * 2);
    joints.block_rows[joints.starts[k].pair_entry + pairs - 1] =
        static_cast<uint16_t>(block * kBlockRowUnit);
    ++moved;
  }
  ASSERT_GT(moved, 10u);
  ASSERT_EQ(exercise_baked(file.bytes.data(), file.bytes.size()).opened, MIEN_OK);
  for (uint32_t common : {12, 40, 60}) {
    const Results results = results_of(file.rig, 1, common);
    EXPECT_TRUE(results.together == results.alone) << common;
  }
}

// A pair stands in an even block and the next one, whichever of them is named.
TEST(BakedRig, PairsBeginWithEvenBlocks) {
  OpenBaked file(bake(make_rig(tall_rig()).get()));
  const JointMatrix& joints = file.arrays().joints;
  const Results before = results_of(file.rig, 0, 12);
  for (size_t k = 0; k < joints.columns.count; ++k) {
    const uint32_t pairs = joints.part(k, joints.panel_count()).pairs;
    for (uint32_t i = 0; i < pairs; ++i)
      joints.block_rows[joints.starts[k].pair_entry + i] += kBlockRowUnit;
  }
  for (uint32_t isa : present_isas()) {
    const ExerciseBaked life = exercise_baked(file.bytes.data(), file.bytes.size(), isa);
    EXPECT_EQ(life.opened, MIEN_OK);
    EXPECT_EQ(life.broken, "");
  }
  const Results after = results_of(file.rig, 0, 12);
  EXPECT_TRUE(after.alone == before.alone);
  EXPECT_TRUE(after.together == before.together);
}

TEST(BakedRig, TargetsStayInTheirPanels) {
  OpenBaked file(bake(make_rig(tall_rig()).get()));
  const Rig& rig = file.arrays();
  const JointMatrix& joints = rig.joints;
  for (uint32_t panel : {0u, joints.panel_count() - 1}) {
    const JointPanel &at = joints.panels[panel], &next = joints.panels[panel + 1];
    const uint32_t packed_rows = (next.first_block_row - at.first_block_row) * kJointBlockRows;
    uint32_t end = at.first_target;
    for (uint32_t kind = 0; kind < kTargetKinds; ++kind) {
      const uint32_t first = end, rows = kTargetRows[kind];
      end += joints.targets_at_lod[(size_t{panel} * kTargetKinds + kind) * rig.lod_count];
      if (first == end) continue;
      for (uint32_t t : {first, end - 1}) {
        JointTarget& target = joints.targets[t];
        const Span<uint16_t> fields[] = {
            {&target.packed_row, 1}, {&target.output, 1}, {&target.group, 1}};
        const uint32_t most[] = {packed_rows - rows, rig.joint_value_count() - rows,
                                 joints.group_count - 1};
        for (size_t f = 0; f < 3; ++f) {
          EXPECT_EQ(file.status_with(fields[f], 0, most[f]), MIEN_OK);
          EXPECT_EQ(file.status_with(fields[f], 0, most[f] + 1), MIEN_ERROR_BAKED_STRUCTURE);
        }
      }
    }
    EXPECT_EQ(end, next.first_target);
  }
}

// Those of all panels at once: a LOD must not write what it did not sum.
TEST(BakedRig, TargetsOfALodHaveSums) {
  OpenBaked file(bake(create_rig(generate_dna(MIEN_PRESET_SMALL, 3).get()).get()));
  const Rig& rig = file.arrays();
  const JointMatrix& joints = rig.joints;
  ASSERT_TRUE(joints.fits_tile());
  uint32_t first = joints.panels[joints.panel_count()].first_target;
  size_t found = 0;
  for (uint32_t kind = 0; kind < kTargetKinds; ++kind) {
    const uint16_t* at_lod =
        &joints
             .targets_at_lod[(size_t{joints.panel_count()} * kTargetKinds + kind) * rig.lod_count];
    const uint32_t rows = kTargetRows[kind];
    for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
      const uint32_t coarser = lod + 1 < rig.lod_count ? at_lod[lod + 1] : 0;
      if (at_lod[lod] == coarser) continue;
      const uint32_t packed_rows =
          joints.panels[joints.panels_at_lod[lod]].first_block_row * kJointBlockRows;
      const Span<uint16_t> packed_row = {&joints.targets[first + at_lod[lod] - 1].packed_row, 1};
      EXPECT_EQ(file.status_with(packed_row, 0, packed_rows - rows), MIEN_OK);
      EXPECT_EQ(file.status_with(packed_row, 0, packed_rows - rows + 1),
                MIEN_ERROR_BAKED_STRUCTURE);
      ++found;
    }
    first += at_lod[0];
  }
  EXPECT_GT(found, rig.lod_count);
}

// They cross the C interface as enumerations, which hosts index arrays with.
// A number of the file that nothing else contradicts must not become memory of each instance.
TEST(BakedRig, MemoryOfInstancesIsWhatStepsAndLayersAskFor) {
  Random random = Random::from_seed(71, 1);
  std::vector<uint8_t> file;
  do {
    const LayerFile layers(random_layer_rig(random, false));
    file = bake(create_rig(layers.dna.get()).get());
  } while (OpenBaked(file).arrays().ml.steps.empty());
  const uint32_t kept = OpenBaked(file).arrays().ml.widest_layer;
  const uint32_t buffer = OpenBaked(file).arrays().ml.buffer_size;
  ASSERT_EQ(exercise_baked(AlignedBytes(file).data(), file.size()).opened, MIEN_OK);
  // Numbers lie at the begin of a part, 8 bytes each: all that read like one of the two.
  uint32_t refused = 0;
  BakedPart part;
  memcpy(&part, file.data() + sizeof(BakedHeader), sizeof(part));
  for (uint32_t i = 0; i < part.number_count; ++i) {
    std::vector<uint8_t> changed = file;
    uint8_t* const at = changed.data() + part.offset + size_t{i} * sizeof(uint64_t);
    uint32_t number = 0;
    memcpy(&number, at, sizeof(number));
    if (number != kept && number != buffer) continue;
    number = 4u << 20;
    memcpy(at, &number, sizeof(number));
    const AlignedBytes bytes(changed);
    const ExerciseBaked life = exercise_baked(bytes.data(), bytes.size());
    EXPECT_EQ(life.broken, "");
    refused += life.opened == MIEN_ERROR_BAKED_STRUCTURE;
  }
  EXPECT_GE(refused, 2u);
}

TEST(BakedRig, UnitsAndAxesAreInRange) {
  const Bytes whole = tiny_baked();
  const AlignedBytes good(whole);
  const MienRigInfo info = info_of(open_rig(good));
  // Each number has a slot of eight bytes.
  const uint32_t values[] = {info.translation_unit,
                             info.rotation_unit,
                             info.rotation_sequence,
                             info.axes[0],
                             info.axes[1],
                             info.axes[2],
                             static_cast<uint32_t>(info.rotation_signs[0]),
                             static_cast<uint32_t>(info.rotation_signs[1]),
                             static_cast<uint32_t>(info.rotation_signs[2])};
  uint32_t pairs[2 * std::size(values)] = {};
  for (size_t i = 0; i < std::size(values); ++i) pairs[2 * i] = values[i];
  const auto* slots = reinterpret_cast<const uint8_t*>(pairs);
  const auto found = std::search(whole.begin(), whole.end(), slots, slots + sizeof(pairs));
  ASSERT_NE(found, whole.end());
  for (size_t i = 0; i < std::size(values); ++i) {
    AlignedBytes bad(whole);
    bad.data()[static_cast<size_t>(found - whole.begin()) + 8 * i] = 0x80;
    rig_of(open_baked(bad, MIEN_BAKED_CHECK_SAFE), MIEN_ISA_BEST, MIEN_ERROR_BAKED_STRUCTURE);
  }
}

TEST(BakedRig, RunsOfCorrectivesStayInTheirTable) {
  OpenBaked file(bake(create_rig(generate_dna(MIEN_PRESET_SMALL, 3).get()).get()));
  const PsdTable& psds = file.arrays().psds;
  const auto count = static_cast<uint32_t>(psds.run_lengths.count);
  ASSERT_GT(count, 2u);
  for (uint32_t e : {0u, count / 2, count - 1}) {
    for (uint32_t length : {0u, count - e + 1, 0xFFFFu}) {
      EXPECT_EQ(file.status_with(psds.run_lengths, e, length), MIEN_ERROR_BAKED_STRUCTURE);
    }
    EXPECT_EQ(file.status_with(psds.run_lengths, e, 1), MIEN_OK);
  }
  // As many as are left, taken to have as many inputs each as the one with the most.
  uint32_t widest = 0;
  for (uint32_t e = 0; e < count; ++e) {
    const auto inputs = [&](uint32_t i) { return psds.first_input[i + 1] - psds.first_input[i]; };
    if (inputs(e) > inputs(widest)) widest = e;
  }
  const uint64_t last =
      psds.first_input[widest] +
      uint64_t{count - widest} * (psds.first_input[widest + 1] - psds.first_input[widest]);
  ASSERT_GT(last, psds.inputs.count);
  EXPECT_EQ(file.status_with(psds.run_lengths, widest, count - widest), MIEN_ERROR_BAKED_STRUCTURE);
}

// Wrong, but harmless: only those who ask for all checks are told, and only if the checksum does
// not tell them first.
TEST(BakedRig, FullCheckKnowsTheOrderOfCorrectives) {
  OpenBaked file(tiny_baked());
  const PsdTable& psds = file.arrays().psds;
  ASSERT_EQ(psds.outputs.count, 2u);
  psds.inputs[0] = psds.outputs[1];
  EXPECT_EQ(exercise_baked(file.bytes.data(), file.bytes.size()).broken, "");
  rig_of(open_baked(file.bytes, MIEN_BAKED_CHECK_SAFE));
  file.seal();
  rig_of(open_baked(file.bytes), MIEN_ISA_BEST, MIEN_ERROR_BAKED_STRUCTURE);

  psds.inputs[0] = 0;
  EXPECT_EQ(file.status_with(psds.outputs, 0, psds.outputs[0] - 1u), MIEN_ERROR_BAKED_STRUCTURE)
      << "a raw control";
  EXPECT_EQ(file.status_with(psds.outputs, 1, psds.outputs[1] + 1u), MIEN_ERROR_BAKED_STRUCTURE)
      << "a control of the next kind";
}

}  // namespace
}  // namespace mien
