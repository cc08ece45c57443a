// SPDX-License-Identifier: MIT
// One channel of one block -> bits (clip_block.h).
#pragma once

#include "runtime/anim/clip_block.h"

namespace mien {

/// Appends bits to zeroed bytes; without bytes it counts them.
struct BitWriter {
  uint8_t* bytes = nullptr;
  uint64_t bit = 0;

  void put(uint64_t value, uint32_t count) {
    if (bytes) {
      for (uint32_t done = 0; done < count;) {
        const uint32_t shift = (bit + done) & 7;
        bytes[(bit + done) >> 3] |= static_cast<uint8_t>(value >> done << shift);
        done += 8 - shift;
      }
    }
    bit += count;
  }
};

/// Writes the samples of up to kBlockFrames frames in the mode and form that take fewest bits.
BlockMode encode_channel(const float* samples, uint32_t count, BitWriter& writer);

/// Grids are used for |k| below this, where k is exact as a float.
constexpr double kMaxGridNumber = 4e6;

}  // namespace mien
