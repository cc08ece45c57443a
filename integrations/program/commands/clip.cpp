// SPDX-License-Identifier: MIT
// mien clip: curves of controls <-> clips.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/bound_clip.h"
#include "integrations/program/io/clip_file.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/take.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct BuildOptions {
  std::string input, rate, snap, tolerance, rig, names, loop = "clamp", channels, minus;
  std::vector<std::string> closures;
  bool resample = false;
  OutputFile output;
};

struct ClipOptions {
  std::string clip;
  bool json = false;
  OutputFile output;
};

// Building ----------------------------------------------------------------------------------------

float parse_snap(const std::string& word) {
  if (word.empty()) return 0;
  // As a fraction, a power or a decimal: 1/2048, 2^-11, 0.00048828125.
  double step = 0;
  const bool is_fraction = word.compare(0, 2, "1/") == 0, is_power = word.compare(0, 3, "2^-") == 0;
  const char *begin = word.data() + (is_fraction ? 2
                                     : is_power  ? 3
                                                 : 0),
             *end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(begin, end, step);
  const bool parsed = error == std::errc() && stop == end;
  if (is_fraction) step = 1 / step;
  if (is_power) step = std::exp2(-step);
  int exponent = 0;
  const bool is_step = std::frexp(step, &exponent) == 0.5 && exponent >= -15 && exponent <= -8;
  if (parsed && (step == 0 || is_step)) return static_cast<float>(step);
  fail_usage("--snap \"" + word + "\"", "not a step from 1/65536 to 1/512",
             "give a power of two, such as 1/2048, or 0 to keep every bit");
}

Rate parse_rate_option(const std::string& word) {
  if (word.empty()) return {};
  const Rate rate = parse_rate(word);
  if (rate.known()) return rate;
  fail_usage("--rate \"" + word + "\"", "not a number of frames per second",
             "give one such as 60, 29.97 or 30000/1001");
}

[[noreturn]] void fail_off(const Take& take, const Rate& rate, size_t row) {
  const double expected = take.times.seconds[0] + static_cast<double>(row) / rate.hertz();
  char text[160];
  snprintf(text, sizeof(text),
           "its time is %.6g s after the first row, at %s frames per second it would be %.6g s",
           take.times.seconds[row] - take.times.seconds[0], rate_text(rate).c_str(),
           expected - take.times.seconds[0]);
  fail(kInvalid, "cannot build clip", take.row_name(row), text,
       "give the right --rate, or --resample to interpolate");
}

/// Every row of the app becomes a frame, also where it left frames out.
void note_drift(const std::vector<double>& seconds, const Rate& rate, const Session& session) {
  double most = 0;
  for (size_t i = 0; i < seconds.size(); ++i) {
    const double shown = seconds[0] + static_cast<double>(i) / rate.hertz();
    most = std::max(most, std::abs(seconds[i] - shown));
  }
  if (most <= 1.5 / rate.hertz()) return;
  char text[200];
  snprintf(text, sizeof(text),
           "%.3f s were recorded, the clip takes %.3f s: every row is a frame, up to %.3f s from "
           "its time; --resample --rate 60 keeps the times",
           seconds.back() - seconds.front(), static_cast<double>(seconds.size() - 1) / rate.hertz(),
           most);
  note(session, text);
}

/// The rate of the clip; the rows lie on it afterwards.
Rate settle_rate(Take& take, const Rate& wanted, bool with_resampling, const Session& session) {
  Rate rate = wanted.known() ? wanted : take.rate;
  if (take.times.seconds.empty()) {
    if (with_resampling) {
      fail(kInvalid, "cannot build clip", take.shown, "there are no times to resample",
           "leave out --resample");
    }
    return rate.known() ? rate : Rate{60, 1};
  }
  if (!rate.known()) {
    rate = take.is_live_link ? find_drifting_rate(take.times) : find_rate(take.times);
  }
  if (!rate.known()) {
    fail(kInvalid, "cannot build clip", take.shown,
         "its rows are less than a microsecond or more than 6 seconds apart",
         "give --rate and --resample, and times in seconds");
  }
  if (with_resampling) {
    resample(take, rate);
  } else if (take.is_live_link) {
    note_drift(take.times.seconds, rate, session);
  } else {
    const size_t off = first_row_off(take.times, rate);
    if (off < take.row_count) fail_off(take, rate, off);
  }
  return rate;
}

