// SPDX-License-Identifier: MIT
// Dense layers of neural networks, and their activations.

#pragma once

#include <utility>  // index_sequence, a type only

#include "simd/dense_kernels.h"
#include "simd/math.inl"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// Within 3e-7: 1 - 2 / (e^2|v| + 1), with the sign of v, written with e^-2|v|, which cannot
// overflow.
inline Vec hyperbolic_tangent(Vec v) {
  const Vec zero = broadcast(0.0f), one = broadcast(1.0f);
  const Vec minus = select(less(v, zero), v, zero - v);  // -|v|
  const Vec e = exp_of_negative(minus + minus);
  const Vec t = divide(one - e, one + e);
  return select(less(v, zero), zero - t, t);
}

inline Vec logistic(Vec v) {
  const Vec zero = broadcast(0.0f), one = broadcast(1.0f);
  const Vec e = exp_of_negative(select(less(v, zero), v, zero - v));  // e^-|v|
  return divide(select(less(v, zero), e, one), one + e);
}

inline Vec activate(Vec v, uint8_t function, Vec alpha) {
  const Vec zero = broadcast(0.0f);
  switch (function) {
    case 2: return select(less(v, zero), alpha * v, v);
    case 3: return hyperbolic_tangent(v);
    case 4: return logistic(v);
    default: return v;
  }
}

/// Adds the bias of a row, saturates, and applies max(0, v) if that is the activation. Other activations take
/// another pass over all rows.
struct Finish {
  Vec lowest, highest = broadcast(3.40282347e38f);
  explicit Finish(uint8_t function) : lowest(broadcast(function == 1 ? 0.0f : -3.40282347e38f)) {}
  Vec operator()(Vec sum, Vec bias) const { return at_most(at_least(sum + bias, lowest), highest); }
};
inline bool is_finished(uint8_t function) { return function < 2 || function > 4; }

inline Vec load_weights(const float* from) { return load(from); }
inline Vec load_weights(const uint16_t* from) { return load_half(from); }

void floats_from_halves(const uint16_t* from, size_t count, float* to) {
  for (size_t i = 0; i < count; i += kWidth) store(to + i, load_half(from + i));
}

/// Writes vectors because vectors are read: a read that covers several smaller writes waits until the last of
/// them has reached the cache.
void gather_inputs(const float* from, const uint16_t* at, size_t count, float* to) {
  size_t i = 0;
  for (; i + kWidth <= count; i += kWidth) store(to + i, gather(from, at + i));
  if (i == count) return;
  uint16_t last[kWidth] = {};
  for (size_t k = 0; i + k < count; ++k) last[k] = at[i + k];
  store(to + i, gather(from, last));
}

/// Separate rounding of products is rare, and does not use the code that skips inputs of 0.
template <class How>
constexpr bool kIsFast = false;
template <>
constexpr bool kIsFast<AsFast> = true;

/// Layers with more columns are summed over all of them.
constexpr size_t kMaxSparseColumns = 512;

/// Finds the inputs that are not 0: bit c % 64 of words[c / 64]. Returns whether any input is 0.
inline bool find_inputs(const float* inputs, size_t count, uint64_t* words) {
  if (count > kMaxSparseColumns) return false;
  uint64_t zeros = 0;
  for (size_t first = 0; first < count; first += 64) {
    const size_t left = count - first < 64 ? count - first : 64;
    uint64_t word = 0;
    for (size_t i = 0; i < left; i += kWidth) {
      const Vec size = absolute(load(inputs + first + i));
      word |= uint64_t{different_lanes(size, broadcast(0.0f))} << i;
    }
    const uint64_t all = ~uint64_t{0} >> (64 - left);
    words[first / 64] = word & all;
    zeros |= ~word & all;
  }
  return zeros != 0;
}

/// Whether to load four inputs at once, because loads are the bottleneck: one of weights for each
/// multiply-add, and those of inputs. Not for halves, unless on AVX2, where widening takes longer than
/// loading; and not for products that are rounded separately, which leave no register for the four.
template <class How, class Weight>
constexpr bool kByFour = kIsFast<How> && (sizeof(Weight) == sizeof(float) || kIsa == Isa::kAvx2);

