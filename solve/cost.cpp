// SPDX-License-Identifier: MIT
// The cost of a frame at the controls of the instance, and its gradient.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

namespace mien {
namespace {

constexpr uint32_t kMotionRounds = 3;  // in which motions converge from pose to pose

void add_joint_cost(Frame& f, Cost& cost) {
  MienFit& fit = f.fit;
  const double factor = f.joint_factor();
  for (size_t i = 0; i < fit.joint_count; ++i) {
    const bool present = std::isfinite(f.in.joints[i]);
    const double weight = present ? fit.joint_weights[i] * factor : 0;
    const double r = present ? double{fit.joints[i]} - f.in.joints[i] : 0;
    cost.joints.squares += weight * r * r;
    cost.joints.weight += weight;
    if (weight > 0) cost.joints.worst = std::max(cost.joints.worst, r * r);
    fit.joint_gradient[i] = static_cast<float>(weight * r);
  }
}

/// Adds the gradient by a point to that by its positions.
void add_to_positions(MienFit& fit, const MienSolvePoint& point, const double* gradient,
                      double factor) {
  for (size_t n = 0; n < 3; ++n) {
    if (point.weights[n] == 0) continue;
    const size_t position = fit.meshes[point.mesh].first + point.positions[n];
    float* to = fit.position_gradient.data + position * 3;
    const double share = factor * double{point.weights[n]};
    for (size_t k = 0; k < 3; ++k) to[k] += static_cast<float>(share * gradient[k]);
  }
}

void add_kind_cost(Frame& f, Kind kind, Cost& cost) {
  MienFit& fit = f.fit;
  const KindTargets& to = fit.kinds[kind];
  Sum& sum = cost.points[kind];
  const double scale = f.robust_scale_of(kind);
  const bool in_place = kind == kPoints && !(f.in.rigid && f.moves(kind));
  for (size_t i = 0; i < fit.points.count; ++i) {
    to.pulls[i] = 0;
    if (!(to.weights[i] > 0)) continue;
    double gradient[3], weight, squared;
    if (in_place) {
      const double *at = fit.surface.data + 3 * i, *target = to.targets.data + 3 * i;
      for (size_t k = 0; k < 3; ++k) gradient[k] = at[k] - target[k];
      squared = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
    } else {
      squared = point_residual(f, kind, i, gradient);
    }
    if (kind == kSurface) {
      cost.compared_surface +=
          to.weights[i] * robust(compared_residual(f, i, squared), scale, weight);
      if (fit.lost[i]) continue;
    }
    sum.squares += to.weights[i] * robust(squared, scale, weight);
    sum.weight += to.weights[i];
    sum.worst = std::max(sum.worst, squared);
    to.pulls[i] = to.weights[i] * weight;
    add_to_positions(fit, fit.points[i], gradient, to.pulls[i]);
  }
}

void add_symmetric_gradient(const Frame& f, const float* raw, double* gradient) {
  const MienFit& fit = f.fit;
  for (size_t i = 0; i + 1 < fit.symmetric.count && f.in.symmetric_weight > 0; i += 2) {
    const uint32_t a = fit.symmetric[i], b = fit.symmetric[i + 1];
    const double difference = f.in.symmetric_weight * (double{raw[a]} - raw[b]);
    for (size_t k = 0; k < fit.controls.count; ++k) {
      if (fit.controls[k] == a) gradient[k] += difference;
      if (fit.controls[k] == b) gradient[k] -= difference;
    }
  }
}

/// The last term, as the sum of magnitudes has a kink at the initial values: there the derivative is that of the side to
/// which the other terms pull, and 0 if they pull too little to leave it.
void add_sparse_gradient(const Frame& f, const float* raw, double* gradient) {
  const MienFit& fit = f.fit;
  const double half = 0.5 * f.in.sparse_weight;
  for (size_t i = 0; i < fit.controls.count && half > 0; ++i) {
    const double value = double{raw[fit.controls[i]]} - fit.initial[fit.controls[i]];
    double& g = gradient[i];
    g += value > 0 ? half : value < 0 ? -half : std::min(std::max(-g, -half), half);
  }
}

bool is_rotation(const MienFit& fit, size_t place) {
  for (const uint32_t r : fit.rotations) {
    if (place >= r && place < size_t{r} + 4) return true;
  }
  return false;
}

}  // namespace

void evaluate(MienFit& fit) {
  static_cast<void>(mien_rig_evaluate_stages(fit.rig, fit.instance, fit.lod,
                                             MIEN_STAGE_ALL & ~uint32_t{MIEN_STAGE_ANIMATED_MAPS}));
}

double regularize(const Frame& f, const float* raw, double* gradient) {
  const MienFit& fit = f.fit;
  double cost = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    const uint32_t c = fit.controls[i];
    const double to_prior = double{raw[c]} - fit.prior[c], to_start = double{raw[c]} - fit.start[c];
    cost += f.in.prior_weight * square(to_prior) + f.in.smooth_weight * square(to_start) +
            f.in.sparse_weight * std::fabs(double{raw[c]} - fit.initial[c]);
    if (gradient) gradient[i] += f.in.prior_weight * to_prior + f.in.smooth_weight * to_start;
  }
  for (size_t i = 0; i + 1 < fit.symmetric.count; i += 2) {
    cost +=
        f.in.symmetric_weight * square(double{raw[fit.symmetric[i]]} - raw[fit.symmetric[i + 1]]);
  }
  if (gradient) {
    add_symmetric_gradient(f, raw, gradient);
    add_sparse_gradient(f, raw, gradient);
  }
  return cost;
}

