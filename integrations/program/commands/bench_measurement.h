// SPDX-License-Identifier: MIT
// The measurements of `mien bench`.
//
//     rows (instruction set, LOD, activity, instances) and the CSR rows  ->  rounds over all of them,
//     a few samples of each per round  ->  medians
//
// Samples repeat their controls, so the rigs reuse no results; bench_evaluate measures rigs that do.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "integrations/program/baseline/csr_matrix.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

/// Shares of the raw controls that are not zero.
constexpr double kActivities[] = {0.05, 0.08, 0.25, 0.5, 1.0};
constexpr size_t kActivityCount = std::size(kActivities);

constexpr uint32_t kInstances = 64;
/// The rows of stages and of frames.
constexpr uint32_t kCharacters[] = {1, kInstances};

// Many instances of LOD 0 at one activity.
constexpr uint32_t kManyInstances = 512;
constexpr size_t kManyActivity = 1;  // of kActivities

/// Rounds go on until both `min_rounds` and `seconds` are reached, or `max_rounds`.
struct BenchPlan {
  size_t min_rounds, max_rounds;
  double seconds;
};
constexpr BenchPlan kFullPlan = {15, 500, 20.0};
constexpr BenchPlan kQuickPlan = {2, 25, 2.0};

/// What is measured: a rig can be made for each desc. The matrix of a DNA file also gives the CSR
/// rows; a baked file has no such matrix.
struct BenchSource {
  std::string shown;
  std::function<Rig(const MienRigDesc&)> make_rig;
  const RigFile* dna = nullptr;
};

/// Raw controls of all instances at one activity: [instance][control].
struct ControlSets {
  size_t count;               // controls of one instance
  std::vector<float> own;     // kManyInstances: each has active controls of its own
  std::vector<float> shared;  // kInstances: all have the same active controls

  const float* of(bool is_shared, size_t instance) const {
    return (is_shared ? shared : own).data() + instance * count;
  }
};

/// A rig for one instruction set, with its instances.
struct Engine {
  Rig rig;
  MienRigInfo info;
  std::vector<Instance> instances;
  std::vector<MienInstance*> handles;
  std::vector<MienMutableFloatView> raw;
  Batch batch;
};

/// Gives the first instances their controls: set `from` and those after it, in a circle.
void set_controls(const Engine& engine, uint32_t instances, const ControlSets& controls,
                  bool shared, size_t from);

/// Evaluates MIEN_STAGE_... of the first instances at one LOD: several as a batch.
class Evaluator {
 public:
  Evaluator(const Engine& engine, uint32_t lod, uint32_t instances)
      : engine_(engine), lods_(instances, lod) {}

  void operator()(uint32_t stages);
  /// Ends the program if an evaluation failed.
  void check_status() const;

 private:
  const Engine& engine_;
  const std::vector<uint32_t> lods_;
  MienStatus status_ = MIEN_OK;
};

/// One row of the results. Times are for one instance.
struct BenchRow {
  const Engine* engine;
  uint32_t lod;
  size_t activity;  // of kActivities
  uint32_t instances;
  bool shared;             // the same active controls in all instances
  uint64_t bytes_touched;  // of the joint matrix, by one instance: the mean of all
  std::vector<double> evaluate_samples, joints_samples;
  double evaluate_ns = 0, joints_ns = 0;
};

/// The reference of a LOD: its joint matrix in compressed sparse rows.
struct CsrRow {
  uint32_t lod;
  bench::CsrMatrix matrix;
  std::vector<double> samples;
  double joints_ns = 0;
};

struct Measurement {
  std::vector<Engine> engines;
  std::vector<uint32_t> lods;         // that are measured
  std::vector<ControlSets> controls;  // per activity
  // Per engine and LOD and activity: 1 instance, kInstances, kInstances with shared controls. Behind
  // these, kManyInstances of each engine.
  std::vector<BenchRow> rows;
  std::vector<CsrRow> csr;
  std::vector<float> csr_x, csr_y;
  float csr_sum = 0.0f;  // uses the products, so that no compiler leaves them out
};

/// `choose_lods` is given the number of LODs.
Measurement prepare_measurement(const BenchSource& source, const std::vector<MienRigDesc>& descs,
                                const std::function<std::vector<uint32_t>(uint32_t)>& choose_lods);

void measure(Measurement& measurement, const BenchPlan& plan, const Session& session);

}  // namespace mien::cli