/// The sums of sizeof...(K) neighboring vectors of rows in one pass over the columns, even and odd ones
/// separately: over those in `words`, or over all if it is null. The pack keeps each sum in its own register.
template <class How, class Weight, size_t... K>
inline void sum_rows(const Weight* values, const DenseLayerArgs& args, const uint64_t* words,
                     size_t first_vec, std::index_sequence<K...>) {
  const size_t column_count = args.column_count, block_size = column_count * kBlockLanes;
  const float* const inputs = args.inputs;
  const Weight* const rows[] = {values + (first_vec + K) / kVecsPerBlock * block_size +
                                (first_vec + K) % kVecsPerBlock * kWidth...};
  Vec even[] = {(static_cast<void>(K), broadcast(0.0f))...};
  Vec odd[] = {(static_cast<void>(K), broadcast(0.0f))...};
  const auto add = [&](size_t c, Vec input, auto& sums) {
    ((sums[K] = How::mul_add(load_weights(rows[K] + c * kBlockLanes), input, sums[K])), ...);
  };
  if (!kIsFast<How> || !words) {
    size_t c = 0;
    for (; kByFour<How, Weight> && c + 4 <= column_count; c += 4) {
      auto four = load_four(inputs + c);
      add(c, one_of<0>(four), even);
      take_after(four, even[sizeof...(K) - 1]);
      add(c + 1, one_of<1>(four), odd);
      take_after(four, odd[sizeof...(K) - 1]);
      add(c + 2, one_of<2>(four), even);
      take_after(four, even[sizeof...(K) - 1]);
      add(c + 3, one_of<3>(four), odd);
    }
    for (; c + 2 <= column_count; c += 2) {
      add(c, broadcast(inputs[c]), even);
      add(c + 1, broadcast(inputs[c + 1]), odd);
    }
    if (c < column_count) add(c, broadcast(inputs[c]), even);
  } else {
    constexpr uint64_t kEven = 0x5555'5555'5555'5555;
    const auto add_each = [&](size_t first, uint64_t bits, auto& sums) {
      for (; bits != 0; bits &= bits - 1) {
        const size_t c = first + static_cast<size_t>(__builtin_ctzll(bits));
        add(c, broadcast(inputs[c]), sums);
      }
    };
    for (size_t first = 0; first < column_count; first += 64) {
      add_each(first, words[first / 64] & kEven, even);
      add_each(first, words[first / 64] & ~kEven, odd);
    }
  }
  const Finish finish(args.function);
  (store(args.outputs + (first_vec + K) * kWidth,
         finish(even[K] + odd[K], load(args.biases + (first_vec + K) * kWidth))),
   ...);
}

// Two sums each and two inputs have to fit the registers; weights, too, except floats where instructions take
// them from memory. For halves, AVX2 has registers for more vectors, but that is slower.
#if defined(MIEN_KERNEL_AVX512) || defined(MIEN_KERNEL_NEON)
template <class Weight>
constexpr size_t kMaxVecs = 8;
#elif defined(MIEN_KERNEL_AVX2)
template <class Weight>
constexpr size_t kMaxVecs = sizeof(Weight) == sizeof(float) ? 7 : 4;
#else
template <class Weight>
constexpr size_t kMaxVecs = 6;
#endif

template <class How, class Weight>
void sum_layer(const Weight* values, const DenseLayerArgs& args) {
  uint64_t found[kMaxSparseColumns / 64];
  const uint64_t* words = nullptr;
  if (kIsFast<How> && args.sparse && find_inputs(args.inputs, args.column_count, found))
    words = found;
  const uint32_t vec_count = (args.row_count + kWidth - 1) / kWidth;
  const auto walk = [&](uint32_t v, auto vecs) { sum_rows<How>(values, args, words, v, vecs); };
  const auto walk_over = [&](uint32_t v, uint32_t count) {
    if constexpr (kMaxVecs < Weight >> 6) {
      if (count == 7) return walk(v, std::make_index_sequence<7>());
    }
    if constexpr (kMaxVecs < Weight >> 7) {
      if (count == 8) return walk(v, std::make_index_sequence<8>());
    }
    switch (count) {
      case 1: return walk(v, std::make_index_sequence<1>());
      case 2: return walk(v, std::make_index_sequence<2>());
      case 3: return walk(v, std::make_index_sequence<3>());
      case 4: return walk(v, std::make_index_sequence<4>());
      case 5: return walk(v, std::make_index_sequence<5>());
      case 6: return walk(v, std::make_index_sequence<6>());
      default: return;
    }
  };
  uint32_t walks = (vec_count + kMaxVecs<Weight> - 1) / kMaxVecs<Weight>;
  for (uint32_t v = 0; walks != 0; --walks) {
    const uint32_t left = vec_count - v;
    const uint32_t count = walks == 1 ? left : (left + walks - 1) / walks;  // in equal shares
    walk_over(v, count);
    v += count;
  }
}

