// SPDX-License-Identifier: MIT
// Joint matrix times controls, column by column.

#pragma once

#include <utility>  // index_sequence, a type only

#include "simd/joint_kernels.h"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// A lane is a row and adds its columns in order, so the width of vectors does not change the result. Sums
// stay in the L1 cache; only the values come from farther away, and they are read in sequence.
//
// The time goes into three accesses of the L1 cache per block: reading values, reading sums and writing them.
// So block row numbers are loaded four at a time, and a pair is one vector where vectors are that wide. All
// sums are read before the first is written: they belong to different block rows, which the processor cannot
// know.

/// The sums of a block row.
inline float* sums_of(float* sums, size_t number) {
  return sums + number * (kJointBlockRows / kBlockRowUnit);
}

/// Four block row numbers, loaded at once.
struct FourBlockRows {
  uint64_t numbers;
  explicit FourBlockRows(const uint16_t* from) {
    __builtin_memcpy(&numbers, from, sizeof(numbers));
  }
  static FourBlockRows of_pairs(const uint16_t* from) {
    FourBlockRows four(from);
    four.numbers &= kPairBlockRows * uint64_t{0x0001'0001'0001'0001};
    return four;
  }
  size_t operator[](size_t i) const {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    i = 3 - i;
#endif
    return numbers >> 16 * i & 0xFFFF;
  }
};

template <class How, class Value, size_t... P>
inline void add_blocks(const Value* values, float* const* sums, BlockVec input,
                       std::index_sequence<P...>) {
  for (size_t r = 0; r < kJointBlockRows; r += kBlockWidth) {
    const BlockVec added[] = {How::mul_add(load_block(values + P * kJointBlockRows + r), input,
                                           load_block(sums[P] + r))...};
    (store_block(sums[P] + r, added[P]), ...);
  }
}

template <class How, class Value, size_t... P>
inline void add_last_singles(const Value* values, const uint16_t* block_rows, float* sums,
                             BlockVec input, std::index_sequence<P...> each) {
  float* const to[] = {sums_of(sums, block_rows[P])...};
  add_blocks<How>(values, to, input, each);
}

template <class How, class Value>
inline void add_singles(const Value* values, const uint16_t* block_rows, size_t count, float* sums,
                        BlockVec input) {
  size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const FourBlockRows b(block_rows + i);
    float* const four[] = {sums_of(sums, b[0]), sums_of(sums, b[1]), sums_of(sums, b[2]),
                           sums_of(sums, b[3])};
    add_blocks<How>(values + i * kJointBlockRows, four, input, std::make_index_sequence<4>());
  }
  const auto add_last = [&](auto each) {
    add_last_singles<How>(values + i * kJointBlockRows, block_rows + i, sums, input, each);
  };
  switch (count - i) {
    case 1: add_last(std::make_index_sequence<1>()); break;
    case 2: add_last(std::make_index_sequence<2>()); break;
    case 3: add_last(std::make_index_sequence<3>()); break;
    default: break;
  }
}

#if defined(MIEN_KERNEL_AVX512)

template <class How, class Value, size_t... P>
inline void add_pairs(const Value* values, float* const* sums, Vec input,
                      std::index_sequence<P...>) {
  const Vec added[] = {
      How::mul_add(load_pair(values + P * 2 * kJointBlockRows), input, load(sums[P]))...};
  (store(sums[P], added[P]), ...);
}

template <class How, class Value>
inline void add_pairs(const Value* values, const uint16_t* block_rows, size_t count, float* sums,
                      float input_value) {
  const Vec input = broadcast(input_value);
  size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const FourBlockRows b = FourBlockRows::of_pairs(block_rows + i);
    float* const four[] = {sums_of(sums, b[0]), sums_of(sums, b[1]), sums_of(sums, b[2]),
                           sums_of(sums, b[3])};
    add_pairs<How>(values + i * 2 * kJointBlockRows, four, input, std::make_index_sequence<4>());
  }
  for (; i < count; ++i) {
    float* const one[] = {sums_of(sums, block_rows[i] & kPairBlockRows)};
    add_pairs<How>(values + i * 2 * kJointBlockRows, one, input, std::make_index_sequence<1>());
  }
}

#else

