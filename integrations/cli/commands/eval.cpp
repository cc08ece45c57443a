// SPDX-License-Identifier: MIT
// mien eval: frames of controls -> joints, blend shapes and animated maps, as JSON.
#include <optional>

#include "integrations/cli/commands/baked_rig.h"
#include "integrations/cli/commands/options.h"
#include "integrations/cli/io/dna_fields.h"
#include "integrations/cli/io/frames.h"
#include "integrations/cli/io/json_writer.h"

namespace mien::cli {

namespace {

struct EvalOptions {
  std::string rig, input, lod = "0";
  OutputFile output{"-"};
  LoadOptions load;
  RigOptions evaluation;
};

struct OutputArray {
  const char* key;
  MienStatus (*view)(const MienInstance*, MienFloatView*);
};

// The raw controls are the first of the control row, see write_lod().
constexpr OutputArray kOutputArrays[] = {
    {"psd", mien_instance_psd_controls},          {"ml", mien_instance_ml_controls},
    {"rbf", mien_instance_rbf_controls},          {"joints", mien_instance_joints},
    {"blend_shapes", mien_instance_blend_shapes}, {"animated_maps", mien_instance_animated_maps},
};

void write_array(JsonWriter& json, const char* key, const float* values, size_t count,
                 const std::string& where) {
  json.key(key);
  const size_t written = json.floats(values, count);
  if (written == count) return;
  fail(kInvalid, "cannot evaluate", where + ", " + key + "[" + std::to_string(written) + "]",
       "the result is not a finite number", "give smaller controls; they are usually in 0..1");
}

void write_lod(JsonWriter& json, const MienRig* rig, MienInstance* instance, uint32_t lod,
               const std::string& where) {
  json.begin_object();
  json.member("lod", lod);
  MienFloatView controls{};
  check(mien_instance_controls(instance, &controls), nullptr, "cannot read outputs", "");
  write_array(json, "raw", controls.data, rig_count(rig, MIEN_KIND_RAW_CONTROL), where);
  for (const OutputArray& array : kOutputArrays) {
    MienFloatView view{};
    check(array.view(instance, &view), nullptr, "cannot read outputs", "");
    write_array(json, array.key, view.data, view.count, where);
  }
  json.end_object();
}

/// What stands above the frames; a baked rig does not know its name and version.
struct Heading {
  std::string shown, name, version;
  bool baked = false;
};

void evaluate(const Heading& file, const MienRig* rig, const std::vector<Frame>& frames,
              uint32_t first_lod, uint32_t lod_end, const EvalOptions& options,
              const Session& session) {
  auto error = sized<MienError>();
  MienInstance* made = nullptr;
  check(mien_instance_create(rig, nullptr, &made, &error), &error, "cannot evaluate", file.shown);
  const Instance instance(made);

  Output output(options.output.path);
  JsonWriter json(output);
  using Layout = JsonWriter::Layout;
  json.begin_object(Layout::kLines);
  const MienRigInfo info = rig_info(rig);
  for (const auto& [key, text] :
       {std::pair<const char*, const std::string&>{"rig", file.name}, {"version", file.version}}) {
    json.key(key);
    if (file.baked) {
      json.null();
    } else {
      json.value(text);
    }
  }
  json.member("lod_count", info.lod_count);
  json.member("rotation",
              info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION ? "quaternion" : "euler");
  json.member("arithmetic", arithmetic_word(info));
  json.key("frames");
  json.begin_array(Layout::kLines);
  Progress progress(session, "frame", frames.size());
  for (size_t f = 0; f < frames.size(); ++f) {
    progress.at(f);
    json.begin_object(Layout::kLines);
    json.key("lods");
    json.begin_array(Layout::kLines);
    for (uint32_t lod = first_lod; lod < lod_end; ++lod) {
      check(mien_instance_reset(made), nullptr, "cannot evaluate", file.shown);
      apply_frame(frames[f], rig, made);
      check(mien_rig_evaluate(rig, made, lod), nullptr, "cannot evaluate", file.shown);
      write_lod(json, rig, made, lod,
                file.shown + ", frame " + std::to_string(f) + ", LOD " + std::to_string(lod));
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
  output.commit();
}

void run(const EvalOptions& options, const Session& session) {
  const MienDnaDesc desc = parse_load_options(options.load, kEvaluationLayers);
  require_behavior(desc);
  const MienRigDesc rig_desc = parse_rig_options(options.evaluation);
  const bool all_lods = options.lod == "all";
  const uint32_t lod = all_lods ? 0 : parse_lod(options.lod, true);
  if (options.rig == "-" && options.input == "-") {
    fail_usage("--input -", "standard input cannot be both RIG and FRAMES",
               "put one of them in a file");
  }
  refuse_replacing(options.output, {options.rig, options.input});

  // Whatever is opened has to stay so: rigs may point into it.
  std::optional<RigFile> dna;
  std::optional<BakedFile> baked;
  Rig made;
  Heading heading;
  const MienRig* rig = nullptr;
  if (is_baked_file(options.rig)) {
    baked = open_baked_rig(options.rig, options.load, options.evaluation);
    heading = {baked->shown, "", "", true};
    rig = baked->rig.get();
  } else {
    dna = open_rig_file(options.rig, desc, session);
    made = create_rig(*dna, rig_desc);
    heading = {dna->shown, read_string(*dna, "desc.name"),
               std::to_string(dna->info.generation) + "." + std::to_string(dna->info.version),
               false};
    rig = made.get();
  }
  const uint32_t lod_count = rig_info(rig).lod_count;
  if (!all_lods && lod >= lod_count) {
    fail(kInvalid, "cannot evaluate", heading.shown,
         "LOD " + options.lod + " is out of range: there are " + std::to_string(lod_count),
         "count from 0, or use --lod all");
  }
  const std::vector<Frame> frames = read_frames(options.input, rig);
  evaluate(heading, rig, frames, lod, all_lods ? lod_count : lod + 1, options, session);
}

}  // namespace

Command add_eval_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* eval = app.add_subcommand("eval", "Evaluate frames of controls");
  eval->add_option("RIG", options->rig, "DNA file or baked rig; - reads standard input")
      ->type_name("")
      ->required();
  eval->add_option("-i,--input", options->input, "JSON with the controls; - reads standard input")
      ->type_name("FRAMES")
      ->required();
  add_output_options(*eval, options->output, "File to write; - is standard output (default)");
  eval->add_option("--lod", options->lod,
                   "LOD to evaluate, counted from 0 among those loaded (default: 0), or all")
      ->type_name("N");
  add_load_options(*eval, options->load);
  add_rig_options(*eval, options->evaluation);
  eval->footer(
      "FRAMES is one JSON object:\n"
      "  {\"frames\": [\n"
      "    {\"raw\": [0.1, ...]},                         all raw controls, in order\n"
      "    {\"raw\": {\"jawOpen\": 1}},                     some by name, or its last part\n"
      "    {\"gui\": {\"CTRL_C_jaw.ty\": 0.4},              GUI controls (or all, in order),\n"
      "     \"raw_after_gui\": {\"12\": 1.0}},              mapped to raw; then raw, or by index\n"
      "    {\"gui\": [0.0, ...], \"ml_mask\": [1, 0]}       region masks, in any frame\n"
      "  ]}\n"
      "Controls that are not named keep their initial values. Every frame starts afresh at\n"
      "every LOD.\n\n"
      "Examples:\n"
      "  mien eval head.dna --input frames.json -o out.json\n"
      "  echo '{\"frames\": [{}]}' | mien eval head.dna --input - --lod 0");
  return {eval, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
