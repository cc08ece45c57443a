// SPDX-License-Identifier: MIT
#include "runtime/mix/mix.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/anim/clip.h"
#include "runtime/base/arena.h"
#include "runtime/mix/fade.h"
#include "runtime/mix/stream.h"

namespace mien {
namespace {

/// What is wrong with an element of a list, and what it would have to be.
template <class... Values>
Status wrong(Error& error, const char* format, size_t index, Values... values) {
  return fail(error, Status::kInvalidArgument, kNoOffset, format, index, values...);
}

/// The first element that is not within the limits; the number of elements if all are.
size_t first_beyond(Span<const float> values, float low, float high) {
  size_t i = 0;
  while (i < values.count && values[i] >= low && values[i] <= high) ++i;
  return i;
}

/// Refuses the first lane that does not exist, or is there twice where each has one value.
Status check_lane_list(const MixDesc& desc, Span<const uint16_t> list, bool once, const char* of,
                       size_t index, Error& error) {
  const uint32_t lanes = desc.raw_count + desc.variable_count;
  uint64_t seen[kMaxLanes / 64] = {};
  for (size_t i = 0; i < list.count; ++i) {
    const uint16_t lane = list[i];
    if (lane >= lanes) {
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "%s %zu: .lanes[%zu] is %u; lanes are below %u", of, index, i, lane, lanes);
    }
    uint64_t& word = seen[lane / 64];
    const uint64_t bit = uint64_t{1} << lane % 64;
    if (once && (word & bit) != 0) {
      const bool named = desc.names && lane < desc.raw_count;
      const Span<const char> name = named ? (*desc.names)[lane] : Span<char>{};
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "%s %zu: .lanes[%zu] is %u%s%.*s, which it lists twice", of, index, i, lane,
                  named ? ", " : "", static_cast<int>(name.count), name.data ? name.data : "");
    }
    word |= bit;
  }
  return Status::kOk;
}

bool within(float value, float low, float high) { return value >= low && value <= high; }

bool is_time(int64_t ticks) { return ticks >= 0 && ticks <= kMaxFadeTicks; }

bool is_gaze(const LayerDesc& layer) {
  return layer.source == LayerSource::kGenerator && layer.generator == Generator::kGaze;
}

bool is_protected(LayerGroup group) {
  return group == LayerGroup::kBase || group == LayerGroup::kSpeech;
}

constexpr char kTimeRange[] = "times are 0 ... 2^40 ticks (26 minutes)";

