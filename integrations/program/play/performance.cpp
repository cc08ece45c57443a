// SPDX-License-Identifier: MIT
#include "integrations/program/play/performance.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/frame_rate.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/take.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr const char* kCannot = "cannot play scene";

const NamedValues kBlinkControls = {{"eyeBlinkLeft", 1}, {"eyeBlinkRight", 1}};
const NamedValues kBreathControls = {{"noseNostrilDilateL", 0.3f}, {"noseNostrilDilateR", 0.3f}};
const NamedValues kSquintControls = {{"eyeSquintLeft", 0.8f},
                                     {"eyeSquintRight", 0.8f},
                                     {"browDownLeft", 0.7f},
                                     {"browDownRight", 0.7f}};
const char* const kGazeVariables[] = {"gaze.x", "gaze.y", "gaze.z", "head.left", "head.up"};
const std::vector<std::string> kVariables = {"gaze.x",    "gaze.y",  "gaze.z", "head.left",
                                             "head.turn", "head.up", "pupil",  "breath"};
constexpr double kSpeechRate = 60;  // of the clips that speech becomes
const NamedValues kPupilControls = {{"eyePupilNarrowL", 1}, {"eyePupilNarrowR", 1}};

int64_t ticks_of(double seconds) {
  return std::llround(seconds * static_cast<double>(MIEN_TICKS_PER_SECOND));
}

void checked(MienStatus status, const MienError& error, const std::string& where) {
  if (status == MIEN_OK) return;
  // If a scene asks for something impossible, it is an error of the scene.
  const bool own = status == MIEN_ERROR_INVALID_ARGUMENT || status == MIEN_ERROR_MISMATCH;
  if (own && error.message[0]) fail(kInvalid, kCannot, where, error.message, "change the scene");
  check(status, &error, kCannot, where);
}

}  // namespace

Performance::Performance(const Script& script, const MienRig* rig, const MienDeformer* deformer,
                         const StreamScript& stream, const NamesFile& names, const Session& session)
    : script_(script), stream_(stream), rig_(rig), session_(session), names_(names),
      curves_(rig, names) {
  MienFloatView initial{};
  check(mien_rig_initial_raw_controls(rig, &initial), nullptr, kCannot, script.shown);
  initial_.assign(initial.data, initial.data + initial.count);
  find_eyes(deformer);
  add_layers();
  for (size_t r = 0; r < script.reactions.size(); ++r) add_glare();
  for (const EventScript& event : script.events) {
    if (event.kind == EventKind::kPlay) clip(event.clip);
    if (event.kind == EventKind::kVariable) add_variable(event.variable);
  }
  make_mix(deformer);
}

/// One that neither a layer nor a reaction has may be meant for a solver of the host; or it is misspelled.
void Performance::add_variable(const std::string& name) {
  const std::vector<std::string>& used = curves_.variables();
  const bool known = std::find(used.begin(), used.end(), name) != used.end() ||
                     std::find(kVariables.begin(), kVariables.end(), name) != kVariables.end();
  curves_.variable(name);
  if (known || name.compare(0, 5, "user.") == 0) return;
  note(session_, "the variable \"" + one_line(name) + "\" moves nothing; " +
                     nearest_question(name, kVariables, "variables of your own begin with user."));
}

/// A text, a sound or phonemes as a clip; paths are relative to the scene.
void Performance::say(const speech::SpeechSource& source, BoundClip& bound) {
  const std::filesystem::path folder = std::filesystem::path(script_.shown).parent_path();
  speech::SpeechSource here = source;
  for (std::string* path : {&here.audio, &here.phonemes}) {
    if (!path->empty()) *path = (folder / *path).string();
  }
  const speech::SpokenTake take =
      speech::make_take(speech::read_speech(here, session_), kSpeechRate, session_);
  bound.file.shown = "speech";
  bound.file.clip = speech::make_clip(take, script_.shown);
  bound.file.info = sized<MienClipInfo>();
  check(mien_clip_info(bound.file.clip.get(), &bound.file.info), nullptr, kCannot, script_.shown);
}

