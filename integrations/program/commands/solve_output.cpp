// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_output.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/json_writer.h"

namespace mien::cli {

namespace {

const char* status_word(uint32_t status) {
  switch (status) {
    case MIEN_FIT_CONVERGED: return "converged";
    case MIEN_FIT_NO_DATA: return "no data";
    default: return "iterations";
  }
}

void write_number(JsonWriter& json, const char* key, double number) {
  json.key(key);
  json.shortest(number);
}

/// What SolvedTake::data are.
const char* data_key(const SolveTarget& target) {
  if (target.points.empty()) return "by_joint";
  return target.point_names.empty() ? "by_region" : "by_landmark";
}

}  // namespace

Frame SolvedTake::pose(size_t frame) const {
  Frame out;
  for (uint32_t c = 0; c < controls.size(); ++c) out.raw.push_back({c, row(frame)[c]});
  return out;
}

void reduce_keys(SolvedTake& take, float tolerance) {
  const size_t frames = take.frames.size(), controls = take.controls.size();
  std::vector<float> curve(frames);
  std::vector<uint32_t> keys(frames);
  for (size_t c = 0; c < controls; ++c) {
    for (size_t f = 0; f < frames; ++f) curve[f] = take.values[f * controls + c];
    size_t count = 0;
    check(mien_fit_keys(curve.data(), frames, tolerance, keys.data(), &count), nullptr,
          "cannot reduce keys", take.controls[c]);
    for (size_t k = 0; k + 1 < count; ++k) {
      const uint32_t from = keys[k], to = keys[k + 1];
      for (uint32_t f = from + 1; f < to; ++f) {
        const float share = static_cast<float>(f - from) / static_cast<float>(to - from);
        take.values[f * controls + c] = curve[from] + (curve[to] - curve[from]) * share;
      }
    }
    take.keys.emplace_back(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(count));
  }
}

void write_solved_json(const SolvedTake& take, Output& output) {
  using Layout = JsonWriter::Layout;
  JsonWriter json(output);
  json.begin_object(Layout::kLines);
  json.member("rig", take.rig);
  write_number(json, "rate", take.rate.hertz());
  json.key("controls");
  json.begin_array();
  for (const std::string& name : take.controls) json.value(name);
  json.end_array();
  for (const char* key : {"variables", "events"}) {
    json.key(key);
    json.begin_array();
    json.end_array();
  }
  if (!take.keys.empty()) {
    json.key("keys");
    json.begin_object(Layout::kLines);
    for (size_t c = 0; c < take.controls.size(); ++c) {
      json.key(take.controls[c]);
      json.begin_array();
      for (const uint32_t key : take.keys[c]) json.value(key);
      json.end_array();
    }
    json.end_object();
  }
  json.key("frames");
  json.begin_array(Layout::kLines);
  for (size_t f = 0; f < take.frames.size(); ++f) {
    json.begin_object();
    write_number(json, "time", static_cast<double>(f) / take.rate.hertz());
    json.key("raw");
    json.floats(take.row(f), take.controls.size());
    json.key("variables");
    json.begin_array();
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

void write_solved_clip(const SolvedTake& take, Output& output) {
  std::vector<MienStringView> names;
  for (const std::string& name : take.controls) names.push_back({name.data(), name.size()});
  auto desc = sized<MienClipDesc>();
  desc.rate_numerator = take.rate.numerator;
  desc.rate_denominator = take.rate.denominator;
  desc.frame_count = static_cast<uint32_t>(take.frames.size());
  desc.channel_count = static_cast<uint32_t>(names.size());
  desc.names = names.data();
  desc.values = take.values.data();
  auto error = sized<MienError>();
  MienClip* made = nullptr;
  check(mien_clip_build(&desc, &made, &error), &error, "cannot build clip", "controls");
  const Clip clip(made);
  size_t size = 0;
  check(mien_clip_write_memory(made, nullptr, 0, &size, &error), &error, "cannot build clip",
        "controls");
  std::vector<char> bytes(size);
  check(mien_clip_write_memory(made, bytes.data(), size, &size, &error), &error,
        "cannot build clip", "controls");
  output.write(bytes.data(), size);
}

void write_solve_report(const SolvedTake& take, const SolveTarget& target, Output& output) {
  using Layout = JsonWriter::Layout;
  double squares = 0, worst = 0;
  uint64_t iterations = 0, keys = 0, missing = 0;
  size_t with_data = 0;
  for (const SolvedFrame& frame : take.frames) {
    iterations += frame.iterations;
    missing += frame.missing;
    if (frame.status == MIEN_FIT_NO_DATA) continue;
    ++with_data;
    squares += frame.rms * frame.rms;
    worst = std::fmax(worst, frame.worst);
  }
  JsonWriter json(output);
  json.begin_object(Layout::kLines);
  json.member("frames", uint64_t{take.frames.size()});
  json.key("residual");
  json.begin_object();
  write_number(json, "rms", with_data ? std::sqrt(squares / static_cast<double>(with_data)) : 0.0);
  write_number(json, "worst", worst);
  json.end_object();
  if (!take.kinds.empty()) {
    json.key("by_kind");
    json.begin_object(Layout::kLines);
    for (const SolvedKind& kind : take.kinds) {
      json.key(kind.name);
      json.begin_object();
      const auto count = static_cast<double>(std::max<size_t>(kind.frame_count, 1));
      write_number(json, "rms", std::sqrt(kind.squares / count));
      write_number(json, "worst", kind.worst);
      json.end_object();
    }
    json.end_object();
  }
  json.key("unobservable");
  json.begin_array();
  for (const std::string& name : take.unobservable) json.value(name);
  json.end_array();
  json.member("missing", missing);
  json.key("jumped");
  json.begin_array();
  for (size_t f = 0; f < take.frames.size(); ++f) {
    if (take.frames[f].jumped) json.value(uint64_t{f});
  }
  json.end_array();
  json.member("iterations", iterations);
  write_number(json, "seconds", take.seconds);
  if (!take.keys.empty()) {
    for (const std::vector<uint32_t>& own : take.keys) keys += own.size();
    json.member("keys", keys);
  }
  json.key(data_key(target));
  json.begin_array(Layout::kLines);
  for (const SolvedDatum& datum : take.data) {
    json.begin_object();
    json.member("name", datum.name);
    write_number(json, "rms", datum.rms);
    write_number(json, "worst", datum.worst);
    json.member("worst_frame", uint64_t{datum.worst_frame});
    json.end_object();
  }
  json.end_array();
  json.key("by_frame");
  json.begin_array(Layout::kLines);
  for (size_t f = 0; f < take.frames.size(); ++f) {
    const SolvedFrame& frame = take.frames[f];
    json.begin_object();
    if (!target.frame_names.empty()) json.member("name", target.frame_names[f]);
    json.member("status", status_word(frame.status));
    write_number(json, "rms", frame.rms);
    write_number(json, "worst", frame.worst);
    json.member("iterations", frame.iterations);
    json.member("missing", frame.missing);
    json.member("jumped", frame.jumped);
    if (take.rigid) {
      json.key("rotation");
      json.floats(frame.rotation, 9);
      json.key("translation");
      json.floats(frame.translation, 3);
      if (frame.focal[0] > 0) {
        json.key("focal");
        json.floats(frame.focal, 2);
      }
    }
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

}  // namespace mien::cli
