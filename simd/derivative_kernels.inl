// SPDX-License-Identifier: MIT
// Products with transposed matrices.

#pragma once

#include "simd/derivative_kernels.h"
#include "simd/joint_kernels.inl"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// The values of a block are multiplied by four columns of one gradient, or by several gradients of one
// column: sums that do not wait for each other. Those of pairs stay in registers. Which half a block without
// its other half belongs to is known only when it is read, so those sums are in memory.

constexpr size_t kPairRows = 2 * kJointBlockRows;
constexpr size_t kColumnsTogether = 4;

// How many columns or lanes the registers take, beside the values.
#if defined(MIEN_KERNEL_AVX512)
constexpr size_t kColumnStep = kColumnsTogether, kLaneStep = kTransposedLanes;
#elif defined(MIEN_KERNEL_SCALAR)
constexpr size_t kColumnStep = 1, kLaneStep = 1;
#elif defined(MIEN_KERNEL_SSE2)
constexpr size_t kColumnStep = 2, kLaneStep = 2;
#else
constexpr size_t kColumnStep = kColumnsTogether, kLaneStep = 4;
#endif
constexpr size_t kPairVecs = kPairRows / InPairs::kRows;

/// Pairs or single blocks of a run: their values and numbers, and one past the last.
template <class Value>
struct RunPart {
  const Value* values;
  const uint16_t *numbers, *end;
};
template <class Value>
inline RunPart<Value> pairs_of(const JointTransposedArgs& args, const JointRun& run) {
  const uint16_t* numbers = args.block_rows + run.start.pair_entry;
  return {static_cast<const Value*>(args.values) + size_t{run.start.first_pair} * kJointBlockRows,
          numbers, numbers + run.pair_count};
}
template <class Value>
inline RunPart<Value> singles_of(const JointTransposedArgs& args, const JointRun& run) {
  const uint16_t* numbers = args.block_rows + run.start.single_entry;
  return {static_cast<const Value*>(args.values) + size_t{run.start.first_single} * kJointBlockRows,
          numbers, numbers + run.single_count};
}

/// The rows of the first lane for the pair that a block row belongs to, numbered as in JointColumnsArgs.
inline const float* rows_of_pair(const float* rows, size_t number, size_t lane_count) {
  return rows + (number & kPairBlockRows) / (2 * kBlockRowUnit) * (kPairRows * lane_count);
}
inline size_t half_of(size_t number) { return (number / kBlockRowUnit & 1) * kJointBlockRows; }

/// The sums of the pairs that all of these columns have: a V per vector of 16 rows of each column.
template <class How, class Value, size_t... V>
inline void sum_columns_of_pairs(RunPart<Value>* parts, const float* rows, float* sums,
                                 std::index_sequence<V...>) {
  constexpr size_t kColumns = sizeof...(V) / kPairVecs, kRows = InPairs::kRows;
  size_t count = static_cast<size_t>(parts[0].end - parts[0].numbers);
  for (size_t c = 1; c < kColumns; ++c) {
    const auto other = static_cast<size_t>(parts[c].end - parts[c].numbers);
    count = other < count ? other : count;
  }
  const Value* const values[] = {parts[V / kPairVecs].values + V % kPairVecs * kRows...};
  const uint16_t* const numbers[] = {parts[V / kPairVecs].numbers...};
  InPairs::Rows sum[] = {(static_cast<void>(V), InPairs::broadcast(0.0f))...};
  for (size_t i = 0; i < count; ++i) {
    ((sum[V] = How::mul_add(
          InPairs::load_values(values[V] + i * kPairRows),
          InPairs::load(rows_of_pair(rows, numbers[V][i], 1) + V % kPairVecs * kRows), sum[V])),
     ...);
  }
  (InPairs::store(sums + V * kRows, sum[V]), ...);
  for (size_t c = 0; c < kColumns; ++c) {
    parts[c].values += count * kPairRows;
    parts[c].numbers += count;
  }
}

/// The same for the rest of a column.
template <class How, class Value, size_t... V>
inline void add_pairs_of_column(const RunPart<Value>& part, const float* rows, float* sums,
                                std::index_sequence<V...>) {
  constexpr size_t kRows = InPairs::kRows;
  InPairs::Rows sum[] = {InPairs::load(sums + V * kRows)...};
  const Value* values = part.values;
  for (const uint16_t* number = part.numbers; number < part.end; ++number, values += kPairRows) {
    const float* const from = rows_of_pair(rows, *number, 1);
    ((sum[V] = How::mul_add(InPairs::load_values(values + V * kRows),
                            InPairs::load(from + V * kRows), sum[V])),
     ...);
  }
  (InPairs::store(sums + V * kRows, sum[V]), ...);
}

/// The sums of the pairs of a column in neighboring lanes: a V per vector of 16 rows of each lane.
template <class How, class Value, size_t... V>
inline void sum_lanes_of_pairs(const RunPart<Value>& part, const float* rows, float* sums,
                               std::index_sequence<V...>) {
  constexpr size_t kRows = InPairs::kRows;
  InPairs::Rows sum[] = {(static_cast<void>(V), InPairs::broadcast(0.0f))...};
  const Value* values = part.values;
  for (const uint16_t* number = part.numbers; number < part.end; ++number, values += kPairRows) {
    const float* const from = rows_of_pair(rows, *number, kTransposedLanes);
    const InPairs::Rows value[] = {InPairs::load_values(values + V % kPairVecs * kRows)...};
    ((sum[V] = How::mul_add(value[V], InPairs::load(from + V * kRows), sum[V])), ...);
  }
  (InPairs::store(sums + V * kRows, sum[V]), ...);
}