Status check_layers(const MixDesc& desc, uint32_t lanes, Error& error) {
  if (desc.layers.count > kMaxLayers) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "%zu layers; a mix has at most %u",
                desc.layers.count, kMaxLayers);
  }
  uint32_t clips = 0, gazes = 0;
  for (size_t i = 0; i < desc.layers.count; ++i) {
    const LayerDesc& layer = desc.layers[i];
    const auto group = static_cast<uint32_t>(layer.group), mode = static_cast<uint32_t>(layer.mode);
    const auto source = static_cast<uint32_t>(layer.source);
    if (group >= kLayerGroups || mode >= kBlendModes || source >= kLayerSources) {
      return wrong(error, "layer %zu: .group %u, .mode %u or .source %u is none of the known ones",
                   i, group, mode, source);
    }
    if ((layer.flags & ~uint32_t{kLayerAfterGuards}) != 0 ||
        (layer.flags != 0 && is_protected(layer.group))) {
      return wrong(error,
                   "layer %zu: .flags %u; only .after_guards is known, and not in the groups base "
                   "and speech, which guards protect",
                   i, layer.flags);
    }
    const float lowest = layer.mode == BlendMode::kAdd ? -1.0f : 0.0f;
    if (!within(layer.weight, lowest, 1.0f)) {
      return wrong(error, "layer %zu: .weight is %g; it must be within %g ... 1", i,
                   double{layer.weight}, double{lowest});
    }
    if (layer.mask.count > lanes) {
      return wrong(error, "layer %zu: .mask has %zu lanes; the mix has %u", i, layer.mask.count,
                   lanes);
    }
    const size_t beyond = first_beyond(layer.mask, 0.0f, 1.0f);
    if (beyond != layer.mask.count) {
      return wrong(error, "layer %zu: .mask[%zu] is %g; masks are within 0 ... 1", i, beyond,
                   double{layer.mask[beyond]});
    }
    if (layer.first_pose > desc.poses.count ||
        layer.pose_count > desc.poses.count - layer.first_pose) {
      return wrong(error, "layer %zu: %u poses from %u on; the mix has %zu", i, layer.pose_count,
                   layer.first_pose, desc.poses.count);
    }
    clips += layer.source == LayerSource::kClip;
    if (layer.source != LayerSource::kStream && layer.source != LayerSource::kGenerator) continue;
    if (layer.lanes.count > lanes) {
      return wrong(error, "layer %zu: %zu lanes; the mix has %u", i, layer.lanes.count, lanes);
    }
    const Status status = check_lane_list(desc, layer.lanes, false, "layer", i, error);
    if (status != Status::kOk) return status;
    if (layer.source == LayerSource::kGenerator) {
      if (static_cast<uint32_t>(layer.generator) >= kGenerators || layer.period < 1 ||
          layer.period > kMaxFadeTicks) {
        return wrong(
            error,
            "layer %zu: .generator %u with a .period of %lld ticks; generators are below %u, "
            "periods 1 ... 2^40 ticks",
            i, static_cast<uint32_t>(layer.generator), static_cast<long long>(layer.period),
            kGenerators);
      }
      if (layer.amounts.count != layer.lanes.count ||
          first_beyond(layer.amounts, -kLargestFloat, kLargestFloat) != layer.amounts.count) {
        return wrong(error, "layer %zu: %zu finite .amounts are needed, one for each of .lanes", i,
                     layer.lanes.count);
      }
      const size_t count = layer.lanes.count;
      if (is_gaze(layer) && (!desc.gaze || (count != 3 && count != 5) || ++gazes > 1)) {
        return wrong(
            error,
            "layer %zu: a gaze takes 3 or 5 lanes, not %zu, and the gaze of the mix; there is "
            "one such layer at most",
            i, count);
      }
    } else if (!is_time(layer.delay) || layer.stream_frames < 2 ||
               layer.stream_frames > kMaxStreamFrames) {
      return wrong(error, "layer %zu: .delay %lld, .stream_frames %u; %s, frames 2 ... %u", i,
                   static_cast<long long>(layer.delay), layer.stream_frames, kTimeRange,
                   kMaxStreamFrames);
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
    if (reaction.strokes.count > kMaxStrokes) {
      return wrong(error, "reaction %zu: %zu strokes; it has at most %u", i, reaction.strokes.count,
                   kMaxStrokes);
    }
    if (static_cast<uint32_t>(reaction.retrigger) > 2 || !within(reaction.adapted, 0.0f, 1.0f)) {
      return wrong(
          error, "reaction %zu: .retrigger %u, .adapted %g; rules are 0 ... 2, the latter 0 ... 1",
          i, static_cast<uint32_t>(reaction.retrigger), double{reaction.adapted});
    }
    if (!within(reaction.level_on, 0.0f, 1.0f) ||
        !within(reaction.level_off, 0.0f, reaction.level_on)) {
      return wrong(error,
                   "reaction %zu: .level_off %g, .level_on %g; they are 0 ... 1, in this order", i,
                   double{reaction.level_off}, double{reaction.level_on});
    }
    if (!is_time(reaction.cooldown) || !is_time(reaction.adapt_ticks) ||
        !is_time(reaction.recover_ticks)) {
      return wrong(error, "reaction %zu: .cooldown, .adapt_ticks or .recover_ticks; %s", i,
                   kTimeRange);
    }
    for (size_t s = 0; s < reaction.strokes.count; ++s) {
      const Stroke& stroke = reaction.strokes[s];
      if (stroke.pose >= desc.poses.count || static_cast<uint32_t>(stroke.mode) >= kBlendModes) {
        return wrong(error, "reaction %zu, stroke %zu: .pose %u of %zu, .mode %u of %u", i, s,
                     stroke.pose, desc.poses.count, static_cast<uint32_t>(stroke.mode),
                     kBlendModes);
      }
      if (!is_time(stroke.delay) || !is_time(stroke.attack) || !is_time(stroke.hold) ||
          !is_time(stroke.release)) {
        return wrong(error, "reaction %zu, stroke %zu: .delay, .attack, .hold or .release; %s", i,
                     s, kTimeRange);
      }
    }
  }
  return Status::kOk;
}

