// SPDX-License-Identifier: MIT
#include <algorithm>

#include "integrations/program/accept/report.h"
#include "integrations/program/io/json_writer.h"

namespace mien::cli {

bool AcceptReport::passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.passed; });
}

void write_report_json(const AcceptReport& report, Output& output) {
  using Layout = JsonWriter::Layout;
  JsonWriter json(output);
  json.begin_object(Layout::kLines);
  json.member("mien", report.mien_version);
  json.member("cpu", report.cpu);
  if (!report.name.empty()) json.member("name", report.name);
  if (!report.file.empty()) json.member("file", report.file);
  json.member("version", report.content.version);
  json.member("bytes", report.content.bytes);
  json.member("passed", report.passed());
  json.key("checks");
  json.begin_array(Layout::kLines);
  for (const Check& check : report.checks) {
    json.begin_object();
    json.member("name", check.name);
    json.member("passed", check.passed);
    json.member("skipped", check.skipped);
    json.member("detail", check.detail);
    json.end_object();
  }
  json.end_array();
  json.key("counts");
  json.begin_object(Layout::kLines);
  for (const Count& count : report.content.counts) json.member(count.name, count.value);
  json.end_object();
  json.key("histograms");
  json.begin_object(Layout::kLines);
  for (const Histogram& histogram : report.content.histograms) {
    json.key(histogram.name);
    json.begin_object();
    for (const Histogram::Bar& bar : histogram.bars) json.member(bar.label, bar.value);
    json.end_object();
  }
  json.end_object();
  json.key("timings");
  json.begin_array(Layout::kLines);
  for (const Timing& timing : report.content.timings) {
    json.begin_object();
    json.member("isa", timing.isa);
    json.member("lod", timing.lod);
    json.key("evaluate_us");
    json.fixed(timing.microseconds, 2);
    json.end_object();
  }
  json.end_array();
  json.end_object();
  json.finish();
}

}  // namespace mien::cli
