// SPDX-License-Identifier: MIT
// docs/rig-evaluation.md, 12.9 "Finite inputs give finite outputs": whatever finite numbers come
// in, no result is infinite or not a number. Some seconds of it; MIEN_LONG=1 in the environment
// makes it a million frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/support/random_layer_rig.h"

namespace mien {
namespace {

size_t frame_count() {
  const char* wanted = std::getenv("MIEN_LONG");
  return wanted && *wanted && *wanted != '0' ? 1000000 : 200000;
}

/// Wild, ordinary, or all the same.
void fill(const Span<float>& values, Random& random) {
  const uint32_t kind = random.below(4);
  const float same = wild_float(random);
  for (float& value : values) {
    value = kind == 0   ? same
            : kind == 1 ? static_cast<float>(random.between(-1, 1))
                        : wild_float(random);
  }
}

testing::AssertionResult all_finite(const Character& character) {
  const struct {
    const char* name;
    Span<const float> values;
  } parts[] = {{"control", character.controls},
               {"joint value", character.joints},
               {"channel", character.channels},
               {"map", character.maps},
               {"GUI control", {character.gui.data, character.gui.count}}};
  for (const auto& part : parts) {
    for (size_t i = 0; i < part.values.count; ++i) {
      if (std::isfinite(part.values[i])) continue;
      return testing::AssertionFailure() << part.name << " " << i << " is " << part.values[i];
    }
  }
  return testing::AssertionSuccess();
}

void run_frames(bool wild_rigs, uint64_t seed) {
  constexpr size_t kFramesPerRig = 50;
  Random random = Random::from_seed(41, seed);
  const std::vector<uint32_t> isas = present_isas();
  size_t frames = 0;
  for (uint32_t rig_number = 0; frames < frame_count() / 2; ++rig_number) {
    const LayerRig rig = random_layer_rig(random, wild_rigs);
    const LayerFile file(rig);
    ASSERT_TRUE(file.dna);
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = isas[rig_number % isas.size()];
    desc.rotation_output = rig_number / 2 % 2;
    desc.ml_masks = rig_number / 4 % 2;
    desc.storage = rig_number / 8 % 2;
    MienRig* made = nullptr;
    MienError error = sized<MienError>();
    ASSERT_EQ(mien_rig_create(file.dna.get(), &desc, &made, &error), MIEN_OK) << error.message;
    Character character{RigHandle(made)};
    for (size_t f = 0; f < kFramesPerRig; ++f, ++frames) {
      fill(character.gui, random);
      fill(character.raw, random);
      fill(character.masks, random);
      if (random.chance(0.2)) character.map_gui_to_raw();
      character.evaluate(random.below(2));
      if (random.chance(0.2)) character.map_raw_to_gui();
      ASSERT_TRUE(all_finite(character))
          << mien_isa_name(desc.isa) << ", rig " << rig_number << ", frame " << f
          << ", output form " << desc.rotation_output << ", masks " << desc.ml_masks << ", storage "
          << desc.storage;
    }
  }
  std::printf("  %zu frames\n", frames);
}

TEST(FiniteInputs, GiveFiniteOutputs) { run_frames(false, 1); }

TEST(FiniteInputs, GiveThemEvenWithFilesOfWildNumbers) { run_frames(true, 2); }

}  // namespace
}  // namespace mien
