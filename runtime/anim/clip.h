// SPDX-License-Identifier: MIT
// A clip: control curves at a constant rate, in a file that is used in place. Its contents do not depend
// on the address, the machine or a rig: channels have names (binding.h).
//
//     | header, 64 bytes
//     | rest values, f32 each         by channel: its value if that never changes, else 0
//     | ends of names, u32 each       by name: channels, then events
//     | changing channels, u16 each   ascending
//     | events, 16 bytes each         ascending ticks
//     | ends of blocks, u32 each      counted from the first block
//     | characters of names
//     | blocks                        64 frames of all changing channels each (clip_block.h)
//     | zeros, 8 bytes or more        so that bits can be read 8 bytes at a time
//
// Sections follow each other in this order at multiples of 8, with zeros in between, and their
// sizes follow from the counts in the header: the file has no offsets to check. Numbers are
// little-endian and may be read at any address.
//
// Channels keep the order in which they were given, so that exporting a clip restores the table from
// which it was built. The file stores neither hashes nor sorted names, because a binding ignores case and
// has to sort the names itself.
#pragma once

#include "runtime/base/byte_order.h"
#include "runtime/base/span.h"
#include "runtime/base/status.h"

namespace mien {

/// All times are integers. At every common frame rate, a frame is a whole number of ticks.
constexpr int64_t kTicksPerSecond = 705600000;

constexpr char kClipMagic[8] = {'M', 'I', 'E', 'N', 'C', 'L', 'P', '\n'};
constexpr uint32_t kClipVersion = 3;
constexpr size_t kClipHeaderSize = 64;
constexpr size_t kClipPadding = 8;
constexpr uint32_t kBlockFrames = 64;

constexpr uint32_t kMaxClipChannels = 0xFFFF;
constexpr uint32_t kMaxChangingChannels = 512;
// With these limits, times and their sums fit 64 bits.
constexpr uint32_t kMaxClipFrames = 1u << 28;
constexpr int64_t kMaxTicksPerFrame = int64_t{1} << 32;

enum ClipFlags : uint32_t {
  kClipWraps = 1,     // after the last frame comes the first; else the last one stays
  kClipSnapped = 2,   // values were rounded when the clip was built
  kClipHalfRate = 4,  // frames 1, 3, 5 ... are not stored: each is the mean of its neighbors
  kClipIsDelta = 8,   // values are differences from a reference, to be added to other values
};

/// Offsets of the header fields that are not in kClipFields.
enum ClipHeaderOffset : size_t {
  kAtMagic = 0,
  kAtChecksum = 8,  // u32: CRC-32C of everything after this field
  kAtVersion = 12,  // u32
  kAtSize = 16,     // u64: of the file
};

/// Offsets of the sections.
struct ClipLayout {
  uint64_t rests, name_ends, changing, events, block_ends, chars, blocks;
};

struct ClipEvent {
  int64_t tick;
  Span<const char> name;
  float value;
};

/// A checked view of the bytes, which must outlive it. May be used by any number of threads.
struct Clip {
  const uint8_t* bytes = nullptr;
  size_t size = 0;
  ClipLayout at = {};
  uint32_t flags = 0;
  uint32_t rate_numerator = 0, rate_denominator = 0;
  uint32_t frame_count = 0, channel_count = 0, changing_count = 0, event_count = 0;
  uint32_t name_count = 0, name_bytes = 0;
  uint32_t snap = 0;  // n of the coarsest step 1 / 2^n that channels were rounded to; 0: none was
  int64_t ticks_per_frame = 0;

  bool has(ClipFlags flag) const { return (flags & flag) != 0; }
  /// Frames in the blocks.
  uint32_t stored_frame_count() const {
    return has(kClipHalfRate) ? (frame_count + 1) / 2 : frame_count;
  }
  /// None if nothing changes.
  uint32_t block_count() const {
    if (changing_count == 0) return 0;
    return (stored_frame_count() + kBlockFrames - 1) / kBlockFrames;
  }
  /// In ticks. A clip that wraps also moves from its last frame to the first.
  int64_t length(bool wraps) const {
    return ticks_per_frame * (int64_t{frame_count} - (wraps ? 0 : 1));
  }

