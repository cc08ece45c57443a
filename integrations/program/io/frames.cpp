// SPDX-License-Identifier: MIT
#include "integrations/program/io/frames.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using nlohmann::json;

constexpr const char* kCannotUseFrames = "cannot use frames";

/// A member of a frame that takes numbers.
struct Target {
  uint32_t kind;
  const char* noun;    // for one of them
  const char* names;   // the option of `mien info` that lists them
  bool takes_indices;  // "12" may stand for a name
};

constexpr Target kRaw = {MIEN_KIND_RAW_CONTROL, "raw control", "--names raw", false};
constexpr Target kRawAfterGui = {MIEN_KIND_RAW_CONTROL, "raw control", "--names raw", true};
constexpr Target kGui = {MIEN_KIND_GUI_CONTROL, "GUI control", "--names gui", false};
constexpr Target kMask = {MIEN_KIND_ML_MASK, "region mask", "--names regions,meshes", false};

// What `mien play` and `mien solve` write beside the controls.
const std::vector<std::string> kIgnored = {"rig",       "rate",   "controls",
                                           "variables", "events", "keys"};
const std::vector<std::string> kIgnoredInFrames = {"time", "variables", "stages", "guards"};

std::string at_index(const std::string& where, size_t index) {
  return where + "[" + std::to_string(index) + "]";
}

float parse_value(const json& value, const std::string& where) {
  if (!value.is_number()) {
    fail(kInvalid, kCannotUseFrames, where,
         std::string("expected a number, not ") + value.type_name(), "write a number");
  }
  const auto number = static_cast<float>(value.get<double>());
  if (!std::isfinite(number)) {
    fail(kInvalid, kCannotUseFrames, where, value.dump() + " is too large for a 32-bit float",
         "controls are usually in 0..1");
  }
  return number;
}

/// Finds controls by name; names come again in every frame.
class ControlNames {
 public:
  explicit ControlNames(const MienRig* rig) : rig_(rig) {}

  const MienRig* rig() const { return rig_; }

  uint32_t find(const Target& target, const std::string& name, const std::string& where) {
    auto& known = known_[&target];
    const auto found = known.find(name);
    if (found != known.end()) return found->second;
    return known[name] = search(target, name, where);
  }

 private:
  uint32_t search(const Target& target, const std::string& name, const std::string& where);

  const MienRig* rig_;
  std::unordered_map<uint32_t, ShortNames> short_names_;  // by kind, once one was needed
  std::unordered_map<const Target*, std::unordered_map<std::string, uint32_t>> known_;
};

uint32_t ControlNames::search(const Target& target, const std::string& name,
                              const std::string& where) {
  uint32_t index = 0;
  if (mien_rig_find_n(rig_, target.kind, name.data(), name.size(), &index) == MIEN_OK) return index;
  const uint32_t count = rig_count(rig_, target.kind);

  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, index);
  const bool is_number = stop == end && !name.empty() && error != std::errc::invalid_argument;
  if (target.takes_indices && is_number) {
    if (error == std::errc() && index < count) return index;
    fail(kInvalid, kCannotUseFrames, where,
         "index " + name + " is out of range: the rig has " + std::to_string(count) + " " +
             target.noun + "s",
         "count from 0");
  }

  const ShortNames& short_names =
      short_names_.try_emplace(target.kind, rig_, target.kind).first->second;
  const std::vector<uint32_t>& short_named = short_names.find(name);
  if (short_named.size() == 1) return short_named[0];
  if (short_named.size() > 1) {
    fail(kInvalid, kCannotUseFrames, where,
         "\"" + name + "\" is ambiguous: " + rig_name(rig_, target.kind, short_named[0]) + " or " +
             rig_name(rig_, target.kind, short_named[1]),
         "give the full name");
  }
  NearestName nearest(name);
  for (uint32_t i = 0; i < count; ++i) nearest.offer(rig_name(rig_, target.kind, i));
  fail(kInvalid, kCannotUseFrames, where,
       std::string("no ") + target.noun + " is named \"" + name + "\"",
       nearest.question(std::string("'mien info RIG ") + target.names + "' lists the names"));
}

/// A control may have several names: its own, a short one, its index.
void refuse_doubles(const std::vector<Assignment>& assignments, const ControlNames& names,
                    const Target& target, const std::string& where) {
  std::vector<uint32_t> indices;
  for (const Assignment& assignment : assignments) indices.push_back(assignment.index);
  std::sort(indices.begin(), indices.end());
  const auto twice = std::adjacent_find(indices.begin(), indices.end());
  if (twice == indices.end()) return;
  fail(kInvalid, kCannotUseFrames, where,
       std::string(target.noun) + " \"" + rig_name(names.rig(), target.kind, *twice) +
           "\" is set twice",
       "leave one of them out");
}