Limits limits_of(const Frame& f, size_t place) {
  const MienFit& fit = f.fit;
  const uint32_t c = fit.controls[place];
  const double value = fit.raw[c], kink = fit.initial[c];
  Limits limits = {fit.lower[place], fit.upper[place]};
  if (!(f.in.sparse_weight > 0)) return limits;
  const double pull = fit.gradient[place];
  const bool rests = value == kink && !is_rotation(fit, place);
  if (value > kink || (rests && pull <= 0)) limits.low = std::max(limits.low, kink);
  if (value < kink || (rests && pull >= 0)) limits.high = std::min(limits.high, kink);
  return limits;
}

void follow_points(Frame& f, uint32_t rounds) {
  MienFit& fit = f.fit;
  const KindTargets& to = fit.kinds[kPoints];
  if (f.in.rigid && f.in.points && !f.in.images && !f.in.surface) {
    fit_rigid(fit.surface.data, to.targets.data, to.weights.data, fit.points.count,
              f.motion.rotation, f.motion.translation);
  } else if (f.in.rigid) {
    fit_motion(f, rounds);
  }
  if (f.in.surface && !(f.in.rigid && f.moves(kSurface))) match_surface(f);
}

Cost find_cost(Frame& f) {
  MienFit& fit = f.fit;
  evaluate(fit);
  Cost cost;
  if (f.in.joints) add_joint_cost(f, cost);
  if (f.has_points() || f.in.constraints) {
    find_points(f);
    std::fill(fit.position_gradient.begin(), fit.position_gradient.end(), 0.0f);
  }
  if (f.has_points()) follow_points(f, kMotionRounds);
  for (const Kind kind : kAllKinds) {
    if (f.has(kind)) add_kind_cost(f, kind, cost);
  }
  if (f.in.constraints) add_constraint_cost(f, cost);
  cost.total = cost.joints.squares;
  for (const Sum& sum : cost.points) cost.total += sum.squares;
  cost.total += cost.constraints.squares;
  return cost;
}

void linearize_points(MienFit& fit) {
  if (fit.meshes.empty()) {
    static_cast<void>(mien_derivatives_linearize(fit.derivatives, fit.instance, MIEN_STAGE_ALL));
  }
  for (const FitMesh& mesh : fit.meshes) {
    static_cast<void>(mien_derivatives_linearize(mesh.derivatives, fit.instance, MIEN_STAGE_ALL));
  }
}

void find_gradient(Frame& f) {
  MienFit& fit = f.fit;
  std::fill(fit.gradient.begin(), fit.gradient.end(), 0.0);
  const auto add = [&](MienDerivatives* derivatives, uint32_t from, uint32_t mesh,
                       const float* gradient, const Span<float>& out) {
    static_cast<void>(
        mien_derivatives_reverse(derivatives, MIEN_POINT_RAW, from, mesh, 1, gradient, out.data));
    for (size_t i = 0; i < fit.controls.count; ++i) fit.gradient[i] += out[fit.controls[i]];
  };
  static_cast<void>(
      mien_derivatives_linearize(fit.control_derivatives, fit.instance, MIEN_STAGE_ALL));
  if (f.in.joints) {
    add(fit.control_derivatives, MIEN_POINT_JOINTS, 0, fit.joint_gradient.data, fit.from_joints);
  }
  if (f.has_points() || f.in.constraints) {
    linearize_points(fit);
    for (const FitMesh& mesh : fit.meshes) {
      add(mesh.derivatives, MIEN_POINT_POSITIONS, mesh.mesh,
          fit.position_gradient.data + 3 * mesh.first, fit.from_positions);
    }
  }
  if (has_joint_constraints(f)) {
    add(fit.derivatives, MIEN_POINT_MODELS, 0, fit.model_gradient.data, fit.from_positions);
  }
  regularize(f, fit.raw.data, fit.gradient.data);
  hold_gradient(fit);
}

double point_factor(const MienFit& fit) {
  double factor = 0;
  for (size_t i = 0; i < fit.points.count; ++i) factor += fit.kinds[kPoints].pulls[i];
  return factor / static_cast<double>(fit.points.count);
}

void add_regularization(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
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

}  // namespace mien
