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

/// Fails with a message about an element of a list: what is wrong, and what is allowed.
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

/// Refuses the first curve that does not exist, or is there twice where each has one value.
Status check_curve_list(const MixDesc& desc, Span<const uint16_t> list, bool once, const char* of,
                        size_t index, Error& error) {
  const uint32_t curves = desc.raw_count + desc.variable_count;
  uint64_t seen[kMaxCurves / 64] = {};
  for (size_t i = 0; i < list.count; ++i) {
    const uint16_t curve = list[i];
    if (curve >= curves) {
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "%s %zu: .curves[%zu] is %u; curves are below %u", of, index, i, curve, curves);
    }
    uint64_t& word = seen[curve / 64];
    const uint64_t bit = uint64_t{1} << curve % 64;
    if (once && (word & bit) != 0) {
      const bool named = curve < desc.names.count();
      const Span<const char> name = named ? desc.names[curve] : Span<char>{};
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "%s %zu: .curves[%zu] is %u%s%.*s, which it lists twice", of, index, i, curve,
                  named ? ", " : "", static_cast<int>(name.count), name.data ? name.data : "");
    }
    word |= bit;
  }
  return Status::kOk;
}

bool within(float value, float low, float high) { return value >= low && value <= high; }

bool is_fade_time(int64_t ticks) { return ticks >= 0 && ticks <= kMaxFadeTicks; }

bool is_gaze(const LayerDesc& layer) {
  return layer.source == LayerSource::kGenerator && layer.generator == Generator::kGaze;
}

bool is_protected(LayerGroup group) {
  return group == LayerGroup::kBase || group == LayerGroup::kSpeech;
}

constexpr char kTimeRange[] = "times are 0 ... 2^40 ticks (26 minutes)";

Status check_layers(const MixDesc& desc, uint32_t curves, Error& error) {
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
    if (layer.mask.count > curves) {
      return wrong(error, "layer %zu: .mask has %zu curves; the mix has %u", i, layer.mask.count,
                   curves);
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
    if (layer.curves.count > curves) {
      return wrong(error, "layer %zu: %zu curves; the mix has %u", i, layer.curves.count, curves);
    }
    const Status status = check_curve_list(desc, layer.curves, false, "layer", i, error);
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
      if (layer.amounts.count != layer.curves.count ||
          first_beyond(layer.amounts, -kLargestFloat, kLargestFloat) != layer.amounts.count) {
        return wrong(error, "layer %zu: %zu finite .amounts are needed, one for each of .curves", i,
                     layer.curves.count);
      }
      const size_t count = layer.curves.count;
      if (is_gaze(layer) && (!desc.gaze || (count != 3 && count != 5) || ++gazes > 1)) {
        return wrong(
            error,
            "layer %zu: a gaze takes 3 or 5 curves, not %zu, and the gaze of the mix; there is "
            "one such layer at most",
            i, count);
      }
    } else if (!is_fade_time(layer.delay) || layer.stream_frames < 2 ||
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
    if (!is_fade_time(reaction.cooldown) || !is_fade_time(reaction.adapt_ticks) ||
        !is_fade_time(reaction.recover_ticks)) {
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
      if (!is_fade_time(stroke.delay) || !is_fade_time(stroke.attack) ||
          !is_fade_time(stroke.hold) || !is_fade_time(stroke.release)) {
        return wrong(error, "reaction %zu, stroke %zu: .delay, .attack, .hold or .release; %s", i,
                     s, kTimeRange);
      }
    }
  }
  return Status::kOk;
}

