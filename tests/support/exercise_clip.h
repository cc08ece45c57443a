// SPDX-License-Identifier: MIT
// All that can be done with a clip, whatever its bytes are: opened, verified, played in every way.
// Used by tests and by the fuzzer, so without GoogleTest.
#pragma once

#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "runtime/anim/clip_sampler.h"

namespace mien {

class ClipExercise {
 public:
  Status opened = Status::kOk, verified = Status::kOk;
  std::string broken;  // a promise that was not kept; "" if all were

  /// Without `ways` in all of them: bit k + 3 * reverse stands for the k-th interpolation.
  ClipExercise(const uint8_t* bytes, size_t size, uint32_t ways = ~0u) {
    Clip clip;
    Error error;
    opened = open_clip(bytes, size, clip, error);
    if (opened != Status::kOk) {
      check_error(opened, error, size);
      if (clip.bytes) broke("a clip in spite of an error");
      return;
    }
    // A few bytes may be the table of very many blocks of nothing.
    if (clip.block_count() <= 1024) {
      verified = verify_clip(clip, error);
      if (verified != Status::kOk) check_error(verified, error, size);
    }
    for (uint32_t c = 0; c < clip.channel_count; ++c) {
      if (find_channel(clip, clip.name(c)) > c) broke("a channel was not found");
      if (c >= 8) c += clip.channel_count / 8;
    }
    for (uint32_t e = 0; e < clip.event_count; ++e) add(clip.event(e).value);
    for (const bool reverse : {false, true}) play(clip, reverse, ways >> (reverse ? 3 : 0) & 7);
  }

 private:
  void broke(const char* what) {
    if (broken.empty()) broken = what;
  }
  void add(float value) {
    if (!std::isfinite(value)) broke("a value that is not finite");
    sum_ = sum_ + value;
  }
  void check_error(Status status, const Error& error, size_t size) {
    if (error.status != status || error.message[0] == 0) broke("refused without a word");
    if (error.byte_offset != kNoOffset && error.byte_offset > size) broke("a place outside");
    if (status < Status::kClipSignature || status > Status::kClipLimit) broke("another status");
  }

  void play(const Clip& clip, bool reverse, uint32_t kinds) {
    if (kinds == 0) return;
    const SamplerLimits limits = {clip.channel_count, clip.changing_count, reverse};
    ClipSampler sampler;
    Placer measure(nullptr);
    place_clip_sampler(measure, limits, sampler);
    const auto memory = std::make_unique<uint8_t[]>(measure.size() + kBlockAlignment);
    const auto at = reinterpret_cast<uintptr_t>(memory.get());
    Placer placer(memory.get() + (align_up(at, kBlockAlignment) - at));
    place_clip_sampler(placer, limits, sampler);

    for (uint32_t kind = 0; kind < 3; ++kind) {
      if ((kinds >> kind & 1) == 0) continue;
      PlayDesc desc;
      desc.interpolation = static_cast<Interpolation>(kind);
      desc.looping = kind == 1 ? Looping::kOnce : Looping::kLoop;
      Error error;
      if (start_clip(sampler, clip, desc, error) != Status::kOk) return broke("not started");
      const int64_t frame = clip.ticks_per_frame, length = frame * clip.frame_count;
      for (int i = 0; i < 70; ++i) step(sampler, frame * 3 / 4);
      for (int i = 0; i < 70; ++i) step(sampler, -frame * 2 / 3);
      for (int64_t i = 0; i < 8; ++i) {
        seek_clip(sampler, length / 8 * i);
        step(sampler, i % 2 == 0 ? frame / 2 : -frame);
      }
      step(sampler, length < kMaxStepTicks / 2 ? 2 * length : kMaxStepTicks);
    }
  }

  void step(ClipSampler& sampler, int64_t ticks) {
    const int64_t most = kMaxStepTicks;
    EventRange range = advance_clip(sampler, ticks < -most ? -most : ticks > most ? most : ticks);
    ClipEvent event = {};
    for (int i = 0; i < 100 && next_event(range, event); ++i) {
      add(event.value);
      if (event.name.empty()) broke("an event without a name");
    }
    const Span<const float> values = sample_clip(sampler);
    if (values.count != sampler.clip->channel_count) broke("values are missing");
    for (float value : values) add(value);
  }

  volatile float sum_ = 0;
};

}  // namespace mien
