// SPDX-License-Identifier: MIT
// mien accept: checks an exported character, and the results of the library for it.
#include <cmath>
#include <cstdio>

#include "integrations/program/accept/check_deform.h"
#include "integrations/program/accept/check_poses.h"
#include "integrations/program/accept/check_results.h"
#include "integrations/program/accept/report.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/cpu.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/output.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

struct AcceptOptions {
  std::string rig, poses;
  double tolerance = 0.01, rotation_tolerance = 0.1;
  OutputFile report;
  bool names = false;
};

enum class ReportFormat { kNone, kJson, kHtml };

ReportFormat format_of(const std::string& path) {
  const auto ends = [&](const std::string& end) {
    return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
  };
  if (path.empty()) return ReportFormat::kNone;
  if (path == "-" || ends(".json")) return ReportFormat::kJson;
  if (ends(".html") || ends(".htm")) return ReportFormat::kHtml;
  fail_usage("--report " + path, "the name does not tell the format",
             "let it end in .json or .html, or write - for JSON on standard output");
}

void check_options(const AcceptOptions& options) {
  for (const double value : {options.tolerance, options.rotation_tolerance}) {
    if (std::isfinite(value) && value >= 0) continue;
    fail_usage("--tolerance", "not a number of 0 or more", "write it as 0.01");
  }
  if (options.rig == "-" && options.poses == "-") {
    fail_usage("--poses -", "standard input cannot be both FILE and poses",
               "put one of them in a file");
  }
  if (options.rig == "-" && !options.poses.empty()) {
    fail_usage("--poses", "FILE is opened again for them, and standard input can be read once",
               "name the file");
  }
}

/// The findings of the validator by their number: their messages may hold names.
Check check_valid(const AcceptedRig& rig, const AcceptOptions& options) {
  MienReport* made = nullptr;
  auto error = sized<MienError>();
  const std::string& bytes = rig.file.bytes;
  const MienStatus status =
      bytes.empty() ? mien_dna_validate_file(options.rig.c_str(), nullptr, &made, &error)
                    : mien_dna_validate_memory(bytes.data(), bytes.size(), nullptr, &made, &error);
  check(status, &error, "cannot validate", rig.file.shown);
  const Report report(made);
  uint32_t errors = 0, warnings = 0;
  check(mien_report_counts(made, &errors, &warnings), nullptr, "cannot validate", rig.file.shown);
  Check result{"valid", errors == 0, false, ""};
  result.detail = std::to_string(errors) + " errors, " + std::to_string(warnings) + " warnings";
  if (errors + warnings != 0) result.detail += "; 'mien validate' lists them";
  return result;
}

std::string text_of(const AcceptReport& report, const Session& session) {
  const bool colors = session.terminal.out_colors;
  std::string text;
  for (const Check& check : report.checks) {
    const std::string word = check.skipped ? "not checked" : check.passed ? "passed" : "failed";
    const Style style = check.skipped ? Style::kYellow : check.passed ? Style::kGreen : Style::kRed;
    text += paint(word, style, colors) + std::string(13 - word.size(), ' ') + check.name + ": " +
            check.detail + "\n";
  }
  return text;
}

std::string version_text() {
  const uint32_t version = mien_version();
  return std::to_string(version >> 24) + "." + std::to_string(version >> 16 & 255) + "." +
         std::to_string(version & 0xffff);
}

void run(const AcceptOptions& options, const Session& session) {
  check_options(options);
  const ReportFormat format = format_of(options.report.path);
  if (format != ReportFormat::kNone) {
    refuse_replacing(options.report, {options.rig, options.poses});
  }
  const AcceptedRig rig = open_accepted_rig(options.rig, session);
  AcceptReport report;
  report.mien_version = version_text();
  report.cpu = cpu_name();
  if (options.names) {
    report.name = read_string(rig.file, "desc.name");
    report.file = rig.file.shown;
  }
  report.checks = {check_valid(rig, options), check_round_trip(rig, options.rig)};
  for (const Check& check : check_model(rig, session)) report.checks.push_back(check);
  report.checks.push_back(check_subsets(rig, options.rig, session));
  report.checks.push_back(check_bake(rig));
  report.checks.push_back(check_deform(rig, session));
  if (!options.poses.empty()) {
    const PoseOptions poses = {options.rig, options.poses, options.tolerance,
                               options.rotation_tolerance, options.names};
    for (const Check& check : check_poses(poses, session)) report.checks.push_back(check);
  }
  report.content = content_of(rig);

  if (options.report.path != "-" && !session.quiet) {
    Output terminal("-");
    terminal.write(text_of(report, session));
    terminal.commit();
  }
  if (format != ReportFormat::kNone) {
    Output output(options.report.path);
    if (format == ReportFormat::kJson) {
      write_report_json(report, output);
    } else {
      output.write(report_html(report));
    }
    output.commit();
    note_written(session, options.report.path, output.size());
  }
  if (report.passed()) return;
  size_t failed = 0;
  for (const Check& check : report.checks) failed += check.passed ? 0 : 1;
  throw Failure(kUsage, "not accepted, " + rig.file.shown + ": " + std::to_string(failed) + " of " +
                            std::to_string(report.checks.size()) +
                            " checks failed; the report names them");
}

}  // namespace

Command add_accept_command(CLI::App& app, const Session& session) {
  auto options = std::make_shared<AcceptOptions>();
  CLI::App* command = app.add_subcommand(
      "accept", "Check an exported rig: results, round trip, geometry, poses of an engine");
  command->add_option("FILE", options->rig, "DNA file, or .uasset with one inside")
      ->type_name("")
      ->required();
  command
      ->add_option("--poses", options->poses, "Joints baked in an engine, as JSON, to compare with")
      ->type_name("FILE");
  command
      ->add_option("--tolerance", options->tolerance,
                   "Allowed distance of a joint, in the unit of the poses (default: 0.01)")
      ->type_name("LENGTH");
  command
      ->add_option("--rotation-tolerance", options->rotation_tolerance,
                   "Allowed rotation error of a joint, in degrees (default: 0.1)")
      ->type_name("DEGREES");
  command
      ->add_option("--report", options->report.path,
                   "Write a report: .json or .html; - writes JSON to standard output")
      ->type_name("FILE");
  command->add_flag("--force", options->report.force, "Replace a report that is read-only");
  command->add_flag("--names", options->names,
                    "Include the names of the file, the character and joints in the report");
  command->footer(
      "Checks that the file is valid and is written back byte for byte; that all LODs give the\n"
      "results of a model in double precision, on each instruction set of this machine; that\n"
      "each LOD opened alone and the baked rig give the same results; and that meshes are\n"
      "deformed as by the model. The report also has counts, histograms and times, but no names\n"
      "or numbers of the character, so that it can be shared. docs/engine-poses.md explains how\n"
      "to bake poses in an engine. Exits with 0 if every check passes, 1 if one fails, 2 if the\n"
      "file is refused.\n\n"
      "Examples:\n"
      "  mien accept head.dna\n"
      "  mien accept Ada_FaceMesh_DNA.uasset --report ada.html\n"
      "  mien accept head.dna --poses jaw.json --tolerance 0.02");
  return {command, [options, &session] { run(*options, session); }};
}

}  // namespace mien::cli