Status check_guard(const MixDesc& desc, size_t i, Error& error) {
  const Guard& guard = desc.guards[i];
  if (guard.count > kMaxGuardCurves || guard.pair_count > kMaxGuardPairs) {
    return wrong(error, "guard %zu: %u curves and %u pairs; it has at most %u and %u", i,
                 guard.count, guard.pair_count, kMaxGuardCurves, kMaxGuardPairs);
  }
  const Status status =
      check_curve_list(desc, {guard.curves, guard.count}, true, "guard", i, error);
  if (status != Status::kOk) return status;
  if (guard.together >> guard.count != 0 || (guard.together & (guard.together << 1 | 1)) != 0) {
    return wrong(
        error,
        "guard %zu: .together %u; a curve goes with the one before, in pairs of the %u curves", i,
        guard.together, guard.count);
  }
  bool finite =
      first_beyond({guard.gains, guard.count}, -kLargestFloat, kLargestFloat) == guard.count;
  for (uint32_t k = 0; k < guard.pair_count; ++k) {
    const GuardPair& pair = guard.pairs[k];
    finite = finite && std::isfinite(pair.gain);
    if (pair.first < guard.count && pair.second < guard.count && pair.first != pair.second)
      continue;
    return wrong(error,
                 "guard %zu: pair %u is of its curves %u and %u; it has %u, and a pair has two", i,
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

Status check_curves(const MixDesc& desc, uint32_t curves, Error& error) {
  if (desc.poses.count > kMaxPoses || desc.guards.count > kMaxGuards) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%zu poses and %zu guards; a mix has at most %u and %u", desc.poses.count,
                desc.guards.count, kMaxPoses, kMaxGuards);
  }
  Status status = Status::kOk;
  for (size_t i = 0; i < desc.poses.count; ++i) {
    const PoseDesc& pose = desc.poses[i];
    if (pose.curves.count != pose.values.count || pose.curves.count > curves) {
      return wrong(error, "pose %zu: %zu curves, %zu values; both must be as many, at most %u", i,
                   pose.curves.count, pose.values.count, curves);
    }
    status = check_curve_list(desc, pose.curves, true, "pose", i, error);
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
    if (pair.a >= curves || pair.b >= curves || pair.a == pair.b) {
      return wrong(error, "antagonists %zu: curves %u and %u; they must be two of %u", i, pair.a,
                   pair.b, curves);
    }
    if (!within(pair.stiffness, 0.0f, 1.0f)) {
      return wrong(error, "antagonists %zu: .stiffness is %g; it must be within 0 ... 1", i,
                   double{pair.stiffness});
    }
  }
  if (desc.gaze) {
    for (const GazeEye& eye : desc.gaze->eyes) {
      for (uint16_t curve : eye.curves) {
        if (curve >= desc.raw_count) {
          return wrong(error, "gaze: control %zu of %u", curve, desc.raw_count);
        }
      }
    }
  }
  if (!desc.mirror.empty() && desc.mirror.count != curves) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "the mirror map has %zu of %u curves",
                desc.mirror.count, curves);
  }
  for (size_t i = 0; i < desc.mirror.count; ++i) {
    if (desc.mirror[i] >= curves || desc.mirror[desc.mirror[i]] != i) {
      return wrong(
          error, "mirror map: curve %zu becomes %u, which does not become it; give curves in pairs",
          i, desc.mirror[i]);
    }
  }
  if (desc.lower.count != desc.upper.count || (!desc.lower.empty() && desc.lower.count != curves)) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "limits of %zu and %zu of %u curves",
                desc.lower.count, desc.upper.count, curves);
  }
  for (size_t i = 0; i < desc.lower.count; ++i) {
    if (!(desc.lower[i] <= desc.upper[i]) || !std::isfinite(desc.lower[i]) ||
        !std::isfinite(desc.upper[i])) {
      return wrong(error, "limits of curve %zu: %g ... %g; they must be finite and in order", i,
                   double{desc.lower[i]}, double{desc.upper[i]});
    }
  }
  return Status::kOk;
}

/// Placer::keep() for a list whose elements refer to other lists: `keep_parts` keeps those.
template <class T, class KeepParts>
void keep(Placer& placer, Span<const T>& list, KeepParts keep_parts) {
  const Span<T> copy = placer.array<T>(list.count);
  for (size_t i = 0; i < list.count; ++i) {
    T item = list[i];
    keep_parts(item);
    if (!placer.measuring()) copy[i] = item;
  }
  if (!placer.measuring()) list = copy;
}

