// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "integrations/program/accept/report.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr char kStyle[] = R"(
:root { color-scheme: light dark; --ink: #1d2430; --soft: #667085; --line: #e3e7ee; --page: #f6f7f9;
  --card: #fff; --bar: #3b6fd4; --good: #14794a; --bad: #b42318; --none: #667085; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8ebf1; --soft: #98a2b3; --line: #2c3442;
  --page: #12161d; --card: #1a202a; --bar: #6c9bf2; --good: #4cc38a; --bad: #ff8379; --none: #98a2b3; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", sans-serif; }
main { max-width: 1040px; margin: 0 auto; padding: 40px 24px 64px; }
header { display: flex; flex-wrap: wrap; align-items: baseline; gap: 8px 16px; margin-bottom: 24px; }
h1 { font-size: 26px; margin: 0; letter-spacing: -.01em; }
h2 { font-size: 17px; margin: 36px 0 12px; }
h3 { font-size: 14px; margin: 0 0 10px; font-weight: 600; }
p.facts { margin: 0; color: var(--soft); }
.verdict { font-weight: 600; padding: 2px 12px; border-radius: 99px; color: #fff; }
.verdict.good { background: #14794a; color: #fff; } .verdict.bad { background: #b42318; color: #fff; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 16px 18px; }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; padding: 8px 12px 8px 0; border-top: 1px solid var(--line); vertical-align: top; }
tbody:first-child tr:first-child td { border-top: 0; }
thead th { border-top: 0; color: var(--soft); font-weight: 500; font-size: 13px; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; padding-right: 20px; }
td.state { white-space: nowrap; font-weight: 600; width: 1%; padding-right: 20px; }
td.name { white-space: nowrap; }
.good { color: var(--good); } .bad { color: var(--bad); } .none { color: var(--none); }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 10px; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 10px 14px; }
.tile b { display: block; font-size: 20px; font-weight: 600; font-variant-numeric: tabular-nums; }
.tile span { color: var(--soft); font-size: 13px; }
.charts { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 14px; }
.bar { display: grid; grid-template-columns: 70px 1fr 74px; gap: 10px; align-items: center; font-size: 13px;
  line-height: 1.7; }
.bar i { display: block; height: 10px; background: var(--bar); border-radius: 3px; min-width: 1px; }
.bar span:last-child { text-align: right; font-variant-numeric: tabular-nums; color: var(--soft); }
.scroll { overflow-x: auto; }
footer { margin-top: 40px; color: var(--soft); font-size: 13px; }
)";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : one_line(text)) {
    switch (c) {
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '&': result += "&amp;"; break;
      case '"': result += "&quot;"; break;
      default: result += c;
    }
  }
  return result;
}

/// "RBF controls" of "rbf_controls".
std::string words_of(const std::string& name) {
  std::istringstream parts(name);
  std::string words, word;
  while (std::getline(parts, word, '_')) {
    if (word == "gui" || word == "ml" || word == "rbf" || word == "lod") {
      for (char& c : word) c = static_cast<char>(c - 'a' + 'A');
    }
    if (word == "lods") word = "LODs";
    words += (words.empty() ? "" : " ") + word;
  }
  return escaped(words);
}

std::string checks_table(const std::vector<Check>& checks) {
  std::string html = "<div class=\"card scroll\"><table><tbody>\n";
  for (const Check& check : checks) {
    const char* state = check.skipped ? "none" : check.passed ? "good" : "bad";
    const char* word = check.skipped ? "not checked" : check.passed ? "passed" : "failed";
    html += "<tr><td class=\"state " + std::string(state) + "\">" + word +
            "</td><td class=\"name\">" + escaped(check.name) + "</td><td>" + escaped(check.detail) +
            "</td></tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string tiles(const std::vector<Count>& counts) {
  std::string html = "<div class=\"tiles\">\n";
  for (const Count& count : counts) {
    html += "<div class=\"tile\"><b>" + grouped(count.value) + "</b><span>" + words_of(count.name) +
            "</span></div>\n";
  }
  return html + "</div>\n";
}

std::string chart(const Histogram& histogram) {
  uint64_t most = 1;
  for (const Histogram::Bar& bar : histogram.bars) most = std::max(most, bar.value);
  std::string html = "<div class=\"card\"><h3>" + words_of(histogram.name) + "</h3>\n";
  for (const Histogram::Bar& bar : histogram.bars) {
    char width[32];
    std::snprintf(width, sizeof(width), "%.1f%%", 100.0 * double(bar.value) / double(most));
    html += "<div class=\"bar\"><span>" + escaped(bar.label) + "</span><i style=\"width:" + width +
            "\"></i><span>" + grouped(bar.value) + "</span></div>\n";
  }
  return html + "</div>\n";
}

std::string timing_table(const std::vector<Timing>& timings) {
  std::vector<std::string> isas;
  uint32_t lods = 0;
  for (const Timing& timing : timings) {
    if (isas.empty() || isas.back() != timing.isa) isas.push_back(timing.isa);
    lods = std::max(lods, timing.lod + 1);
  }
  std::string html = "<div class=\"card scroll\"><table><thead><tr><th>LOD</th>";
  for (const std::string& isa : isas) html += "<th class=\"number\">" + escaped(isa) + "</th>";
  html += "</tr></thead><tbody>\n";
  for (uint32_t lod = 0; lod < lods; ++lod) {
    html += "<tr><td>" + std::to_string(lod) + "</td>";
    for (const Timing& timing : timings) {
      if (timing.lod != lod) continue;
      char text[32];
      std::snprintf(text, sizeof(text), "%.1f", timing.microseconds);
      html += "<td class=\"number\">" + std::string(text) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string report_html(const AcceptReport& report) {
  const bool passed = report.passed();
  const std::string title =
      report.name.empty() ? "DNA " + report.content.version : escaped(report.name);
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Acceptance of " +
      title + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<main>\n";
  html += "<header><h1>Acceptance of " + title + "</h1><span class=\"verdict " +
          (passed ? "good\">passed" : "bad\">failed") + "</span></header>\n";
  html += "<p class=\"facts\">Version " + report.content.version + ", " +
          size_text(report.content.bytes);
  if (!report.file.empty()) html += ", " + escaped(report.file);
  html += "</p>\n<h2>Checks</h2>\n" + checks_table(report.checks);
  html += "<h2>Content</h2>\n" + tiles(report.content.counts);
  html += "<h2>Distribution</h2>\n<div class=\"charts\">\n";
  for (const Histogram& histogram : report.content.histograms) html += chart(histogram);
  html += "</div>\n<h2>Evaluation, microseconds per character</h2>\n" +
          timing_table(report.content.timings);
  html += "<footer>mien " + escaped(report.mien_version) + " on " + escaped(report.cpu);
  html += report.name.empty()
              ? ". This report has no name, position, weight or control value of the character."
              : ".";
  return html + "</footer>\n</main>\n</body>\n</html>\n";
}

}  // namespace mien::cli
