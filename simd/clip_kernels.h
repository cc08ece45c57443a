// SPDX-License-Identifier: MIT
// Samples of clips, eight channels at a time.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace mien {

constexpr uint32_t kClipLanes = 8;

/// The decoder state of eight channels in a block of a clip (runtime/anim/clip_block.h).
struct ClipLanes {
  uint32_t bit[kClipLanes];      // position of the next sample in the block
  uint32_t width[kClipLanes];    // bits of a sample of the current run; 0 where none is coded
  uint32_t mask[kClipLanes];     // the lowest `width` bits are 1
  uint32_t last[kClipLanes];     // grid: k; float: ordered, without its shift
  uint32_t slope[kClipLanes];    // added to `last` to predict the next sample
  uint32_t linear[kClipLanes];   // all ones or 0: order 1 or more
  uint32_t present[kClipLanes];  // all ones if the frame has a sample, 0 if it is zero
  uint32_t unit[kClipLanes];     // float: 1 << shift; grid: 0
  float scale
      [kClipLanes];  // of a grid; float of order 2 or 3: 2^s, which makes integers of it; else 1
  // Of groups with an order of 2 or 3, else unused.
  int32_t order[kClipLanes];        // 0 to 3
  int32_t age[kClipLanes];          // samples before the next one, up to 3
  uint32_t number[kClipLanes];      // the last sample: grid: k; float: times the scale, truncated
  uint32_t difference[kClipLanes];  // of the last two samples
  uint32_t bend[kClipLanes];        // of the last two differences
  // Read only where a run or a stretch of zeros begins.
  uint64_t widths[kClipLanes];     // codes of later runs less the least width, lowest first
  uint64_t samples[kClipLanes];    // bit f: frame f of the block has one
  uint8_t width_bits[kClipLanes];  // of a code in `widths`
  uint8_t least[kClipLanes];       // the width of code 0, as a code of 5 bits
  uint8_t largest[kClipLanes];     // the width of the highest code, the same
  uint8_t run_samples[kClipLanes];
  uint8_t run_width[kClipLanes];  // of the current run
  uint8_t left[kClipLanes];       // samples of the run after this stretch
  uint8_t turn[kClipLanes];       // frame of the block where the next run or stretch begins
  uint8_t
      curved[kClipLanes];  // in the first lane: not 0 if a lane of the group has an order of 2 or 3
  uint64_t turns;          // bit f: `turn` of some lane is f, or was; 0: all are constants
};
static_assert(sizeof(ClipLanes) == kClipLanes * 81, "no padding");

/// next_samples: decodes the next sample in each lane of a block. The prediction of order 0 repeats the last
/// sample, order 1 continues the last difference; orders 2 and 3 also continue its changes. For them, floats
/// are integers, and what is predicted is truncated to 24 bits: the same in all rounding modes.
using NextSamplesKernel = void(const uint8_t* block, ClipLanes* groups, size_t count);

/// sample_values: row[kClipLanes * group + lane] = value. False if one would not be finite, which gives 0.
using SampleValuesKernel = bool(const ClipLanes* groups, size_t count, float* row);

}  // namespace mien
