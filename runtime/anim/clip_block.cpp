// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_block.h"

#include <cassert>

#include "simd/kernels.h"

namespace mien {
namespace {

uint64_t low_bits(uint32_t count) {
  return count >= 64 ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
}

/// Reads up to 57 bits at a time. The 8 bytes from any position up to the end of a block can be
/// loaded, because zeros follow the last block.
struct BitReader {
  const uint8_t* data;
  uint64_t bit;
  uint64_t end;  // in bits

  uint64_t take(uint32_t count) {
    if (count > end - bit) {
      bit = end;
      good = false;
      return 0;
    }
    const uint64_t bits = load_little_endian<uint64_t>(data + (bit >> 3)) >> (bit & 7);
    bit += count;
    return bits & low_bits(count);
  }
  uint64_t take64() {
    const uint64_t low = take(32);
    return low | take(32) << 32;
  }
  bool good = true;
};

uint64_t read_mask(BitReader& reader) {
  const auto edges = static_cast<uint32_t>(reader.take(3));
  if (edges == 0) return reader.take64();
  uint64_t mask = 0;
  for (uint32_t i = 0; i < edges; ++i) mask ^= ~low_bits(static_cast<uint32_t>(reader.take(6)));
  return mask;
}

struct Lane {
  ClipLanes& of;
  uint32_t at;
};

uint32_t run_width(const ClipLanes& lanes, uint32_t k, uint32_t code) {
  const uint32_t bits = lanes.width_bits[k];
  const bool highest = bits > 0 && code + 1 == 1u << bits;
  return width_of_code(highest ? lanes.largest[k] : lanes.least[k] + code);
}

/// A channel whose value does not change in the block.
void set_constant(float value, Lane lane) {
  lane.of.last[lane.at] = ordered_from_bits(bits_of(value));
  lane.of.present[lane.at] = ~0u;
}

/// Prediction by differences of differences.
void set_order(uint32_t order, uint32_t first_number, Lane lane) {
  ClipLanes& lanes = lane.of;
  lanes.linear[lane.at] = order >= 1 ? ~0u : 0;
  lanes.order[lane.at] = static_cast<int32_t>(order);
  if (order >= 2) lanes.curved[0] = 1;
  lanes.number[lane.at] = first_number;
}

/// The widths of the runs, and where the residuals begin and end.
void read_runs(BitReader& reader, uint32_t run_samples, uint32_t residuals, Lane lane) {
  ClipLanes& lanes = lane.of;
  auto code_bits = static_cast<uint32_t>(reader.take(kWidthCodeSizeBits));
  if (code_bits > kWidthCodeBits) {
    reader.good = false;
    code_bits = 0;
  }
  const auto least = static_cast<uint32_t>(reader.take(kWidthBits));
  const auto largest = static_cast<uint32_t>(reader.take(code_bits > 0 ? kWidthBits : 0));
  const uint32_t runs = (residuals + run_samples - 1) / run_samples;
  uint64_t size = 0;
  lanes.width_bits[lane.at] = static_cast<uint8_t>(code_bits);
  lanes.least[lane.at] = static_cast<uint8_t>(least);
  lanes.largest[lane.at] = static_cast<uint8_t>(largest);
  lanes.run_samples[lane.at] = static_cast<uint8_t>(run_samples);
  uint64_t widths = 0;
  for (uint32_t r = 0; r < runs; ++r) {
    const uint64_t code = reader.take(code_bits);
    const uint32_t run = r + 1 < runs ? run_samples : residuals - r * run_samples;
    widths |= code << (r * code_bits);
    size += run * run_width(lanes, lane.at, static_cast<uint32_t>(code));
  }
  lanes.widths[lane.at] = widths;
  // The first sample is a run of its own, of width 0: it repeats the prediction.
  lanes.run_width[lane.at] = 0;
  lanes.left[lane.at] = 1;
  lanes.turn[lane.at] = 0;
  lanes.turns = 1;
  lanes.bit[lane.at] = static_cast<uint32_t>(reader.bit);
  if (size > reader.end - reader.bit) {
    reader.good = false;
  } else {
    reader.bit += size;
  }
}

/// A channel in grid or float mode: leaves the reader at the next channel.
void read_channel(BitReader& reader, BlockMode mode, uint32_t frame_count, Lane lane) {
  ClipLanes& lanes = lane.of;
  const bool grid = mode == kBlockGrid;
  const auto order = static_cast<uint32_t>(reader.take(2));
  const bool masked = reader.take(1) != 0, short_runs = reader.take(1) != 0;
  const auto parameter = static_cast<uint32_t>(reader.take(grid ? 4 : 5));
  const uint64_t samples = (masked ? read_mask(reader) : ~uint64_t{0}) & low_bits(frame_count);
  const bool curve = !grid && order >= 2;  // its parameter is not a shift
  const uint32_t shift = grid || curve ? 0 : parameter;
  uint32_t first_width = 32 - shift;
  if (grid) first_width = width_of_code(static_cast<uint32_t>(reader.take(kWidthBits)));
  const auto first = static_cast<uint32_t>(reader.take(first_width));
  if (grid) {
    lanes.last[lane.at] = (first >> 1) ^ (0u - (first & 1));
    lanes.unit[lane.at] = 0;
    lanes.scale[lane.at] = kGridScales[parameter];
  } else {
    lanes.last[lane.at] = first;
    lanes.unit[lane.at] = 1u << shift;
    if (curve) lanes.scale[lane.at] = curve_scale(parameter);
  }
  lanes.samples[lane.at] = samples;
  const uint32_t last = lanes.last[lane.at];
  set_order(order, curve ? curve_number(last, lanes.scale[lane.at]) : last, lane);
  const uint32_t count = bit_count(samples);
  read_runs(reader, short_runs ? kShortRunSamples : kRunSamples, count > 0 ? count - 1 : 0, lane);
}

/// Sets up the lanes; false if the bytes are not a block. All bounds are checked here: decoding stays within
/// the widths that are added up here. `slack` is the number of bits after the last channel.
bool read_block(BlockDecoder& decoder, uint32_t block, uint64_t& slack) {
  const Clip& clip = *decoder.clip;
  const auto block_end = [&](uint32_t b) {
    return load_little_endian<uint32_t>(clip.bytes + clip.at.block_ends + b * sizeof(uint32_t));
  };
  const uint32_t begin = block == 0 ? 0 : block_end(block - 1), end = block_end(block);
  // The limit keeps positions in 32 bits.
  if (begin > end || end > block_end(clip.block_count() - 1) || end - begin > (1u << 28)) {
    return false;
  }
  decoder.data = clip.bytes + clip.at.blocks + begin;
  BitReader reader = {decoder.data, 0, uint64_t{end - begin} * 8};
  for (uint32_t i = 0; i < clip.changing_count; ++i) {
    const Lane lane = {decoder.groups[i / kClipLanes], i % kClipLanes};
    const auto mode = static_cast<BlockMode>(reader.take(2));
    if (mode == kBlockConstant) {
      const auto bits = static_cast<uint32_t>(reader.take(32));
      if ((bits & 0x7F800000) == 0x7F800000) reader.good = false;
      set_constant(float_of(bits), lane);
    } else if (mode != kBlockZero) {
      read_channel(reader, mode, decoder.end - decoder.next, lane);
    }
    if (!reader.good) return false;
  }
  slack = reader.end - reader.bit;
  return true;
}

/// Sets all lanes to zeros.
void clear_groups(BlockDecoder& decoder) {
  for (ClipLanes& group : decoder.groups) {
    // The fields of runs are set for channels that have runs.
    for (uint32_t k = 0; k < kClipLanes; ++k) {
      group.bit[k] = group.width[k] = group.mask[k] = group.last[k] = group.slope[k] = 0;
      group.linear[k] = group.present[k] = 0;
      group.number[k] = group.difference[k] = group.bend[k] = 0;
      group.order[k] = group.age[k] = 0;
      group.unit[k] = 1;
      group.scale[k] = 1;
      group.turn[k] = kBlockFrames;
    }
    group.curved[0] = 0;
    group.turns = 0;
  }
}

uint64_t enter_block(BlockDecoder& decoder, uint32_t block) {
  const uint32_t stored = decoder.clip->stored_frame_count();
  decoder.next = block * kBlockFrames;
  decoder.end = stored - decoder.next < kBlockFrames ? stored : decoder.next + kBlockFrames;
  decoder.turns = 1;
  uint64_t slack = 0;
  clear_groups(decoder);
  if (!read_block(decoder, block, slack)) {
    decoder.damaged = true;
    clear_groups(decoder);
  }
  return slack;
}

/// Starts what begins in a lane at a frame of the block: a run, a stretch of zeros, or the rest of a run
/// after such a stretch.
void turn_lane(ClipLanes& lanes, uint32_t k, uint32_t frame) {
  const uint64_t ahead = lanes.samples[k] >> frame;
  const bool present = (ahead & 1) != 0;
  const uint64_t other = present ? ~ahead : ahead;
  uint32_t frames = other != 0 ? lowest_bit(other) : kBlockFrames, width = 0;
  if (present) {
    if (lanes.left[k] == 0) {
      const uint32_t bits = lanes.width_bits[k];
      const auto code = static_cast<uint32_t>(lanes.widths[k] & low_bits(bits));
      lanes.run_width[k] = static_cast<uint8_t>(run_width(lanes, k, code));
      lanes.widths[k] >>= bits;
      lanes.left[k] = lanes.run_samples[k];
    }
    if (frames > lanes.left[k]) frames = lanes.left[k];
    lanes.left[k] = static_cast<uint8_t>(lanes.left[k] - frames);
    width = lanes.run_width[k];
  }
  lanes.present[k] = present ? ~0u : 0;
  lanes.width[k] = width;
  lanes.mask[k] = static_cast<uint32_t>(low_bits(width));
  const uint32_t turn = frame + frames;
  lanes.turn[k] = static_cast<uint8_t>(turn);
  if (turn < kBlockFrames) lanes.turns |= uint64_t{1} << turn;
}

void turn_lanes(BlockDecoder& decoder, uint32_t frame) {
  for (ClipLanes& group : decoder.groups) {
    if ((group.turns >> frame & 1) == 0) continue;
    constexpr uint64_t kLow7 = 0x7F7F7F7F7F7F7F7F;
    // Bytes are below 128, so no carry reaches the next byte.
    const uint64_t other = load_little_endian<uint64_t>(group.turn) ^ (kLow7 / 0x7F * frame);
    for (uint64_t due = ~(other + kLow7) & ~kLow7; due != 0; due &= due - 1) {
      turn_lane(group, lowest_bit(due) / 8, frame);
    }
    decoder.turns |= group.turns;
  }
}

void decode_next(BlockDecoder& decoder) {
  const uint32_t frame = decoder.next % kBlockFrames;
  if ((decoder.turns >> frame & 1) != 0) turn_lanes(decoder, frame);
  decoder.kernels->next_samples(decoder.data, decoder.groups.data, decoder.groups.count);
  ++decoder.next;
}

/// The values of the frame before `next`.
void write_row(BlockDecoder& decoder, float* row) {
  if (decoder.kernels->sample_values(decoder.groups.data, decoder.groups.count, row)) return;
  decoder.damaged = true;
}

}  // namespace

void begin_decoding(const Clip& clip, const KernelTable& kernels, Span<ClipLanes> groups,
                    BlockDecoder& decoder) {
  decoder = {};
  decoder.clip = &clip;
  decoder.kernels = &kernels;
  decoder.groups = groups.first(clip_groups(clip.changing_count));
}

void decode_frame(BlockDecoder& decoder, uint32_t frame, float* row) {
  if (decoder.clip->changing_count == 0) return;
  // The lanes still have the frame before `next`.
  const bool same_block =
      decoder.end != 0 && frame / kBlockFrames == (decoder.end - 1) / kBlockFrames;
  if (!same_block || frame + 1 < decoder.next) enter_block(decoder, frame / kBlockFrames);
  while (decoder.next <= frame) decode_next(decoder);
  write_row(decoder, row);
}

constexpr size_t kMaxGroups = clip_groups(kMaxChangingChannels);

bool read_frames(const Clip& clip, uint32_t first, uint32_t count, float* out, size_t stride) {
  assert(first <= clip.frame_count && count <= clip.frame_count - first);
  if (clip.channel_count == 0) return true;  // `out` may be null
  ClipLanes groups[kMaxGroups];
  float row[kMaxChangingChannels], before[kMaxChangingChannels];
  BlockDecoder decoder;
  begin_decoding(clip, *kernels_for(Isa::kBest), {groups, kMaxGroups}, decoder);
  const bool half_rate = clip.has(kClipHalfRate);
  for (uint32_t f = first; f < first + count; ++f, out += stride) {
    const bool is_mean = half_rate && f % 2 == 1;
    if (is_mean) decode_frame(decoder, f / 2, before);
    decode_frame(decoder, half_rate ? (f + 1) / 2 : f, row);
    for (uint32_t c = 0; c < clip.channel_count; ++c) out[c] = clip.rest(c);
    for (uint32_t i = 0; i < clip.changing_count; ++i) {
      out[clip.changing(i)] = is_mean ? half_rate_mean(before[i], row[i]) : row[i];
    }
  }
  return !decoder.damaged;
}

Status verify_clip(const Clip& clip, Error& error) {
  if (clip_checksum(clip.bytes, clip.size) !=
      load_little_endian<uint32_t>(clip.bytes + kAtChecksum)) {
    return fail(error, Status::kClipChecksum, kAtChecksum,
                "the bytes are not those that were written: the clip is damaged; fetch it again or "
                "build it again");
  }
  ClipLanes groups[kMaxGroups];
  float row[kMaxChangingChannels];
  BlockDecoder decoder;
  begin_decoding(clip, *kernels_for(Isa::kBest), {groups, kMaxGroups}, decoder);
  for (uint32_t block = 0; block < clip.block_count(); ++block) {
    const uint64_t slack = enter_block(decoder, block);
    while (decoder.next < decoder.end) {
      decode_next(decoder);
      write_row(decoder, row);
    }
    if (decoder.damaged || slack >= 8) {
      return fail(error, Status::kClipStructure, kNoOffset,
                  "block %u is damaged; fetch the clip again or build it again", block);
    }
  }
  return Status::kOk;
}

}  // namespace mien
