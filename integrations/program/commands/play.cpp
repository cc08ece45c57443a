// SPDX-License-Identifier: MIT
// mien play: a scene of clips, poses, reactions and generators on a rig, as frames of controls.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/contact_strip.h"
#include "integrations/program/commands/exported_rig.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/commands/real_time.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/frame_rate.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"
#include "integrations/program/play/recording.h"

namespace mien::cli {

namespace {

struct PlayOptions {
  std::string scene, rig, rate, seconds, seed, stages, names;
  GlbOptions glb;
  std::vector<std::string> outputs;
  StripOptions strip;  // with --lod, which a GLB has as well
  RealTimeOptions real_time;
  bool force = false;
};

constexpr double kMaxFrames = 1e7;
const Words kEndings = {".json", ".csv", ".clip", ".svg", ".glb", ".png"};

bool any_ends_with(const std::vector<std::string>& outputs, const std::string& end) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [&](const std::string& output) { return ends_with(output, end); });
}

double parse_seconds(const std::string& option, const std::string& word) {
  double number = 0;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error == std::errc() && stop == end && number >= 0 && number <= 86400) return number;
  fail_usage(option + " \"" + word + "\"", "not a number of seconds up to 86400",
             "give one in decimal digits");
}

std::vector<uint16_t> watched_curves(const std::string& names, RigCurves curves) {
  std::vector<uint16_t> watched;
  if (names.empty()) return watched;
  for (const std::string& name : split_at_commas(names))
    watched.push_back(curves.curve(name, "--stages"));
  return watched;
}

/// Endings, and options that none of the outputs has a use for.
void check_outputs(const std::vector<std::string>& outputs, const PlayOptions& options) {
  if (options.scene == "-" && options.rig == "-") {
    fail_usage("SCENE - RIG -", "both would be read from standard input", "put one in a file");
  }
  for (const std::string& output : outputs) {
    const bool known = output == "-" ||
                       std::any_of(kEndings.begin(), kEndings.end(),
                                   [&](const std::string& end) { return ends_with(output, end); });
    if (!known) {
      fail_usage("-o " + output, "the ending of the name selects the format",
                 "use " + list_of(kEndings, "or"));
    }
    refuse_replacing({output, options.force}, {options.scene, options.rig});
  }
  const bool png = any_ends_with(outputs, ".png"), glb = any_ends_with(outputs, ".glb");
  const StripOptions& strip = options.strip;
  const RenderOutputOptions usual;
  const std::pair<const char*, bool> of_images[] = {
      {"--every", !strip.every.empty()},
      {"--columns", !strip.columns.empty()},
      {"--meshes", !strip.scene.meshes.empty()},
      {"--camera", strip.output.camera != usual.camera},
      {"--target", !strip.output.target.empty()},
      {"--size", !strip.output.size.empty()},
      {"--background", strip.output.background != usual.background},
      {"--samples", strip.output.samples != usual.samples}};
  for (const auto& [option, given] : of_images) {
    if (given && !png) fail_usage(option, "there are no images", "add -o OUT.png");
  }
  check_glb_options(options.glb);
  if (options.glb.named() && !glb) {
    fail_usage(options.glb.named(), "there is no GLB", "add -o OUT.glb");
  }
  parse_lod(strip.scene.lod, false);
  if (strip.scene.lod != "0" && !png && !glb) {
    fail_usage("--lod " + strip.scene.lod, "controls are the same for all LODs",
               "add -o OUT.png or OUT.glb");
  }
  if (options.rig == "-" && (png || glb)) {
    fail_usage("RIG -", "the rig is read again for images and for a GLB", "put it in a file");
  }
  if (glb && is_baked_file(options.rig)) {
    fail_usage("-o OUT.glb", "a baked file has no names and axes for a GLB", "give the DNA file");
  }
}

