// SPDX-License-Identifier: MIT
// Evaluation by instruction set, LOD and share of active controls, with controls that stay and with frames
// that have nothing in common ("changing"); stages by themselves; and references, so that numbers of two
// machines compare: the joint matrix in compressed rows, and RBF solvers as anyone would write them. For the
// stages of a body, or of a head with networks:
//
//     MIEN_BENCH_RIG=body.dna build/release/bench/bench_evaluate --benchmark_filter='/lod0/25%'
#include <algorithm>
#include <cmath>
#include <random>

#include "bench/bench_support.h"
#include "bench/plain_rbf.h"
#include "integrations/program/baseline/csr_matrix.h"

namespace mien::bench {
namespace {

const MienDna* behavior() {
  static const MienDna* dna = open_rig(kBehaviorLayers, 0);
  return dna;
}

const MienRig* rig_for(uint32_t isa) {
  static const MienRig* rigs[MIEN_ISA_NEON + 1] = {};
  if (!rigs[isa]) rigs[isa] = create_rig(behavior(), isa);
  return rigs[isa];
}

/// The first of a random order of the controls are active: values in (0, 1].
void activate(MienMutableFloatView raw, int percent, uint32_t seed = 7) {
  std::fill(raw.data, raw.data + raw.count, 0.0f);
  std::mt19937 random(seed);
  std::vector<size_t> order(raw.count);
  for (size_t i = 0; i < raw.count; ++i) order[i] = i;
  for (size_t i = 0; i + 1 < raw.count; ++i) {
    std::swap(order[i], order[i + random() % (raw.count - i)]);
  }
  const auto active =
      static_cast<size_t>(std::lround(percent / 100.0 * static_cast<double>(raw.count)));
  for (size_t i = 0; i < active; ++i) {
    raw.data[order[i]] = static_cast<float>((random() >> 8) + 1) / 16777216.0f;
  }
}

// Beside the stages of mien.h: what stands before them, and a part of the joints.
constexpr uint32_t kGuiToRaw = 1u << 30, kTwistSwing = 1u << 31;

void run(const MienRig* rig, MienInstance* instance, uint32_t lod, uint32_t stages,
         uint32_t set_ups) {
  if (stages == kGuiToRaw) {
    require(mien_rig_map_gui_to_raw(rig, instance));
  } else if (stages == kTwistSwing) {
    for (uint32_t s = 0; s < set_ups; ++s)
      require(mien_rig_evaluate_twist_swing(rig, instance, lod, s));
  } else {
    require(mien_rig_evaluate_stages(rig, instance, lod, stages));
  }
}

MienInstance* create_instance(const MienRig* rig, MienMutableFloatView* raw) {
  MienInstance* instance = nullptr;
  MienError error = sized<MienError>();
  require(mien_instance_create(rig, nullptr, &instance, &error), error);
  require(mien_instance_raw_controls(instance, raw));
  return instance;
}

void evaluate(benchmark::State& state, uint32_t isa, uint32_t lod, int percent, uint32_t stages) {
  const MienRig* rig = rig_for(isa);
  MienMutableFloatView raw = {};
  MienInstance* instance = create_instance(rig, &raw);
  activate(raw, percent);
  require(mien_rig_evaluate(rig, instance, lod));
  uint32_t set_ups = 0;
  require(mien_rig_count(rig, MIEN_KIND_TWIST_SWING, &set_ups));
  for (auto _ : state) {
    run(rig, instance, lod, stages, set_ups);
    benchmark::ClobberMemory();
  }
  MienRigStatistics statistics = sized<MienRigStatistics>();
  require(mien_rig_statistics(rig, lod, &statistics));
  state.counters["matrix_bytes"] = static_cast<double>(statistics.joint_byte_count);
  mien_instance_destroy(instance);
}

/// Frames that have nothing in common, in turn: what a branch predictor learns from one is of little use for
/// the next.
constexpr uint32_t kChangingFrames = 64;

void evaluate_changing(benchmark::State& state, uint32_t isa, uint32_t lod, int percent) {
  const MienRig* rig = rig_for(isa);
  MienMutableFloatView raw = {};
  MienInstance* instance = create_instance(rig, &raw);
  std::vector<float> frames;
  for (uint32_t f = 0; f < kChangingFrames; ++f) {
    activate(raw, percent, f);
    frames.insert(frames.end(), raw.data, raw.data + raw.count);
  }
  uint32_t frame = 0;
  for (auto _ : state) {
    std::copy_n(frames.data() + frame * raw.count, raw.count, raw.data);
    frame = (frame + 1) % kChangingFrames;
    require(mien_rig_evaluate(rig, instance, lod));
    benchmark::ClobberMemory();
  }
  mien_instance_destroy(instance);
}

template <class T, class Read>
std::vector<T> read_field(const std::string& path, Read read) {
  MienDnaField field = sized<MienDnaField>();
  MienError error = sized<MienError>();
  require(mien_dna_field(behavior(), path.c_str(), &field, &error), error);
  std::vector<T> values(static_cast<size_t>(field.count));
  require(read(behavior(), path.c_str(), 0, field.count, values.data(), &error), error);
  return values;
}

void csr(benchmark::State& state, uint32_t lod) {
  MienDnaInfo info = sized<MienDnaInfo>();
  require(mien_dna_info(behavior(), &info));
  std::vector<bench::DenseGroup> groups(info.joint_group_count);
  for (size_t g = 0; g < groups.size(); ++g) {
    const std::string at = "bhvr.joints.jointGroups[" + std::to_string(g) + "].";
    groups[g].lods = read_field<int64_t>(at + "lods", mien_dna_read_integers);
    groups[g].inputs = read_field<int64_t>(at + "inputIndices", mien_dna_read_integers);
    groups[g].outputs = read_field<int64_t>(at + "outputIndices", mien_dna_read_integers);
    groups[g].values = read_field<float>(at + "values", mien_dna_read_floats);
  }
  const bench::CsrMatrix matrix = bench::make_csr(groups, lod, size_t{info.joint_count} * 9);
  std::vector<float> x(65536, 0.5f), y(size_t{info.joint_count} * 9);
  for (auto _ : state) {
    bench::multiply(matrix, x.data(), y.data());
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
}

/// All solvers of the file, whatever LOD they belong to; a rig whose LOD 0 has all of them
/// compares.
void plain_rbf(benchmark::State& state) {
  const PlainRbf rbf = read_plain_rbf(behavior());
  const MienRig* rig = rig_for(MIEN_ISA_SCALAR);
  MienMutableFloatView raw = {};
  MienInstance* instance = create_instance(rig, &raw);
  MienFloatView expected = {};
  require(mien_instance_controls(instance, &expected));
  activate(raw, 25);
  require(mien_rig_evaluate_stages(rig, instance, 0, MIEN_STAGE_RBF));
  std::vector<float> controls(expected.data, expected.data + expected.count);
  for (auto _ : state) {
    evaluate(rbf, controls);
    benchmark::DoNotOptimize(controls.data());
    benchmark::ClobberMemory();
  }
  float worst = 0;
  for (size_t i = 0; i < expected.count; ++i) {
    worst = std::fmax(worst, std::fabs(controls[i] - expected.data[i]));
  }
  state.counters["difference"] = worst;  // to what the library gives
  mien_instance_destroy(instance);
}

const int kRegistered = [] {
  MienDnaInfo info = sized<MienDnaInfo>();
  require(mien_dna_info(behavior(), &info));
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    benchmark::RegisterBenchmark(("csr/lod" + std::to_string(lod)).c_str(), csr, lod);
  }
  if (info.rbf_solver_count) benchmark::RegisterBenchmark("plain_rbf/lod0/25%", plain_rbf);
  const struct {
    const char* name;
    uint32_t stages;
  } stages[] = {{"all", MIEN_STAGE_ALL},
                {"controls", kGuiToRaw},
                {"ml", MIEN_STAGE_ML},
                {"rbf", MIEN_STAGE_RBF},
                {"psd", MIEN_STAGE_PSD},
                {"joints", MIEN_STAGE_JOINTS},  // with twists and swings
                {"twist_swing", kTwistSwing},
                {"channels", MIEN_STAGE_BLEND_SHAPES},
                {"maps", MIEN_STAGE_ANIMATED_MAPS}};
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
      for (int percent : {5, 25, 50, 100}) {
        if (lod == 0) {
          const std::string name = std::string("changing/") + mien_isa_name(isa) + "/lod0/" +
                                   std::to_string(percent) + "%";
          benchmark::RegisterBenchmark(name.c_str(), evaluate_changing, isa, lod, percent);
        }
        for (const auto& stage : stages) {
          // The stages by themselves where they weigh most.
          if (stage.stages != MIEN_STAGE_ALL && (lod != 0 || percent != 25)) continue;
          const std::string name = std::string(stage.name) + "/" + mien_isa_name(isa) + "/lod" +
                                   std::to_string(lod) + "/" + std::to_string(percent) + "%";
          benchmark::RegisterBenchmark(name.c_str(), evaluate, isa, lod, percent, stage.stages);
        }
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace mien::bench
