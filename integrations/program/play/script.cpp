// SPDX-License-Identifier: MIT
#include "integrations/program/play/script.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

// Objects keep their order.
using json = nlohmann::basic_json<MemberList>;
using Words = std::vector<std::string>;

constexpr const char* kCannotPlayScript = "cannot play scene";
constexpr double kLongestSeconds = 24 * 3600;
constexpr size_t kLongestName = 255;  // of layers and reactions: each event repeats one

const Words kGroups = {"base", "speech", "emotion", "reaction", "life"};
const Words kModes = {"override", "add", "screen", "max", "scale"};
const Words kGenerators = {"blink", "breath", "noise", "gaze"};
const Words kTransitions = {"inertial", "crossfade", "cut"};
const Words kGuards = {"lips", "lids", "teeth"};

/// A value of the document and where it is.
struct Node {
  const json& value;
  std::string where;
  const char* separator = ".";  // between `where` and a key

  [[noreturn]] void wrong(const std::string& why, const std::string& what_to_do) const {
    fail(kInvalid, kCannotPlayScript, where, why, what_to_do);
  }
  [[noreturn]] void not_a(const std::string& what) const {
    wrong("expected " + what + ", not " + value.type_name(), "see 'mien help play'");
  }

  /// An object with none but these members.
  void require_object(const Words& keys) const {
    if (!value.is_object()) not_a("an object");
    for (const auto& [key, ignored] : value.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      wrong("there is no \"" + one_line(key) + "\" here",
            nearest_question(key, keys, "its members are " + list_of(keys, "and")));
    }
  }
  bool has(const char* key) const { return value.contains(key); }
  Node at(const std::string& key) const {
    const auto found = value.find(key);
    if (found == value.end()) wrong("there is no \"" + key + "\"", "add it");
    return {*found, where + separator + key};
  }
  Node at(size_t index) const { return {value[index], where + "[" + std::to_string(index) + "]"}; }
  size_t count() const {
    if (!value.is_array()) not_a("a list");
    return value.size();
  }

  double number(double least, double most) const {
    if (!value.is_number()) not_a("a number");
    const auto found = value.get<double>();
    if (found >= least && found <= most) return found;
    char text[120];
    snprintf(text, sizeof(text), "%g is not within %g to %g", found, least, most);
    wrong(text, "give another number");
  }
  float single(double most = 1e6) const { return static_cast<float>(number(-most, most)); }
  double seconds() const { return number(0, kLongestSeconds); }
  bool truth() const {
    if (!value.is_boolean()) not_a("true or false");
    return value.get<bool>();
  }
  std::string text() const {
    if (!value.is_string()) not_a("a string");
    return value.get<std::string>();
  }
  std::string name() const {
    std::string found = text();
    if (found.size() > kLongestName) wrong("the name is longer than 255 bytes", "shorten it");
    return found;
  }
  uint32_t word(const Words& words) const {
    const std::string found = text();
    const auto place = std::find(words.begin(), words.end(), found);
    if (place != words.end()) return static_cast<uint32_t>(place - words.begin());
    if (words.empty()) wrong("\"" + one_line(found) + "\" is not in the scene", "add it");
    wrong("\"" + one_line(found) + "\" is not one of " + list_of(words, "and"),
          nearest_question(found, words, "choose one of them"));
  }
};

NamedValues read_values(const Node& node, double most = 1e6) {
  if (!node.value.is_object()) node.not_a("an object of numbers");
  NamedValues values;
  for (const auto& [name, value] : node.value.items()) {
    values.emplace_back(name, Node{value, node.where + "." + name}.single(most));
  }
  return values;
}

speech::SpeechSource read_speech(const Node& node) {
  node.require_object({"text", "voice", "audio", "phonemes"});
  speech::SpeechSource speech;
  const auto read = [&](const char* key, std::string& text) {
    if (!node.has(key)) return;
    text = node.at(key).text();
    if (text.empty()) node.at(key).wrong("it is empty", "leave it out");
  };
  read("text", speech.text);
  read("voice", speech.voice);
  read("audio", speech.audio);
  read("phonemes", speech.phonemes);
  const bool is_given = !speech.text.empty() || !speech.audio.empty() || !speech.phonemes.empty();
  if (!is_given) node.wrong("there is nothing to say", "add text, audio or phonemes");
  if (!speech.phonemes.empty() && (!speech.text.empty() || !speech.audio.empty())) {
    node.wrong("it has both phonemes and something to say", "keep one of them");
  }
  return speech;
}

