// SPDX-License-Identifier: MIT
#include "integrations/program/speech/take.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/frame_rate.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/take.h"
#include "integrations/program/io/text.h"
#include "integrations/program/speech/prosody.h"

namespace mien::speech {

namespace {

constexpr const char* kCannotSpeak = "cannot speak";
/// The mouth comes to rest after the last sound.
constexpr double kRest = 0.35;
/// Steps of values: fine enough for any face, and rounding hides what the last bits of exp() differ in.
constexpr float kStep = 1.0f / 4096;
constexpr double kTicks = static_cast<double>(MIEN_TICKS_PER_SECOND);
/// The longest closure of one event: docs/mixing.md, 4 "Guards".
constexpr double kLongestClosure = 1;

const char* name_of(Closure closure) {
  switch (closure) {
    case Closure::kLips: return "close:lips";
    case Closure::kLipToTeeth: return "close:lip-to-teeth";
    case Closure::kTeeth: return "close:teeth";
    case Closure::kNone: break;
  }
  return "";
}

void add_events(const std::vector<Phoneme>& phonemes, const std::vector<ClosedTime>& closures,
                SpokenTake& take) {
  const double last = take.curves.time(take.curves.frame_count - 1);
  const auto add = [&](double begin, double end, const std::string& name) {
    if (begin > last) return;
    take.events.push_back(
        {std::llround(std::max(0.0, begin) * kTicks), name, static_cast<float>(end - begin)});
  };
  for (const Phoneme& phoneme : phonemes) add(phoneme.begin, phoneme.end, phoneme.label);
  for (const ClosedTime& closed : closures) {
    for (double begin = closed.begin; begin < closed.end; begin += kLongestClosure) {
      add(begin, std::min(closed.end, begin + kLongestClosure), name_of(closed.closure));
    }
  }
  std::stable_sort(take.events.begin(), take.events.end(),
                   [](const SpokenEvent& a, const SpokenEvent& b) { return a.tick < b.tick; });
}

}  // namespace

SpokenTake make_take(Utterance utterance, Alphabet alphabet, double rate, size_t bytes,
                     const std::string& shown) {
  SpokenTake take;
  Segments found = find_segments(utterance, alphabet);
  take.unknown = std::move(found.unknown);
  if (found.list.empty()) {
    cli::fail(cli::kInvalid, kCannotSpeak, shown,
              take.unknown.empty() ? "there are no phonemes"
                                   : "no label is of a known alphabet, the first is \"" +
                                         cli::one_line(take.unknown[0]) + "\"",
              "give phonemes in IPA, ARPABET or X-SAMPA");
  }
  Curves& curves = take.curves;
  curves.rate = rate;
  curves.controls = speech_controls();
  const double seconds = std::max(utterance.seconds, utterance.phonemes.back().end + kRest);
  curves.frame_count = static_cast<size_t>(std::ceil(seconds * rate)) + 1;
  if (curves.frame_count > cli::most_values(bytes) / curves.controls.size()) {
    cli::fail(cli::kInvalid, kCannotSpeak, shown,
              "it lasts " + cli::duration_text(seconds) + ", which is too long for its size",
              "leave out what is silent, or give a lower --rate");
  }
  curves.values.resize(curves.frame_count * curves.controls.size());
  const std::vector<ClosedTime> closures = find_closures(found.list, rate);
  move_mouth(found.list, find_effort(utterance.phonemes), closures, curves);
  move_upper_face(found.list, utterance.phonemes, curves);
  for (float& value : curves.values) value = std::round(value / kStep) * kStep;
  take.head_up = move_head(found.list, utterance.phonemes, rate, curves.frame_count);
  // Plus 0, so that none is -0, which JSON does not keep.
  for (float& value : take.head_up) value = std::round(value / kStep) * kStep + 0.0f;
  add_events(utterance.phonemes, closures, take);
  return take;
}

void bind(SpokenTake& take, const MienRig* rig, const cli::NamesFile& names,
          const std::string& rig_shown, const cli::Session& session) {
  cli::MatchedNames matched(rig, names, kCannotSpeak);
  Curves bound;
  bound.rate = take.curves.rate;
  bound.frame_count = take.curves.frame_count;
  std::vector<std::vector<std::pair<size_t, float>>> shares(take.curves.controls.size());
  std::vector<uint32_t> raw;
  std::string missing;
  for (size_t c = 0; c < shares.size(); ++c) {
    const cli::MatchedName match = matched.find(take.curves.controls[c]);
    if (!match.found()) missing += (missing.empty() ? "" : ", ") + take.curves.controls[c];
    for (const MienControlShare& share : match.shares) {
      const auto at = std::find(raw.begin(), raw.end(), share.control);
      shares[c].emplace_back(static_cast<size_t>(at - raw.begin()), share.weight);
      if (at == raw.end()) raw.push_back(share.control);
    }
  }
  if (raw.empty()) {
    cli::fail(cli::kInvalid, kCannotSpeak, rig_shown, "the rig has none of the controls of speech",
              "name the rig of a face, or give --names");
  }
  if (!missing.empty()) cli::note(session, rig_shown + ": the rig lacks " + missing);
  matched.note_matched(rig_shown, session);
  for (const uint32_t control : raw) {
    bound.controls.push_back(cli::rig_name(rig, MIEN_KIND_RAW_CONTROL, control));
  }
  bound.values.resize(bound.frame_count * raw.size());
  for (size_t f = 0; f < bound.frame_count; ++f) {
    for (size_t c = 0; c < shares.size(); ++c) {
      for (const auto& [to, weight] : shares[c]) bound.at(f, to) += weight * take.curves.at(f, c);
    }
    for (size_t r = 0; r < raw.size(); ++r) bound.at(f, r) = std::clamp(bound.at(f, r), 0.0f, 1.0f);
  }
  take.curves = std::move(bound);
  take.raw = std::move(raw);
  for (uint32_t i = 0; i < cli::rig_count(rig, MIEN_KIND_RAW_CONTROL); ++i) {
    take.rig_controls.push_back(cli::rig_name(rig, MIEN_KIND_RAW_CONTROL, i));
  }
}

cli::Clip make_clip(const SpokenTake& take, const std::string& shown) {
  const Curves& curves = take.curves;
  const size_t controls = curves.controls.size();
  std::vector<MienStringView> names;
  for (const std::string& name : curves.controls) names.push_back({name.data(), name.size()});
  const std::string head_up = kHeadUp;
  names.push_back({head_up.data(), head_up.size()});
  std::vector<float> values;
  values.reserve(curves.frame_count * names.size());
  for (size_t f = 0; f < curves.frame_count; ++f) {
    const auto row = curves.values.begin() + static_cast<long>(f * controls);
    values.insert(values.end(), row, row + static_cast<long>(controls));
    values.push_back(take.head_up[f]);
  }
  std::vector<MienClipEvent> events;
  for (const SpokenEvent& event : take.events) {
    events.push_back({event.tick, {event.name.data(), event.name.size()}, event.seconds, 0});
  }
  const cli::Rate rate = cli::nearest_rate(curves.rate, 1e-9);
  auto desc = cli::sized<MienClipDesc>();
  desc.rate_numerator = rate.numerator;
  desc.rate_denominator = rate.denominator;
  desc.frame_count = static_cast<uint32_t>(curves.frame_count);
  desc.channel_count = static_cast<uint32_t>(names.size());
  desc.names = names.data();
  desc.values = values.data();
  desc.events = events.data();
  desc.event_count = static_cast<uint32_t>(events.size());
  auto error = cli::sized<MienError>();
  MienClip* made = nullptr;
  cli::check(mien_clip_build(&desc, &made, &error), &error, "cannot build clip", shown);
  return cli::Clip(made);
}

void write_frames(const SpokenTake& take, const std::string& rig_name, cli::Output& output) {
  const Curves& curves = take.curves;
  cli::JsonWriter json(output);
  using Layout = cli::JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  json.member("rig", rig_name);
  json.key("rate");
  json.shortest(curves.rate);
  json.key("controls");
  json.begin_array();
  const bool is_bound = !take.rig_controls.empty();
  for (const std::string& name : is_bound ? take.rig_controls : curves.controls) json.value(name);
  json.end_array();
  json.key("variables");
  json.begin_array();
  json.value(kHeadUp);
  json.end_array();
  json.key("events");
  json.begin_array(Layout::kLines);
  for (const SpokenEvent& event : take.events) {
    json.begin_object();
    json.key("time");
    json.shortest(static_cast<double>(event.tick) / kTicks);
    json.member("layer", "speech");
    json.member("name", event.name);
    json.key("value");
    json.shortest(static_cast<double>(event.seconds));
    json.end_object();
  }
  json.end_array();
  json.key("frames");
  json.begin_array(Layout::kLines);
  std::vector<float> row(take.rig_controls.size());
  for (size_t f = 0; f < curves.frame_count; ++f) {
    json.begin_object();
    json.key("time");
    json.shortest(curves.time(f));
    json.key("raw");
    const float* values = &curves.values[f * curves.controls.size()];
    if (is_bound) {
      for (size_t c = 0; c < take.raw.size(); ++c) row[take.raw[c]] = values[c];
      json.floats(row.data(), row.size());
    } else {
      json.begin_object();
      for (size_t c = 0; c < curves.controls.size(); ++c) {
        json.key(curves.controls[c]);
        json.shortest(static_cast<double>(values[c]));
      }
      json.end_object();
    }
    json.key("variables");
    json.floats(&take.head_up[f], 1);
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

}  // namespace mien::speech
