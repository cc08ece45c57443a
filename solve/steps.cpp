// SPDX-License-Identifier: MIT
// Solves a frame: bounded Gauss-Newton steps with Levenberg-Marquardt damping (docs/solving.md).
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

namespace mien {
namespace {

constexpr uint32_t kDefaultIterations = 50;
constexpr double kSlow = 0.3;            // of what the step before gained
constexpr double kAsModeled = 0.9;       // of the predicted gain: the model serves another step
constexpr double kEnoughOfStage = 1e-3;  // of the cost, before more controls are unlocked
constexpr uint32_t kFirstRounds = 40;    // of motions, at the start

/// Controls that are not held at a bound by the gradient.
size_t list_free(const Frame& f) {
  const MienFit& fit = f.fit;
  size_t count = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    if (f.is_locked(fit.controls[i]) || fit.resting[i]) continue;
    const double value = fit.raw[fit.controls[i]];
    const Limits limits = limits_of(f, i);
    if (value <= limits.low && fit.gradient[i] >= 0) continue;
    if (value >= limits.high && fit.gradient[i] <= 0) continue;
    fit.free[count] = static_cast<uint32_t>(i);
    fit.inputs[count++] = fit.controls[i];
  }
  return count;
}

/// The matrix of a step: D^T G D and the regularization.
void set_matrix(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
  list_free_derivatives(fit, free_count);
  std::fill(fit.matrix.data, fit.matrix.data + free_count * free_count, 0.0);
  if (f.in.joints) project_metric(fit, fit.joint_metric.data, f.joint_factor(), free_count);
  if (f.has_points()) add_point_rows(f, free_count);
  list_constraint_rows(f, MIEN_POINT_RAW);
  for (size_t r = 0; r < f.row_count; ++r) {
    const float* row = fit.constraint_rows.data + r * fit.raw_count;
    for (size_t a = 0; a < free_count; ++a) {
      const double value = fit.row_weights[r] * double{row[fit.inputs[a]]};
      for (size_t b = 0; b < free_count; ++b) {
        fit.matrix[a * free_count + b] += value * double{row[fit.inputs[b]]};
      }
    }
  }
  add_regularization(f, free_count);
  hold_matrix(fit, free_count);
  stiffen_lengths(fit, free_count);
}

/// A step from `best` into the instance; controls that leave their bounds stay at them. Returns how far the
/// farthest control moved.
double take_step(Frame& f, size_t free_count, double damping) {
  MienFit& fit = f.fit;
  find_bounded_step(f, free_count, damping);
  turn_rotations(fit, free_count);
  double farthest = 0;
  for (size_t a = 0; a < free_count; ++a) {
    const uint32_t i = fit.free[a], c = fit.controls[i];
    const double low = fit.lower[i], high = fit.upper[i], from = fit.best[c];
    const double to = std::min(std::max(from + fit.step[a], low), high);
    farthest = std::max(farthest, std::fabs(to - from));
    fit.raw[c] = static_cast<float>(to);
  }
  normalize_rotations(fit);
  return farthest;
}

double largest_target(const Frame& f, Kind kind) {
  const KindTargets& to = f.fit.kinds[kind];
  double largest = 0;
  for (size_t i = 0; i < f.fit.points.count; ++i) {
    if (!(to.weights[i] > 0)) continue;
    for (size_t k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(to.targets[3 * i + k]));
  }
  return largest;
}

double largest_joint(const Frame& f) {
  double largest = 0;
  for (size_t i = 0; f.in.joints && i < f.fit.joint_count; ++i) {
    if (!(f.fit.joint_weights[i] > 0) || !std::isfinite(f.in.joints[i])) continue;
    largest = std::max(largest, std::fabs(double{f.in.joints[i]}));
  }
  return largest;
}

/// The cost that the rounding of floats leaves.
double rounding_of(const Frame& f, const Cost& cost) {
  double sum = 0;
  for (const Kind kind : kAllKinds) {
    if (f.has(kind)) {
      sum += cost.points[kind].weight * square(kRounding * largest_target(f, kind));
    }
  }
  return sum + cost.joints.weight * square(kRounding * largest_joint(f));
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
  f.starting = true;
  if (f.in.points && f.in.surface && !f.in.images) {
    // The nearest places of a surface mean little before points have brought it near.
    const MienFitSurface* const surface = f.in.surface;
    f.in.surface = nullptr;
    fit_motion(f, kFirstRounds);
    f.in.surface = surface;
  }
  follow_points(f, kFirstRounds);
  f.starting = false;
}

struct Solve {
  Frame& f;
  Cost cost;         // at the best controls
  double first = 0;  // the total at the start
  uint32_t iterations = 0;

