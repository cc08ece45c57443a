// SPDX-License-Identifier: MIT
// Derivatives of RBF solvers (docs/derivatives.md, 4). The weights are computed again, in double precision,
// with their derivatives by the controls that the solver reads.
#include <cmath>

#include "runtime/derive/derive_stages.h"
#include "runtime/derive/dual.h"

namespace mien {
namespace {

using Part = Dual<4>;

/// Numbers that a solver compares: those of its controls, or of the parts of rotations.
uint32_t compared_count(const RbfSolverPlan& plan) { return plan.input_count; }

/// The numbers of a rotation a b c w, with a the axis of the twist, that a solver compares: b c w of the
/// swing, or a w. Returns their number.
uint32_t split(const double* q, bool swing, Part* parts) {
  const Part a = Part::variable(q[0], 0), b = Part::variable(q[1], 1);
  const Part c = Part::variable(q[2], 2), w = Part::variable(q[3], 3);
  const Part length = square_root(a * a + w * w);
  if (swing) {
    const Part n = -1.0 * length;
    parts[0] = (w * b - a * c) / n;
    parts[1] = (w * c + a * b) / n;
    parts[2] = n;
    return 3;
  }
  parts[0] = a / length;
  parts[1] = w / length;
  return 2;
}

/// The scratch of a solver: arrays of doubles.
struct RbfScratch {
  double* compared;     // [number]
  double* parts;        // [number][4]: by the controls of its rotation
  double* by_compared;  // [pose][number]: of weights, then of results
  double* weights;      // [pose]
  double* mixed;        // [pose][number]
  double* sums;         // [number]
};

/// The weight of a distance and its derivative. A weight of 0 has the slope 0.
double weight_of(const RbfSolverPlan& plan, double distance, double& slope) {
  const double x = distance * plan.scale;
  if (plan.function < 2) {
    double exponent = x;
    const bool limited = plan.scale > 0 && x > 60;
    if (limited) exponent = 60;
    const double weight = exponent < -126 ? 0 : std::exp2(exponent);
    slope = limited ? 0 : weight * plan.scale * 0.6931471805599453;
    return weight;
  }
  const int n = plan.function;  // 2, 3, 4: powers 1, 3, 5
  const int power = n == 2 ? 1 : n == 3 ? 3 : 5;
  double before = 1;
  for (int i = 1; i < power; ++i) before *= x;
  const double weight = 1 - before * x;
  slope = weight > 0 ? -power * before * plan.scale : 0;
  return weight > 0 ? std::min(weight, 1.152921505e18) : 0;
}

/// Weight of each pose, and its derivatives by the compared numbers.
void weigh(const RbfTable& rbf, const RbfSolverPlan& plan, const RbfScratch& s) {
  const uint32_t count = compared_count(plan);
  const size_t stride = align_up(plan.pose_count, kBlockLanes);
  const uint32_t each = plan.angle_inputs;
  const uint32_t used = each ? count / each * each : count;
  for (uint32_t t = 0; t < plan.pose_count; ++t) {
    const float* target = rbf.targets.data + plan.first_target + t;
    double* slopes = s.by_compared + size_t{t} * count;
    std::fill(slopes, slopes + count, 0.0);
    double squared = 0;
    if (each == 0) {
      for (uint32_t i = 0; i < used; ++i) {
        const double difference = s.compared[i] - target[i * stride];
        squared += difference * difference;
        slopes[i] = difference;
      }
    } else {
      for (uint32_t r = 0; r < used; r += each) {
        double dot = 0;
        for (uint32_t k = 0; k < each; ++k) dot += s.compared[r + k] * target[(r + k) * stride];
        const double near = std::min(1.0, std::fabs(dot));
        const double angle = 2 * std::acos(near), rest = 1 - dot * dot;
        squared += angle * angle;
        const double by_dot = rest > 0 ? (dot < 0 ? 2 : -2) / std::sqrt(rest) : 0;
        for (uint32_t k = 0; k < each; ++k) {
          slopes[r + k] = angle * by_dot * target[(r + k) * stride];
        }
      }
    }
    // At the pose itself the distance has no derivative: it counts as 0.
    const double distance = used == 0 ? target[0] : std::sqrt(squared);
    double slope = 0;
    double weight = weight_of(plan, distance, slope);
    if (!(weight == weight)) weight = slope = 0;
    s.weights[t] = weight;
    const double factor = distance > 0 && used != 0 ? slope / distance : 0;
    for (uint32_t i = 0; i < count; ++i) {
      slopes[i] *= factor;
      if (!(std::fabs(slopes[i]) <= kLargestFloat)) slopes[i] = 0;
    }
  }
}

/// The inverse times the weights, clamped.
void interpolate(const RbfTable& rbf, const RbfSolverPlan& plan, const RbfScratch& s) {
  const uint32_t count = compared_count(plan), poses = plan.pose_count;
  for (uint32_t t = 0; t < poses; ++t) {
    const float* column = rbf.inverses.data + plan.first_inverse +
                          size_t{t / kBlockLanes} * poses * kBlockLanes + t % kBlockLanes;
    double* mixed = s.mixed + size_t{t} * (count + 1);
    std::fill(mixed, mixed + count + 1, 0.0);
    for (uint32_t p = 0; p < poses; ++p, column += kBlockLanes) {
      const double entry = *column;
      mixed[count] += entry * s.weights[p];
      for (uint32_t i = 0; i < count; ++i) mixed[i] += entry * s.by_compared[size_t{p} * count + i];
    }
  }
  for (uint32_t t = 0; t < poses; ++t) {
    const double* mixed = s.mixed + size_t{t} * (count + 1);
    const double value = mixed[count];
    const bool moving = value >= 0 && value <= 1;
    s.weights[t] = value > 0 ? std::min(value, 1.0) : 0;
    for (uint32_t i = 0; i < count; ++i)
      s.by_compared[size_t{t} * count + i] = moving ? mixed[i] : 0;
  }
}

/// Results of the poses. A weight below the threshold has the result 0, but the derivative that it would have
/// without a threshold, so that a solver sees where to go. Negative scales never reach a threshold of 0.
void normalize(const RbfTable& rbf, const RbfSolverPlan& plan, const RbfScratch& s) {
  const uint32_t count = compared_count(plan);
  double sum = 0;
  std::fill(s.sums, s.sums + count, 0.0);
  for (uint32_t t = 0; t < plan.pose_count; ++t) {
    sum += s.weights[t];
    for (uint32_t i = 0; i < count; ++i) s.sums[i] += s.by_compared[size_t{t} * count + i];
  }
  const bool divides = sum > 1 || (plan.always_normalize && sum > 0);
  const double scale = divides ? (1 / sum < 3.4e38 ? 1 / sum : 0) : 1;
  for (uint32_t t = 0; t < plan.pose_count; ++t) {
    const double pose_scale = rbf.pose_scales[plan.first_lane + t];
    const double factor = pose_scale * rbf.pose_factors[plan.first_lane + t];
    const double weight = s.weights[t] * scale;
    for (uint32_t i = 0; i < count; ++i) {
      double& slope = s.by_compared[size_t{t} * count + i];
      slope *= scale;
      if (divides) slope -= weight * scale * s.sums[i];
      slope *= pose_scale > 0 || plan.threshold < 0 ? factor : 0;
    }
    s.weights[t] = weight * pose_scale > plan.threshold ? weight * factor : 0;
  }
}

void linearize_solver(Derivatives& d, uint32_t index) {
  const RbfTable& rbf = d.rig->rbf;
  const RbfSolverPlan& plan = rbf.plans[index];
  const uint32_t inputs = rbf_input_count(plan), count = compared_count(plan);
  RbfScratch s;
  s.compared = d.rbf_scratch.data;
  s.parts = s.compared + count;
  s.by_compared = s.parts + size_t{count} * 4;
  s.weights = s.by_compared + size_t{plan.pose_count} * count;
  s.mixed = s.weights + plan.pose_count;
  s.sums = s.mixed + size_t{plan.pose_count} * (count + 1);

  // Outputs are cleared first, then inputs are read.
  const RbfSolver& solver = rbf.solvers[index];
  const auto each_output = [&](auto&& f) {
    for (uint16_t pose : rbf.poses.slice(solver.first_pose, plan.pose_count)) {
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        f(rbf.pose_outputs[o]);
      }
    }
  };
  each_output([&](uint16_t control) {
    d.values[control] = 0.0f;
    d.moving[control] = 1;
  });
  const uint32_t each = plan.angle_inputs;
  const bool split_up = takes_parts(plan);
  for (uint32_t i = 0; i < count; ++i) {
    if (!split_up) s.compared[i] = d.values[rbf_input_control(rbf, plan, i)];
  }
  for (uint32_t r = 0; split_up && r < count / each; ++r) {
    double q[4];
    for (uint32_t k = 0; k < 4; ++k) q[k] = d.values[rbf_input_control(rbf, plan, 4 * r + k)];
    Part parts[3];
    split(q, each == 3, parts);
    for (uint32_t k = 0; k < each; ++k) {
      s.compared[r * each + k] = parts[k].value;
      std::copy(parts[k].by, parts[k].by + 4, s.parts + size_t{r * each + k} * 4);
    }
  }
  weigh(rbf, plan, s);
  if (plan.interpolative) interpolate(rbf, plan, s);
  normalize(rbf, plan, s);