/// The mask, limited to curves for which the source of a layer can have values; other curves stay 0.
void fill_mask(const Mix& mix, const LayerDesc& layer, Span<float> row) {
  const auto fill = [&](size_t curve) {
    row[curve] = layer.mask.empty() ? 1.0f : curve < layer.mask.count ? layer.mask[curve] : 0.0f;
  };
  if (layer.source == LayerSource::kClip) {
    for (uint32_t l = 0; l < mix.raw_count; ++l) fill(l);
  } else if (layer.source == LayerSource::kPoses) {
    for (const PoseDesc& pose : mix.poses.slice(layer.first_pose, layer.pose_count)) {
      for (uint16_t curve : pose.curves) fill(curve);
    }
  } else {
    const Span<const uint16_t> curves = is_gaze(layer) ? mix.gaze_curves : layer.curves;
    for (uint16_t curve : curves) fill(curve);
  }
}

void place_gaze(Placer& placer, Mix& mix) {
  const GazeTable* const table = mix.gaze;
  mix.gaze = nullptr;
  for (const LayerDesc& layer : mix.layers) {
    if (!is_gaze(layer)) continue;
    const Span<GazeTable> copy = placer.array<GazeTable>(1);
    mix.gaze_curves = placer.array<uint16_t>(8 + layer.curves.count - 3);
    if (placer.measuring()) return;
    copy[0] = *table;
    mix.gaze = copy.data;
    for (uint32_t i = 0; i < 8; ++i) mix.gaze_curves[i] = table->eyes[i / 4].curves[i % 4];
    for (size_t i = 3; i < layer.curves.count; ++i) mix.gaze_curves[5 + i] = layer.curves[i];
  }
}

void place_layers(Placer& placer, Mix& mix) {
  mix.mask_rows = placer.array<Span<float>>(mix.layers.count);
  mix.first_fades = placer.array<uint32_t>(mix.layers.count);
  uint32_t i = 0;
  keep(placer, mix.layers, [&](LayerDesc& layer) {
    placer.keep(layer.curves);
    placer.keep(layer.amounts);
    if (layer.source != LayerSource::kPoses) layer.pose_count = 0;
    const Span<float> mask = placer.array<float>(mix.curve_count, kBlockAlignment);
    if (!placer.measuring()) {
      fill_mask(mix, layer, mask);
      if (!layer.mask.empty()) layer.mask = mask.first(mix.used_curves());
      mix.mask_rows[i] = mask;
      mix.first_fades[i] = mix.fade_count;
    }
    mix.fade_count += layer.pose_count;
    ++i;
    if (is_protected(layer.group)) mix.first_unprotected = i;
    if (layer.group != LayerGroup::kLife && layer.flags == 0) mix.first_after_reactions = i;
  });
}

void place_poses(Placer& placer, Mix& mix) {
  mix.pose_rows = placer.array<Span<float>>(mix.poses.count);
  uint32_t i = 0;
  keep(placer, mix.poses, [&](PoseDesc& pose) {
    placer.keep(pose.curves);
    placer.keep(pose.values);
    const uint32_t number = i++;
    if (pose.curves.count * 2 < mix.curve_count) return;
    const Span<float> row = placer.array<float>(mix.curve_count, kBlockAlignment);
    if (placer.measuring()) return;
    for (size_t k = 0; k < pose.curves.count; ++k) row[pose.curves[k]] = pose.values[k];
    mix.pose_rows[number] = row;
  });
}

void place_reactions(Placer& placer, Mix& mix) {
  mix.first_strokes = placer.array<uint32_t>(mix.reactions.count);
  uint32_t i = 0;
  keep(placer, mix.reactions, [&](ReactionDesc& reaction) {
    placer.keep(reaction.strokes);
    if (!placer.measuring()) mix.first_strokes[i++] = mix.stroke_count;
    mix.stroke_count += static_cast<uint32_t>(reaction.strokes.count);
  });
}

