// SPDX-License-Identifier: MIT
// The stages of an evaluation in `mien bench`, each by itself.
#pragma once

#include <vector>

#include "integrations/program/commands/bench_measurement.h"

namespace mien::cli {

constexpr size_t kStageActivity = 2;  // of kActivities

/// A stage that the rig has.
struct Stage {
  const char* name;    // of the column
  const char* member;  // of the JSON form
  uint32_t stages;     // MIEN_STAGE_...
};

/// Times are for one character.
struct StageRow {
  const Engine* engine;
  uint32_t characters;
  std::vector<double> ns;  // as StageTable::stages
};

struct StageTable {
  uint32_t lod;
  std::vector<Stage> stages;  // the last one is all of them
  std::vector<StageRow> rows;
};

/// Rows of one and of kInstances characters for each engine, at the finest LOD that is measured.
StageTable measure_stages(const Measurement& measurement, const BenchPlan& plan,
                          const Session& session);

}  // namespace mien::cli
