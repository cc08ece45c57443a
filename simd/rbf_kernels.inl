// SPDX-License-Identifier: MIT
// RBF solvers: distances, weights, interpolation, normalization. Products and sums are rounded one
// by one, in an order that does not depend on the width.

#include "simd/dense_kernels.inl"
#include "simd/joint_kernels.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// acos(x) for -1 <= x <= 1, within 2e-8 before rounding: sqrt(1 - |x|) times a polynomial
// (Abramowitz and Stegun 4.4.46), reflected for negative x.
inline Vec arc_cosine(Vec x) {
  const Vec a = at_most(absolute(x), broadcast(1.0f));
  const Vec a2 = a * a;
  const Vec low = (broadcast(-0.0501743046f) * a + broadcast(0.0889789874f)) * a2 +
                  (broadcast(-0.2145988016f) * a + broadcast(1.5707963050f));
  const Vec high = (broadcast(-0.0012624911f) * a + broadcast(0.0066700901f)) * a2 +
                   (broadcast(-0.0170881256f) * a + broadcast(0.0308918810f));
  const Vec angle = (high * (a2 * a2) + low) * square_root(broadcast(1.0f) - a);
  return select(less(x, broadcast(0.0f)), broadcast(3.14159265f) - angle, angle);
}

// The angle between two rotations from the dot product of their quaternions; the sign of either
// does not matter.
inline Vec angle_between(const float* targets, const float* inputs, size_t stride, Vec start) {
  Vec dot = start;
  for (size_t k = 0; k < 4; ++k) dot = dot + load(targets + k * stride) * broadcast(inputs[k]);
  const Vec u = dot * dot;
  const Vec angle = arc_cosine((u + u) - broadcast(1.0f));
  // u - u is 0, or hands on what is not a number, which the polynomial would hide.
  return select(less(broadcast(1.0f), u), broadcast(0.0f), angle + (u - u));
}

inline Vec distance(const RbfSolverPlan& solver, const float* targets, const float* inputs,
                    size_t stride) {
  const Vec start = load(targets);  // 0, or NaN behind the last pose
  targets += stride;
  if (solver.angular && solver.input_count / 4 == 1) {
    return angle_between(targets, inputs, stride, start);
  }
  Vec sum = start;
  if (solver.angular) {
    for (size_t i = 0; i + 4 <= solver.input_count; i += 4) {
      const Vec angle = angle_between(targets + i * stride, inputs + i, stride, start);
      sum = sum + angle * angle;
    }
  } else {
    for (size_t i = 0; i < solver.input_count; ++i) {
      const Vec d = load(targets + i * stride) - broadcast(inputs[i]);
      sum = sum + d * d;
    }
  }
  return square_root(sum);
}

inline Vec weight_of(Vec x, const RbfSolverPlan& solver) {
  constexpr float kLargest = 3.4e38f;
  const Vec zero = broadcast(0.0f), one = broadcast(1.0f);
  if (solver.function >= 2) {
    Vec power = x;
    for (int n = 2; n < solver.function; ++n) power = power * (x * x);
    return at_most(at_least(one - power, zero), broadcast(kLargest));
  }
  if (!(solver.scale < 0)) {
    return select(less(x, broadcast(kLargest)), exp_of_negative(zero - x), zero);
  }
  // A radius below zero makes weights grow with the distance, up to where they stop being numbers.
  const Vec weight = divide(one, exp_of_negative(x));
  return select(less(x, broadcast(kLargest)), at_most(weight, broadcast(kLargest)), zero);
}

void weigh_poses(const RbfSolverPlan& solver, const RbfArgs& args) {
  const size_t stride = (solver.pose_count + kBlockRows - 1) / kBlockRows * kBlockRows;
  const float* targets = args.targets + solver.first_target;
  const float* inputs = args.inputs + solver.first_input;
  float* weights = args.weights + solver.first_lane;
  size_t p = 0;
  for (; p < solver.pose_count; p += kWidth) {
    const Vec x = distance(solver, targets + p, inputs, stride) * broadcast(solver.scale);
    store(weights + p, weight_of(x, solver));
  }
  for (; p < stride; p += kWidth) store(weights + p, broadcast(0.0f));
}

/// results = the inverse times the weights. A few rows at a time keep their sums in registers.
void interpolate(const RbfSolverPlan& solver, const RbfArgs& args) {
  const float* weights = args.weights + solver.first_lane;
  float* results = args.results + solver.first_lane;
  const float* inverse = args.inverses + solver.first_inverse;
  const size_t count = solver.pose_count;
  for (size_t p = 0; p < count; p += kWidth) {
    const float* column = inverse + p / kBlockRows * count * kBlockRows + p % kBlockRows;
    Vec sum = broadcast(0.0f);
    for (size_t t = 0; t < count; ++t) {
      sum = sum + load(column + t * kBlockRows) * broadcast(weights[t]);
    }
    store(results + p, at_most(at_least(sum, broadcast(0.0f)), broadcast(1.0f)));
  }
  const size_t stride = (count + kBlockRows - 1) / kBlockRows * kBlockRows;
  for (size_t p = (count + kWidth - 1) / kWidth * kWidth; p < stride; p += kWidth) {
    store(results + p, broadcast(0.0f));
  }
}

/// Of whole blocks: sixteen sums, then one half added to the other until one is left.
inline float sum_of(const float* values, size_t count) {
  float sums[kBlockRows];
  for (size_t v = 0; v < kBlockRows; v += kWidth) {
    Vec sum = load(values + v);
    for (size_t p = kBlockRows; p < count; p += kBlockRows) sum = sum + load(values + p + v);
    store(sums + v, sum);
  }
  for (size_t half = kBlockRows / 2; half > 0; half /= 2) {
    for (size_t i = 0; i < half; ++i) sums[i] += sums[i + half];
  }
  return sums[0];
}

void normalize(const RbfSolverPlan& solver, const RbfArgs& args) {
  const size_t at = solver.first_lane, count = solver.pose_count;
  const float* weights = (solver.interpolative ? args.results : args.weights) + at;
  const float sum = sum_of(weights, count);
  float scale = 1.0f;
  if (sum > 1.0f || (solver.always_normalize && sum > 0.0f)) scale = 1.0f / sum;
  if (!(scale < 3.4e38f)) scale = 0.0f;  // of weights that all but vanish
  const Vec threshold = broadcast(solver.threshold), zero = broadcast(0.0f);
  for (size_t p = 0; p < count; p += kWidth) {
    const Vec value = load(weights + p) * broadcast(scale) * load(args.pose_scales + at + p);
    const Vec counted = select(less(threshold, value), saturate(value), zero);
    store(args.results + at + p, saturate(counted * load(args.pose_factors + at + p)) + zero);
  }
}

// Step by step for all of them: what one solver waits for, another has ready.
void rbf_solvers(const RbfArgs& args) {
  for (size_t i = 0; i < args.count; ++i) weigh_poses(args.solvers[args.list[i]], args);
  for (size_t i = 0; i < args.count; ++i) {
    const RbfSolverPlan& solver = args.solvers[args.list[i]];
    if (solver.interpolative) interpolate(solver, args);
  }
  for (size_t i = 0; i < args.count; ++i) normalize(args.solvers[args.list[i]], args);
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