ClipScript read_clip(const Node& node) {
  node.require_object({"clip", "speech", "loop", "speed", "start"});
  ClipScript clip;
  if (node.has("speech")) {
    if (node.has("clip")) node.wrong("it has both a clip and speech", "keep one of them");
    clip.speech = read_speech(node.at("speech"));
    clip.path = node.at("speech").value.dump();
  } else {
    clip.path = node.at("clip").text();
    if (clip.path.empty()) node.at("clip").wrong("the path is empty", "name a clip");
  }
  if (node.has("loop")) clip.loop = node.at("loop").truth();
  if (node.has("speed")) clip.speed = node.at("speed").number(-1000, 1000);
  if (node.has("start")) clip.start = node.at("start").seconds();
  return clip;
}

void read_poses(const Node& source, LayerScript& layer) {
  source.require_object({"poses", "weights"});
  const Node poses = source.at("poses");
  if (!poses.value.is_object()) poses.not_a("an object of poses");
  if (poses.value.empty()) poses.wrong("there are no poses", "add {NAME: {CONTROL: value}}");
  for (const auto& [name, values] : poses.value.items()) {
    layer.poses.push_back({name, read_values({values, poses.where + "." + name})});
  }
  if (source.has("weights")) layer.weights = read_values(source.at("weights"));
}

void read_generator(const Node& source, LayerScript& layer) {
  source.require_object({"generator", "period", "controls", "eyes", "jitter"});
  layer.generator = source.at("generator").word(kGenerators);
  if (layer.generator == MIEN_GENERATOR_GAZE) {
    source.require_object({"generator", "eyes", "jitter"});
    layer.period = 0.25;
    if (source.has("jitter")) layer.jitter = static_cast<float>(source.at("jitter").number(0, 5));
    if (!source.has("eyes")) return;
    const Node eyes = source.at("eyes");
    if (eyes.count() != 2)
      eyes.wrong("there must be two names", "name the joints of the left and the right eye");
    for (size_t i = 0; i < 2; ++i) layer.eyes.push_back(eyes.at(i).text());
    return;
  }
  source.require_object({"generator", "period", "controls"});
  if (source.has("period")) layer.period = source.at("period").number(0.02, 3600);
  if (source.has("controls")) layer.controls = read_values(source.at("controls"));
  if (layer.generator == MIEN_GENERATOR_NOISE && layer.controls.empty()) {
    source.wrong("noise has no controls of its own", "add \"controls\": {NAME: amount}");
  }
}

LayerScript read_layer(const Node& node) {
  node.require_object({"name", "group", "mode", "weight", "mask", "source", "after_guards"});
  LayerScript layer;
  layer.name = node.at("name").name();
  if (node.has("group")) layer.group = node.at("group").word(kGroups);
  if (node.has("mode")) layer.mode = node.at("mode").word(kModes);
  if (node.has("weight")) {
    const double least = layer.mode == MIEN_BLEND_MODE_ADD ? -1 : 0;
    layer.weight = static_cast<float>(node.at("weight").number(least, 1));
  }
  if (node.has("after_guards")) layer.after_guards = node.at("after_guards").truth();
  if (node.has("mask")) {
    const Node mask = node.at("mask");
    mask.require_object({"controls", "invert"});
    layer.mask.emplace();
    const Node controls = mask.at("controls");
    for (size_t i = 0; i < controls.count(); ++i) layer.mask->push_back(controls.at(i).text());
    if (mask.has("invert")) layer.invert_mask = mask.at("invert").truth();
  }
  const Node source = node.at("source");
  if (source.has("clip") || source.has("speech")) {
    layer.clip = read_clip(source);
  } else if (source.has("poses")) {
    layer.source = MIEN_LAYER_SOURCE_POSES;
    read_poses(source, layer);
  } else if (source.has("generator")) {
    layer.source = MIEN_LAYER_SOURCE_GENERATOR;
    read_generator(source, layer);
  } else if (source.has("live")) {
    source.require_object({"live"});
    if (!source.at("live").truth()) source.at("live").wrong("it must be true", "write true");
    layer.source = MIEN_LAYER_SOURCE_STREAM;
  } else {
    source.require_object({"clip", "speech", "poses", "generator", "live"});
    source.wrong("it names no source", "give a clip, speech, poses, a generator or \"live\": true");
  }
  return layer;
}

