// SPDX-License-Identifier: MIT
// mien bake: a DNA file -> a baked file: the compiled rig and its geometry, used in place.
#include "integrations/program/commands/options.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

struct BakeOptions {
  std::string rig;
  OutputFile output;
  bool no_geometry = false;
  LoadOptions load;
  RigOptions evaluation;
};

void write_baked(const MienRig* rig, const MienDeformer* deformer, const std::string& path,
                 const Session& session) {
  const std::string shown = path == "-" ? "standard output" : path;
  auto error = sized<MienError>();
  size_t size = 0;
  check(mien_bake_memory(rig, deformer, nullptr, 0, &size, &error), &error, "cannot bake", shown);
  std::vector<char> bytes(size);
  check(mien_bake_memory(rig, deformer, bytes.data(), size, &size, &error), &error, "cannot bake",
        shown);
  Output output(path);
  output.write(bytes.data(), size);
  output.commit();
  note_written(session, path, size);
}

void run(const BakeOptions& options, const Session& session) {
  const uint32_t geometry = options.no_geometry ? 0 : uint32_t{MIEN_LAYER_GEOMETRY};
  const MienDnaDesc desc = parse_load_options(options.load, kEvaluationLayers | geometry);
  require_behavior(desc);
  const MienRigDesc rig_desc = parse_rig_options(options.evaluation);
  refuse_terminal(options.output.path, session, "a baked file");
  refuse_replacing(options.output, {options.rig});
  const RigFile file = open_rig_file(options.rig, desc, session);
  const Rig rig = create_rig(file, rig_desc);
  Deformer deformer;
  if ((desc.layers & MIEN_LAYER_GEOMETRY) != 0 && has_geometry(file)) {
    auto error = sized<MienError>();
    MienDeformer* made = nullptr;
    check(mien_deformer_create(file.dna.get(), rig.get(), nullptr, &made, &error), &error,
          "cannot compile geometry", file.shown);
    deformer.reset(made);
  }
  write_baked(rig.get(), deformer.get(), options.output.path, session);
}

}  // namespace

Command add_bake_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* bake = app.add_subcommand("bake", "Compile a rig into a file that opens instantly");
  bake->add_option("RIG", options->rig, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*bake, options->output, "File to write; - is standard output")->required();
  bake->add_flag("--no-geometry", options->no_geometry, "Leave the meshes out");
  add_load_options(*bake, options->load);
  add_rig_options(*bake, options->evaluation, false);
  bake->footer(
      "A baked file opens in microseconds, and all processes that open it share its memory. It\n"
      "gives the same results as the DNA file, on every instruction set; the options chosen here\n"
      "are fixed. info, validate, eval, play, bench, render and inspect accept it in place of a\n"
      "DNA file.\n"
      "Keep the DNA file: a later version of Mien may require baking again.\n\n"
      "Examples:\n"
      "  mien bake head.dna -o head.rig\n"
      "  mien bake head.dna -o phone.rig --max-lod 3 --storage f16\n"
      "  mien bake head.dna -o server.rig --no-geometry\n"
      "  mien eval head.rig --input frames.json");
  return {bake, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