/// Millimeters.
float parse_tolerance(const std::string& word) {
  if (word.empty()) return 0.02f;
  float tolerance = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, tolerance);
  if (error == std::errc() && stop == end && tolerance > 0 && std::isfinite(tolerance)) {
    return tolerance;
  }
  fail_usage("--tolerance \"" + word + "\"", "not a number of millimeters above 0",
             "give a number such as 0.02");
}

Clip built(const MienClipDesc& desc, const Take& take) {
  auto error = sized<MienError>();
  MienClip* made = nullptr;
  check(mien_clip_build(&desc, &made, &error), &error, "cannot build clip", take.shown);
  return Clip(made);
}

/// A step for each channel of which half moves no vertex of a rig by more than the tolerance.
std::vector<float> steps_on_rig(const Clip& clip, const Take& take, const BuildOptions& options,
                                float tolerance, const Session& session) {
  const std::string& path = options.rig;
  std::optional<BakedFile> baked;
  std::optional<RigFile> dna;
  Rig made;
  Deformer compiled;
  const MienRig* rig = nullptr;
  const MienDeformer* deformer = nullptr;
  auto error = sized<MienError>();
  if (is_baked_file(path)) {
    baked = open_baked_rig(path, LoadOptions{}, RigOptions{});
    rig = baked->rig.get();
    deformer = baked->deformer.get();
  } else {
    dna = open_rig_file(
        path, parse_load_options(LoadOptions{}, kEvaluationLayers | MIEN_LAYER_GEOMETRY), session);
    made = create_rig(*dna, parse_rig_options(RigOptions{}));
    rig = made.get();
    MienDeformer* created = nullptr;
    check(mien_deformer_create(dna->dna.get(), rig, nullptr, &created, &error), &error,
          "cannot compile geometry", dna->shown);
    compiled.reset(created);
    deformer = created;
  }
  if (!deformer) {
    fail(kInvalid, "cannot measure steps", path, "the baked file has no geometry",
         "bake it with its geometry, or give the DNA file");
  }
  const ClipBinding binding =
      bind_clip(clip.get(), rig, NamesFile(options.names), "cannot bind clip", take.shown, session);
  const MienClipBindingInfo info = binding_info(binding.get());
  std::vector<float> steps(info.channel_count);
  check(mien_clip_binding_snaps(binding.get(), deformer, tolerance, steps.data(), steps.size(),
                                &error),
        &error, "cannot measure steps", path);
  if (info.missing_channels.count != 0) {
    note(session,
         std::to_string(info.missing_channels.count) + " of " + std::to_string(take.names.size()) +
             " channels drive nothing on the rig and are rounded to 1/2048, the first is " +
             one_line(take.names[info.missing_channels.data[0]]));
  }
  return steps;
}

/// Subtracts, channel by channel, a frame of the take or the frames of a clip, of which the last one stays.
void subtract(Take& take, const std::string& minus, const Session& session) {
  const size_t channels = take.names.size();
  if (minus == "nothing") return;
  size_t frame = 0;
  const char* const end = minus.data() + minus.size();
  const auto [stop, error] = std::from_chars(minus.data(), end, frame);
  if (error == std::errc() && stop == end) {
    if (frame >= take.row_count) {
      fail(kInvalid, "cannot build clip", take.shown,
           "there is no frame " + minus + " among its " + grouped(take.row_count) + " frames",
           "give a lower number to --minus; the first frame is 0");
    }
    const std::vector<float> row(take.values.begin() + static_cast<long>(frame * channels),
                                 take.values.begin() + static_cast<long>((frame + 1) * channels));
    for (size_t i = 0; i < take.values.size(); ++i) take.values[i] -= row[i % channels];
    return;
  }
  const ClipFile from = open_clip_file(minus);
  const std::vector<std::string> names = channel_names(from);
  std::vector<size_t> at(channels, names.size());
  size_t known = 0;
  for (size_t c = 0; c < channels; ++c) {
    const auto found = std::find(names.begin(), names.end(), take.names[c]);
    at[c] = static_cast<size_t>(found - names.begin());
    known += found != names.end();
  }
  if (known == 0) {
    fail(kInvalid, "cannot build clip", take.shown,
         "it has no channel in common with " + one_line(from.shown), "name another clip");
  }
  if (known < channels) {
    note(session, one_line(from.shown) + ": lacks " + grouped(channels - known) + " of " +
                      grouped(channels) + " channels, from which nothing is subtracted");
  }
  const auto use = [&](size_t row, const float* values) {
    for (size_t c = 0; c < channels; ++c) {
      if (at[c] < names.size()) take.values[row * channels + c] -= values[at[c]];
    }
  };
  for_each_frame(from, [&](uint32_t f, const float* values) {
    if (f < take.row_count) use(f, values);
    for (size_t row = f + 1; f + 1 == from.info.frame_count && row < take.row_count; ++row) {
      use(row, values);
    }
  });
}

