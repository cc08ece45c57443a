// SPDX-License-Identifier: MIT
// mien extract: DNA files out of other files, such as .uasset.
#include "integrations/program/commands/options.h"
#include "integrations/program/io/dna_streams.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr char kCannotExtract[] = "cannot extract";

struct ExtractOptions {
  std::string input, index;
  bool list = false, json = false;
  OutputFile output;
};

std::string version_of(const DnaStream& stream) { return "2." + std::to_string(stream.version); }

void write_json(const FoundStreams& found, Output& output) {
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.key("streams");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const DnaStream& stream : found.streams) {
    json.begin_object();
    json.member("offset", stream.offset);
    json.member("size", stream.size);
    json.member("version", version_of(stream));
    json.member("name", stream.name);
    json.member("truncated", stream.truncated);
    json.key("problem");
    if (stream.problem.empty()) {
      json.null();
    } else {
      json.value(stream.problem);
    }
    json.end_object();
  }
  json.end_array();
  json.key("compressed_payloads");
  json.begin_object();
  json.member("oodle", found.oodle_payloads);
  json.member("lz4", found.lz4_payloads);
  json.end_object();
  json.end_object();
  json.finish();
}

std::string text_of(const FoundStreams& found) {
  std::string text = "index       offset         size  version  name\n";
  for (size_t i = 0; i < found.streams.size(); ++i) {
    const DnaStream& stream = found.streams[i];
    char line[96];
    std::snprintf(line, sizeof(line), "%5zu %12llu %12llu  %-7s  ", i,
                  static_cast<unsigned long long>(stream.offset),
                  static_cast<unsigned long long>(stream.size), version_of(stream).c_str());
    text += line + one_line(stream.name);
    if (stream.truncated) text += "(truncated) ";
    if (!stream.problem.empty()) text += "refused: " + one_line(stream.problem);
    text += "\n";
  }
  return text;
}

const DnaStream& chosen(const FoundStreams& found, const ExtractOptions& options,
                        const std::string& shown) {
  const size_t count = found.streams.size();
  if (options.index.empty()) {
    if (count == 1) return found.streams[0];
    fail(kInvalid, kCannotExtract, shown, list_of_streams(found), "choose one with --index");
  }
  const uint64_t index = parse_number("--index", options.index, 1000000);
  if (index >= count) {
    fail(kInvalid, kCannotExtract, shown,
         "there is no stream " + options.index + "; " + list_of_streams(found),
         "choose another --index");
  }
  return found.streams[index];
}

void run(const ExtractOptions& options, const Session& session) {
  const bool listing = options.list || options.json;
  if (!listing && options.output.path.empty()) {
    fail(kInvalid, kCannotExtract, shown_name(options.input), "nothing to do",
         "give -o FILE, or --list to see what is in it");
  }
  if (!options.output.path.empty()) {
    refuse_terminal(options.output.path, session, "a DNA file");
    refuse_replacing(options.output, {options.input});
  }
  FileBytes file(options.input);
  const FoundStreams found = find_dna_streams(file);
  if (found.streams.empty()) {
    fail(kInvalid, kCannotExtract, file.shown(), why_no_stream(found),
         "give a file that holds a DNA stream uncompressed");
  }
  if (listing) {
    Output out("-");
    if (options.json) {
      write_json(found, out);
    } else {
      out.write(text_of(found));
    }
    out.commit();
  }
  if (options.output.path.empty()) return;
  const DnaStream& stream = chosen(found, options, file.shown());
  if (stream.truncated) {
    fail(kInvalid, kCannotExtract,
         file.shown() + ", DNA stream at byte " + std::to_string(stream.offset), stream.problem,
         "export the file again");
  }
  if (!stream.problem.empty()) {
    note(session,
         file.shown() + ": written as it is, but the reader refuses it: " + stream.problem);
  }
  Output out(options.output.path);
  out.write(file.read(stream.offset, stream.size));
  out.commit();
}

}  // namespace

Command add_extract_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<ExtractOptions>();
  CLI::App* extract =
      app.add_subcommand("extract", "Extract DNA files from other files, such as .uasset");
  extract->add_option("FILE", options->input, "Any file; - reads standard input")
      ->type_name("")
      ->required();
  add_output_options(*extract, options->output, "DNA file to write; - is standard output");
  extract->add_option("--index", options->index, "Which stream to write, where there are several")
      ->type_name("N");
  extract->add_flag("--list", options->list, "List the streams: offset, size, version, name");
  extract->add_flag("--json", options->json, "List them as JSON");
  extract->footer(
      "Finds a DNA file inside another file by its own structure, so any format works if the DNA\n"
      "is stored in one piece and uncompressed: assets (.uasset, .uexp, .ubulk) and archives\n"
      "(.pak) without compression. Writes the stream byte for byte. Commands that take a DNA file\n"
      "also take a file that contains one such stream.\n\n"
      "Examples:\n"
      "  mien extract Ada_FaceMesh_DNA.uasset --list\n"
      "  mien extract Ada_FaceMesh_DNA.uasset -o ada.dna\n"
      "  mien info Ada_FaceMesh_DNA.uasset");
  return {extract, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
