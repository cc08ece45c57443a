// SPDX-License-Identifier: MIT
// mien convert: a DNA file read and written, whole or in part, in any version.
#include "integrations/cli/commands/options.h"
#include "integrations/cli/io/nearest_name.h"
#include "integrations/cli/io/output.h"
#include "integrations/cli/io/rig_file.h"
#include "integrations/cli/io/write_dna.h"

namespace mien::cli {

namespace {

struct ConvertOptions {
  std::string input, version, unknown = "keep";
  OutputFile output;
  LoadOptions load;
};

/// Only version 2.1 has no place for layers that it does not know.
void note_lost_layers(const RigFile& file, uint32_t version, const Session& session) {
  if (version != 1 || file.info.version == 1) return;
  std::vector<std::string> lost;
  for (uint32_t i = 0; i < file.info.layer_count; ++i) {
    auto layer = sized<MienDnaLayer>();
    check(mien_dna_layer(file.dna.get(), i, &layer), nullptr, "cannot examine rig", file.shown);
    const std::string code = layer.code;
    if (code != "desc" && code != "defn" && code != "bhvr" && code != "geom") lost.push_back(code);
  }
  if (lost.empty()) return;
  note(session, file.shown + ": version 2.1 cannot store " + list_of(lost, "and") + ": left out");
}

void run(const ConvertOptions& options, const Session& session) {
  MienDnaDesc desc = parse_load_options(options.load, MIEN_LAYER_ALL);
  auto write = sized<MienWriteDesc>();
  if (!options.version.empty()) {
    write.version = 1 + static_cast<uint32_t>(parse_word("--version", options.version));
  }
  const bool drop = parse_word("--unknown", options.unknown) == 1;
  desc.unknown_layers = drop ? MIEN_UNKNOWN_LAYERS_DROP : MIEN_UNKNOWN_LAYERS_KEEP;
  write.unknown_layers = desc.unknown_layers;
  refuse_terminal(options.output.path, session, "a DNA file");
  refuse_replacing(options.output, {});  // a file may be converted in place

  const RigFile file = open_rig_file(options.input, desc, session);
  note_lost_layers(file, write.version, session);
  write_dna(file.dna.get(), write, options.output.path, session);
}

}  // namespace

Command add_convert_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* convert =
      app.add_subcommand("convert", "Convert a DNA file: version, layers, LODs, axes and units");
  convert->add_option("IN", options->input, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*convert, options->output, "File to write; - is standard output")->required();
  convert
      ->add_option("--version", options->version,
                   "Version to write, 2.1 to 2.8 (default: that of IN)")
      ->type_name("V");
  convert
      ->add_option("--unknown", options->unknown,
                   "Layers of unknown kind, or newer than the version: keep (default) or drop")
      ->type_name("WHAT");
  add_load_options(*convert, options->load);
  convert->footer(
      "Without options the output has the bytes of the input, if the input is in canonical form.\n"
      "IN and OUT may be the same file. Layers that are not loaded are written empty.\n\n"
      "Examples:\n"
      "  mien convert head.dna -o old.dna --version 2.2\n"
      "  mien convert head.dna -o phone.dna --max-lod 3 --layers behavior,geometry\n"
      "  mien convert head.dna -o unity.dna --system unity\n"
      "  mien convert head.dna -o head.dna --unknown drop");
  return {convert, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
