// SPDX-License-Identifier: MIT
#include "runtime/mix/mix.h"

#include <algorithm>

#include "runtime/base/arena.h"
#include "runtime/mix/mix_check.h"
#include "runtime/mix/mix_fields.h"

namespace mien {
namespace {

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

/// Copies the lists of a mix.
struct MixCopy : SkipsLists {
  Placer& placer;

  explicit MixCopy(Placer& to) : placer(to) {}
  template <class... Parts>
  void value(Parts&&...) {}
  template <class... Parts>
  void choice(Parts&&...) {}
  template <class... Parts>
  void count(Parts&&...) {}
  template <class... Parts>
  void pair(Parts&&...) {}
  template <class... Parts>
  void place(Parts&&...) {}

  void curves(Field, Span<const uint16_t>& list) { placer.keep(list); }
  void pairs(Field, Span<const uint16_t>& list, Span<const float>& values) {
    placer.keep(list);
    placer.keep(values);
  }
  template <class T, class Otherwise>
  void row(Field, Span<const T>& numbers, Otherwise) {
    placer.keep(numbers);
  }
  template <class T, class Fields>
  void list(Field, Span<const T>& items, uint32_t, Fields fields) {
    mien::keep(placer, items, fields);
  }
  void keep(const GazeTable& gaze, const GazeTable*& to) {
    const Span<GazeTable> copy = placer.array<GazeTable>(1);
    if (placer.measuring()) return;
    copy[0] = gaze;
    to = copy.data;
  }
};

/// After the copy.
void place_gaze(Placer& placer, Mix& mix) {
  for (const LayerDesc& layer : mix.layers) {
    if (!is_gaze(layer)) continue;
    mix.gaze_curves = placer.array<uint16_t>(8 + layer.curves.count - 3);
    if (placer.measuring()) return;
    for (uint32_t i = 0; i < 8; ++i) mix.gaze_curves[i] = mix.gaze->eyes[i / 4].curves[i % 4];
    for (size_t i = 3; i < layer.curves.count; ++i) mix.gaze_curves[5 + i] = layer.curves[i];
  }
}

void place_layers(Placer& placer, Mix& mix) {
  mix.mask_rows = placer.array<Span<float>>(mix.layers.count);
  mix.first_fades = placer.array<uint32_t>(mix.layers.count);
  for (uint32_t i = 0; i < mix.layers.count; ++i) {
    const Span<float> mask = placer.array<float>(mix.curve_count, kBlockAlignment);
    if (placer.measuring()) continue;
    auto& layer = const_cast<LayerDesc&>(mix.layers[i]);  // the copy
    if (layer.source != LayerSource::kPoses) layer.pose_count = 0;
    fill_mask(mix, layer, mask);
    if (!layer.mask.empty()) layer.mask = mask.first(mix.used_curves());
    mix.mask_rows[i] = mask;
    mix.first_fades[i] = mix.fade_count;
    mix.fade_count += layer.pose_count;
    if (is_protected(layer.group)) mix.first_unprotected = i + 1;
    if (layer.group != LayerGroup::kLife && layer.after_guards == 0) {
      mix.first_after_reactions = i + 1;
    }
  }
}

void place_poses(Placer& placer, Mix& mix) {
  mix.pose_rows = placer.array<Span<float>>(mix.poses.count);
  for (uint32_t i = 0; i < mix.poses.count; ++i) {
    const PoseDesc& pose = mix.poses[i];
    if (pose.curves.count * 2 < mix.curve_count) continue;
    const Span<float> row = placer.array<float>(mix.curve_count, kBlockAlignment);
    if (placer.measuring()) continue;
    for (size_t k = 0; k < pose.curves.count; ++k) row[pose.curves[k]] = pose.values[k];
    mix.pose_rows[i] = row;
  }
}

void place_reactions(Placer& placer, Mix& mix) {
  mix.first_strokes = placer.array<uint32_t>(mix.reactions.count);
  for (uint32_t i = 0; i < mix.reactions.count; ++i) {
    if (!placer.measuring()) mix.first_strokes[i] = mix.stroke_count;
    mix.stroke_count += static_cast<uint32_t>(mix.reactions[i].strokes.count);
  }
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
}

void place_mix(Placer& placer, const MixDesc& desc, Mix& mix) {
  static_cast<MixDesc&>(mix) = desc;
  mix.curve_count = static_cast<uint32_t>(align_up(mix.used_curves(), kRowStep));
  if (std::none_of(mix.layers.begin(), mix.layers.end(), is_gaze)) mix.gaze = nullptr;
  MixCopy copy(placer);
  visit_mix(copy, mix);
  place_gaze(placer, mix);
  place_poses(placer, mix);
  place_layers(placer, mix);  // their masks depend on gaze and poses
  place_reactions(placer, mix);
  place_lids(placer, mix);
  if (!mix.kernels) mix.kernels = kernels_for(Isa::kBest);
  place_guards(placer, mix.guards, mix.kernels, mix.guard_table);
  place_limits(placer, mix);
  placer.keep(mix.names.first);
  placer.keep(mix.names.chars);
  mix.names.sorted = {};
}

/// FNV-1a of the fields that the state of mixers depends on.
struct Fingerprint : SkipsLists {
  uint64_t hash = 0xCBF29CE484222325u;

  void add(uint64_t number) {
    for (int i = 0; i < 8; ++i) hash = (hash ^ (number >> 8 * i & 0xFF)) * 0x100000001B3u;
  }
  template <class T>
  void value(Field field, const Limits&, T number) {
    if (field.in_fingerprint) add(static_cast<uint64_t>(number));
  }
  template <class T, class Names>
  void choice(Field field, const Names&, T number) {
    value(field, kAnyValue, number);
  }
};

uint64_t fingerprint(const Mix& mix) {
  Fingerprint print;
  MixDesc desc = mix;
  print.add(desc.raw_count);
  visit_fields(print, desc);
  for (uint64_t count : {uint64_t{mix.guards.count}, uint64_t{mix.guard_table.curves.count},
                         uint64_t{mix.layers.count}, uint64_t{mix.reactions.count},
                         uint64_t{mix.stroke_count}, uint64_t{mix.gaze != nullptr}}) {
    print.add(count);
  }
  for (LayerDesc layer : mix.layers) {
    visit_fields(print, layer);
    if (layer.source != LayerSource::kPoses) print.add(0);  // its number of poses
  }
  return print.hash;
}

}  // namespace

uint32_t clip_layer_count(const MixDesc& desc) {
  return static_cast<uint32_t>(
      std::count_if(desc.layers.begin(), desc.layers.end(),
                    [](const LayerDesc& layer) { return layer.source == LayerSource::kClip; }));
}

void set_default_sizes(MixDesc& desc) {
  if (desc.player_count == 0) desc.player_count = 2 * clip_layer_count(desc);
  if (desc.max_channels == 0) desc.max_channels = desc.raw_count;
  if (desc.max_changing_channels == 0) {
    desc.max_changing_channels = std::min(desc.max_channels, kMaxChangingChannels);
  }
}

Status create_mix(const MixDesc& desc, const Allocator& allocator, Mix*& out, Error& error) {
  out = nullptr;
  const Status status = check_mix(desc, error);
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
