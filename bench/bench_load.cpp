// SPDX-License-Identifier: MIT
// Opening and compiling, by layers and LODs. The file is in memory, so the disk does not count.
#include "bench/bench_support.h"

namespace mien::bench {
namespace {

void open(benchmark::State& state, uint32_t layers, uint64_t lods) {
  MienDnaInfo info = sized<MienDnaInfo>();
  for (auto _ : state) {
    MienDna* dna = open_rig(layers, lods);
    mien_dna_info(dna, &info);
    mien_dna_close(dna);
  }
  state.counters["memory_bytes"] = static_cast<double>(info.memory_bytes);
}

void compile(benchmark::State& state, uint64_t lods) {
  MienDna* dna = open_rig(kBehaviorLayers, lods);
  MienRigInfo info = sized<MienRigInfo>();
  for (auto _ : state) {
    MienRig* rig = create_rig(dna, MIEN_ISA_BEST);
    mien_rig_info(rig, &info);
    mien_rig_destroy(rig);
  }
  state.counters["rig_bytes"] = static_cast<double>(info.rig_bytes);
  state.counters["instance_bytes"] = static_cast<double>(info.instance_bytes);
  mien_dna_close(dna);
}

const int kRegistered = [] {
  const struct {
    const char* name;
    uint32_t layers;
    uint64_t lods;
  } openings[] = {
      {"descriptor", MIEN_LAYER_DESCRIPTOR, 0},
      {"definition", MIEN_LAYER_DEFINITION, 0},
      {"behavior", MIEN_LAYER_BEHAVIOR, 0},
      {"behavior/lod0", MIEN_LAYER_BEHAVIOR, 1},
      {"behavior/last_lods", MIEN_LAYER_BEHAVIOR, ~uint64_t{0} << 2},
      {"geometry_without_blend_shapes", MIEN_LAYER_GEOMETRY_WITHOUT_BLEND_SHAPES, 0},
      {"all", MIEN_LAYER_ALL, 0},
      {"all/lod0", MIEN_LAYER_ALL, 1},
  };
  for (const auto& o : openings) {
    benchmark::RegisterBenchmark((std::string("open/") + o.name).c_str(), open, o.layers, o.lods);
  }
  benchmark::RegisterBenchmark("compile/all_lods", compile, 0);
  benchmark::RegisterBenchmark("compile/lod0", compile, 1);
  return 0;
}();

}  // namespace
}  // namespace mien::bench