/// Channels such as head.up are no controls: they are added to the variables of these names.
void Performance::read_head(BoundClip& bound, const std::vector<std::string>& names) {
  std::vector<size_t> channels;
  for (size_t c = 0; c < names.size(); ++c) {
    if (!turns_head(names[c])) continue;
    channels.push_back(c);
    bound.head.push_back({curves_.variable(names[c]), {}});
  }
  if (channels.empty()) return;
  const ClipFile& file = bound.file;
  if (channels.size() > most_values(file.info.file_bytes) / file.info.frame_count) {
    fail(kInvalid, kCannot, file.shown, "it is too long for its size",
         "leave out " + names[channels[0]]);
  }
  for_each_frame(file, [&](uint32_t, const float* values) {
    for (size_t i = 0; i < channels.size(); ++i)
      bound.head[i].values.push_back(values[channels[i]]);
  });
}

void Performance::turn_head(int64_t tick, float* row) const {
  const double now = static_cast<double>(tick) / static_cast<double>(MIEN_TICKS_PER_SECOND);
  for (const auto& [layer, turn] : head_turns_) {
    const MienClipInfo& info = turn.clip->file.info;
    const double rate = static_cast<double>(info.rate_numerator) / info.rate_denominator;
    const double frames = info.frame_count;
    double at = (turn.start + (now - turn.begin) * turn.speed) * rate;
    if (turn.loops) at -= std::floor(at / frames) * frames;
    const auto frame = static_cast<size_t>(std::clamp(at, 0.0, frames - 1));
    for (const HeadChannel& head : turn.clip->head) row[head.variable] += head.values[frame];
  }
}

const Performance::BoundClip& Performance::clip(const ClipScript& what) {
  const auto known = clips_.find(what.path);
  if (known != clips_.end()) return known->second;
  const std::filesystem::path folder = std::filesystem::path(script_.shown).parent_path();
  BoundClip bound;
  if (what.speech) {
    say(*what.speech, bound);
  } else {
    bound.file = open_clip_file((folder / what.path).string());
  }
  bound.binding =
      bind_clip(bound.file.clip.get(), rig_, names_, kCannot, bound.file.shown, session_);
  const MienClipBindingInfo info = binding_info(bound.binding.get());
  const std::vector<std::string> names = channel_names(bound.file);
  read_head(bound, names);
  std::vector<std::string> missing;
  for (size_t i = 0; i < info.missing_channels.count; ++i) {
    const std::string& name = names[info.missing_channels.data[i]];
    if (!turns_head(name)) missing.push_back(name);
  }
  if (!missing.empty()) {
    note(session_, bound.file.shown + ": the rig has no controls for " +
                       std::to_string(missing.size()) + " of " + std::to_string(names.size()) +
                       " channels, the first is " + one_line(missing[0]));
  }
  return clips_.emplace(what.path, std::move(bound)).first->second;
}

/// Eyes look at gaze.x, gaze.y and gaze.z: meters to the left, up and to the front of their middle.
void Performance::find_eyes(const MienDeformer* deformer) {
  const std::vector<LayerScript>& layers = script_.layers;
  const auto layer = std::find_if(layers.begin(), layers.end(), is_gaze);
  if (layer == layers.end()) return;
  if (!deformer) {
    fail(kInvalid, kCannot, script_.shown, "the rig has no geometry to measure its eyes on",
         "leave out the generator gaze");
  }
  auto desc = sized<MienGazeDesc>();
  if (!layer->eyes.empty()) {
    desc.left_eye = layer->eyes[0].c_str();
    desc.right_eye = layer->eyes[1].c_str();
  }
  auto error = sized<MienError>();
  MienGaze* gaze = nullptr;
  const MienStatus status = mien_gaze_create(deformer, &desc, &gaze, &error);
  if (status == MIEN_ERROR_NAME) {
    fail(kInvalid, kCannot, script_.shown, "the rig has no joints of these names for the eyes",
         "name them: \"eyes\": [LEFT, RIGHT]");
  }
  checked(status, error, script_.shown);
  gaze_.reset(gaze);
  auto info = sized<MienGazeInfo>();
  check(mien_gaze_info(gaze, &info), nullptr, kCannot, script_.shown);
  const MienGazeTarget &left = info.left_eye, &right = info.right_eye;
  const float middle[] = {(left.left + right.left) / 2, (left.up + right.up) / 2,
                          (left.front + right.front) / 2};
  for (size_t i = 0; i < std::size(middle); ++i) {
    gaze_places_[curves_.variable(kGazeVariables[i])] = {1000, middle[i]};
  }
}

