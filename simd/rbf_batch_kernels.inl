// SPDX-License-Identifier: MIT
// RBF solvers for many characters, one lane each: what rbf_kernels.inl does with poses in lanes, with the
// same operations in the same order.

#pragma once

#include <utility>  // index_sequence, a type only

#include "simd/quad.inl"
#include "simd/rbf_kernels.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

constexpr size_t kPairLanes = 2 * kWidth;  // a VecPair
static_assert(kBatchLanes % kPairLanes == 0, "pairs fill the lanes");

/// The numbers of rotation i of a solver, or its plain inputs: rows of 32.
struct BatchInputs {
  const float* rows[4];
};

inline BatchInputs batch_rotation(const RbfSolverPlan& solver, const RbfBatchArgs& args, size_t i) {
  BatchInputs inputs = {};
  if (solver.angle_inputs == 4) {
    const uint16_t* controls = args.inputs + solver.first_input + 4 * i;
    for (size_t k = 0; k < 4; ++k) inputs.rows[k] = args.controls + controls[k] * kBatchLanes;
    return inputs;
  }
  const float* parts = args.rotations + (solver.first_input + i) * 4 * kBatchLanes;
  if (solver.angle_inputs == 3) {
    for (size_t k = 0; k < 3; ++k) inputs.rows[k] = parts + (k + 1) * kBatchLanes;
  } else {
    inputs.rows[0] = parts;
    inputs.rows[1] = parts + 3 * kBatchLanes;
  }
  return inputs;
}

/// The dot product of kCount numbers, in registers, and those of a target.
template <size_t kCount>
inline VecPair batch_angle(const float* targets, size_t stride, const VecPair* inputs) {
  using M = Make<VecPair>;
  VecPair dot = M::of(targets[0]) * inputs[0];
  for (size_t k = 1; k < kCount; ++k) dot = dot + M::of(targets[k * stride]) * inputs[k];
  return quick_rotation_angle(dot);
}

/// Distances of kCount numbers per rotation. A single rotation stays in registers for all poses; the squares
/// of several are summed one after another.
template <size_t kCount, class Weigh>
inline void weigh_angles(const RbfSolverPlan& solver, const RbfBatchArgs& args, size_t stride,
                         size_t lane, const Weigh& weigh) {
  using M = Make<VecPair>;
  const size_t rotations = solver.input_count / kCount, count = solver.pose_count;
  const float* targets = args.targets + solver.first_target;
  float* const weights = args.weights[0] + lane;
  for (size_t i = 0; i < rotations; ++i, targets += kCount * stride) {
    const BatchInputs rows = batch_rotation(solver, args, i);
    VecPair inputs[kCount];
    for (size_t k = 0; k < kCount; ++k) inputs[k] = M::from(rows.rows[k] + lane);
    const bool first = i == 0, last = i + 1 == rotations;
    for (size_t p = 0; p < count; ++p) {
      VecPair d = batch_angle<kCount>(targets + p, stride, inputs);
      float* const at = weights + p * kBatchLanes;
      if (rotations != 1) {
        d = (first ? M::of(0.0f) : M::from(at)) + d * d;
        if (last) d = square_root(d);
      }
      store(at, last ? weigh(d) : d);
    }
  }
}

template <class Weigh>
inline void weigh_differences(const RbfSolverPlan& solver, const RbfBatchArgs& args, size_t stride,
                              size_t lane, const Weigh& weigh) {
  using M = Make<VecPair>;
  const uint16_t* const controls = args.inputs + solver.first_input;
  for (size_t p = 0; p < solver.pose_count; ++p) {
    const float* const targets = args.targets + solver.first_target + p;
    VecPair sum = M::of(0.0f);
    for (size_t i = 0; i < solver.input_count; ++i) {
      const VecPair d =
          M::of(targets[i * stride]) - M::from(args.controls + controls[i] * kBatchLanes + lane);
      sum = sum + d * d;
    }
    if (solver.input_count == 0) sum = M::of(targets[0]);
    store(args.weights[0] + p * kBatchLanes + lane,
          weigh(solver.input_count == 0 ? sum : square_root(sum)));
  }
}