template <class How, class Value, size_t... P>
inline void add_last_pairs(const Value* values, const uint16_t* block_rows, float* sums,
                           BlockVec input, std::index_sequence<P...>) {
  float* const to[] = {sums_of(sums, block_rows[P] & kPairBlockRows)...};
  float* const both[] = {
      (to[P / 2] + P % 2 * kJointBlockRows)...,
      (to[(P + sizeof...(P)) / 2] + (P + sizeof...(P)) % 2 * kJointBlockRows)...};
  add_blocks<How>(values, both, input, std::make_index_sequence<2 * sizeof...(P)>());
}

template <class How, class Value>
inline void add_pairs(const Value* values, const uint16_t* block_rows, size_t count, float* sums,
                      float input_value) {
  const BlockVec input = broadcast_block(input_value);
  size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const FourBlockRows n = FourBlockRows::of_pairs(block_rows + i);
    float *const a = sums_of(sums, n[0]), *const b = sums_of(sums, n[1]);
    float* const four[] = {a, a + kJointBlockRows, b, b + kJointBlockRows};
    add_blocks<How>(values + i * 2 * kJointBlockRows, four, input, std::make_index_sequence<4>());
    float *const c = sums_of(sums, n[2]), *const d = sums_of(sums, n[3]);
    float* const others[] = {c, c + kJointBlockRows, d, d + kJointBlockRows};
    add_blocks<How>(values + (i + 2) * 2 * kJointBlockRows, others, input,
                    std::make_index_sequence<4>());
  }
  const auto add_last = [&](auto each) {
    add_last_pairs<How>(values + i * 2 * kJointBlockRows, block_rows + i, sums, input, each);
  };
  switch (count - i) {
    case 1: add_last(std::make_index_sequence<1>()); break;
    case 2: add_last(std::make_index_sequence<2>()); break;
    case 3: add_last(std::make_index_sequence<3>()); break;
    default: break;
  }
}

#endif

template <class How, class Value>
inline void add_columns(const JointColumnsArgs& args) {
  // Local copies, because the compiler must assume that writes to the sums alias `args`.
  const Value* const values = static_cast<const Value*>(args.values);
  const uint16_t* const block_rows = args.block_rows;
  float* const sums = args.sums;
  const JointRun* const end = args.runs + args.run_count;
  for (const JointRun* run = args.runs; run < end; ++run) {
    add_pairs<How>(values + size_t{run->start.first_pair} * kJointBlockRows,
                   block_rows + run->start.pair_entry, run->pair_count, sums, run->input);
    add_singles<How>(values + size_t{run->start.first_single} * kJointBlockRows,
                     block_rows + run->start.single_entry, run->single_count, sums,
                     broadcast_block(run->input));
  }
}

template <class Value>
void add_columns(const JointColumnsArgs& args) {
  args.portable ? add_columns<AsPortable, Value>(args) : add_columns<AsFast, Value>(args);
}

void joint_columns(const JointColumnsArgs& args) { add_columns<float>(args); }
void joint_columns_fixed(const JointColumnsArgs& args) { add_columns<int16_t>(args); }

// Here sums stay in registers, and only values and inputs are read, including zeros: for small matrices most
// of whose columns are in use.

/// The rows of a strip as vectors.
struct InBlocks {
  using Rows = BlockVec;
  static constexpr size_t kRows = kBlockWidth;
  static Rows broadcast(float value) { return broadcast_block(value); }
  static Rows load(const float* from) { return load_block(from); }
  template <class Value>
  static Rows load_values(const Value* from) {
    return load_block(from);
  }
  static void store(float* to, Rows sums) { store_block(to, sums); }
};
#if defined(MIEN_KERNEL_AVX512)
struct InPairs {
  using Rows = Vec;
  static constexpr size_t kRows = kWidth;
  static Rows broadcast(float value) { return avx512::broadcast(value); }
  static Rows load(const float* from) { return Rows::load_unaligned(from); }
  template <class Value>
  static Rows load_values(const Value* from) {
    return load_pair(from);
  }
  static void store(float* to, Rows sums) { sums.store_unaligned(to); }
};
#else
using InPairs = InBlocks;
#endif

template <class In, size_t kBlockRows>
using VecsOf = std::make_index_sequence<kBlockRows * kJointBlockRows / In::kRows>;

