// SPDX-License-Identifier: MIT
// The motion of a target as a whole: rigid, or that of a camera, with its focal length.
#include <algorithm>

#include "solve/frame.h"

namespace mien {
namespace {

bool is_moving(const Frame& f, Kind kind) { return f.has(kind) && f.moves(kind); }

/// The cost of the points as they are placed now, and what it is compared by.
struct MotionCost {
  double total = 0, compared = 0;
};
MotionCost motion_cost(Frame& f) {
  MienFit& fit = f.fit;
  if (is_moving(f, kSurface)) match_surface(f);
  MotionCost cost;
  for (const Kind kind : kAllKinds) {
    if (!is_moving(f, kind)) continue;
    const KindTargets& to = fit.kinds[kind];
    const double scale = f.robust_scale_of(kind);
    double total = 0, compared = 0;
    for (size_t i = 0; i < fit.points.count; ++i) {
      to.pulls[i] = 0;
      if (!(to.weights[i] > 0)) continue;
      double gradient[3], weight;
      const double squared = point_residual(f, kind, i, gradient);
      if (kind == kSurface) {
        compared += to.weights[i] * robust(compared_residual(f, i, squared), scale, weight);
        if (fit.lost[i]) continue;
      }
      total += to.weights[i] * robust(squared, scale, weight);
      to.pulls[i] = to.weights[i] * weight;
    }
    cost.total += total;
    cost.compared += kind == kSurface ? compared : total;
  }
  return cost;
}

/// A small rotation about the origin, by the vector of its angle, then a translation, and a factor of the focal
/// length.
Motion changed(const Motion& from, const double* step, size_t count) {
  Motion to = from;
  const double angle = std::sqrt(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
  double turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (angle > 0) {
    const double x = step[0] / angle, y = step[1] / angle, z = step[2] / angle;
    const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
    const double m[9] = {c + d * x * x,     d * x * y - s * z, d * x * z + s * y,
                         d * x * y + s * z, c + d * y * y,     d * y * z - s * x,
                         d * x * z - s * y, d * y * z + s * x, c + d * z * z};
    std::copy(m, m + 9, turn);
  }
  for (size_t r = 0; r < 3; ++r) {
    for (size_t k = 0; k < 3; ++k) {
      to.rotation[3 * r + k] = 0;
      for (size_t n = 0; n < 3; ++n) {
        to.rotation[3 * r + k] += turn[3 * r + n] * from.rotation[3 * n + k];
      }
    }
    to.translation[r] = step[3 + r];
    for (size_t n = 0; n < 3; ++n) to.translation[r] += turn[3 * r + n] * from.translation[n];
  }
  if (count > 6) {
    const double factor = std::exp(std::min(std::max(step[6], -1.0), 1.0));
    for (double& focal : to.focal) focal *= factor;
  }
  return to;
}

/// Adds J^T W J and -J^T W r of the points by the numbers of the motion.
void add_motion_rows(const Frame& f, Kind kind, double* matrix, double* right) {
  const MienFit& fit = f.fit;
  const Span<double>& pulls = fit.kinds[kind].pulls;
  const size_t n = f.motion_count();
  for (size_t i = 0; i < fit.points.count; ++i) {
    if (!(pulls[i] > 0)) continue;
    double directions[3][3], residuals[3], moved[3], row[kMostMotion];
    f.motion.place(fit.surface.data + 3 * i, moved);
    const size_t rows = point_rows(f, kind, i, directions, residuals);
    for (size_t r = 0; r < rows; ++r) {
      list_motion(f, moved, directions[r], r, row);
      for (size_t a = 0; a < n; ++a) {
        right[a] -= pulls[i] * row[a] * residuals[r];
        for (size_t b = 0; b <= a; ++b) matrix[a * n + b] += pulls[i] * row[a] * row[b];
      }
    }
  }
}

}  // namespace

void list_motion(const Frame& f, const double* moved, const double* direction, size_t row,
                 double* out) {
  // direction . (turn x moved), direction . shift
  out[0] = moved[1] * direction[2] - moved[2] * direction[1];
  out[1] = moved[2] * direction[0] - moved[0] * direction[2];
  out[2] = moved[0] * direction[1] - moved[1] * direction[0];
  std::copy(direction, direction + 3, out + 3);
  if (f.motion_count() > 6) out[6] = f.motion.focal[row] * moved[row] / moved[2];
}

void fit_motion(Frame& f, uint32_t rounds) {
  MienFit& fit = f.fit;
  const size_t n = f.motion_count();
  MotionCost cost = motion_cost(f);
  double damping = 1e-6;
  for (uint32_t round = 0; round < rounds; ++round) {
    if (round != 0 && f.is_late()) return;
    // Before there are best controls, each round is compared by the targets before it.
    if (f.in.surface && f.starting) keep_targets(fit);
    const double from = f.starting ? cost.total : cost.compared;
    double matrix[kMostMotion * kMostMotion] = {}, factor[kMostMotion * kMostMotion];
    double right[kMostMotion] = {};
    for (const Kind kind : kAllKinds) {
      if (is_moving(f, kind)) add_motion_rows(f, kind, matrix, right);
    }
    const Motion before = f.motion;
    double decrease = 0;
    for (int tries = 0; tries < 6 && !(decrease > 0); ++tries, damping *= 10) {
      if (!factor_matrix(matrix, n, damping, factor)) continue;
      double step[kMostMotion];
      std::copy(right, right + n, step);
      solve_factored(factor, n, step);
      f.motion = changed(before, step, n);
      cost = motion_cost(f);
      decrease = from - cost.compared;
    }
    if (!(decrease > 0)) {
      f.motion = before;
      motion_cost(f);
      return;
    }
    damping = std::max(damping * 0.01, 1e-9);
    if (decrease <= 1e-9 * from) return;
  }
}

void guess_camera(Frame& f) {
  MienFit& fit = f.fit;
  const KindTargets& to = fit.kinds[kImages];
  MienRigInfo info = mien_rig_info_default();
  static_cast<void>(mien_rig_info(fit.rig, &info));
  // The camera's x, y and z: to the left of the character, down, and to its back.
  constexpr uint32_t kCameraAxes[3][2] = {{MIEN_DIRECTION_LEFT, MIEN_DIRECTION_RIGHT},
                                          {MIEN_DIRECTION_DOWN, MIEN_DIRECTION_UP},
                                          {MIEN_DIRECTION_BACK, MIEN_DIRECTION_FRONT}};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t axis = info.axes[c];
      f.motion.rotation[3 * r + c] = axis == kCameraAxes[r][0]   ? 1
                                     : axis == kCameraAxes[r][1] ? -1
                                                                 : 0;
    }
  }
  for (double& t : f.motion.translation) t = 0;
  double total = 0, model[3] = {}, image[2] = {}, model_size = 0, image_size = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (size_t i = 0; i < fit.points.count; ++i) {
      if (!(to.weights[i] > 0)) continue;
      double at[3];
      f.motion.place(fit.surface.data + 3 * i, at);
      if (pass == 0) {
        total += to.weights[i];
        for (size_t k = 0; k < 3; ++k) model[k] += to.weights[i] * at[k];
        for (size_t k = 0; k < 2; ++k) image[k] += to.weights[i] * to.targets[3 * i + k];
        continue;
      }
      for (size_t k = 0; k < 2; ++k) {
        const double x = at[k] - model[k],
                     u = (to.targets[3 * i + k] - image[k]) / f.motion.focal[k];
        model_size += to.weights[i] * x * x;
        image_size += to.weights[i] * u * u;
      }
    }
    if (pass == 1 || !(total > 0)) break;
    for (double& v : model) v /= total;
    for (double& v : image) v /= total;
  }
  const double away = image_size > 0 ? std::sqrt(model_size / image_size) : 0;
  const double z = away > 0 ? away : 1;
  for (size_t k = 0; k < 2; ++k) {
    f.motion.translation[k] =
        (image[k] - double{f.in.camera->center[k]}) / f.motion.focal[k] * z - model[k];
  }
  f.motion.translation[2] = z - model[2];
}

}  // namespace mien