template <class Weigh>
inline void weigh_poses(const RbfSolverPlan& solver, const RbfBatchArgs& args, size_t lane,
                        const Weigh& weigh) {
  const size_t stride = (solver.pose_count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
  if (solver.input_count == 0 || solver.angle_inputs == 0) {
    return weigh_differences(solver, args, stride, lane, weigh);
  }
  switch (solver.angle_inputs) {
    case 2: return weigh_angles<2>(solver, args, stride, lane, weigh);
    case 3: return weigh_angles<3>(solver, args, stride, lane, weigh);
    default: return weigh_angles<4>(solver, args, stride, lane, weigh);
  }
}

/// The inverse times the weights, for the poses from `pose` on, one for each P. The pack keeps each sum in
/// its own register.
template <size_t... P>
inline void batch_interpolate(const RbfSolverPlan& solver, const RbfBatchArgs& args, size_t pose,
                              size_t lane, std::index_sequence<P...>) {
  using M = Make<VecPair>;
  const size_t count = solver.pose_count;
  const float* const inverses = args.inverses + solver.first_inverse;
  const float* const columns[] = {inverses + (pose + P) / kBlockLanes * count * kBlockLanes +
                                  (pose + P) % kBlockLanes...};
  const float* const weights = args.weights[0] + lane;
  VecPair sums[] = {(static_cast<void>(P), M::of(0.0f))...};
  for (size_t t = 0; t < count; ++t) {
    const VecPair weight = M::from(weights + t * kBatchLanes);
    ((sums[P] = sums[P] + M::of(columns[P][t * kBlockLanes]) * weight), ...);
  }
  (store(args.weights[1] + (pose + P) * kBatchLanes + lane,
         at_most(at_least(sums[P], M::of(0.0f)), M::of(1.0f))),
   ...);
}

/// Partial sum `i` of sum_of() of rbf_kernels.inl; 0 for lanes without a pose.
inline VecPair batch_partial_sum(const float* weights, size_t i, size_t count) {
  using M = Make<VecPair>;
  alignas(64) static constexpr float kNone[2 * kWidth] = {};
  VecPair sum = M::from(i < count ? weights + i * kBatchLanes : kNone);
  for (size_t p = i + kBlockLanes; p < count; p += kBlockLanes) {
    sum = sum + M::from(weights + p * kBatchLanes);
  }
  return sum;
}

/// As sum_of(), which adds halves in this order: partial sums i, i + kStep, i + 2 kStep ...
template <size_t kStep = 1>
[[gnu::always_inline]] inline VecPair batch_sum(const float* weights, size_t count, size_t i = 0) {
  if constexpr (kStep == kBlockLanes) {
    return batch_partial_sum(weights, i, count);
  } else {
    const VecPair sum = batch_sum<2 * kStep>(weights, count, i);
    return sum + batch_sum<2 * kStep>(weights, count, i + kStep);
  }
}

/// Where the results of a solver go: the lanes of its controls, or scratch memory.
inline float* results_of(const RbfSolverPlan& solver, const RbfBatchArgs& args) {
  if (solver.first_control == kNoFirstControl) return args.weights[solver.interpolative];
  return args.controls + size_t{solver.first_control} * kBatchLanes;
}

inline void batch_solver(const RbfSolverPlan& solver, const RbfBatchArgs& args, size_t lane) {
  using M = Make<VecPair>;
  const size_t count = solver.pose_count;
  with_weight<VecPair>(solver,
                       [&](const auto& weight_of) { weigh_poses(solver, args, lane, weight_of); });
  if (solver.interpolative) {
    size_t p = 0;
    for (; p + 4 <= count; p += 4) {
      batch_interpolate(solver, args, p, lane, std::make_index_sequence<4>());
    }
    switch (count - p) {
      case 1: batch_interpolate(solver, args, p, lane, std::make_index_sequence<1>()); break;
      case 2: batch_interpolate(solver, args, p, lane, std::make_index_sequence<2>()); break;
      case 3: batch_interpolate(solver, args, p, lane, std::make_index_sequence<3>()); break;
      default: break;
    }
  }
  const float* const weights = args.weights[solver.interpolative] + lane;
  float* const results = results_of(solver, args) + lane;
  const VecPair zero = M::of(0.0f), one = M::of(1.0f), sum = batch_sum(weights, count);
  const auto divides = solver.always_normalize ? less(zero, sum) : less(one, sum);
  VecPair scale = select(divides, divide(one, sum), one);
  scale = keep(less(scale, M::of(3.4e38f)), scale);  // all weights are nearly 0
  const VecPair threshold = M::of(solver.threshold);
  const float* const pose_scales = args.pose_scales + solver.first_lane;
  const float* const pose_factors = args.pose_factors + solver.first_lane;
  for (size_t p = 0; p < count; ++p) {
    const VecPair value = M::from(weights + p * kBatchLanes) * scale * M::of(pose_scales[p]);
    store(results + p * kBatchLanes, keep(less(threshold, value), value) * M::of(pose_factors[p]));
  }
}

/// As part_rotations(), for one rotation of all characters.
inline void batch_part(const RbfBatchArgs& args, size_t rotation, size_t lane) {
  using M = Make<VecPair>;
  const uint16_t* inputs =
      args.rotation_inputs + rotation / kBlockLanes * 4 * kBlockLanes + rotation % kBlockLanes;
  const auto part = [&](size_t k) {
    return M::from(args.controls + inputs[k * kBlockLanes] * kBatchLanes + lane);
  };
  const VecPair zero = M::of(0.0f), a = part(0), b = part(1), c = part(2), w = part(3);
  const VecPair length = square_root(a * a + w * w);
  float* to = args.rotations + rotation * 4 * kBatchLanes + lane;
  if (args.swings[rotation] > 0.0f) {
    const VecPair n = zero - length;
    store(to, zero);
    store(to + kBatchLanes, divide(w * b - a * c, n));
    store(to + 2 * kBatchLanes, divide(w * c + a * b, n));
    store(to + 3 * kBatchLanes, n);
  } else {
    store(to, divide(a, length));
    store(to + kBatchLanes, zero);
    store(to + 2 * kBatchLanes, zero);
    store(to + 3 * kBatchLanes, divide(w, length));
  }
}

void rbf_batch(const RbfBatchArgs& args) {
  const size_t lane_count = args.lane_count;
  for (size_t r = 0; r < size_t{args.block_count} * kBlockLanes; ++r) {
    for (size_t lane = 0; lane < lane_count; lane += kPairLanes) batch_part(args, r, lane);
  }
  for (size_t i = 0; i < args.count; ++i) {
    const RbfSolverPlan& solver = args.solvers[args.list[i]];
    if (solver.pose_count == 0) continue;
    for (size_t lane = 0; lane < lane_count; lane += kPairLanes) batch_solver(solver, args, lane);
    const bool direct = solver.first_control != kNoFirstControl;
    scatter_lanes(results_of(solver, args), solver.pose_count, lane_count,
                  direct ? args.rows : args.results,
                  direct ? solver.first_control : solver.first_lane);
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
