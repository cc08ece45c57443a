// SPDX-License-Identifier: MIT
// JSON: the frames of `mien eval`, as `mien play` and `mien clip export` write them.
#include <mien.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/json_check.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/take.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

// Numbers are parsed as floats at once, so that none is rounded twice; objects keep their order.
using json = FloatJson;

constexpr const char* kCannotReadTake = "cannot read take";
constexpr const char* kTakeExample =
    "give one JSON object: {\"frames\": [{\"raw\": {NAME: number}}]}";

const std::vector<std::string> kIgnoredInTake = {"rig", "keys"};
const std::vector<std::string> kIgnoredInTakeFrames = {"stages", "guards"};

struct Reader {
  Take take;
  std::unordered_map<std::string, size_t> channels;
  size_t listed = 0;                   // channels of the list "controls"
  std::vector<std::string> variables;  // the list "variables"
  size_t frames = 0, most_values = 0;

  size_t channel(const std::string& name) {
    const auto [found, is_new] = channels.try_emplace(name, take.names.size());
    if (!is_new) return found->second;
    take.names.push_back(name);
    // Frames need not list all names, but each has a value for all.
    if (take.names.size() > most_values / frames) {
      fail(kInvalid, kCannotReadTake, take.shown,
           "over " + std::to_string(most_values) + " values: " + std::to_string(frames) +
               " frames of " + std::to_string(take.names.size()) + " names or more",
           "make several clips, of fewer names or frames");
    }
    return found->second;
  }
};

float number(const json& value, const std::string& where) {
  if (!value.is_number()) {
    fail(kInvalid, kCannotReadTake, where,
         std::string("expected a number, not ") + value.type_name(), "write a number");
  }
  const auto result = value.get<float>();
  if (!std::isfinite(result)) {
    fail(kInvalid, kCannotReadTake, where, "it is too large for a 32-bit float",
         "controls are usually in 0..1");
  }
  return result;
}

Rate read_rate(const json& value, const std::string& where) {
  Rate rate;
  if (value.is_array() && value.size() == 2 && value[0].is_number_unsigned() &&
      value[1].is_number_unsigned()) {
    rate = parse_rate(value[0].dump() + "/" + value[1].dump());
  } else if (value.is_number()) {
    rate = parse_rate(value.dump());
  }
  if (rate.known()) return rate;
  fail(kInvalid, kCannotReadTake, where, "the rate is " + value.dump(),
       "give frames per second, or [numerator, denominator]");
}

/// Values of a frame, by channel; `row` grows with the channels.
void read_values(Reader& reader, const json& values, const std::string& where,
                 std::vector<float>& row) {
  if (values.is_array()) {
    if (reader.listed == 0) {
      fail(kInvalid, kCannotReadTake, where, "its values have no names",
           "write an object, or a list \"controls\" beside \"frames\"");
    }
    if (values.size() != reader.listed) {
      fail(kInvalid, kCannotReadTake, where,
           std::to_string(values.size()) + " numbers given, \"controls\" names " +
               std::to_string(reader.listed),
           "give one for each name");
    }
    for (size_t c = 0; c < reader.listed; ++c) {
      row[c] = number(values[c], where + "[" + std::to_string(c) + "]");
    }
    return;
  }
  if (!values.is_object()) {
    fail(kInvalid, kCannotReadTake, where,
         std::string("expected an array or an object of numbers, not ") + values.type_name(),
         kTakeExample);
  }
  for (const auto& [name, value] : values.items()) {
    const size_t c = reader.channel(name);
    if (c >= row.size()) row.resize(c + 1);
    row[c] = number(value, where + "[\"" + one_line(name) + "\"]");
  }
}

/// Variables that turn the head become channels; others are no part of a take.
void read_variables(Reader& reader, const json& values, const std::string& where,
                    std::vector<float>& row) {
  if (!values.is_array() || values.size() != reader.variables.size()) return;
  for (size_t v = 0; v < values.size(); ++v) {
    if (!turns_head(reader.variables[v])) continue;
    const size_t c = reader.channel(reader.variables[v]);
    if (c >= row.size()) row.resize(c + 1);
    row[c] = number(values[v], where + "[" + std::to_string(v) + "]");
  }
}

std::vector<float> read_frame(Reader& reader, const json& frame, const std::string& where) {
  if (!frame.is_object()) {
    fail(kInvalid, kCannotReadTake, where,
         std::string("expected an object, not ") + frame.type_name(), kTakeExample);
  }
  std::vector<float> row(reader.take.names.size());
  for (const auto& [key, value] : frame.items()) {
    const std::string member = where + "." + key;
    if (key == "raw" || key == "gui") {
      read_values(reader, value, member, row);
    } else if (key == "variables") {
      read_variables(reader, value, member, row);
    } else if (key == "time") {
      reader.take.times.seconds.push_back(static_cast<double>(number(value, member)));
    } else if (key == "raw_after_gui" || key == "ml_mask") {
      fail(kInvalid, kCannotReadTake, where, "a clip has no " + key,
           "leave it out, or name controls in raw");
    } else if (!is_one_of(key, kIgnoredInTakeFrames)) {
      fail(kInvalid, kCannotReadTake, where, "a frame has no member \"" + one_line(key) + "\"",
           nearest_question(key, {"raw", "gui", "time"}, "its members are raw or gui, and time"));
    }
  }
  return row;
}