/// Whether strokes close what blinks close.
void place_lids(Placer& placer, Mix& mix) {
  mix.closes_lids = placer.array<uint8_t>(mix.stroke_count);
  if (placer.measuring()) return;
  uint64_t blinks[kMaxCurves / 64] = {};
  for (const LayerDesc& layer : mix.layers) {
    if (layer.source != LayerSource::kGenerator || layer.generator != Generator::kBlink) continue;
    for (uint16_t curve : layer.curves) blinks[curve / 64] |= uint64_t{1} << curve % 64;
  }
  uint8_t* out = mix.closes_lids.data;
  for (const ReactionDesc& reaction : mix.reactions) {
    for (const Stroke& stroke : reaction.strokes) {
      const PoseDesc& pose = mix.poses[stroke.pose];
      for (size_t k = 0; k < pose.curves.count; ++k) {
        const bool blinked = (blinks[pose.curves[k] / 64] >> pose.curves[k] % 64 & 1) != 0;
        if (blinked && pose.values[k] > 0.0f) *out = 1;
      }
      ++out;
    }
  }
}

void place_limits(Placer& placer, Mix& mix) {
  mix.lower_row = placer.array<float>(mix.curve_count, kBlockAlignment);
  mix.upper_row = placer.array<float>(mix.curve_count, kBlockAlignment);
  if (placer.measuring()) return;
  const bool limited = !mix.lower.empty();
  for (uint32_t l = 0; l < mix.used_curves(); ++l) {
    mix.lower_row[l] = limited ? mix.lower[l] : -kLargestFloat;
    mix.upper_row[l] = limited ? mix.upper[l] : kLargestFloat;
  }
  if (!limited) return;
  mix.lower = mix.lower_row.first(mix.used_curves());
  mix.upper = mix.upper_row.first(mix.used_curves());
}

void place_mix(Placer& placer, const MixDesc& desc, Mix& mix) {
  static_cast<MixDesc&>(mix) = desc;
  mix.curve_count = static_cast<uint32_t>(align_up(mix.used_curves(), kRowStep));
  place_gaze(placer, mix);
  place_poses(placer, mix);
  place_layers(placer, mix);  // their masks depend on gaze and poses
  place_reactions(placer, mix);
  place_lids(placer, mix);
  if (!mix.kernels) mix.kernels = kernels_for(Isa::kBest);
  placer.keep(mix.guards);
  place_guards(placer, mix.guards, mix.kernels, mix.guard_table);
  place_limits(placer, mix);
  placer.keep(mix.antagonists);
  placer.keep(mix.mirror);
  placer.keep(mix.names.first);
  placer.keep(mix.names.chars);
  mix.names.sorted = {};
}

/// FNV-1a
uint64_t hash_numbers(uint64_t hash, std::initializer_list<uint64_t> numbers) {
  for (uint64_t number : numbers) {
    for (int i = 0; i < 8; ++i) hash = (hash ^ (number >> 8 * i & 0xFF)) * 0x100000001B3u;
  }
  return hash;
}

uint64_t fingerprint(const Mix& mix) {
  uint64_t hash = hash_numbers(
      0xCBF29CE484222325u, {mix.raw_count, mix.variable_count, mix.player_count, mix.guards.count,
                            mix.guard_table.curves.count, mix.layers.count, mix.reactions.count,
                            mix.stroke_count, mix.gaze != nullptr});
  for (const LayerDesc& layer : mix.layers) {
    hash = hash_numbers(hash, {static_cast<uint64_t>(layer.mode),
                               static_cast<uint64_t>(layer.source), layer.pose_count});
  }
  return hash;
}

}  // namespace

Status create_mix(const MixDesc& desc, const Allocator& allocator, Mix*& out, Error& error) {
  out = nullptr;
  if (desc.raw_count > kMaxCurves || desc.variable_count > kMaxCurves - desc.raw_count) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%u raw controls and %u pose variables; a row has at most %u curves",
                desc.raw_count, desc.variable_count, kMaxCurves);
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
  const uint32_t curves = desc.raw_count + desc.variable_count;
  Status status = check_curves(desc, curves, error);
  if (status == Status::kOk) status = check_layers(desc, curves, error);
  if (status == Status::kOk) status = check_reactions(desc, error);
  if (status != Status::kOk) return status;

  const auto place = [&](Placer& placer, Mix& mix) { place_mix(placer, desc, mix); };
  out = create_object<Mix>(allocator, place);
  if (!out) {
    return fail(error, Status::kMemory, kNoOffset, "no memory for a mix: %zu bytes",
                block_bytes<Mix>(place));
  }
  out->fingerprint = fingerprint(*out);
  return Status::kOk;
}

}  // namespace mien
