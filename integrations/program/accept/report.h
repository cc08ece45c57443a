// SPDX-License-Identifier: MIT
// The results of `mien accept` as JSON and as a page that stands alone.
#pragma once

#include "integrations/program/accept/check.h"
#include "integrations/program/accept/content.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

struct AcceptReport {
  std::string mien_version, cpu;
  std::string name, file;  // of the character; empty unless they were asked for
  std::vector<Check> checks;
  Content content;

  bool passed() const;
};

void write_report_json(const AcceptReport& report, Output& output);

/// No scripts, nothing loaded from elsewhere; light and dark.
std::string report_html(const AcceptReport& report);

}  // namespace mien::cli