  float* slopes = d.rbf_slopes.data + d.rbf_first[index];
  for (uint32_t t = 0; t < plan.pose_count; ++t, slopes += inputs) {
    const double* by = s.by_compared + size_t{t} * count;
    for (uint32_t i = 0; i < inputs; ++i) {
      double slope = 0;
      if (!split_up) {
        slope = by[i];
      } else {
        for (uint32_t k = i / 4 * each; k < (i / 4 + 1) * each; ++k) {
          slope += by[k] * s.parts[size_t{k} * 4 + i % 4];
        }
      }
      slopes[i] = std::fabs(slope) <= kLargestFloat ? static_cast<float>(slope) : 0.0f;
    }
  }
  // The pose controls, of which later poses and solvers read.
  for (uint32_t t = 0; t < plan.pose_count; ++t) {
    const auto result = static_cast<float>(s.weights[t]);
    d.rbf_factors[plan.first_lane + t] = result;
    if (plan.first_control != kNoFirstControl) {
      d.values[plan.first_control + t] = result;
      continue;
    }
    const uint32_t pose = rbf.poses[solver.first_pose + t];
    float factor = result;
    for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
      factor = saturated(factor * d.values[rbf.pose_inputs[i]]);
    }
    for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
      float& control = d.values[rbf.pose_outputs[o]];
      control = saturated(control + saturated(rbf.pose_weights[o] * factor));
    }
  }
}