std::string seconds_text(int64_t ticks) {
  char text[40];
  snprintf(text, sizeof(text), "%.6g",
           static_cast<double>(ticks) / static_cast<double>(MIEN_TICKS_PER_SECOND));
  return text;
}

/// The events of a take, which are within its frames. Names stay in the take.
std::vector<MienClipEvent> events_of(const Take& take, const Rate& rate) {
  // As clips round it; of wild rates building says more.
  const int64_t twice = 2 * int64_t{MIEN_TICKS_PER_SECOND} * rate.denominator / rate.numerator;
  const int64_t frame = std::max<int64_t>((twice + 1) / 2, 1);
  std::vector<MienClipEvent> events;
  for (const TakeEvent& event : take.events) {
    if (event.tick / frame >= static_cast<int64_t>(take.row_count)) {
      fail(kInvalid, "cannot build clip",
           take.shown + ", events[" + std::to_string(events.size()) + "]",
           "it comes after the last of " + grouped(take.row_count) + " frames, at " +
               seconds_text(event.tick) + " s",
           "leave it out, or add frames");
    }
    events.push_back({event.tick, {event.name.data(), event.name.size()}, event.value, 0});
  }
  return events;
}

void run_build(const BuildOptions& options, const Session& session) {
  const float snap = parse_snap(options.snap);
  const float tolerance = parse_tolerance(options.tolerance);
  if (options.rig.empty() && !options.tolerance.empty()) {
    fail_usage("--tolerance", "no rig to measure on", "add --rig RIG");
  }
  if (options.rig.empty() && !options.names.empty()) {
    fail_usage("--names", "a clip keeps the names of its take",
               "add --rig RIG, whose controls they mean");
  }
  if (!options.rig.empty() && !options.snap.empty()) {
    fail_usage("--snap", "--rig finds the steps", "leave out one of them");
  }
  const Rate wanted = parse_rate_option(options.rate);
  const size_t loop = parse_word("--loop", options.loop);
  refuse_terminal(options.output.path, session, "a clip");
  refuse_replacing(options.output, {options.input});
  Take take = parse_take(read_text(options.input, "cannot read take"), shown_name(options.input));
  if (!options.channels.empty()) keep_channels(take, options.channels);
  for (const std::string& closure : options.closures) {
    if (add_closures(take, closure) != 0) continue;
    note(session, "--close " + one_line(closure) + ": no event has one of these names");
  }
  const Rate rate = settle_rate(take, wanted, options.resample, session);
  if (!options.minus.empty()) subtract(take, options.minus, session);

  std::vector<MienStringView> names;
  for (const std::string& name : take.names) names.push_back({name.data(), name.size()});
  auto desc = sized<MienClipDesc>();
  desc.rate_numerator = rate.numerator;
  desc.rate_denominator = rate.denominator;
  desc.frame_count = static_cast<uint32_t>(std::min<size_t>(take.row_count, UINT32_MAX));
  desc.channel_count = static_cast<uint32_t>(std::min<size_t>(names.size(), UINT32_MAX));
  desc.names = names.data();
  desc.values = take.values.data();
  desc.snap = snap;
  const std::vector<MienClipEvent> events = events_of(take, rate);
  desc.events = events.data();
  desc.event_count = static_cast<uint32_t>(std::min<size_t>(events.size(), UINT32_MAX));
  desc.is_delta = options.minus.empty() ? 0 : 1;
  desc.looping = loop == 0 ? MIEN_LOOPING_CLAMP : MIEN_LOOPING_WRAP;
  Clip clip = built(desc, take);
  std::vector<float> steps;
  if (!options.rig.empty()) {
    steps = steps_on_rig(clip, take, options, tolerance, session);
    desc.snaps = steps.data();
    clip = built(desc, take);
  }
  auto error = sized<MienError>();
  size_t size = 0;
  check(mien_clip_write_memory(clip.get(), nullptr, 0, &size, &error), &error, "cannot build clip",
        take.shown);
  std::vector<char> bytes(size);
  check(mien_clip_write_memory(clip.get(), bytes.data(), size, &size, &error), &error,
        "cannot build clip", take.shown);
  Output output(options.output.path);
  output.write(bytes.data(), size);
  output.commit();
}

