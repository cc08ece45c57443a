// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_block.h"

#include <cassert>
#include <cstring>

#include "runtime/base/vectors.h"

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

/// A lane of the cursors that grids or floats have, which becomes the next one of a channel.
struct Lane {
  ChannelCursors& of;
  uint32_t at;
};

Lane add_lane(BlockDecoder& decoder, BlockMode mode) {
  const uint32_t place = mode == kBlockGrid ? decoder.grid_count++ : decoder.float_count++;
  const uint32_t group = place / kCursorLanes;
  ChannelCursors& cursors =
      decoder.cursors[mode == kBlockGrid ? group : decoder.cursors.count - 1 - group];
  if (place % kCursorLanes == 0) {
    cursors = {};
    for (uint32_t& unit : cursors.unit) unit = 1;
    for (uint8_t& turn : cursors.turn) turn = kBlockFrames;
    for (uint16_t& channel : cursors.channel) channel = static_cast<uint16_t>(decoder.row.count);
  }
  return {cursors, place % kCursorLanes};
}

/// A channel in grid or float mode: leaves the reader at the next channel.
void read_channel(BitReader& reader, BlockMode mode, uint32_t frame_count, Lane lane) {
  ChannelCursors& cursors = lane.of;
  const bool linear = reader.take(1) != 0, masked = reader.take(1) != 0;
  const auto parameter = static_cast<uint32_t>(reader.take(mode == kBlockGrid ? 4 : 5));
  const uint64_t samples = (masked ? read_mask(reader) : ~uint64_t{0}) & low_bits(frame_count);
  uint32_t first_width = 32 - parameter;
  if (mode == kBlockGrid) first_width = width_of_code(static_cast<uint32_t>(reader.take(5)));
  const auto first = static_cast<uint32_t>(reader.take(first_width));
  cursors.last[lane.at] =
      mode == kBlockGrid ? (first >> 1) ^ (0u - (first & 1)) : first << parameter;
  cursors.unit[lane.at] =
      mode == kBlockGrid ? static_cast<uint32_t>(kGridScales[parameter]) : 1u << parameter;
  cursors.linear[lane.at] = linear ? ~0u : 0;
  cursors.samples[lane.at] = samples;

  // The first sample is a run by itself, of no width: it repeats the prediction.
  const uint32_t count = bit_count(samples);
  const uint32_t residuals = count > 0 ? count - 1 : 0;
  const uint32_t runs = (residuals + kRunSamples - 1) / kRunSamples;
  const auto width_bits = static_cast<uint32_t>(reader.take(kWidthSizeBits));
  if (width_bits > kWidthBits) reader.good = false;
  const auto least = static_cast<uint32_t>(reader.take(width_bits < kWidthBits ? kWidthBits : 0));
  const uint64_t widths = reader.take(runs * width_bits);
  uint64_t size = 0;
  for (uint32_t r = 0; r < runs; ++r) {
    const uint32_t run = r + 1 < runs ? kRunSamples : residuals - r * kRunSamples;
    size += run * width_of_code(least + (widths >> (r * width_bits) & low_bits(width_bits)));
  }
  cursors.widths[lane.at] = widths;
  cursors.width_bits[lane.at] = static_cast<uint8_t>(width_bits);
  cursors.least[lane.at] = static_cast<uint8_t>(least);
  cursors.left[lane.at] = 1;
  cursors.turn[lane.at] = 0;
  cursors.turns = 1;
  cursors.bit[lane.at] = static_cast<uint32_t>(reader.bit);
  if (size > reader.end - reader.bit) {
    reader.good = false;
  } else {
    reader.bit += size;
  }
}

/// Sets up the cursors; false if the bytes are not a block. This is where all bounds are checked: what
/// is decoded later lies within the widths that were added up here. `slack` is the number of bits
/// after the last channel.
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
    const auto mode = static_cast<BlockMode>(reader.take(2));
    if (mode == kBlockZero) {
      decoder.row[i] = 0;
    } else if (mode == kBlockConstant) {
      const auto bits = static_cast<uint32_t>(reader.take(32));
      if ((bits & 0x7F800000) == 0x7F800000) reader.good = false;
      decoder.row[i] = float_of(bits);
    } else {
      const Lane lane = add_lane(decoder, mode);
      read_channel(reader, mode, decoder.end - decoder.next, lane);
      lane.of.channel[lane.at] = static_cast<uint16_t>(i);
    }
    if (!reader.good) return false;
  }
  slack = reader.end - reader.bit;
  return true;
}

