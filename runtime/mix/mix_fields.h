// SPDX-License-Identifier: MIT
// The fields of a mix, each described once, under the name that it has in mien.h:
//
//     v.value("adapted", Limits{0, 1}, reaction.adapted, c.adapted...);
//
// Visitors call such a list for a struct. They check it (mix_check.cpp), copy and hash it (mix.cpp), read and
// write it (mix_reader.cpp, mix_writer.cpp), and fill it from the caller's struct of mien.h (capi/mix.cpp).
// Only the last kind passes a second struct, `c`, whose members have the same names; in all other calls `c`
// is empty. A new number of a layer takes a member in mix.h, a member in mien.h and a line here, and changes
// kMixVersion, because files have it too.
#pragma once

#include <cmath>

#include "runtime/anim/clip.h"
#include "runtime/mix/fade.h"
#include "runtime/mix/mix.h"
#include "runtime/mix/stream.h"

namespace mien {

constexpr uint32_t kMixVersion = 3;
constexpr size_t kMixHeaderSize = 24;  // the offsets are those of ClipHeaderOffset
constexpr size_t kMaxNameLength = 0xFFFF;

constexpr const char* kGroups[] = {"base", "speech", "emotion", "reaction", "life"};
constexpr const char* kModes[] = {"override", "add", "screen", "max", "scale"};
constexpr const char* kSources[] = {"clip", "poses", "stream", "generator"};
constexpr const char* kGeneratorNames[] = {"blink", "breath", "noise", "gaze"};
constexpr const char* kRetriggers[] = {"extend", "restart", "ignore"};

struct Field {
  const char* name;
  bool in_fingerprint;  // the state of mixers depends on it: Mix::fingerprint

