// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/anim/clip_encoder.h"
#include "runtime/base/arena.h"

namespace mien {
namespace {

/// The analysis, before anything is written.
struct Build {
  Allocator allocator;
  size_t block_size = 0;
  ClipDesc desc;
  Clip clip;                   // counts, flags, rate and layout of the clip to be made
  Span<uint16_t> by_name;      // channels
  Span<uint8_t> is_changing;   // [channel]
  Span<uint16_t> changing;     // channels
  Span<uint32_t> event_order;  // events by tick

  void place(Placer& placer) {
    by_name = placer.array<uint16_t>(desc.names.count);
    is_changing = placer.array<uint8_t>(desc.names.count);
    changing = placer.array<uint16_t>(desc.names.count);
    event_order = placer.array<uint32_t>(desc.events.count);
  }
  float raw(uint32_t frame, uint32_t channel) const {
    const size_t stride = desc.frame_stride == 0 ? desc.names.count : desc.frame_stride;
    return desc.values[frame * stride + channel];
  }
  float value(uint32_t frame, uint32_t channel) const {
    const uint32_t snap = desc.snaps.empty() ? kNoSnap : desc.snaps[channel];
    return snap == kNoSnap ? raw(frame, channel) : snapped_value(raw(frame, channel), snap);
  }
};

Status wrong_clip(Error& error, const char* what) {
  return fail(error, Status::kInvalidArgument, kNoOffset, "%s", what);
}

Status check_desc(const ClipDesc& desc, Error& error) {
  const size_t channels = desc.names.count;
  if (ticks_per_frame(desc.rate_numerator, desc.rate_denominator) == 0) {
    return wrong_clip(error, "the frame rate is out of range");
  }
  if (desc.frame_count == 0) return wrong_clip(error, "a clip has at least one frame");
  if (channels != 0 && !desc.values) return wrong_clip(error, "there are channels and no values");
  if (desc.frame_stride != 0 && desc.frame_stride < channels) {
    return wrong_clip(error, "the frame stride is shorter than a frame");
  }
  if (!desc.snaps.empty() && desc.snaps.count != channels) {
    return wrong_clip(error, "snaps: not one for each channel");
  }
  for (uint8_t n : desc.snaps) {
    if (n != kNoSnap && (n < kMinSnap || n > kMaxSnap)) {
      return wrong_clip(error, "snaps: a step is 1 / 2^9 to 1 / 2^16");
    }
  }
  if (desc.frame_count > kMaxClipFrames || channels > kMaxClipChannels ||
      desc.events.count > UINT32_MAX / 2 || desc.event_names.count > UINT32_MAX / 2) {
    return fail(error, Status::kClipLimit, kNoOffset,
                "%zu channels, %u frames: a clip has at most %u channels and %u frames", channels,
                desc.frame_count, kMaxClipChannels, kMaxClipFrames);
  }
  return Status::kOk;
}

/// Checks that there are names, and that those of channels differ.
Status check_names(Build& build, Error& error) {
  const Span<const Span<const char>>& names = build.desc.names;
  uint64_t bytes = 0;
  for (const auto& list : {names, build.desc.event_names}) {
    for (size_t i = 0; i < list.count; ++i) {
      bytes += list[i].count;
      if (list[i].empty()) return fail(error, Status::kName, kNoOffset, "name %zu is empty", i);
    }
  }
  if (bytes > UINT32_MAX) return fail(error, Status::kClipLimit, kNoOffset, "names of over 4 GB");
  build.clip.name_bytes = static_cast<uint32_t>(bytes);

  const Span<uint16_t>& order = build.by_name;
  for (size_t c = 0; c < names.count; ++c) order[c] = static_cast<uint16_t>(c);
  std::sort(order.begin(), order.end(),
            [&](uint16_t a, uint16_t b) { return compare_names(names[a], names[b]) < 0; });
  for (size_t i = 1; i < names.count; ++i) {
    const Span<const char> name = names[order[i]];
    if (compare_names(names[order[i - 1]], name) != 0) continue;
    return fail(error, Status::kName, kNoOffset, "two channels are called \"%.*s\"",
                static_cast<int>(std::min<size_t>(name.count, 160)), name.data);
  }
  return Status::kOk;
}

Status sort_events(Build& build, Error& error) {
  const Span<const ClipEventDesc>& events = build.desc.events;
  for (uint32_t e = 0; e < events.count; ++e) {
    const bool within = events[e].tick >= 0 && events[e].tick < build.clip.length(true);
    if (!within || events[e].name >= build.desc.event_names.count) {
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "event %u: its tick is not within the clip, or it has no name", e);
    }
    if (!std::isfinite(events[e].value)) {
      return fail(error, Status::kClipValue, kNoOffset, "event %u: not a finite number", e);
    }
    build.event_order[e] = e;
  }
  std::sort(build.event_order.begin(), build.event_order.end(), [&](uint32_t a, uint32_t b) {
    return events[a].tick != events[b].tick ? events[a].tick < events[b].tick : a < b;
  });
  return Status::kOk;
}

/// Finds the channels that change, and checks that all values are finite.
Status find_changes(Build& build, Span<ChannelReport> reports, Error& error) {
  Clip& clip = build.clip;
  for (uint32_t f = 0; f < clip.frame_count; ++f) {
    for (uint32_t c = 0; c < clip.channel_count; ++c) {
      const float raw = build.raw(f, c), value = build.value(f, c);
      if (!std::isfinite(raw)) {
        const Span<const char> name = build.desc.names[c];
        return fail(error, Status::kClipValue, kNoOffset,
                    "frame %u, channel %u (\"%.*s\"): not a finite number", f, c,
                    static_cast<int>(std::min<size_t>(name.count, 120)), name.data);
      }
      build.is_changing[c] |= bits_of(value) != bits_of(build.value(0, c));
      if (!reports.empty()) {
        reports[c].max_error = std::max(reports[c].max_error, std::abs(value - raw));
      }
    }
  }
  for (uint32_t c = 0; c < clip.channel_count; ++c) {
    if (build.is_changing[c]) build.changing[clip.changing_count++] = static_cast<uint16_t>(c);
  }
  if (clip.changing_count <= kMaxChangingChannels) return Status::kOk;
  return fail(error, Status::kClipLimit, kNoOffset,
              "%u channels change, a clip has at most %u of them; leave some out or make two clips",
              clip.changing_count, kMaxChangingChannels);
}

// Only with an odd number of frames: then every frame between has two neighbors, without a rule for
// clips that wrap.
bool is_half_rate(const Build& build) {
  if (build.clip.frame_count < 3 || build.clip.frame_count % 2 == 0) return false;
  for (uint32_t i = 0; i < build.clip.changing_count; ++i) {
    const uint32_t c = build.changing[i];
    for (uint32_t f = 1; f < build.clip.frame_count; f += 2) {
      const float mean = half_rate_mean(build.value(f - 1, c), build.value(f + 1, c));
      if (bits_of(mean) != bits_of(build.value(f, c))) return false;
    }
  }
  return true;
}

/// Number of bytes of all blocks. `file` is the clip, or null: then they are only counted.
uint64_t encode_blocks(const Build& build, uint8_t* file, Span<ChannelReport> reports) {
  const Clip& clip = build.clip;
  const uint32_t step = clip.has(kClipHalfRate) ? 2 : 1, stored = clip.stored_frame_count();
  BitWriter writer = {file ? file + clip.at.blocks : nullptr, 0};
  for (uint32_t b = 0; b < clip.block_count(); ++b) {
    const uint32_t first = b * kBlockFrames, count = std::min(stored - first, kBlockFrames);
    for (uint32_t i = 0; i < clip.changing_count; ++i) {
      const uint32_t c = build.changing[i];
      float samples[kBlockFrames];
      for (uint32_t k = 0; k < count; ++k) samples[k] = build.value((first + k) * step, c);
      const uint64_t before = writer.bit;
      const BlockMode mode = encode_channel(samples, count, writer);
      if (!file || reports.empty()) continue;
      ++reports[c].blocks[mode];
      reports[c].bits += writer.bit - before;
    }
    writer.bit = align_up(writer.bit, 8);
    if (!file) continue;
    store_little_endian(file + clip.at.block_ends + b * sizeof(uint32_t),
                        static_cast<uint32_t>(writer.bit / 8));
  }
  return writer.bit / 8;
}

void write_tables(const Build& build, size_t size, uint8_t* file) {
  const ClipDesc& desc = build.desc;
  const Clip& clip = build.clip;
  memcpy(file + kAtMagic, kClipMagic, sizeof(kClipMagic));
  store_little_endian(file + kAtVersion, kClipVersion);
  store_little_endian(file + kAtSize, static_cast<uint64_t>(size));
  for (const ClipField& field : kClipFields)
    store_little_endian(file + field.at, clip.*field.member);

  for (uint32_t c = 0; c < clip.channel_count; ++c) {
    const float rest = build.is_changing[c] ? 0 : build.value(0, c);
    store_little_endian(file + clip.at.rests + c * sizeof(float), rest);
  }
  for (uint32_t i = 0; i < clip.changing_count; ++i) {
    store_little_endian(file + clip.at.changing + i * sizeof(uint16_t), build.changing[i]);
  }
  for (uint32_t i = 0; i < clip.event_count; ++i) {
    const ClipEventDesc& event = desc.events[build.event_order[i]];
    uint8_t* entry = file + clip.at.events + i * Clip::kEventSize;
    store_little_endian(entry, event.tick);
    store_little_endian(entry + 8, clip.channel_count + event.name);
    store_little_endian(entry + 12, event.value);
  }
  uint32_t end = 0;
  for (uint32_t i = 0; i < clip.name_count; ++i) {
    const Span<const char>& name =
        i < clip.channel_count ? desc.names[i] : desc.event_names[i - clip.channel_count];
    memcpy(file + clip.at.chars + end, name.data, name.count);
    end += static_cast<uint32_t>(name.count);
    store_little_endian(file + clip.at.name_ends + i * sizeof(uint32_t), end);
  }
}

Status build_with_scratch(Build& build, Span<ChannelReport> reports, ClipBytes& out, Error& error) {
  const ClipDesc& desc = build.desc;
  Clip& clip = build.clip;
  clip.rate_numerator = desc.rate_numerator;
  clip.rate_denominator = desc.rate_denominator;
  clip.ticks_per_frame = ticks_per_frame(desc.rate_numerator, desc.rate_denominator);
  clip.frame_count = desc.frame_count;
  clip.channel_count = static_cast<uint32_t>(desc.names.count);
  clip.event_count = static_cast<uint32_t>(desc.events.count);
  clip.name_count = clip.channel_count + static_cast<uint32_t>(desc.event_names.count);
  Status status = check_names(build, error);
  if (status == Status::kOk) status = sort_events(build, error);
  if (status == Status::kOk) status = find_changes(build, reports, error);
  if (status != Status::kOk) return status;
  for (uint8_t n : desc.snaps) {
    if (n != kNoSnap && (clip.snap == kNoSnap || n < clip.snap)) clip.snap = n;
  }
  if (clip.snap != kNoSnap) clip.flags |= kClipSnapped;
  if (desc.wraps) clip.flags |= kClipWraps;
  if (desc.is_delta) clip.flags |= kClipIsDelta;
  if (is_half_rate(build)) clip.flags |= kClipHalfRate;
  clip.at = clip_layout(clip);

  // Encoded twice, the first time to learn the size: so there is one block of memory, of the size of the
  // clip.
  const uint64_t block_bytes = encode_blocks(build, nullptr, {});
  const uint64_t size = align_up(clip.at.blocks + block_bytes + kClipPadding, 8);
  if (block_bytes > UINT32_MAX || size > SIZE_MAX / 2) {
    return fail(error, Status::kClipLimit, kNoOffset,
                "the curves take more than 4 GB; make several clips of them");
  }
  auto* file = static_cast<uint8_t*>(build.allocator.get(size, kBlockAlignment));
  if (!file) return fail(error, Status::kMemory, kNoOffset, "no memory for the clip");
  memset(file, 0, size);
  encode_blocks(build, file, reports);
  write_tables(build, size, file);
  store_little_endian(file + kAtChecksum, clip_checksum(file, size));
  out = {build.allocator, file, static_cast<size_t>(size)};
  return Status::kOk;
}

}  // namespace

float snapped_value(float value, uint32_t n) {
  const double scale = static_cast<double>(1u << n);
  const double number = std::floor(value * scale + 0.5);
  return std::abs(number) < kMaxGridNumber ? static_cast<float>(number / scale) : value;
}

Status build_clip(const ClipDesc& desc, const Allocator& allocator, Span<ChannelReport> reports,
                  ClipBytes& out, Error& error) {
  out = {};
  for (ChannelReport& report : reports) report = {};
  const Status status = check_desc(desc, error);
  if (status != Status::kOk) return status;
  if (!reports.empty() && reports.count != desc.names.count) {
    return wrong_clip(error, "reports: not one for each channel");
  }
  auto* const build = create_block<Build>(allocator, [&](Placer& placer, Build& made) {
    made.desc = desc;
    made.place(placer);
  });
  if (!build) return fail(error, Status::kMemory, kNoOffset, "no memory to build a clip");
  const Status built = build_with_scratch(*build, reports, out, error);
  release_block(build);
  return built;
}

void release_clip(ClipBytes& clip) {
  if (clip.bytes) clip.allocator.put(clip.bytes, clip.size, kBlockAlignment);
  clip = {};
}

}  // namespace mien