  Span<const char> name(uint32_t i) const {
    const uint32_t begin = i == 0 ? 0 : load<uint32_t>(at.name_ends, i - 1);
    return {reinterpret_cast<const char*>(bytes + at.chars) + begin,
            load<uint32_t>(at.name_ends, i) - begin};
  }
  float rest(uint32_t channel) const { return load<float>(at.rests, channel); }
  /// Channel of the i-th changing channel.
  uint32_t changing(uint32_t i) const { return load<uint16_t>(at.changing, i); }
  ClipEvent event(uint32_t i) const {
    const uint8_t* entry = bytes + at.events + size_t{i} * kEventSize;
    return {load_little_endian<int64_t>(entry), name(event_name(i)),
            load_little_endian<float>(entry + 12)};
  }
  /// Its place among the names.
  uint32_t event_name(uint32_t i) const {
    return load_little_endian<uint32_t>(bytes + at.events + size_t{i} * kEventSize + 8);
  }
  int64_t event_tick(uint32_t i) const {
    return load_little_endian<int64_t>(bytes + at.events + size_t{i} * kEventSize);
  }

  static constexpr size_t kEventSize = 16;  // tick i64, name u32, value f32

 private:
  template <class T>
  T load(uint64_t section, uint32_t i) const {
    return load_little_endian<T>(bytes + section + size_t{i} * sizeof(T));
  }
};

/// The fields of the header, u32 each, up to its end.
struct ClipField {
  size_t at;
  uint32_t Clip::*member;
};
constexpr ClipField kClipFields[] = {
    {24, &Clip::flags},       {28, &Clip::rate_numerator}, {32, &Clip::rate_denominator},
    {36, &Clip::frame_count}, {40, &Clip::channel_count},  {44, &Clip::changing_count},
    {48, &Clip::event_count}, {52, &Clip::name_count},     {56, &Clip::name_bytes},
    {60, &Clip::snap},
};

/// Steps of snapped channels are 1 / 2^n.
constexpr uint32_t kNoSnap = 0;
constexpr uint32_t kMinSnap = 9, kMaxSnap = 16;
constexpr uint32_t kDefaultSnap = 11;

/// The step of n, 0 for kNoSnap; and n of a step, kInvalidSnap if it is none of these.
float snap_step(uint32_t n);
uint8_t snap_of_step(float step);
constexpr uint8_t kInvalidSnap = 1;

constexpr uint32_t kNoChannel = ~uint32_t{0};

/// Makes `out` a view of bytes at any address. Checks everything before the blocks, in time that depends on
/// the channels and events but not on the frames, without allocating. Blocks are checked when they are
/// decoded. kClipSignature, kClipVersion, kClipTruncated or kClipStructure.
Status open_clip(const uint8_t* bytes, size_t size, Clip& out, Error& error);

bool is_changing(const Clip& clip, uint32_t channel);

/// The first channel of a name, exactly as written; kNoChannel if there is none.
uint32_t find_channel(const Clip& clip, Span<const char> name);

/// Events before a tick, or before and at it.
int64_t count_events(const Clip& clip, int64_t tick, bool at_too);

/// The order of names, by their bytes: negative, 0 or positive.
int compare_names(Span<const char> a, Span<const char> b);

/// Ticks per frame, rounded to the nearest integer (an error of less than a nanosecond per frame, and
/// none at common rates); 0 for a rate out of range. A whole number makes loops exact.
int64_t ticks_per_frame(uint32_t rate_numerator, uint32_t rate_denominator);

/// The layout of a clip with the given counts.
ClipLayout clip_layout(const Clip& clip);

/// CRC-32C (Castagnoli) of bytes.
uint32_t crc32c(const uint8_t* bytes, size_t size);

/// The checksum that belongs in the header.
inline uint32_t clip_checksum(const uint8_t* bytes, size_t size) {
  return crc32c(bytes + kAtVersion, size - kAtVersion);
}

}  // namespace mien
