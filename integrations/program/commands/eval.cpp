// SPDX-License-Identifier: MIT
// mien eval: frames of controls -> joints, blend shapes and animated maps.
#include <filesystem>
#include <optional>

#include "integrations/program/commands/baked_rig.h"
#include "integrations/program/commands/eval_output.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/frames.h"

namespace mien::cli {

namespace {

struct EvalOptions {
  std::string rig, input, format, lod = "0";
  OutputFile output{"-"};
  LoadOptions load;
  RigOptions evaluation;
};

/// By --format, else by the ending of the file, else JSON.
EvalFormat parse_format(const EvalOptions& options) {
  const std::string option = "eval --format";
  if (!options.format.empty()) return static_cast<EvalFormat>(parse_word(option, options.format));
  const std::string ending = std::filesystem::path(options.output.path).extension().string();
  const Words& words = option_words(option);
  for (size_t i = 0; i < words.size(); ++i) {
    if (ending == "." + words[i]) return static_cast<EvalFormat>(i);
  }
  return EvalFormat::kJson;
}

void evaluate(const EvalHeading& file, const MienRig* rig, const std::vector<Frame>& frames,
              uint32_t first_lod, uint32_t lod_end, const EvalOptions& options,
              const Session& session) {
  auto error = sized<MienError>();
  MienInstance* made = nullptr;
  check(mien_instance_create(rig, nullptr, &made, &error), &error, "cannot evaluate", file.shown);
  const Instance instance(made);

  Output output(options.output.path);
  const std::unique_ptr<EvalWriter> writer = make_eval_writer(parse_format(options), output);
  writer->begin(rig, file, frames.size() * (lod_end - first_lod));
  Progress progress(session, "frame", frames.size());
  for (size_t f = 0; f < frames.size(); ++f) {
    progress.at(f);
    for (uint32_t lod = first_lod; lod < lod_end; ++lod) {
      check(mien_instance_reset(made), nullptr, "cannot evaluate", file.shown);
      apply_frame(frames[f], rig, made);
      check(mien_rig_evaluate(rig, made, lod), nullptr, "cannot evaluate", file.shown);
      writer->write(f, lod, made);
    }
  }
  writer->end();
  output.commit();
  progress.finish();
  note_written(session, options.output.path, output.size());
}

void run(const EvalOptions& options, const Session& session) {
  const MienDnaDesc desc = parse_load_options(options.load, kEvaluationLayers);
  require_behavior(desc);
  const MienRigDesc rig_desc = parse_rig_options(options.evaluation);
  if (parse_format(options) == EvalFormat::kNpy) {
    refuse_terminal(options.output.path, session, "an array");
  }
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
  EvalHeading heading;
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
  eval->add_option("-i,--input", options->input,
                   "JSON with frames of controls; - reads standard input")
      ->type_name("FRAMES")
      ->required();
  add_output_options(*eval, options->output, "File to write; - is standard output (default)");
  eval->add_option("--lod", options->lod,
                   "LOD to evaluate, counted from 0 among those loaded (default: 0), or all")
      ->type_name("N");
  eval->add_option(
          "--format", options->format,
          "json (default, everything), jsonl, csv (joints, blend shapes and animated maps, "
          "with their names) or npy (joints)")
      ->type_name("NAME");
  add_load_options(*eval, options->load);
  add_rig_options(*eval, options->evaluation);
  eval->footer(
      "FRAMES is one JSON object:\n"
      "  {\"frames\": [\n"
      "    {\"raw\": [0.1, ...]},                    all raw controls, in order\n"
      "    {\"raw\": {\"jawOpen\": 1}},                some, by name or its last part\n"
      "    {\"gui\": {\"CTRL_C_jaw.ty\": 0.4},         GUI controls (or all, in order),\n"
      "     \"raw_after_gui\": {\"12\": 1.0}},         mapped to raw; then raw, or by index\n"
      "    {\"gui\": [0.0, ...], \"ml_mask\": [1, 0]}  region masks, in any frame\n"
      "  ]}\n"
      "Controls that are not named keep their initial values. Every frame starts from the\n"
      "initial state, at every LOD.\n\n"
      "For long takes: csv has a header and a row per frame and LOD; jsonl a line with the names,\n"
      "then a line per frame and LOD; npy is an array [frame and LOD][joint][value] for NumPy, in\n"
      "the order of 'mien info RIG --names joints'. Without --format, the ending of OUT "
      "decides.\n\n"
      "Examples:\n"
      "  mien eval head.dna --input frames.json -o out.json\n"
      "  mien eval head.dna --input take.json -o take.csv\n"
      "  echo '{\"frames\": [{}]}' | mien eval head.dna --input - --lod 0");
  return {eval, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
