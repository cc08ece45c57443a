// SPDX-License-Identifier: MIT
#include "runtime/mix/mix.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/anim/clip.h"
#include "runtime/base/arena.h"
#include "runtime/mix/fade.h"
#include "runtime/mix/stream.h"
#include "runtime/rig/rig.h"

namespace mien {
namespace {

Status wrong(Error& error, const char* what, size_t index, const char* why) {
  return fail(error, Status::kInvalidArgument, kNoOffset, "%s %zu: %s", what, index, why);
}

bool within(float value, float low, float high) { return value >= low && value <= high; }

bool all_within(Span<const float> values, float low, float high) {
  for (float value : values) {
    if (!within(value, low, high)) return false;
  }
  return true;
}

bool is_time(int64_t ticks) { return ticks >= 0 && ticks <= kMaxFadeTicks; }

bool is_protected(LayerGroup group) {
  return group == LayerGroup::kBase || group == LayerGroup::kSpeech;
}

Status check_layers(const MixDesc& desc, uint32_t lanes, Error& error) {
  if (desc.layers.count > kMaxLayers) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "%zu layers; a mix has at most %u",
                desc.layers.count, kMaxLayers);
  }
  uint32_t clips = 0;
  for (size_t i = 0; i < desc.layers.count; ++i) {
    const LayerDesc& layer = desc.layers[i];
    if (static_cast<uint32_t>(layer.group) >= kLayerGroups ||
        static_cast<uint32_t>(layer.mode) >= kBlendModes ||
        static_cast<uint32_t>(layer.source) >= kLayerSources) {
      return wrong(error, "layer", i, "group, mode or source is not known");
    }
    if ((layer.flags & ~uint32_t{kLayerAfterGuards}) != 0 ||
        (layer.flags != 0 && is_protected(layer.group))) {
      return wrong(error, "layer", i, "the flags do not fit the group");
    }
    const float lowest = layer.mode == BlendMode::kAdd ? -1.0f : 0.0f;
    if (!within(layer.weight, lowest, 1.0f)) return wrong(error, "layer", i, "weight out of range");
    if (layer.mask.count > lanes) return wrong(error, "layer", i, "mask with too many lanes");
    if (!all_within(layer.mask, 0.0f, 1.0f)) return wrong(error, "layer", i, "mask beyond 0 ... 1");
    if (layer.first_pose > desc.poses.count ||
        layer.pose_count > desc.poses.count - layer.first_pose) {
      return wrong(error, "layer", i, "poses that the mix does not have");
    }
    clips += layer.source == LayerSource::kClip;
    if (layer.source != LayerSource::kStream && layer.source != LayerSource::kGenerator) continue;
    if (layer.lanes.count > lanes) return wrong(error, "layer", i, "too many lanes");
    for (uint16_t lane : layer.lanes) {
      if (lane >= lanes) return wrong(error, "layer", i, "a lane that does not exist");
    }
    const bool generates = layer.source == LayerSource::kGenerator;
    if (generates && (static_cast<uint32_t>(layer.generator) >= kGenerators || layer.period < 1 ||
                      layer.period > kMaxFadeTicks || layer.amounts.count != layer.lanes.count ||
                      !all_within(layer.amounts, -kLargestFloat, kLargestFloat))) {
      return wrong(error, "layer", i, "generator, period or amounts out of range");
    }
    if (!generates && (!is_time(layer.delay) || layer.stream_frames < 2 ||
                       layer.stream_frames > kMaxStreamFrames)) {
      return wrong(error, "layer", i, "delay or number of frames out of range");
    }
  }
  if (desc.player_count >= clips && desc.player_count <= 4 * kMaxLayers) return Status::kOk;
  return fail(error, Status::kInvalidArgument, kNoOffset,
              "%u players; each of the %u layers of clips needs one, and at most %u can be",
              desc.player_count, clips, 4 * kMaxLayers);
}

Status check_reactions(const MixDesc& desc, Error& error) {
  if (desc.reactions.count > kMaxReactions) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "%zu reactions; a mix has at most %u",
                desc.reactions.count, kMaxReactions);
  }
  for (size_t i = 0; i < desc.reactions.count; ++i) {
    const ReactionDesc& reaction = desc.reactions[i];
    if (reaction.strokes.count > kMaxStrokes)
      return wrong(error, "reaction", i, "too many strokes");
    if (!within(reaction.adapted, 0.0f, 1.0f) || !is_time(reaction.cooldown) ||
        !is_time(reaction.adapt_ticks) || !is_time(reaction.recover_ticks) ||
        static_cast<uint32_t>(reaction.retrigger) > 2) {
      return wrong(error, "reaction", i, "rule, adaptation or a time out of range");
    }
    for (const Stroke& stroke : reaction.strokes) {
      if (stroke.pose >= desc.poses.count || static_cast<uint32_t>(stroke.mode) >= kBlendModes) {
        return wrong(error, "reaction", i, "a stroke with a pose or mode that does not exist");
      }
      if (!is_time(stroke.delay) || !is_time(stroke.attack) || !is_time(stroke.hold) ||
          !is_time(stroke.release)) {
        return wrong(error, "reaction", i, "a stroke with a time out of range");
      }
    }
  }
  return Status::kOk;
}

