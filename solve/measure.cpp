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

/// The derivatives of a point of the chain by all controls, by column, without those of 0.
struct Entries {
  Span<Column> columns;
  Span<uint32_t> rows;
  Span<float> values;
};
/// False if memory ran out.
bool find_entries(MienFit& fit, MienDerivatives* derivatives, uint32_t to, Arena& arena,
                  Entries& out) {
  MienJacobianDesc desc = mien_jacobian_desc_default();
  desc.from_point = MIEN_POINT_CONTROLS;
  desc.to_point = to;
  desc.lod = fit.lod;
  const MienAllocator allocator = {fit.allocator.user, fit.allocator.allocate,
                                   fit.allocator.release};
  desc.allocator = &allocator;
  MienJacobian* jacobian = nullptr;
  MienJacobianPattern pattern = mien_jacobian_pattern_default();
  if (mien_jacobian_create(derivatives, &desc, &jacobian, nullptr) != MIEN_OK) return false;
  bool made = mien_jacobian_pattern(jacobian, &pattern) == MIEN_OK;
  const size_t count = pattern.rows.count;
  out.columns = arena.array<Column>(fit.control_count + 1);
  out.rows = arena.array<uint32_t>(count + 1);
  out.values = arena.array<float>(count + 1);
  made = made && out.columns.data && out.rows.data && out.values.data &&
         mien_derivatives_linearize(derivatives, fit.instance, MIEN_STAGE_ALL) == MIEN_OK &&
         mien_derivatives_jacobian(derivatives, jacobian, nullptr, 0, out.values.data, count) ==
             MIEN_OK;
  uint32_t kept = 0;
  for (size_t i = 0; made && i < count; ++i) {
    if (out.values[i] == 0) continue;
    Column& column = out.columns[pattern.columns.data[i]];
    if (column.count++ == 0) column.first = kept;
    out.rows[kept] = pattern.rows.data[i];
    out.values[kept++] = out.values[i];
  }
  mien_jacobian_destroy(jacobian);
  if (!made) return false;
  out.columns = out.columns.first(fit.control_count);
  out.rows = out.rows.first(kept);
  out.values = out.values.first(kept);
  return true;
}

