// SPDX-License-Identifier: MIT
// mien play: a scene of clips, poses, reactions and generators on a rig, as frames of controls.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "integrations/cli/commands/baked_rig.h"
#include "integrations/cli/commands/options.h"
#include "integrations/cli/io/controls.h"
#include "integrations/cli/io/dna_fields.h"
#include "integrations/cli/io/json_writer.h"
#include "integrations/cli/io/take.h"
#include "integrations/cli/io/text.h"
#include "integrations/cli/play/lanes_svg.h"
#include "integrations/cli/play/performance.h"

namespace mien::cli {

namespace {

struct PlayOptions {
  std::string scene, rig, rate, seconds, seed, stages;
  std::vector<std::string> outputs;
  bool force = false;
};

/// All frames, as they are written.
struct Recording {
  std::vector<double> times;
  std::vector<float> rows;                 // [frame][lane]
  std::vector<std::vector<float>> stages;  // [frame][watched lane * stages + stage]
};

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

double parse_seconds(const std::string& option, const std::string& word) {
  double number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error == std::errc() && stop == end && number >= 0 && number <= 86400) return number;
  fail_usage(option + " \"" + word + "\"", "not a number of seconds up to 86400",
             "give one in decimal digits");
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  for (size_t begin = 0; begin <= list.size() && !list.empty();) {
    const size_t comma = std::min(list.find(',', begin), list.size());
    words.push_back(list.substr(begin, comma - begin));
    begin = comma + 1;
  }
  return words;
}

void write_json(const std::string& rig_name, double rate, const Performance& performance,
                const Recording& recording, const std::vector<uint16_t>& watched, Output& output) {
  const RigLanes& lanes = performance.lanes();
  const size_t controls = lanes.controls().size(), count = lanes.count();
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
  json.shortest(rate);
  list("controls", lanes.controls());
  list("variables", lanes.variables());
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
    if (!watched.empty()) {
      json.key("stages");
      json.begin_object();
      for (size_t w = 0; w < watched.size(); ++w) {
        json.key(watched[w] < controls ? short_name(lanes.controls()[watched[w]])
                                       : lanes.variables()[watched[w] - controls]);
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
    }
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

void write_csv(const Performance& performance, const Recording& recording, Output& output) {
  const RigLanes& lanes = performance.lanes();
  std::string text = "time";
  for (const std::string& name : lanes.controls()) text += "," + name;
  text += "\n";
  char digits[64];
  const auto append = [&](auto number) {
    text.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  };
  for (size_t f = 0; f < recording.times.size(); ++f) {
    append(recording.times[f]);
    for (size_t c = 0; c < lanes.controls().size(); ++c) {
      text += ',';
      append(recording.rows[f * lanes.count() + c]);
    }
    text += '\n';
    output.write(text);
    text.clear();
  }
}

void write_clip(const Performance& performance, const Recording& recording, double rate,
                const std::string& shown, Output& output) {
  const RigLanes& lanes = performance.lanes();
  std::vector<MienStringView> names;
  for (const std::string& name : lanes.controls()) names.push_back({name.data(), name.size()});
  const Rate fraction = nearest_rate(rate, 1e-9);
  auto desc = sized<MienClipDesc>();
  desc.rate_numerator = fraction.numerator;
  desc.rate_denominator = fraction.denominator;
  desc.frame_count = static_cast<uint32_t>(recording.times.size());
  desc.channel_count = static_cast<uint32_t>(names.size());
  desc.names = names.data();
  desc.values = recording.rows.data();
  desc.frame_stride = lanes.count();
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

/// Lanes that were named, else all that move.
std::vector<uint16_t> watched_lanes(const std::string& names, RigLanes lanes) {
  std::vector<uint16_t> watched;
  for (const std::string& name : split(names)) watched.push_back(lanes.lane(name, "--stages"));
  return watched;
}

/// Drops the watched lanes that stay as they are, with their stages.
void keep_moving(const Performance& performance, std::vector<uint16_t>& watched,
                 Recording& recording) {
  const size_t stage_count = performance.stages().size(), count = performance.lanes().count();
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

void write_svg(const Performance& performance, const Recording& recording,
               const std::vector<uint16_t>& watched, Output& output) {
  const RigLanes& lanes = performance.lanes();
  const size_t frames = recording.times.size(), stage_count = performance.stages().size();
  std::vector<LanePlot> plots;
  for (size_t w = 0; w < watched.size(); ++w) {
    const size_t lane = watched[w], controls = lanes.controls().size();
    LanePlot plot;
    plot.name = lane < controls ? std::string(short_name(lanes.controls()[lane]))
                                : lanes.variables()[lane - controls];
    plot.stages.assign(stage_count, std::vector<float>(frames));
    for (size_t f = 0; f < frames; ++f) {
      plot.values.push_back(recording.rows[f * lanes.count() + lane]);
      for (size_t s = 0; s < stage_count; ++s) {
        plot.stages[s][f] = recording.stages[f][w * stage_count + s];
      }
    }
    plots.push_back(std::move(plot));
  }
  output.write(lanes_svg(plots, performance.stages(), recording.times.back()));
}

void run(const PlayOptions& options, const Session& session) {
  const std::vector<std::string> outputs =
      options.outputs.empty() ? std::vector<std::string>{"-"} : options.outputs;
  for (const std::string& output : outputs) {
    bool known = output == "-";
    for (const char* end : {".json", ".csv", ".clip", ".svg"})
      known = known || ends_with(output, end);
    if (!known) {
      fail_usage("-o " + output, "the name ends in none of .json, .csv, .clip and .svg",
                 "write JSON; 'mien export --animation' and 'mien render --frames' take it");
    }
    refuse_replacing({output, options.force}, {options.scene, options.rig});
  }
  const Rate rate_option = options.rate.empty() ? Rate{} : parse_rate(options.rate);
  if (!options.rate.empty() && !rate_option.known()) {
    fail_usage("--rate \"" + options.rate + "\"", "not a number of frames per second",
               "give one such as 60, 29.97 or 30000/1001");
  }
  Script script =
      parse_script(read_json(options.scene, "cannot read scene"), shown_name(options.scene));
  if (!options.seed.empty()) script.seed = parse_number("--seed", options.seed, UINT64_MAX);
  const double rate = rate_option.known() ? rate_option.hertz() : script.rate;
  const double seconds =
      options.seconds.empty() ? script.seconds : parse_seconds("--seconds", options.seconds);
  if (seconds * rate > 1e7) {
    fail(kInvalid, "cannot play scene", script.shown, "there would be more than 10,000,000 frames",
         "give fewer --seconds or a lower --rate");
  }

  const LoadOptions load;
  const RigOptions evaluation;
  std::optional<RigFile> dna;
  std::optional<BakedFile> baked;
  Rig made;
  Deformer deformer;
  const MienRig* rig = nullptr;
  const MienDeformer* meshes = nullptr;
  std::string name;
  if (is_baked_file(options.rig)) {
    baked = open_baked_rig(options.rig, load, evaluation);
    rig = baked->rig.get();
    meshes = baked->deformer.get();
    name = baked->shown;
  } else {
    const uint32_t geometry = script.guards ? uint32_t{MIEN_LAYER_GEOMETRY} : 0;
    dna =
        open_rig_file(options.rig, parse_load_options(load, kEvaluationLayers | geometry), session);
    made = create_rig(*dna, parse_rig_options(evaluation));
    rig = made.get();
    name = read_string(*dna, "desc.name");
    if (geometry != 0 && has_geometry(*dna)) {
      auto error = sized<MienError>();
      MienDeformer* created = nullptr;
      check(mien_deformer_create(dna->dna.get(), rig, nullptr, &created, &error), &error,
            "cannot compile geometry", dna->shown);
      deformer.reset(created);
      meshes = created;
    }
  }
  if (script.guards != 0 && !meshes) {
    note(session, "the rig has no geometry to measure guards on; they are off");
    script.guards = 0;
  }

  Performance performance(script, rig, meshes, session);
  std::vector<uint16_t> watched = watched_lanes(options.stages, performance.lanes());
  const bool draws = std::any_of(outputs.begin(), outputs.end(),
                                 [](const std::string& o) { return ends_with(o, ".svg"); });
  const bool all = draws && watched.empty();
  if (all) {
    for (size_t lane = 0; lane < performance.lanes().count(); ++lane) {
      watched.push_back(static_cast<uint16_t>(lane));
    }
  }
  Recording recording;
  performance.run(rate, seconds, [&](size_t, double time, const float* row) {
    recording.times.push_back(time);
    recording.rows.insert(recording.rows.end(), row, row + performance.lanes().count());
    std::vector<float> stages;
    for (uint16_t lane : watched) {
      const std::vector<float> values = performance.stage_values(lane);
      stages.insert(stages.end(), values.begin(), values.end());
    }
    recording.stages.push_back(std::move(stages));
  });
  if (all) keep_moving(performance, watched, recording);

  for (const std::string& path : outputs) {
    Output output(path);
    if (ends_with(path, ".csv")) {
      write_csv(performance, recording, output);
    } else if (ends_with(path, ".clip")) {
      write_clip(performance, recording, rate, path, output);
    } else if (ends_with(path, ".svg")) {
      write_svg(performance, recording, watched, output);
    } else {
      write_json(name, rate, performance, recording, all ? std::vector<uint16_t>() : watched,
                 output);
    }
    output.commit();
  }
}

}  // namespace

Command add_play_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<PlayOptions>();
  CLI::App* play =
      app.add_subcommand("play", "Play a scene of clips, moods and reactions on a rig");
  play->add_option("SCENE", options->scene, "JSON with layers and events; - reads standard input")
      ->type_name("")
      ->required();
  play->add_option("RIG", options->rig, "DNA file or baked rig")->type_name("")->required();
  play->add_option("-o,--output", options->outputs,
                   "Files to write, by their endings: .json, .csv, .clip, .svg\n(default: JSON on "
                   "standard output)")
      ->type_name("OUT")
      ->expected(1)
      ->take_all();
  play->add_flag("--force", options->force, "Replace even an input or a read-only file");
  play->add_option("--rate", options->rate, "Frames per second (default: the scene's, else 60)")
      ->type_name("R");
  play->add_option("--seconds", options->seconds, "How long (default: the scene's)")
      ->type_name("S");
  play->add_option("--seed", options->seed, "Of blinks, breath and noise (default: the scene's)")
      ->type_name("N");
  play->add_option("--stages", options->stages,
                   "Also tell for these controls which layer made their values,\nwith commas "
                   "between")
      ->type_name("NAMES");
  play->footer(
      "SCENE is one JSON object, in which everything may be left out:\n"
      "  {\"rate\": 60, \"seconds\": 4, \"seed\": 7,\n"
      "   \"layers\": [\n"
      "     {\"name\": \"talk\", \"group\": \"speech\",\n"
      "      \"source\": {\"clip\": \"talk.clip\", \"speed\": 1, \"start\": 0}},\n"
      "     {\"name\": \"joy\", \"group\": \"emotion\", \"mode\": \"screen\", \"weight\": 0,\n"
      "      \"mask\": {\"controls\": [\"mouth*\", \"cheek*\"], \"invert\": false},\n"
      "      \"source\": {\"poses\": {\"joy\": {\"mouthSmileLeft\": 0.8}},\n"
      "                 \"weights\": {\"joy\": 1}}},\n"
      "     {\"name\": \"blink\", \"group\": \"life\", \"mode\": \"max\",\n"
      "      \"source\": {\"generator\": \"blink\"}}],\n"
      "   \"guards\": [\"lips\", \"lids\"], \"antagonists\": true, \"limits\": true,\n"
      "   \"reactions\": [{\"name\": \"glare\", \"preset\": \"glare\"}],\n"
      "   \"events\": [\n"
      "     {\"time\": 1, \"layer\": \"joy\", \"weight\": 1, \"fade\": 0.4},\n"
      "     {\"time\": 2, \"layer\": \"talk\", \"play\": {\"clip\": \"other.clip\"}},\n"
      "     {\"time\": 3, \"trigger\": \"glare\", \"strength\": 1, \"hold\": 1.5}]}\n\n"
      "Clips are found from the folder of the scene. Channels with the names of ARKit drive rigs "
      "that have other names by the table of docs/face-capture.md.\n\n"
      "Examples:\n"
      "  mien play scene.json head.dna -o frames.json -o lanes.svg\n"
      "  mien play scene.json head.dna | mien eval head.dna --input -\n"
      "  mien export head.dna --animation frames.json -o head.glb");
  return {play, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
