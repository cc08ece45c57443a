// SPDX-License-Identifier: MIT
// A sampler that owns a share of its clip and remembers the events that it passed.
#pragma once

#include "runtime/anim/clip_sampler.h"
#include "runtime/anim/shared_clip.h"

namespace mien {

struct ClipPlayer : Object {
  static constexpr uint32_t kTag = 0x6D43'504C;

  const SharedClip* clip = nullptr;
  ClipSampler sampler;
  EventRange events;  // passed by the last advance
  ~ClipPlayer() { release(clip); }
};

/// Bytes of a player. `reverse`: as in SamplerLimits.
size_t clip_player_size(const Clip& clip, bool reverse);

/// The player becomes an owner of the clip; give it back with release(). Errors of start_clip(), kMemory.
Status create_clip_player(const SharedClip& clip, const PlayDesc& desc, bool reverse,
                          const Allocator& allocator, ClipPlayer*& out, Error& error);

}  // namespace mien
