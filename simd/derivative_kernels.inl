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
// its other half belongs to is known only when it is read, so its sums are in memory.

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

/// Pairs or single blocks of a run.
template <class Value>
struct RunPart {
  const Value* values;
  const uint16_t* numbers;
  size_t count;
};
template <class Value>
inline RunPart<Value> pairs_of(const JointTransposedArgs& args, const JointRun& run) {
  return {static_cast<const Value*>(args.values) + size_t{run.start.first_pair} * kJointBlockRows,
          args.block_rows + run.start.pair_entry, run.pair_count};
}
template <class Value>
inline RunPart<Value> singles_of(const JointTransposedArgs& args, const JointRun& run) {
  return {static_cast<const Value*>(args.values) + size_t{run.start.first_single} * kJointBlockRows,
          args.block_rows + run.start.single_entry, run.single_count};
}

/// The rows of the first lane for the pair that a block row belongs to, numbered as in JointColumnsArgs.
inline const float* rows_of_pair(const float* rows, size_t number, size_t lane_count) {
  return rows + (number & kPairBlockRows) / (2 * kBlockRowUnit) * (kPairRows * lane_count);
}
inline size_t half_of(size_t number) { return (number / kBlockRowUnit & 1) * kJointBlockRows; }

/// The sums of the first `count` pairs of columns and one gradient: a V per vector of 16 rows of each column.
template <class How, class Value, size_t... V>
inline void sum_columns_of_pairs(const RunPart<Value>* parts, size_t count, const float* rows,
                                 float* sums, std::index_sequence<V...>) {
  constexpr size_t kRows = InPairs::kRows;
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
}