/// One V per vector of neighboring rows; the values of the next input are `stride` later.
template <class How, class In, class Value, size_t... V>
inline void sum_strip(const Value* values, size_t stride, const uint16_t* inputs, size_t count,
                      const float* controls, float* sums, std::index_sequence<V...>) {
  using Rows = typename In::Rows;
  Rows sum[] = {In::load(sums + V * In::kRows)...};
  for (size_t i = 0; i < count; ++i, values += stride) {
    const Rows input = In::broadcast(controls[inputs[i]]);
    ((sum[V] = How::mul_add(In::load_values(values + V * In::kRows), input, sum[V])), ...);
  }
  (In::store(sums + V * In::kRows, sum[V]), ...);
}

template <class How, class Value>
inline void sum_strips(const JointStripsArgs& args) {
  for (const RowStrip* strip = args.strips; strip != args.strips + args.strip_count; ++strip) {
    const size_t block_rows = strip[1].first_block_row - strip->first_block_row;
    const size_t stride = block_rows * kJointBlockRows;
    const Value* values =
        static_cast<const Value*>(args.values) + size_t{strip->first_block} * kJointBlockRows;
    const uint16_t* const inputs = args.inputs + strip->first_input;
    const size_t input_count = strip[1].first_input - strip->first_input;
    float* sums = args.sums + size_t{strip->first_block_row} * kJointBlockRows;
    const auto sum = [&](auto in, auto each) {
      sum_strip<How, decltype(in)>(values, stride, inputs, input_count, args.controls, sums, each);
    };
    if constexpr (kWidth == 1) {
      // The sums of one block row fit the registers.
      for (size_t b = 0; b < block_rows; ++b, values += kJointBlockRows, sums += kJointBlockRows) {
        sum(InBlocks(), VecsOf<InBlocks, 1>());
      }
    } else {
      switch (block_rows) {
        case 1: sum(InBlocks(), VecsOf<InBlocks, 1>()); break;
        case 2: sum(InPairs(), VecsOf<InPairs, 2>()); break;
        case 3: sum(InBlocks(), VecsOf<InBlocks, 3>()); break;
        case 4: sum(InPairs(), VecsOf<InPairs, 4>()); break;
        case 5: sum(InBlocks(), VecsOf<InBlocks, 5>()); break;
        default: sum(InPairs(), VecsOf<InPairs, kMaxStripBlockRows>()); break;
      }
    }
  }
}

template <class Value>
void sum_strips(const JointStripsArgs& args) {
  args.portable ? sum_strips<AsPortable, Value>(args) : sum_strips<AsFast, Value>(args);
}

void joint_strips(const JointStripsArgs& args) { sum_strips<float>(args); }
void joint_strips_fixed(const JointStripsArgs& args) { sum_strips<int16_t>(args); }

inline Vec finished(Vec sum) { return saturate(sum) + broadcast(0.0f); }

// Turns -0 into 0: in a batch, a character that does not use a column adds 0 times its values.
void finish_sums(float* sums, const float* scales, size_t count) {
  for (size_t i = 0; i < count; i += kWidth) {
    Vec sum = load(sums + i);
    if (scales) sum = sum * load(scales + i);
    store(sums + i, finished(sum));
  }
}

/// Calls f(i) for the members of a word of a set.
template <class F>
inline void for_each_in_word(uint64_t bits, F&& f) {
  if (bits == ~uint64_t{0}) {
    for (size_t i = 0; i < 64; ++i) f(i);
    return;
  }
  for (; bits != 0; bits &= bits - 1) f(static_cast<size_t>(__builtin_ctzll(bits)));
}

/// Finishes and writes the runs of kRows rows.
template <bool kScaled, size_t kRows>
inline void write_runs(const FinishRunsArgs& args) {
  // Local copies, because the compiler must assume that writes alias `args`.
  const float *const sums = args.sums, *const scales = args.scales;
  const uint32_t* const rows = args.rows;
  const uint16_t* const outputs = args.outputs;
  float* const to = args.to;
  const Quad zero = broadcast4(0.0f);
  const auto write4 = [&](size_t row, float* out) {
    Quad sum = load4(sums + row);
    if constexpr (kScaled) sum = sum * load4(scales + row);
    store4(out, sum + zero);
  };
  const auto write2 = [&](size_t row, float* out) {
    Quad sum = load2(sums + row);
    if constexpr (kScaled) sum = sum * load2(scales + row);
    store2(out, sum + zero);
  };
  const auto write1 = [&](size_t row, float* out) {
    *out = (kScaled ? sums[row] * scales[row] : sums[row]) + 0.0f;
  };
  for (uint32_t w = args.first_words[kRows - 1]; w < args.first_words[kRows]; ++w) {
    for_each_in_word(args.runs[w], [&](size_t i) {
      const size_t row = rows[size_t{w} * 64 + i];
      float* const out = to + outputs[size_t{w} * 64 + i];
      if constexpr (kRows >= 4) {
        write4(row, out);
        // The last four; some of them twice.
        if constexpr (kRows > 4) write4(row + kRows - 4, out + kRows - 4);
      } else {
        if constexpr (kRows > 1) write2(row, out);
        if constexpr (kRows != 2) write1(row + kRows - 1, out + kRows - 1);
      }
    });
  }
}