uint32_t layer_named(const Script& script, const Node& node) {
  Words names;
  for (const LayerScript& layer : script.layers) names.push_back(layer.name);
  return node.word(names);
}

void read_layer_event(const Script& script, const Node& node, EventScript& event) {
  event.target = layer_named(script, node.at("layer"));
  const uint32_t source = script.layers[event.target].source;
  if (node.has("play")) {
    node.require_object({"time", "layer", "play", "transition", "duration"});
    event.kind = EventKind::kPlay;
    event.clip = read_clip(node.at("play"));
    if (node.has("transition")) event.transition = node.at("transition").word(kTransitions);
    if (node.has("duration")) event.duration = node.at("duration").seconds();
  } else if (node.has("stop")) {
    node.require_object({"time", "layer", "stop", "fade"});
    event.kind = EventKind::kStop;
    if (!node.at("stop").truth()) node.at("stop").wrong("it must be true", "write true");
  } else if (node.has("weights")) {
    node.require_object({"time", "layer", "weights", "fade"});
    event.kind = EventKind::kWeights;
    event.weights = read_values(node.at("weights"));
  } else {
    node.require_object({"time", "layer", "weight", "fade"});
    const bool adds = script.layers[event.target].mode == MIEN_BLEND_MODE_ADD;
    event.weight = static_cast<float>(node.at("weight").number(adds ? -1 : 0, 1));
  }
  if (node.has("fade")) event.fade = node.at("fade").seconds();
  const bool of_clips = event.kind == EventKind::kPlay || event.kind == EventKind::kStop;
  if ((of_clips && source != MIEN_LAYER_SOURCE_CLIP) ||
      (event.kind == EventKind::kWeights && source != MIEN_LAYER_SOURCE_POSES)) {
    node.wrong(std::string("the layer has no ") + (of_clips ? "clip" : "poses"),
               "name another layer");
  }
}

EventScript read_event(const Script& script, const Node& node) {
  node.require_object({"time", "layer", "weight", "weights", "fade", "play", "stop", "transition",
                       "duration", "trigger", "strength", "hold", "level", "variable", "value"});
  EventScript event;
  event.where = node.where;
  event.time = node.at("time").seconds();
  if (node.has("trigger")) {
    node.require_object({"time", "trigger", "strength", "hold"});
    event.kind = EventKind::kTrigger;
    event.target = node.at("trigger").word(script.reactions);
    event.weight = node.has("strength") ? static_cast<float>(node.at("strength").number(0, 1)) : 1;
    if (node.has("hold")) event.hold = node.at("hold").seconds();
  } else if (node.has("level")) {
    node.require_object({"time", "level", "value"});
    event.kind = EventKind::kLevel;
    event.target = node.at("level").word(script.reactions);
    event.weight = static_cast<float>(node.at("value").number(0, 1));
  } else if (node.has("variable")) {
    node.require_object({"time", "variable", "value"});
    event.kind = EventKind::kVariable;
    event.variable = node.at("variable").text();
    event.weight = node.at("value").single();
  } else if (node.has("layer")) {
    read_layer_event(script, node, event);
  } else {
    node.wrong("it does not say what happens", "add a layer, trigger, level or variable");
  }
  return event;
}

template <class Item, class Read>
void read_list(const Node& root, const char* key, size_t most, std::vector<Item>& out,
               const Read& read) {
  if (!root.has(key)) return;
  const Node list = root.at(key);
  if (list.count() > most) {
    list.wrong("there are " + std::to_string(list.count()), "give at most " + std::to_string(most));
  }
  for (size_t i = 0; i < list.count(); ++i) out.push_back(read(list.at(i)));
}

void refuse_same_names(const Node& root, const char* key, Words names) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return;
  root.at(key).wrong("two of them are named \"" + one_line(*twice) + "\"",
                     "give each its own name");
}

}  // namespace