  void keep() {
    std::copy(f.fit.raw.begin(), f.fit.raw.end(), f.fit.best.begin());
    if (f.in.surface) keep_targets(f.fit);
  }
  /// The total after a step, as it is compared with the total before.
  double compared(const Cost& next) const {
    return f.in.surface ? next.total - next.points[kSurface].squares + next.compared_surface
                        : next.total;
  }
  Cost find_all() {
    Cost found = find_cost(f);
    found.total += regularize(f, f.fit.raw.data, nullptr);
    return found;
  }
  uint32_t run_stage(uint32_t limit, double enough_decrease);
  bool rest();
};

/// The angle between floats of nearly equal rotations is mostly rounding, of which RBF solvers make noise. So rotations
/// that are all but at rest are put there, and the others go on without them. False if that does not lower the cost.
bool Solve::rest() {
  MienFit& fit = f.fit;
  std::copy(fit.best.begin(), fit.best.end(), fit.raw.begin());
  if (!rest_rotations(fit)) return false;
  const Cost next = find_all();
  if (compared(next) < cost.total) {
    cost = next;
    keep();
    return true;
  }
  std::copy(fit.best.begin(), fit.best.end(), fit.raw.begin());
  cost = find_all();
  return false;
}

/// Steps until nothing is gained: MIEN_FIT_...
uint32_t Solve::run_stage(uint32_t limit, double enough_decrease) {
  MienFit& fit = f.fit;
  double damping = kFirstDamping, before = 0;
  double missed = 0;  // of the gains of steps before, the part that models did not predict
  uint32_t slow = 0;  // steps in a row that gained little less than the one before
  bool fresh = true;  // no step was taken since effects on points were measured
  std::fill(fit.measured.begin(), fit.measured.end(), uint8_t{0});
  // Effects of controls on points change with the pose: where steps gain little, they are measured at it.
  const auto measure_again = [&](bool damped = false) {
    if (!f.has_points() || (f.exact && slow == 0 && !damped)) return false;
    f.exact = fresh = true;
    slow = 0;
    before = 0;
    damping = kFirstDamping;
    std::fill(fit.measured.begin(), fit.measured.end(), uint8_t{0});
    return true;
  };
  const double rounding = rounding_of(f, cost);
  // Gains that are not worth a step, or that rounding alone may give.
  const auto enough_of = [&](double total) {
    return std::max({enough_decrease * total, kEnoughOfFirst * first, rounding});
  };
  for (uint32_t done = 0; done < limit; ++done, ++iterations) {
    if (f.in.canceled && f.in.canceled(f.in.user)) return MIEN_FIT_CANCELED;
    if (iterations != 0 && f.is_late()) return MIEN_FIT_TIME;
    const bool by_model = !f.has_rows();
    size_t free_count = 0;
    if (by_model) {
      make_model(f);
    } else {
      // What a rotation does changes with its pose, and on the other side of the pose of an RBF solver.
      if (fit.rotations.count != 0) std::fill(fit.measured.begin(), fit.measured.end(), uint8_t{0});
      find_gradient(f);
      free_count = list_free(f);
      if (free_count == 0) return MIEN_FIT_CONVERGED;
      set_matrix(f, free_count);
    }
    const Motion motion = f.motion;
    for (;;) {
      ModelStep step = {0, 0, false};
      if (by_model) {
        step = minimize_model(f, cost.total, first, rounding, damping);
        if (step.farthest == 0) {
          cost = find_all();
          return MIEN_FIT_CONVERGED;
        }
      } else {
        step.farthest = take_step(f, free_count, damping);
      }
      const Cost next = find_all();
      const double reached = compared(next);
      if (reached < cost.total) {
        const double decrease = cost.total - reached, enough = enough_of(cost.total);
        const bool as_modeled = by_model && decrease > kAsModeled * (cost.total - step.predicted);
        slow = decrease > kSlow * before && before > 0 ? slow + 1 : 0;
        before = decrease;
        // A step that is short because effects are those of an earlier pose is not the last one.
        const bool damped = damping > kFirstDamping && !fresh;
        fresh = false;
        cost = next;
        keep();
        // A model that was off before may predict a cost by chance, even twice. By how much it was off is by how much its
        // gradient may be now, and the square of that is what the cost may still lose.
        const double error = std::fabs(cost.total - step.predicted);
        const bool as_predicted =
            step.solved && damping <= kFirstDamping &&
            std::max(error, square(missed) * decrease) <= enough_of(cost.total);
        missed = std::max(error / decrease, 0.5 * missed);
        damping = std::max(damping * 0.2, 1e-7);
        if (as_predicted || cost.total <= rounding) {
          ++iterations;
          return MIEN_FIT_CONVERGED;
        }
        const bool ended = decrease <= enough || step.farthest < kEnoughStep;
        if (ended && ((slow == 0 && !damped) || !measure_again(damped))) {
          ++iterations;
          return MIEN_FIT_CONVERGED;
        }
        if (slow >= 2 || (!f.learns && step.solved && !as_modeled)) measure_again();
        break;
      }
      std::copy(fit.best.begin(), fit.best.end(), fit.raw.begin());
      f.motion = motion;
      // A full step that loses next to nothing: the best controls are the minimum, up to rounding.
      const bool at_minimum =
          !by_model && damping <= kFirstDamping && reached - cost.total <= enough_of(cost.total);
      if (at_minimum || step.farthest < kEnoughStep || damping > 1e8) {
        cost = find_all();  // of the best controls
        if ((!f.exact || !fresh) && damping > kFirstDamping && measure_again(!fresh)) break;
        return MIEN_FIT_CONVERGED;
      }
      if (f.is_late()) {
        cost = find_all();
        return MIEN_FIT_TIME;
      }
      damping *= 10;
    }
  }
  return MIEN_FIT_ITERATIONS;
}

/// What `start` and the targets say of how far things may move (MienFitResult.jumped).
struct Moves {
  double asked_joints = 0, asked_points = 0;
};

Moves start_moves(Frame& f) {
  MienFit& fit = f.fit;
  Moves moves;
  if (f.in.joints) {
    std::copy(fit.joints.begin(), fit.joints.end(), fit.start_joints.begin());
    for (size_t i = 0; i < fit.joint_count; ++i) {
      if (!std::isfinite(f.in.joints[i])) continue;
      moves.asked_joints +=
          double{fit.joint_weights[i]} * square(double{fit.joints[i]} - f.in.joints[i]);
    }
  }
  if (!f.has_points()) return moves;
  std::copy(fit.surface.begin(), fit.surface.end(), fit.start_surface.begin());
  for (const Kind kind : kAllKinds) {
    for (size_t i = 0; f.has(kind) && i < fit.points.count; ++i) {
      const double pull = fit.kinds[kind].pulls[i];
      double gradient[3];
      if (pull > 0) moves.asked_points += pull * point_residual(f, kind, i, gradient);
    }
  }
  return moves;
}

bool has_target(const MienFit& fit, size_t point) {
  return std::any_of(fit.kinds, fit.kinds + kKinds,
                     [&](const KindTargets& to) { return to.weights[point] > 0; });
}

bool has_jumped(const Frame& f, const Moves& moves) {
  const MienFit& fit = f.fit;
  constexpr double kSlack = 1.01;  // of the sums: what rounding and curvature add
  double joints = 0, points = 0, room_for_joints = 0, point_noise = 0;
  for (size_t i = 0; f.in.joints && i < fit.joint_count; ++i) {
    joints += double{fit.joint_weights[i]} * square(double{fit.joints[i]} - fit.start_joints[i]);
    room_for_joints += double{fit.joint_weights[i]};
  }
  bool first = true;  // of the kinds that are given
  for (const Kind kind : kAllKinds) {
    if (!f.has(kind)) continue;
    double room = 0;
    for (size_t i = 0; i < fit.points.count; ++i) {
      // A point without a target of any kind counts as much as one that has one, an outlier as little as in the cost.
      double weight = fit.kinds[kind].pulls[i];
      if (!(fit.kinds[kind].weights[i] > 0)) {
        weight = first && !has_target(fit, i) ? f.given_weight(kind, i) : 0;
      }
      double before[3], after[3];
      view_point(f, kind, fit.start_surface.data + 3 * i, before);
      view_point(f, kind, fit.surface.data + 3 * i, after);
      for (size_t k = 0; k < 3; ++k) points += weight * square(after[k] - before[k]);
      room += weight;
    }
    point_noise += room * square(10 * kRounding * largest_target(f, kind));
    first = false;
  }
  const double joint_noise = room_for_joints * square(10 * kRounding * largest_joint(f));
  return joints > kSlack * moves.asked_joints + joint_noise ||
         points > kSlack * moves.asked_points + point_noise;
}

}  // namespace