template <bool kScaled, size_t... R>
inline void finish_runs_by(const FinishRunsArgs& args, std::index_sequence<R...>) {
  (write_runs<kScaled, R + 1>(args), ...);
}

void finish_runs(const FinishRunsArgs& args) {
  const auto lengths = std::make_index_sequence<kMaxRunRows>();
  args.scales ? finish_runs_by<true>(args, lengths) : finish_runs_by<false>(args, lengths);
}

// Lanes are characters here, and the 8 rows of a block row are sums in registers. With 32 registers there are
// two vectors for each row; 16 have room for four such rows, so the others come in a second pass.
#if defined(MIEN_KERNEL_AVX512) || defined(MIEN_KERNEL_NEON)
constexpr size_t kBatchVecs = 2, kBatchRows = kJointBlockRows;
#elif defined(MIEN_KERNEL_SCALAR)
constexpr size_t kBatchVecs = 1, kBatchRows = kJointBlockRows;
#else
constexpr size_t kBatchVecs = 2, kBatchRows = kJointBlockRows / 2;
#endif
constexpr size_t kBatchStep = kBatchVecs * kWidth;

inline const float* block_values(const float* values, float*) { return values; }
inline const float* block_values(const int16_t* values, float* made) {
  for (size_t r = 0; r < kJointBlockRows; r += kBlockWidth) {
    store_block(made + r, load_block(values + r));
  }
  return made;
}

/// The rows from `first` on of the lanes from `lane` on, one for each R.
template <class How, class Value, size_t... R>
inline void sum_block_row(const JointBatchArgs& args, size_t first, size_t lane, float* sums,
                          size_t stride, std::index_sequence<R...>) {
  const Value* const values = static_cast<const Value*>(args.values);
  const float* const inputs = args.inputs + lane;
  const InputBlock* const blocks = args.blocks;
  const size_t block_count = args.block_count;
  alignas(32) float made[kJointBlockRows];
  Vec a[] = {(static_cast<void>(R), broadcast(0.0f))...};
  Vec b[] = {(static_cast<void>(R), broadcast(0.0f))...};
  for (size_t i = 0; i < block_count; ++i) {
    __builtin_prefetch(values + size_t{blocks[i + kBatchAhead].block} * kJointBlockRows);
    const float* const v =
        block_values(values + size_t{blocks[i].block} * kJointBlockRows, made) + first;
    const float* const x = inputs + size_t{blocks[i].input} * kBatchLanes;
    const Vec xa = load(x), xb = load(x + (kBatchVecs - 1) * kWidth);
    const Vec row[] = {broadcast(v[R])...};
    ((a[R] = How::mul_add(row[R], xa, a[R])), ...);
    if constexpr (kBatchVecs == 2) ((b[R] = How::mul_add(row[R], xb, b[R])), ...);
  }
  if (args.finish) {
    const auto finish = [&](size_t r, Vec sum) {
      return finished(args.scales ? sum * broadcast(args.scales[first + r]) : sum);
    };
    ((a[R] = finish(R, a[R])), ...);
    if constexpr (kBatchVecs == 2) ((b[R] = finish(R, b[R])), ...);
  }
  // [row][lane]
  (store(sums + R * stride, a[R]), ...);
  if constexpr (kBatchVecs == 2) (store(sums + R * stride + kWidth, b[R]), ...);
}

