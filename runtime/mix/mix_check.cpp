// SPDX-License-Identifier: MIT
#include "runtime/mix/mix_check.h"

#include <cmath>
#include <cstdio>

#include "runtime/mix/mix_fields.h"

namespace mien {
namespace {

/// "layer 3", or "reaction 0, stroke 2": the element that a message is about.
struct Place {
  char text[80];

  Place(const char* element, size_t index) {
    snprintf(text, sizeof(text), "%s %zu", element, index);
  }
  Place(const char* element, size_t index, const char* part, size_t part_index) {
    snprintf(text, sizeof(text), "%s %zu, %s %zu", element, index, part, part_index);
  }
  explicit Place(const char* whole) { snprintf(text, sizeof(text), "%s", whole); }
};

template <class... Values>
Status wrong(Error& error, const char* format, Values... values) {
  return fail(error, Status::kInvalidArgument, kNoOffset, format, values...);
}

/// The first element that is not within the limits; the number of elements if all are.
size_t first_beyond(Span<const float> values, float low, float high) {
  size_t i = 0;
  while (i < values.count && values[i] >= low && values[i] <= high) ++i;
  return i;
}

/// Refuses the first curve that does not exist, or is there twice where each has one value.
Status check_curve_list(const MixDesc& desc, Span<const uint16_t> list, bool once,
                        const Place& place, Error& error) {
  const uint32_t curves = desc.raw_count + desc.variable_count;
  uint64_t seen[kMaxCurves / 64] = {};
  for (size_t i = 0; i < list.count; ++i) {
    const uint16_t curve = list[i];
    if (curve >= curves) {
      return wrong(error, "%s: .curves[%zu] is %u; curves are below %u", place.text, i, curve,
                   curves);
    }
    uint64_t& word = seen[curve / 64];
    const uint64_t bit = uint64_t{1} << curve % 64;
    if (once && (word & bit) != 0) {
      const bool named = curve < desc.names.count();
      const Span<const char> name = named ? desc.names[curve] : Span<char>{};
      return wrong(error, "%s: .curves[%zu] is %u%s%.*s, which it lists twice", place.text, i,
                   curve, named ? ", " : "", static_cast<int>(name.count),
                   name.data ? name.data : "");
    }
    word |= bit;
  }
  return Status::kOk;
}

/// Checks each field of an element by its limits; `status` is that of the first that is wrong.
struct FieldCheck : SkipsLists {
  const MixDesc& desc;
  const Place& at;
  Error& error;
  bool curves_once;  // each curve of a list has one value
  Status status = Status::kOk;

  FieldCheck(const MixDesc& of, const Place& place_of, Error& out, bool once)
      : desc(of), at(place_of), error(out), curves_once(once) {}

  uint32_t curve_count() const { return desc.raw_count + desc.variable_count; }
  template <class... Values>
  void refuse(const char* format, Values... values) {
    if (status == Status::kOk) status = wrong(error, format, at.text, values...);
  }
  static bool within(const Limits& limits, double value) {
    return value >= limits.low && value <= limits.high;
  }

