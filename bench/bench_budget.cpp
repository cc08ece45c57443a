// SPDX-License-Identifier: MIT
// What an error budget saves: sizes and CPU times of rigs that `mien bake --tolerance` made, as shares of those with
// 32-bit storage.
//
//     mien bake head.dna -o head-0.02.rig --tolerance 0.02mm
//     ./build/release/bench/bench_budget head.dna [head-0.02.rig ...]
//
// Prints a table in Markdown. Its first row is the file with 16-bit storage, before anything is removed. A frame is the
// evaluation of LOD 0, joint matrices, and deformation of its meshes; each time is that of one character whose data
// may stay in the caches. Times are medians of the ratios of all turns; a turn measures all rigs, in random order.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "capi/include/mien_author.h"

namespace {

constexpr int kTurns = 61;
constexpr double kTurnSeconds = 0.003;

void require(MienStatus status, const MienError& error, const char* shown) {
  if (status == MIEN_OK) return;
  std::fprintf(stderr, "%s: %s: %s\n", shown, mien_status_name(status), error.message);
  std::exit(1);
}

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

/// Evaluation alone, then frames by the normals that they have.
constexpr uint32_t kFrames[] = {MIEN_NORMALS_NONE, MIEN_NORMALS_SKINNED, MIEN_NORMALS_RECOMPUTED};
constexpr size_t kWorks = 1 + std::size(kFrames);
constexpr int kActive[] = {25, 100};  // percent of the raw controls

struct Character {
  std::string shown;
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  MienInstance* instance = nullptr;
  MienDeformerInstance* pose = nullptr;
  MienIndex16View meshes = {};
  uint64_t rig_bytes = 0, deformer_bytes = 0;

  Character() = default;
  Character(const Character&) = delete;
  Character& operator=(const Character&) = delete;
  ~Character() {
    mien_deformer_instance_destroy(pose);
    mien_instance_destroy(instance);
    mien_deformer_destroy(deformer);
    mien_rig_destroy(rig);
  }

  void compile(const MienDna* dna, uint32_t isa, uint32_t storage) {
    MienError error = mien_error_default();
    MienRigDesc desc = mien_rig_desc_default();
    desc.isa = isa;
    desc.storage = storage;
    desc.reuse = MIEN_REUSE_NOTHING;
    require(mien_rig_create(dna, &desc, &rig, &error), error, "rig");
    MienDeformerDesc deformer_desc = mien_deformer_desc_default();
    deformer_desc.storage = storage;
    require(mien_deformer_create(dna, rig, &deformer_desc, &deformer, &error), error, "deformer");
    start();
  }
  void open(const char* path, uint32_t isa) {
    MienError error = mien_error_default();
    MienBaked* baked = nullptr;
    require(mien_baked_open_file(path, nullptr, &baked, &error), error, path);
    MienBakedRigDesc desc = mien_baked_rig_desc_default();
    desc.isa = isa;
    desc.reuse = MIEN_REUSE_NOTHING;
    require(mien_rig_from_baked(baked, &desc, &rig, &error), error, path);
    require(mien_deformer_from_baked(baked, rig, nullptr, &deformer, &error), error, path);
    mien_baked_close(baked);
    shown = path;
    start();
  }
  void start() {
    MienError error = mien_error_default();
    require(mien_instance_create(rig, nullptr, &instance, &error), error, "instance");
    MienDeformerInstanceDesc desc = mien_deformer_instance_desc_default();
    desc.lods = 1;
    require(mien_deformer_instance_create(deformer, &desc, &pose, &error), error, "pose");
    require(mien_rig_lod_indices(rig, MIEN_KIND_MESH, 0, &meshes), error, "meshes");
    MienRigInfo rig_info = mien_rig_info_default();
    MienDeformerInfo info = mien_deformer_info_default();
    require(mien_rig_info(rig, &rig_info), error, "rig");
    require(mien_deformer_info(deformer, &info), error, "deformer");
    rig_bytes = rig_info.rig_bytes;
    deformer_bytes = info.deformer_bytes;
  }