Status check_guard(const MixDesc& desc, size_t i, Error& error) {
  const Guard& guard = desc.guards[i];
  if (guard.count > kMaxGuardLanes || guard.pair_count > kMaxGuardPairs) {
    return wrong(error, "guard %zu: %u lanes and %u pairs; it has at most %u and %u", i,
                 guard.count, guard.pair_count, kMaxGuardLanes, kMaxGuardPairs);
  }
  const Status status = check_lane_list(desc, {guard.lanes, guard.count}, true, "guard", i, error);
  if (status != Status::kOk) return status;
  if (guard.together >> guard.count != 0 || (guard.together & (guard.together << 1 | 1)) != 0) {
    return wrong(
        error, "guard %zu: .together %u; a lane goes with the one before, in pairs of the %u lanes",
        i, guard.together, guard.count);
  }
  bool finite =
      first_beyond({guard.gains, guard.count}, -kLargestFloat, kLargestFloat) == guard.count;
  for (uint32_t k = 0; k < guard.pair_count; ++k) {
    const GuardPair& pair = guard.pairs[k];
    finite = finite && std::isfinite(pair.gain);
    if (pair.first < guard.count && pair.second < guard.count && pair.first != pair.second)
      continue;
    return wrong(error,
                 "guard %zu: pair %u is of its lanes %u and %u; it has %u, and a pair has two", i,
                 k, pair.first, pair.second, guard.count);
  }
  if (finite && std::isfinite(guard.rest) && within(guard.tolerance, 0.0f, kLargestFloat) &&
      guard.f_on > 0.0f && std::isfinite(guard.f_on)) {
    return Status::kOk;
  }
  return wrong(
      error,
      "guard %zu: gains and .rest must be finite, .tolerance (%g) 0 or more, .f_on (%g) above "
      "0",
      i, double{guard.tolerance}, double{guard.f_on});
}

