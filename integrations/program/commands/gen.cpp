// SPDX-License-Identifier: MIT
// mien gen: a synthetic rig; mien demo-head: the head in the box.
#include <mien_author.h>

#include "integrations/program/commands/head_textures.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/write_dna.h"

namespace mien::cli {

namespace {

struct GenOptions {
  OutputFile output;
  std::string preset = "tiny", seed = "0";
  std::string textures;  // folder; empty: none
  bool ml = false;
};

void run(const GenOptions& options, uint32_t preset, const Session& session) {
  auto desc = sized<MienGenerateDesc>();
  desc.preset = preset;
  desc.flags = options.ml ? uint32_t{MIEN_GENERATE_ML} : 0;
  desc.seed = parse_number("--seed", options.seed, UINT64_MAX);
  refuse_terminal(options.output.path, session, "a DNA file");
  refuse_replacing(options.output, {});
  if (!options.textures.empty() && is_stream(options.output.path)) {
    fail(kUsage, "cannot use --textures", options.output.path,
         "the file that names them would be beside the DNA file", "give a file with -o");
  }

  MienDna* made = nullptr;
  auto error = sized<MienError>();
  check(mien_dna_generate(&desc, &made, &error), &error, "cannot generate",
        "preset " + options.preset);
  Dna dna(made);
  write_dna(made, sized<MienWriteDesc>(), options.output.path, session);
  if (options.textures.empty()) return;
  write_head_textures(std::move(dna), desc.seed, options.output.path, options.textures, session);
}

void add_common_options(CLI::App* command, GenOptions& options, const std::string& seed) {
  add_output_options(*command, options.output, "File to write; - is standard output", "OUT.dna")
      ->required();
  command->add_option("--seed", options.seed, seed)->type_name("N");
}

}  // namespace

Command add_gen_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<GenOptions>();
  CLI::App* gen = app.add_subcommand("gen", "Generate a synthetic rig");
  add_common_options(gen, *options, "The same number gives the same bytes everywhere (default: 0)");
  gen->add_option(
         "--preset", options->preset,
         "Heads: tiny (default), small, medium or large (870 joints), or a body\n(342 joints, RBF "
         "solvers, twists and swings). With the counts and names of\nexported characters: "
         "metahuman-head (2.5), metahuman-body (2.7), archetype (that\nhead without blend shapes)")
      ->type_name("NAME");
  gen->add_flag("--ml", options->ml,
                "Add machine-learned behavior: networks, their operations, joints that they move");
  gen->footer(
      "Examples:\n"
      "  mien gen -o tiny.dna\n"
      "  mien gen -o head.dna --preset large --seed 7\n"
      "  mien gen -o body.dna --preset body --ml\n"
      "  mien gen -o export.dna --preset metahuman-head\n"
      "  mien gen -o - | mien info -");
  return {gen, [options, &session] {
            constexpr uint32_t kPresets[] = {MIEN_PRESET_TINY,           MIEN_PRESET_SMALL,
                                             MIEN_PRESET_MEDIUM,         MIEN_PRESET_LARGE,
                                             MIEN_PRESET_BODY,           MIEN_PRESET_METAHUMAN_HEAD,
                                             MIEN_PRESET_METAHUMAN_BODY, MIEN_PRESET_ARCHETYPE};
            run(*options, kPresets[parse_word("--preset", options->preset)], session);
          }};
}

Command add_demo_head_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<GenOptions>();
  options->preset = "head";
  CLI::App* head = app.add_subcommand("demo-head", "Generate a stylized head with 72 expressions");
  add_common_options(head, *options, "Each number gives another person (default: 0)");
  head->add_option("--textures", options->textures,
                   "Also write images of the skin, the eyes and hair with an alpha\ninto "
                   "this folder, and OUT.materials.json, which\nnames them, beside OUT.dna")
      ->type_name("DIR");
  head->footer(
      "A stylized person: skin, eyes, teeth, tongue, hair, with vertex colors, correctives,\n"
      "wrinkle maps and 8 LODs. Raw controls have the names of the ARKit coefficients;\n"
      "mouthClose closes the lips over an open jaw. 20 more have names of MetaHuman rigs.\n\n"
      "Examples:\n"
      "  mien demo-head -o head.dna\n"
      "  mien demo-head -o head.dna --textures textures\n"
      "  mien render head.dna --set jawOpen=0.6 --set mouthSmileLeft=1 -o smile.png");
  return {head, [options, &session] { run(*options, MIEN_PRESET_HEAD, session); }};
}

}  // namespace mien::cli
