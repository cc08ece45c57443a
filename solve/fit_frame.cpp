// SPDX-License-Identifier: MIT
// Solves a frame: bounded Gauss-Newton steps with Levenberg-Marquardt damping (docs/solving.md).
#include <algorithm>
#include <chrono>
#include <cmath>

#include "solve/frame.h"

using namespace mien;
using namespace mien::capi;

namespace {

constexpr uint32_t kDefaultIterations = 50;
constexpr double kEnoughDecrease = 1e-6;  // of the cost: far below what noise is worth
constexpr double kEnoughOfFirst = 1e-10;  // of the cost at the start
constexpr double kEnoughStep = 1e-6;      // of a control
constexpr double kRounding = 4e-7;        // of the largest coordinate: floats have no more digits
constexpr double kSlow = 0.3;             // of what the step before gained
constexpr double kFirstDamping = 1e-5;
constexpr uint32_t kFirstRounds = 40, kMotionRounds = 3;  // of motions, in which they converge

/// The sums over the data at some controls.
struct Cost {
  double total = 0, joints = 0, points = 0, joint_weight = 0, point_weight = 0;
  double joint_worst = 0, point_worst = 0;  // the latter squared
};

double square(double v) { return v * v; }

void evaluate(MienFit& fit) {
  static_cast<void>(mien_rig_evaluate_stages(fit.rig, fit.instance, fit.lod,
                                             MIEN_STAGE_ALL & ~uint32_t{MIEN_STAGE_ANIMATED_MAPS}));
}

/// The weight of a control's distance to where it started, or to its prior, and so on: adds to the cost, and
/// to gradients and diagonal if there are any.
double regularize(const Frame& f, const float* raw, double* gradient) {
  const MienFit& fit = f.fit;
  double cost = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    const uint32_t c = fit.controls[i];
    const double to_prior = double{raw[c]} - fit.prior[c], to_start = double{raw[c]} - fit.start[c];
    cost += f.in.prior_weight * square(to_prior) + f.in.smooth_weight * square(to_start) +
            f.in.sparse_weight * std::fabs(raw[c]);
    if (!gradient) continue;
    // At 0, the sign of the side to which the control may move: the sum of magnitudes has a kink there.
    const double sign = raw[c] > 0 ? 1 : raw[c] < 0 ? -1 : fit.upper[i] > 0 ? 1 : -1;
    gradient[i] += f.in.prior_weight * to_prior + f.in.smooth_weight * to_start +
                   0.5 * f.in.sparse_weight * sign;
  }
  for (size_t i = 0; i + 1 < fit.symmetric.count; i += 2) {
    cost +=
        f.in.symmetric_weight * square(double{raw[fit.symmetric[i]]} - raw[fit.symmetric[i + 1]]);
  }
  return cost;
}

/// Moves the target as a whole, or the camera, to where it fits the points, which have moved.
void follow_points(Frame& f, uint32_t rounds) {
  MienFit& fit = f.fit;
  if (f.in.points && f.in.rigid) {
    fit_rigid(fit.surface.data, fit.targets.data, fit.weights.data, fit.points.count,
              f.motion.rotation, f.motion.translation);
  } else if (f.in.rigid) {
    fit_motion(f, rounds);
  } else if (f.in.surface) {
    match_surface(f);
  }
}

void add_point_cost(Frame& f, bool with_gradients, Cost& cost) {
  MienFit& fit = f.fit;
  find_points(f);
  follow_points(f, kMotionRounds);
  if (with_gradients) {
    std::fill(fit.position_gradient.begin(), fit.position_gradient.end(), 0.0f);
  }
  for (size_t i = 0; i < fit.points.count; ++i) {
    fit.pulls[i] = 0;
    if (!(fit.weights[i] > 0)) continue;
    double gradient[3], weight;
    if (fit.lost[i] >= 0) {
      cost.points += fit.weights[i] * robust(fit.lost[i], double{f.in.robust_scale}, weight);
      continue;
    }
    const double squared = point_residual(f, i, gradient);
    cost.points += fit.weights[i] * robust(squared, double{f.in.robust_scale}, weight);
    cost.point_weight += fit.weights[i];
    cost.point_worst = std::max(cost.point_worst, squared);
    fit.pulls[i] = fit.weights[i] * weight;
    if (!with_gradients) continue;
    const MienSolvePoint& point = fit.points[i];
    for (size_t n = 0; n < 3; ++n) {
      float* to = fit.position_gradient.data + size_t{point.positions[n]} * 3;
      for (size_t k = 0; k < 3; ++k) {
        to[k] += static_cast<float>(fit.pulls[i] * point.weights[n] * gradient[k]);
      }
    }
  }
}

