// SPDX-License-Identifier: MIT
// Motions whose only targets are joint values that are sums over the controls (mien_fit_solve_frames()). The model of
// model.cpp is the cost then, and from frame to frame only the targets change it:
//
//     changes of the targets, a block of frames at a time -> pulls of the controls that count
//     pull of the frame before + what its step has left + that -> steps, with the matrix of earlier frames while it
//     serves -> one evaluation of joints, which has to confirm the cost
//
// Controls that count are the raw ones that may move, and those that move with one of them at the pose at hand.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

namespace mien {
namespace {

constexpr uint32_t kRounds = 12;
constexpr double kSlowGain = 0.05;  // of the gain before: the matrix at hand no longer serves
constexpr double kNoSolution = -1;

/// Joint values against their targets, in few sums that can be added side by side, of one order.
struct JointSums {
  double squares = 0;
  float worst = 0, largest = 0;  // difference that counts, target
};
JointSums compare_joints(const MienFit& fit, const float* targets) {
  constexpr size_t kLanes = 8;
  double sums[kLanes] = {};
  float worst[kLanes] = {}, largest[kLanes] = {};
  const float* const joints = fit.joints.data;
  const float* const weights = fit.joint_weights.data;
  const auto add = [&](size_t i, size_t lane) {
    const float apart = joints[i] - targets[i];
    const float size = weights[i] > 0 ? std::fabs(apart) : 0.0f;
    const float target = std::fabs(targets[i]);
    sums[lane] += double{weights[i]} * (double{apart} * double{apart});
    worst[lane] = size > worst[lane] ? size : worst[lane];
    largest[lane] = target > largest[lane] ? target : largest[lane];
  };
  size_t i = 0;
  for (; i + kLanes <= fit.joint_count; i += kLanes) {
    for (size_t k = 0; k < kLanes; ++k) add(i + k, k);
  }
  for (; i < fit.joint_count; ++i) add(i, 0);
  JointSums all;
  for (size_t k = 0; k < kLanes; ++k) {
    all.squares += sums[k];
    all.worst = std::max(all.worst, worst[k]);
    all.largest = std::max(all.largest, largest[k]);
  }
  return all;
}

/// What the changes of targets from frame to frame do to the pull of a control.
void multiply_targets(MienFit& fit, uint32_t control) {
  float sums[kBlockFrames] = {};
  const float* const targets = fit.block_targets.data;
  const uint32_t end = fit.joint_first[control + 1];
  for (uint32_t i = fit.joint_first[control]; i < end; ++i) {
    const float* const from = targets + size_t{fit.joint_rows[i]} * kBlockFrames;
    const float effect = fit.joint_effects[i];
    for (size_t k = 0; k < kBlockFrames; ++k) sums[k] += effect * from[k];
  }
  std::copy(sums, sums + kBlockFrames, fit.block_pulls.data + size_t{control} * kBlockFrames);
}

/// The pull of a control where the model was made, whose joint values are still those of the instance.
double find_pull(const Frame& f, uint32_t control) {
  const MienFit& fit = f.fit;
  double sum = 0;
  for (uint32_t i = fit.joint_first[control]; i < fit.joint_first[control + 1]; ++i) {
    const uint32_t j = fit.joint_rows[i];
    sum += double{fit.joint_weights[j]} * fit.joint_effects[i] *
           (double{fit.joints[j]} - f.in.joints[j]);
  }
  return f.joint_factor() * sum;
}

/// Whether a control may move with a raw one: a product of which two factors are 0 does not.
bool may_move(const MienFit& fit, uint32_t control) {
  uint32_t zeros = 0;
  const uint32_t end = fit.depends_first[control + 1];
  for (uint32_t i = fit.depends_first[control]; i < end; ++i) {
    zeros += !fit.above_zero[fit.depends_on[i]];
  }
  return zeros <= 1;
}

template <class F>
void add_counting(MienFit& fit, F&& added) {
  for (uint32_t c = static_cast<uint32_t>(fit.raw_count); c < fit.control_count; ++c) {
    if (fit.counts[c] || !may_move(fit, c)) continue;
    fit.counts[c] = 1;
    fit.counting[fit.counting.count++] = c;
    added(c);
  }
}

/// Notes which raw controls are above 0; whether these are others than before.
bool note_zeros(MienFit& fit) {
  uint8_t changed = 0;
  for (size_t c = 0; c < fit.raw_count; ++c) {
    const uint8_t above = fit.raw[c] > 0;
    changed |= above ^ fit.above_zero[c];
    fit.above_zero[c] = above;
  }
  return changed != 0;
}

/// The controls that count at the pose at hand, anew.
void list_counting(MienFit& fit) {
  fit.counting.count = 0;
  std::fill(fit.counts.begin(), fit.counts.end(), uint8_t{0});
  note_zeros(fit);
  for (const uint32_t c : fit.controls) {
    fit.counts[c] = 1;
    fit.counting[fit.counting.count++] = c;
  }
  add_counting(fit, [](uint32_t) {});
}

/// Adds those that count at the pose at hand, with their pulls.
void extend_counting(const Frame& f) {
  MienFit& fit = f.fit;
  if (!note_zeros(fit)) return;
  add_counting(fit, [&](uint32_t c) {
    multiply_targets(fit, c);
    fit.pull[c] = find_pull(f, c);
  });
}

/// find_change() for the controls that count.
double find_counting_change(Frame& f) {
  MienFit& fit = f.fit;
  const size_t count = fit.counting.count;
  const uint32_t* const counting = fit.counting.data;
  size_t changed = 0;
  for (size_t i = 0; i < count; ++i) {
    const uint32_t c = counting[i];
    fit.change[c] = double{fit.all_controls[c]} - fit.model_controls[c];
    if (fit.change[c] != 0) fit.changed[changed++] = c;
  }
  double* const sums = fit.projected.data;
  std::fill(sums, sums + count, 0.0);
  for (size_t n = 0; n < changed; ++n) {
    const double value = fit.change[fit.changed[n]];
    const double* const row = fit.joint_metric.data + size_t{fit.changed[n]} * fit.control_count;
    for (size_t i = 0; i < count; ++i) sums[i] += value * row[counting[i]];
  }
  for (size_t i = 0; i < count; ++i) fit.response[counting[i]] = f.joint_factor() * sums[i];
  double value = 0;
  for (size_t n = 0; n < changed; ++n) {
    const uint32_t c = fit.changed[n];
    value += (2 * fit.pull[c] + fit.response[c]) * fit.change[c];
  }
  return value;
}

void find_counting_gradient(Frame& f) {
  MienFit& fit = f.fit;
  linearize_controls(fit);
  std::fill(fit.metric_row.begin(), fit.metric_row.end(), 0.0f);
  for (const uint32_t c : fit.counting) {
    fit.metric_row[c] = static_cast<float>(fit.pull[c] + fit.response[c]);
  }
  take_model_gradient(f, kFirstDamping);
}

double held_back(const MienFit& fit) {
  double sum = 0;
  for (size_t i = 0; i < fit.controls.count; ++i) {
    const uint32_t c = fit.controls[i];
    sum += fit.stiffness[i] * square(double{fit.raw[c]} - fit.best[c]);
  }
  return kFirstDamping * sum;
}

/// A step of the free controls by the factor at hand; false if it would leave the bounds.
bool find_free_step(Frame& f, size_t free_count) {
  MienFit& fit = f.fit;
  for (size_t a = 0; a < free_count; ++a) fit.work[a] = -fit.gradient[fit.free[a]];
  solve_factored(fit.factor.data, free_count, fit.work.data);
  for (size_t a = 0; a < free_count; ++a) {
    const uint32_t i = fit.free[a];
    const Limits limits = limits_of(f, i);
    const double to = fit.raw[fit.controls[i]] + fit.work[a];
    if (!(to >= limits.low && to <= limits.high)) return false;
    fit.step[a] = fit.work[a];
  }
  return true;
}

}  // namespace

/// MienFit::matrix = the part of the kept one for the free controls. False if some of them have none.
bool JointFrames::take_matrix(size_t free_count) {
  uint32_t* const places = fit.support.data;  // in the kept one
  size_t at = 0;
  for (size_t a = 0; a < free_count; ++a) {
    while (at < matrix_count && fit.matrix_free[at] < fit.free[a]) ++at;
    if (at == matrix_count || fit.matrix_free[at] != fit.free[a]) return false;
    places[a] = static_cast<uint32_t>(at);
  }
  for (size_t a = 0; a < free_count; ++a) {
    const double* const from = fit.kept_matrix.data + places[a] * matrix_count;
    for (size_t b = 0; b < free_count; ++b) fit.matrix[a * free_count + b] = from[places[b]];
  }
  return true;
}

void JointFrames::make_matrix(Frame& f, size_t free_count) {
  set_model_matrix(f, free_count, kFirstDamping);
  std::copy(fit.matrix.data, fit.matrix.data + free_count * free_count, fit.kept_matrix.data);
  std::copy(fit.free.data, fit.free.data + free_count, fit.matrix_free.data);
  matrix_count = free_count;
}

void JointFrames::factor(size_t free_count) {
  factor_damped(fit.matrix.data, free_count, kOwnDamping, fit.factor.data);
  std::copy(fit.free.data, fit.free.data + free_count, fit.factor_free.data);
  factor_count = free_count;
}

/// A step from the controls of the instance that lowers the model, whose change so far is `value`. False if there is
/// none.
bool JointFrames::step(Frame& f, size_t free_count, double terms, double& value) {
  const bool same = free_count == factor_count && matrix_count != 0 &&
                    std::equal(fit.free.data, fit.free.data + free_count, fit.factor_free.data);
  bool fresh = !take_matrix(free_count);
  if (fresh) make_matrix(f, free_count);
  if (fresh || !same) factor(free_count);
  std::copy(fit.raw.begin(), fit.raw.end(), fit.kept.begin());
  for (;;) {
    if (!find_free_step(f, free_count)) {
      factor_count = 0;  // it will be that of fewer controls
      find_bounded_step(f, free_count, kOwnDamping);
    }
    move_free(fit, free_count);
    evaluate_controls(fit);
    extend_counting(f);
    const double next =
        find_counting_change(f) + regularize(f, fit.raw.data, nullptr) - terms + held_back(fit);
    if (next < value) {
      value = next;
      return true;
    }
    std::copy(fit.kept.begin(), fit.kept.end(), fit.raw.begin());
    evaluate_controls(fit);
    find_counting_change(f);
    if (fresh) return false;
    fresh = true;
    make_matrix(f, free_count);
    factor(free_count);
  }
}

/// Moves controls to where the model is lowest. Returns the predicted cost, or kNoSolution.
double JointFrames::minimize(Frame& f, double first, double rounding) {
  double value = 0, gain = HUGE_VAL;
  const double terms = regularize(f, fit.best.data, nullptr);
  for (uint32_t round = 0; round < kRounds; ++round) {
    find_counting_gradient(f);
    const double enough = std::max(
        {kEnoughDecrease * std::max(first + value, 0.0), kEnoughOfFirst * first, rounding});
    Gains left;
    size_t free_count = list_model_free(f, true, left);
    // Controls at a bound may leave it once the others gain no more.
    if (left.held > enough && left.all - left.held <= enough) {
      left = {};
      free_count = list_model_free(f, false, left);
    }
    if (free_count == 0 || (gain <= enough && left.held <= enough) ||
        (round != 0 && left.all <= kLittle * enough)) {
      return first + value - held_back(fit);
    }
    const double before = value, gain_before = gain;
    if (!step(f, free_count, terms, value)) {
      // As low as rounding lets it be, or a model that takes damping.
      return left.all <= enough ? first + value - held_back(fit) : kNoSolution;
    }
    gain = before - value;
    if (gain > kSlowGain * gain_before) matrix_count = 0;
  }
  return kNoSolution;
}

bool JointFrames::begin_block(const MienFitFrame& in, size_t count) {
  if (!fit.joint_block || !in.joints) return false;
  if (in.points || in.images || in.surface || in.constraints) return false;
  for (size_t j = 0; j < fit.joint_count; ++j) {
    float* const to = fit.block_targets.data + j * kBlockFrames;
    const float* const from = in.joints + j;
    float before = from[0], any = 0;
    for (size_t k = 0; k < kBlockFrames; ++k) {
      const float now = k < count ? from[k * fit.joint_count] : before;
      any += now - now;  // NaN if one is not finite
      to[k] = fit.joint_weights[j] * (before - now);
      before = now;
    }
    if (any != 0) return false;
  }
  weight = 0;
  for (const float one : fit.joint_weights) weight += double{one};
  follows = false;
  return true;
}

bool JointFrames::solve(Frame& f, size_t lane, MienFitResult& told) {
  const double factor = f.joint_factor();
  std::copy(fit.raw.begin(), fit.raw.end(), fit.best.begin());
  if (!follows) {
    list_counting(fit);
    for (const uint32_t c : fit.counting) multiply_targets(fit, c);
    static_cast<void>(find_cost(f));
    make_model(f);
    find_stiffness(f);
  } else {
    for (const uint32_t c : fit.counting) {
      fit.pull[c] += fit.response[c] + factor * fit.block_pulls[c * kBlockFrames + lane];
    }
    std::copy(fit.all_controls.begin(), fit.all_controls.end(), fit.model_controls.begin());
  }
  follows = false;  // unless it is solved
  for (const uint32_t c : fit.counting) fit.change[c] = fit.response[c] = 0;
  const JointSums start = compare_joints(fit, f.in.joints);
  const double first = factor * start.squares + regularize(f, fit.raw.data, nullptr);
  const double rounding = factor * weight * square(kRounding * double{start.largest});
  const double predicted = minimize(f, first, rounding);
  if (predicted == kNoSolution) return false;
  double moved = 0;
  for (const uint32_t c : fit.counting) moved += fit.change[c] * fit.response[c];
  evaluate(fit);
  const JointSums end = compare_joints(fit, f.in.joints);
  Cost cost;
  cost.joints = {factor * end.squares, factor * weight, square(double{end.worst})};
  cost.total = cost.joints.squares + regularize(f, fit.raw.data, nullptr);
  // Sums of floats have an error.
  const double close = std::max({1e-3 * cost.total, 1e-5 * first, rounding});
  if (!(std::fabs(cost.total - predicted) <= close)) return false;
  std::copy(fit.raw.begin(), fit.raw.end(), fit.best.begin());
  told.status = MIEN_FIT_CONVERGED;
  told.iterations = 1;
  told.jumped = moved > 1.01 * first + 100 * rounding;
  tell_cost(f.in, cost, told);
  follows = true;
  return true;
}

}  // namespace mien
