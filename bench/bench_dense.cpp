// SPDX-License-Identifier: MIT
// Dense frames, all controls active, where the joint matrix is as large as the caches or larger: the joint
// stage with 32 and 16 bits per entry.
//
// A working set is what is read before anything is read again: the matrix of one LOD, or the matrices of
// several rigs in turn, until it is large enough.
//
// Counters: `megabytes` the working set with 32 bits, `frame` the time of a frame with 32 bits in seconds,
// `of_floats` the time with 16 bits by that with 32 in the same run, `of_bytes` the bytes with 16 bits by those
// with 32, `gigabytes_per_second` what the joint stage reads, with 32 and 16 bits.
#include <algorithm>
#include <ctime>
#include <memory>

#include "bench/bench_support.h"

namespace mien::bench {
namespace {

constexpr uint32_t kDenseLods = 8;

struct DestroyRig {
  void operator()(MienRig* rig) const { mien_rig_destroy(rig); }
};
struct DestroyInstance {
  void operator()(MienInstance* instance) const { mien_instance_destroy(instance); }
};

/// Some equal rigs, each with a character whose controls are all active.
struct WorkingSet {
  std::vector<std::unique_ptr<MienRig, DestroyRig>> rigs;
  std::vector<std::unique_ptr<MienInstance, DestroyInstance>> instances;
  uint64_t bytes = 0;  // that the joint stage reads, of all
  uint32_t lod;

  WorkingSet(const MienDna* dna, uint32_t isa, uint32_t storage, uint32_t at_lod, size_t count)
      : lod(at_lod) {
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = isa;
    desc.storage = storage;
    desc.reuse = MIEN_REUSE_NOTHING;
    MienError error = sized<MienError>();
    for (size_t i = 0; i < count; ++i) {
      MienRig* rig = nullptr;
      require(mien_rig_create(dna, &desc, &rig, &error), error);
      rigs.emplace_back(rig);
      MienInstance* instance = nullptr;
      require(mien_instance_create(rig, nullptr, &instance, &error), error);
      instances.emplace_back(instance);
      MienMutableFloatView raw = {};
      require(mien_instance_raw_controls(instance, &raw));
      std::fill(raw.data, raw.data + raw.count, 0.5f);
      require(mien_rig_evaluate(rig, instance, lod));  // correctives, too
      MienInstanceStatistics read = sized<MienInstanceStatistics>();
      require(mien_instance_statistics(instance, &read));
      bytes += read.joint_byte_count;
    }
  }

  void evaluate() {
    for (size_t i = 0; i < rigs.size(); ++i) {
      benchmark::DoNotOptimize(
          mien_rig_evaluate_stages(rigs[i].get(), instances[i].get(), lod, MIEN_STAGE_JOINTS));
    }
    benchmark::ClobberMemory();
  }
};

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

double median(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

/// About `kilobytes` of floats: the finest LOD that fits, in as many rigs as fit.
void dense(benchmark::State& state, uint32_t isa, uint64_t kilobytes) {
  static const MienDna* dna = open_rig(kBehaviorLayers, 0);
  uint32_t lod = 0;
  uint64_t of_one = 0;
  for (; lod < kDenseLods; ++lod) {
    of_one = WorkingSet(dna, isa, MIEN_STORAGE_32_BIT, lod, 1).bytes;
    if (of_one <= kilobytes * 1100) break;
  }
  const auto count = static_cast<size_t>(std::max<uint64_t>(kilobytes * 1100 / of_one, 1));
  WorkingSet floats(dna, isa, MIEN_STORAGE_32_BIT, std::min(lod, kDenseLods - 1), count);
  WorkingSet halves(dna, isa, MIEN_STORAGE_16_BIT, std::min(lod, kDenseLods - 1), count);
  // Turns of both, so that a slow moment hits them alike. A turn begins with the caches as it leaves them.
  const uint64_t rounds = std::max<uint64_t>(16'000'000 / floats.bytes, 1);
  const auto turn = [&](WorkingSet& set) {
    set.evaluate();
    const double start = thread_seconds();
    for (uint64_t r = 0; r < rounds; ++r) set.evaluate();
    return (thread_seconds() - start) / static_cast<double>(rounds);
  };
  std::vector<double> of_floats, of_halves;
  for (auto _ : state) {
    of_floats.push_back(turn(floats));
    of_halves.push_back(turn(halves));
    state.SetIterationTime(of_floats.back() * static_cast<double>(rounds));
  }
  const double with_floats = median(of_floats), with_halves = median(of_halves);
  const auto bytes = static_cast<double>(floats.bytes);
  const auto half_bytes = static_cast<double>(halves.bytes);
  state.counters["megabytes"] = bytes * 1e-6;
  state.counters["frame"] = with_floats / static_cast<double>(count);
  state.counters["of_floats"] = with_halves / with_floats;
  state.counters["of_bytes"] = half_bytes / bytes;
  state.counters["gigabytes_per_second_32"] = bytes * 1e-9 / with_floats;
  state.counters["gigabytes_per_second_16"] = half_bytes * 1e-9 / with_halves;
}

const int kRegisteredDense = [] {
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    for (const uint64_t kilobytes : {300, 500, 800, 1200, 1700, 3100, 4200, 8400, 16800}) {
      const std::string name =
          std::string("dense/") + mien_isa_name(isa) + "/" + std::to_string(kilobytes) + "KB";
      benchmark::RegisterBenchmark(name.c_str(), dense, isa, kilobytes)->UseManualTime();
    }
  }
  return 0;
}();

}  // namespace
}  // namespace mien::bench
