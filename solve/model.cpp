// SPDX-License-Identifier: MIT
// The cost as a quadratic function of all controls, at the pose at hand:
//
//     cost(c + change) = cost(c) + 2 pull . change + change^T G change
//
// G is the metric at rest, corrected by what the steps of the frame have shown.
//
// Control values as functions of raw controls, with correctives, networks and bounds, are evaluated as they are, which
// takes little time. So one evaluation of joints and points serves several steps. For joint values that are
// sums, the model is the cost.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

namespace mien {
namespace {

constexpr uint32_t kControlStages = MIEN_STAGE_ML | MIEN_STAGE_RBF | MIEN_STAGE_PSD;
constexpr uint32_t kModelRounds = 24;
constexpr uint32_t kBoundRounds = 6;
constexpr double kShareOfBest = 0.01;  // of the best gain that frees a control held at a bound
constexpr double kBeyondModel = 0.02;  // of its gain so far: what a model cannot tell
constexpr double kLeastBend = 0.01;    // of the model's: less, or concave, is that of outliers

/// Calls use(row of all controls, its weight, its change) for what is added to G.
template <class F>
void for_each_row(const Frame& f, F&& use) {
  const MienFit& fit = f.fit;
  const size_t count = fit.control_count;
  for (size_t r = 0; r < fit.secant_count; ++r) {
    use(fit.secant_rows.data + r * count, fit.secant_weights[r], fit.secant_changes.data + r);
  }
  for (size_t r = 0; r < f.row_count; ++r) {
    use(fit.constraint_rows.data + r * count, fit.row_weights[r], fit.row_changes.data + r);
  }
}

/// Whether G is that of any pose.
bool is_exact(const Frame& f) {
  return !f.has_points() && !f.in.constraints && !f.fit.joint_first.empty();
}

}  // namespace

size_t list_model_free(Frame& f, bool inside_only, Gains& gains) {
  MienFit& fit = f.fit;
  const auto gain_of = [&](size_t i) {
    const double value = fit.raw[fit.controls[i]], g = fit.gradient[i];
    const Limits limits = limits_of(f, i);
    const bool held = (value <= limits.low && g >= 0) || (value >= limits.high && g <= 0);
    return held ? 0.0 : g * g / fit.stiffness[i];
  };
  const auto is_inside = [&](size_t i) {
    const double value = fit.raw[fit.controls[i]];
    const Limits limits = limits_of(f, i);
    return value > limits.low && value < limits.high;
  };
  double most = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    if (f.is_locked(fit.controls[i])) continue;
    const double gain = gain_of(i);
    gains.all += gain;
    if (is_inside(i)) continue;
    most = std::max(most, gain);
    gains.held += gain;
  }
  size_t count = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    if (f.is_locked(fit.controls[i])) continue;
    if (!is_inside(i)) {
      const double gain = gain_of(i);
      if (inside_only || !(gain > 0) || gain < kShareOfBest * most) continue;
    }
    fit.free[count] = static_cast<uint32_t>(i);
    fit.inputs[count++] = fit.controls[i];
  }
  return count;
}

void linearize_controls(MienFit& fit) {
  static_cast<void>(
      mien_derivatives_linearize(fit.control_derivatives, fit.instance, kControlStages));
}

void take_model_gradient(Frame& f, double damping) {
  MienFit& fit = f.fit;
  static_cast<void>(mien_derivatives_reverse(fit.control_derivatives, MIEN_POINT_RAW,
                                             MIEN_POINT_CONTROLS, 0, 1, fit.metric_row.data,
                                             fit.from_joints.data));
  for (size_t i = 0; i < fit.controls.count; ++i) {
    const uint32_t c = fit.controls[i];
    fit.gradient[i] = double{fit.from_joints[c]} +
                      damping * fit.stiffness[i] * (double{fit.raw[c]} - fit.best[c]);
  }
  regularize(f, fit.raw.data, fit.gradient.data);
}