// Looking into clips ------------------------------------------------------------------------------

uint64_t raw_bytes(const MienClipInfo& info) {
  return uint64_t{info.frame_count} * info.channel_count * sizeof(float);
}

double ratio(const MienClipInfo& info) {
  return static_cast<double>(raw_bytes(info)) / static_cast<double>(info.file_bytes);
}

const char* loop_word(const MienClipInfo& info) {
  return info.looping == MIEN_LOOPING_WRAP ? "wrap" : "clamp";
}

void write_json(const ClipFile& file, Output& output) {
  const MienClipInfo& info = file.info;
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.key("rate");
  json.begin_array();
  json.value(info.rate_numerator);
  json.value(info.rate_denominator);
  json.end_array();
  json.member("frames", info.frame_count);
  json.key("channels");
  json.begin_array();
  for (const std::string& name : channel_names(file)) json.value(name);
  json.end_array();
  json.member("changing_channels", info.changing_channel_count);
  json.member("bytes", info.file_bytes);
  json.member("raw_bytes", raw_bytes(info));
  json.key("ratio");
  json.fixed(ratio(info), 1);
  json.key("snap");
  json.shortest(static_cast<double>(info.snap));
  json.member("loop", loop_word(info));
  json.end_object();
  json.finish();
}

std::string info_text(const ClipFile& file, const Session& session) {
  const MienClipInfo& info = file.info;
  const auto line = [](std::string label, const std::string& value) {
    label.resize(std::max<size_t>(label.size(), 18), ' ');
    return "  " + label + value + "\n";
  };
  std::string text =
      paint(one_line(file.shown) + ": a clip", Style::kBold, session.terminal.out_colors) + "\n";
  const double seconds =
      static_cast<double>(info.length) / static_cast<double>(MIEN_TICKS_PER_SECOND);
  char length[64];
  snprintf(length, sizeof(length), ", %.3f s, %s", seconds, loop_word(info));
  text += line("frames", grouped(info.frame_count) + length);
  text += line("rate", rate_text({info.rate_numerator, info.rate_denominator}) + " per second");
  text += line("channels", grouped(info.channel_count) + ", of which " +
                               grouped(info.changing_channel_count) + " change");
  char share[40];
  snprintf(share, sizeof(share), " (%.1f times as much)", ratio(info));
  text += line("size", size_text(info.file_bytes) + "; as 32-bit floats " +
                           size_text(raw_bytes(info)) + (ratio(info) > 1 ? share : ""));
  text +=
      line("values", info.snap == 0
                         ? std::string("every bit kept")
                         : "rounded to 1/" +
                               grouped(static_cast<uint64_t>(1 / static_cast<double>(info.snap))));
  if (info.event_count != 0) text += line("events", grouped(info.event_count));
  if (info.is_delta) text += line("kind", "differences");
  std::string names;
  for (const std::string& name : channel_names(file)) {
    names += (names.empty() ? "" : " ") + one_line(name);
  }
  return text + line("names", names);
}

void run_info(const ClipOptions& options, const Session& session) {
  const ClipFile file = open_clip_file(options.clip);
  Output output("-");
  if (options.json) {
    write_json(file, output);
  } else {
    output.write(info_text(file, session));
  }
  output.commit();
}

void run_verify(const ClipOptions& options, const Session& session) {
  const ClipFile file = open_clip_file(options.clip);
  auto error = sized<MienError>();
  check(mien_clip_verify(file.clip.get(), &error), &error, "clip is damaged", file.shown);
  if (session.quiet) return;
  Output output("-");
  output.write(one_line(file.shown) + ": " + grouped(file.info.frame_count) + " frames of " +
               grouped(file.info.channel_count) + " channels are as they were written\n");
  output.commit();
}

// Export ------------------------------------------------------------------------------------------

double frame_time(const MienClipInfo& info, uint32_t frame) {
  return static_cast<double>(frame) * info.rate_denominator / info.rate_numerator;
}