/// metric = P^T P, one row of P after the other: only controls that have an entry in the same row have a product. False
/// if memory ran out.
bool multiply_rows(const Entries& entries, size_t row_count, Arena& arena, double* metric) {
  const size_t count = entries.columns.count;
  const Span<uint32_t> first = arena.array<uint32_t>(row_count + 1);
  const Span<uint32_t> controls = arena.array<uint32_t>(entries.rows.count + 1);
  const Span<float> values = arena.array<float>(entries.rows.count + 1);
  if (!first.data || !controls.data || !values.data) return false;
  for (const uint32_t row : entries.rows) ++first[row];
  uint32_t end = 0;
  for (uint32_t& of_row : first) {  // each begins where the one before ends
    const uint32_t own = of_row;
    of_row = end;
    end += own;
  }
  for (size_t c = 0; c < count; ++c) {
    const Column& column = entries.columns[c];
    for (uint32_t i = column.first; i < column.first + column.count; ++i) {
      uint32_t& to = first[entries.rows[i]];
      controls[to] = static_cast<uint32_t>(c);
      values[to++] = entries.values[i];
    }
  }
  uint32_t begin = 0;  // by now each has moved to its end
  for (size_t row = 0; row < row_count; begin = first[row++]) {
    for (uint32_t i = begin; i < first[row]; ++i) {
      double* const to = metric + size_t{controls[i]} * count;
      const double value = double{values[i]};
      for (uint32_t k = begin; k <= i; ++k) to[controls[k]] += value * values[k];
    }
  }
  for (size_t a = 0; a < count; ++a) {
    for (size_t b = 0; b < a; ++b) metric[b * count + a] = metric[a * count + b];
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

/// Calls f(corrective, raw control that it reads, directly or not), if networks and RBF solvers, which are no products,
/// write none of the controls.
template <class F>
void for_each_dependency(const MienFit& fit, F&& f) {
  uint32_t learned = 0, solved = 0;
  static_cast<void>(mien_rig_count(fit.rig, MIEN_KIND_ML_CONTROL, &learned));
  static_cast<void>(mien_rig_count(fit.rig, MIEN_KIND_RBF_CONTROL, &solved));
  if (learned + solved != 0) return;
  const MienJacobianPattern pattern = pattern_of(fit);
  for (size_t i = 0; i < pattern.rows.count; ++i) {
    if (pattern.rows.data[i] >= fit.raw_count) f(pattern.rows.data[i], pattern.columns.data[i]);
  }
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

void keep_dependencies(MienFit& fit) {
  for_each_dependency(fit, [&](uint32_t control, uint32_t) { ++fit.depends_first[control + 1]; });
  for (size_t c = 0; c < fit.control_count; ++c) fit.depends_first[c + 1] += fit.depends_first[c];
  // Each list is filled from its end, then it begins where it should.
  for (size_t c = fit.control_count; c > 0; --c) fit.depends_first[c] = fit.depends_first[c - 1];
  for_each_dependency(fit, [&](uint32_t control, uint32_t raw) {
    fit.depends_on[fit.depends_first[control + 1]++] = raw;
  });
}

/// For mien_fit_solve_frames(). False if memory ran out.
bool keep_effects(MienFit& fit, const Entries& entries) {
  const size_t count = entries.rows.count;
  size_t dependency_count = 0;
  for_each_dependency(fit, [&](uint32_t, uint32_t) { ++dependency_count; });
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
  keep_dependencies(fit);
  return true;
}

bool measure_joints(MienFit& fit, Arena& arena, Entries& entries) {
  const Span<double> sums = arena.array<double>(fit.joint_count + 1);
  if (!sums.data ||
      !find_entries(fit, fit.control_derivatives, MIEN_POINT_JOINTS, arena, entries)) {
    return false;
  }
  if (fit.rotations.empty() && are_sums(fit, entries, sums.first(fit.joint_count)) &&
      !keep_effects(fit, entries)) {
    return false;
  }
  for (size_t i = 0; i < entries.rows.count; ++i) {
    entries.values[i] *= std::sqrt(fit.joint_weights[entries.rows[i]]);
  }
  return multiply_rows(entries, fit.joint_count, arena, fit.joint_metric.data);
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
  // A control moves things itself, and by what networks and RBF solvers make of it.
  const auto project = [&](const Span<double>& metric, const Span<double>& stiffness) {
    for (size_t i = 0; i < count; ++i) stiffness[i] = fit.matrix[i * (count + 1)];
    project_metric(fit, metric.data, 1, count);
    for (size_t i = 0; i < count; ++i) {
      const double own = metric[size_t{fit.controls[i]} * (fit.control_count + 1)];
      stiffness[i] = std::max(fit.matrix[i * (count + 1)] - stiffness[i], own);
    }
  };
  project(fit.joint_metric, fit.joint_stiffness);
  if (fit.points.count != 0) project(fit.point_metric, fit.point_stiffness);
  std::fill(fit.observability.begin(), fit.observability.end(), 0.0f);
  hold_matrix(fit, count);
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
    if (pivot == count) break;
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
  // A rotation is determined as well as the turn that is determined least.
  for (const uint32_t r : fit.rotations) {
    float* const parts = fit.observability.data + fit.controls[r];
    std::fill(parts, parts + 4, std::min({parts[0], parts[1], parts[2]}));
  }
}

}  // namespace

bool measure_rig(MienFit& fit, Span<const MienDeformer*> deformers, Arena& arena) {
  Entries joints;
  if (!measure_joints(fit, arena, joints)) return false;
  if (fit.points.count != 0 && !measure_points(fit, deformers, arena)) return false;
  find_observability(fit);
  return true;
}

void list_free_derivatives(MienFit& fit, size_t free_count) {
  fit.first[0] = 0;
  if (free_count == 0) return;
  std::fill(fit.wanted.begin(), fit.wanted.end(), uint8_t{0});
  for (size_t a = 0; a < free_count; ++a) fit.wanted[fit.inputs[a]] = 1;
  static_cast<void>(mien_derivatives_jacobian(fit.control_derivatives, fit.by_raw, fit.wanted.data,
                                              fit.wanted.count, fit.entries.data,
                                              fit.entries.count));
  const MienIndex32View rows = pattern_of(fit).rows;
  uint32_t count = 0;
  for (size_t a = 0; a < free_count; ++a) {
    const uint32_t raw = fit.inputs[a];
    for (uint32_t i = fit.first_entry[raw]; i < fit.first_entry[raw + 1]; ++i) {
      if (fit.entries[i] == 0) continue;
      fit.rows[count] = rows.data[i];
      fit.values[count++] = fit.entries[i];
    }
    fit.first[a + 1] = count;
  }
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
