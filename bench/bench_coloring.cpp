// SPDX-License-Identifier: MIT
// Matrices of derivatives by raw controls: the CPU time with the directions that coloring finds, and with one direction
// per column, in one run. docs/derivatives.md, 9.
//
//     ./build/release/bench/bench_coloring [HEAD.dna]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <vector>

#include "author/base/random.h"
#include "capi/include/mien_author.h"
#include "runtime/derive/jacobian.h"

namespace {

void require(MienStatus status) {
  if (status == MIEN_OK) return;
  std::fprintf(stderr, "%s\n", mien_status_name(status));
  std::exit(1);
}

struct Rig {
  MienDna* dna;
  MienRig* rig = nullptr;
  MienInstance* instance = nullptr;
  MienDeformer* deformer = nullptr;
  MienDerivatives* derivatives = nullptr;
  MienMutableFloatView raw = {};

  explicit Rig(MienDna* owned) : dna(owned) {
    require(mien_rig_create(dna, nullptr, &rig, nullptr));
    require(mien_instance_create(rig, nullptr, &instance, nullptr));
    require(mien_deformer_create(dna, rig, nullptr, &deformer, nullptr));
    MienDerivativesDesc desc = mien_derivatives_desc_default();
    desc.deformer = deformer;
    require(mien_derivatives_create(rig, &desc, &derivatives, nullptr));
    require(mien_instance_raw_controls(instance, &raw));
  }
  ~Rig() {
    mien_derivatives_destroy(derivatives);
    mien_deformer_destroy(deformer);
    mien_instance_destroy(instance);
    mien_rig_destroy(rig);
    mien_dna_close(dna);
  }
  /// A share of the raw controls is above 0.
  void pose(mien::Random& random, double share) {
    for (size_t i = 0; i < raw.count; ++i) {
      raw.data[i] = random.chance(share) ? static_cast<float>(random.between(0.1, 0.6)) : 0.0f;
    }
    require(mien_rig_evaluate(rig, instance, 0));
    require(mien_derivatives_linearize(derivatives, instance, MIEN_STAGE_ALL));
  }
};

/// What the matrix is of: joint values, controls, or coordinates of mesh 0.
struct Outputs {
  uint32_t point = MIEN_POINT_JOINTS;
  std::vector<uint32_t> chosen;  // empty: all
};

/// A matrix by raw controls.
struct Matrix {
  MienJacobian* jacobian = nullptr;
  MienJacobianPattern pattern = mien_jacobian_pattern_default();
  std::vector<float> values;
  std::vector<uint32_t> firsts;  // of colors, if each column has one

  Matrix(Rig& rig, const Outputs& outputs) {
    MienJacobianDesc desc = mien_jacobian_desc_default();
    desc.from_point = MIEN_POINT_RAW;
    desc.to_point = outputs.point;
    desc.outputs = outputs.chosen.empty() ? nullptr : outputs.chosen.data();
    desc.output_count = outputs.chosen.size();
    require(mien_jacobian_create(rig.derivatives, &desc, &jacobian, nullptr));
    require(mien_jacobian_pattern(jacobian, &pattern));
    values.resize(pattern.rows.count);
  }
  ~Matrix() { mien_jacobian_destroy(jacobian); }
  /// Gives each column a direction of its own; returns how many columns have entries.
  size_t separate_columns() {
    auto& of = *reinterpret_cast<mien::Jacobian*>(jacobian);
    firsts.resize(of.by_color.count + 1);
    std::iota(firsts.begin(), firsts.end(), 0u);
    of.first_of_color = {firsts.data(), firsts.size()};
    return of.by_color.count;
  }
  void find(Rig& rig) {
    require(mien_derivatives_jacobian(rig.derivatives, jacobian, nullptr, 0, values.data(),
                                      values.size()));
  }
};

double median_time(const std::function<void()>& run) {
  std::vector<double> times;
  for (int i = 0; i < 15; ++i) {
    const std::clock_t start = std::clock();
    run();
    times.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC * 1e3);
  }
  std::nth_element(times.begin(), times.begin() + 7, times.end());
  return times[7];
}

void run(const char* name, Rig& rig, const char* what, const Outputs& outputs) {
  mien::Random random = mien::Random::from_seed(5, 1);
  rig.pose(random, 0.1);
  const std::clock_t start = std::clock();
  Matrix colored(rig, outputs);
  const double making = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC * 1e3;
  Matrix separate(rig, outputs);
  const size_t columns = separate.separate_columns();
  if (columns == 0) return;
  std::vector<size_t> in_row(colored.pattern.row_count);
  for (size_t i = 0; i < colored.pattern.rows.count; ++i) ++in_row[colored.pattern.rows.data[i]];
  colored.find(rig);
  separate.find(rig);
  if (colored.values != separate.values) std::printf("OTHER VALUES  ");
  // Alternately, so that what else the machine does slows both.
  double by_colors = 0, by_columns = 0;
  for (int i = 0; i < 3; ++i) {
    by_colors += median_time([&] { colored.find(rig); }) / 3;
    by_columns += median_time([&] { separate.find(rig); }) / 3;
  }
  std::printf(
      "%-14s %-13s %4zu columns, %4zu directions, fullest row %4zu: %8.3f ms by colors, %8.3f ms "
      "by "
      "columns, ratio %.2f; made in %.1f ms\n",
      name, what, columns, colored.pattern.direction_count,
      in_row.empty() ? 0 : *std::max_element(in_row.begin(), in_row.end()), by_colors, by_columns,
      by_colors / by_columns, making);
}

void run_all(const char* name, MienDna* dna) {
  Rig rig(dna);
  const Outputs joints;
  run(name, rig, "joint values", joints);
  Outputs controls;
  controls.point = MIEN_POINT_CONTROLS;
  run(name, rig, "controls", controls);
  MienMesh mesh = mien_mesh_default();
  if (mien_deformer_mesh(rig.deformer, 0, &mesh) != MIEN_OK) return;
  Outputs positions;
  positions.point = MIEN_POINT_POSITIONS;
  run(name, rig, "all vertices", positions);
  constexpr uint32_t kChosen = 200;
  if (mesh.position_count <= kChosen) return;
  for (uint32_t i = 0; i < kChosen; ++i) {
    const auto p = static_cast<uint32_t>(size_t{i} * mesh.position_count / kChosen);
    positions.chosen.insert(positions.chosen.end(), {3 * p, 3 * p + 1, 3 * p + 2});
  }
  run(name, rig, "200 vertices", positions);
}

MienDna* generate(uint32_t preset) {
  MienGenerateDesc desc = mien_generate_desc_default();
  desc.preset = preset;
  desc.seed = 1;
  MienDna* dna = nullptr;
  require(mien_dna_generate(&desc, &dna, nullptr));
  return dna;
}

}  // namespace

int main(int argc, char** argv) {
  run_all("large head", generate(MIEN_PRESET_LARGE));
  run_all("body", generate(MIEN_PRESET_BODY));
  run_all("generated head", generate(MIEN_PRESET_HEAD));
  MienDna* dna = nullptr;
  if (argc < 2) return 0;
  require(mien_dna_open_file(argv[1], nullptr, &dna, nullptr));
  run_all("file", dna);
  return 0;
}