/// Values of a scene that a layer blends by `mode`.
CurveValues Performance::of_mixer(CurveValues values, uint32_t mode,
                                  const std::string& where) const {
  for (size_t i = 0; i < values.curves.size(); ++i) {
    const auto found = gaze_places_.find(values.curves[i]);
    if (found == gaze_places_.end()) continue;
    const GazePlace& place = found->second;
    if (mode != MIEN_BLEND_MODE_ADD && mode != MIEN_BLEND_MODE_OVERRIDE) {
      fail(kInvalid, kCannot, where, "places to look at are added or overridden",
           "use the mode add or override");
    }
    values.values[i] =
        values.values[i] * place.scale + (mode == MIEN_BLEND_MODE_OVERRIDE ? place.offset : 0.0f);
  }
  return values;
}

float Performance::of_scene(size_t curve, float value) const {
  const auto found = gaze_places_.find(curve);
  if (found == gaze_places_.end()) return value;
  return (value - found->second.offset) / found->second.scale;
}

uint32_t Performance::add_pose(CurveValues values) {
  pose_values_.push_back(std::move(values));
  const CurveValues& kept = pose_values_.back();
  poses_.push_back({kept.curves.data(), kept.values.data(), kept.curves.size()});
  return static_cast<uint32_t>(poses_.size() - 1);
}

void Performance::add_layers() {
  for (size_t l = 0; l < script_.layers.size(); ++l) {
    const LayerScript& from = script_.layers[l];
    const std::string where = script_.shown + ", layers[" + std::to_string(l) + "]";
    parts_.emplace_back();
    LayerParts& parts = parts_.back();
    MienMixLayer layer = {};
    layer.group = from.group;
    layer.mode = from.mode;
    layer.source = from.source;
    layer.weight = from.weight;
    layer.after_guards = from.after_guards;
    if (from.mask) {
      parts.mask = curves_.mask(*from.mask, from.invert_mask, where + ".mask.controls");
      layer.mask = parts.mask.data();
      layer.mask_count = static_cast<uint32_t>(parts.mask.size());
    }
    if (from.source == MIEN_LAYER_SOURCE_CLIP) clip(from.clip);
    if (from.source == MIEN_LAYER_SOURCE_POSES) {
      layer.first_pose = static_cast<uint32_t>(poses_.size());
      layer.pose_count = static_cast<uint32_t>(from.poses.size());
      for (const PoseScript& pose : from.poses) {
        const std::string name = where + ".source.poses." + pose.name;
        add_pose(of_mixer(curves_.curves(pose.values, name), from.mode, name));
      }
    }
    if (from.source == MIEN_LAYER_SOURCE_STREAM) {
      layer.curves = stream_.curves.data();
      layer.curve_count = static_cast<uint32_t>(stream_.curves.size());
      layer.delay = ticks_of(stream_.delay);
      layer.stream_frames = 256;
    }
    if (is_gaze(from)) {
      for (const char* name : kGazeVariables)
        parts.generated.curves.push_back(curves_.variable(name));
      parts.generated.values = {from.jitter, from.jitter, 0, 1, 1};
    } else if (from.source == MIEN_LAYER_SOURCE_GENERATOR) {
      const bool blinks = from.generator == MIEN_GENERATOR_BLINK;
      parts.generated = from.controls.empty()
                            ? curves_.present(blinks ? kBlinkControls : kBreathControls)
                            : curves_.curves(from.controls, where + ".source.controls");
      if (parts.generated.curves.empty() && !blinks)
        parts.generated = {{curves_.variable("breath")}, {1}};
      if (parts.generated.curves.empty()) {
        fail(kInvalid, kCannot, where, "the rig has no controls that blink",
             "name them: \"controls\": {NAME: 1}");
      }
      parts.generated = of_mixer(std::move(parts.generated), from.mode, where);
    }
    if (from.source == MIEN_LAYER_SOURCE_GENERATOR) {
      layer.generator = from.generator;
      layer.period = ticks_of(from.period);
      layer.curves = parts.generated.curves.data();
      layer.amounts = parts.generated.values.data();
      layer.curve_count = static_cast<uint32_t>(parts.generated.curves.size());
    }
    layers_.push_back(layer);
  }
}

