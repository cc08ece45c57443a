// SPDX-License-Identifier: MIT
// The effects of controls: the metric G = P^T W P of all controls, where P are the derivatives of joint
// values, or of points, by controls at the neutral pose. For joint values it holds in every pose (where
// rotations are sums of angles); for points it is near enough for steps, whose gradients are exact.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

namespace mien {
namespace {

struct Column {
  uint32_t first, count;  // into the entries
};

/// The sparse matrix P, its columns, and one dense column at a time against all others.
void multiply_columns(Span<Column> columns, const uint32_t* rows, const float* values,
                      double* dense, double* metric) {
  const size_t count = columns.count;
  for (size_t a = 0; a < count; ++a) {
    const Column& one = columns[a];
    for (uint32_t i = 0; i < one.count; ++i) dense[rows[one.first + i]] = values[one.first + i];
    for (size_t b = a; b < count && one.count != 0; ++b) {
      const Column& other = columns[b];
      double sum = 0;
      for (uint32_t i = 0; i < other.count; ++i) {
        sum += dense[rows[other.first + i]] * values[other.first + i];
      }
      metric[a * count + b] = metric[b * count + a] = sum;
    }
    for (uint32_t i = 0; i < one.count; ++i) dense[rows[one.first + i]] = 0;
  }
}

/// The derivatives of a point of the chain by one before it, by column. Null data if memory ran out.
struct Entries {
  Span<Column> columns;
  Span<uint32_t> rows, numbers;
  Span<float> values;
};
bool find_entries(MienFit& fit, MienDerivatives* derivatives, uint32_t from, uint32_t to,
                  Arena& arena, Entries& out) {
  MienJacobian jacobian = mien_jacobian_default();
  size_t count = 0;
  if (mien_derivatives_linearize(derivatives, fit.instance, MIEN_STAGE_ALL) != MIEN_OK ||
      mien_derivatives_jacobian(derivatives, from, to, fit.mesh, &jacobian, &count) != MIEN_OK) {
    return false;
  }
  out.columns = arena.array<Column>(fit.control_count + 1);
  out.rows = arena.array<uint32_t>(count + 1);
  out.numbers = arena.array<uint32_t>(count + 1);
  out.values = arena.array<float>(count + 1);
  if (!out.columns.data || !out.rows.data || !out.numbers.data || !out.values.data) return false;
  jacobian.rows = out.rows.data;
  jacobian.columns = out.numbers.data;
  jacobian.values = out.values.data;
  jacobian.capacity = count;
  if (count != 0 &&
      mien_derivatives_jacobian(derivatives, from, to, fit.mesh, &jacobian, &count) != MIEN_OK) {
    return false;
  }
  out.columns = out.columns.first(fit.control_count);
  for (uint32_t i = 0; i < count; ++i) {
    Column& column = out.columns[out.numbers[i]];
    if (column.count++ == 0) column.first = i;
  }
  return true;
}

/// Whether joint values are sums over the controls: at a pose, that is what evaluation gives.
bool are_sums(MienFit& fit, const Entries& entries, const Span<double>& sums) {
  for (size_t i = 0; i < fit.controls.count; ++i) {
    const float high = fit.upper[i], low = fit.lower[i];
    fit.raw[fit.controls[i]] = low + 0.3f * (high - low);
  }
  evaluate(fit);
  std::fill(sums.begin(), sums.end(), 0.0);
  for (size_t c = 0; c < fit.control_count; ++c) {
    const Column& column = entries.columns[c];
    for (uint32_t i = column.first; i < column.first + column.count; ++i) {
      sums[entries.rows[i]] += double{fit.all_controls[c]} * entries.values[i];
    }
  }
  double worst = 0, largest = 0;
  for (size_t i = 0; i < fit.joint_count; ++i) {
    worst = std::max(worst, std::fabs(double{fit.joints[i]} - sums[i]));
    largest = std::max(largest, std::fabs(double{fit.joints[i]}));
  }
  std::copy(fit.initial.begin(), fit.initial.end(), fit.raw.begin());
  evaluate(fit);
  return worst <= 1e-5 * largest;
}

/// What correctives read: the derivatives by raw controls where all are a little above 0, so that no factor is 0 and
/// no product above 1. Networks and RBF solvers have none. False if memory ran out.
bool find_dependencies(MienFit& fit, Arena& arena, Entries& out) {
  uint32_t learned = 0, solved = 0;
  static_cast<void>(mien_rig_count(fit.rig, MIEN_KIND_ML_CONTROL, &learned));
  static_cast<void>(mien_rig_count(fit.rig, MIEN_KIND_RBF_CONTROL, &solved));
  if (learned + solved != 0) return true;
  std::fill(fit.raw.begin(), fit.raw.end(), 0.01f);
  evaluate(fit);
  const bool found =
      find_entries(fit, fit.control_derivatives, MIEN_POINT_RAW, MIEN_POINT_CONTROLS, arena, out);
  std::copy(fit.initial.begin(), fit.initial.end(), fit.raw.begin());
  evaluate(fit);
  return found;
}

void place_effects(size_t count, size_t dependency_count, Placer& placer, MienFit& fit) {
  fit.joint_first = placer.array<uint32_t>(fit.control_count + 1);
  fit.joint_rows = placer.array<uint32_t>(count);
  fit.joint_effects = placer.array<float>(count);
  fit.depends_first = placer.array<uint32_t>(fit.control_count + 1);
  fit.depends_on = placer.array<uint32_t>(dependency_count);
  fit.block_targets = placer.array<float>(fit.joint_count * kBlockFrames);
  fit.block_pulls = placer.array<double>(fit.control_count * kBlockFrames);
  fit.counting = placer.array<uint32_t>(fit.control_count);
  fit.counts = placer.array<uint8_t>(fit.control_count);
  fit.above_zero = placer.array<uint8_t>(fit.raw_count);
  fit.matrix_free = placer.array<uint32_t>(fit.controls.count);
  fit.factor_free = placer.array<uint32_t>(fit.controls.count);
  fit.kept_matrix = placer.array<double>(fit.controls.count * fit.controls.count);
}

void keep_dependencies(MienFit& fit, const Entries& entries, size_t count) {
  const auto for_each = [&](auto&& f) {
    for (size_t i = 0; i < count; ++i) {
      if (entries.rows[i] >= fit.raw_count) f(entries.rows[i], entries.numbers[i]);
    }
  };
  for_each([&](uint32_t control, uint32_t) { ++fit.depends_first[control + 1]; });
  for (size_t c = 0; c < fit.control_count; ++c) fit.depends_first[c + 1] += fit.depends_first[c];
  // Each list is filled from its end, then it begins where it should.
  for (size_t c = fit.control_count; c > 0; --c) fit.depends_first[c] = fit.depends_first[c - 1];
  for_each([&](uint32_t control, uint32_t raw) {
    fit.depends_on[fit.depends_first[control + 1]++] = raw;
  });
}

/// For mien_fit_solve_frames(). False if memory ran out.
bool keep_effects(MienFit& fit, const Entries& entries, Arena& arena) {
  const size_t count = entries.rows.count - 1;
  Entries dependencies;
  if (!find_dependencies(fit, arena, dependencies)) return false;
  const size_t dependency_count = dependencies.rows.empty() ? 0 : dependencies.rows.count - 1;
  MienFit measured = fit;
  Placer sizes(nullptr);
  place_effects(count, dependency_count, sizes, measured);
  fit.joint_block_size = sizes.size();
  fit.joint_block = fit.allocator.get(fit.joint_block_size, kBlockAlignment);
  if (!fit.joint_block) return false;
  Placer placer(fit.joint_block);
  place_effects(count, dependency_count, placer, fit);
  std::copy(entries.rows.data, entries.rows.data + count, fit.joint_rows.data);
  std::copy(entries.values.data, entries.values.data + count, fit.joint_effects.data);
  for (size_t c = 0; c < fit.control_count; ++c) {
    fit.joint_first[c + 1] = fit.joint_first[c] + entries.columns[c].count;
  }
  keep_dependencies(fit, dependencies, dependency_count);
  return true;
}

bool measure_joints(MienFit& fit, Arena& arena, Entries& entries) {
  const Span<double> dense = arena.array<double>(fit.joint_count + 1);
  if (!dense.data || !find_entries(fit, fit.control_derivatives, MIEN_POINT_CONTROLS,
                                   MIEN_POINT_JOINTS, arena, entries)) {
    return false;
  }
  if (are_sums(fit, entries, dense.first(fit.joint_count)) && !keep_effects(fit, entries, arena)) {
    return false;
  }
  std::fill(dense.begin(), dense.end(), 0.0);
  for (size_t i = 0; i + 1 < entries.rows.count; ++i) {
    entries.values[i] *= std::sqrt(fit.joint_weights[entries.rows[i]]);
  }
  multiply_columns(entries.columns, entries.rows.data, entries.values.data, dense.data,
                   fit.joint_metric.data);
  return true;
}

/// Some of the points, evenly chosen, stand for all.
bool measure_points(MienFit& fit, Arena& arena) {
  const size_t count = fit.samples.count;
  Entries entries;
  if (!find_entries(fit, fit.sample_derivatives, MIEN_POINT_CONTROLS, MIEN_POINT_POSITIONS, arena,
                    entries)) {
    return false;
  }
  const Span<float> coordinates = arena.array<float>(fit.sample_position_count * 3 + 1);
  const Span<double> dense = arena.array<double>(count * 3 + 1);
  const Span<Column> columns = arena.array<Column>(fit.control_count + 1);
  // An entry of a coordinate becomes at most as many of points.
  const Span<uint32_t> rows = arena.array<uint32_t>(fit.control_count * count * 3 + 1);
  const Span<float> values = arena.array<float>(fit.control_count * count * 3 + 1);
  if (!coordinates.data || !dense.data || !columns.data || !rows.data || !values.data) return false;
  const double scale =
      std::sqrt(static_cast<double>(fit.points.count) / static_cast<double>(count));
  std::fill(fit.sample_effects.begin(), fit.sample_effects.end(), 0.0f);
  uint32_t at = 0;
  for (size_t c = 0; c < fit.control_count; ++c) {
    const Column& column = entries.columns[c];
    columns[c] = {at, 0};
    if (column.count == 0) continue;
    std::fill(coordinates.begin(), coordinates.end(), 0.0f);
    for (uint32_t i = column.first; i < column.first + column.count; ++i) {
      coordinates[entries.rows[i]] = entries.values[i];
    }
    uint32_t row = 0;
    for (const MienSolvePoint& point : fit.sample_points) {
      for (uint32_t k = 0; k < 3; ++k, ++row) {
        double sum = 0;
        for (size_t n = 0; n < 3; ++n) {
          sum += double{point.weights[n]} * coordinates[size_t{point.positions[n]} * 3 + k];
        }
        fit.sample_effects[c * count * 3 + row] = static_cast<float>(sum);
        if (sum == 0) continue;
        rows[at] = row;
        values[at++] = static_cast<float>(sum * scale);
        ++columns[c].count;
      }
    }
  }
  multiply_columns(columns.first(fit.control_count), rows.data, values.data, dense.data,
                   fit.point_metric.data);
  return true;
}

/// Pivoted factorization: the share of the effect of a control that the controls chosen before it cannot
/// reproduce.
void find_observability(MienFit& fit) {
  const size_t count = fit.controls.count;
  for (size_t i = 0; i < count; ++i) {
    fit.free[i] = static_cast<uint32_t>(i);
    fit.inputs[i] = fit.controls[i];
  }
  list_free_derivatives(fit, count);
  std::fill(fit.matrix.begin(), fit.matrix.end(), 0.0);
  project_metric(fit, fit.joint_metric.data, 1, count);
  if (fit.points.count != 0) project_metric(fit, fit.point_metric.data, 1, count);
  std::fill(fit.observability.begin(), fit.observability.end(), 0.0f);
  double* const m = fit.matrix.data;
  double largest = 0;
  for (size_t i = 0; i < count; ++i) {
    fit.work[i] = m[i * count + i];
    fit.step[i] = 1;  // not chosen yet
    largest = std::max(largest, fit.work[i]);
  }
  if (!(largest > 0)) return;
  for (size_t n = 0; n < count; ++n) {
    size_t pivot = count;
    double best = 1e-9;
    for (size_t i = 0; i < count; ++i) {
      const double own = fit.work[i];
      if (fit.step[i] == 0 || !(own > 1e-12 * largest)) continue;
      const double share = m[i * count + i] / own;
      if (share > best) {
        best = share;
        pivot = i;
      }
    }
    if (pivot == count) return;
    fit.step[pivot] = 0;
    fit.observability[fit.controls[pivot]] = static_cast<float>(std::min(best, 1.0));
    const double diagonal = m[pivot * count + pivot];
    std::copy(m + pivot * count, m + (pivot + 1) * count, fit.factor.data);
    for (size_t i = 0; i < count; ++i) {
      if (fit.step[i] == 0) continue;
      const double factor = m[i * count + pivot] / diagonal;
      if (factor == 0) continue;
      for (size_t k = 0; k < count; ++k) m[i * count + k] -= factor * fit.factor[k];
    }
  }
}

}  // namespace

bool measure_rig(MienFit& fit, Arena& arena) {
  Entries joints;
  if (!measure_joints(fit, arena, joints)) return false;
  if (fit.points.count != 0 && !measure_points(fit, arena)) return false;
  find_observability(fit);
  return true;
}

void list_free_derivatives(MienFit& fit, size_t free_count) {
  MienJacobian jacobian = mien_jacobian_default();
  jacobian.inputs = fit.inputs.data;
  jacobian.input_count = free_count;
  jacobian.rows = fit.rows.data;
  jacobian.columns = fit.columns.data;
  jacobian.values = fit.values.data;
  jacobian.capacity = fit.values.count;
  size_t count = 0;
  std::fill(fit.first.data, fit.first.data + free_count + 1, 0u);
  if (free_count == 0) return;
  static_cast<void>(mien_derivatives_jacobian(fit.control_derivatives, MIEN_POINT_RAW,
                                              MIEN_POINT_CONTROLS, 0, &jacobian, &count));
  for (size_t i = 0; i < count; ++i) ++fit.first[fit.columns[i] + 1];
  for (size_t c = 0; c < free_count; ++c) fit.first[c + 1] += fit.first[c];
}

void project_metric(MienFit& fit, const double* metric, double factor, size_t free_count) {
  // Only controls that D has count.
  size_t support = 0;
  for (uint32_t i = 0; i < fit.first[free_count]; ++i) fit.places[fit.rows[i]] = 1;
  for (uint32_t c = 0; c < fit.control_count; ++c) {
    if (fit.places[c] == 0) continue;
    fit.places[c] = static_cast<uint32_t>(support);
    fit.support[support++] = c;
  }
  double* const row = fit.projected.data;
  for (size_t a = 0; a < free_count; ++a) {
    std::fill(row, row + support, 0.0);
    for (uint32_t i = fit.first[a]; i < fit.first[a + 1]; ++i) {
      const double* const from = metric + size_t{fit.rows[i]} * fit.control_count;
      const double value = factor * double{fit.values[i]};
      for (size_t s = 0; s < support; ++s) row[s] += value * from[fit.support[s]];
    }
    for (size_t b = 0; b <= a; ++b) {
      double sum = 0;
      for (uint32_t i = fit.first[b]; i < fit.first[b + 1]; ++i) {
        sum += row[fit.places[fit.rows[i]]] * double{fit.values[i]};
      }
      fit.matrix[a * free_count + b] += sum;
      if (a != b) fit.matrix[b * free_count + a] += sum;
    }
  }
  for (size_t s = 0; s < support; ++s) fit.places[fit.support[s]] = 0;
}

}  // namespace mien
