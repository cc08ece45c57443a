// SPDX-License-Identifier: MIT
// mien convert: a DNA file read and written, whole or in part, in any version.
#include <algorithm>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/write_dna.h"

namespace mien::cli {

namespace {

struct ConvertOptions {
  std::string input, version, unknown = "keep";
  OutputFile output;
  LoadOptions load;
};

std::vector<std::string> layer_codes(const MienDna* dna, const std::string& shown) {
  auto info = sized<MienDnaInfo>();
  check(mien_dna_info(dna, &info), nullptr, "cannot examine rig", shown);
  std::vector<std::string> codes;
  for (uint32_t i = 0; i < info.layer_count; ++i) {
    auto layer = sized<MienDnaLayer>();
    check(mien_dna_layer(dna, i, &layer), nullptr, "cannot examine rig", shown);
    codes.emplace_back(layer.code);
  }
  return codes;
}

/// Older versions lack layers: 2.1 has no place for them, later ones only if they are to be dropped.
void note_lost_layers(const RigFile& file, const std::vector<char>& written,
                      const std::string& path, const Session& session) {
  auto desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_DESCRIPTOR;
  auto error = sized<MienError>();
  MienDna* opened = nullptr;
  check(mien_dna_open_memory(written.data(), written.size(), &desc, &opened, &error), &error,
        "cannot open what was written", path);
  const Dna dna(opened);
  const std::vector<std::string> kept = layer_codes(dna.get(), path);
  std::vector<std::string> lost;
  for (const std::string& code : layer_codes(file.dna.get(), file.shown)) {
    if (std::find(kept.begin(), kept.end(), code) == kept.end()) lost.push_back(code);
  }
  if (lost.empty()) return;
  auto info = sized<MienDnaInfo>();
  check(mien_dna_info(dna.get(), &info), nullptr, "cannot examine what was written", path);
  note(session, file.shown + ": version 2." + std::to_string(info.version) + " does not have " +
                    list_of(lost, "and") + ": left out");
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
  const std::vector<char> written = write_dna(file.dna.get(), write, options.output.path, session);
  note_lost_layers(file, written, options.output.path, session);
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
