// SPDX-License-Identifier: MIT
// mien validate: everything that is wrong with a DNA file.
#include "integrations/cli/commands/commands.h"
#include "integrations/cli/io/json_writer.h"
#include "integrations/cli/io/output.h"
#include "integrations/cli/io/rig_file.h"
#include "integrations/cli/io/text.h"

namespace mien::cli {

namespace {

struct ValidateOptions {
  std::string rig;
  bool json = false;
};

std::vector<MienFinding> gather(const MienReport* report, uint32_t count,
                                const std::string& shown) {
  std::vector<MienFinding> findings;
  for (uint32_t i = 0; i < count; ++i) {
    auto finding = sized<MienFinding>();
    check(mien_report_finding(report, i, &finding), nullptr, "cannot examine rig", shown);
    findings.push_back(finding);
  }
  return findings;
}

const char* severity_word(const MienFinding& finding) {
  return finding.severity == MIEN_SEVERITY_WARNING ? "warning" : "error";
}

std::string count_text(uint32_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void write_json(const std::string& shown, const std::vector<MienFinding>& findings, uint32_t errors,
                uint32_t warnings) {
  Output output("-");
  JsonWriter json(output);
  json.begin_object(JsonWriter::Layout::kLines);
  json.member("file", shown);
  json.member("valid", errors == 0);
  json.member("errors", errors);
  json.member("warnings", warnings);
  json.key("findings");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const MienFinding& finding : findings) {
    json.begin_object();
    json.member("severity", severity_word(finding));
    json.member("status", mien_status_name(finding.status));
    json.member("field", to_string(finding.field));
    json.key("offset");
    if (finding.byte_offset == MIEN_NO_OFFSET) {
      json.null();
    } else {
      json.value(finding.byte_offset);
    }
    json.member("message", to_string(finding.message));
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
  output.commit();
}

void write_text(const std::string& shown, const std::vector<MienFinding>& findings,
                uint32_t warnings, bool valid, const Session& session) {
  const bool colors = session.terminal.out_colors;
  Output output("-");
  for (const MienFinding& finding : findings) {
    const bool warning = finding.severity == MIEN_SEVERITY_WARNING;
    std::string line =
        paint(severity_word(finding), warning ? Style::kYellow : Style::kRed, colors);
    if (finding.field.count != 0) line += " " + one_line(to_string(finding.field));
    if (finding.byte_offset != MIEN_NO_OFFSET)
      line += ", byte " + std::to_string(finding.byte_offset);
    output.write(line + ": " + one_line(to_string(finding.message)) + "\n");
  }
  if (valid && !session.quiet) {
    const std::string verdict = warnings ? "valid, " + count_text(warnings, "warning") : "valid";
    output.write(one_line(shown) + ": " + paint(verdict, Style::kGreen, colors) + "\n");
  }
  output.commit();
}

void run(const ValidateOptions& options, const Session& session) {
  const std::string shown = shown_name(options.rig);
  std::string bytes;
  MienReport* made = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  if (options.rig == "-") {
    bytes = read_standard_input();
    status = mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &made, &error);
  } else {
    status = mien_dna_validate_file(options.rig.c_str(), nullptr, &made, &error);
  }
  check(status, &error, "cannot validate", shown);
  const Report report(made);

  uint32_t errors = 0, warnings = 0;
  check(mien_report_counts(made, &errors, &warnings), nullptr, "cannot validate", shown);
  const std::vector<MienFinding> findings = gather(made, errors + warnings, shown);
  if (options.json) {
    write_json(shown, findings, errors, warnings);
  } else {
    write_text(shown, findings, warnings, errors == 0, session);
  }
  if (errors != 0) {
    fail(kInvalid, "not valid", shown,
         count_text(errors, "error") + ", " + count_text(warnings, "warning"),
         "repair the file, or export it again");
  }
}

}  // namespace

Command add_validate_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* validate =
      app.add_subcommand("validate", "Check a rig and list everything that is wrong");
  validate->add_option("RIG", options->rig, "DNA file; - reads standard input")
      ->type_name("")
      ->required();
  validate->add_flag("--json", options->json, "JSON, for other programs");
  validate->footer(
      "Exits with 0 if there are no errors (there may be warnings), with 2 if there are.\n\n"
      "Examples:\n"
      "  mien validate head.dna\n"
      "  mien validate head.dna --json | jq '.findings[].field'");
  return {validate, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