/// Adds a block without its other half.
template <class How, class Value>
inline void add_single(const Value* values, const float* rows, float* sums) {
  for (size_t r = 0; r < kJointBlockRows; r += kBlockWidth) {
    store_block(sums + r,
                How::mul_add(load_block(values + r), load_block(rows + r), load_block(sums + r)));
  }
}

inline float sum_of_eight(const float* v) {
  const float a = v[0] + v[4], b = v[1] + v[5], c = v[2] + v[6], d = v[3] + v[7];
  return (a + c) + (b + d);
}
inline float sum_of_rows(const float* sums) {
  return sum_of_eight(sums) + sum_of_eight(sums + kJointBlockRows);
}

/// sum_of_rows() of four times 16 sums.
inline Quad four_sums_of_eight(const float* sums) {
  Quad q[4];
  for (size_t k = 0; k < 4; ++k) {
    q[k] = load4(sums + k * kPairRows) + load4(sums + k * kPairRows + 4);
  }
  transpose4(q[0], q[1], q[2], q[3]);
  return (q[0] + q[2]) + (q[1] + q[3]);
}
inline void four_sums_of_rows(const float* sums, float* to) {
  store4(to, four_sums_of_eight(sums) + four_sums_of_eight(sums + kJointBlockRows));
}

/// One gradient, kColumnsTogether columns at a time.
template <class How, class Value>
inline void sum_columns_of_one(const JointTransposedArgs& args) {
  alignas(64) float sums[kColumnsTogether * kPairRows];
  const float* const rows = args.rows;
  const auto finish = [&](const RunPart<Value>& pairs, const JointRun& run, float* of_column) {
    add_pairs_of_column<How>(pairs, rows, of_column, std::make_index_sequence<kPairVecs>());
    const RunPart<Value> singles = singles_of<Value>(args, run);
    const Value* values = singles.values;
    for (const uint16_t* n = singles.numbers; n < singles.end; ++n, values += kJointBlockRows) {
      add_single<How>(values, rows_of_pair(rows, *n, 1) + half_of(*n), of_column + half_of(*n));
    }
  };
  size_t i = 0;
  for (; i + kColumnsTogether <= args.run_count; i += kColumnsTogether) {
    for (size_t c = 0; c < kColumnsTogether; c += kColumnStep) {
      RunPart<Value> parts[kColumnStep];
      for (size_t k = 0; k < kColumnStep; ++k) {
        parts[k] = pairs_of<Value>(args, args.runs[i + c + k]);
      }
      float* const of_step = sums + c * kPairRows;
      sum_columns_of_pairs<How>(parts, rows, of_step,
                                std::make_index_sequence<kColumnStep * kPairVecs>());
      for (size_t k = 0; k < kColumnStep; ++k) {
        finish(parts[k], args.runs[i + c + k], of_step + k * kPairRows);
      }
    }
    four_sums_of_rows(sums, args.outputs + i);
  }
  for (; i < args.run_count; ++i) {
    for (size_t r = 0; r < kPairRows; ++r) sums[r] = 0.0f;
    finish(pairs_of<Value>(args, args.runs[i]), args.runs[i], sums);
    args.outputs[i] = sum_of_rows(sums);
  }
}

/// kTransposedLanes gradients, one column at a time.
template <class How, class Value>
inline void sum_columns_of_lanes(const JointTransposedArgs& args) {
  alignas(64) float sums[kTransposedLanes * kPairRows];
  for (size_t i = 0; i < args.run_count; ++i) {
    const RunPart<Value> pairs = pairs_of<Value>(args, args.runs[i]);
    for (size_t k = 0; k < kTransposedLanes; k += kLaneStep) {
      sum_lanes_of_pairs<How>(pairs, args.rows + k * kPairRows, sums + k * kPairRows,
                              std::make_index_sequence<kLaneStep * kPairVecs>());
    }
    const RunPart<Value> singles = singles_of<Value>(args, args.runs[i]);
    const Value* values = singles.values;
    for (const uint16_t* n = singles.numbers; n < singles.end; ++n, values += kJointBlockRows) {
      const float* const from = rows_of_pair(args.rows, *n, kTransposedLanes) + half_of(*n);
      float* const to = sums + half_of(*n);
      for (size_t k = 0; k < kTransposedLanes * kPairRows; k += kPairRows) {
        add_single<How>(values, from + k, to + k);
      }
    }
    for (size_t k = 0; k < kTransposedLanes; k += 4) {
      four_sums_of_rows(sums + k * kPairRows, args.outputs + i * kTransposedLanes + k);
    }
  }
}

template <class How, class Value>
void sum_runs(const JointTransposedArgs& args) {
  args.lane_count == 1 ? sum_columns_of_one<How, Value>(args)
                       : sum_columns_of_lanes<How, Value>(args);
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
