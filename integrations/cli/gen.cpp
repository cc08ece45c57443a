// SPDX-License-Identifier: MIT
// mien gen: a synthetic rig.
#include "integrations/cli/options.h"
#include "integrations/cli/write_dna.h"

namespace mien::cli {

namespace {

struct GenOptions {
  std::string output, preset = "tiny", seed = "0";
};

void run(const GenOptions& options, const Session& session) {
  auto desc = sized<MienGenerateDesc>();
  desc.preset = MIEN_PRESET_TINY + static_cast<uint32_t>(parse_word("--preset", options.preset));
  desc.seed = parse_number("--seed", options.seed, UINT64_MAX);
  refuse_terminal(options.output, session);

  MienDna* made = nullptr;
  auto error = sized<MienError>();
  check(mien_dna_generate(&desc, &made, &error), &error, "cannot generate",
        "preset " + options.preset);
  const Dna dna(made);
  write_dna(made, sized<MienWriteDesc>(), options.output);
}

}  // namespace

Command add_gen_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<GenOptions>();
  CLI::App* gen = app.add_subcommand("gen", "Make a synthetic rig");
  gen->add_option("-o,--output", options->output, "File to write; - is standard output")
      ->type_name("OUT.dna")
      ->required();
  gen->add_option(
         "--preset", options->preset,
         "Size: tiny (default), small, medium or large\n(large: a production head of 870 joints)")
      ->type_name("NAME");
  gen->add_option("--seed", options->seed,
                  "The same number gives the same bytes everywhere (default: 0)")
      ->type_name("N");
  gen->footer(
      "Examples:\n"
      "  mien gen -o tiny.dna\n"
      "  mien gen -o head.dna --preset large --seed 7\n"
      "  mien gen -o - | mien info -");
  return {gen, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