/// The product of a pose's inputs without input `left_out` (or with all of them).
float product_of_inputs(const Derivatives& d, uint32_t pose, uint32_t left_out) {
  const RbfTable& rbf = d.rig->rbf;
  float product = 1.0f;
  for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
    if (i != left_out) product *= d.values[rbf.pose_inputs[i]];
  }
  return product;
}

}  // namespace

uint32_t rbf_input_count(const RbfSolverPlan& plan) {
  return takes_parts(plan) ? plan.input_count / plan.angle_inputs * 4 : plan.input_count;
}

uint16_t rbf_input_control(const RbfTable& rbf, const RbfSolverPlan& plan, uint32_t i) {
  if (!takes_parts(plan)) return rbf.inputs[plan.first_input + i];
  const size_t lane = plan.first_input + i / 4;
  return rbf
      .rotations[lane / kBlockLanes * 4 * kBlockLanes + i % 4 * kBlockLanes + lane % kBlockLanes];
}

void linearize_rbf(Derivatives& d) {
  const Rig& rig = *d.rig;
  if (rig.rbf_count == 0) return;
  for (const uint16_t solver : rig.rbf.lod_solvers.at(d.lod)) linearize_solver(d, solver);
}

// docs/rig-evaluation.md, 6.8: outputs = sum over poses of weight * result * product of the pose's inputs.
template <uint32_t L>
void push_rbf(Derivatives& d) {
  const Rig& rig = *d.rig;
  const RbfTable& rbf = rig.rbf;
  if (rig.rbf_count == 0) return;
  float* const x = d.controls.data;
  for (const uint16_t index : rbf.lod_solvers.at(d.lod)) {
    const RbfSolverPlan& plan = rbf.plans[index];
    const RbfSolver& solver = rbf.solvers[index];
    const uint32_t inputs = rbf_input_count(plan);
    for (uint16_t pose : rbf.poses.slice(solver.first_pose, plan.pose_count)) {
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        clear<L>(x + size_t{rbf.pose_outputs[o]} * L);
      }
    }
    // All results before the first output is written: solvers may read what they write.
    float* const results = d.rbf_lanes.data;
    const float* slopes = d.rbf_slopes.data + d.rbf_first[index];
    for (uint32_t t = 0; t < plan.pose_count; ++t, slopes += inputs) {
      float sum[L] = {};  // compilers must assume that buffers overlap
      for (uint32_t i = 0; i < inputs; ++i) {
        if (slopes[i] == 0.0f) continue;
        add_scaled<L>(sum, x + size_t{rbf_input_control(rbf, plan, i)} * L, slopes[i]);
      }
      std::copy(sum, sum + L, results + size_t{t} * L);
    }
    for (uint32_t t = 0; t < plan.pose_count; ++t) {
      const float* result = results + size_t{t} * L;
      if (plan.first_control != kNoFirstControl) {
        std::copy(result, result + L, x + (size_t{plan.first_control} + t) * L);
        continue;
      }
      const uint32_t pose = rbf.poses[solver.first_pose + t];
      float factor[L] = {};
      add_scaled<L>(factor, result, product_of_inputs(d, pose, ~uint32_t{0}));
      for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
        add_scaled<L>(factor, x + size_t{rbf.pose_inputs[i]} * L,
                      d.rbf_factors[plan.first_lane + t] * product_of_inputs(d, pose, i));
      }
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        add_scaled<L>(x + size_t{rbf.pose_outputs[o]} * L, factor, rbf.pose_weights[o]);
      }
    }
  }
}

