// SPDX-License-Identifier: MIT
// One test over rigs of many kinds, and over all that a rig can be asked for.
#pragma once

#include <string>

#include "tests/support/plain_rig.h"
#include "tests/support/rig_handles.h"
#include "tests/support/tiny_rig.h"

namespace mien {

/// Calls f(DNA) for a rig with all layers, random ones without geometry, and generated faces.
template <class F>
void for_each_dna(uint32_t random_rigs, F&& f) {
  {
    SCOPED_TRACE("tiny rig");
    Arena arena(default_allocator());
    const std::vector<uint8_t> bytes = write_view(dna::tiny_rig(arena));
    f(open_dna(bytes));
  }
  Random random = Random::from_seed(7, 1);
  for (uint32_t i = 0; i < random_rigs; ++i) {
    SCOPED_TRACE("random rig " + std::to_string(i));
    Arena arena(default_allocator());
    const std::vector<uint8_t> bytes = write_view(to_view(random_rig(random), arena));
    f(open_dna(bytes));
  }
  for (uint32_t preset : {MIEN_PRESET_TINY, MIEN_PRESET_SMALL}) {
    SCOPED_TRACE("preset " + std::to_string(preset));
    f(generate_dna(preset, 3));
  }
}

/// Calls f(description) for each instruction set, storage and form of rotations.
template <class F>
void for_each_rig_desc(F&& f) {
  for (uint32_t isa : present_isas()) {
    for (uint32_t storage : {MIEN_STORAGE_32_BIT, MIEN_STORAGE_16_BIT}) {
      for (uint32_t rotation : {MIEN_ROTATION_OUTPUT_EULER, MIEN_ROTATION_OUTPUT_QUATERNION}) {
        SCOPED_TRACE(std::string(mien_isa_name(isa)) + ", storage " + std::to_string(storage) +
                     ", rotation " + std::to_string(rotation));
        MienRigDesc desc = sized<MienRigDesc>();
        desc.isa = isa;
        desc.storage = storage;
        desc.rotation_output = rotation;
        f(desc);
      }
    }
  }
}

/// Raw controls of which about `percent` are not zero, some out of range.
inline void draw_controls(Random& random, uint32_t percent, Span<float> raw) {
  for (float& value : raw) {
    value = random.below(100) < percent ? static_cast<float>(random.below(1300)) / 1000 - 0.1f : 0;
  }
}

inline bool same_results(const Character& a, const Character& b) {
  const std::vector<float> x = a.results(), y = b.results();
  return x.size() == y.size() && memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
}

}  // namespace mien
