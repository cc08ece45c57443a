// SPDX-License-Identifier: MIT
// Products with derivatives as ratios to the evaluation of the same rig in the same pose, in one run: each
// round takes the CPU time of all of them, and the ratio is that of the lower quartiles. Directions move all
// raw controls, or only the active ones, those that are not 0 in the pose: an evaluation leaves out the
// others, too.
//
//     ./build/release/bench/bench_derivatives [--isa NAME]
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <vector>

#include "author/base/random.h"
#include "capi/include/mien_author.h"

namespace {

/// CPU time in microseconds: other programs do not count.
double now() {
  timespec t = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e6 + static_cast<double>(t.tv_nsec) * 1e-3;
}

struct Subject {
  const char* name;
  uint32_t preset, flags;
  double active;  // share of the raw controls that are not 0
};

struct Timed {
  const char* name;
  std::function<void()> run;
  std::vector<double> times = {};
};

double lower_quartile(std::vector<double> times) {
  std::nth_element(times.begin(), times.begin() + static_cast<long>(times.size() / 4), times.end());
  return times[times.size() / 4];
}

void measure(std::vector<Timed>& all) {
  constexpr int kRounds = 41;
  for (int round = 0; round < kRounds; ++round) {
    for (Timed& t : all) {
      t.run();  // caches as in a loop of the same work
      const double start = now();
      t.run();
      t.run();
      t.times.push_back((now() - start) / 2);
    }
  }
}

void run(const Subject& subject, uint32_t isa) {
  MienGenerateDesc generate = {};
  generate.struct_size = sizeof(generate);
  generate.preset = subject.preset;
  generate.flags = subject.flags;
  generate.seed = 1;
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienInstance* instance = nullptr;
  MienDerivatives* derivatives = nullptr;
  MienRigDesc rig_desc = mien_rig_desc_default();
  rig_desc.isa = isa;
  rig_desc.reuse = MIEN_REUSE_NOTHING;
  if (mien_dna_generate(&generate, &dna, nullptr) != MIEN_OK ||
      mien_rig_create(dna, &rig_desc, &rig, nullptr) != MIEN_OK ||
      mien_instance_create(rig, nullptr, &instance, nullptr) != MIEN_OK ||
      mien_derivatives_create(rig, nullptr, &derivatives, nullptr) != MIEN_OK) {
    std::printf("%s: cannot be made\n", subject.name);
    return;
  }
  mien::Random random = mien::Random::from_seed(9, 9);
  MienMutableFloatView raw = {};
  static_cast<void>(mien_instance_raw_controls(instance, &raw));
  for (size_t i = 0; i < raw.count; ++i) {
    if (random.chance(subject.active)) raw.data[i] = static_cast<float>(random.between(0.1, 1));
  }
  static_cast<void>(mien_rig_evaluate(rig, instance, 0));
  static_cast<void>(mien_derivatives_linearize(derivatives, instance, MIEN_STAGE_ALL));
  size_t inputs = 0, outputs = 0;
  static_cast<void>(mien_derivatives_size(derivatives, MIEN_POINT_RAW, 0, &inputs));
  static_cast<void>(mien_derivatives_size(derivatives, MIEN_POINT_JOINTS, 0, &outputs));
  constexpr uint32_t kMany = 64;
  std::vector<float> directions(inputs * kMany), results(outputs * kMany);
  std::vector<float> gradients(outputs * kMany), controls(inputs * kMany);
  for (float& v : directions) v = static_cast<float>(random.between(-1, 1));
  for (float& v : gradients) v = static_cast<float>(random.between(-1, 1));
  std::vector<float> of_active = directions;
  for (size_t i = 0; i < of_active.size(); ++i) {
    if (raw.data[i % inputs] == 0.0f) of_active[i] = 0;
  }
  const auto push = [&](const std::vector<float>& rows, uint32_t count) {
    static_cast<void>(mien_derivatives_forward(derivatives, MIEN_POINT_RAW, MIEN_POINT_JOINTS, 0,
                                               count, rows.data(), results.data()));
  };
  const auto pull = [&](uint32_t count) {
    static_cast<void>(mien_derivatives_reverse(derivatives, MIEN_POINT_RAW, MIEN_POINT_JOINTS, 0,
                                               count, gradients.data(), controls.data()));
  };
  std::vector<Timed> all = {
      {"evaluate", [&] { static_cast<void>(mien_rig_evaluate(rig, instance, 0)); }},
      {"linearize",
       [&] {
         static_cast<void>(mien_derivatives_linearize(derivatives, instance, MIEN_STAGE_ALL));
       }},
      {"forward", [&] { push(directions, 1); }},
      {"of active", [&] { push(of_active, 1); }},
      {"reverse", [&] { pull(1); }},
      {"forward, 64", [&] { push(directions, kMany); }},
      {"of active, 64", [&] { push(of_active, kMany); }},
      {"reverse, 64", [&] { pull(kMany); }},
  };
  measure(all);
  const double one = lower_quartile(all[0].times);
  std::printf("%-22s %-7s %9.1f us", subject.name, mien_isa_name(isa), one);
  for (size_t i = 1; i < all.size(); ++i) {
    std::printf("  %s %.2f", all[i].name, lower_quartile(all[i].times) / one);
  }
  std::printf("\n");
  mien_derivatives_destroy(derivatives);
  mien_instance_destroy(instance);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
}

}  // namespace

int main(int argc, char** argv) {
  const char* only = argc == 3 && !std::strcmp(argv[1], "--isa") ? argv[2] : nullptr;
  const Subject subjects[] = {{"large head, 25 %", MIEN_PRESET_LARGE, 0, 0.25},
                              {"large head, all", MIEN_PRESET_LARGE, 0, 1},
                              {"head, networks, 25 %", MIEN_PRESET_LARGE, MIEN_GENERATE_ML, 0.25},
                              {"body, all", MIEN_PRESET_BODY, 0, 1}};
  std::printf("time of an evaluation, and the ratios of the others to it\n");
  for (uint32_t isa = MIEN_ISA_SCALAR; isa <= MIEN_ISA_NEON; ++isa) {
    if (!mien_isa_available(isa)) continue;
    if (only && std::strcmp(only, mien_isa_name(isa)) != 0) continue;
    for (const Subject& subject : subjects) run(subject, isa);
  }
  return 0;
}
