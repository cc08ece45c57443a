// SPDX-License-Identifier: MIT
// Block matrix times vector: joint groups, and the sums of dense layers.

#pragma once

#include <utility>  // index_sequence, a mere type

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

constexpr size_t kVecsPerBlock = kBlockRows / kWidth;

struct BlockMatrix {
  const float* values;
  size_t column_count, block_count;
};

// The sums of sizeof...(K) neighbouring vectors of rows, counted over all blocks, in one walk over
// the columns:
//
//     AVX2, first_vec 2:   block 0 | block 1 | block 2 | ...
//                          v0  v1  | v2  v3  | v4  v5  | ...
//                                    K=0 K=1   K=2 K=3
//
// Each lane is a row and adds its columns in ascending order, so neither the width nor the number
// of vectors changes a bit of the result. The pack instead of a loop makes each sum a register of
// its own at any level of optimization.
template <size_t... K>
inline void sum_vecs(const BlockMatrix& matrix, const float* inputs, float* sums_out,
                     size_t first_vec, std::index_sequence<K...>) {
  const size_t column_count = matrix.column_count;
  const size_t block_floats = column_count * kBlockRows;

  const float* const rows[] = {matrix.values + (first_vec + K) / kVecsPerBlock * block_floats +
                               (first_vec + K) % kVecsPerBlock * kWidth...};
  Vec sums[] = {(static_cast<void>(K), broadcast(0.0f))...};
  for (size_t c = 0; c < column_count; ++c) {
    const Vec input = broadcast(inputs[c]);
    ((sums[K] = mul_add(load(rows[K] + c * kBlockRows), input, sums[K])), ...);
  }
  (store(sums_out + (first_vec + K) * kWidth, saturate(sums[K])), ...);
}

template <size_t kCount>
inline void sum_vecs(const BlockMatrix& matrix, const float* inputs, float* sums,
                     size_t first_vec) {
  sum_vecs(matrix, inputs, sums, first_vec, std::make_index_sequence<kCount>());
}

// A multiply-add takes about four cycles and two start in each: eight sums hide the wait, and fit
// the 16 registers of SSE2 and AVX2.
void multiply(const BlockMatrix& matrix, const float* inputs, float* sums) {
  const size_t vec_count = matrix.block_count * kVecsPerBlock;
  size_t v = 0;
  for (; v + 8 <= vec_count; v += 8) sum_vecs<8>(matrix, inputs, sums, v);
  for (; v + 4 <= vec_count; v += 4) sum_vecs<4>(matrix, inputs, sums, v);
  for (; v + 2 <= vec_count; v += 2) sum_vecs<2>(matrix, inputs, sums, v);
  for (; v < vec_count; ++v) sum_vecs<1>(matrix, inputs, sums, v);
}

void joint_group(const JointGroupArgs& args) {
  // The controls are scattered; fetch each once, not once per row.
  for (size_t c = 0; c < args.column_count; ++c) args.inputs[c] = args.controls[args.columns[c]];
  multiply({args.values, args.column_count, args.block_count}, args.inputs, args.sums);
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
