// SPDX-License-Identifier: MIT
// mien bake: a DNA file -> a rig as it is in memory, to be mapped and used in place.
#include "integrations/cli/commands/options.h"
#include "integrations/cli/io/output.h"
#include "integrations/cli/io/rig_file.h"

namespace mien::cli {

namespace {

struct BakeOptions {
  std::string rig, output;
  LoadOptions load;
  RigOptions evaluation;
};

void write_image(const MienRig* rig, const std::string& path) {
  const std::string shown = path == "-" ? "standard output" : path;
  auto error = sized<MienError>();
  size_t size = 0;
  check(mien_rig_save_memory(rig, nullptr, 0, &size, &error), &error, "cannot bake rig", shown);
  std::vector<char> bytes(size);
  check(mien_rig_save_memory(rig, bytes.data(), size, &size, &error), &error, "cannot bake rig",
        shown);
  Output output(path);
  output.write(bytes.data(), size);
  output.commit();
}

void run(const BakeOptions& options, const Session& session) {
  const MienDnaDesc desc = parse_load_options(options.load, kEvaluationLayers);
  require_behavior(desc);
  const MienRigDesc rig_desc = parse_rig_options(options.evaluation);
  refuse_terminal(options.output, session, "a baked file");
  const RigFile file = open_rig_file(options.rig, desc, session);
  write_image(create_rig(file, rig_desc).get(), options.output);
}

}  // namespace

Command add_bake_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<BakeOptions>();
  CLI::App* bake = app.add_subcommand("bake", "Pack a rig into a file that is used as it is");
  bake->add_option("RIG", options->rig, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  bake->add_option("-o,--output", options->output, "File to write; - is standard output")
      ->type_name("OUT")
      ->required();
  add_load_options(*bake, options->load);
  add_rig_options(*bake, options->evaluation, false);
  bake->footer(
      "A baked rig opens in microseconds, and all processes share its memory. It evaluates\n"
      "like the rig of the DNA file, on every instruction set; what is chosen here stays.\n"
      "info, eval and bench take it where they take a DNA file. It holds no geometry, and a\n"
      "later version of Mien may want it baked again: keep the DNA file.\n\n"
      "Examples:\n"
      "  mien bake head.dna -o head.rig\n"
      "  mien bake head.dna -o phone.rig --max-lod 3 --storage f16\n"
      "  mien eval head.rig --input frames.json");
  return {bake, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