void export_csv(const ClipFile& file, Output& output) {
  std::string text = "time";
  for (const std::string& name : channel_names(file)) text += "," + csv_field(name);
  text += "\n";
  char digits[64];
  const auto append = [&](auto number) {
    text.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  };
  for_each_frame(file, [&](uint32_t frame, const float* values) {
    append(frame_time(file.info, frame));
    for (uint32_t c = 0; c < file.info.channel_count; ++c) {
      text += ',';
      append(values[c]);
    }
    text += '\n';
    output.write(text);
    text.clear();
  });
}

/// The tick counts when a clip is built of them; the time is there for readers.
void write_events(const ClipFile& file, JsonWriter& json) {
  json.key("events");
  json.begin_array(JsonWriter::Layout::kLines);
  for (uint32_t i = 0; i < file.info.event_count; ++i) {
    MienClipEvent event = {};
    check(mien_clip_event(file.clip.get(), i, &event), nullptr, "cannot export clip", file.shown);
    json.begin_object();
    json.key("time");
    json.shortest(static_cast<double>(event.tick) / static_cast<double>(MIEN_TICKS_PER_SECOND));
    json.key("tick");
    json.value(event.tick);
    json.member("name", std::string(event.name.data, event.name.count));
    json.key("value");
    json.shortest(static_cast<double>(event.value));
    json.end_object();
  }
  json.end_array();
}

void export_json(const ClipFile& file, Output& output) {
  const std::vector<std::string> names = channel_names(file);
  const MienClipInfo& info = file.info;
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.key("rate");
  if (info.rate_denominator == 1) {
    json.value(info.rate_numerator);
  } else {
    json.begin_array();
    json.value(info.rate_numerator);
    json.value(info.rate_denominator);
    json.end_array();
  }
  if (info.event_count != 0) write_events(file, json);
  const bool has_head = std::any_of(names.begin(), names.end(), turns_head);
  if (has_head) {
    json.key("variables");
    json.begin_array();
    for (const std::string& name : names) {
      if (turns_head(name)) json.value(name);
    }
    json.end_array();
  }
  json.key("frames");
  json.begin_array(JsonWriter::Layout::kLines);
  for_each_frame(file, [&](uint32_t frame, const float* values) {
    json.begin_object();
    json.key("time");
    json.shortest(frame_time(info, frame));
    json.key("raw");
    json.begin_object();
    std::vector<float> head;
    for (uint32_t c = 0; c < info.channel_count; ++c) {
      if (turns_head(names[c])) {
        head.push_back(values[c]);
        continue;
      }
      json.key(names[c]);
      json.shortest(static_cast<double>(values[c]));
    }
    json.end_object();
    if (has_head) {
      json.key("variables");
      json.floats(head.data(), head.size());
    }
    json.end_object();
  });
  json.end_array();
  json.end_object();
  json.finish();
}

void run_export(const ClipOptions& options, const Session& session) {
  const std::string& path = options.output.path;
  const bool as_json = ends_with(path, ".json");
  if (!as_json && !ends_with(path, ".csv") && path != "-") {
    fail_usage("-o " + path, "the ending of the name selects the format", "use .csv or .json");
  }
  refuse_replacing(options.output, {options.clip});
  const ClipFile file = open_clip_file(options.clip);
  if (!as_json && file.info.event_count != 0) {
    note(session, one_line(file.shown) + ": a table has no place for its " +
                      grouped(file.info.event_count) + " events; JSON does");
  }
  Output output(path);
  (as_json ? export_json : export_csv)(file, output);
  output.commit();
}

CLI::Option* add_clip_option(CLI::App& app, ClipOptions& options) {
  return app.add_option("CLIP", options.clip, "Clip; - reads standard input")
      ->type_name("")
      ->required();
}

}  // namespace

