// SPDX-License-Identifier: MIT
#include "runtime/anim/clip.h"

#include <cinttypes>
#include <cmath>
#include <cstring>

#include "runtime/base/arena.h"

namespace mien {
namespace {

constexpr uint32_t kKnownFlags = kClipWraps | kClipSnapped | kClipHalfRate | kClipIsDelta;

Status damaged_clip(Error& error, uint64_t offset, const char* what) {
  return fail(error, Status::kClipStructure, offset,
              "%s: counts or values contradict each other, the clip is damaged; build it again",
              what);
}

Status read_header(const uint8_t* bytes, size_t size, Clip& clip, Error& error) {
  if (size < kClipHeaderSize || memcmp(bytes, kClipMagic, sizeof(kClipMagic)) != 0) {
    return fail(error, Status::kClipSignature, 0,
                "not a clip: it does not begin with the signature of clips");
  }
  const uint32_t version = load_little_endian<uint32_t>(bytes + kAtVersion);
  if (version != kClipVersion) {
    return fail(error, Status::kClipVersion, kAtVersion,
                "the clip has version %" PRIu32 ", this library reads %" PRIu32 "; build it again",
                version, kClipVersion);
  }
  const uint64_t stated = load_little_endian<uint64_t>(bytes + kAtSize);
  if (stated > size) {
    return fail(error, Status::kClipTruncated, size,
                "the clip ends after %zu of %" PRIu64 " bytes; fetch or build it again", size,
                stated);
  }
  if (stated < size) return damaged_clip(error, stated, "bytes after the end");

  for (const ClipField& field : kClipFields) {
    clip.*field.member = load_little_endian<uint32_t>(bytes + field.at);
  }
  clip.ticks_per_frame = ticks_per_frame(clip.rate_numerator, clip.rate_denominator);
  // The mean of two frames needs both.
  const bool whole = !clip.has(kClipHalfRate) || clip.frame_count % 2 == 1;
  if ((clip.flags & ~kKnownFlags) != 0 || clip.ticks_per_frame == 0 || clip.frame_count == 0 ||
      clip.frame_count > kMaxClipFrames || !whole || clip.channel_count > kMaxClipChannels ||
      clip.changing_count > clip.channel_count || clip.changing_count > kMaxChangingChannels ||
      clip.name_count < clip.channel_count || clip.has(kClipSnapped) != (clip.snap != kNoSnap) ||
      (clip.snap != kNoSnap && (clip.snap < kMinSnap || clip.snap > kMaxSnap))) {
    return damaged_clip(error, kClipFields[0].at, "header");
  }
  return Status::kOk;
}

Status check_names(const Clip& clip, Error& error) {
  uint32_t end = 0;
  for (uint32_t i = 0; i < clip.name_count; ++i) {
    const uint64_t at = clip.at.name_ends + uint64_t{i} * sizeof(uint32_t);
    const uint32_t next = load_little_endian<uint32_t>(clip.bytes + at);
    if (next <= end || next > clip.name_bytes) return damaged_clip(error, at, "names");
    end = next;
  }
  return end == clip.name_bytes ? Status::kOk : damaged_clip(error, clip.at.name_ends, "names");
}

Status check_channels(const Clip& clip, Error& error) {
  for (uint32_t c = 0; c < clip.channel_count; ++c) {
    const uint64_t at = clip.at.rests + uint64_t{c} * sizeof(float);
    if (!std::isfinite(clip.rest(c))) return damaged_clip(error, at, "rest values");
  }
  for (uint32_t i = 0; i < clip.changing_count; ++i) {
    const uint64_t at = clip.at.changing + uint64_t{i} * sizeof(uint16_t);
    const bool ascends = i == 0 || clip.changing(i - 1) < clip.changing(i);
    if (!ascends || clip.changing(i) >= clip.channel_count) {
      return damaged_clip(error, at, "changing channels");
    }
  }
  return Status::kOk;
}

Status check_events(const Clip& clip, Error& error) {
  int64_t previous = 0;
  for (uint32_t i = 0; i < clip.event_count; ++i) {
    const uint64_t at = clip.at.events + uint64_t{i} * Clip::kEventSize;
    const int64_t tick = clip.event_tick(i);
    const bool in_order = tick >= previous && tick < clip.length(true);
    const uint32_t name = load_little_endian<uint32_t>(clip.bytes + at + 8);
    const float value = load_little_endian<float>(clip.bytes + at + 12);
    if (!in_order || name >= clip.name_count || !std::isfinite(value)) {
      return damaged_clip(error, at, "events");
    }
    previous = tick;
  }
  return Status::kOk;
}

}  // namespace

int compare_names(Span<const char> a, Span<const char> b) {
  const size_t common = a.count < b.count ? a.count : b.count;
  const int order = common == 0 ? 0 : memcmp(a.data, b.data, common);
  if (order != 0) return order;
  return a.count < b.count ? -1 : a.count > b.count ? 1 : 0;
}

int64_t ticks_per_frame(uint32_t rate_numerator, uint32_t rate_denominator) {
  if (rate_numerator == 0 || rate_denominator == 0) return 0;
  // 705600000 * 2^32 is below 2^62.
  const int64_t twice = 2 * kTicksPerSecond * rate_denominator / rate_numerator;
  const int64_t ticks = (twice + 1) / 2;
  return ticks <= kMaxTicksPerFrame ? ticks : 0;
}

ClipLayout clip_layout(const Clip& clip) {
  ClipLayout at;
  uint64_t end = kClipHeaderSize;
  const auto section = [&](uint64_t count, uint64_t element_size) {
    const uint64_t begin = end;
    end = (begin + count * element_size + 7) & ~uint64_t{7};
    return begin;
  };
  at.rests = section(clip.channel_count, sizeof(float));
  at.name_ends = section(clip.name_count, sizeof(uint32_t));
  at.changing = section(clip.changing_count, sizeof(uint16_t));
  at.events = section(clip.event_count, Clip::kEventSize);
  at.block_ends = section(clip.block_count(), sizeof(uint32_t));
  at.chars = section(clip.name_bytes, 1);
  at.blocks = end;
  return at;
}

Status open_clip(const uint8_t* bytes, size_t size, Clip& out, Error& error) {
  out = {};
  Clip clip;
  Status status = read_header(bytes, size, clip, error);
  if (status != Status::kOk) return status;
  clip.bytes = bytes;
  clip.size = size;
  clip.at = clip_layout(clip);
  if (clip.at.blocks > size) return damaged_clip(error, kClipFields[0].at, "size of the tables");
  uint64_t end = clip.at.blocks;
  if (clip.block_count() > 0) {
    const uint64_t last = clip.at.block_ends + (clip.block_count() - 1) * sizeof(uint32_t);
    end += load_little_endian<uint32_t>(bytes + last);
  }
  if (((end + kClipPadding + 7) & ~uint64_t{7}) != size) {
    return damaged_clip(error, clip.at.block_ends, "size of the blocks");
  }
  if ((status = check_names(clip, error)) != Status::kOk) return status;
  if ((status = check_channels(clip, error)) != Status::kOk) return status;
  if ((status = check_events(clip, error)) != Status::kOk) return status;
  out = clip;
  return Status::kOk;
}

int64_t count_events(const Clip& clip, int64_t tick, bool at_too) {
  uint32_t begin = 0, end = clip.event_count;
  while (begin < end) {
    const uint32_t middle = (begin + end) / 2;
    const int64_t here = clip.event_tick(middle);
    if (here < tick || (at_too && here == tick)) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

float snap_step(uint32_t n) { return n == kNoSnap ? 0 : 1.0f / static_cast<float>(1u << n); }

uint8_t snap_of_step(float step) {
  if (step == 0) return kNoSnap;
  for (uint32_t n = kMinSnap; n <= kMaxSnap; ++n) {
    if (step == snap_step(n)) return static_cast<uint8_t>(n);
  }
  return kInvalidSnap;
}

bool is_changing(const Clip& clip, uint32_t channel) {
  uint32_t begin = 0, end = clip.changing_count;
  while (begin < end) {
    const uint32_t middle = (begin + end) / 2;
    if (clip.changing(middle) < channel) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin < clip.changing_count && clip.changing(begin) == channel;
}

uint32_t find_channel(const Clip& clip, Span<const char> name) {
  for (uint32_t c = 0; c < clip.channel_count; ++c) {
    if (compare_names(clip.name(c), name) == 0) return c;
  }
  return kNoChannel;
}

uint32_t crc32c(const uint8_t* bytes, size_t size) {
  // Bit 0 first. A small table is fast enough for a check on request.
  uint32_t table[16];
  for (uint32_t i = 0; i < 16; ++i) {
    table[i] = i;
    for (int bit = 0; bit < 4; ++bit) {
      table[i] = table[i] >> 1 ^ (0x82F63B78u & (0u - (table[i] & 1)));
    }
  }
  uint32_t crc = ~0u;
  for (size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    crc = crc >> 4 ^ table[crc & 15];
    crc = crc >> 4 ^ table[crc & 15];
  }
  return ~crc;
}

}  // namespace mien