/// The cost at the controls of the instance; with gradients of joints and positions if asked for.
Cost find_cost(Frame& f, bool with_gradients) {
  MienFit& fit = f.fit;
  evaluate(fit);
  Cost cost;
  if (f.in.joints) {
    for (size_t i = 0; i < fit.joint_count; ++i) {
      const bool present = std::isfinite(f.in.joints[i]);
      const double weight = present ? fit.joint_weights[i] * f.joint_factor() : 0;
      const double r = present ? double{fit.joints[i]} - f.in.joints[i] : 0;
      cost.joints += weight * r * r;
      cost.joint_weight += weight;
      if (weight > 0) cost.joint_worst = std::max(cost.joint_worst, std::fabs(r));
      if (with_gradients) fit.joint_gradient[i] = static_cast<float>(weight * r);
    }
  }
  if (f.has_points()) add_point_cost(f, with_gradients, cost);
  cost.total = cost.joints + cost.points;
  return cost;
}

/// Half of the gradient of the cost by the controls that may move.
void find_gradient(Frame& f) {
  MienFit& fit = f.fit;
  static_cast<void>(mien_derivatives_linearize(fit.derivatives, fit.instance, MIEN_STAGE_ALL));
  std::fill(fit.gradient.begin(), fit.gradient.end(), 0.0);
  const auto add = [&](uint32_t from, const float* gradient, const Span<float>& out) {
    static_cast<void>(mien_derivatives_reverse(fit.derivatives, MIEN_POINT_RAW, from, fit.mesh, 1,
                                               gradient, out.data));
    for (size_t i = 0; i < fit.controls.count; ++i) fit.gradient[i] += out[fit.controls[i]];
  };
  if (f.in.joints) add(MIEN_POINT_JOINTS, fit.joint_gradient.data, fit.from_joints);
  if (f.has_points()) add(MIEN_POINT_POSITIONS, fit.position_gradient.data, fit.from_positions);
  regularize(f, fit.raw.data, fit.gradient.data);
  for (size_t i = 0; i + 1 < fit.symmetric.count; i += 2) {
    const uint32_t a = fit.symmetric[i], b = fit.symmetric[i + 1];
    const double difference = f.in.symmetric_weight * (double{fit.raw[a]} - fit.raw[b]);
    for (size_t k = 0; k < fit.controls.count; ++k) {
      if (fit.controls[k] == a) fit.gradient[k] += difference;
      if (fit.controls[k] == b) fit.gradient[k] -= difference;
    }
  }
}

/// Controls that are not held at a bound by the gradient.
size_t list_free(const MienFit& fit) {
  size_t count = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    const float value = fit.raw[fit.controls[i]];
    if (value <= fit.lower[i] && fit.gradient[i] >= 0) continue;
    if (value >= fit.upper[i] && fit.gradient[i] <= 0) continue;
    fit.free[count] = static_cast<uint32_t>(i);
    fit.inputs[count++] = fit.controls[i];
  }
  return count;
}

/// The mean weight of points: what the metric of points is multiplied by.
double point_factor(const MienFit& fit) {
  double factor = 0;
  for (size_t i = 0; i < fit.points.count; ++i) factor += fit.pulls[i];
  return factor / static_cast<double>(fit.points.count);
}

/// The matrix of a step: D^T G D and the regularization.
void set_matrix(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
  list_free_derivatives(fit, free_count);
  std::fill(fit.matrix.data, fit.matrix.data + free_count * free_count, 0.0);
  if (f.in.joints) project_metric(fit, fit.joint_metric.data, f.joint_factor(), free_count);
  if (f.has_points() && f.has_rows()) {
    add_point_rows(f, free_count);
  } else if (f.has_points()) {
    project_metric(fit, fit.point_metric.data, point_factor(fit), free_count);
  }
  for (size_t a = 0; a < free_count; ++a) {
    fit.matrix[a * free_count + a] += double{f.in.prior_weight} + f.in.smooth_weight;
  }
  for (size_t i = 0; i + 1 < fit.symmetric.count && f.in.symmetric_weight > 0; i += 2) {
    size_t at[2] = {free_count, free_count};
    for (size_t a = 0; a < free_count; ++a) {
      for (size_t n = 0; n < 2; ++n) at[n] = fit.inputs[a] == fit.symmetric[i + n] ? a : at[n];
    }
    for (const size_t a : at) {
      if (a != free_count) fit.matrix[a * free_count + a] += f.in.symmetric_weight;
    }
    if (at[0] == free_count || at[1] == free_count) continue;
    fit.matrix[at[0] * free_count + at[1]] -= f.in.symmetric_weight;
    fit.matrix[at[1] * free_count + at[0]] -= f.in.symmetric_weight;
  }
}

