// SPDX-License-Identifier: MIT
// The fields of a mix, listed once for the reader and the writers of its file (mix_file.h).
#pragma once

#include "runtime/anim/clip.h"
#include "runtime/mix/mix.h"

namespace mien {

constexpr uint32_t kMixVersion = 3;
constexpr size_t kMixHeaderSize = 24;  // the offsets are those of ClipHeaderOffset
constexpr size_t kMaxNameLength = 0xFFFF;

constexpr const char* kGroups[] = {"base", "speech", "emotion", "reaction", "life"};
constexpr const char* kModes[] = {"override", "add", "screen", "max", "scale"};
constexpr const char* kSources[] = {"clip", "poses", "stream", "generator"};
constexpr const char* kGeneratorNames[] = {"blink", "breath", "noise", "gaze"};
constexpr const char* kRetriggers[] = {"extend", "restart", "ignore"};

// Fields ------------------------------------------------------------------------------------------

/// Visits the fields of a mix in the order of the file. A walker has these functions:
///     value   a number; uint16_t is a curve
///     choice  an enum, with the names of its values
///     pairs   curves with a float each
///     curves   a list of curves
///     row     a number for each curve, or none; and a function for the curves that the file does not have
///     list    elements, each of which is walked
template <class Walker>
void walk(Walker& w, MixDesc& mix) {
  w.value("variables", mix.variable_count);
  w.names("control", mix.variable_count);
  w.value("players", mix.player_count);
  w.value("max_channels", mix.max_channels);
  w.value("max_changing_channels", mix.max_changing_channels);
  w.value("max_events", mix.max_events);
  w.value("plays_backward", mix.plays_backward);
  w.list("layers", mix.layers, kMaxLayers, [&w](LayerDesc& layer) {
    w.choice("group", layer.group, kGroups);
    w.choice("mode", layer.mode, kModes);
    w.choice("source", layer.source, kSources);
    w.value("flags", layer.flags);
    w.value("weight", layer.weight);
    w.row("mask", layer.mask, [](size_t) { return 0.0f; });
    if (layer.source == LayerSource::kPoses) {
      w.value("first_pose", layer.first_pose);
      w.value("pose_count", layer.pose_count);
    } else if (layer.source == LayerSource::kStream) {
      w.value("delay", layer.delay);
      w.value("stream_frames", layer.stream_frames);
      w.curves("curve", layer.curves);
    } else if (layer.source == LayerSource::kGenerator) {
      w.choice("generator", layer.generator, kGeneratorNames);
      w.value("period", layer.period);
      w.pairs("amount", layer.curves, layer.amounts);
    }
  });
  w.list("poses", mix.poses, kMaxPoses,
         [&w](PoseDesc& pose) { w.pairs("value", pose.curves, pose.values); });
  w.list("reactions", mix.reactions, kMaxReactions, [&w](ReactionDesc& reaction) {
    w.choice("retrigger", reaction.retrigger, kRetriggers);
    w.value("after_guards", reaction.after_guards);
    w.value("cooldown", reaction.cooldown);
    w.value("adapted", reaction.adapted);
    w.value("adapt_ticks", reaction.adapt_ticks);
    w.value("recover_ticks", reaction.recover_ticks);
    w.value("level_on", reaction.level_on);
    w.value("level_off", reaction.level_off);
    w.list("strokes", reaction.strokes, kMaxStrokes, [&w](Stroke& stroke) {
      w.value("pose", stroke.pose);
      w.choice("mode", stroke.mode, kModes);
      w.value("held", stroke.held);
      w.value("lags", stroke.lags);
      w.value("scaled", stroke.scaled);
      w.value("delay", stroke.delay);
      w.value("attack", stroke.attack);
      w.value("hold", stroke.hold);
      w.value("release", stroke.release);
    });
  });
  w.list("guards", mix.guards, kMaxGuards, [&w](Guard& guard) {
    w.value("kind", guard.kind);
    w.value("needs_speech", guard.needs_speech);
    w.value("rest", guard.rest);
    w.value("f_on", guard.f_on);
    w.value("tolerance", guard.tolerance);
    w.value("fit_error", guard.fit_error);
    w.count("curves", guard.count, kMaxGuardCurves);
    for (uint32_t i = 0; i < guard.count; ++i) w.pair("gain", guard.curves[i], guard.gains[i]);
    w.value("together", guard.together);
    w.count("pairs", guard.pair_count, kMaxGuardPairs);
    for (uint32_t i = 0; i < guard.pair_count; ++i) {
      w.place("first", guard.pairs[i].first);
      w.place("second", guard.pairs[i].second);
      w.value("gain", guard.pairs[i].gain);
    }
  });
  bool has_gaze = mix.gaze != nullptr;
  w.value("has_gaze", has_gaze);
  if (has_gaze) {
    GazeTable gaze = mix.gaze ? *mix.gaze : GazeTable{};
    w.value("gaze.yaw_first", gaze.yaw_first);
    w.value("gaze.fit_error", gaze.fit_error);
    for (GazeEye& eye : gaze.eyes) {
      for (float& place : eye.center) w.value("gaze.center", place);
      for (uint32_t d = 0; d < 4; ++d) {
        w.value("gaze.curve", eye.curves[d]);
        for (float& tangent : eye.tangents[d]) w.value("gaze.tangent", tangent);
      }
    }
    w.keep(gaze, mix.gaze);
  }
  w.list("antagonists", mix.antagonists, kMaxCurves, [&w](AntagonistPair& pair) {
    w.value("a", pair.a);
    w.value("b", pair.b);
    w.value("stiffness", pair.stiffness);
  });
  w.row("mirror", mix.mirror, [](size_t curve) { return static_cast<uint16_t>(curve); });
  w.row("lower", mix.lower, [](size_t) { return -kLargestFloat; });
  w.row("upper", mix.upper, [](size_t) { return kLargestFloat; });
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
