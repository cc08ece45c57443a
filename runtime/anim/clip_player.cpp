// SPDX-License-Identifier: MIT
#include "runtime/anim/clip_player.h"

namespace mien {
namespace {

struct PlacePlayer {
  SamplerLimits limits;
  void operator()(Placer& placer, ClipPlayer& player) const {
    place_clip_sampler(placer, limits, player.sampler);
  }
};

PlacePlayer placing(const Clip& clip, bool reverse) {
  return {{clip.channel_count, clip.changing_count, reverse}};
}

}  // namespace

size_t clip_player_size(const Clip& clip, bool reverse) {
  return block_bytes<ClipPlayer>(placing(clip, reverse));
}

Status create_clip_player(const SharedClip& clip, const PlayDesc& desc, bool reverse,
                          const Allocator& allocator, ClipPlayer*& out, Error& error) {
  out = create_object<ClipPlayer>(allocator, placing(clip.view, reverse));
  if (!out) return fail(error, Status::kMemory, kNoOffset, "no memory for a player of a clip");
  const Status status = start_clip(out->sampler, clip.view, desc, error);
  if (status != Status::kOk) {
    release(out);
    out = nullptr;
    return status;
  }
  out->clip = share(clip);
  return status;
}

}  // namespace mien