/// In the order in which they act: reactions come behind the last layer that is not of the group life.
void Performance::order_stages() {
  const auto layer_count = static_cast<uint32_t>(layers_.size());
  uint32_t before_reactions = 0;
  for (uint32_t i = 0; i < layer_count; ++i) {
    if (layers_[i].group != MIEN_LAYER_GROUP_LIFE) before_reactions = i + 1;
  }
  const auto add = [&](const std::string& name, uint32_t number) {
    stages_.push_back(name);
    stage_numbers_.push_back(number);
  };
  for (uint32_t i = 0; i < before_reactions; ++i) add(script_.layers[i].name, i);
  add("reactions", layer_count);
  for (uint32_t i = before_reactions; i < layer_count; ++i) add(script_.layers[i].name, i);
  add("guards", layer_count + 1);
  add("antagonists", layer_count + 2);
  add("limits", layer_count + 3);
}

/// Light in the eyes: lids, squint, gaze, pupils, head.
void Performance::add_glare() {
  CurveValues pupils = curves_.present(kPupilControls);
  if (pupils.curves.empty()) pupils = {{curves_.variable("pupil")}, {-1}};
  const CurveValues poses[] = {
      curves_.present(kBlinkControls),
      curves_.present(kSquintControls),
      of_mixer({{curves_.variable("gaze.y")}, {-0.4f}}, MIEN_BLEND_MODE_ADD, script_.shown),
      pupils,
      {{curves_.variable("head.turn")}, {0.3f}}};
  if (poses[0].curves.empty() && strokes_.empty()) {
    note(session_, "the rig has no controls that blink: a glare does not close the eyes");
  }
  const uint32_t first = add_pose(poses[0]);
  for (size_t i = 1; i < std::size(poses); ++i) add_pose(poses[i]);
  strokes_.emplace_back(std::size(poses));
  MienMixReaction reaction = {};
  check(mien_mix_glare(first, strokes_.back().data(), strokes_.back().size(), &reaction), nullptr,
        kCannot, script_.shown);
  reactions_.push_back(reaction);
}

void Performance::make_mix(const MienDeformer* deformer) {
  std::vector<MienMixAntagonists> antagonists;
  if (script_.antagonists) {
    size_t count = 0;
    check(mien_mix_antagonists(rig_, nullptr, 0, &count), nullptr, kCannot, script_.shown);
    antagonists.resize(count);
    check(mien_mix_antagonists(rig_, antagonists.data(), count, &count), nullptr, kCannot,
          script_.shown);
  }
  // Tables of GUI controls end in 0 to 1 for every raw control; parts of rotations reach further.
  std::vector<float> lower(curves_.count(), -1e6f), upper(curves_.count(), 1e6f);
  for (size_t i = 0; i < curves_.controls().size(); ++i) {
    const bool rotation = curves_.controls()[i].find(".q") != std::string::npos;
    lower[i] = rotation ? -1.0f : 0.0f;
    upper[i] = 1;
  }
  auto desc = sized<MienMixDesc>();
  desc.layers = layers_.data();
  desc.layer_count = layers_.size();
  desc.poses = poses_.data();
  desc.pose_count = poses_.size();
  desc.reactions = reactions_.data();
  desc.reaction_count = reactions_.size();
  desc.antagonists = antagonists.data();
  desc.antagonist_count = antagonists.size();
  if (script_.limits) desc.lower = lower.data(), desc.upper = upper.data();
  desc.deformer = script_.guards ? deformer : nullptr;
  desc.guards = script_.guards;
  desc.gaze = gaze_.get();
  desc.variable_count = static_cast<uint32_t>(curves_.variables().size());
  desc.max_events = 1024;
  desc.reverse = 1;
  for (const auto& [path, bound] : clips_) {
    desc.max_channels = std::max(desc.max_channels, bound.file.info.channel_count);
    desc.max_changing_channels =
        std::max(desc.max_changing_channels, bound.file.info.changing_channel_count);
  }
  auto error = sized<MienError>();
  MienMix* mix = nullptr;
  checked(mien_mix_create(rig_, &desc, &mix, &error), error, script_.shown);
  mix_.reset(mix);
  auto info = sized<MienMixInfo>();
  check(mien_mix_info(mix, &info), nullptr, kCannot, script_.shown);
  if (script_.guards != 0 && info.guard_count == 0) {
    note(session_, script_.shown + ": the rig has none of the parts that the guards measure");
  }
  order_stages();
  auto how = sized<MienMixerDesc>();
  how.seed = script_.seed;
  how.stages = 1;
  MienMixer* mixer = nullptr;
  checked(mien_mixer_create(mix, &how, &mixer, &error), error, script_.shown);
  mixer_.reset(mixer);
  for (uint32_t g = 0; g < info.guard_count; ++g) {
    auto state = sized<MienGuardState>();
    check(mien_mixer_guard(mixer, g, &state), nullptr, kCannot, script_.shown);
    const MienIndex16View& controls = state.controls;
    guards_.push_back({to_string(state.name), {controls.data, controls.data + controls.count}});
  }
}