/// An array with all numbers in order, or an object with some by name.
std::vector<Assignment> parse_assignments(const json& values, ControlNames& names,
                                          const Target& target, const std::string& where) {
  std::vector<Assignment> assignments;
  if (values.is_array() && !target.takes_indices) {
    const uint32_t count = rig_count(names.rig(), target.kind);
    if (values.size() != count) {
      fail(kInvalid, kCannotUseFrames, where,
           std::to_string(values.size()) + " numbers given, " + std::to_string(count) + " expected",
           std::string("give one for each ") + target.noun + ", or an object with some by name");
    }
    for (uint32_t i = 0; i < count; ++i) {
      assignments.push_back({i, parse_value(values[i], at_index(where, i))});
    }
  } else if (values.is_object()) {
    for (const auto& [name, value] : values.items()) {
      assignments.push_back(
          {names.find(target, name, where), parse_value(value, where + "[\"" + name + "\"]")});
    }
    refuse_doubles(assignments, names, target, where);
  } else {
    fail(kInvalid, kCannotUseFrames, where,
         std::string("expected ") + (target.takes_indices ? "" : "an array or ") +
             "an object of numbers, not " + values.type_name(),
         "see 'mien eval --help' for an example");
  }
  return assignments;
}

Frame parse_frame(const json& value, ControlNames& names, const std::string& where) {
  if (!value.is_object()) {
    fail(kInvalid, kCannotUseFrames, where,
         std::string("expected an object, not ") + value.type_name(),
         "see 'mien eval --help' for an example");
  }
  Frame frame;
  for (const auto& [key, values] : value.items()) {
    const std::string member = where + "." + key;
    if (key == "raw") {
      frame.raw = parse_assignments(values, names, kRaw, member);
    } else if (key == "gui") {
      frame.gui = parse_assignments(values, names, kGui, member);
      frame.maps_gui = true;
    } else if (key == "ml_mask") {
      frame.masks = parse_assignments(values, names, kMask, member);
    } else if (key != "raw_after_gui" && !is_one_of(key, kIgnoredInFrames)) {
      fail(kInvalid, kCannotUseFrames, where, "a frame has no member \"" + key + "\"",
           nearest_question(key, {"raw", "gui", "raw_after_gui", "ml_mask"},
                            "its members are raw, or gui and raw_after_gui, and ml_mask"));
    }
  }
  if (value.contains("raw") && frame.maps_gui) {
    fail(kInvalid, kCannotUseFrames, where,
         "both raw and gui are given, but mapping gui overwrites raw",
         "leave one out, or write raw_after_gui to set raw controls after the mapping");
  }
  const auto after = value.find("raw_after_gui");
  if (after != value.end()) {
    if (!frame.maps_gui) {
      fail(kInvalid, kCannotUseFrames, where, "raw_after_gui is given without gui",
           "rename it to raw, or add gui");
    }
    frame.raw = parse_assignments(*after, names, kRawAfterGui, where + ".raw_after_gui");
  }
  return frame;
}

void assign(const std::vector<Assignment>& assignments, const MienMutableFloatView& view) {
  for (const Assignment& assignment : assignments) view.data[assignment.index] = assignment.value;
}

}  // namespace

std::vector<Frame> parse_frames(const std::string& text, const MienRig* rig,
                                const std::string& shown, Rate* rate) {
  const json document =
      parse_json<json>(text, kCannotUseFrames, shown, "give one JSON object: {\"frames\": [...]}");
  if (!document.is_object() || !document.contains("frames") || !document["frames"].is_array()) {
    fail(kInvalid, kCannotUseFrames, shown, "there is no list \"frames\"",
         "give one JSON object: {\"frames\": [...]}");
  }
  for (const auto& [key, value] : document.items()) {
    if (key == "frames" || is_one_of(key, kIgnored)) continue;
    fail(kInvalid, kCannotUseFrames, shown, "the key \"" + key + "\" is unknown",
         nearest_question(key, {"frames"}, "give one JSON object: {\"frames\": [...]}"));
  }
  if (rate && document.contains("rate") && document["rate"].is_number()) {
    *rate = parse_rate(document["rate"].dump());
  }
  std::vector<Frame> frames;
  ControlNames names(rig);
  for (const json& value : document["frames"]) {
    frames.push_back(parse_frame(value, names, shown + ", " + at_index("frames", frames.size())));
  }
  return frames;
}

std::vector<Frame> read_frames(const std::string& path, const MienRig* rig) {
  return parse_frames(read_json(path, "cannot read frames"), rig, shown_name(path));
}

void apply_frame(const Frame& frame, const MienRig* rig, MienInstance* instance) {
  const std::string what = "cannot set controls";
  MienMutableFloatView masks{}, gui{}, raw{};
  check(mien_instance_ml_masks(instance, &masks), nullptr, what, "");
  check(mien_instance_gui_controls(instance, &gui), nullptr, what, "");
  check(mien_instance_raw_controls(instance, &raw), nullptr, what, "");
  assign(frame.masks, masks);
  assign(frame.gui, gui);
  if (frame.maps_gui)
    check(mien_rig_map_gui_to_raw(rig, instance), nullptr, "cannot map GUI controls", "");
  assign(frame.raw, raw);
}

}  // namespace mien::cli