Status check_lanes(const MixDesc& desc, uint32_t lanes, Error& error) {
  if (desc.poses.count > kMaxPoses) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "%zu poses; a mix has at most %u",
                desc.poses.count, kMaxPoses);
  }
  for (size_t i = 0; i < desc.poses.count; ++i) {
    const PoseDesc& pose = desc.poses[i];
    if (pose.lanes.count != pose.values.count || pose.lanes.count > lanes) {
      return wrong(error, "pose", i, "counts of lanes and values do not match");
    }
    for (uint16_t lane : pose.lanes) {
      if (lane >= lanes) return wrong(error, "pose", i, "a lane that does not exist");
    }
    if (!all_within(pose.values, -kLargestFloat, kLargestFloat)) {
      return wrong(error, "pose", i, "a value is not finite");
    }
  }
  if (desc.guards.count > kMaxGuards) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "%zu guards; a mix has at most %u",
                desc.guards.count, kMaxGuards);
  }
  for (size_t i = 0; i < desc.guards.count; ++i) {
    const Guard& guard = desc.guards[i];
    if (guard.count > kMaxGuardLanes) return wrong(error, "guard", i, "too many lanes");
    if (guard.pair_count > kMaxGuardPairs) return wrong(error, "guard", i, "too many pairs");
    for (uint32_t k = 0; k < guard.pair_count; ++k) {
      const GuardPair& pair = guard.pairs[k];
      if (pair.first >= guard.count || pair.second >= guard.count || pair.first == pair.second) {
        return wrong(error, "guard", i, "a pair of lanes that it does not have");
      }
      if (!std::isfinite(pair.gain)) return wrong(error, "guard", i, "a gain is not finite");
    }
    for (uint32_t k = 0; k < guard.count; ++k) {
      if (guard.lanes[k] >= lanes) return wrong(error, "guard", i, "a lane that does not exist");
      if (!std::isfinite(guard.gains[k])) return wrong(error, "guard", i, "a gain is not finite");
    }
    if (!std::isfinite(guard.rest) || !within(guard.tolerance, 0.0f, kLargestFloat) ||
        !(guard.f_on > 0.0f) || !std::isfinite(guard.f_on)) {
      return wrong(error, "guard", i, "rest, f_on or tolerance out of range");
    }
  }
  for (size_t i = 0; i < desc.antagonists.count; ++i) {
    const AntagonistPair& pair = desc.antagonists[i];
    if (pair.a >= lanes || pair.b >= lanes || pair.a == pair.b) {
      return wrong(error, "antagonists", i, "they are not two lanes of the mix");
    }
    if (!within(pair.stiffness, 0.0f, 1.0f)) {
      return wrong(error, "antagonists", i, "stiffness beyond 0 ... 1");
    }
  }
  if (!desc.mirror.empty() && desc.mirror.count != lanes) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "the mirror map has %zu of %u lanes",
                desc.mirror.count, lanes);
  }
  for (size_t i = 0; i < desc.mirror.count; ++i) {
    if (desc.mirror[i] >= lanes || desc.mirror[desc.mirror[i]] != i) {
      return wrong(error, "mirror map, lane", i, "it is not the mirror image of its own image");
    }
  }
  if (desc.lower.count != desc.upper.count || (!desc.lower.empty() && desc.lower.count != lanes)) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "limits of %zu and %zu of %u lanes",
                desc.lower.count, desc.upper.count, lanes);
  }
  for (size_t i = 0; i < desc.lower.count; ++i) {
    if (!(desc.lower[i] <= desc.upper[i]) || !std::isfinite(desc.lower[i]) ||
        !std::isfinite(desc.upper[i])) {
      return wrong(error, "limits, lane", i, "lower and upper are not in order");
    }
  }
  return Status::kOk;
}