uint64_t enter_block(BlockDecoder& decoder, uint32_t block) {
  const Clip& clip = *decoder.clip;
  const uint32_t stored = clip.stored_frame_count();
  decoder.next = block * kBlockFrames;
  decoder.end = stored - decoder.next < kBlockFrames ? stored : decoder.next + kBlockFrames;
  decoder.grid_count = decoder.float_count = 0;
  decoder.turns = 1;
  uint64_t slack = 0;
  if (!read_block(decoder, block, slack)) {
    decoder.damaged = true;
    decoder.grid_count = decoder.float_count = 0;
    for (float& value : decoder.row) value = 0;
  }
  return slack;
}

/// Calls f(cursors) for grids or floats.
template <class F>
void for_cursors(BlockDecoder& decoder, BlockMode mode, F&& f) {
  const bool grid = mode == kBlockGrid;
  const size_t count =
      ((grid ? decoder.grid_count : decoder.float_count) + kCursorLanes - 1) / kCursorLanes;
  ChannelCursors* const first = decoder.cursors.data + (grid ? 0 : decoder.cursors.count - count);
  for (size_t i = 0; i < count; ++i) f(first[i]);
}

/// What begins at a frame of the block in a lane: a run, a stretch of zeros, or the rest of a run
/// after one.
void turn_lane(ChannelCursors& cursors, uint32_t k, uint32_t frame) {
  const uint64_t ahead = cursors.samples[k] >> frame;
  const bool present = (ahead & 1) != 0;
  const uint64_t other = present ? ~ahead : ahead;
  uint32_t frames = other != 0 ? lowest_bit(other) : kBlockFrames, width = 0;
  if (present) {
    if (cursors.left[k] == 0) {
      const uint32_t bits = cursors.width_bits[k];
      const auto code = static_cast<uint32_t>(cursors.widths[k] & low_bits(bits));
      cursors.run_width[k] = static_cast<uint8_t>(width_of_code(cursors.least[k] + code));
      cursors.widths[k] >>= bits;
      cursors.left[k] = kRunSamples;
    }
    if (frames > cursors.left[k]) frames = cursors.left[k];
    cursors.left[k] = static_cast<uint8_t>(cursors.left[k] - frames);
    width = cursors.run_width[k];
  }
  cursors.present[k] = present ? ~0u : 0;
  cursors.width[k] = width;
  cursors.mask[k] = static_cast<uint32_t>(low_bits(width));
  const uint32_t turn = frame + frames;
  cursors.turn[k] = static_cast<uint8_t>(turn);
  if (turn < kBlockFrames) cursors.turns |= uint64_t{1} << turn;
}

void turn_lanes(BlockDecoder& decoder, uint32_t frame) {
  const auto turn = [&](ChannelCursors& cursors) {
    if ((cursors.turns >> frame & 1) == 0) return;
    constexpr uint64_t kLow7 = 0x7F7F7F7F7F7F7F7F;
    // Bytes are below 128, so that no carry leaves one.
    const uint64_t other = load_little_endian<uint64_t>(cursors.turn) ^ (kLow7 / 0x7F * frame);
    for (uint64_t due = ~(other + kLow7) & ~kLow7; due != 0; due &= due - 1) {
      turn_lane(cursors, lowest_bit(due) / 8, frame);
    }
    decoder.turns |= cursors.turns;
  };
  for_cursors(decoder, kBlockGrid, turn);
  for_cursors(decoder, kBlockFloat, turn);
}

/// Codes of the residuals at hand.
void read_codes(const ChannelCursors& cursors, const uint8_t* data, uint32_t* codes) {
  for (uint32_t k = 0; k < kCursorLanes; ++k) {
    const uint64_t window = load_little_endian<uint64_t>(data + (cursors.bit[k] >> 3));
    codes[k] = static_cast<uint32_t>(window >> (cursors.bit[k] & 7)) & cursors.mask[k];
  }
}

/// Goes on by a sample in each lane.
template <BlockMode kMode>
void add_residuals(ChannelCursors& cursors, const uint32_t* codes) {
  MIEN_VECTOR_LOOP
  for (uint32_t k = 0; k < kCursorLanes; ++k) {
    const uint32_t residual = (codes[k] >> 1) ^ (0u - (codes[k] & 1));
    const uint32_t change =
        cursors.slope[k] + (kMode == kBlockGrid ? residual : residual * cursors.unit[k]);
    cursors.bit[k] += cursors.width[k];
    cursors.last[k] += change & cursors.present[k];
    cursors.slope[k] = change & cursors.linear[k];
  }
}

void decode_next(BlockDecoder& decoder) {
  const uint32_t frame = decoder.next % kBlockFrames;
  if ((decoder.turns >> frame & 1) != 0) turn_lanes(decoder, frame);
  // All codes first: what was just written in parts is not at once read as a whole.
  uint32_t codes[cursor_count(kMaxChangingChannels) * kCursorLanes], *end = codes;
  const auto read = [&end, data = decoder.data](const ChannelCursors& cursors) {
    read_codes(cursors, data, end);
    end += kCursorLanes;
  };
  for_cursors(decoder, kBlockGrid, read);
  for_cursors(decoder, kBlockFloat, read);
  const uint32_t* at = codes;
  for_cursors(decoder, kBlockGrid, [&at](ChannelCursors& cursors) {
    add_residuals<kBlockGrid>(cursors, at);
    at += kCursorLanes;
  });
  for_cursors(decoder, kBlockFloat, [&at](ChannelCursors& cursors) {
    add_residuals<kBlockFloat>(cursors, at);
    at += kCursorLanes;
  });
  ++decoder.next;
}