  constexpr Field(const char* n, bool depends = false) : name(n), in_fingerprint(depends) {}
};
constexpr Field in_fingerprint(const char* name) { return {name, true}; }

/// The values that a field may have. What depends on other fields is checked by check_mix().
struct Limits {
  double low, high;
  uint32_t default_value = 0;  // what 0 in a struct of a caller means
};
constexpr Limits kAnyValue = {-HUGE_VAL, HUGE_VAL};  // but not NaN
constexpr Limits kTimes = {0, double{kMaxFadeTicks}};

// Fields, in the order of the file ----------------------------------------------------------------

// A visitor has these functions; those that skip lists are in SkipsLists:
//     value   a number; uint16_t is a curve
//     choice  an enum, with the names of its values
//     pairs   curves with a float each
//     curves  a list of curves
//     mask    a number from 0 to 1 for each curve, or none, which is 1 for all
//     row     a number for each curve, or none; and a function for the curves that the file does not have
//     list    elements, each of which is visited
//     names   of the raw controls

struct SkipsLists {
  template <class... Parts>
  void pairs(Parts&&...) {}
  template <class... Parts>
  void curves(Parts&&...) {}
  template <class... Parts>
  void mask(Parts&&...) {}
  template <class... Parts>
  void list(Parts&&...) {}
  template <class... Parts>
  void names(Parts&&...) {}
};

template <class Visitor, class... Caller>
void visit_fields(Visitor& v, LayerDesc& layer, Caller&... c) {
  v.choice("group", kGroups, layer.group, c.group...);
  v.choice(in_fingerprint("mode"), kModes, layer.mode, c.mode...);
  v.choice(in_fingerprint("source"), kSources, layer.source, c.source...);
  v.value("after_guards", Limits{0, 1}, layer.after_guards, c.after_guards...);
  v.value("weight", Limits{-1, 1}, layer.weight, c.weight...);
  v.mask("mask", layer.mask);
  if (layer.source == LayerSource::kPoses) {
    v.value("first_pose", Limits{0, kMaxPoses}, layer.first_pose, c.first_pose...);
    v.value(in_fingerprint("pose_count"), Limits{0, kMaxPoses}, layer.pose_count, c.pose_count...);
  } else if (layer.source == LayerSource::kStream) {
    v.value("delay", kTimes, layer.delay, c.delay...);
    v.value("stream_frames", Limits{2, kMaxStreamFrames, 64}, layer.stream_frames,
            c.stream_frames...);
    v.curves("curve", layer.curves);
  } else if (layer.source == LayerSource::kGenerator) {
    v.choice("generator", kGeneratorNames, layer.generator, c.generator...);
    v.value("period", Limits{1, double{kMaxFadeTicks}}, layer.period, c.period...);
    v.pairs("amount", layer.curves, layer.amounts);
  }
}

template <class Visitor>
void visit_fields(Visitor& v, PoseDesc& pose) {
  v.pairs("value", pose.curves, pose.values);
}

template <class Visitor, class... Caller>
void visit_fields(Visitor& v, Stroke& stroke, Caller&... c) {
  v.value("pose", Limits{0, kMaxPoses - 1}, stroke.pose, c.pose...);
  v.choice("mode", kModes, stroke.mode, c.mode...);
  v.value("is_held", kAnyValue, stroke.is_held, c.is_held...);
  v.value("is_lag", kAnyValue, stroke.is_lag, c.is_lag...);
  v.value("is_scaled", kAnyValue, stroke.is_scaled, c.is_scaled...);
  v.value("delay", kTimes, stroke.delay, c.delay...);
  v.value("attack", kTimes, stroke.attack, c.attack...);
  v.value("hold", kTimes, stroke.hold, c.hold...);
  v.value("release", kTimes, stroke.release, c.release...);
}

template <class Visitor, class... Caller>
void visit_fields(Visitor& v, ReactionDesc& reaction, Caller&... c) {
  v.choice("retrigger", kRetriggers, reaction.retrigger, c.retrigger...);
  v.value("after_guards", kAnyValue, reaction.after_guards, c.after_guards...);
  v.value("cooldown", kTimes, reaction.cooldown, c.cooldown...);
  v.value("adapted", Limits{0, 1}, reaction.adapted, c.adapted...);
  v.value("adapt_ticks", kTimes, reaction.adapt_ticks, c.adapt_ticks...);
  v.value("recover_ticks", kTimes, reaction.recover_ticks, c.recover_ticks...);
  v.value("level_on", Limits{0, 1}, reaction.level_on, c.level_on...);
  v.value("level_off", Limits{0, 1}, reaction.level_off, c.level_off...);
  v.list("strokes", reaction.strokes, kMaxStrokes, [&v](auto& stroke) { visit_fields(v, stroke); });
}

template <class Visitor, class... Caller>
void visit_fields(Visitor& v, AntagonistPair& pair, Caller&... c) {
  v.value("first", kAnyValue, pair.first, c.first...);
  v.value("second", kAnyValue, pair.second, c.second...);
  v.value("stiffness", Limits{0, 1}, pair.stiffness, c.stiffness...);
}

/// Measured on a rig, so that callers have no such struct.
template <class Visitor>
void visit_fields(Visitor& v, Guard& guard) {
  const Limits finite = {-double{kLargestFloat}, double{kLargestFloat}};
  v.value("kind", kAnyValue, guard.kind);
  v.value("needs_speech", kAnyValue, guard.needs_speech);
  v.value("rest", finite, guard.rest);
  v.value("f_on", Limits{0, double{kLargestFloat}}, guard.f_on);
  v.value("tolerance", Limits{0, double{kLargestFloat}}, guard.tolerance);
  v.value("fit_error", kAnyValue, guard.fit_error);
  v.count("curves", guard.count, kMaxGuardCurves);
  for (uint32_t i = 0; i < guard.count; ++i) v.pair("gain", guard.curves[i], guard.gains[i]);
  v.value("together", kAnyValue, guard.together);
  v.count("pairs", guard.pair_count, kMaxGuardPairs);
  for (uint32_t i = 0; i < guard.pair_count; ++i) {
    v.place("first", guard.pairs[i].first);
    v.place("second", guard.pairs[i].second);
    v.value("gain", finite, guard.pairs[i].gain);
  }
}

template <class Visitor>
void visit_fields(Visitor& v, GazeTable& gaze) {
  v.value("gaze.yaw_first", kAnyValue, gaze.yaw_first);
  v.value("gaze.fit_error", kAnyValue, gaze.fit_error);
  for (GazeEye& eye : gaze.eyes) {
    for (float& place : eye.center) v.value("gaze.center", kAnyValue, place);
    for (uint32_t d = 0; d < 4; ++d) {
      v.value("gaze.curve", kAnyValue, eye.curves[d]);
      for (float& tangent : eye.tangents[d]) v.value("gaze.tangent", kAnyValue, tangent);
    }
  }
}

/// The numbers of the mix itself.
template <class Visitor, class... Caller>
void visit_fields(Visitor& v, MixDesc& mix, Caller&... c) {
  const Limits channels = {0, kMaxClipChannels};
  v.value(in_fingerprint("variable_count"), Limits{0, kMaxCurves}, mix.variable_count,
          c.variable_count...);
  v.names("control", mix.variable_count);
  v.value(in_fingerprint("player_count"), Limits{0, 4 * kMaxLayers}, mix.player_count,
          c.player_count...);
  v.value("max_channels", channels, mix.max_channels, c.max_channels...);
  v.value("max_changing_channels", Limits{0, kMaxChangingChannels}, mix.max_changing_channels,
          c.max_changing_channels...);
  v.value("max_events", Limits{0, kMaxClipChannels, 64}, mix.max_events, c.max_events...);
  v.value("reverse", kAnyValue, mix.reverse, c.reverse...);
}

/// All of it.
template <class Visitor>
void visit_mix(Visitor& v, MixDesc& mix) {
  const auto fields = [&v](auto& element) { visit_fields(v, element); };
  visit_fields(v, mix);
  v.list("layers", mix.layers, kMaxLayers, fields);
  v.list("poses", mix.poses, kMaxPoses, fields);
  v.list("reactions", mix.reactions, kMaxReactions, fields);
  v.list("guards", mix.guards, kMaxGuards, fields);
  bool has_gaze = mix.gaze != nullptr;
  v.value("has_gaze", kAnyValue, has_gaze);
  if (has_gaze) {
    GazeTable gaze = mix.gaze ? *mix.gaze : GazeTable{};
    visit_fields(v, gaze);
    v.keep(gaze, mix.gaze);
  }
  v.list("antagonists", mix.antagonists, kMaxCurves, fields);
  v.row("mirror", mix.mirror, [](size_t curve) { return static_cast<uint16_t>(curve); });
  v.row("lower", mix.lower, [](size_t) { return -kLargestFloat; });
  v.row("upper", mix.upper, [](size_t) { return kLargestFloat; });
}

// Curves of the file -------------------------------------------------------------------------------

/// Maps the curves of a mix to those of its file, | controls by name | pose variables |, and back.
struct CurveMap {
  Span<uint16_t> curve_of;       // [curve of the file]
  Span<uint16_t> file_curve_of;  // [curve of the mix]
  uint32_t name_count = 0;
};
constexpr uint16_t kNowhere = 0xFFFF;

}  // namespace mien