  void value(Field field, const Limits& limits, float number) {
    if (within(limits, double{number})) return;
    refuse("%s: .%s is %g; it must be within %g ... %g", field.name, double{number}, limits.low,
           limits.high);
  }
  void value(Field field, const Limits& limits, int64_t ticks) {
    if (within(limits, static_cast<double>(ticks))) return;
    refuse("%s: .%s is %lld; times are %.0f ... 2^40 ticks (26 minutes)", field.name,
           static_cast<long long>(ticks), limits.low);
  }
  void value(Field field, const Limits& limits, uint32_t number) {
    if (within(limits, number)) return;
    refuse("%s: .%s is %u; it must be within %.0f ... %.0f", field.name, number, limits.low,
           limits.high);
  }
  void value(Field, const Limits&, bool) {}
  void value(Field field, const Limits&, uint16_t curve) {
    if (curve < curve_count()) return;
    refuse("%s: .%s is %u; curves are below %u", field.name, curve, curve_count());
  }
  template <class T, size_t N>
  void choice(Field field, const char* const (&)[N], T number) {
    if (static_cast<size_t>(number) < N) return;
    refuse("%s: .%s is none of its values, 0 ... %zu", field.name, N - 1);
  }
  void mask(Field field, Span<const float> values) {
    const size_t beyond = first_beyond(values, 0.0f, 1.0f);
    if (values.count > curve_count()) {
      refuse("%s: .%s has %zu curves; the mix has %u", field.name, values.count, curve_count());
    } else if (beyond != values.count) {
      refuse("%s: .%s[%zu] is %g; it must be within 0 ... 1", field.name, beyond,
             double{values[beyond]});
    }
  }
  void curves(Field, Span<const uint16_t> list) {
    if (list.count > curve_count()) {
      refuse("%s: %zu curves; the mix has %u", list.count, curve_count());
    } else if (status == Status::kOk) {
      status = check_curve_list(desc, list, curves_once, at, error);
    }
  }
  void pairs(Field field, Span<const uint16_t> list, Span<const float> values) {
    if (list.count != values.count) {
      return refuse("%s: %zu .curves, %zu .%ss; both must be as many", list.count, values.count,
                    field.name);
    }
    curves(field, list);
    const size_t beyond = first_beyond(values, -kLargestFloat, kLargestFloat);
    if (beyond == values.count) return;
    refuse("%s: .%ss[%zu] is %g; it must be finite", field.name, beyond, double{values[beyond]});
  }
  void count(Field field, uint32_t number, uint32_t most) {
    value(field, Limits{0, double(most)}, number);
  }
  void pair(Field field, uint16_t curve, float number) {
    value(field, kAnyValue, curve);
    value(field, Limits{-double{kLargestFloat}, double{kLargestFloat}}, number);
  }
  void place(Field, uint16_t) {}
};

template <class Element>
Status check_fields(const MixDesc& desc, const Place& place, Element element, Error& error,
                    bool curves_once = false) {
  FieldCheck check(desc, place, error, curves_once);
  visit_fields(check, element);
  return check.status;
}

Status check_layer(const MixDesc& desc, const LayerDesc& layer, const Place& place, Error& error) {
  const Status status = check_fields(desc, place, layer, error);
  if (status != Status::kOk) return status;
  if (layer.after_guards != 0 && is_protected(layer.group)) {
    return wrong(error,
                 "%s: .after_guards; not in the groups base and speech, which guards protect",
                 place.text);
  }
  if (layer.mode != BlendMode::kAdd && layer.weight < 0.0f) {
    return wrong(error, "%s: .weight is %g; it must be within 0 ... 1", place.text,
                 double{layer.weight});
  }
  const size_t poses = desc.poses.count;
  if (layer.source == LayerSource::kPoses &&
      (layer.first_pose > poses || layer.pose_count > poses - layer.first_pose)) {
    return wrong(error, "%s: %u poses from %u on; the mix has %zu", place.text, layer.pose_count,
                 layer.first_pose, poses);
  }
  const size_t curves = layer.curves.count;
  if (!is_gaze(layer) || (desc.gaze && (curves == 3 || curves == 5))) return Status::kOk;
  return wrong(error, "%s: a gaze takes 3 or 5 curves, not %zu, and the gaze of the mix",
               place.text, curves);
}

Status check_layers(const MixDesc& desc, Error& error) {
  uint32_t gazes = 0;
  for (size_t i = 0; i < desc.layers.count; ++i) {
    const Place place("layer", i);
    const Status status = check_layer(desc, desc.layers[i], place, error);
    if (status != Status::kOk) return status;
    if (is_gaze(desc.layers[i]) && ++gazes > 1) {
      return wrong(error, "%s: a second gaze; a mix has one such layer at most", place.text);
    }
  }
  const uint32_t clips = clip_layer_count(desc);
  if (desc.player_count >= clips) return Status::kOk;
  return wrong(error, "%u players; each of the %u layers of clips needs one", desc.player_count,
               clips);
}

Status check_reactions(const MixDesc& desc, Error& error) {
  for (size_t i = 0; i < desc.reactions.count; ++i) {
    const ReactionDesc& reaction = desc.reactions[i];
    const Place place("reaction", i);
    if (reaction.strokes.count > kMaxStrokes) {
      return wrong(error, "%s: %zu strokes; it has at most %u", place.text, reaction.strokes.count,
                   kMaxStrokes);
    }
    Status status = check_fields(desc, place, reaction, error);
    if (status != Status::kOk) return status;
    if (reaction.level_off > reaction.level_on) {
      return wrong(error, "%s: .level_off is %g; it is at most .level_on, %g", place.text,
                   double{reaction.level_off}, double{reaction.level_on});
    }
    for (size_t s = 0; s < reaction.strokes.count; ++s) {
      const Place stroke_place("reaction", i, "stroke", s);
      status = check_fields(desc, stroke_place, reaction.strokes[s], error);
      if (status != Status::kOk) return status;
      if (reaction.strokes[s].pose >= desc.poses.count) {
        return wrong(error, "%s: .pose is %u; the mix has %zu poses", stroke_place.text,
                     reaction.strokes[s].pose, desc.poses.count);
      }
    }
  }
  return Status::kOk;
}

Status check_guard(const MixDesc& desc, const Guard& guard, const Place& place, Error& error) {
  if (guard.count > kMaxGuardCurves || guard.pair_count > kMaxGuardPairs) {
    return wrong(error, "%s: %u curves and %u pairs; it has at most %u and %u", place.text,
                 guard.count, guard.pair_count, kMaxGuardCurves, kMaxGuardPairs);
  }
  Status status = check_curve_list(desc, {guard.curves, guard.count}, true, place, error);
  if (status == Status::kOk) status = check_fields(desc, place, guard, error);
  if (status != Status::kOk) return status;
  if (!(guard.f_on > 0.0f)) return wrong(error, "%s: .f_on must be above 0", place.text);
  if (guard.together >> guard.count != 0 || (guard.together & (guard.together << 1 | 1)) != 0) {
    return wrong(error,
                 "%s: .together %u; a curve goes with the one before, in pairs of the %u curves",
                 place.text, guard.together, guard.count);
  }
  for (uint32_t k = 0; k < guard.pair_count; ++k) {
    const GuardPair& pair = guard.pairs[k];
    if (pair.first < guard.count && pair.second < guard.count && pair.first != pair.second)
      continue;
    return wrong(error, "%s: pair %u is of its curves %u and %u; it has %u, and a pair has two",
                 place.text, k, pair.first, pair.second, guard.count);
  }
  return Status::kOk;
}

Status check_rows(const MixDesc& desc, size_t curves, Error& error) {
  if (!desc.mirror.empty() && desc.mirror.count != curves) {
    return wrong(error, "the mirror map has %zu of %zu curves", desc.mirror.count, curves);
  }
  for (size_t i = 0; i < desc.mirror.count; ++i) {
    if (desc.mirror[i] >= curves || desc.mirror[desc.mirror[i]] != i) {
      return wrong(
          error, "mirror map: curve %zu becomes %u, which does not become it; give curves in pairs",
          i, desc.mirror[i]);
    }
  }
  if (desc.lower.count != desc.upper.count || (!desc.lower.empty() && desc.lower.count != curves)) {
    return wrong(error, "limits of %zu and %zu of %zu curves", desc.lower.count, desc.upper.count,
                 curves);
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

Status check_counts(const MixDesc& desc, Error& error) {
  if (desc.raw_count > kMaxCurves || desc.variable_count > kMaxCurves - desc.raw_count) {
    return wrong(error, "%u raw controls and a .variable_count of %u; a row has at most %u curves",
                 desc.raw_count, desc.variable_count, kMaxCurves);
  }
  if (desc.max_bound_gui > kMaxClipChannels) {
    return wrong(error, "%u GUI controls; clips have at most %u channels", desc.max_bound_gui,
                 kMaxClipChannels);
  }
  const struct {
    const char* name;
    size_t count, most;
  } lists[] = {{"layers", desc.layers.count, kMaxLayers},
               {"poses", desc.poses.count, kMaxPoses},
               {"reactions", desc.reactions.count, kMaxReactions},
               {"guards", desc.guards.count, kMaxGuards},
               {"pairs of antagonists", desc.antagonists.count, kMaxCurves}};
  for (const auto& list : lists) {
    if (list.count <= list.most) continue;
    return wrong(error, "%zu %s; a mix has at most %zu", list.count, list.name, list.most);
  }
  return Status::kOk;
}

}  // namespace

Status check_mix(const MixDesc& desc, Error& error) {
  Status status = check_counts(desc, error);
  if (status == Status::kOk) status = check_fields(desc, Place("the mix"), desc, error);
  for (size_t i = 0; i < desc.poses.count && status == Status::kOk; ++i) {
    status = check_fields(desc, Place("pose", i), desc.poses[i], error, true);
  }
  for (size_t i = 0; i < desc.guards.count && status == Status::kOk; ++i) {
    status = check_guard(desc, desc.guards[i], Place("guard", i), error);
  }
  for (size_t i = 0; i < desc.antagonists.count && status == Status::kOk; ++i) {
    const Place place("antagonists", i);
    const AntagonistPair& pair = desc.antagonists[i];
    status = check_fields(desc, place, pair, error);
    if (status == Status::kOk && pair.first == pair.second) {
      status = wrong(error, "%s: .first and .second are both %u", place.text, pair.first);
    }
  }
  if (status != Status::kOk) return status;
  if (desc.gaze) {
    for (const GazeEye& eye : desc.gaze->eyes) {
      for (uint16_t curve : eye.curves) {
        if (curve < desc.raw_count) continue;
        return wrong(error, "gaze: control %u of %u", curve, desc.raw_count);
      }
    }
  }
  status = check_rows(desc, size_t{desc.raw_count} + desc.variable_count, error);
  if (status == Status::kOk) status = check_layers(desc, error);
  if (status == Status::kOk) status = check_reactions(desc, error);
  return status;
}

}  // namespace mien