namespace {

/// Half of the gradient of the model by the controls that may move.
void find_model_gradient(Frame& f, double damping) {
  MienFit& fit = f.fit;
  linearize_controls(fit);
  for (size_t c = 0; c < fit.control_count; ++c) {
    fit.metric_row[c] = static_cast<float>(fit.pull[c] + fit.response[c]);
  }
  take_model_gradient(f, damping);
}

}  // namespace

void set_model_matrix(Frame& f, size_t free_count, double damping) {
  MienFit& fit = f.fit;
  list_free_derivatives(fit, free_count);
  std::fill(fit.matrix.data, fit.matrix.data + free_count * free_count, 0.0);
  if (f.in.joints) project_metric(fit, fit.joint_metric.data, f.joint_factor(), free_count);
  if (f.has_points()) {
    project_metric(fit, fit.point_metric.data, point_factor(fit), free_count);
  }
  for_each_row(f, [&](const float* row, double weight, const double*) {
    for (size_t a = 0; a < free_count; ++a) {
      fit.work[a] = 0;
      for (uint32_t i = fit.first[a]; i < fit.first[a + 1]; ++i) {
        fit.work[a] += double{row[fit.rows[i]]} * fit.values[i];
      }
      for (size_t b = 0; b <= a; ++b) {
        const double value = weight * fit.work[a] * fit.work[b];
        fit.matrix[a * free_count + b] += value;
        if (a != b) fit.matrix[b * free_count + a] += value;
      }
    }
  });
  add_regularization(f, free_count);
  for (size_t a = 0; a < free_count; ++a) {
    fit.matrix[a * free_count + a] += damping * fit.stiffness[fit.free[a]];
  }
}

void evaluate_controls(MienFit& fit) {
  static_cast<void>(mien_rig_evaluate_stages(fit.rig, fit.instance, fit.lod, kControlStages));
}

double find_change(Frame& f) {
  MienFit& fit = f.fit;
  const size_t count = fit.control_count;
  size_t changed = 0;
  for (size_t c = 0; c < count; ++c) {
    fit.change[c] = double{fit.all_controls[c]} - fit.model_controls[c];
    if (fit.change[c] != 0) fit.changed[changed++] = static_cast<uint32_t>(c);
  }
  std::fill(fit.response.begin(), fit.response.end(), 0.0);
  const auto respond = [&](const Span<double>& metric, double factor) {
    for (size_t i = 0; i < changed; ++i) {
      const double value = factor * fit.change[fit.changed[i]];
      const double* const row = metric.data + size_t{fit.changed[i]} * count;
      for (size_t c = 0; c < count; ++c) fit.response[c] += value * row[c];
    }
  };
  if (f.in.joints) respond(fit.joint_metric, f.joint_factor());
  if (f.has_points()) respond(fit.point_metric, point_factor(fit));
  for_each_row(f, [&](const float* row, double weight, double* row_change) {
    double sum = 0;
    for (size_t i = 0; i < changed; ++i)
      sum += double{row[fit.changed[i]]} * fit.change[fit.changed[i]];
    *row_change = sum;
    for (size_t c = 0; c < count; ++c) fit.response[c] += weight * sum * double{row[c]};
  });
  double value = 0;
  for (size_t i = 0; i < changed; ++i) {
    const uint32_t c = fit.changed[i];
    value += (2 * fit.pull[c] + fit.response[c]) * fit.change[c];
  }
  return value;
}