void Performance::play(uint32_t layer, const ClipScript& what, uint32_t transition, double duration,
                       const std::string& where) {
  const BoundClip& bound = clip(what);
  head_turns_.erase(layer);
  if (!bound.head.empty()) {
    const double now = static_cast<double>(now_) / static_cast<double>(MIEN_TICKS_PER_SECOND);
    const bool loops = what.loop ? *what.loop : bound.file.info.looping == MIEN_LOOPING_WRAP;
    head_turns_[layer] = {&bound, now, what.start, what.speed, loops};
  }
  auto desc = sized<MienPlayDesc>();
  desc.start_tick = ticks_of(what.start);
  desc.transition = transition;
  desc.transition_ticks = ticks_of(duration);
  if (what.loop) desc.looping = *what.loop ? MIEN_LOOPING_WRAP : MIEN_LOOPING_CLAMP;
  // 0.3333333 is a third, so that loops keep step.
  const double speed = std::abs(what.speed);
  if (speed < 1e-6) {
    desc.speed_numerator = 0;
    desc.speed_denominator = 1;
  } else {
    const Rate fraction = nearest_rate(speed, 1e-7);
    desc.speed_numerator = static_cast<int32_t>(fraction.numerator) * (what.speed < 0 ? -1 : 1);
    desc.speed_denominator = static_cast<int32_t>(fraction.denominator);
  }
  auto error = sized<MienError>();
  checked(mien_mixer_play(mixer_.get(), layer, bound.file.clip.get(), bound.binding.get(), &desc,
                          &error),
          error, where);
}

void Performance::start() {
  for (const auto& [curve, place] : gaze_places_) {
    const auto variable = static_cast<uint32_t>(curve - curves_.controls().size());
    const float ahead = curve == curves_.variable("gaze.z") ? 1.0f : 0.0f;
    checked(mien_mixer_set_variable(mixer_.get(), variable, ahead * place.scale + place.offset),
            sized<MienError>(), script_.shown);
  }
  for (uint32_t l = 0; l < script_.layers.size(); ++l) {
    const LayerScript& layer = script_.layers[l];
    const std::string where = script_.shown + ", layers[" + std::to_string(l) + "]";
    if (layer.source == MIEN_LAYER_SOURCE_CLIP) play(l, layer.clip, MIEN_TRANSITION_CUT, 0, where);
    EventScript weights;
    weights.kind = EventKind::kWeights;
    weights.where = where + ".source.weights";
    weights.target = l;
    weights.weights = layer.weights;
    apply(weights);
  }
}

void Performance::apply(const EventScript& event) {
  MienMixer* mixer = mixer_.get();
  const auto error = sized<MienError>();
  const int64_t fade = ticks_of(event.fade);
  switch (event.kind) {
    case EventKind::kWeight:
      checked(mien_mixer_set_weight(mixer, event.target, event.weight, fade), error, event.where);
      break;
    case EventKind::kWeights:
      for (const auto& [name, weight] : event.weights) {
        const std::vector<PoseScript>& poses = script_.layers[event.target].poses;
        std::vector<std::string> names;
        for (const PoseScript& pose : poses) names.push_back(pose.name);
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
          fail(kInvalid, kCannot, event.where, "the layer has no pose \"" + one_line(name) + "\"",
               nearest_question(name, names, "name one of its poses"));
        }
        if (weight < 0 || weight > 1) {
          fail(kInvalid, kCannot, event.where,
               "the weight of " + one_line(name) + " is not within 0 to 1", "give another number");
        }
        checked(
            mien_mixer_set_pose_weight(mixer, event.target,
                                       static_cast<uint32_t>(found - names.begin()), weight, fade),
            error, event.where);
      }
      break;
    case EventKind::kPlay:
      play(event.target, event.clip, event.transition, event.duration, event.where);
      break;
    case EventKind::kStop:
      checked(mien_mixer_stop(mixer, event.target, fade), error, event.where);
      head_turns_.erase(event.target);
      break;
    case EventKind::kTrigger:
      checked(mien_mixer_trigger(mixer, event.target, event.weight, ticks_of(event.hold)), error,
              event.where);
      break;
    case EventKind::kLevel:
      checked(mien_mixer_set_level(mixer, event.target, event.weight), error, event.where);
      break;
    case EventKind::kVariable: {
      const uint16_t curve = curves_.variable(event.variable);
      const float value =
          of_mixer({{curve}, {event.weight}}, MIEN_BLEND_MODE_OVERRIDE, event.where).values[0];
      checked(mien_mixer_set_variable(
                  mixer, static_cast<uint32_t>(curve - curves_.controls().size()), value),
              error, event.where);
      break;
    }
  }
}