Script parse_script(const std::string& text, const std::string& shown, bool live) {
  const json document = parse_json<json>(text, kCannotPlayScript, shown,
                                         "give one JSON object; see 'mien help play'");
  const Node root = {document, shown, ", "};
  root.require_object({"rate", "seconds", "seed", "layers", "guards", "antagonists", "limits",
                       "reactions", "events"});
  Script script;
  script.shown = shown;
  if (root.has("rate")) script.rate = root.at("rate").number(1.0 / 6, 10000);
  if (root.has("seconds")) script.seconds = root.at("seconds").seconds();
  if (root.has("seed")) {
    if (!root.at("seed").value.is_number_unsigned())
      root.at("seed").wrong("it is " + root.at("seed").value.dump(),
                            "give a whole number, 0 or more");
    script.seed = root.at("seed").value.get<uint64_t>();
  }
  if (root.has("antagonists")) script.antagonists = root.at("antagonists").truth();
  if (root.has("limits")) script.limits = root.at("limits").truth();
  std::vector<uint32_t> guards;
  read_list(root, "guards", 3, guards, [](const Node& node) { return 1u << node.word(kGuards); });
  for (uint32_t guard : guards) script.guards |= guard;

  read_list(root, "layers", 16, script.layers, read_layer);
  const auto is_live = [](const LayerScript& l) { return l.source == MIEN_LAYER_SOURCE_STREAM; };
  const auto lives = std::count_if(script.layers.begin(), script.layers.end(), is_live);
  if (lives != 0 && !live) {
    root.at("layers").wrong("one of them is live, but nothing is received",
                            "add --live livelink://:11111 or --live vmc://:39539");
  }
  if (lives > 1) root.at("layers").wrong("several are live", "keep one of them");
  if (std::count_if(script.layers.begin(), script.layers.end(), is_gaze) > 1) {
    root.at("layers").wrong("several turn the eyes", "keep one of them");
  }
  if (lives == 0 && live) {
    if (script.layers.size() == 16) {
      root.at("layers").wrong("there are 16 already, and --live adds one", "leave one out");
    }
    LayerScript added;
    added.name = "live";
    added.source = MIEN_LAYER_SOURCE_STREAM;
    script.layers.insert(script.layers.begin(), added);
  }
  Words names;
  for (const LayerScript& layer : script.layers) names.push_back(layer.name);
  refuse_same_names(root, "layers", names);
  read_list(root, "reactions", 16, script.reactions, [](const Node& node) {
    node.require_object({"name", "preset"});
    node.at("preset").word({"glare"});
    return node.at("name").name();
  });
  refuse_same_names(root, "reactions", script.reactions);
  read_list(root, "events", 1000000, script.events,
            [&](const Node& node) { return read_event(script, node); });
  std::stable_sort(script.events.begin(), script.events.end(),
                   [](const EventScript& a, const EventScript& b) { return a.time < b.time; });
  return script;
}

Captions find_captions(const Script& script) {
  MienMixStroke strokes[5];
  MienMixReaction glare;
  (void)mien_mix_glare(0, strokes, 5, &glare);
  std::vector<bool> lit(script.reactions.size());
  Captions captions;
  for (const EventScript& event : script.events) {
    switch (event.kind) {
      case EventKind::kTrigger:
        captions.emplace_back(event.time, script.reactions[event.target]);
        break;
      case EventKind::kLevel: {
        const float least = lit[event.target] ? glare.level_off : glare.level_on;
        const bool is_lit = event.weight >= least;
        if (is_lit && !lit[event.target]) {
          captions.emplace_back(event.time, script.reactions[event.target]);
        }
        lit[event.target] = is_lit;
        break;
      }
      case EventKind::kWeights:
        for (const auto& [name, weight] : event.weights) {
          if (weight > 0) captions.emplace_back(event.time, name);
        }
        break;
      case EventKind::kWeight:
        captions.emplace_back(
            event.time, script.layers[event.target].name + (event.weight == 0 ? " ends" : ""));
        break;
      case EventKind::kStop:
        captions.emplace_back(event.time, script.layers[event.target].name + " ends");
        break;
      case EventKind::kPlay:
        captions.emplace_back(event.time, script.layers[event.target].name);
        break;
      case EventKind::kVariable: break;
    }
  }
  return captions;
}

}  // namespace mien::cli