namespace {

/// The pull changed by y over a change s of controls since the last model, so G s should be y:
/// G += y y^T / (y . s) - r r^T / (r . s), with r = G s (C. G. Broyden, R. Fletcher, D. Goldfarb and D. F. Shanno, 1970).
void learn_from_step(Frame& f) {
  MienFit& fit = f.fit;
  const size_t count = fit.control_count;
  if (fit.secant_count == kMostSecants) fit.secant_count = 0;
  find_change(f);
  // Constraints have rows of their own at each pose.
  double* const y = fit.last_pull.data;
  for (size_t c = 0; c < count; ++c) y[c] = fit.pull[c] - y[c];
  for (size_t r = 0; r < f.row_count; ++r) {
    const float* const row = fit.constraint_rows.data + r * count;
    const double factor = fit.row_weights[r] * fit.row_changes[r];
    for (size_t c = 0; c < count; ++c) {
      y[c] -= factor * double{row[c]};
      fit.response[c] -= factor * double{row[c]};
    }
  }
  double seen = 0, modeled = 0;
  for (size_t c = 0; c < count; ++c) {
    seen += y[c] * fit.change[c];
    modeled += fit.response[c] * fit.change[c];
  }
  if (!(modeled > 0) || !(seen > kLeastBend * modeled)) return;
  const auto add_row = [&](const double* row, double weight) {
    float* const to = fit.secant_rows.data + fit.secant_count * count;
    for (size_t c = 0; c < count; ++c) to[c] = static_cast<float>(row[c]);
    fit.secant_weights[fit.secant_count++] = weight;
  };
  add_row(y, 1 / seen);
  add_row(fit.response.data, -1 / modeled);
}

}  // namespace

void make_model(Frame& f) {
  MienFit& fit = f.fit;
  std::swap(fit.pull, fit.last_pull);
  std::fill(fit.pull.begin(), fit.pull.end(), 0.0);
  const auto add = [&](MienDerivatives* derivatives, uint32_t from, uint32_t mesh,
                       const float* gradient) {
    static_cast<void>(mien_derivatives_reverse(derivatives, MIEN_POINT_CONTROLS, from, mesh, 1,
                                               gradient, fit.metric_row.data));
    for (size_t c = 0; c < fit.control_count; ++c) fit.pull[c] += double{fit.metric_row[c]};
  };
  if (f.in.joints) {
    static_cast<void>(
        mien_derivatives_linearize(fit.control_derivatives, fit.instance, MIEN_STAGE_ALL));
    add(fit.control_derivatives, MIEN_POINT_JOINTS, 0, fit.joint_gradient.data);
  }
  f.row_count = 0;
  if (f.has_points() || f.in.constraints) {
    linearize_points(fit);
    for (const FitMesh& mesh : fit.meshes) {
      add(mesh.derivatives, MIEN_POINT_POSITIONS, mesh.mesh,
          fit.position_gradient.data + 3 * mesh.first);
    }
    if (has_joint_constraints(f)) {
      add(fit.derivatives, MIEN_POINT_MODELS, 0, fit.model_gradient.data);
    }
    list_constraint_rows(f, MIEN_POINT_CONTROLS);
  }
  if (f.modeled && f.learns && !is_exact(f)) learn_from_step(f);
  f.modeled = true;
  std::copy(fit.all_controls.begin(), fit.all_controls.end(), fit.model_controls.begin());
}

void find_bounded_step(Frame& f, size_t free_count, double damping) {
  MienFit& fit = f.fit;
  uint32_t* const moving = fit.support.data;  // places in `free` of those that have not stopped
  size_t count = free_count;
  for (size_t a = 0; a < free_count; ++a) moving[a] = static_cast<uint32_t>(a);
  for (uint32_t round = 0; round < kBoundRounds && count != 0; ++round) {
    for (size_t a = 0; a < count; ++a) {
      const double* const from = fit.matrix.data + moving[a] * free_count;
      for (size_t b = 0; b <= a; ++b) fit.reduced[a * count + b] = from[moving[b]];
    }
    factor_damped(fit.reduced.data, count, damping, fit.factor.data);
    // The right side: the gradient at the steps of those that stopped.
    for (size_t a = 0; a < count; ++a) {
      const double* const from = fit.matrix.data + moving[a] * free_count;
      double right = -fit.gradient[fit.free[moving[a]]];
      size_t next = 0;
      for (size_t b = 0; b < free_count; ++b) {
        if (next < count && moving[next] == b) {
          ++next;
        } else {
          right -= from[b] * fit.step[b];
        }
      }
      fit.work[a] = right;
    }
    solve_factored(fit.factor.data, count, fit.work.data);
    size_t kept = 0;
    for (size_t a = 0; a < count; ++a) {
      const uint32_t i = fit.free[moving[a]];
      const Limits limits = limits_of(f, i);
      const double from = fit.raw[fit.controls[i]], step = fit.work[a];
      const double low = limits.low - from, high = limits.high - from;
      fit.step[moving[a]] = std::min(std::max(step, low), high);
      if (step < low || step > high) continue;
      moving[kept++] = moving[a];
    }
    if (kept == count) return;
    count = kept;
  }
}

