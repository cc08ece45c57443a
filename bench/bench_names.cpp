// SPDX-License-Identifier: MIT
// Expressions of one rig on another one of the same topology: each control to those of the same meaning
// (mien_rig_match()), or by effect, with the displacements of all positions as targets. Prints how far the positions then
// are from those displacements: the root mean square of each expression, its mean and largest value.
//
//     ./build/release/bench/bench_names SOURCE.dna TARGET.dna
//
// Both in centimeters. docs/solving.md has the commands that make two heads.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "capi/include/mien_author.h"
#include "capi/include/mien_solve.h"

namespace {

using Floats = std::vector<float>;

struct Head {
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienInstance* instance = nullptr;
  MienDeformer* deformer = nullptr;
  MienDeformerInstance* deformed = nullptr;
  MienMutableFloatView raw = {};
  Floats rest;

  explicit Head(const char* path) {
    MienError error = mien_error_default();
    const bool made =
        mien_dna_open_file(path, nullptr, &dna, &error) == MIEN_OK &&
        mien_rig_create(dna, nullptr, &rig, &error) == MIEN_OK &&
        mien_instance_create(rig, nullptr, &instance, &error) == MIEN_OK &&
        mien_deformer_create(dna, rig, nullptr, &deformer, &error) == MIEN_OK &&
        mien_deformer_instance_create(deformer, nullptr, &deformed, &error) == MIEN_OK &&
        mien_instance_raw_controls(instance, &raw) == MIEN_OK;
    if (!made) {
      std::fprintf(stderr, "%s: %s\n", path, error.message);
      std::exit(1);
    }
    rest = positions(Floats(raw.count));
  }
  ~Head() {
    mien_deformer_instance_destroy(deformed);
    mien_deformer_destroy(deformer);
    mien_instance_destroy(instance);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
  }
  Floats positions(const Floats& controls) {
    MienFloatView view = {};
    std::copy(controls.begin(), controls.end(), raw.data);
    static_cast<void>(mien_rig_evaluate(rig, instance, 0));
    static_cast<void>(mien_deformer_instance_update(deformed, instance));
    static_cast<void>(mien_deformer_instance_deform(deformed, 0, MIEN_NORMALS_NONE, nullptr));
    static_cast<void>(mien_deformer_instance_positions(deformed, 0, &view));
    return {view.data, view.data + view.count};
  }
  Floats displacements(const Floats& controls) {
    Floats moved = positions(controls);
    for (size_t i = 0; i < moved.size(); ++i) moved[i] -= rest[i];
    return moved;
  }
  std::string name(uint32_t control) const {
    MienStringView name = {};
    static_cast<void>(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, control, &name));
    return {name.data, name.count};
  }
};

/// In millimeters, over the positions.
double root_mean_square(const Floats& a, const Floats& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return 10 * std::sqrt(sum / (static_cast<double>(a.size()) / 3));
}

struct Transfer {
  Head &source, &target;
  MienFit* fit = nullptr;

  Transfer(Head& from, Head& to) : source(from), target(to) {
    std::vector<MienSolvePoint> points;
    for (uint32_t i = 0; i < to.rest.size() / 3; ++i) points.push_back({0, {i, i, i}, {1, 0, 0}});
    MienFitDesc desc = mien_fit_desc_default();
    desc.deformer = to.deformer;
    desc.points = points.data();
    desc.point_count = points.size();
    if (mien_fit_create(to.rig, &desc, &fit, nullptr) != MIEN_OK) std::exit(1);
  }
  ~Transfer() { mien_fit_destroy(fit); }

  Floats by_names(const Floats& controls) const {
    Floats out(target.raw.count);
    for (uint32_t c = 0; c < controls.size(); ++c) {
      if (controls[c] == 0) continue;
      const std::string name = source.name(c);
      MienControlShare shares[MIEN_MOST_SHARES];
      size_t count = 0;
      uint32_t how = 0;
      if (mien_rig_match(target.rig, name.data(), name.size(), shares, MIEN_MOST_SHARES, &count,
                         &how) != MIEN_OK) {
        continue;
      }
      for (size_t i = 0; i < count; ++i) out[shares[i].control] += shares[i].weight * controls[c];
    }
    for (float& v : out) v = std::min(std::max(v, 0.0f), 1.0f);
    return out;
  }
  Floats by_effect(const Floats& controls) const {
    Floats targets = source.displacements(controls), out(target.raw.count);
    for (size_t i = 0; i < targets.size(); ++i) targets[i] += target.rest[i];
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = targets.data();
    frame.max_iterations = 100;
    if (mien_fit_solve(fit, &frame, out.data(), nullptr) != MIEN_OK) std::exit(1);
    return out;
  }
  void compare(const char* what, const std::vector<Floats>& expressions) const {
    std::vector<double> apart[2];
    for (const Floats& controls : expressions) {
      const Floats wanted = source.displacements(controls);
      apart[0].push_back(root_mean_square(target.displacements(by_names(controls)), wanted));
      apart[1].push_back(root_mean_square(target.displacements(by_effect(controls)), wanted));
    }
    const auto mean = [](const std::vector<double>& all) {
      return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
    };
    const auto most = [](const std::vector<double>& all) {
      return *std::max_element(all.begin(), all.end());
    };
    std::printf("%3zu %-24s by names %.2f mm, at most %.2f; by effect %.2f mm, at most %.2f\n",
                expressions.size(), what, mean(apart[0]), most(apart[0]), mean(apart[1]),
                most(apart[1]));
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "bench_names SOURCE.dna TARGET.dna\n");
    return 1;
  }
  Head source(argv[1]), target(argv[2]);
  if (source.rest.size() != target.rest.size()) {
    std::fprintf(stderr, "mesh 0 has %zu positions, and %zu\n", source.rest.size() / 3,
                 target.rest.size() / 3);
    return 1;
  }
  std::printf("%zu positions, %zu and %zu raw controls\n", source.rest.size() / 3, source.raw.count,
              target.raw.count);
  std::vector<uint32_t> faces;  // controls that move more than the eyes
  for (uint32_t c = 0; c < source.raw.count; ++c) {
    if (source.name(c).find("eyeLook") == std::string::npos) faces.push_back(c);
  }
  const Transfer transfer(source, target);
  std::vector<Floats> expressions;
  for (const uint32_t c : faces) {
    expressions.emplace_back(source.raw.count);
    expressions.back()[c] = 1;
  }
  transfer.compare("expressions alone", expressions);
  mien::Random random = mien::Random::from_seed(6, 1);
  expressions.assign(200, Floats(source.raw.count));
  for (Floats& controls : expressions) {
    for (uint32_t n = 4 + random.below(5); n != 0; --n) {
      controls[faces[random.below(static_cast<uint32_t>(faces.size()))]] =
          static_cast<float>(random.between(0.2, 1));
    }
  }
  transfer.compare("combinations of 4 to 8", expressions);
  return 0;
}
