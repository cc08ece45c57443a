// SPDX-License-Identifier: MIT
#include "integrations/program/play/recording.h"

#include <algorithm>
#include <charconv>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/frame_rate.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/take.h"
#include "integrations/program/io/text.h"
#include "integrations/program/play/curves_svg.h"

namespace mien::cli {

namespace {

bool knows(const GuardFacts& guard, uint16_t curve) {
  return std::find(guard.controls.begin(), guard.controls.end(), curve) != guard.controls.end();
}

/// Guards that had something to hold back in a frame, of those that know a watched curve.
void write_guards(const Performance& performance, const Recording& recording, size_t frame,
                  JsonWriter& json) {
  const std::vector<GuardFacts>& guards = performance.guards();
  json.key("guards");
  json.begin_object();
  for (size_t g = 0; g < guards.size(); ++g) {
    const GuardFrame& state = recording.guards[frame][g];
    const auto known = [&](uint16_t curve) { return knows(guards[g], curve); };
    if (!state.acts() || std::none_of(recording.watched.begin(), recording.watched.end(), known)) {
      continue;
    }
    json.key(guards[g].name);
    json.begin_object();
    const auto number = [&](const char* key, float value) {
      json.key(key);
      json.shortest(static_cast<double>(value));
    };
    number("activation", state.activation);
    number("wanted_mm", state.wanted);
    number("limit_mm", state.limit);
    number("distance_mm", state.distance);
    json.end_object();
  }
  json.end_object();
}

/// The guards that held a curve back, as words below its name.
std::string holders(const Performance& performance, const Recording& recording, size_t watched) {
  const std::vector<std::string>& stages = performance.stages();
  const auto at = std::find(stages.begin(), stages.end(), "guards");
  const auto stage = static_cast<size_t>(at - stages.begin());
  if (stage == 0 || at == stages.end()) return "";
  const uint16_t curve = recording.watched[watched];
  std::string text;
  for (size_t g = 0; g < performance.guards().size(); ++g) {
    const GuardFacts& guard = performance.guards()[g];
    bool held = false;
    for (size_t f = 0; f < recording.times.size() && !held && knows(guard, curve); ++f) {
      const float* values = &recording.stages[f][watched * stages.size()];
      held = values[stage] != values[stage - 1] && recording.guards[f][g].acts();
    }
    if (held) text += (text.empty() ? "held: " : ", ") + guard.name;
  }
  return text;
}

}  // namespace

Frame Recording::shown_frame(size_t number, size_t raw_count) const {
  const size_t curve_count = rows.size() / times.size();
  Frame frame;
  for (uint32_t i = 0; i < raw_count; ++i) frame.raw.push_back({i, rows[number * curve_count + i]});
  if (!heads.empty()) frame.head = heads[number];
  return frame;
}

void write_json(const std::string& rig_name, const Performance& performance,
                const Recording& recording, bool stages, Output& output) {
  const std::vector<uint16_t>& watched = recording.watched;
  const RigCurves& curves = performance.curves();
  const size_t controls = curves.controls().size(), count = curves.count();
  JsonWriter json(output);
  using Layout = JsonWriter::Layout;
  const auto list = [&](const char* key, const std::vector<std::string>& names) {
    json.key(key);
    json.begin_array();
    for (const std::string& name : names) json.value(name);
    json.end_array();
  };
  json.begin_object(Layout::kLines);
  json.member("rig", rig_name);
  json.key("rate");
  json.shortest(recording.rate);
  list("controls", curves.controls());
  list("variables", curves.variables());
  json.key("events");
  json.begin_array(Layout::kLines);
  for (const FiredEvent& event : performance.events()) {
    json.begin_object();
    json.key("time");
    json.shortest(event.time);
    json.member("layer", event.layer);
    json.member("name", event.name);
    json.key("value");
    json.shortest(static_cast<double>(event.value));
    json.end_object();
  }
  json.end_array();
  json.key("frames");
  json.begin_array(Layout::kLines);
  const size_t stage_count = performance.stages().size();
  for (size_t f = 0; f < recording.times.size(); ++f) {
    json.begin_object();
    json.key("time");
    json.shortest(recording.times[f]);
    const float* row = &recording.rows[f * count];
    json.key("raw");
    json.floats(row, controls);
    json.key("variables");
    json.floats(row + controls, count - controls);
    if (stages && !watched.empty()) {
      json.key("stages");
      json.begin_object();
      for (size_t w = 0; w < watched.size(); ++w) {
        json.key(watched[w] < controls ? short_name(curves.controls()[watched[w]])
                                       : curves.variables()[watched[w] - controls]);
        json.begin_array();
        for (size_t s = 0; s < stage_count; ++s) {
          json.begin_array();
          json.value(performance.stages()[s]);
          json.shortest(static_cast<double>(recording.stages[f][w * stage_count + s]));
          json.end_array();
        }
        json.end_array();
      }
      json.end_object();
      write_guards(performance, recording, f, json);
    }
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

void write_csv(const Performance& performance, const Recording& recording, Output& output) {
  const RigCurves& curves = performance.curves();
  std::string text = "time";
  for (const std::string& name : curves.controls()) text += "," + csv_field(name);
  text += "\n";
  char digits[64];
  const auto append = [&](auto number) {
    text.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  };
  for (size_t f = 0; f < recording.times.size(); ++f) {
    append(recording.times[f]);
    for (size_t c = 0; c < curves.controls().size(); ++c) {
      text += ',';
      append(recording.rows[f * curves.count() + c]);
    }
    text += '\n';
    output.write(text);
    text.clear();
  }
}

void write_clip(const Performance& performance, const Recording& recording,
                const std::string& shown, Output& output) {
  const RigCurves& curves = performance.curves();
  std::vector<MienStringView> names;
  std::vector<size_t> kept;  // curves: all controls, and the variables that turn the head
  const auto keep = [&](const std::string& name, size_t curve) {
    names.push_back({name.data(), name.size()});
    kept.push_back(curve);
  };
  for (const std::string& name : curves.controls()) keep(name, kept.size());
  for (size_t v = 0; v < curves.variables().size(); ++v) {
    if (turns_head(curves.variables()[v])) {
      keep(curves.variables()[v], curves.controls().size() + v);
    }
  }
  std::vector<float> values;
  values.reserve(recording.times.size() * kept.size());
  for (size_t f = 0; f < recording.times.size(); ++f) {
    for (const size_t curve : kept) values.push_back(recording.rows[f * curves.count() + curve]);
  }
  const Rate fraction = nearest_rate(recording.rate, 1e-9);
  auto desc = sized<MienClipDesc>();
  desc.rate_numerator = fraction.numerator;
  desc.rate_denominator = fraction.denominator;
  desc.frame_count = static_cast<uint32_t>(recording.times.size());
  desc.channel_count = static_cast<uint32_t>(names.size());
  desc.names = names.data();
  desc.values = values.data();
  auto error = sized<MienError>();
  MienClip* made = nullptr;
  check(mien_clip_build(&desc, &made, &error), &error, "cannot build clip", shown);
  const Clip clip(made);
  size_t size = 0;
  check(mien_clip_write_memory(made, nullptr, 0, &size, &error), &error, "cannot build clip",
        shown);
  std::vector<char> bytes(size);
  check(mien_clip_write_memory(made, bytes.data(), size, &size, &error), &error,
        "cannot build clip", shown);
  output.write(bytes.data(), size);
}

void keep_moving(const Performance& performance, Recording& recording) {
  std::vector<uint16_t>& watched = recording.watched;
  const size_t stage_count = performance.stages().size(), count = performance.curves().count();
  std::vector<size_t> kept;
  for (size_t w = 0; w < watched.size(); ++w) {
    bool moves = false;
    for (size_t f = 0; f < recording.times.size() && !moves; ++f) {
      moves = recording.rows[f * count + watched[w]] != recording.rows[watched[w]];
    }
    if (moves) kept.push_back(w);
  }
  for (std::vector<float>& stages : recording.stages) {
    std::vector<float> left;
    for (size_t w : kept) {
      const auto first = stages.begin() + static_cast<std::ptrdiff_t>(w * stage_count);
      left.insert(left.end(), first, first + static_cast<std::ptrdiff_t>(stage_count));
    }
    stages = std::move(left);
  }
  std::vector<uint16_t> moving;
  for (size_t w : kept) moving.push_back(watched[w]);
  watched = std::move(moving);
}

void write_svg(const Performance& performance, const Recording& recording, Output& output) {
  const std::vector<uint16_t>& watched = recording.watched;
  const RigCurves& curves = performance.curves();
  const size_t frames = recording.times.size(), stage_count = performance.stages().size();
  std::vector<CurvePlot> plots;
  for (size_t w = 0; w < watched.size(); ++w) {
    const size_t curve = watched[w], controls = curves.controls().size();
    CurvePlot plot;
    plot.name = curve < controls ? std::string(short_name(curves.controls()[curve]))
                                 : curves.variables()[curve - controls];
    plot.stages.assign(stage_count, std::vector<float>(frames));
    for (size_t f = 0; f < frames; ++f) {
      plot.values.push_back(recording.rows[f * curves.count() + curve]);
      for (size_t s = 0; s < stage_count; ++s) {
        plot.stages[s][f] = recording.stages[f][w * stage_count + s];
      }
    }
    plot.note = holders(performance, recording, w);
    plots.push_back(std::move(plot));
  }
  std::vector<GuardPlot> guards;
  for (size_t g = 0; g < performance.guards().size(); ++g) {
    GuardPlot plot;
    plot.name = performance.guards()[g].name;
    bool acts = false;
    for (const std::vector<GuardFrame>& frame : recording.guards) {
      acts = acts || frame[g].acts();
      plot.activation.push_back(frame[g].activation);
      plot.wanted.push_back(frame[g].wanted);
      plot.limit.push_back(frame[g].limit);
      plot.distance.push_back(frame[g].distance);
    }
    if (acts) guards.push_back(std::move(plot));
  }
  output.write(
      curves_svg(plots, performance.stages(), guards, recording.captions, recording.times.back()));
}

}  // namespace mien::cli
