// SPDX-License-Identifier: MIT
// mien validate: everything that is wrong with DNA files, and whether baked files can be used.
#include <algorithm>
#include <filesystem>
#include <optional>

#include "integrations/program/commands/commands.h"
#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/dna_streams.h"
#include "integrations/program/io/json_writer.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct ValidateOptions {
  std::vector<std::string> rigs;
  bool json = false;
};

/// Of one file. The findings point into the report.
struct Checked {
  std::string shown;
  bool baked = false;  // without findings: a baked file that is not valid does not open
  Report report;
  uint32_t errors = 0, warnings = 0;
  std::vector<MienFinding> findings;
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

void write_json(const Checked& checked, JsonWriter& json) {
  json.begin_object(JsonWriter::Layout::kLines);
  json.member("file", checked.shown);
  json.member("valid", checked.errors == 0);
  json.member("errors", checked.errors);
  json.member("warnings", checked.warnings);
  json.key("findings");
  json.begin_array(JsonWriter::Layout::kLines);
  for (const MienFinding& finding : checked.findings) {
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
}

std::string text_of(const Checked& checked, const Session& session) {
  const bool colors = session.terminal.out_colors;
  std::string text;
  for (const MienFinding& finding : checked.findings) {
    const bool warning = finding.severity == MIEN_SEVERITY_WARNING;
    text += paint(severity_word(finding), warning ? Style::kYellow : Style::kRed, colors);
    if (finding.field.count != 0) text += " " + one_line(to_string(finding.field));
    if (finding.byte_offset != MIEN_NO_OFFSET)
      text += ", byte " + std::to_string(finding.byte_offset);
    text += ": " + one_line(to_string(finding.message)) + "\n";
  }
  if (checked.errors != 0 || session.quiet) return text;
  std::string verdict = checked.baked ? "valid baked file" : "valid";
  if (checked.warnings) verdict += ", " + count_text(checked.warnings, "warning");
  return text + one_line(checked.shown) + ": " + paint(verdict, Style::kGreen, colors) + "\n";
}

void take_report(Checked& checked, MienStatus status, MienReport* report, const MienError& error) {
  check(status, &error, "cannot validate", checked.shown);
  checked.report.reset(report);
  check(mien_report_counts(report, &checked.errors, &checked.warnings), nullptr, "cannot validate",
        checked.shown);
  checked.findings = gather(report, checked.errors + checked.warnings, checked.shown);
}

// Takes about a second to check.
constexpr uint64_t kLargeBytes = uint64_t{200} << 20;

Checked check_rig(const std::string& rig, const Session& session) {
  Checked checked;
  checked.shown = shown_name(rig);
  std::error_code unknown;
  const uint64_t bytes_of_file = is_stream(rig) ? 0 : std::filesystem::file_size(rig, unknown);
  std::optional<Progress> progress;
  if (!unknown && bytes_of_file > kLargeBytes) {
    progress.emplace(session,
                     "checking " + one_line(checked.shown) + ", " + size_text(bytes_of_file));
  }
  if (is_baked_file(rig)) {
    open_baked_file(rig, sized<MienBakedRigDesc>());
    checked.baked = true;
    return checked;
  }
  std::string bytes;
  MienReport* made = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  if (is_stream(rig)) {
    bytes = read_rig_stream(rig);
    status = mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &made, &error);
  } else {
    status = mien_dna_validate_file(rig.c_str(), nullptr, &made, &error);
  }
  take_report(checked, status, made, error);
  if (checked.findings.empty() || checked.findings[0].status != MIEN_ERROR_DNA_SIGNATURE)
    return checked;

  FileBytes file = is_stream(rig) ? FileBytes(checked.shown, std::move(bytes)) : FileBytes(rig);
  if (const auto inside = only_dna_stream(file, "cannot validate")) {
    const std::string dna = file.read(inside->offset, inside->size);
    checked.shown += ", DNA stream at byte " + std::to_string(inside->offset);
    status = mien_dna_validate_memory(dna.data(), dna.size(), nullptr, &made, &error);
    take_report(checked, status, made, error);
  }
  return checked;
}

Failure invalid(const Checked& checked) {
  return {kInvalid, "not valid, " + checked.shown + ": " + count_text(checked.errors, "error") +
                        ", " + count_text(checked.warnings, "warning") +
                        "; repair the file, or export it again"};
}

void run(const ValidateOptions& options, const Session& session) {
  const auto& rigs = options.rigs;
  if (std::count(rigs.begin(), rigs.end(), "-") > 1) {
    fail_usage("RIG -", "standard input can be read once", "name it once");
  }
  Output output("-");
  JsonWriter json(output);
  const bool several = rigs.size() > 1;
  if (options.json && several) json.begin_array(JsonWriter::Layout::kLines);
  bool has_json = false;
  std::vector<Failure> failures;
  for (const std::string& rig : rigs) {
    try {
      const Checked checked = check_rig(rig, session);
      if (options.json) {
        write_json(checked, json);
        has_json = true;
      } else {
        output.write(text_of(checked, session));
      }
      if (checked.errors != 0) failures.push_back(invalid(checked));
    } catch (const Failure& failure) {
      // The other files are checked all the same.
      failures.push_back(failure);
    }
  }
  if (several && options.json) json.end_array();
  if (options.json && (several || has_json)) json.finish();
  output.commit();
  if (failures.empty()) return;
  for (size_t i = 0; i + 1 < failures.size(); ++i) print_failure(session, failures[i].what());
  // One that cannot be read tells nothing about itself, which weighs more.
  const auto worst = std::max_element(
      failures.begin(), failures.end(),
      [](const Failure& a, const Failure& b) { return a.exit_code < b.exit_code; });
  throw Failure(worst->exit_code, failures.back().what());
}

}  // namespace

Command add_validate_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* validate =
      app.add_subcommand("validate", "Check a rig and list everything that is wrong");
  validate->add_option("RIG", options->rigs, "DNA or baked files; - reads standard input")
      ->type_name("")
      ->required();
  validate->add_flag("--json", options->json, "Print JSON");
  validate->footer(
      "Exits with 0 if there are no errors (there may be warnings), with 2 if there are. All\n"
      "files are checked, even after one that is not valid; --json prints an array for several.\n\n"
      "Examples:\n"
      "  mien validate head.dna\n"
      "  mien validate characters/*.dna --quiet\n"
      "  mien validate head.dna --json | jq '.findings[].field'");
  return {validate, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
