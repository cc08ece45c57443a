// SPDX-License-Identifier: MIT
// mien edit: a DNA file changed, by options that are applied one after the other, all or none.
#include <exception>

#include "integrations/program/commands/edit_options.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/diff/dna_diff.h"
#include "integrations/program/edit/json_document.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

struct EditCommand {
  std::string input;
  OutputFile output;
  std::vector<Edit> edits;
  bool dry_run = false;
  bool from_json = false;
  bool to_json = false;
};

Dna finished(const Document& document) {
  MienDna* dna = nullptr;
  auto error = sized<MienError>();
  check(mien_document_to_dna(document.get(), nullptr, &dna, &error), &error, "cannot edit",
        document.shown);
  return Dna(dna);
}

RigFile open_edited_file(const EditCommand& command, const Session& session) {
  auto desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_ALL;
  desc.unknown_layers = MIEN_UNKNOWN_LAYERS_KEEP;
  desc.file_access = MIEN_FILE_MAP;
  return open_rig_file(command.input, desc, session);
}

/// A script is applied where it is named.
std::vector<Edit> with_scripts(const std::vector<Edit>& edits) {
  std::vector<Edit> all;
  for (const Edit& edit : join_options(edits)) {
    if (edit.option != "--script") {
      all.push_back(edit);
      continue;
    }
    const std::vector<Edit> script = read_edit_script(edit.value);
    all.insert(all.end(), script.begin(), script.end());
  }
  return all;
}

void print_dry_run(const EditCommand& command, Document document, const std::vector<Edit>& edits,
                   const Session& session) {
  // A file is opened again at the end, in place of the document.
  const bool again = !command.from_json && !is_stream(command.input);
  RigFile before;
  if (!again) before.dna = finished(document);
  const std::vector<std::string> done = apply_edits(document, edits);
  const Dna after = finished(document);
  document.handle.reset();
  if (again) before = open_edited_file(command, session);
  Output output("-");
  for (const std::string& sentence : done) output.write(sentence + "\n");
  output.write(diff_text(diff_dna(before.dna.get(), after.get())));
  output.commit();
}

/// Passes pieces of a file to the output. Exceptions wait until the library has returned.
struct OutputSink {
  Output output;
  std::exception_ptr failure;

  explicit OutputSink(const std::string& path) : output(path) {}
  static size_t MIEN_CALLBACK write(void* user, const void* bytes, size_t size) {
    OutputSink& self = *static_cast<OutputSink*>(user);
    try {
      self.output.write(bytes, size);
      return size;
    } catch (...) {
      self.failure = std::current_exception();
      return 0;
    }
  }
};

void write_document(Document document, const std::string& path, const Session& session) {
  auto desc = sized<MienWriteDesc>();
  desc.version = document.version;
  auto error = sized<MienError>();
  OutputSink sink(path);
  const MienByteSink bytes = {&sink, OutputSink::write};
  const MienStatus status = mien_document_write_stream(document.get(), &bytes, &desc, &error);
  if (sink.failure) std::rethrow_exception(sink.failure);
  check(status, &error, "cannot edit", document.shown);
  document.handle.reset();  // on Windows a mapped file cannot be replaced
  sink.output.commit();
  note_written(session, path, sink.output.size());
}

void run(const EditCommand& command, const Session& session) {
  if (command.output.path.empty() && !command.dry_run) {
    fail_usage("mien edit", "there is no file to write", "give -o OUT.dna, or --dry-run");
  }
  if (!command.dry_run) {
    if (!command.to_json) refuse_terminal(command.output.path, session, "a DNA file");
    refuse_replacing(command.output, {});  // a file may be edited in place
  }
  const std::vector<Edit> edits = with_scripts(command.edits);
  Document document = command.from_json ? read_json_document(command.input, session)
                                        : open_document(command.input, session);
  if (command.dry_run) return print_dry_run(command, std::move(document), edits, session);
  const std::vector<std::string> done = apply_edits(document, edits);
  if (command.to_json) {
    if (document.version != 0) {
      fail_usage("mien edit", "--version goes with a DNA file", "leave out --to-json or --version");
    }
    Output output(command.output.path);
    write_json_document(document, output);
    output.commit();
    note_written(session, command.output.path, output.size());
    return;
  }
  for (const std::string& sentence : done) note(session, document.shown + ": " + sentence);
  write_document(std::move(document), command.output.path, session);
}

}  // namespace

Command add_edit_command(CLI::App& app, const Session& session) {
  auto command = std::make_shared<EditCommand>();
  CLI::App* edit = app.add_subcommand("edit", "Change a DNA file: names, joints, meshes, LODs");
  edit->add_option("IN", command->input, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*edit, command->output, "File to write; - is standard output");
  edit->add_flag("-n,--dry-run", command->dry_run, "Print what would change, and write nothing");
  edit->add_flag("--to-json", command->to_json, "Write lossless JSON, for version control");
  edit->add_flag("--from-json", command->from_json, "IN is JSON that --to-json wrote");
  const auto add = [&](const char* name, const char* type_name, const char* text) {
    return edit
        ->add_option_function<std::string>(
            name,
            [command, name](const std::string& value) {
              command->edits.push_back({name, value, ""});
            },
            text)
        ->type_name(type_name)
        ->trigger_on_parse();
  };
  add("--script", "COMMANDS.json", "Edits from a file, a list of [\"--option\", \"value\"]");
  for (const EditOption& option : edit_options()) {
    add(option.name, option.type_name, option.text)->group(option.group);
  }
  edit->footer(
      "Edits are applied in the order in which they are given, all of them or, if one fails, "
      "none.\n"
      "What is not named stays as it was, byte for byte. IN and OUT may be the same file. See\n"
      "docs/editing.md.\n\n"
      "Examples:\n"
      "  mien edit head.dna --rename joint:FACIAL_C_Jaw=jaw -o engine.dna\n"
      "  mien edit head.dna --lods 2-7 --clear blend-shapes -o phone.dna\n"
      "  mien edit head.dna --conform head_lod0_mesh=sculpt.obj -o reshaped.dna\n"
      "  mien edit head.dna --remove mesh:eyelashes_lod0_mesh --dry-run\n"
      "  mien edit head.dna --script edits.json -o out.dna\n"
      "  mien edit head.dna --to-json -o head.json\n"
      "  mien edit head.json --from-json -o head.dna");
  return {edit, [command, &session] { run(*command, session); }};
}

}  // namespace mien::cli
