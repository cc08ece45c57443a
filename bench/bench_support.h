// SPDX-License-Identifier: MIT
// The rig that all benchmarks use: the file in MIEN_BENCH_RIG, else a generated one of production
// size.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "capi/include/mien_author.h"

namespace mien::bench {

template <class T>
T sized() {
  T object = {};
  object.struct_size = sizeof(T);
  return object;
}

inline void require(MienStatus status, const MienError& error) {
  if (status == MIEN_OK) return;
  std::fprintf(stderr, "%s: %s\n", mien_status_name(status), error.message);
  std::exit(1);
}

inline void require(MienStatus status) {
  if (status == MIEN_OK) return;
  std::fprintf(stderr, "%s\n", mien_status_name(status));
  std::exit(1);
}

/// The bytes of the file.
inline const std::vector<char>& rig_bytes() {
  static const std::vector<char> bytes = [] {
    MienError error = sized<MienError>();
    MienDna* dna = nullptr;
    const char* path = std::getenv("MIEN_BENCH_RIG");
    MienGenerateDesc desc = sized<MienGenerateDesc>();
    desc.preset = MIEN_PRESET_LARGE;
    require(path ? mien_dna_open_file(path, nullptr, &dna, &error)
                 : mien_dna_generate(&desc, &dna, &error),
            error);
    size_t size = 0;
    require(mien_dna_write_memory(dna, nullptr, nullptr, 0, &size, &error), error);
    std::vector<char> all(size);
    require(mien_dna_write_memory(dna, nullptr, all.data(), size, &size, &error), error);
    mien_dna_close(dna);
    return all;
  }();
  return bytes;
}

inline MienDna* open_rig(uint32_t layers, uint64_t lods, bool skip_targets = false) {
  MienDnaDesc desc = sized<MienDnaDesc>();
  desc.layers = layers;
  desc.lods = lods;
  desc.skip_blend_shape_targets = skip_targets;
  MienError error = sized<MienError>();
  MienDna* dna = nullptr;
  require(mien_dna_open_memory(rig_bytes().data(), rig_bytes().size(), &desc, &dna, &error), error);
  return dna;
}

inline MienRig* create_rig(const MienDna* dna, uint32_t isa) {
  MienRigDesc desc = sized<MienRigDesc>();
  desc.isa = isa;
  desc.reuse = MIEN_REUSE_NOTHING;  // benchmarks repeat the same controls
  MienError error = sized<MienError>();
  MienRig* rig = nullptr;
  require(mien_rig_create(dna, &desc, &rig, &error), error);
  return rig;
}

constexpr uint32_t kBehaviorLayers = MIEN_LAYER_BEHAVIOR | MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR |
                                     MIEN_LAYER_RBF_BEHAVIOR | MIEN_LAYER_JOINT_BEHAVIOR_METADATA |
                                     MIEN_LAYER_TWIST_SWING_BEHAVIOR;

}  // namespace mien::bench