  /// The same controls for all characters.
  void draw_controls(int percent) const {
    MienMutableFloatView raw{};
    require(mien_instance_raw_controls(instance, &raw), mien_error_default(), "controls");
    std::mt19937 random(20240229);
    for (size_t i = 0; i < raw.count; ++i) {
      const bool active = random() % 100 < static_cast<uint32_t>(percent);
      const float value = static_cast<float>((random() >> 8) + 1) / 16777216.0f;
      raw.data[i] = active ? value : 0.0f;
    }
  }
  void work(size_t kind) const {
    MienStatus failed = mien_rig_evaluate(rig, instance, 0);
    if (kind != 0) {
      failed |= mien_deformer_instance_update(pose, instance);
      for (size_t i = 0; i < meshes.count; ++i) {
        failed |= mien_deformer_instance_deform(pose, meshes.data[i], kFrames[kind - 1], nullptr);
      }
    }
    if (failed != MIEN_OK) std::exit(1);
  }
  double seconds(size_t kind) const {
    work(kind);  // fetches what the others have displaced from the caches
    const double start = thread_seconds();
    double now = start;
    size_t passes = 0;
    do {
      work(kind);
      ++passes;
      now = thread_seconds();
    } while (now - start < kTurnSeconds);
    return (now - start) / static_cast<double>(passes);
  }
};

double median(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double share(uint64_t part, uint64_t whole) {
  return 100 * static_cast<double>(part) / static_cast<double>(whole);
}

void compare(const MienDna* dna, uint32_t isa, char** paths, size_t count) {
  std::vector<std::unique_ptr<Character>> all;
  all.push_back(std::make_unique<Character>());
  all.back()->compile(dna, isa, MIEN_STORAGE_32_BIT);
  all.push_back(std::make_unique<Character>());
  all.back()->compile(dna, isa, MIEN_STORAGE_16_BIT);
  all.back()->shown = "16-bit storage";
  for (size_t i = 0; i < count; ++i) {
    all.push_back(std::make_unique<Character>());
    all.back()->open(paths[i], isa);
  }
  using Ratios = std::array<std::vector<double>, kWorks * std::size(kActive)>;
  std::vector<Ratios> ratios(all.size());
  std::array<std::vector<double>, kWorks * std::size(kActive)> exact;
  std::mt19937 random(1);
  std::vector<double> times(all.size());
  for (int turn = 0; turn < kTurns; ++turn) {
    for (size_t a = 0; a < std::size(kActive); ++a) {
      for (const auto& character : all) character->draw_controls(kActive[a]);
      for (size_t kind = 0; kind < kWorks; ++kind) {
        std::vector<size_t> order(all.size());
        for (size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        for (const size_t i : order) times[i] = all[i]->seconds(kind);
        exact[kind * std::size(kActive) + a].push_back(times[0]);
        for (size_t i = 1; i < all.size(); ++i) {
          ratios[i][kind * std::size(kActive) + a].push_back(times[i] / times[0]);
        }
      }
    }
  }
  const char* name = mien_isa_name(isa);
  std::printf("| 32-bit storage | %s | %.2f MB | %.2f MB |", name,
              static_cast<double>(all[0]->rig_bytes) / 1e6,
              static_cast<double>(all[0]->deformer_bytes) / 1e6);
  for (auto& of_work : exact) std::printf(" %.0f us |", median(of_work) * 1e6);
  for (size_t i = 1; i < all.size(); ++i) {
    std::printf("\n| %s | %s | %.1f %% | %.1f %% |", all[i]->shown.c_str(), name,
                share(all[i]->rig_bytes, all[0]->rig_bytes),
                share(all[i]->deformer_bytes, all[0]->deformer_bytes));
    for (auto& of_work : ratios[i]) std::printf(" %.2f |", median(of_work));
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_budget HEAD.dna [REDUCED.rig ...]\n");
    return 2;
  }
  MienError error = mien_error_default();
  MienDna* dna = nullptr;
  require(mien_dna_open_file(argv[1], nullptr, &dna, &error), error, argv[1]);
  std::printf(
      "| | | rig | deformer | evaluation, 25 %% active | 100 %% | frame without normals, 25 %% | "
      "100 %% | "
      "skinned normals, 25 %% | 100 %% | recomputed normals, 25 %% | 100 %% |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const uint32_t isa : {MIEN_ISA_AVX2, MIEN_ISA_AVX512, MIEN_ISA_NEON}) {
    MienRig* probe = nullptr;
    MienRigDesc desc = mien_rig_desc_default();
    desc.isa = isa;
    const bool available = mien_rig_create(dna, &desc, &probe, nullptr) == MIEN_OK;
    mien_rig_destroy(probe);
    if (available) compare(dna, isa, argv + 2, static_cast<size_t>(argc - 2));
  }
  mien_dna_close(dna);
  return 0;
}
