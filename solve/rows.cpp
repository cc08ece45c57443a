// SPDX-License-Identifier: MIT
// The part of points in the matrix of a step: derivatives of the residuals of samples by the free controls.
#include <algorithm>

#include "solve/frame.h"

namespace mien {
namespace {

/// What free controls do to the samples at the pose at hand, kDirections at a time.
void measure_controls(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
  const size_t width = f.samples.count * 3;
  const Span<MienSolvePoint>& points = f.own_samples ? fit.points : fit.sample_points;
  size_t a = 0;
  while (a < free_count) {
    uint32_t places[kDirections], count = 0;
    for (; a < free_count && count < kDirections; ++a) {
      if (!fit.measured[fit.free[a]]) places[count++] = fit.free[a];
    }
    for (uint32_t k = 0; k < count; ++k) {
      float* const direction = fit.directions.data + k * fit.raw_count;
      std::fill(direction, direction + fit.raw_count, 0.0f);
      direction[fit.controls[places[k]]] = 1;
    }
    if (count == 0) return;
    for (uint32_t m = 0; m < fit.meshes.count; ++m) {
      const FitMesh& mesh = fit.meshes[m];
      const size_t size = (f.own_samples ? mesh.count : mesh.sample_count) * 3;
      if (size == 0) continue;
      static_cast<void>(mien_derivatives_forward(
          f.own_samples ? mesh.derivatives : mesh.sample_derivatives, MIEN_POINT_RAW,
          MIEN_POINT_POSITIONS, mesh.mesh, count, fit.directions.data, fit.moved.data));
      for (uint32_t k = 0; k < count; ++k) {
        float* const effects = fit.step_effects.data + places[k] * width;
        for (size_t s = 0; s < f.samples.count; ++s) {
          const MienSolvePoint& point = points[f.own_samples ? f.samples[s] : s];
          if (point.mesh != m) continue;
          for (size_t axis = 0; axis < 3; ++axis) {
            float sum = 0;
            for (size_t n = 0; n < 3; ++n) {
              sum += point.weights[n] * fit.moved[k * size + size_t{point.positions[n]} * 3 + axis];
            }
            effects[3 * s + axis] = sum;
          }
        }
      }
    }
    for (uint32_t k = 0; k < count; ++k) fit.measured[places[k]] = 1;
  }
}

/// The effects of the free controls: those of this pose, or what all controls do at the neutral pose.
void find_effects(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
  const size_t width = f.samples.count * 3;
  if (f.exact || f.own_samples) {
    for (const FitMesh& mesh : fit.meshes) {
      if (f.own_samples || mesh.sample_derivatives == mesh.derivatives) continue;
      static_cast<void>(
          mien_derivatives_linearize(mesh.sample_derivatives, fit.instance, MIEN_STAGE_ALL));
    }
    return measure_controls(f, free_count);
  }
  for (size_t a = 0; a < free_count; ++a) {
    float* const to = fit.step_effects.data + fit.free[a] * width;
    std::fill(to, to + width, 0.0f);
    for (uint32_t k = fit.first[a]; k < fit.first[a + 1]; ++k) {
      const float* const from = fit.sample_effects.data + size_t{fit.rows[k]} * width;
      for (size_t n = 0; n < width; ++n) to[n] += fit.values[k] * from[n];
    }
  }
}

}  // namespace

void add_point_rows(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
  find_effects(f, free_count);
  const size_t motion = f.motion_count(), width = motion + free_count;
  double* const wide = fit.wide.data;
  double* const panel = fit.panel.data;
  std::fill(wide, wide + width * width, 0.0);
  std::fill(panel, panel + width * kPanel, 0.0);
  size_t filled = 0;  // rows of J, which are columns of the panel
  const auto add_products = [&] {
    for_each_product(panel, width,
                     [&](size_t a, size_t b, double sum) { wide[a * width + b] += sum; });
    std::fill(panel, panel + width * kPanel, 0.0);
    filled = 0;
  };
  const auto add_rows = [&](Kind kind, size_t s, double weight) {
    const size_t i = f.samples[s];
    const double scale = std::sqrt(weight);
    const Motion& placed = f.motion_of(kind);
    double directions[3][3], residuals[3], moved[3];
    placed.place(fit.surface.data + 3 * i, moved);
    const size_t rows = point_rows(f, kind, i, directions, residuals);
    for (size_t r = 0; r < rows; ++r) {
      double back[3], by_motion[kMostMotion] = {};
      placed.turn_back(directions[r], back);
      if (motion != 0 && f.moves(kind)) list_motion(f, moved, directions[r], r, by_motion);
      for (size_t a = 0; a < motion; ++a) panel[a * kPanel + filled] = scale * by_motion[a];
      for (size_t a = 0; a < free_count; ++a) {
        const float* const effect = fit.step_effects.data + (fit.free[a] * f.samples.count + s) * 3;
        panel[(motion + a) * kPanel + filled] =
            scale * (back[0] * effect[0] + back[1] * effect[1] + back[2] * effect[2]);
      }
      if (++filled == kPanel) add_products();
    }
  };
  for (const Kind kind : kAllKinds) {
    if (!f.has(kind)) continue;
    const Span<double>& pulls = fit.kinds[kind].pulls;
    double all = 0, sampled = 0;
    for (const double pull : pulls) all += pull;
    for (const uint32_t i : f.samples) sampled += pulls[i];
    for (size_t s = 0; s < f.samples.count; ++s) {
      const double pull = pulls[f.samples[s]];
      if (pull > 0) add_rows(kind, s, pull * all / sampled);
    }
  }
  if (filled != 0) add_products();
  // Without the motion, which is chosen anew at each pose: its part is eliminated.
  for (size_t p = 0; p < motion; ++p) {
    const double pivot = wide[p * width + p];
    if (!(pivot > 1e-12)) continue;
    for (size_t a = p + 1; a < width; ++a) {
      const double factor = wide[a * width + p] / pivot;
      for (size_t b = p + 1; b <= a; ++b) wide[a * width + b] -= factor * wide[b * width + p];
    }
  }
  for (size_t a = 0; a < free_count; ++a) {
    for (size_t b = 0; b <= a; ++b) {
      const double value = wide[(motion + a) * width + motion + b];
      fit.matrix[a * free_count + b] += value;
      if (a != b) fit.matrix[b * free_count + a] += value;
    }
  }
}

}  // namespace mien