/// Adds the pairs of a column from `first` on.
template <class How, class Value, size_t... V>
inline void add_pairs_of_column(const RunPart<Value>& part, size_t first, const float* rows,
                                float* sums, std::index_sequence<V...>) {
  if (first == part.count) return;
  constexpr size_t kRows = InPairs::kRows;
  InPairs::Rows sum[] = {InPairs::load(sums + V * kRows)...};
  for (size_t i = first; i < part.count; ++i) {
    const Value* const values = part.values + i * kPairRows;
    const float* const from = rows_of_pair(rows, part.numbers[i], 1);
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
  for (size_t i = 0; i < part.count; ++i) {
    const Value* const values = part.values + i * kPairRows;
    const float* const from = rows_of_pair(rows, part.numbers[i], kTransposedLanes);
    ((sum[V] = How::mul_add(InPairs::load_values(values + V % kPairVecs * kRows),
                            InPairs::load(from + V * kRows), sum[V])),
     ...);
  }
  (InPairs::store(sums + V * kRows, sum[V]), ...);
}

/// Adds a block without its other half: a C per column or lane.
template <class How, class Value, size_t... C>
inline void add_singles_of(const Value* const* values, const float* const* rows, float* const* sums,
                           std::index_sequence<C...>) {
  for (size_t r = 0; r < kJointBlockRows; r += kBlockWidth) {
    const BlockVec added[] = {How::mul_add(load_block(values[C] + r), load_block(rows[C] + r),
                                           load_block(sums[C] + r))...};
    (store_block(sums[C] + r, added[C]), ...);
  }
}

/// Adds single block `i` of each of these columns of one gradient.
template <class How, class Value, size_t... C>
inline void add_singles_of_columns(const RunPart<Value>* parts, const float* rows, float* sums,
                                   size_t i, std::index_sequence<C...> each) {
  const size_t numbers[] = {parts[C].numbers[i]...};
  const Value* const values[] = {parts[C].values + i * kJointBlockRows...};
  const float* const from[] = {rows_of_pair(rows, numbers[C], 1) + half_of(numbers[C])...};
  float* const to[] = {sums + C * kPairRows + half_of(numbers[C])...};
  add_singles_of<How>(values, from, to, each);
}

inline float sum_of_eight(const float* v) {
  const float a = v[0] + v[4], b = v[1] + v[5], c = v[2] + v[6], d = v[3] + v[7];
  return (a + c) + (b + d);
}
inline float sum_of_rows(const float* sums) {
  return sum_of_eight(sums) + sum_of_eight(sums + kJointBlockRows);
}

/// sum_of_rows() of four times 16 sums.
inline Quad halves_of_eight(const float* sums) { return load4(sums) + load4(sums + 4); }
inline Quad four_sums_of_eight(const float* sums) {
  Quad a = halves_of_eight(sums), b = halves_of_eight(sums + kPairRows);
  Quad c = halves_of_eight(sums + 2 * kPairRows), d = halves_of_eight(sums + 3 * kPairRows);
  transpose4(a, b, c, d);
  return (a + c) + (b + d);
}
inline void four_sums_of_rows(const float* sums, float* to) {
  store4(to, four_sums_of_eight(sums) + four_sums_of_eight(sums + kJointBlockRows));
}

inline size_t lesser_of(size_t a, size_t b) { return a < b ? a : b; }

/// The sums of one gradient and neighboring runs, one for each C.
template <class How, class Value, size_t... C>
inline void sum_columns_of_one(const JointTransposedArgs& args, const JointRun* runs, float* sums,
                               std::index_sequence<C...> each) {
  const float* const rows = args.rows;
  RunPart<Value> parts[] = {pairs_of<Value>(args, runs[C])...};
  size_t shared = runs[0].pair_count;
  ((shared = lesser_of(shared, runs[C].pair_count)), ...);
  sum_columns_of_pairs<How>(parts, shared, rows, sums,
                            std::make_index_sequence<sizeof...(C) * kPairVecs>());
  (add_pairs_of_column<How>(parts[C], shared, rows, sums + C * kPairRows,
                            std::make_index_sequence<kPairVecs>()),
   ...);
  ((parts[C] = singles_of<Value>(args, runs[C])), ...);
  shared = runs[0].single_count;
  ((shared = lesser_of(shared, runs[C].single_count)), ...);
  for (size_t i = 0; i < shared; ++i) add_singles_of_columns<How>(parts, rows, sums, i, each);
  const auto add_others = [&](const RunPart<Value>& part, float* of_column) {
    for (size_t i = shared; i < part.count; ++i) {
      add_singles_of_columns<How>(&part, rows, of_column, i, std::index_sequence<0>());
    }
  };
  (add_others(parts[C], sums + C * kPairRows), ...);
}

/// One gradient, kColumnsTogether columns at a time.
template <class How, class Value>
inline void sum_columns_of_one(const JointTransposedArgs& args) {
  alignas(64) float sums[kColumnsTogether * kPairRows];
  size_t i = 0;
  for (; i + kColumnsTogether <= args.run_count; i += kColumnsTogether) {
    for (size_t c = 0; c < kColumnsTogether; c += kColumnStep) {
      sum_columns_of_one<How, Value>(args, args.runs + i + c, sums + c * kPairRows,
                                     std::make_index_sequence<kColumnStep>());
    }
    four_sums_of_rows(sums, args.outputs + i);
  }
  for (; i < args.run_count; ++i) {
    sum_columns_of_one<How, Value>(args, args.runs + i, sums, std::index_sequence<0>());
    args.outputs[i] = sum_of_rows(sums);
  }
}

template <class How, class Value, size_t... K>
inline void add_single_of_lanes(const Value* values, const float* rows, float* sums,
                                std::index_sequence<K...> each) {
  const Value* const same[] = {(static_cast<void>(K), values)...};
  const float* const from[] = {rows + K * kPairRows...};
  float* const to[] = {sums + K * kPairRows...};
  add_singles_of<How>(same, from, to, each);
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
    for (size_t n = 0; n < singles.count; ++n) {
      const Value* const values = singles.values + n * kJointBlockRows;
      const size_t half = half_of(singles.numbers[n]);
      const float* const from =
          rows_of_pair(args.rows, singles.numbers[n], kTransposedLanes) + half;
      add_single_of_lanes<How>(values, from, sums + half,
                               std::make_index_sequence<kTransposedLanes>());
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
