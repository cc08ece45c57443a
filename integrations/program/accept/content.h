// SPDX-License-Identifier: MIT
// The contents of a file as counts and histograms, which do not identify the character.
#pragma once

#include "integrations/program/accept/accepted_rig.h"

namespace mien::cli {

struct Count {
  std::string name;  // "raw_controls"
  uint64_t value;
};

struct Histogram {
  std::string name;  // "influences"
  std::string unit;  // what is counted: "positions"
  struct Bar {
    std::string label;
    uint64_t value;
  };
  std::vector<Bar> bars;
};

/// Time of an evaluation of all stages, with a quarter of the raw controls active.
struct Timing {
  std::string isa;
  uint32_t lod;
  double microseconds;  // median
};

struct Content {
  std::string version;  // "2.5"
  uint64_t bytes = 0;
  std::vector<Count> counts;
  std::vector<Histogram> histograms;
  std::vector<Timing> timings;
};

Content content_of(const AcceptedRig& rig);

}  // namespace mien::cli
