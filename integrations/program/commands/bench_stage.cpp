// SPDX-License-Identifier: MIT
#include "integrations/program/commands/bench_stage.h"

#include <algorithm>

#include "integrations/program/commands/bench_clock.h"

namespace mien::cli {

namespace {

std::vector<Stage> stages_of(const MienRig* rig) {
  std::vector<Stage> stages;
  const auto add = [&](uint32_t kind, const Stage& stage) {
    if (rig_count(rig, kind) > 0) stages.push_back(stage);
  };
  add(MIEN_KIND_ML_CONTROL, {"networks", "ml_ns", MIEN_STAGE_ML});
  add(MIEN_KIND_RBF_SOLVER, {"RBF", "rbf_ns", MIEN_STAGE_RBF});
  add(MIEN_KIND_PSD_CONTROL, {"corrective", "psd_ns", MIEN_STAGE_PSD});
  add(MIEN_KIND_JOINT, {"joints", "joints_ns", MIEN_STAGE_JOINTS});
  add(MIEN_KIND_BLEND_SHAPE_CHANNEL, {"shapes", "blend_shapes_ns", MIEN_STAGE_BLEND_SHAPES});
  add(MIEN_KIND_ANIMATED_MAP, {"maps", "animated_maps_ns", MIEN_STAGE_ANIMATED_MAPS});
  stages.push_back({"all", "evaluate_ns", MIEN_STAGE_ALL});
  return stages;
}

}  // namespace

StageTable measure_stages(const Measurement& measurement, const BenchPlan& plan,
                          const Session& session) {
  StageTable table;
  table.lod = measurement.lods[0];
  table.stages = stages_of(measurement.engines[0].rig.get());
  for (const Engine& engine : measurement.engines) {
    for (const uint32_t characters : kCharacters) {
      table.rows.push_back({&engine, characters, std::vector<double>(table.stages.size())});
    }
  }
  const size_t count = table.stages.size();
  std::vector<std::vector<double>> samples(table.rows.size() * count);
  Progress progress(session, "measuring stages", 1);
  const double start = work_ns();
  for (size_t round = 0; round < plan.max_rounds; ++round) {
    const double share = (work_ns() - start) / (plan.seconds * 1e9);
    if (round >= plan.min_rounds && share > 1) break;
    progress.at_share(std::min(share, 1.0));
    for (size_t r = 0; r < table.rows.size(); ++r) {
      const StageRow& row = table.rows[r];
      set_controls(*row.engine, row.characters, measurement.controls[kStageActivity], false, round);
      Evaluator evaluate(*row.engine, table.lod, row.characters);
      evaluate(MIEN_STAGE_ALL);  // stages read what earlier ones write
      for (size_t s = 0; s < count; ++s) {
        const double ns = time_per_pass([&] { evaluate(table.stages[s].stages); });
        samples[r * count + s].push_back(ns / row.characters);
      }
      evaluate.check_status();
    }
  }
  for (size_t i = 0; i < samples.size(); ++i)
    table.rows[i / count].ns[i % count] = median(samples[i]);
  return table;
}

}  // namespace mien::cli
