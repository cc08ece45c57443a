// SPDX-License-Identifier: MIT
// The blocks of a clip: 64 stored frames of every changing channel (the last block: the rest), one channel
// after the other, as one stream of bits, lowest bit of a byte first.
//
//     mode     2 bits   zero | constant | grid | float
//     constant          32 bits: the float
//     grid, float       order, 2 bits        of the prediction: 0 a, 1 2a - b, 2 3a - 3b + c, 3 4a - 6b + 4c - d
//                       masked: 1 bit        zeros (+0) are left out of the samples
//                       short runs: 1 bit    runs of 4 samples instead of 8
//                       scale, 4 bits (grid) or 5 bits (float, orders 2 and 3), or shift, 5 bits (float)
//                       mask                 if masked
//                       first sample         grid: width, 5 bits, and number; float: 32 - shift bits
//                       n, 3 bits            0 ... 4
//                       least width, 5 bits
//                       largest width, 5 bits  if n > 0
//                       widths, n bits each  of the runs; the last run is what is left
//                       residuals            of the samples after the first
//
// A sample is a 32-bit number: in a grid the integer k of the value k / scale; else the bits of the
// float, ordered like the values and without the `shift` lowest bits, which are zero in the whole
// block. A residual is sample - prediction modulo 2^32, zigzag coded: 0, -1, 1, -2, 2 ... Before the second
// sample, b is a; order 2 counts from the third sample, order 3 from the fourth. Floats of these orders are
// predicted as integers, the value times 2^(14 + scale), truncated; the prediction is truncated to 24 bits and
// ordered like the others. The width of a run is the least one plus its code; the highest code means the largest
// one. 31 and above mean 32.
//
//     mask     3 bits: n. n > 0: n places of 6 bits each, where runs of zeros and others alternate,
//              beginning with zeros; n = 0: 64 bits, one set for each sample that is there
//
// All widths precede the residuals. So the end of a channel is known without its residuals, and decoding
// reads nothing else.
//
// Reasons, measured on the curves of tests/support/clip_curves.h: with orders 2 and 3 and runs of 4 samples,
// authored and clean curves are 17 to 26 % smaller, rounded ones 4 to 9 %. Both take more time to decode, so the
// encoder uses them only where they save a tenth and a twentieth; captures gain 3 %. The escape to the
// largest width leaves room for a few large residuals where a curve begins or ends. Masks by their edges are
// smaller than 64 bits. Left out: a mode for a block that repeats the block of another channel, predictions by
// the mean of some samples (1 % smaller at best), and Rice codes, which make noise 3 % smaller but take twice
// the time to decode.
#pragma once

#include "runtime/anim/clip.h"
#include "runtime/base/bits.h"
#include "simd/clip_kernels.h"
#include "simd/isa.h"

namespace mien {

enum BlockMode : uint32_t { kBlockZero, kBlockConstant, kBlockGrid, kBlockFloat };
constexpr uint32_t kBlockModes = 4;

constexpr float kGridScales[16] = {1,    10,   100,  128,   256,   512,   1000,  1024,
                                   2048, 4096, 8192, 10000, 16384, 32768, 65536, 100000};
constexpr uint32_t kRunSamples = 8, kShortRunSamples = 4;
constexpr uint32_t kWidthBits = 5;
constexpr uint32_t kWidthCodeBits = 4;  // at most
constexpr uint32_t kWidthCodeSizeBits = 3;
constexpr uint32_t kMaxOrder = 3;

inline uint32_t width_of_code(uint32_t code) { return code >= 31 ? 32 : code; }

/// Floats as numbers in the same order; -0 is just below +0.
inline uint32_t ordered_from_bits(uint32_t bits) { return bits >> 31 ? ~bits : bits | 1u << 31; }

inline uint32_t bits_from_ordered(uint32_t ordered) {
  return ordered >> 31 ? ordered & ~(1u << 31) : ~ordered;
}

/// Floats of orders 2 and 3 as integers of at most 2^30.
constexpr uint32_t kLeastCurveExponent = 14;
inline float curve_scale(uint32_t parameter) {
  return float_of((kLeastCurveExponent + parameter + 127) << 23);
}
inline uint32_t curve_number(uint32_t ordered, float scale) {
  constexpr float kLimit = 1u << 30;
  float value = float_of(bits_from_ordered(ordered)) * scale;
  value = value < kLimit ? value : kLimit;  // damaged samples; NaN
  value = value > -kLimit ? value : -kLimit;
  return static_cast<uint32_t>(static_cast<int32_t>(value));
}

/// Groups of lanes: the i-th changing channel is lane i % kClipLanes of group i / kClipLanes.
constexpr size_t clip_groups(size_t changing) { return (changing + kClipLanes - 1) / kClipLanes; }
/// Floats of a row of changing channels: groups are written as a whole.
constexpr size_t clip_row_floats(size_t changing) { return clip_groups(changing) * kClipLanes; }

/// Decodes stored frames. A later frame of the same block costs the frames between; any other frame costs
/// decoding its block from the beginning.
struct BlockDecoder {
  const Clip* clip = nullptr;
  const KernelTable* kernels = nullptr;
  Span<ClipLanes> groups;
  uint64_t turns = 0;             // of all groups
  const uint8_t* data = nullptr;  // of the block
  uint32_t next = 0;              // stored frame that is decoded next
  uint32_t end = 0;               // end of the stored frames of the block
  bool damaged = false;           // some block was invalid, and gave zeros
};

/// Uses the memory until the decoder is done: clip_groups() of the changing channels.
void begin_decoding(const Clip& clip, const KernelTable& kernels, Span<ClipLanes> groups,
                    BlockDecoder& decoder);

/// Writes the values of a stored frame to clip_row_floats(): always finite, whatever the bytes are.
void decode_frame(BlockDecoder& decoder, uint32_t frame, float* row);

/// A frame that a half-rate clip does not store, from its neighbors.
inline float half_rate_mean(float a, float b) { return a * 0.5f + b * 0.5f; }

/// Copies `count` frames from `first` on: frame f of all channels goes to out + (f - first) * stride. Takes
/// 46 KiB of stack. False if a block was damaged: it gives zeros.
bool read_frames(const Clip& clip, uint32_t first, uint32_t count, float* out, size_t stride);

/// Whether the bytes are unchanged since they were written: checks the checksum, then every block.
/// kClipChecksum or kClipStructure.
Status verify_clip(const Clip& clip, Error& error);

}  // namespace mien