void find_stiffness(const Frame& f) {
  MienFit& fit = f.fit;
  const double points = f.has_points() ? point_factor(fit) : 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    fit.stiffness[i] = 1e-12 + double{f.in.prior_weight} + f.in.smooth_weight +
                       (f.in.joints ? f.joint_factor() * fit.joint_stiffness[i] : 0) +
                       (f.has_points() ? points * fit.point_stiffness[i] : 0);
  }
}

void move_free(MienFit& fit, size_t free_count) {
  for (size_t a = 0; a < free_count; ++a) {
    const uint32_t i = fit.free[a], c = fit.controls[i];
    const double to = double{fit.kept[c]} + fit.step[a];
    // A control that all but reaches a bound is held there in the next round.
    fit.raw[c] = to - fit.lower[i] < kEnoughStep   ? fit.lower[i]
                 : fit.upper[i] - to < kEnoughStep ? fit.upper[i]
                                                   : static_cast<float>(to);
  }
}

ModelStep minimize_model(Frame& f, double cost, double first, double rounding, double damping) {
  MienFit& fit = f.fit;
  std::copy(fit.best.begin(), fit.best.end(), fit.raw.begin());
  evaluate_controls(fit);
  double value = find_change(f);
  find_stiffness(f);
  const double terms = regularize(f, fit.best.data, nullptr);
  const auto held_back = [&] {
    double sum = 0;
    for (size_t i = 0; i < fit.controls.count; ++i) {
      const uint32_t c = fit.controls[i];
      sum += fit.stiffness[i] * square(double{fit.raw[c]} - fit.best[c]);
    }
    return damping * sum;
  };
  const auto enough = [&] {
    return std::max(
        {kEnoughDecrease * std::max(cost + value, 0.0), kEnoughOfFirst * first, rounding});
  };
  // The first frame of a motion is far: there, all controls that may explain it compete from the first step on.
  const bool follows = f.in.start && !is_exact(f);
  double gain = HUGE_VAL;
  bool solved = false;
  for (uint32_t round = 0; round < kModelRounds && !solved; ++round) {
    find_model_gradient(f, damping);
    Gains left;
    // The first step keeps to the controls that moved in the frame before.
    size_t free_count = list_model_free(f, round == 0, left);
    if (free_count == 0 && round == 0) {
      left = {};
      free_count = list_model_free(f, false, left);
    }
    solved = free_count == 0 || (gain <= enough() && left.held <= enough()) ||
             (round != 0 && left.all <= kLittle * enough());
    if (solved || (round != 0 && follows && left.all <= kBeyondModel * -value)) break;
    set_model_matrix(f, free_count, damping);
    std::copy(fit.raw.begin(), fit.raw.end(), fit.kept.begin());
    gain = 0;
    double own = kOwnDamping;
    for (int tries = 0; tries < 6; ++tries, own = std::max(own * 100, 1e-6)) {
      find_bounded_step(f, free_count, own);
      move_free(fit, free_count);
      evaluate_controls(fit);
      const double next =
          find_change(f) + regularize(f, fit.raw.data, nullptr) - terms + held_back();
      if (next < value) {
        gain = value - next;
        value = next;
        break;
      }
      std::copy(fit.kept.begin(), fit.kept.end(), fit.raw.begin());
    }
    if (gain > 0) continue;
    evaluate_controls(fit);
    find_change(f);
    solved = round != 0;  // as low as rounding lets it be
  }
  ModelStep step = {0, cost + value - held_back(), solved};
  for (const uint32_t c : fit.controls) {
    step.farthest = std::max(step.farthest, std::fabs(double{fit.raw[c]} - fit.best[c]));
  }
  return step;
}

}  // namespace mien