template <class How>
void sum_layer(const DenseLayerArgs& args) {
  if (args.halves) {
    sum_layer<How>(static_cast<const uint16_t*>(args.values), args);
  } else {
    sum_layer<How>(static_cast<const float*>(args.values), args);
  }
}

void dense_layer(const DenseLayerArgs& args) {
  args.portable ? sum_layer<AsPortable>(args) : sum_layer<AsFast>(args);
  if (is_finished(args.function)) return;
  const Vec alpha = broadcast(args.alpha);
  for (size_t r = 0; r < args.row_count; r += kWidth) {
    store(args.outputs + r, saturate(activate(load(args.outputs + r), args.function, alpha)));
  }
}

// Batches: lanes are characters, and a weight is the same for all of them -----------------------------

/// The sums over every other column of neighboring rows (one for each R), for a pair of vectors of lanes.
template <class How, size_t... R>
inline void sum_columns(const float* weights, const float* inputs, size_t first_column,
                        size_t column_count, VecPair* sums, std::index_sequence<R...>) {
  VecPair sum[] = {(static_cast<void>(R), Make<VecPair>::of(0.0f))...};
  for (size_t c = first_column; c < column_count; c += 2) {
    const Vec a = load(inputs + c * kBatchLanes), b = load(inputs + c * kBatchLanes + kWidth);
    const float* const column = weights + c * kBlockLanes;
    // Row by row: compilers would load all weights first, which needs more registers than are left.
    const auto add = [&](VecPair& to, float value) {
      const Vec weight = broadcast(value);
      to.a = How::mul_add(weight, a, to.a);
      to.b = How::mul_add(weight, b, to.b);
    };
    (add(sum[R], column[R]), ...);
  }
  ((sums[R] = sum[R]), ...);
}

// Two vectors of sums for each row, two inputs and a weight have to fit the registers.
#if defined(MIEN_KERNEL_AVX512) || defined(MIEN_KERNEL_NEON)
constexpr size_t kMaxDenseRows = 8;
#else
constexpr size_t kMaxDenseRows = 6;
#endif

/// The rows from `row` on and the lanes from `lane` on; `weights` begin with those of the first row.
template <class How, size_t kRows>
inline void sum_batch_rows(const DenseBatchArgs& args, const float* weights, size_t row,
                           size_t lane, const Finish& finish) {
  constexpr std::make_index_sequence<kRows> kEach;
  VecPair even[kRows], odd[kRows];
  sum_columns<How>(weights, args.inputs + lane, 0, args.column_count, even, kEach);
  sum_columns<How>(weights, args.inputs + lane, 1, args.column_count, odd, kEach);
  for (size_t r = 0; r < kRows; ++r) {
    const VecPair sum = even[r] + odd[r];
    const Vec bias = broadcast(args.biases[row + r]);
    store(args.outputs + (row + r) * kBatchLanes + lane,
          VecPair{finish(sum.a, bias), finish(sum.b, bias)});
  }
}

/// There are more independent sums than multiply-adds that a core has in flight.
template <class How>
void sum_batch(const DenseBatchArgs& args) {
  const Finish finish(args.function);
  for (size_t block = 0; block < args.row_count; block += kBlockLanes) {
    const float* weights = args.values + block * args.column_count;
    const size_t end = block + kBlockLanes < args.row_count ? block + kBlockLanes : args.row_count;
    for (size_t row = block; row < end;) {
      const bool many = end - row > 4;  // computes no rows past the block
      for (size_t lane = 0; lane < args.lane_count; lane += 2 * kWidth) {
        if (many) {
          sum_batch_rows<How, kMaxDenseRows>(args, weights, row, lane, finish);
        } else {
          sum_batch_rows<How, 4>(args, weights, row, lane, finish);
        }
      }
      weights += many ? kMaxDenseRows : 4;
      row += many ? kMaxDenseRows : 4;
    }
  }
}

void dense_batch(const DenseBatchArgs& args) {
  args.portable ? sum_batch<AsPortable>(args) : sum_batch<AsFast>(args);
  if (is_finished(args.function)) return;
  const Vec alpha = broadcast(args.alpha);
  for (size_t r = 0; r < args.row_count; ++r) {
    for (size_t lane = 0; lane < args.lane_count; lane += kWidth) {
      float* const at = args.outputs + r * kBatchLanes + lane;
      store(at, saturate(activate(load(at), args.function, alpha)));
    }
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