Command add_clip_command(CLI::App& app, const Session& session) {
  CLI::App* clip =
      app.add_subcommand("clip", "Build, inspect and export clips: compressed control curves");
  clip->require_subcommand(1);
  clip->footer("'mien help clip build' shows the options of an action, with examples.");

  auto build = std::make_shared<BuildOptions>();
  CLI::App* build_app = clip->add_subcommand("build", "Build a clip from a table or from frames");
  build_app->add_option("IN", build->input, "CSV or JSON; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*build_app, build->output, "File to write; - is standard output")->required();
  build_app->add_option("--rate", build->rate, "Frames per second (default: found from the times)")
      ->type_name("R");
  build_app
      ->add_option("--snap", build->snap,
                   "Round values to a step of 1/512 to 1/65536, which makes the clip\nseveral "
                   "times smaller (default: keep every bit)")
      ->type_name("STEP");
  build_app
      ->add_option(
          "--rig", build->rig,
          "Round each channel to the coarsest step that moves no vertex of\nthis rig by more "
          "than --tolerance")
      ->type_name("RIG");
  build_app
      ->add_option("--names", build->names,
                   "With --rig: JSON with meanings of names on this rig, before those that\n"
                   "Mien knows: {\"smirk\": \"mouthSmileLeft\"}")
      ->type_name("FILE");
  build_app->add_option("--tolerance", build->tolerance, "In millimeters (default: 0.02)")
      ->type_name("MM");
  build_app->add_option("--loop", build->loop, "After the last frame: clamp (default) or wrap")
      ->type_name("WORD");
  build_app
      ->add_option("--channels", build->channels,
                   "Only these channels, separated by commas; * matches any characters")
      ->type_name("LIST");
  build_app
      ->add_option(
          "--minus", build->minus,
          "Build a delta clip, for layers that add: subtract a frame of IN\n(its number, from 0 "
          "on), or another clip frame by frame, or\nnothing if IN already has differences")
      ->type_name("FROM");
  build_app
      ->add_option(
          "--close", build->closures,
          "Make events with these names closures of lips, lip-to-teeth or\nteeth, as many seconds "
          "long as their value: m,b,p=lips,\nf,v=lip-to-teeth, s,z=teeth. In speech layers, "
          "guards keep them\nclosed. May be repeated")
      ->type_name("NAMES=WHAT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  build_app->add_flag("--resample", build->resample,
                      "Interpolate rows that do not fit a constant rate");
  build_app->footer(
      "IN is one of these, recognized by its content:\n"
      "  CSV        a header time,NAME,NAME,... and a row per frame; time in seconds\n"
      "  CSV of the Live Link Face app, 61 channels behind a timecode: every row is\n"
      "             a frame, the channels keep the names of the app\n"
      "  JSON       frames as 'mien eval' takes them and 'mien play' writes them. A\n"
      "             control that a frame does not name is 0 there. \"events\": [{\"time\":\n"
      "             seconds, \"name\": NAME, \"value\": number}] become events of the clip\n"
      "Values are the nearest 32-bit floats. Times may be a twentieth of a frame off the rate.\n\n"
      "Examples:\n"
      "  mien clip build take.csv -o take.clip\n"
      "  mien clip build take.csv -o small.clip --snap 1/2048 --channels 'jaw*,mouth*'\n"
      "  mien clip build talk.json -o talk.clip --close m,b,p=lips\n"
      "  mien clip build nod.csv -o nod.clip --minus 0\n"
      "  mien clip build phone.csv -o phone.clip --rig head.dna --tolerance 0.05\n"
      "  mien clip build phone.csv -o phone.clip --resample --rate 60");

  auto info = std::make_shared<ClipOptions>();
  CLI::App* info_app = clip->add_subcommand("info", "Show what a clip contains");
  add_clip_option(*info_app, *info);
  info_app->add_flag("--json", info->json, "Print JSON");

  auto verify = std::make_shared<ClipOptions>();
  CLI::App* verify_app =
      clip->add_subcommand("verify", "Check that a clip has not changed since it was written");
  add_clip_option(*verify_app, *verify);

  auto exported = std::make_shared<ClipOptions>();
  CLI::App* export_app =
      clip->add_subcommand("export", "Write the frames of a clip as CSV or JSON");
  add_clip_option(*export_app, *exported);
  add_output_options(*export_app, exported->output,
                     "File to write, .csv or .json; - is standard output, CSV")
      ->required();
  export_app->footer(
      "Numbers have enough digits to restore the same floats: building a clip from the file gives\n"
      "the same frames. JSON keeps events, CSV cannot.\n\n"
      "Examples:\n"
      "  mien clip export take.clip -o take.csv\n"
      "  mien clip export take.clip -o frames.json\n"
      "  mien eval head.dna --input frames.json");

  return {clip, [=, &session] {
            if (build_app->parsed()) run_build(*build, session);
            if (info_app->parsed()) run_info(*info, session);
            if (verify_app->parsed()) run_verify(*verify, session);
            if (export_app->parsed()) run_export(*exported, session);
          }};
}

}  // namespace mien::cli
