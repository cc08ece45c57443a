// SPDX-License-Identifier: MIT
// Clips as tests make them, and what they play like.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "runtime/anim/clip_builder.h"
#include "runtime/anim/clip_sampler.h"
#include "tests/support/clip_curves.h"

namespace mien {

/// What a clip is built of. Channels are called "CTRL_expressions.control0" and so on unless they
/// have other names.
struct ClipInput {
  struct Event {
    int64_t tick;
    std::string name;
    float value;
  };

  Curves curves;
  std::vector<std::string> names;
  std::vector<uint8_t> snaps;
  std::vector<Event> events;
  uint32_t rate_numerator = 60, rate_denominator = 1;
  bool wraps = false, is_delta = false;

  explicit ClipInput(Curves what, uint32_t snap = kNoSnap)
      : curves(std::move(what)), snaps(curves.channels, static_cast<uint8_t>(snap)) {
    for (uint32_t c = 0; c < curves.channels; ++c) {
      names.push_back("CTRL_expressions.control" + std::to_string(c));
    }
  }

  /// Valid as long as the input does not change.
  ClipDesc desc() {
    name_views_ = views(names);
    event_views_.clear();
    event_name_views_.clear();
    std::vector<std::string> unique;  // a name is stored once, however many events have it
    for (const Event& event : events) {
      const auto at = std::find(unique.begin(), unique.end(), event.name);
      event_views_.push_back({event.tick, static_cast<uint32_t>(at - unique.begin()), event.value});
      if (at != unique.end()) continue;
      unique.push_back(event.name);
      event_name_views_.push_back({event.name.data(), event.name.size()});
    }
    ClipDesc desc;
    desc.rate_numerator = rate_numerator;
    desc.rate_denominator = rate_denominator;
    desc.frame_count = curves.frames;
    desc.values = curves.values.data();
    desc.names = {name_views_.data(), name_views_.size()};
    desc.snaps = {snaps.data(), snaps.size()};
    desc.events = {event_views_.data(), event_views_.size()};
    desc.event_names = {event_name_views_.data(), event_name_views_.size()};
    desc.wraps = wraps;
    desc.is_delta = is_delta;
    return desc;
  }

  std::vector<uint8_t> build(std::vector<ChannelReport>* reports = nullptr) {
    if (reports) reports->assign(curves.channels, {});
    const Span<ChannelReport> report_span =
        reports ? Span<ChannelReport>{reports->data(), reports->size()} : Span<ChannelReport>{};
    ClipBytes made;
    Error error;
    EXPECT_EQ(build_clip(desc(), default_allocator(), report_span, made, error), Status::kOk)
        << error.message;
    const std::vector<uint8_t> bytes(made.bytes, made.bytes + made.size);
    release_clip(made);
    return bytes;
  }

 private:
  static std::vector<Span<const char>> views(const std::vector<std::string>& strings) {
    std::vector<Span<const char>> all;
    for (const std::string& s : strings) all.push_back({s.data(), s.size()});
    return all;
  }

  std::vector<Span<const char>> name_views_, event_name_views_;
  std::vector<ClipEventDesc> event_views_;
};

/// The bytes, and the clip that they are.
struct MadeClip {
  std::vector<uint8_t> bytes;
  Clip clip;

  explicit MadeClip(ClipInput input) : MadeClip(input.build()) {}
  explicit MadeClip(std::vector<uint8_t> file) : bytes(std::move(file)) {
    Error error;
    EXPECT_EQ(open_clip(bytes.data(), bytes.size(), clip, error), Status::kOk) << error.message;
    EXPECT_EQ(verify_clip(clip, error), Status::kOk) << error.message;
  }
  MadeClip(const MadeClip&) = delete;
  MadeClip& operator=(const MadeClip&) = delete;
};

/// A sampler with its memory.
struct OwnSampler {
  std::unique_ptr<uint8_t[]> memory;
  ClipSampler sampler;

  explicit OwnSampler(const SamplerLimits& limits) {
    Placer measure(nullptr);
    place_clip_sampler(measure, limits, sampler);
    memory = std::make_unique<uint8_t[]>(measure.size() + kBlockAlignment);
    const auto at = reinterpret_cast<uintptr_t>(memory.get());
    Placer placer(memory.get() + (align_up(at, kBlockAlignment) - at));
    place_clip_sampler(placer, limits, sampler);
  }
  explicit OwnSampler(const Clip& clip, const PlayDesc& desc = {}, bool reverse = false)
      : OwnSampler(SamplerLimits{clip.channel_count, clip.changing_count, reverse}) {
    Error error;
    EXPECT_EQ(start_clip(sampler, clip, desc, error), Status::kOk) << error.message;
  }

  Span<const float> at_frame(uint32_t frame) {
    return at_tick(frame * sampler.clip->ticks_per_frame);
  }
  Span<const float> at_tick(int64_t tick) {
    seek_clip(sampler, tick);
    return sample_clip(sampler);
  }
};

/// What a clip decodes to, forward.
inline Curves decoded(const Clip& clip) {
  Curves curves(clip.channel_count, clip.frame_count);
  OwnSampler own(clip);
  for (uint32_t f = 0; f < clip.frame_count; ++f) {
    const Span<const float> values = own.at_frame(f);
    for (uint32_t c = 0; c < clip.channel_count; ++c) curves.at(f, c) = values[c];
  }
  return curves;
}

inline bool same_bits(const Curves& a, const Curves& b) {
  return a.frames == b.frames && a.channels == b.channels &&
         memcmp(a.values.data(), b.values.data(), a.raw_bytes()) == 0;
}

}  // namespace mien