/// A step from `best` into the instance; controls that leave their bounds stay at them. Returns how far the
/// farthest control moved.
double take_step(Frame& f, size_t free_count, double damping) {
  MienFit& fit = f.fit;
  while (!factor_matrix(fit.matrix.data, free_count, damping, fit.factor.data)) {
    damping = std::max(damping * 10, 1e-8);
  }
  for (size_t a = 0; a < free_count; ++a) fit.step[a] = -fit.gradient[fit.free[a]];
  solve_factored(fit.factor.data, free_count, fit.step.data);
  double farthest = 0;
  for (size_t a = 0; a < free_count; ++a) {
    const uint32_t i = fit.free[a], c = fit.controls[i];
    const double low = fit.lower[i], high = fit.upper[i], from = fit.best[c];
    double to = std::min(std::max(from + fit.step[a], low), high);
    // A control does not jump over the kink of the sum of magnitudes.
    if (f.in.sparse_weight > 0 && from * to < 0) to = 0;
    farthest = std::max(farthest, std::fabs(to - from));
    fit.raw[c] = static_cast<float>(to);
  }
  return farthest;
}

bool is_weight(float v) { return v >= 0 && std::isfinite(v); }

MienStatus check_camera(const MienFitFrame& in) {
  const MienFitCamera& camera = *in.camera;
  bool known = false;
  for (const float v : camera.rotation) {
    if (!std::isfinite(v)) return MIEN_ERROR_INVALID_ARGUMENT;
    known = known || v != 0;
  }
  for (size_t k = 0; k < 2; ++k) {
    if (!std::isfinite(camera.center[k]) || !std::isfinite(camera.focal[k]) ||
        (in.rigid && !(camera.focal[k] > 0))) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
  }
  for (const float v : camera.translation) {
    if (!std::isfinite(v)) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  return known || in.rigid ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

MienStatus check_frame(const MienFit& fit, const MienFitFrame& in) {
  const int kinds = (in.points ? 1 : 0) + (in.images ? 1 : 0) + (in.surface ? 1 : 0);
  if (kinds != 0 && fit.points.count == 0) return MIEN_ERROR_NULL_ARGUMENT;
  if (in.images && !in.camera) return MIEN_ERROR_NULL_ARGUMENT;
  if (kinds > 1) return MIEN_ERROR_INVALID_ARGUMENT;
  if (in.images) {
    if (MienStatus status = check_camera(in)) return status;
  }
  if (in.surface) {
    if (MienStatus status = check_tag(in.surface, kFitSurfaceTag)) return status;
  }
  for (const float weight :
       {in.prior_weight, in.smooth_weight, in.sparse_weight, in.symmetric_weight, in.robust_scale,
        in.joint_weight, in.surface_reach}) {
    if (!is_weight(weight)) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  for (size_t i = 0; in.point_weights && i < fit.points.count; ++i) {
    if (!is_weight(in.point_weights[i])) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  const auto finite = [&](const float* row) {
    for (size_t i = 0; row && i < fit.raw_count; ++i) {
      if (!std::isfinite(row[i])) return false;
    }
    return true;
  };
  return finite(in.start) && finite(in.prior) ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

/// Start and prior, the start within its bounds.
void read_rows(Frame& f) {
  MienFit& fit = f.fit;
  const float* start = f.in.start ? f.in.start : fit.initial.data;
  const float* prior = f.in.prior ? f.in.prior : fit.initial.data;
  std::copy(start, start + fit.raw_count, fit.start.data);
  std::copy(prior, prior + fit.raw_count, fit.prior.data);
  std::copy(start, start + fit.raw_count, fit.raw.data);
  for (size_t i = 0; i < fit.controls.count; ++i) {
    float& v = fit.raw[fit.controls[i]];
    v = std::min(std::max(v, fit.lower[i]), fit.upper[i]);
  }
}

double largest_target(const Frame& f) {
  double largest = 0;
  for (size_t i = 0; i < f.fit.points.count; ++i) {
    if (!(f.fit.weights[i] > 0)) continue;
    for (size_t k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(f.fit.targets[3 * i + k]));
  }
  return largest;
}

/// The motion at the start.
void start_motion(Frame& f) {
  if (!f.has_points() || !f.in.rigid) return;
  evaluate(f.fit);
  find_points(f);
  if (f.in.images &&
      std::all_of(f.motion.rotation, f.motion.rotation + 9, [](double v) { return v == 0; })) {
    guess_camera(f);
  }
  follow_points(f, kFirstRounds);
}

uint32_t solve(Frame& f, Cost& cost, uint32_t& iterations) {
  using Clock = std::chrono::steady_clock;
  MienFit& fit = f.fit;
  const auto begin = Clock::now();
  const auto late = [&] {
    return f.in.max_seconds > 0 &&
           std::chrono::duration<double>(Clock::now() - begin).count() >= f.in.max_seconds;
  };
  const uint32_t limit = f.in.max_iterations ? f.in.max_iterations : kDefaultIterations;
  const auto keep = [&] { std::copy(fit.raw.begin(), fit.raw.end(), fit.best.begin()); };
  const auto find_all = [&](bool with_gradients) {
    Cost found = find_cost(f, with_gradients);
    found.total += regularize(f, fit.raw.data, nullptr);
    return found;
  };
  start_motion(f);
  const auto is_rounding = [&](const Cost& found) {
    return !f.in.joints &&
           found.points <= found.point_weight * square(kRounding * largest_target(f));
  };
  cost = find_all(true);
  keep();
  if (!(cost.joint_weight + cost.point_weight > 0)) return MIEN_FIT_NO_DATA;
  const double first = cost.total;
  double damping = kFirstDamping, before = 0;
  uint32_t slow = 0;  // steps in a row that gained little less than the one before
  std::fill(fit.measured.begin(), fit.measured.end(), uint8_t{0});
  // Effects of controls on points change with the pose: where steps gain little, they are measured at it.
  const auto measure_again = [&] {
    if (!f.has_points() || (f.exact && slow == 0)) return false;
    f.exact = true;
    slow = 0;
    before = 0;
    damping = kFirstDamping;
    std::fill(fit.measured.begin(), fit.measured.end(), uint8_t{0});
    return true;
  };
  for (iterations = 0; iterations < limit; ++iterations) {
    if (f.in.canceled && f.in.canceled(f.in.user)) return MIEN_FIT_CANCELED;
    if (iterations != 0 && late()) return MIEN_FIT_TIME;
    find_gradient(f);
    const size_t free_count = list_free(fit);
    if (free_count == 0) return MIEN_FIT_CONVERGED;
    set_matrix(f, free_count);
    const Motion motion = f.motion;
    for (;;) {
      const double farthest = take_step(f, free_count, damping);
      const Cost next = find_all(true);
      if (next.total < cost.total) {
        const double decrease = cost.total - next.total;
        const double enough = std::max(kEnoughDecrease * cost.total, kEnoughOfFirst * first);
        slow = decrease > kSlow * before && before > 0 ? slow + 1 : 0;
        before = decrease;
        cost = next;
        keep();
        damping = std::max(damping * 0.2, 1e-7);
        if (is_rounding(cost)) return MIEN_FIT_CONVERGED;
        const bool done = decrease <= enough || farthest < kEnoughStep;
        if (done && (slow == 0 || !measure_again())) return MIEN_FIT_CONVERGED;
        if (slow >= 2) measure_again();
        break;
      }
      std::copy(fit.best.begin(), fit.best.end(), fit.raw.begin());
      f.motion = motion;
      const bool ended = farthest < kEnoughStep || damping > 1e8;
      if (ended) {
        cost = find_all(true);  // of the best controls
        if (!f.exact && damping > kFirstDamping && measure_again()) break;
        return MIEN_FIT_CONVERGED;
      }
      damping *= 10;
    }
  }
  return MIEN_FIT_ITERATIONS;
}

}  // namespace

MienStatus mien_fit_solve(MienFit* fit, const MienFitFrame* frame, float* out_raw,
                          MienFitResult* result) {
  if (!frame || !out_raw) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check_tag(fit, kFitTag)) return status;
  MienFitFrame known;
  if (MienStatus status = read_struct(frame, known)) return status;
  if (result) {
    if (MienStatus status = clear_struct(result)) return status;
  }
  if (MienStatus status = check_frame(*fit, known)) return status;
  Frame f = {*fit, known, {}};
  read_rows(f);
  if (f.has_points()) read_points(f);
  Cost cost;
  uint32_t iterations = 0;
  MienFitResult told = {};
  told.status = solve(f, cost, iterations);
  std::copy(fit->best.begin(), fit->best.end(), out_raw);
  told.iterations = iterations;
  told.cost = cost.total;
  const auto root_mean = [](double sum, double weight) {
    return weight > 0 ? std::sqrt(sum / weight) : 0.0;
  };
  told.joint_residual = root_mean(cost.joints, cost.joint_weight);
  told.point_residual = root_mean(cost.points, cost.point_weight);
  told.joint_worst = cost.joint_worst;
  told.point_worst = std::sqrt(cost.point_worst);
  told.missing_points = f.missing;
  for (int k = 0; k < 9; ++k) told.rotation[k] = static_cast<float>(f.motion.rotation[k]);
  for (int k = 0; k < 3; ++k) told.translation[k] = static_cast<float>(f.motion.translation[k]);
  for (int k = 0; k < 2 && f.in.images; ++k) told.focal[k] = static_cast<float>(f.motion.focal[k]);
  if (result) write_struct(result, told);
  return MIEN_OK;
}
