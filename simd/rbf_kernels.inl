// SPDX-License-Identifier: MIT
// RBF solvers: distances, weights, interpolation, normalization. Products and sums are rounded separately, in
// an order that does not depend on the width.

#pragma once

#include "simd/math.inl"
#include "simd/rbf_kernels.h"

namespace mien::MIEN_KERNEL_ISA {
namespace {

/// The numbers of one rotation, `step` apart; swings lack the first of four, twists the middle two.
struct RotationInput {
  const float* first;
  size_t step;
};

inline RotationInput rotation_input(const RbfSolverPlan& solver, const RbfArgs& args, size_t i) {
  if (solver.angle_inputs == 4) return {args.inputs + solver.first_input + 4 * i, 1};
  const size_t lane = solver.first_input + i;
  const float* a = args.rotations + lane / kBlockLanes * 4 * kBlockLanes + lane % kBlockLanes;
  if (solver.angle_inputs == 3) return {a + kBlockLanes, kBlockLanes};
  return {a, 3 * kBlockLanes};
}

// The angle between two rotations: the dot product of their quaternions is the real part of the rotation from
// one to the other.
template <class V>
[[gnu::always_inline]] inline V angle_between(const float* targets, size_t stride,
                                              RotationInput input, size_t count) {
  using M = Make<V>;
  V dot = M::from(targets) * M::of(input.first[0]);
  for (size_t k = 1; k < count; ++k) {
    dot = dot + M::from(targets + k * stride) * M::of(input.first[k * input.step]);
  }
  return quick_rotation_angle(dot);
}

template <class V>
[[gnu::always_inline]] inline V distance(const RbfSolverPlan& solver, const RbfArgs& args,
                                         const float* targets, size_t stride) {
  using M = Make<V>;
  if (solver.input_count == 0) return M::from(targets);
  V sum = M::of(0.0f);
  if (solver.angle_inputs == 0) {
    const float* inputs = args.inputs + solver.first_input;
    for (size_t i = 0; i < solver.input_count; ++i) {
      const V d = M::from(targets + i * stride) - M::of(inputs[i]);
      sum = sum + d * d;
    }
    return square_root(sum);
  }
  const size_t count = solver.angle_inputs, rotations = solver.input_count / count;
  if (rotations == 1) {
    return angle_between<V>(targets, stride, rotation_input(solver, args, 0), count);
  }
  for (size_t i = 0; i < rotations; ++i) {
    const V angle = angle_between<V>(targets + i * count * stride, stride,
                                     rotation_input(solver, args, i), count);
    sum = sum + angle * angle;
  }
  return square_root(sum);
}

/// Calls f(weight of a distance); the function is chosen once for all distances.
template <class V, class F>
[[gnu::always_inline]] inline void with_weight(const RbfSolverPlan& solver, F&& f) {
  using M = Make<V>;
  // With a radius below zero, weights grow with the distance: up to 2^60, so that the product with scale and
  // factor of a pose does not overflow.
  constexpr float kMax = 60, kMaxWeight = 1.152921505e18f;
  const V scale = M::of(solver.scale);
  if (solver.function < 2) {
    const V most = M::of(solver.scale > 0 ? kMax : __builtin_inff());
    return f([=](V d) { return power_of_two_or_zero(at_most_or_nan(d * scale, most)); });
  }
  const int exponent = solver.function;
  f([=](V d) {
    const V x = d * scale;
    V power = x;
    for (int n = 2; n < exponent; ++n) power = power * (x * x);
    return at_most(at_least(M::of(1.0f) - power, M::of(0.0f)), M::of(kMaxWeight));
  });
}

template <class V>
inline void weigh_lanes(const RbfSolverPlan& solver, const RbfArgs& args, size_t lane,
                        size_t stride) {
  const V d = distance<V>(solver, args, args.targets + solver.first_target + lane, stride);
  with_weight<V>(solver, [&](const auto& weight_of) {
    store(args.weights + solver.first_lane + lane, weight_of(d));
  });
}

void weigh_poses(const RbfSolverPlan& solver, const RbfArgs& args) {
  const size_t count = solver.pose_count;
  const size_t stride = (count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
  size_t p = 0;
  for (; p + kWidth < count; p += 2 * kWidth) weigh_lanes<VecPair>(solver, args, p, stride);
  if (p < count) {
    weigh_lanes<Vec>(solver, args, p, stride);
    p += kWidth;
  }
  for (; p < stride; p += kWidth) store(args.weights + solver.first_lane + p, broadcast(0.0f));
}

template <class V>
inline void interpolate_lanes(const RbfSolverPlan& solver, const RbfArgs& args, size_t lane) {
  using M = Make<V>;
  const float* weights = args.weights + solver.first_lane;
  const size_t count = solver.pose_count;
  const float* column = args.inverses + solver.first_inverse +
                        lane / kBlockLanes * count * kBlockLanes + lane % kBlockLanes;
  V sum = M::of(0.0f);
#pragma GCC unroll 4
  for (size_t t = 0; t < count; ++t, column += kBlockLanes) {
    sum = sum + M::from(column) * M::of(weights[t]);
  }
  store(args.results + solver.first_lane + lane, at_most(at_least(sum, M::of(0.0f)), M::of(1.0f)));
}

/// results = the inverse times the weights. A pair of vectors must not reach into the next block.
void interpolate(const RbfSolverPlan& solver, const RbfArgs& args) {
  constexpr bool kPairsFit = 2 * kWidth <= kBlockLanes;
  const size_t count = solver.pose_count;
  const size_t stride = (count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
  size_t p = 0;
  if constexpr (kPairsFit) {
    for (; p + kWidth < count; p += 2 * kWidth) interpolate_lanes<VecPair>(solver, args, p);
  }
  for (; p < count; p += kWidth) interpolate_lanes<Vec>(solver, args, p);
  for (; p < stride; p += kWidth) store(args.results + solver.first_lane + p, broadcast(0.0f));
}

/// Of whole blocks: sixteen sums, then one half is added to the other until one is left.
inline float sum_of(const float* values, size_t count) {
  Vec sums[kVecsPerBlock];
  for (size_t v = 0; v < kVecsPerBlock; ++v) {
    sums[v] = load(values + v * kWidth);
    for (size_t p = kBlockLanes; p < count; p += kBlockLanes) {
      sums[v] = sums[v] + load(values + p + v * kWidth);
    }
  }
  return sum_of_lanes(sums);
}

void normalize(const RbfSolverPlan& solver, const RbfArgs& args) {
  const size_t at = solver.first_lane, count = solver.pose_count;
  if (count == 0) return;  // there is no block to sum
  const float* weights = (solver.interpolative ? args.results : args.weights) + at;
  const float sum = sum_of(weights, count);
  float scale = 1.0f;
  if (sum > 1.0f || (solver.always_normalize && sum > 0.0f)) scale = 1.0f / sum;
  if (!(scale < 3.4e38f)) scale = 0.0f;  // all weights are nearly 0
  const Vec threshold = broadcast(solver.threshold);
  float* results = args.results + at;
  if (solver.first_control != kNoFirstControl) results = args.controls + solver.first_control;
  for (size_t p = 0; p < count; p += kWidth) {
    const Vec value = load(weights + p) * broadcast(scale) * load(args.pose_scales + at + p);
    const Vec result = keep(less(threshold, value), value) * load(args.pose_factors + at + p);
    if (p + kWidth <= count) {
      store(results + p, result);
    } else {
      store_first(results + p, result, count - p);
    }
  }
}

/// Turns each of sixteen rotations into its swing or its twist (docs/rig-evaluation.md, 6.2 "Preparation of
/// inputs and targets").
void part_rotations(float* rotations, const float* swings) {
  for (size_t v = 0; v < kBlockLanes; v += kWidth) {
    float* at = rotations + v;
    const Vec zero = broadcast(0.0f), a = load(at), b = load(at + kBlockLanes);
    const Vec c = load(at + 2 * kBlockLanes), w = load(at + 3 * kBlockLanes);
    const Vec length = square_root(a * a + w * w);
    const Vec n = zero - length;
    const Mask swing = less(zero, load(swings + v));
    store(at, select(swing, zero, divide(a, length)));
    store(at + kBlockLanes, select(swing, divide(w * b - a * c, n), zero));
    store(at + 2 * kBlockLanes, select(swing, divide(w * c + a * b, n), zero));
    store(at + 3 * kBlockLanes, select(swing, n, divide(w, length)));
  }
}

// Each step for all solvers, so that the latencies of one are hidden by the others.
void rbf_solvers(const RbfArgs& args) {
  for (size_t b = args.first_block; b < args.first_block + size_t{args.block_count}; ++b) {
    part_rotations(args.rotations + b * 4 * kBlockLanes, args.swings + b * kBlockLanes);
  }
  for (size_t i = 0; i < args.count; ++i) weigh_poses(args.solvers[args.list[i]], args);
  for (size_t i = 0; i < args.count; ++i) {
    const RbfSolverPlan& solver = args.solvers[args.list[i]];
    if (solver.interpolative) interpolate(solver, args);
  }
  for (size_t i = 0; i < args.count; ++i) normalize(args.solvers[args.list[i]], args);
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
