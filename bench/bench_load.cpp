// SPDX-License-Identifier: MIT
// Opening and compiling, by layers and LODs. The file is in memory, so the disk does not count.
#include <unistd.h>

#include "bench/bench_support.h"

namespace mien::bench {
namespace {

void open(benchmark::State& state, uint32_t layers, uint64_t lods, bool skip_targets) {
  MienDnaInfo info = sized<MienDnaInfo>();
  for (auto _ : state) {
    MienDna* dna = open_rig(layers, lods, skip_targets);
    require(mien_dna_info(dna, &info));
    mien_dna_close(dna);
  }
  state.counters["memory_bytes"] = static_cast<double>(info.memory_bytes);
}

void compile(benchmark::State& state, uint64_t lods) {
  MienDna* dna = open_rig(kBehaviorLayers, lods);
  MienRigInfo info = sized<MienRigInfo>();
  for (auto _ : state) {
    MienRig* rig = create_rig(dna, MIEN_ISA_ENVIRONMENT);
    require(mien_rig_info(rig, &info));
    mien_rig_destroy(rig);
  }
  state.counters["rig_bytes"] = static_cast<double>(info.rig_bytes);
  state.counters["instance_bytes"] = static_cast<double>(info.instance_bytes);
  mien_dna_close(dna);
}

/// The baked rig in a file that is removed at the end.
struct BakedFile {
  std::string path = "/tmp/mien_bench_" + std::to_string(getpid()) + ".rig";
  BakedFile() {
    MienDna* dna = open_rig(kBehaviorLayers, 0);
    MienRig* rig = create_rig(dna, MIEN_ISA_ENVIRONMENT);
    MienError error = sized<MienError>();
    require(mien_bake_file(rig, nullptr, path.c_str(), &error), error);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
  }
  ~BakedFile() { remove(path.c_str()); }
};

struct Requests {
  size_t count = 0;
  static void* allocate(void* user, size_t size, size_t alignment) {
    ++static_cast<Requests*>(user)->count;
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  }
  static void release(void*, void* block, size_t, size_t) { std::free(block); }
};

// The file is in the page cache, mapped anew each time.
void open_baked(benchmark::State& state, uint32_t access, uint32_t check) {
  static const BakedFile file;
  Requests requests;
  const MienAllocator allocator = {&requests, Requests::allocate, Requests::release};
  MienBakedDesc desc = sized<MienBakedDesc>();
  desc.file_access = access;
  desc.check = check;
  MienBakedRigDesc rig_desc = sized<MienBakedRigDesc>();
  desc.allocator = rig_desc.allocator = &allocator;
  MienRigInfo info = sized<MienRigInfo>();
  MienError error = sized<MienError>();
  for (auto _ : state) {
    MienBaked* baked = nullptr;
    MienRig* rig = nullptr;
    require(mien_baked_open_file(file.path.c_str(), &desc, &baked, &error), error);
    require(mien_rig_from_baked(baked, &rig_desc, &rig, &error), error);
    require(mien_rig_info(rig, &info));
    mien_rig_destroy(rig);
    mien_baked_close(baked);
  }
  state.counters["rig_bytes"] = static_cast<double>(info.rig_bytes);
  state.counters["allocations"] =
      static_cast<double>(requests.count) / static_cast<double>(state.iterations());
}

const int kRegistered = [] {
  const struct {
    const char* name;
    uint32_t layers;
    uint64_t lods;
    bool skip_targets = false;
  } openings[] = {
      {"descriptor", MIEN_LAYER_DESCRIPTOR, 0},
      {"definition", MIEN_LAYER_DEFINITION, 0},
      {"behavior", MIEN_LAYER_BEHAVIOR, 0},
      {"behavior/lod0", MIEN_LAYER_BEHAVIOR, 1},
      {"behavior/last_lods", MIEN_LAYER_BEHAVIOR, ~uint64_t{0} << 2},
      {"geometry_without_blend_shapes", MIEN_LAYER_GEOMETRY, 0, true},
      {"all", MIEN_LAYER_ALL, 0},
      {"all/lod0", MIEN_LAYER_ALL, 1},
      {"all/last_lods", MIEN_LAYER_ALL, ~uint64_t{0} << 2},
  };
  for (const auto& o : openings) {
    benchmark::RegisterBenchmark((std::string("open/") + o.name).c_str(), open, o.layers, o.lods,
                                 o.skip_targets);
  }
  benchmark::RegisterBenchmark("baked/map", open_baked, MIEN_FILE_MAP, MIEN_BAKED_CHECK_SAFE);
  benchmark::RegisterBenchmark("baked/map/full", open_baked, MIEN_FILE_MAP, MIEN_BAKED_CHECK_FULL);
  benchmark::RegisterBenchmark("baked/read", open_baked, MIEN_FILE_READ, MIEN_BAKED_CHECK_SAFE);
  benchmark::RegisterBenchmark("compile/all_lods", compile, 0);
  benchmark::RegisterBenchmark("compile/lod0", compile, 1);
  return 0;
}();

}  // namespace
}  // namespace mien::bench
