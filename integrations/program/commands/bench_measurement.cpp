// SPDX-License-Identifier: MIT
#include "integrations/program/commands/bench_measurement.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "integrations/program/commands/bench_clock.h"
#include "integrations/program/io/dna_fields.h"

namespace mien::cli {

namespace {

// A single instance is quick to measure, so each round takes more samples of it.
constexpr size_t kSamplesOfOne = 5;

/// `activity` is the share of controls that are not zero.
ControlSets draw_controls(size_t count, double activity, std::mt19937& random) {
  ControlSets sets = {count, std::vector<float>(count * kManyInstances),
                      std::vector<float>(count * kInstances)};
  const auto active = static_cast<size_t>(std::lround(activity * static_cast<double>(count)));
  std::vector<size_t> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = i;
  // Not std::shuffle, whose result depends on the standard library.
  const auto shuffle = [&] {
    for (size_t i = 0; i + 1 < count; ++i) std::swap(order[i], order[i + random() % (count - i)]);
  };
  const auto draw = [&](float* controls) {
    for (size_t i = 0; i < active; ++i) {
      controls[order[i]] = static_cast<float>((random() >> 8) + 1) / 16777216.0f;  // in (0, 1]
    }
  };
  shuffle();
  for (size_t c = 0; c < kInstances; ++c) draw(sets.shared.data() + c * count);
  for (size_t c = 0; c < kManyInstances; ++c) {
    shuffle();
    draw(sets.own.data() + c * count);
  }
  return sets;
}

Engine make_engine(const BenchSource& source, const MienRigDesc& desc) {
  Engine engine;
  engine.rig = source.make_rig(desc);
  engine.info = rig_info(engine.rig.get());
  for (uint32_t c = 0; c < kManyInstances; ++c) {
    auto error = sized<MienError>();
    MienInstance* made = nullptr;
    check(mien_instance_create(engine.rig.get(), nullptr, &made, &error), &error,
          "cannot create instances", source.shown);
    engine.instances.emplace_back(made);
    engine.handles.push_back(made);
    MienMutableFloatView raw{};
    check(mien_instance_raw_controls(made, &raw), nullptr, "cannot create instances", source.shown);
    engine.raw.push_back(raw);
  }
  auto error = sized<MienError>();
  MienBatch* batch = nullptr;
  MienBatchDesc batch_desc = mien_batch_desc_default();
  batch_desc.capacity = kManyInstances;
  check(mien_batch_create(engine.rig.get(), &batch_desc, &batch, &error), &error,
        "cannot create a batch", source.shown);
  engine.batch.reset(batch);
  return engine;
}

std::vector<bench::DenseGroup> read_groups(const RigFile& file) {
  const std::string list = "bhvr.joints.jointGroups";
  std::vector<bench::DenseGroup> groups(field_count(file, list));
  for (size_t i = 0; i < groups.size(); ++i) {
    groups[i].lods = read_integers(file, element(list, i, ".lods"));
    groups[i].inputs = read_integers(file, element(list, i, ".inputIndices"));
    groups[i].outputs = read_integers(file, element(list, i, ".outputIndices"));
    groups[i].values = read_floats(file, element(list, i, ".values"));
  }
  return groups;
}

void prepare_csr(Measurement& made, const RigFile& file, std::mt19937& random) {
  const std::vector<bench::DenseGroup> groups = read_groups(file);
  const MienRigInfo& info = made.engines[0].info;
  for (const uint32_t lod : made.lods) {
    made.csr.push_back({lod, bench::make_csr(groups, lod, info.joint_value_count), {}});
  }
  made.csr_y.resize(info.joint_value_count);
  made.csr_x.resize(info.control_count);
  for (float& x : made.csr_x) x = static_cast<float>(random() >> 8) / 16777216.0f;
}

/// Bytes of the joint matrix that the evaluation of one instance reads: the mean over kInstances.
uint64_t bytes_touched(const Engine& engine, uint32_t lod, const ControlSets& controls,
                       bool shared) {
  set_controls(engine, kInstances, controls, shared, 0);
  Evaluator evaluate(engine, lod, kInstances);
  evaluate(MIEN_STAGE_ALL);
  evaluate.check_status();
  uint64_t sum = 0;
  for (uint32_t c = 0; c < kInstances; ++c) {
    auto statistics = sized<MienInstanceStatistics>();
    check(mien_instance_statistics(engine.handles[c], &statistics), nullptr,
          "cannot read statistics", "");
    sum += statistics.joint_byte_count;
  }
  return sum / kInstances;
}

void sample_row(BenchRow& row, const ControlSets& controls, size_t number) {
  // A single instance has other controls in every sample.
  set_controls(*row.engine, row.instances, controls, row.shared, number);
  Evaluator evaluate(*row.engine, row.lod, row.instances);
  const auto time = [&](uint32_t stages) { return time_per_pass([&] { evaluate(stages); }); };
  evaluate(MIEN_STAGE_ALL);  // resets what another LOD has written
  const double evaluate_ns = time(MIEN_STAGE_ALL);
  const double joints_ns = time(MIEN_STAGE_JOINTS);
  evaluate.check_status();
  row.evaluate_samples.push_back(evaluate_ns / row.instances);
  row.joints_samples.push_back(joints_ns / row.instances);
}

void sample_csr(CsrRow& row, Measurement& measurement) {
  const auto pass = [&] {
    bench::multiply(row.matrix, measurement.csr_x.data(), measurement.csr_y.data());
  };
  pass();
  row.samples.push_back(time_per_pass(pass));
  for (const float y : measurement.csr_y) measurement.csr_sum += y;
}

}  // namespace

void set_controls(const Engine& engine, uint32_t instances, const ControlSets& controls,
                  bool shared, size_t from) {
  for (uint32_t c = 0; c < instances; ++c) {
    const size_t sets = std::max(instances, kInstances);
    const float* source = controls.of(shared, (c + from) % sets);
    std::copy(source, source + controls.count, engine.raw[c].data);
  }
}

void Evaluator::operator()(uint32_t stages) {
  const MienRig* rig = engine_.rig.get();
  status_ |= lods_.size() == 1 ? mien_rig_evaluate_stages(rig, engine_.handles[0], lods_[0], stages)
                               : mien_rig_evaluate_batch(
                                     rig, engine_.batch.get(), engine_.handles.data(), lods_.data(),
                                     static_cast<uint32_t>(lods_.size()), stages, nullptr);
}

void Evaluator::check_status() const {
  if (status_ != MIEN_OK) check(status_, nullptr, "cannot evaluate", "");
}

Measurement prepare_measurement(const BenchSource& source, const std::vector<MienRigDesc>& descs,
                                const std::function<std::vector<uint32_t>(uint32_t)>& choose_lods) {
  Measurement made;
  std::mt19937 random(20240229);
  for (const MienRigDesc& desc : descs) made.engines.push_back(make_engine(source, desc));
  const MienRig* first = made.engines[0].rig.get();
  for (const double activity : kActivities) {
    made.controls.push_back(
        draw_controls(rig_count(first, MIEN_KIND_RAW_CONTROL), activity, random));
  }
  made.lods = choose_lods(made.engines[0].info.lod_count);
  std::vector<uint64_t>
      bytes;  // [number of the lod][activity][shared]: the same for each instruction set
  for (const uint32_t lod : made.lods) {
    for (const ControlSets& controls : made.controls) {
      for (const bool shared : {false, true}) {
        bytes.push_back(bytes_touched(made.engines[0], lod, controls, shared));
      }
    }
  }
  for (const Engine& engine : made.engines) {
    for (size_t l = 0; l < made.lods.size(); ++l) {
      const uint32_t lod = made.lods[l];
      for (size_t activity = 0; activity < kActivityCount; ++activity) {
        const uint64_t* of_row = &bytes[(l * kActivityCount + activity) * 2];
        made.rows.push_back({&engine, lod, activity, 1, false, of_row[0], {}, {}});
        made.rows.push_back({&engine, lod, activity, kInstances, false, of_row[0], {}, {}});
        made.rows.push_back({&engine, lod, activity, kInstances, true, of_row[1], {}, {}});
      }
    }
  }
  for (const Engine& engine : made.engines) {
    made.rows.push_back({&engine,
                         made.lods[0],
                         kManyActivity,
                         kManyInstances,
                         false,
                         bytes[2 * kManyActivity],
                         {},
                         {}});
  }
  if (source.dna) prepare_csr(made, *source.dna, random);
  return made;
}

void measure(Measurement& measurement, const BenchPlan& plan, const Session& session) {
  const double start = work_ns();
  Progress progress(session, "measuring", 1);
  // Both the least number of rounds and the time have to be reached.
  const auto share = [&](size_t round, size_t row) {
    const double rounds = static_cast<double>(round) +
                          static_cast<double>(row) / static_cast<double>(measurement.rows.size());
    return std::min(rounds / static_cast<double>(plan.min_rounds),
                    (work_ns() - start) / (plan.seconds * 1e9));
  };
  for (size_t round = 0; round < plan.max_rounds; ++round) {
    if (round >= plan.min_rounds && work_ns() - start > plan.seconds * 1e9) break;
    size_t done = 0;
    for (CsrRow& row : measurement.csr) {
      for (size_t i = 0; i < kSamplesOfOne; ++i) sample_csr(row, measurement);
    }
    for (BenchRow& row : measurement.rows) {
      progress.at_share(share(round, done++));
      const size_t samples = row.instances == 1 ? kSamplesOfOne : 1;
      for (size_t i = 0; i < samples; ++i) {
        sample_row(row, measurement.controls[row.activity], round * samples + i);
      }
    }
  }
  for (CsrRow& row : measurement.csr) row.joints_ns = median(row.samples);
  for (BenchRow& row : measurement.rows) {
    row.evaluate_ns = median(row.evaluate_samples);
    row.joints_ns = median(row.joints_samples);
  }
}

}  // namespace mien::cli