Status check_lanes(const MixDesc& desc, uint32_t lanes, Error& error) {
  if (desc.poses.count > kMaxPoses || desc.guards.count > kMaxGuards) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%zu poses and %zu guards; a mix has at most %u and %u", desc.poses.count,
                desc.guards.count, kMaxPoses, kMaxGuards);
  }
  Status status = Status::kOk;
  for (size_t i = 0; i < desc.poses.count; ++i) {
    const PoseDesc& pose = desc.poses[i];
    if (pose.lanes.count != pose.values.count || pose.lanes.count > lanes) {
      return wrong(error, "pose %zu: %zu lanes, %zu values; both must be as many, at most %u", i,
                   pose.lanes.count, pose.values.count, lanes);
    }
    status = check_lane_list(desc, pose.lanes, true, "pose", i, error);
    if (status != Status::kOk) return status;
    const size_t beyond = first_beyond(pose.values, -kLargestFloat, kLargestFloat);
    if (beyond != pose.values.count) {
      return wrong(error, "pose %zu: .values[%zu] is %g; values must be finite", i, beyond,
                   double{pose.values[beyond]});
    }
  }
  for (size_t i = 0; i < desc.guards.count && status == Status::kOk; ++i) {
    status = check_guard(desc, i, error);
  }
  if (status != Status::kOk) return status;
  for (size_t i = 0; i < desc.antagonists.count; ++i) {
    const AntagonistPair& pair = desc.antagonists[i];
    if (pair.a >= lanes || pair.b >= lanes || pair.a == pair.b) {
      return wrong(error, "antagonists %zu: lanes %u and %u; they must be two of %u", i, pair.a,
                   pair.b, lanes);
    }
    if (!within(pair.stiffness, 0.0f, 1.0f)) {
      return wrong(error, "antagonists %zu: .stiffness is %g; it must be within 0 ... 1", i,
                   double{pair.stiffness});
    }
  }
  if (desc.gaze) {
    for (const GazeEye& eye : desc.gaze->eyes) {
      for (uint16_t lane : eye.lanes) {
        if (lane >= desc.raw_count) {
          return wrong(error, "gaze: control %zu of %u", lane, desc.raw_count);
        }
      }
    }
  }
  if (!desc.mirror.empty() && desc.mirror.count != lanes) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "the mirror map has %zu of %u lanes",
                desc.mirror.count, lanes);
  }
  for (size_t i = 0; i < desc.mirror.count; ++i) {
    if (desc.mirror[i] >= lanes || desc.mirror[desc.mirror[i]] != i) {
      return wrong(error,
                   "mirror map: lane %zu becomes %u, which does not become it; give lanes in pairs",
                   i, desc.mirror[i]);
    }
  }
  if (desc.lower.count != desc.upper.count || (!desc.lower.empty() && desc.lower.count != lanes)) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "limits of %zu and %zu of %u lanes",
                desc.lower.count, desc.upper.count, lanes);
  }
  for (size_t i = 0; i < desc.lower.count; ++i) {
    if (!(desc.lower[i] <= desc.upper[i]) || !std::isfinite(desc.lower[i]) ||
        !std::isfinite(desc.upper[i])) {
      return wrong(error, "limits of lane %zu: %g ... %g; they must be finite and in order", i,
                   double{desc.lower[i]}, double{desc.upper[i]});
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
  mix.pose_rows = placer.array<Span<float>>(desc.poses.count);
  for (size_t i = 0; i < desc.poses.count; ++i) {
    if (desc.poses[i].lanes.count * 2 < mix.lane_count) continue;
    const Span<float> row = placer.array<float>(mix.lane_count, kBlockAlignment);
    if (!placer.measuring()) mix.pose_rows[i] = row;
  }
  mix.pose_lanes = placer.array<uint16_t>(values);
  mix.pose_values = placer.array<float>(values);
  size_t strokes = 0;
  for (const ReactionDesc& reaction : desc.reactions) strokes += reaction.strokes.count;
  mix.reactions = placer.array<Reaction>(desc.reactions.count);
  mix.strokes = placer.array<Stroke>(strokes);
  size_t guarded = 0;
  for (const Guard& guard : desc.guards) guarded += guard.count;
  mix.guards = placer.array<Guard>(desc.guards.count);
  mix.guarded = placer.array<uint16_t>(guarded);
  mix.placed_guards = placer.array<PlacedGuard>(desc.guards.count);
  mix.antagonists = placer.array<AntagonistPair>(desc.antagonists.count);
  for (const LayerDesc& layer : desc.layers) {
    if (!is_gaze(layer)) continue;
    mix.gaze_lanes = placer.array<uint16_t>(8 + layer.lanes.count - 3);
  }
  mix.mirror = placer.array<uint16_t>(desc.mirror.count);
  mix.lower = placer.array<float>(mix.lane_count, kBlockAlignment);
  mix.upper = placer.array<float>(mix.lane_count, kBlockAlignment);
  if (!desc.names) return;
  mix.names.first = placer.array<uint32_t>(desc.names->first.count);
  mix.names.chars = placer.array<char>(desc.names->chars.count);
}

template <class T>
void copy_items(Span<const T> from, Span<T> to) {
  if (!from.empty()) memcpy(static_cast<void*>(to.data), from.data, from.count * sizeof(T));
}

void fill_gaze(const MixDesc& desc, const LayerDesc& layer, Mix& mix) {
  mix.has_gaze = true;
  mix.gaze = *desc.gaze;
  for (uint32_t i = 0; i < 8; ++i) mix.gaze_lanes[i] = mix.gaze.eyes[i / 4].lanes[i % 4];
  for (size_t i = 3; i < layer.lanes.count; ++i) mix.gaze_lanes[5 + i] = layer.lanes[i];
}

void fill_layers(const MixDesc& desc, Mix& mix) {
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
    layer.has_mask = !from.mask.empty();
    const auto mask_of = [&](uint32_t lane) {
      return from.mask.empty() ? 1.0f : lane < from.mask.count ? from.mask[lane] : 0.0f;
    };
    if (layer.source == LayerSource::kPoses) {
      // Lanes that no pose has are left alone.
      for (const PoseDesc& pose : desc.poses.slice(layer.first_pose, layer.pose_count)) {
        for (uint16_t lane : pose.lanes) layer.mask[lane] = mask_of(lane);
      }
    } else if (layer.source == LayerSource::kClip) {
      for (uint32_t l = 0; l < mix.raw_count; ++l) layer.mask[l] = mask_of(l);
    } else if (is_gaze(from)) {
      fill_gaze(desc, from, mix);
      for (uint16_t lane : mix.gaze_lanes) layer.mask[lane] = mask_of(lane);
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
  copy_items(desc.guards, mix.guards);
  mix.guarded.count = list_guarded_lanes(desc.guards, mix.guarded.data);
  for (size_t g = 0; g < mix.guards.count; ++g) {
    place_guard(mix.guards[g], mix.guarded, mix.placed_guards[g]);
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
    if (mix.pose_rows[i].empty()) continue;
    for (size_t k = 0; k < pose.lanes.count; ++k) {
      mix.pose_rows[i][pose.lanes[k]] = pose.values[k];
    }
  }
  uint32_t stroke = 0;
  for (size_t i = 0; i < desc.reactions.count; ++i) {
    const ReactionDesc& from = desc.reactions[i];
    const auto count = static_cast<uint32_t>(from.strokes.count);
    copy_items(from.strokes, mix.strokes.slice(stroke, count));
    mix.reactions[i] = {stroke,
                        stroke + count,
                        from.retrigger,
                        from.after_guards,
                        {},
                        from.adapted,
                        from.level_on,
                        from.level_off,
                        from.cooldown,
                        from.adapt_ticks,
                        from.recover_ticks};
    stroke += count;
  }
  fill_guards(desc, mix);
  copy_items(desc.antagonists, mix.antagonists);
  copy_items(desc.mirror, mix.mirror);
  if (desc.names) {
    copy_items(Span<const uint32_t>(desc.names->first), mix.names.first);
    copy_items(Span<const char>(desc.names->chars), mix.names.chars);
  }
  mix.has_limits = !desc.lower.empty();
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
      hash_numbers(0xCBF29CE484222325u, {mix.raw_count, mix.variable_count, mix.player_count,
                                         mix.guards.count, mix.guarded.count, mix.layers.count,
                                         mix.reactions.count, mix.strokes.count, mix.has_gaze});
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
                "%u channels, %u of them changing, %u GUI controls, %u events; clips have at most "
                "%u, %u, %u "
                "and %u",
                desc.max_channels, desc.max_changing_channels, desc.max_bound_gui, desc.max_events,
                kMaxClipChannels, kMaxChangingChannels, kMaxClipChannels, kMaxClipChannels);
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
  if (!block) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for a mix: %zu bytes",
                measure.size());
  }
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