void Performance::step_to(int64_t tick) {
  checked(mien_mixer_step(mixer_.get(), tick - now_, nullptr), sized<MienError>(), script_.shown);
  now_ = tick;
  auto info = sized<MienMixerInfo>();
  check(mien_mixer_info(mixer_.get(), &info), nullptr, kCannot, script_.shown);
  for (uint32_t e = 0; e < info.event_count; ++e) {
    MienClipEvent event = {};
    uint32_t layer = 0;
    check(mien_mixer_event(mixer_.get(), e, &event, &layer), nullptr, kCannot, script_.shown);
    events_.push_back({static_cast<double>(tick) / static_cast<double>(MIEN_TICKS_PER_SECOND),
                       script_.layers[layer].name, to_string(event.name), event.value});
  }
}

void Performance::push(int64_t tick, const std::vector<float>& row) {
  for (uint32_t l = 0; l < script_.layers.size(); ++l) {
    if (script_.layers[l].source != MIEN_LAYER_SOURCE_STREAM) continue;
    checked(mien_mixer_push(mixer_.get(), l, tick, row.data(), row.size(), nullptr),
            sized<MienError>(), script_.shown);
  }
}

void Performance::run(double rate, double seconds, const std::function<bool(int64_t)>& wait,
                      const std::function<void(size_t, double, const float*)>& use) {
  start();
  const auto frames = static_cast<size_t>(std::floor(seconds * rate + 1e-6)) + 1;
  std::vector<float> row(curves_.count());
  size_t next = 0;
  Progress progress(session_, wait ? "playing" : "frame", wait ? 0 : frames);
  for (size_t f = 0; f < frames; ++f) {
    if (!wait) progress.at(f);
    const double time = static_cast<double>(f) / rate;
    const int64_t tick = ticks_of(time);
    if (wait && !wait(tick)) return;
    for (; next < script_.events.size() && ticks_of(script_.events[next].time) <= tick; ++next) {
      const EventScript& event = script_.events[next];
      // At time 0 nothing has moved yet, so there is nothing to go on from.
      if (ticks_of(event.time) > now_) step_to(ticks_of(event.time));
      apply(event);
    }
    step_to(tick);
    MienFloatView view{};
    check(mien_mixer_row(mixer_.get(), &view), nullptr, kCannot, script_.shown);
    std::copy(view.data, view.data + row.size(), row.begin());
    // The w of rotations that nothing moves.
    for (size_t i = 0; i < initial_.size(); ++i) {
      if (initial_[i] != 0 && row[i] == 0) row[i] = initial_[i];
    }
    for (const auto& place : gaze_places_)
      row[place.first] = of_scene(place.first, row[place.first]);
    turn_head(tick, row.data());
    use(f, time, row.data());
  }
}

std::vector<float> Performance::stage_values(uint16_t curve) const {
  std::vector<float> values;
  for (const uint32_t number : stage_numbers_) {
    MienFloatView view{};
    check(mien_mixer_stage(mixer_.get(), number, &view), nullptr, kCannot, script_.shown);
    values.push_back(of_scene(curve, view.data[curve]));
  }
  return values;
}

std::vector<GuardFrame> Performance::guard_frames() const {
  std::vector<GuardFrame> frames;
  for (uint32_t g = 0; g < guards_.size(); ++g) {
    auto state = sized<MienGuardState>();
    check(mien_mixer_guard(mixer_.get(), g, &state), nullptr, kCannot, script_.shown);
    frames.push_back(
        {state.activation, state.protected_distance, state.wanted, state.limit, state.distance});
  }
  return frames;
}

}  // namespace mien::cli
