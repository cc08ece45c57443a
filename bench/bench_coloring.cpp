// SPDX-License-Identifier: MIT
// A Jacobian by coloring (A. R. Curtis, M. J. D. Powell and J. K. Reid, 1974): columns without a row in common share a
// direction. Prints how many directions that takes for the raw controls of a rig, and the time of both ways, in one run.
//
//     ./build/release/bench/bench_coloring [HEAD.dna]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <vector>

#include "author/base/random.h"
#include "capi/include/mien_author.h"

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

/// What the matrix is of: joint values, or coordinates of mesh 0.
struct Outputs {
  uint32_t point = MIEN_POINT_JOINTS;
  std::vector<uint32_t> chosen;  // empty: all
  size_t size = 0;               // numbers at the point
  size_t row_count() const { return chosen.empty() ? size : chosen.size(); }
};

struct Matrix {
  std::vector<uint32_t> rows, columns;
  std::vector<float> values;
  MienJacobian args = mien_jacobian_default();

  size_t find(Rig& rig, const Outputs& outputs) {
    size_t count = 0;
    args.outputs = outputs.chosen.empty() ? nullptr : outputs.chosen.data();
    args.output_count = outputs.chosen.size();
    args.rows = rows.data();
    args.columns = columns.data();
    args.values = values.data();
    args.capacity = values.size();
    require(mien_derivatives_jacobian(rig.derivatives, MIEN_POINT_RAW, outputs.point, 0, &args,
                                      &count));
    return count;
  }
  explicit Matrix(Rig& rig, const Outputs& outputs) {
    const size_t count = find(rig, outputs);
    rows.resize(count);
    columns.resize(count);
    values.resize(count);
    if (count != 0) find(rig, outputs);
  }
};

/// Colors of columns, UINT32_MAX for empty ones, and the least that any coloring needs: entries of the fullest row.
struct Coloring {
  std::vector<uint32_t> colors;
  uint32_t count = 0, fullest_row = 0, used_columns = 0;
};
Coloring color(const std::vector<std::vector<uint32_t>>& columns, size_t row_count) {
  Coloring out;
  out.colors.assign(columns.size(), UINT32_MAX);
  std::vector<uint32_t> order(columns.size()), in_row(row_count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return columns[a].size() > columns[b].size(); });
  std::vector<std::vector<uint8_t>> taken;  // [color][row]
  for (const uint32_t c : order) {
    if (columns[c].empty()) continue;
    ++out.used_columns;
    for (const uint32_t r : columns[c]) out.fullest_row = std::max(out.fullest_row, ++in_row[r]);
    uint32_t k = 0;
    while (k < taken.size() && std::any_of(columns[c].begin(), columns[c].end(),
                                           [&](uint32_t r) { return taken[k][r] != 0; })) {
      ++k;
    }
    if (k == taken.size()) taken.emplace_back(row_count);
    for (const uint32_t r : columns[c]) taken[k][r] = 1;
    out.colors[c] = k;
  }
  out.count = static_cast<uint32_t>(taken.size());
  return out;
}

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

void run(const char* name, Rig& rig, const Outputs& outputs) {
  mien::Random random = mien::Random::from_seed(5, 1);
  std::vector<std::vector<uint32_t>> pattern(rig.raw.count);
  // Entries that are not 0 in some pose: what a coloring has to know beforehand. The last pose is the one that is timed.
  for (const double share : {1.0, 1.0, 0.7, 0.5, 0.3, 0.2, 0.2, 0.1, 0.1}) {
    rig.pose(random, share);
    const Matrix matrix(rig, outputs);
    for (size_t i = 0; i < matrix.rows.size(); ++i) {
      pattern[matrix.columns[i]].push_back(matrix.rows[i]);
    }
  }
  for (auto& rows : pattern) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  const Coloring coloring = color(pattern, outputs.row_count());
  Matrix matrix(rig, outputs);
  std::vector<float> directions(coloring.count * rig.raw.count);
  for (size_t c = 0; c < rig.raw.count; ++c) {
    if (coloring.colors[c] != UINT32_MAX) directions[coloring.colors[c] * rig.raw.count + c] = 1;
  }
  std::vector<float> products(coloring.count * outputs.size), values;
  std::vector<uint32_t> rows, columns;
  const auto by_colors = [&] {
    require(mien_derivatives_forward(rig.derivatives, MIEN_POINT_RAW, outputs.point, 0,
                                     coloring.count, directions.data(), products.data()));
    rows.clear();
    columns.clear();
    values.clear();
    for (uint32_t c = 0; c < rig.raw.count; ++c) {
      for (const uint32_t r : pattern[c]) {
        const size_t at = outputs.chosen.empty() ? r : outputs.chosen[r];
        const float value = products[coloring.colors[c] * outputs.size + at];
        if (value == 0) continue;
        rows.push_back(r);
        columns.push_back(c);
        values.push_back(value);
      }
    }
  };
  by_colors();
  if (rows != matrix.rows || columns != matrix.columns) std::printf("OTHER ENTRIES  ");
  double apart = 0, largest = 0;
  for (size_t i = 0; i < std::min(values.size(), matrix.values.size()); ++i) {
    apart = std::fmax(apart, std::fabs(double{values[i]} - matrix.values[i]));
    largest = std::fmax(largest, std::fabs(double{matrix.values[i]}));
  }
  const double colored = median_time(by_colors);
  const double present = median_time([&] { matrix.find(rig, outputs); });
  std::printf(
      "%-14s %-18s %4zu controls, %4u with an effect: %4u colors (fullest row %4u)  %8.3f ms by "
      "colors, "
      "%8.3f ms by columns, ratio %.2f, apart %.0e\n",
      name,
      outputs.point == MIEN_POINT_JOINTS ? "joint values"
      : outputs.chosen.empty()           ? "all vertices"
                                         : "200 vertices",
      rig.raw.count, coloring.used_columns, coloring.count, coloring.fullest_row, colored, present,
      colored / present, largest > 0 ? apart / largest : 0);
}

void run_all(const char* name, MienDna* dna) {
  Rig rig(dna);
  Outputs joints;
  require(mien_derivatives_size(rig.derivatives, MIEN_POINT_JOINTS, 0, &joints.size));
  run(name, rig, joints);
  MienMesh mesh = mien_mesh_default();
  if (mien_deformer_mesh(rig.deformer, 0, &mesh) != MIEN_OK) return;
  Outputs positions;
  positions.point = MIEN_POINT_POSITIONS;
  positions.size = size_t{mesh.position_count} * 3;
  run(name, rig, positions);
  constexpr uint32_t kChosen = 200;
  if (mesh.position_count <= kChosen) return;
  for (uint32_t i = 0; i < kChosen; ++i) {
    const auto p = static_cast<uint32_t>(size_t{i} * mesh.position_count / kChosen);
    positions.chosen.insert(positions.chosen.end(), {3 * p, 3 * p + 1, 3 * p + 2});
  }
  run(name, rig, positions);
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