/// Writes the values of the frame before `next`.
void write_row(BlockDecoder& decoder) {
  float* row = decoder.row.data;
  for_cursors(decoder, kBlockGrid, [row](const ChannelCursors& cursors) {
    float values[kCursorLanes];
    MIEN_VECTOR_LOOP
    for (uint32_t k = 0; k < kCursorLanes; ++k) {
      const float number = static_cast<float>(static_cast<int32_t>(cursors.last[k]));
      const float value = number / static_cast<float>(static_cast<int32_t>(cursors.unit[k]));
      values[k] = float_of(bits_of(value) & cursors.present[k]);
    }
    for (uint32_t k = 0; k < kCursorLanes; ++k) row[cursors.channel[k]] = values[k];
  });
  uint32_t damaged = 0;
  for_cursors(decoder, kBlockFloat, [row, &damaged](const ChannelCursors& cursors) {
    uint32_t bits[kCursorLanes], bad = 0;
    MIEN_VECTOR_LOOP
    for (uint32_t k = 0; k < kCursorLanes; ++k) {
      const uint32_t ordered = cursors.last[k], above = 0u - (ordered >> 31);
      const uint32_t all = (ordered ^ (~above | 1u << 31)) & (0u - cursors.unit[k]);
      const uint32_t finite = (all & 0x7F800000) != 0x7F800000 ? cursors.present[k] : 0;
      bits[k] = all & finite;
      bad |= finite ^ cursors.present[k];
    }
    for (uint32_t k = 0; k < kCursorLanes; ++k) row[cursors.channel[k]] = float_of(bits[k]);
    damaged |= bad;
  });
  if (damaged != 0) decoder.damaged = true;
}

}  // namespace

void begin_decoding(const Clip& clip, Span<ChannelCursors> cursors, Span<float> row,
                    BlockDecoder& decoder) {
  decoder = {};
  decoder.clip = &clip;
  decoder.cursors = cursors.first(cursor_count(clip.changing_count));
  decoder.row = row.first(clip.changing_count);
}

void decode_frame(BlockDecoder& decoder, uint32_t frame) {
  if (decoder.clip->changing_count == 0) return;
  // The frame before `next` is still in the row.
  const bool same_block =
      decoder.end != 0 && frame / kBlockFrames == (decoder.end - 1) / kBlockFrames;
  if (!same_block || frame + 1 < decoder.next) enter_block(decoder, frame / kBlockFrames);
  if (decoder.next > frame) return;
  while (decoder.next <= frame) decode_next(decoder);
  write_row(decoder);
}

bool read_frames(const Clip& clip, uint32_t first, uint32_t count, float* out, size_t stride) {
  assert(first <= clip.frame_count && count <= clip.frame_count - first);
  ChannelCursors cursors[cursor_count(kMaxChangingChannels)];
  float row[kMaxChangingChannels + 1], before[kMaxChangingChannels];
  BlockDecoder decoder;
  begin_decoding(clip, {cursors, cursor_count(kMaxChangingChannels)},
                 {row, kMaxChangingChannels + 1}, decoder);
  const bool half_rate = clip.has(kClipHalfRate);
  for (uint32_t f = first; f < first + count; ++f, out += stride) {
    const bool is_mean = half_rate && f % 2 == 1;
    if (is_mean) {
      decode_frame(decoder, f / 2);
      memcpy(before, row, sizeof(float) * clip.changing_count);
    }
    decode_frame(decoder, half_rate ? (f + 1) / 2 : f);
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
  ChannelCursors cursors[cursor_count(kMaxChangingChannels)];
  float row[kMaxChangingChannels + 1];
  BlockDecoder decoder;
  begin_decoding(clip, {cursors, cursor_count(kMaxChangingChannels)},
                 {row, kMaxChangingChannels + 1}, decoder);
  for (uint32_t block = 0; block < clip.block_count(); ++block) {
    const uint64_t slack = enter_block(decoder, block);
    while (decoder.next < decoder.end) {
      decode_next(decoder);
      write_row(decoder);
    }
    if (decoder.damaged || slack >= 8) {
      return fail(error, Status::kClipStructure, kNoOffset,
                  "block %u is damaged; fetch the clip again or build it again", block);
    }
  }
  return Status::kOk;
}

}  // namespace mien
