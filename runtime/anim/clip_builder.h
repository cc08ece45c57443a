// SPDX-License-Identifier: MIT
// Curves -> clip. A clip decodes to the same bits as it was built from or, for channels that are
// snapped, to the nearest values of a grid.
#pragma once

#include "runtime/anim/clip_block.h"
#include "runtime/base/allocator.h"

namespace mien {

struct ClipEventDesc {
  int64_t tick;   // 0 ... frames * ticks per frame - 1
  uint32_t name;  // index
  float value;
};

struct ClipDesc {
  uint32_t rate_numerator = 60, rate_denominator = 1;  // frames per second
  uint32_t frame_count = 0;
  const float* values = nullptr;       // [frame][channel]
  size_t frame_stride = 0;             // floats from frame to frame; 0: the number of channels
  Span<const Span<const char>> names;  // one for each channel, all different, none empty
  Span<const uint8_t> snaps;           // [channel] n or kNoSnap, or empty: kNoSnap
  Span<const ClipEventDesc> events;    // in any order; events of one tick keep their order
  Span<const Span<const char>> event_names;
  bool wraps = false, is_delta = false;  // as in ClipFlags
};

/// How a channel was stored.
struct ChannelReport {
  uint32_t blocks[kBlockModes];  // by mode; none for a channel that never changes
  uint64_t bits;                 // in blocks
  float max_error;               // of snapping, at most half a step
  uint32_t zero;
};

struct ClipBytes {
  Allocator allocator;
  uint8_t* bytes = nullptr;
  size_t size = 0;
};

/// `reports` has an element for each channel or is empty. On success `out` is one block of the allocator;
/// release it with release_clip(). kClipValue for a number that is not finite, with its channel and frame;
/// kName for a name that is empty or occurs twice; kClipLimit for more than the format can number;
/// kInvalidArgument; kMemory. The same input gives the same bytes everywhere.
Status build_clip(const ClipDesc& desc, const Allocator& allocator, Span<ChannelReport> reports,
                  ClipBytes& out, Error& error);
void release_clip(ClipBytes& clip);

/// The value that snapping with n turns a value into; values beyond the grid do not change.
float snapped_value(float value, uint32_t n);

}  // namespace mien