void read_controls(Reader& reader, const json& controls) {
  const std::string where = reader.take.shown + ", controls";
  if (!controls.is_array())
    fail(kInvalid, kCannotReadTake, where, "it is not a list", "list the names");
  for (const json& name : controls) {
    if (!name.is_string() || name.get<std::string>().empty()) {
      fail(kInvalid, kCannotReadTake, where, "it is not a list of names", "list the names");
    }
    if (reader.channel(name.get<std::string>()) != reader.listed++) {
      fail(kInvalid, kCannotReadTake, where,
           "\"" + one_line(name.get<std::string>()) + "\" is there twice", "leave one of them out");
    }
  }
}

/// Where the time is a tick, that counts: a time in seconds was read as a 32-bit float.
int64_t read_tick(const json& event, const std::string& where) {
  const auto bad = [&](const std::string& what) {
    fail(kInvalid, kCannotReadTake, where, what,
         "an event has a time in seconds, from 0 on, or a tick");
  };
  if (event.contains("tick")) {
    const json& tick = event["tick"];
    if (!tick.is_number_integer() || tick.get<int64_t>() < 0) bad("its tick is " + tick.dump());
    return tick.get<int64_t>();
  }
  if (!event.contains("time")) bad("it has no time");
  const double seconds = static_cast<double>(number(event["time"], where + ".time"));
  constexpr double kMost = 1e9;  // ticks of as many seconds are 64-bit integers
  if (!(seconds >= 0 && seconds < kMost)) bad("its time is " + event["time"].dump());
  return std::llround(seconds * static_cast<double>(MIEN_TICKS_PER_SECOND));
}

TakeEvent read_event(const json& event, const std::string& where) {
  constexpr const char* kEvent =
      "an event is {\"time\": seconds, \"name\": NAME, \"value\": number}";
  if (!event.is_object()) {
    fail(kInvalid, kCannotReadTake, where,
         std::string("expected an object, not ") + event.type_name(), kEvent);
  }
  for (const auto& [key, value] : event.items()) {
    if (is_one_of(key, {"time", "tick", "name", "value", "layer"})) continue;
    fail(kInvalid, kCannotReadTake, where, "an event has no member \"" + one_line(key) + "\"",
         nearest_question(key, {"time", "tick", "name", "value"}, kEvent));
  }
  if (!event.contains("name") || !event["name"].is_string() ||
      event["name"].get<std::string>().empty()) {
    fail(kInvalid, kCannotReadTake, where, "it has no name", kEvent);
  }
  const float value = event.contains("value") ? number(event["value"], where + ".value") : 0.0f;
  return {read_tick(event, where), event["name"].get<std::string>(), value};
}

void read_events(Reader& reader, const json& events) {
  const std::string where = reader.take.shown + ", events";
  if (!events.is_array())
    fail(kInvalid, kCannotReadTake, where, "it is not a list", "list the events");
  for (const json& event : events) {
    const std::string place = where + "[" + std::to_string(reader.take.events.size()) + "]";
    reader.take.events.push_back(read_event(event, place));
  }
}

}  // namespace

Take parse_json_take(std::string_view text, const std::string& shown) {
  Reader reader;
  Take& take = reader.take;
  take.shown = shown;
  const json document = parse_json<json>(text, kCannotReadTake, shown, kTakeExample);
  if (!document.contains("frames") || !document["frames"].is_array() ||
      document["frames"].empty()) {
    fail(kInvalid, kCannotReadTake, shown, "there is no list \"frames\" with a frame",
         kTakeExample);
  }
  reader.frames = document["frames"].size();
  reader.most_values = most_values(text.size());
  for (const auto& [key, value] : document.items()) {
    if (key == "rate") {
      take.rate = read_rate(value, shown + ", rate");
    } else if (key == "controls") {
      read_controls(reader, value);
    } else if (key == "variables") {
      for (const json& name : value) {
        reader.variables.push_back(name.is_string() ? name.get<std::string>() : std::string());
      }
    } else if (key == "events") {
      read_events(reader, value);
    } else if (key != "frames" && !is_one_of(key, kIgnoredInTake)) {
      fail(kInvalid, kCannotReadTake, shown, "the key \"" + one_line(key) + "\" is unknown",
           nearest_question(key, {"frames", "rate", "controls", "events"}, kTakeExample));
    }
  }
  std::vector<std::vector<float>> rows;
  for (const json& frame : document["frames"]) {
    rows.push_back(
        read_frame(reader, frame, shown + ", frames[" + std::to_string(rows.size()) + "]"));
  }
  take.row_count = rows.size();
  for (std::vector<float>& row : rows) {
    row.resize(take.names.size());
    take.values.insert(take.values.end(), row.begin(), row.end());
    row = {};
  }
  // Times are there for readers; the rate counts.
  std::vector<double>& seconds = take.times.seconds;
  const bool ascend = std::adjacent_find(seconds.begin(), seconds.end(), [](double a, double b) {
                        return b <= a;
                      }) == seconds.end();
  if (!seconds.empty() && (seconds.size() != rows.size() || !ascend)) {
    fail(kInvalid, kCannotReadTake, shown, "not all frames have a time, or the times do not ascend",
         "give all of them, or none and \"rate\"");
  }
  // 32-bit floats are what times were read as.
  if (!seconds.empty()) take.times.precision = std::abs(seconds.back()) * 6e-8;
  return std::move(reader.take);
}

}  // namespace mien::cli