void place_mix(Placer& placer, const MixDesc& desc, Mix& mix) {
  placer.unwritten_array<Mix>(1);
  mix.layers = placer.array<MixLayer>(desc.layers.count);
  for (size_t i = 0; i < desc.layers.count; ++i) {
    const Span<float> mask = placer.array<float>(mix.lane_count, kBlockAlignment);
    const Span<uint16_t> lanes = placer.array<uint16_t>(desc.layers[i].lanes.count);
    const Span<float> amounts = placer.array<float>(desc.layers[i].amounts.count);
    if (placer.measuring()) continue;
    mix.layers[i].mask = mask;
    mix.layers[i].lanes = lanes;
    mix.layers[i].amounts = amounts;
  }
  size_t values = 0;
  for (const PoseDesc& pose : desc.poses) values += pose.lanes.count;
  mix.pose_ends = placer.array<uint32_t>(desc.poses.count);
  mix.pose_lanes = placer.array<uint16_t>(values);
  mix.pose_values = placer.array<float>(values);
  size_t strokes = 0;
  for (const ReactionDesc& reaction : desc.reactions) strokes += reaction.strokes.count;
  mix.reactions = placer.array<Reaction>(desc.reactions.count);
  mix.strokes = placer.array<Stroke>(strokes);
  size_t guarded = 0;
  for (const Guard& guard : desc.guards) guarded += guard.count;
  mix.guarded = placer.array<uint16_t>(guarded);
  mix.guards = placer.array<Guard>(desc.guards.count);
  mix.antagonists = placer.array<AntagonistPair>(desc.antagonists.count);
  mix.mirror = placer.array<uint16_t>(desc.mirror.count);
  mix.lower = placer.array<float>(mix.lane_count, kBlockAlignment);
  mix.upper = placer.array<float>(mix.lane_count, kBlockAlignment);
}

template <class T>
void copy_items(Span<const T> from, Span<T> to) {
  if (!from.empty()) memcpy(static_cast<void*>(to.data), from.data, from.count * sizeof(T));
}

void fill_layers(const MixDesc& desc, Mix& mix) {
  const uint32_t lanes = mix.used_lanes();
  for (size_t i = 0; i < desc.layers.count; ++i) {
    const LayerDesc& from = desc.layers[i];
    MixLayer& layer = mix.layers[i];
    layer.group = from.group;
    layer.mode = from.mode;
    layer.source = from.source;
    layer.flags = from.flags;
    layer.weight = from.weight;
    layer.first_pose = from.first_pose;
    layer.pose_count = from.source == LayerSource::kPoses ? from.pose_count : 0;
    layer.first_fade = mix.fade_count;
    mix.fade_count += layer.pose_count;
    layer.generator = from.generator;
    layer.period = from.period;
    layer.delay = from.delay;
    layer.stream_frames = from.stream_frames;
    copy_items(from.lanes, layer.lanes);
    copy_items(from.amounts, layer.amounts);
    const auto mask_of = [&](uint32_t lane) {
      return from.mask.empty() ? 1.0f : lane < from.mask.count ? from.mask[lane] : 0.0f;
    };
    if (layer.source == LayerSource::kPoses) {
      // Lanes that no pose has are left alone.
      for (const PoseDesc& pose : desc.poses.slice(layer.first_pose, layer.pose_count)) {
        for (uint16_t lane : pose.lanes) layer.mask[lane] = mask_of(lane);
      }
    } else if (layer.source == LayerSource::kClip) {
      for (uint32_t l = 0; l < lanes; ++l) layer.mask[l] = mask_of(l);
    } else {
      for (uint16_t lane : from.lanes) layer.mask[lane] = mask_of(lane);
    }
    if (is_protected(layer.group)) mix.first_unprotected = static_cast<uint32_t>(i + 1);
    if (layer.group != LayerGroup::kLife && layer.flags == 0) {
      mix.first_after_reactions = static_cast<uint32_t>(i + 1);
    }
  }
}

void fill_guards(const MixDesc& desc, Mix& mix) {
  size_t count = 0;
  for (const Guard& guard : desc.guards) {
    for (uint32_t i = 0; i < guard.count; ++i) mix.guarded[count++] = guard.lanes[i];
  }
  uint16_t* const lanes = mix.guarded.data;
  std::sort(lanes, lanes + count);
  mix.guarded.count = static_cast<size_t>(std::unique(lanes, lanes + count) - lanes);
  copy_items(desc.guards, mix.guards);
  for (Guard& guard : mix.guards) {
    for (uint32_t i = 0; i < kMaxGuardLanes; ++i) {
      const bool used = i < guard.count;
      const uint16_t* at = std::lower_bound(lanes, mix.guarded.end(), guard.lanes[i]);
      guard.lanes[i] = used ? static_cast<uint16_t>(at - lanes) : uint16_t{0};
      if (!used) guard.gains[i] = 0;
    }
  }
}