template <uint32_t L>
void pull_rbf(Derivatives& d) {
  const Rig& rig = *d.rig;
  const RbfTable& rbf = rig.rbf;
  if (rig.rbf_count == 0) return;
  float* const x = d.controls.data;
  const Span<uint16_t> solvers = rbf.lod_solvers.at(d.lod);
  for (size_t n = solvers.count; n-- > 0;) {
    const uint16_t index = solvers[n];
    const RbfSolverPlan& plan = rbf.plans[index];
    const RbfSolver& solver = rbf.solvers[index];
    const uint32_t inputs = rbf_input_count(plan);
    float* const results = d.rbf_lanes.data;
    for (uint32_t t = plan.pose_count; t-- > 0;) {
      float* result = results + size_t{t} * L;
      clear<L>(result);
      if (plan.first_control != kNoFirstControl) {
        take<L>(result, x + (size_t{plan.first_control} + t) * L);
        continue;
      }
      const uint32_t pose = rbf.poses[solver.first_pose + t];
      float factor[L] = {};
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        add_scaled<L>(factor, x + size_t{rbf.pose_outputs[o]} * L, rbf.pose_weights[o]);
      }
      add_scaled<L>(result, factor, product_of_inputs(d, pose, ~uint32_t{0}));
      for (uint32_t i = rbf.first_input[pose]; i < rbf.first_input[pose + 1]; ++i) {
        add_scaled<L>(x + size_t{rbf.pose_inputs[i]} * L, factor,
                      d.rbf_factors[plan.first_lane + t] * product_of_inputs(d, pose, i));
      }
    }
    const float* slopes = d.rbf_slopes.data + d.rbf_first[index];
    for (uint32_t t = 0; t < plan.pose_count; ++t, slopes += inputs) {
      for (uint32_t i = 0; i < inputs; ++i) {
        if (slopes[i] == 0.0f) continue;
        add_scaled<L>(x + size_t{rbf_input_control(rbf, plan, i)} * L, results + size_t{t} * L,
                      slopes[i]);
      }
    }
    for (uint16_t pose : rbf.poses.slice(solver.first_pose, plan.pose_count)) {
      for (uint32_t o = rbf.first_output[pose]; o < rbf.first_output[pose + 1]; ++o) {
        clear<L>(x + size_t{rbf.pose_outputs[o]} * L);
      }
    }
  }
}

template void push_rbf<1>(Derivatives&);
template void push_rbf<kBatchLanes>(Derivatives&);
template void pull_rbf<1>(Derivatives&);
template void pull_rbf<kBatchLanes>(Derivatives&);

}  // namespace mien
