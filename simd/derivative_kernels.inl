// SPDX-License-Identifier: MIT
// Products with transposed matrices.

#pragma once

#include "simd/derivative_kernels.h"
#include "simd/joint_kernels.inl"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

inline float sum_of_eight(const float* v) {
  const float a = v[0] + v[4], b = v[1] + v[5], c = v[2] + v[6], d = v[3] + v[7];
  return (a + c) + (b + d);
}

/// The rows of a block row, numbered as in JointColumnsArgs.
inline const float* rows_of(const float* rows, size_t number) {
  return rows + number * (kJointBlockRows / kBlockRowUnit);
}

constexpr size_t kVecsPerJointBlock = kJointBlockRows / kBlockWidth;

/// The sums of the even and of the odd block rows of a run.
template <class How, class Value>
inline void sum_run(const JointTransposedArgs& args, const JointRun& run, float* sums) {
  const Value* values =
      static_cast<const Value*>(args.values) + size_t{run.start.first_pair} * kJointBlockRows;
  const uint16_t* numbers = args.block_rows + run.start.pair_entry;
#if defined(MIEN_KERNEL_AVX512)
  Vec both = broadcast(0.0f);
  for (size_t i = 0; i < run.pair_count; ++i) {
    both = How::mul_add(load_pair(values + i * 2 * kJointBlockRows),
                        load(rows_of(args.rows, numbers[i] & kPairBlockRows)), both);
  }
  store(sums, both);
#else
  BlockVec pair[2 * kVecsPerJointBlock];
  for (BlockVec& v : pair) v = broadcast_block(0.0f);
  for (size_t i = 0; i < run.pair_count; ++i) {
    const float* rows = rows_of(args.rows, numbers[i] & kPairBlockRows);
    for (size_t v = 0; v < 2 * kVecsPerJointBlock; ++v) {
      pair[v] = How::mul_add(load_block(values + i * 2 * kJointBlockRows + v * kBlockWidth),
                             load_block(rows + v * kBlockWidth), pair[v]);
    }
  }
  for (size_t v = 0; v < 2 * kVecsPerJointBlock; ++v) store_block(sums + v * kBlockWidth, pair[v]);
#endif
  values =
      static_cast<const Value*>(args.values) + size_t{run.start.first_single} * kJointBlockRows;
  numbers = args.block_rows + run.start.single_entry;
  for (size_t i = 0; i < run.single_count; ++i) {
    const float* rows = rows_of(args.rows, numbers[i]);
    float* half = sums + (numbers[i] / kBlockRowUnit & 1) * kJointBlockRows;
    for (size_t v = 0; v < kJointBlockRows; v += kBlockWidth) {
      store_block(half + v, How::mul_add(load_block(values + i * kJointBlockRows + v),
                                         load_block(rows + v), load_block(half + v)));
    }
  }
}

template <class How, class Value>
void sum_runs(const JointTransposedArgs& args) {
  alignas(64) float sums[2 * kJointBlockRows];
  for (size_t i = 0; i < args.run_count; ++i) {
    sum_run<How, Value>(args, args.runs[i], sums);
    args.outputs[i] = sum_of_eight(sums) + sum_of_eight(sums + kJointBlockRows);
  }
}
template <class Value>
void sum_runs(const JointTransposedArgs& args) {
  args.portable ? sum_runs<AsPortable, Value>(args) : sum_runs<AsFast, Value>(args);
}
void joint_transposed(const JointTransposedArgs& args) { sum_runs<float>(args); }
void joint_transposed_fixed(const JointTransposedArgs& args) { sum_runs<int16_t>(args); }

// Skinning ----------------------------------------------------------------------------------------

void skin_transposed(const SkinTransposedArgs& given) {
  const SkinTransposedArgs args = given;
  alignas(16) static constexpr float kUnitW[4] = {0, 0, 0, 1};
  alignas(16) static constexpr float kUnitXyz[4] = {1, 1, 1, 0};
  const Quad unit_w = load4(kUnitW), unit_xyz = load4(kUnitXyz);
  for (size_t i = 0; i < args.count; ++i) {
    const Quad g = load4(args.gradients + size_t{args.position_indices[i]} * 3);
    // x y z 1; the fourth float of a position may be anything finite.
    const Quad p = mul_add4(load4(args.positions + i * 4), unit_xyz, unit_w);
    const Quad x = lane4<0>(g) * p, y = lane4<1>(g) * p, z = lane4<2>(g) * p;
    const float* const weights = args.weights + i * args.influences;
    const uint16_t* const joints = args.joints + i * args.influences;
    for (size_t k = 0; k < args.influences; ++k) {
      const Quad weight = broadcast4(weights[k]);
      float* const rows = args.matrices + size_t{joints[k]} * 12;
      store4(rows, mul_add4(weight, x, load4(rows)));
      store4(rows + 4, mul_add4(weight, y, load4(rows + 4)));
      store4(rows + 8, mul_add4(weight, z, load4(rows + 8)));
    }
    if (!args.out_positions) continue;
    Quad c[3] = {broadcast4(0.0f), broadcast4(0.0f), broadcast4(0.0f)};
    for (size_t k = 0; k < args.influences; ++k) {
      const Quad weight = broadcast4(weights[k]);
      const float* const skin = args.skins + size_t{joints[k]} * 16;
      for (size_t n = 0; n < 3; ++n) c[n] = mul_add4(weight, load4(skin + n * 4), c[n]);
    }
    // Columns of the blended matrix, times the gradient.
    Quad t[4] = {c[0], c[1], c[2], broadcast4(0.0f)};
    transpose4(t[0], t[1], t[2], t[3]);
    store4(args.out_positions + i * 4,
           mul_add4(t[2], lane4<2>(g), mul_add4(t[1], lane4<1>(g), t[0] * lane4<0>(g))));
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