void solve_frame(Frame& f, MienFitResult& told) {
  MienFit& fit = f.fit;
  Solve solve = {f, {}};
  fit.secant_count = 0;
  // Far from the start, P at the pose of all points tells more; P of a sample tells less than steps.
  f.learns = f.in.start || fit.samples.count != fit.points.count;
  start_motion(f);
  solve.cost = solve.find_all();
  solve.keep();
  const Moves moves = start_moves(f);
  const Cost& cost = solve.cost;
  double weight = cost.joints.weight + cost.constraints.weight;
  for (const Sum& sum : cost.points) weight += sum.weight;
  if (weight > 0) {
    solve.first = cost.total;
    const uint32_t limit = f.in.max_iterations ? f.in.max_iterations : kDefaultIterations;
    uint32_t last = 0, present = f.in.stages && fit.controls.count != 0 ? 0 : 1;
    for (const uint32_t c : fit.controls) {
      if (f.in.stages) present |= 1u << f.in.stages[c];
    }
    while (present >> (last + 1) != 0) ++last;
    for (f.stage = 0; f.stage <= last; ++f.stage) {
      if ((present >> f.stage & 1) == 0) continue;
      // The metric of points is of all of them, at rest.
      f.exact = f.few || (!fit.rotations.empty() && f.has_points());
      std::fill(fit.resting.begin(), fit.resting.end(), uint8_t{0});
      const double enough = f.stage == last ? kEnoughDecrease : kEnoughOfStage;
      const uint32_t end = solve.iterations + limit;
      do {
        told.status = solve.run_stage(end - solve.iterations, enough);
      } while (told.status == MIEN_FIT_CONVERGED && solve.iterations < end && solve.rest());
      if (told.status == MIEN_FIT_CANCELED || told.status == MIEN_FIT_TIME) break;
    }
    told.jumped = has_jumped(f, moves);
  } else {
    told.status = MIEN_FIT_NO_DATA;
  }
  told.iterations = solve.iterations;
  tell_cost(f.in, solve.cost, told);
}

}  // namespace mien