template <class How, class Value>
inline void sum_block_row(const JointBatchArgs& args) {
  alignas(64) float rows[kJointBlockRows * kBatchStep];
  const size_t stride = args.stride, lane_count = args.lane_count;
  for (size_t lane = 0; lane < lane_count; lane += kBatchStep) {
    const size_t row_stride = args.finish ? size_t{kBatchLanes} : kBatchStep;
    float* const summed = args.finish ? args.sums + lane : rows;
    for (size_t r = 0; r < kJointBlockRows; r += kBatchRows) {
      sum_block_row<How, Value>(args, r, lane, summed + r * row_stride, row_stride,
                                std::make_index_sequence<kBatchRows>());
    }
    if (args.finish) continue;
    // Transposes rows into characters.
    float* const sums = args.sums + lane * stride;
    if constexpr (kBatchStep == 1) {
      for (size_t r = 0; r < kJointBlockRows; ++r) sums[r] = rows[r];
    } else {
      for (size_t k = 0; k < kBatchStep; k += 4) {
        for (size_t r = 0; r < kJointBlockRows; r += 4) {
          const float* const from = rows + r * kBatchStep + k;
          Quad q0 = load4(from), q1 = load4(from + kBatchStep), q2 = load4(from + 2 * kBatchStep),
               q3 = load4(from + 3 * kBatchStep);
          transpose4(q0, q1, q2, q3);
          float* const to = sums + k * stride + r;
          store4(to, q0);
          store4(to + stride, q1);
          store4(to + 2 * stride, q2);
          store4(to + 3 * stride, q3);
        }
      }
    }
  }
}

template <class Value>
void sum_block_row(const JointBatchArgs& args) {
  args.portable ? sum_block_row<AsPortable, Value>(args) : sum_block_row<AsFast, Value>(args);
}

void joint_batch(const JointBatchArgs& args) { sum_block_row<float>(args); }
void joint_batch_fixed(const JointBatchArgs& args) { sum_block_row<int16_t>(args); }

/// Four lanes of four rows, transposed: the four rows of each lane.
struct FourRows {
  Quad lanes[4];
  explicit FourRows(const float* sums)
      : lanes{load4(sums), load4(sums + kBatchLanes), load4(sums + 2 * kBatchLanes),
              load4(sums + 3 * kBatchLanes)} {
    transpose4(lanes[0], lanes[1], lanes[2], lanes[3]);
  }
};

template <size_t kRows>
inline void scatter_target(const float* sums, size_t output, size_t lane_count, float* const* to) {
  size_t k = 0;
  for (; k + 4 <= lane_count; k += 4) {
    if constexpr (kRows == 6) {
      const FourRows first(sums + k), last(sums + 2 * kBatchLanes + k);  // two rows are in both
      for (size_t i = 0; i < 4; ++i) {
        store4(to[k + i] + output, first.lanes[i]);
        store4(to[k + i] + output + 2, last.lanes[i]);
      }
    } else if constexpr (kRows == 3) {
      Quad a = load4(sums + k), b = load4(sums + kBatchLanes + k);
      Quad c = load4(sums + 2 * kBatchLanes + k), d = c;
      transpose4(a, b, c, d);
      store3(to[k] + output, a);
      store3(to[k + 1] + output, b);
      store3(to[k + 2] + output, c);
      store3(to[k + 3] + output, d);
    } else {
      for (size_t i = 0; i < 4; ++i) to[k + i][output] = sums[k + i];
    }
  }
  for (; k < lane_count; ++k) {
    for (size_t r = 0; r < kRows; ++r) to[k][output + r] = sums[r * kBatchLanes + k];
  }
}

template <size_t kRows>
inline void scatter_each(const ScatterTargetsArgs& args) {
  float* to[kBatchLanes];  // a local copy: the compiler need not assume that joint values alias it
  for (size_t k = 0; k < args.lane_count; ++k) to[k] = args.to[k];
  const size_t lane_count = args.lane_count;
  const float* const sums = args.sums;
  const JointTarget* const end = args.targets + args.count;
  for (const JointTarget* target = args.targets; target != end; ++target) {
    scatter_target<kRows>(sums + size_t{target->packed_row} * kBatchLanes, target->output,
                          lane_count, to);
  }
}

void scatter_targets(const ScatterTargetsArgs& args) {
  switch (args.rows) {
    case 6: return scatter_each<6>(args);
    case 3: return scatter_each<3>(args);
    default: return scatter_each<1>(args);
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