void fill_mix(const MixDesc& desc, Mix& mix) {
  fill_layers(desc, mix);
  uint32_t end = 0;
  for (size_t i = 0; i < desc.poses.count; ++i) {
    const PoseDesc& pose = desc.poses[i];
    copy_items(pose.lanes, mix.pose_lanes.slice(end, pose.lanes.count));
    copy_items(pose.values, mix.pose_values.slice(end, pose.values.count));
    mix.pose_ends[i] = end += static_cast<uint32_t>(pose.lanes.count);
  }
  uint32_t stroke = 0;
  for (size_t i = 0; i < desc.reactions.count; ++i) {
    const ReactionDesc& from = desc.reactions[i];
    const auto count = static_cast<uint32_t>(from.strokes.count);
    copy_items(from.strokes, mix.strokes.slice(stroke, count));
    mix.reactions[i] = {stroke,       stroke + count, from.retrigger,   from.after_guards, {},
                        from.adapted, from.cooldown,  from.adapt_ticks, from.recover_ticks};
    stroke += count;
  }
  fill_guards(desc, mix);
  copy_items(desc.antagonists, mix.antagonists);
  copy_items(desc.mirror, mix.mirror);
  for (uint32_t l = 0; l < mix.used_lanes(); ++l) {
    mix.lower[l] = desc.lower.empty() ? -kLargestFloat : desc.lower[l];
    mix.upper[l] = desc.upper.empty() ? kLargestFloat : desc.upper[l];
  }
}

/// FNV-1a
uint64_t hash_numbers(uint64_t hash, std::initializer_list<uint64_t> numbers) {
  for (uint64_t number : numbers) {
    for (int i = 0; i < 8; ++i) hash = (hash ^ (number >> 8 * i & 0xFF)) * 0x100000001B3u;
  }
  return hash;
}

uint64_t fingerprint(const Mix& mix) {
  uint64_t hash =
      hash_numbers(0xCBF29CE484222325u,
                   {mix.raw_count, mix.variable_count, mix.player_count, mix.guards.count,
                    mix.guarded.count, mix.layers.count, mix.reactions.count, mix.strokes.count});
  for (const MixLayer& layer : mix.layers) {
    hash = hash_numbers(hash, {static_cast<uint64_t>(layer.mode),
                               static_cast<uint64_t>(layer.source), layer.pose_count});
  }
  return hash;
}

}  // namespace

Status create_mix(const MixDesc& desc, const Allocator& allocator, Mix*& out, Error& error) {
  out = nullptr;
  if (desc.raw_count > kMaxLanes || desc.variable_count > kMaxLanes - desc.raw_count) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%u raw controls and %u pose variables; a row has at most %u lanes", desc.raw_count,
                desc.variable_count, kMaxLanes);
  }
  if (desc.max_channels > kMaxClipChannels || desc.max_changing_channels > kMaxChangingChannels ||
      desc.max_bound_gui > kMaxClipChannels || desc.max_events > kMaxClipChannels) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "channels, GUI controls or events beyond what clips can have");
  }
  const uint32_t lanes = desc.raw_count + desc.variable_count;
  Status status = check_lanes(desc, lanes, error);
  if (status == Status::kOk) status = check_layers(desc, lanes, error);
  if (status == Status::kOk) status = check_reactions(desc, error);
  if (status != Status::kOk) return status;

  Mix measured;
  measured.lane_count = static_cast<uint32_t>(align_up(lanes, kLaneStep));
  Placer measure(nullptr);
  place_mix(measure, desc, measured);
  void* block = allocator.get(measure.size(), kBlockAlignment);
  if (!block) return fail(error, Status::kMemory, kNoOffset, "no memory for a mix");
  Mix& mix = *new (block) Mix;
  mix.raw_count = desc.raw_count;
  mix.variable_count = desc.variable_count;
  mix.lane_count = measured.lane_count;
  mix.player_count = desc.player_count;
  mix.max_channels = desc.max_channels;
  mix.max_changing_channels = desc.max_changing_channels;
  mix.max_bound_gui = desc.max_bound_gui;
  mix.max_events = desc.max_events;
  mix.plays_backward = desc.plays_backward;
  mix.kernels = desc.kernels ? desc.kernels : kernels_for(Isa::kBest);
  mix.allocator = allocator;
  mix.block_size = measure.size();
  Placer placer(block);
  place_mix(placer, desc, mix);
  fill_mix(desc, mix);
  mix.fingerprint = fingerprint(mix);
  out = &mix;
  return Status::kOk;
}

void release_mix(const Mix* mix) {
  if (!mix || mix->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  Mix* last = const_cast<Mix*>(mix);
  const Allocator allocator = last->allocator;
  const size_t size = last->block_size;
  last->tag = 0;
  last->~Mix();
  allocator.put(last, size, kBlockAlignment);
}

}  // namespace mien
