// SPDX-License-Identifier: MIT
// mien diff: what differs between two DNA files.
#include "integrations/program/commands/options.h"
#include "integrations/program/diff/dna_diff.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

struct DiffCommand {
  std::string before, after;
  LoadOptions load;
  bool json = false;
};

void run(const DiffCommand& command, const Session& session) {
  if (command.before == "-" && command.after == "-") {
    fail_usage("mien diff", "standard input cannot be both files", "put one of them in a file");
  }
  const MienDnaDesc desc = parse_load_options(command.load, MIEN_LAYER_ALL);
  const RigFile before = open_rig_file(command.before, desc, session);
  const RigFile after = open_rig_file(command.after, desc, session);
  const DnaDiff diff = diff_dna(before.dna.get(), after.dna.get());
  Output output("-");
  if (command.json) {
    JsonWriter json(output);
    write_diff(diff, json);
    json.finish();
  } else {
    output.write(diff_text(diff));
  }
  output.commit();
}

}  // namespace

Command add_diff_command(CLI::App& app, const Session& session) {
  auto command = std::make_shared<DiffCommand>();
  CLI::App* diff =
      app.add_subcommand("diff", "Compare two DNA files: names, fields, results of controls");
  diff->add_option("A", command->before, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  diff->add_option("B", command->after, "DNA file to compare with it")->type_name("")->required();
  diff->add_flag("--json", command->json, "Print JSON");
  add_load_options(*diff, command->load);
  diff->footer(
      "Prints names that were added, removed or renamed; fields that differ, with the largest\n"
      "difference of their numbers; and each raw control that, at 1, moves joints or drives blend\n"
      "shapes and animated maps differently at LOD 0. Of lists of different lengths, only the\n"
      "lengths are compared. Prints nothing if all fields are the same.\n\n"
      "Examples:\n"
      "  mien diff before.dna after.dna\n"
      "  mien diff before.dna after.dna --layers definition,behavior --json");
  return {diff, [command, &session] { run(*command, session); }};
}

}  // namespace mien::cli