/// What `mien export --animation` writes of the same frames.
std::string scene_glb(const PlayOptions& options, const Recording& recording,
                      const Session& session) {
  try {
    ExportedRig face(options.rig, options.strip.scene.lod, session);
    note_color_problems(face, session);
    const uint32_t controls = rig_count(face.rig.get(), MIEN_KIND_RAW_CONTROL);
    std::vector<Frame> frames;
    for (size_t f = 0; f < recording.times.size(); ++f) {
      frames.push_back(recording.shown_frame(f, controls));
    }
    return rig_glb(face, {}, frames, recording.rate, options.glb, session);
  } catch (const gltf::ExportError& error) {
    fail_export(error, options.rig);
  }
}

void run(const PlayOptions& options, const Session& session) {
  std::vector<std::string> outputs = options.outputs;
  if (outputs.empty() && options.real_time.send.empty()) outputs = {"-"};
  check_outputs(outputs, options);
  RealTime::check(options.real_time);
  const bool solves = solves_landmarks(options.real_time);
  if (solves && !options.names.empty()) {
    fail_usage("--names", "landmarks have places, and no controls of their names", "leave it out");
  }
  std::map<std::string, StripPlan> strips;
  for (const std::string& output : outputs) {
    if (ends_with(output, ".png")) strips.emplace(output, plan_strip(options.strip, output));
  }
  const Rate rate_option = options.rate.empty() ? Rate{} : parse_rate(options.rate);
  if (!options.rate.empty() && !rate_option.known()) {
    fail_usage("--rate \"" + options.rate + "\"", "not a number of frames per second",
               "give one such as 60, 29.97 or 30000/1001");
  }
  Script script = parse_script(read_json(options.scene, "cannot read scene"),
                               shown_name(options.scene), !options.real_time.live.empty());
  const NamesFile names(options.names);
  if (!options.seed.empty()) script.seed = parse_number("--seed", options.seed, UINT64_MAX);
  const double rate = rate_option.known() ? rate_option.hertz() : script.rate;
  double seconds =
      options.seconds.empty() ? script.seconds : parse_seconds("--seconds", options.seconds);
  // Until Ctrl-C.
  if (seconds == 0 && options.real_time.given()) seconds = kMaxFrames / rate;
  if (seconds * rate > kMaxFrames) {
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
  std::string name;  // of the rig
  if (is_baked_file(options.rig)) {
    baked = open_baked_rig(options.rig, load, evaluation);
    rig = baked->rig.get();
    meshes = baked->deformer.get();
    name = baked->shown;
  } else {
    const bool measured =
        script.guards != 0 || std::any_of(script.layers.begin(), script.layers.end(), is_gaze);
    const uint32_t geometry = measured || solves ? uint32_t{MIEN_LAYER_GEOMETRY} : 0;
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

  std::unique_ptr<RealTime> real_time;
  if (options.real_time.given()) {
    const LiveRig moved = {rig, meshes, baked ? baked->shown : dna->shown};
    real_time = std::make_unique<RealTime>(options.real_time, moved, names, session);
  }
  const StreamScript stream = real_time ? real_time->stream() : StreamScript();
  Performance performance(script, rig, meshes, stream, names, session);
  performance.curves().note_matched(script.shown, session);
  Recording recording;
  recording.rate = rate;
  recording.captions = find_captions(script);
  recording.watched = watched_curves(options.stages, performance.curves());
  const bool all = any_ends_with(outputs, ".svg") && recording.watched.empty();
  const size_t curve_count = performance.curves().count();
  if (all) {
    for (size_t curve = 0; curve < curve_count; ++curve) {
      recording.watched.push_back(static_cast<uint16_t>(curve));
    }
  }
  std::function<bool(int64_t)> wait;
  if (real_time) wait = [&](int64_t tick) { return real_time->wait(tick, performance); };
  performance.run(rate, seconds, wait, [&](size_t, double time, const float* row) {
    if (real_time) real_time->send(time, row);
    if (outputs.empty()) return;
    recording.times.push_back(time);
    recording.rows.insert(recording.rows.end(), row, row + curve_count);
    recording.heads.push_back(performance.curves().head(row));
    std::vector<float> stages;
    for (uint16_t curve : recording.watched) {
      const std::vector<float> values = performance.stage_values(curve);
      stages.insert(stages.end(), values.begin(), values.end());
    }
    recording.stages.push_back(std::move(stages));
    if (!recording.watched.empty()) recording.guards.push_back(performance.guard_frames());
  });
  if (real_time) real_time->finish(session);
  real_time.reset();
  if (all) keep_moving(performance, recording);

  for (const std::string& path : outputs) {
    if (ends_with(path, ".png")) {
      const uint64_t bytes = write_strip(strips.at(path), options.strip.output.target, recording,
                                         recording.captions, {path, options.force}, session);
      note_written(session, path, bytes);
      continue;
    }
    Output output(path);
    if (ends_with(path, ".csv")) {
      write_csv(performance, recording, output);
    } else if (ends_with(path, ".clip")) {
      write_clip(performance, recording, path, output);
    } else if (ends_with(path, ".svg")) {
      write_svg(performance, recording, output);
    } else if (ends_with(path, ".glb")) {
      output.write(scene_glb(options, recording, session));
    } else {
      write_json(name, performance, recording, !all, output);
    }
    output.commit();
    note_written(session, path, output.size());
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
  play->add_option(
          "-o,--output", options->outputs,
          "Files to write; the ending selects the format: .json, .csv,\n.clip, .svg (curves over "
          "time), .glb (animation), .png (contact\nstrip); may be repeated (default: JSON on "
          "standard output)")
      ->type_name("OUT")
      ->expected(1)
      ->take_all();
  play->add_flag("--force", options->force, "Replace even an input or a read-only file");
  play->add_option("--names", options->names,
                   "JSON with meanings of names on this rig, before those that Mien\nknows: "
                   "{\"smileL\": \"mouthSmile_L\"}")
      ->type_name("FILE");
  play->add_option("--rate", options->rate,
                   "Frames per second (default: the scene's, otherwise 60)")
      ->type_name("R");
  play->add_option("--seconds", options->seconds, "Length in seconds (default: the scene's)")
      ->type_name("S");
  play->add_option("--seed", options->seed,
                   "Seed of blinks, breath and noise (default: the scene's)")
      ->type_name("N");
  play->add_option("--stages", options->stages,
                   "Also report for these controls, separated by commas, which layer\nmade their "
                   "values, and which guards held them back")
      ->type_name("NAMES");
  play->add_option("--lod", options->strip.scene.lod,
                   "LOD of images and of a GLB (default: 0, the finest)")
      ->type_name("N");
  add_glb_options(*play, options->glb, "GLB");
  const std::string clock = "Real time";
  play->add_option(
          "--live", options->real_time.live,
          "Listen on a port: livelink://:11111 for the Live Link Face app,\n"
          "vmc://:39539 for VMC, landmarks3://:11112 or landmarks2://:11112 for\nlandmarks in "
          "space or in pictures; from other machines too, unless a\nhost is named.\n"
          "Drives the layer with the source {\"live\": true}; without one, adds it before\nall "
          "other layers")
      ->type_name("FROM")
      ->group(clock);
  play->add_option("--delay", options->real_time.delay,
                   "Delay of live data in seconds, which hides jitter and packets in\nthe wrong "
                   "order (default: 0.05)")
      ->type_name("S")
      ->group(clock);
  play->add_option(
          "--device", options->real_time.device,
          "Take packets of Live Link Face only from this device, by its id or the\nname of "
          "its subject (default: the first that sends)")
      ->type_name("NAME")
      ->group(clock);
  LandmarkOptions& landmarks = options->real_time.landmarks;
  play->add_option("--landmarks", landmarks.file,
                   "JSON that says where the landmarks of packets are on the rig, and the\ncamera: "
                   "see 'mien help solve'")
      ->type_name("FILE")
      ->group(clock);
  play->add_option(
          "--neutral", landmarks.neutral,
          "Landmarks are of another person, whose face is at rest in the first N\npackets, or "
          "in a CSV of landmarks (pixels): what that face differs in\nis no expression")
      ->type_name("N|FILE")
      ->group(clock);
  play->add_option("--focal", landmarks.focal,
                   "Focal length of the camera of landmarks2 in pixels (default: found from\nthe "
                   "first 60 packets with the face, then kept)")
      ->type_name("F")
      ->group(clock);
  play->add_option("--smooth", landmarks.smooth,
                   "Weight of changes from packet to packet against the mean squared\ndistance of "
                   "landmarks (default: 0)")
      ->type_name("S")
      ->group(clock);
  play->add_option("--sparse", landmarks.sparse,
                   "Weight of the sum of all controls against it (default: 0)")
      ->type_name("S")
      ->group(clock);
  play->add_option("--robust", landmarks.robust,
                   "Landmarks farther off than S count less, in the unit of the rig, or\npixels "
                   "(default: all count)")
      ->type_name("S")
      ->group(clock);
  play->add_option("--solve-time", landmarks.seconds,
                   "Seconds that solving landmarks may take in a frame (default: 0.008)")
      ->type_name("S")
      ->group(clock);
  play->add_option("--send", options->real_time.send,
                   "Send the raw controls of each frame by VMC: vmc://HOST:PORT")
      ->type_name("TO")
      ->group(clock);
  const std::string group = "Images";
  play->add_option("--every", options->strip.every,
                   "Seconds between images (default: at most 16 images)")
      ->type_name("S")
      ->group(group);
  play->add_option("--columns", options->strip.columns, "Images per row (default: 8)")
      ->type_name("N")
      ->group(group);
  play->add_option("--meshes", options->strip.scene.meshes,
                   "Draw only these meshes, for example head*,teeth*")
      ->type_name("PATTERN")
      ->group(group);
  add_camera_options(*play, options->strip.output, group);
  play->footer(
      "SCENE is one JSON object, in which everything is optional:\n"
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
      "Layers: the group is base, speech, emotion, reaction or life, the mode override, add, "
      "screen, "
      "max or scale. {\"generator\": ...} is blink, breath, noise or gaze; the first three take "
      "\"controls\": {NAME: amount} and \"period\" in seconds. \"after_guards\": true lets a layer "
      "do "
      "what guards prevent. Guards are lips, lids and teeth.\n\n"
      "Events of a layer: \"weight\", \"weights\" of poses or \"stop\": true, each with a \"fade\" "
      "in "
      "seconds; \"play\" with the \"transition\" inertial, crossfade or cut and its "
      "\"duration\".\n\n"
      "A clip in a layer or an event may be speech instead, as 'mien speak' makes it: {\"speech\": "
      "{\"text\": \"Hello.\", \"voice\": \"en-us\"}}, or {\"audio\": FILE, \"text\": ...}, or "
      "{\"phonemes\": FILE}.\n\n"
      "{\"time\": 3, \"level\": \"glare\", \"value\": 0.8} says how bright the light is from then "
      "on: 0.5 or more is a glare, until it is below 0.35.\n"
      "{\"generator\": \"gaze\"} turns the eyes to a point given by the variables gaze.x, gaze.y "
      "and "
      "gaze.z: meters to the left, up and to the front of the point between the eyes.\n"
      "Paths of clips are relative to the folder of the scene. Names that the rig spells "
      "otherwise, "
      "or has other words for, are matched as docs/face-capture.md says; a note lists them.\n\n"
      "Examples:\n"
      "  mien play scene.json head.dna -o frames.json -o curves.svg\n"
      "  mien play scene.json head.dna | mien eval head.dna --input -\n"
      "  mien play scene.json head.dna -o scene.glb\n"
      "  mien play scene.json head.dna -o strip.png --every 0.1 --target mouth\n"
      "  mien play scene.json head.dna -o 'frame-%04d.png' --every 0.04\n"
      "  mien play scene.json head.dna --live livelink://:11111 --send vmc://127.0.0.1:39539\n"
      "  mien play scene.json head.dna --live landmarks2://:11112 --landmarks points.json \\\n"
      "      --neutral 60 --sparse 0.1\n\n"
      "Packets of landmarks are JSON: {\"time\": 1.5, \"size\": [1280, 720], \"landmarks\": "
      "[[0.51, 0.4],\n...]}; see docs/face-capture.md.\n"
      "--live and --send play in real time, for --seconds or until Ctrl-C; then outputs are "
      "written.");
  return {play, [options, &session] {
            options->strip.scene.rig = options->rig;
            run(*options, session);
          }};
}

}  // namespace mien::cli
