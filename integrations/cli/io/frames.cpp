// SPDX-License-Identifier: MIT
#include "integrations/cli/io/frames.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "integrations/cli/io/failure.h"
#include "integrations/cli/io/nearest_name.h"
#include "integrations/cli/io/output.h"
#include "integrations/cli/io/rig_file.h"

namespace mien::cli {

namespace {

using nlohmann::json;

constexpr const char* kCannot = "cannot use frames";

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

std::string at_index(const std::string& where, size_t index) {
  return where + "[" + std::to_string(index) + "]";
}

float parse_value(const json& value, const std::string& where) {
  if (!value.is_number()) {
    fail(kInvalid, kCannot, where, std::string("expected a number, not ") + value.type_name(),
         "write a number");
  }
  const auto number = static_cast<float>(value.get<double>());
  if (!std::isfinite(number)) {
    fail(kInvalid, kCannot, where, value.dump() + " is too large for a 32-bit float",
         "controls are usually in 0..1");
  }
  return number;
}

uint32_t find_control(const MienRig* rig, const Target& target, const std::string& name,
                      const std::string& where) {
  uint32_t index = 0;
  if (mien_rig_find_n(rig, target.kind, name.data(), name.size(), &index) == MIEN_OK) return index;
  const uint32_t count = rig_count(rig, target.kind);

  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, index);
  const bool is_number = stop == end && !name.empty() && error != std::errc::invalid_argument;
  if (target.takes_indices && is_number) {
    if (error == std::errc() && index < count) return index;
    fail(kInvalid, kCannot, where,
         "index " + name + " is out of range: the rig has " + std::to_string(count) + " " +
             target.noun + "s",
         "count from 0");
  }

  NearestName nearest(name);
  for (uint32_t i = 0; i < count; ++i) nearest.offer(rig_name(rig, target.kind, i));
  fail(kInvalid, kCannot, where, std::string("no ") + target.noun + " is named \"" + name + "\"",
       nearest.question(std::string("'mien info RIG ") + target.names + "' lists the names"));
}

/// An array with all numbers in order, or an object with some by name.
std::vector<Assignment> parse_assignments(const json& values, const MienRig* rig,
                                          const Target& target, const std::string& where) {
  std::vector<Assignment> assignments;
  if (values.is_array() && !target.takes_indices) {
    const uint32_t count = rig_count(rig, target.kind);
    if (values.size() != count) {
      fail(kInvalid, kCannot, where,
           std::to_string(values.size()) + " numbers given, " + std::to_string(count) + " expected",
           std::string("give one for each ") + target.noun + ", or an object with some by name");
    }
    for (uint32_t i = 0; i < count; ++i) {
      assignments.push_back({i, parse_value(values[i], at_index(where, i))});
    }
  } else if (values.is_object()) {
    for (const auto& [name, value] : values.items()) {
      assignments.push_back({find_control(rig, target, name, where),
                             parse_value(value, where + "[\"" + name + "\"]")});
    }
  } else {
    fail(kInvalid, kCannot, where,
         std::string("expected ") + (target.takes_indices ? "" : "an array or ") +
             "an object of numbers, not " + values.type_name(),
         "see 'mien eval --help' for an example");
  }
  return assignments;
}

Frame parse_frame(const json& value, const MienRig* rig, const std::string& where) {
  if (!value.is_object()) {
    fail(kInvalid, kCannot, where, std::string("expected an object, not ") + value.type_name(),
         "see 'mien eval --help' for an example");
  }
  Frame frame;
  for (const auto& [key, values] : value.items()) {
    const std::string member = where + "." + key;
    if (key == "raw") {
      frame.raw = parse_assignments(values, rig, kRaw, member);
    } else if (key == "gui") {
      frame.gui = parse_assignments(values, rig, kGui, member);
      frame.maps_gui = true;
    } else if (key == "ml_mask") {
      frame.masks = parse_assignments(values, rig, kMask, member);
    } else if (key != "raw_after_gui") {
      fail(kInvalid, kCannot, where, "a frame has no member \"" + key + "\"",
           nearest_question(key, {"raw", "gui", "raw_after_gui", "ml_mask"},
                            "its members are raw, or gui and raw_after_gui, and ml_mask"));
    }
  }
  if (value.contains("raw") && frame.maps_gui) {
    fail(kInvalid, kCannot, where, "both raw and gui are given, but mapping gui overwrites raw",
         "leave one out, or write raw_after_gui to set raw controls after the mapping");
  }
  const auto after = value.find("raw_after_gui");
  if (after != value.end()) {
    if (!frame.maps_gui) {
      fail(kInvalid, kCannot, where, "raw_after_gui is given without gui",
           "rename it to raw, or add gui");
    }
    frame.raw = parse_assignments(*after, rig, kRawAfterGui, where + ".raw_after_gui");
  }
  return frame;
}

json parse_json(const std::string& text, const std::string& shown) {
  // Messages of the parser begin with a tag in brackets.
  const auto plain = [](const json::exception& error) {
    const std::string message = error.what();
    const size_t tag = message.find("] ");
    return tag == std::string::npos ? message : message.substr(tag + 2);
  };
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    fail(kInvalid, kCannot, shown + ", byte " + std::to_string(error.byte), plain(error),
         "give one JSON object: {\"frames\": [...]}");
  } catch (const json::exception& error) {  // a number past the range of a double
    fail(kInvalid, kCannot, shown, plain(error), "give finite numbers only");
  }
}

std::string read_text(const std::string& path) {
  if (path == "-") return read_standard_input();
  FILE* stream = std::fopen(path.c_str(), "rb");
  std::string text;
  char block[65536];
  size_t count;
  while (stream && (count = std::fread(block, 1, sizeof(block), stream)) != 0)
    text.append(block, count);
  const bool good = stream && !std::ferror(stream);
  const int reason = errno;
  if (stream) std::fclose(stream);
  if (!good) {
    fail(kFile, "cannot read frames", path, std::strerror(reason),
         "check the path and its permissions");
  }
  return text;
}

void assign(const std::vector<Assignment>& assignments, const MienMutableFloatView& view) {
  for (const Assignment& assignment : assignments) view.data[assignment.index] = assignment.value;
}

}  // namespace

std::vector<Frame> parse_frames(const std::string& text, const MienRig* rig,
                                const std::string& shown) {
  const json document = parse_json(text, shown);
  if (!document.is_object() || !document.contains("frames") || !document["frames"].is_array()) {
    fail(kInvalid, kCannot, shown, "there is no list \"frames\"",
         "give one JSON object: {\"frames\": [...]}");
  }
  std::vector<Frame> frames;
  for (const json& value : document["frames"]) {
    frames.push_back(parse_frame(value, rig, shown + ", " + at_index("frames", frames.size())));
  }
  return frames;
}

std::vector<Frame> read_frames(const std::string& path, const MienRig* rig) {
  return parse_frames(read_text(path), rig, shown_name(path));
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
