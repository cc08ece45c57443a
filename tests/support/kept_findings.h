// SPDX-License-Identifier: MIT
// A sink for the findings of an examination, and questions to it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/load/dna/check/dna_check.h"

namespace mien::dna {

/// Keeps what it is told, up to `enough`; a report after that fails the test.
struct KeptFindings {
  struct Kept {
    Status status;
    uint64_t byte_offset;
    std::string field, message;
  };
  std::vector<Kept> findings;
  size_t enough = SIZE_MAX;  // end the examination after as many

  static bool keep(void* user, const Finding& f) {
    KeptFindings& report = *static_cast<KeptFindings*>(user);
    EXPECT_LT(report.findings.size(), report.enough) << "reported after the sink had enough";
    report.findings.push_back({f.status, f.byte_offset, f.field, f.message});
    return report.findings.size() < report.enough;
  }
  FindingSink sink(bool thorough) { return {this, keep, thorough}; }

  size_t errors() const {
    size_t n = 0;
    for (const Kept& f : findings) n += f.status != Status::kOk;
    return n;
  }
  bool has(Status status, const std::string& field) const {
    for (const Kept& f : findings) {
      if (f.status == status && f.field == field) return true;
    }
    return false;
  }
  std::string text() const {
    std::string all;
    for (const Kept& f : findings) {
      all += std::string(status_name(f.status)) + " " + f.field + ": " + f.message + "\n";
    }
    return all.empty() ? "no findings" : all;
  }
};

/// All checks, as the reader does them.
inline bool check(const DnaView& view, KeptFindings& report, bool thorough) {
  const FindingSink sink = report.sink(thorough);
  if (!check_definition(view, sink)) return false;
  return report.errors() != 0 || check_layers(view, sink);
}

}  // namespace mien::dna
