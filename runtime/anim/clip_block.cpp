// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_block.h"

#include <cassert>
#include <cstring>

#include "runtime/base/bits.h"

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

/// A channel in grid or float mode: leaves the reader at the next channel.
ChannelCursor read_channel(BitReader& reader, BlockMode mode, uint32_t frame_count) {
  ChannelCursor cursor = {};
  const bool linear = reader.take(1) != 0, masked = reader.take(1) != 0;
  const auto parameter = static_cast<uint32_t>(reader.take(mode == kBlockGrid ? 4 : 5));
  cursor.kind = static_cast<uint8_t>(parameter | (linear ? 0x80 : 0));
  cursor.mask = (masked ? read_mask(reader) : ~uint64_t{0}) & low_bits(frame_count);
  uint32_t first_width = 32 - parameter;
  if (mode == kBlockGrid) first_width = width_of_code(static_cast<uint32_t>(reader.take(5)));
  const auto first = static_cast<uint32_t>(reader.take(first_width));
  cursor.last = mode == kBlockGrid ? (first >> 1) ^ (0u - (first & 1)) : first;
  cursor.before = cursor.last;

  // The first sample is a run by itself, of no width: it repeats the prediction.
  const uint32_t count = bit_count(cursor.mask);
  const uint32_t residuals = count > 0 ? count - 1 : 0;
  const uint32_t runs = (residuals + kRunSamples - 1) / kRunSamples;
  cursor.widths = reader.take(runs * kWidthBits) << kWidthBits;
  cursor.left = 1;
  uint64_t size = 0;
  for (uint32_t r = 0; r < runs; ++r) {
    const uint32_t samples = r + 1 < runs ? kRunSamples : residuals - r * kRunSamples;
    size += samples * width_of_code(cursor.widths >> ((r + 1) * kWidthBits) & 31);
  }
  cursor.bit = static_cast<uint32_t>(reader.bit);
  if (size > reader.end - reader.bit) {
    reader.good = false;
  } else {
    reader.bit += size;
  }
  return cursor;
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
      ChannelCursor cursor = read_channel(reader, mode, decoder.end - decoder.next);
      cursor.channel = static_cast<uint16_t>(i);
      const size_t place =
          mode == kBlockGrid ? decoder.grid_count++ : decoder.cursors.count - ++decoder.float_count;
      decoder.cursors[place] = cursor;
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
  uint64_t slack = 0;
  if (!read_block(decoder, block, slack)) {
    decoder.damaged = true;
    decoder.grid_count = decoder.float_count = 0;
    for (float& value : decoder.row) value = 0;
  }
  return slack;
}

/// The next sample of a channel.
inline uint32_t next_sample(ChannelCursor& cursor, const uint8_t* data) {
  if (cursor.left == 0) {
    cursor.widths >>= kWidthBits;
    cursor.left = kRunSamples;
  }
  --cursor.left;
  const uint32_t width = width_of_code(cursor.widths & 31);
  const uint64_t window = load_little_endian<uint64_t>(data + (cursor.bit >> 3));
  const auto code =
      static_cast<uint32_t>(window >> (cursor.bit & 7) & ((uint64_t{1} << width) - 1));
  cursor.bit += width;
  const uint32_t residual = (code >> 1) ^ (0u - (code & 1));
  const uint32_t slope = cursor.kind >> 7 ? cursor.last - cursor.before : 0;
  cursor.before = cursor.last;
  cursor.last += slope + residual;
  return cursor.last;
}

void decode_next(BlockDecoder& decoder) {
  const uint32_t frame = decoder.next % kBlockFrames;
  float* row = decoder.row.data;
  ChannelCursor* cursor = decoder.cursors.data;
  for (const ChannelCursor* end = cursor + decoder.grid_count; cursor != end; ++cursor) {
    float value = 0;
    if (cursor->mask >> frame & 1) {
      const auto k = static_cast<int32_t>(next_sample(*cursor, decoder.data));
      value = static_cast<float>(k) / kGridScales[cursor->kind & 15];
    }
    row[cursor->channel] = value;
  }
  cursor = decoder.cursors.data + decoder.cursors.count - decoder.float_count;
  for (const ChannelCursor* end = cursor + decoder.float_count; cursor != end; ++cursor) {
    uint32_t bits = 0;
    if (cursor->mask >> frame & 1) {
      const uint32_t shift = cursor->kind & 31;
      const uint32_t ordered = next_sample(*cursor, decoder.data) << shift;
      bits = bits_from_ordered(ordered) & ~0u << shift;
      if ((bits & 0x7F800000) == 0x7F800000) {
        bits = 0;
        decoder.damaged = true;
      }
    }
    row[cursor->channel] = float_of(bits);
  }
  ++decoder.next;
}

}  // namespace

void begin_decoding(const Clip& clip, Span<ChannelCursor> cursors, Span<float> row,
                    BlockDecoder& decoder) {
  decoder = {};
  decoder.clip = &clip;
  decoder.cursors = cursors.first(clip.changing_count);
  decoder.row = row.first(clip.changing_count);
}

void decode_frame(BlockDecoder& decoder, uint32_t frame) {
  if (decoder.clip->changing_count == 0) return;
  // The frame before `next` is still in the row.
  const bool same_block =
      decoder.end != 0 && frame / kBlockFrames == (decoder.end - 1) / kBlockFrames;
  if (!same_block || frame + 1 < decoder.next) enter_block(decoder, frame / kBlockFrames);
  while (decoder.next <= frame) decode_next(decoder);
}

bool read_frames(const Clip& clip, uint32_t first, uint32_t count, float* out, size_t stride) {
  assert(first <= clip.frame_count && count <= clip.frame_count - first);
  ChannelCursor cursors[kMaxChangingChannels];
  float row[kMaxChangingChannels], before[kMaxChangingChannels];
  BlockDecoder decoder;
  begin_decoding(clip, {cursors, kMaxChangingChannels}, {row, kMaxChangingChannels}, decoder);
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
  ChannelCursor cursors[kMaxChangingChannels];
  float row[kMaxChangingChannels];
  BlockDecoder decoder;
  begin_decoding(clip, {cursors, kMaxChangingChannels}, {row, kMaxChangingChannels}, decoder);
  for (uint32_t block = 0; block < clip.block_count(); ++block) {
    const uint64_t slack = enter_block(decoder, block);
    while (decoder.next < decoder.end) decode_next(decoder);
    if (decoder.damaged || slack >= 8) {
      return fail(error, Status::kClipStructure, kNoOffset,
                  "block %u is damaged; fetch the clip again or build it again", block);
    }
  }
  return Status::kOk;
}

}  // namespace mien
