// SPDX-License-Identifier: MIT
// Joint matrix times controls, column by column.

#pragma once

#include <utility>  // index_sequence, a mere type

#include "simd/vec.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// A lane is a row and adds its columns in order, so no width changes a bit of the result. Sums stay
// in the first-level cache, so what is read from afar is the pieces, one behind the other.
//
// All pieces are read before the first is written: they belong to different blocks, which the
// processor cannot know.
template <class How, class Value, size_t... P>
inline void add_pieces(const Value* values, const uint16_t* blocks, PieceVec input, float* sums_in,
                       std::index_sequence<P...>) {
  float* const sums[] = {sums_in + size_t{blocks[P]} * (kPieceRows / kBlockUnit)...};
  for (size_t r = 0; r < kPieceRows; r += kPieceWidth) {
    const PieceVec added[] = {
        How::mul_add(load_piece(values + P * kPieceRows + r), input, load_piece(sums[P] + r))...};
    (store_piece(sums[P] + r, added[P]), ...);
  }
}

template <size_t kCount, class How, class Value>
inline void add_pieces(const Value* values, const uint16_t* blocks, PieceVec input, float* sums) {
  add_pieces<How>(values, blocks, input, sums, std::make_index_sequence<kCount>());
}

template <class How, class Value>
inline void add_columns(const JointColumnsArgs& args) {
  // In names of their own: for all the compiler knows, sums could lie in `args`.
  const Value* const all_values = static_cast<const Value*>(args.values);
  const uint16_t* const all_blocks = args.blocks;
  const uint32_t* const first_pieces = args.first_pieces;
  const uint16_t *const begins = args.begins, *const ends = args.ends;
  const uint16_t* const columns = args.columns;
  const float* const inputs = args.inputs;
  const size_t stride = args.stride, column_count = args.column_count;
  float* const sums = args.sums - size_t{args.first_block} * kPieceRows;

  for (size_t i = 0; i < column_count; ++i) {
    const size_t k = columns[i];
    const PieceVec input = broadcast_piece(inputs[i]);
    const size_t first = first_pieces[k] + size_t{begins[k * stride]};
    const size_t count = first_pieces[k] + size_t{ends[k * stride]} - first;
    const Value* values = all_values + first * kPieceRows;
    const uint16_t* blocks = all_blocks + first;
    size_t p = 0;
    for (; p + 4 <= count; p += 4) {
      add_pieces<4, How>(values + p * kPieceRows, blocks + p, input, sums);
    }
    for (; p < count; ++p) add_pieces<1, How>(values + p * kPieceRows, blocks + p, input, sums);
  }
}

template <class Value>
void add_columns(const JointColumnsArgs& args) {
  args.portable ? add_columns<AsPortable, Value>(args) : add_columns<AsFast, Value>(args);
}

void joint_columns(const JointColumnsArgs& args) { add_columns<float>(args); }
void joint_columns_fixed(const JointColumnsArgs& args) { add_columns<int16_t>(args); }

void finish_sums(float* sums, const float* scales, size_t count) {
  for (size_t i = 0; i < count; i += kPieceWidth) {
    PieceVec sum = load_piece(sums + i);
    if (scales) sum = sum * load_piece(scales + i);
    store_piece(sums + i, saturate(sum));
  }
}

// Lanes are characters here, and a block's 8 rows are sums in registers: two vectors each where
// there are registers for it, so that every value fetched is used twice.
#if defined(MIEN_KERNEL_AVX512) || defined(MIEN_KERNEL_NEON)
constexpr size_t kBatchVecs = 2;
#else
constexpr size_t kBatchVecs = 1;
#endif
constexpr size_t kBatchStep = kBatchVecs * kWidth;

inline const float* piece_values(const float* values, float*) { return values; }
inline const float* piece_values(const int16_t* values, float* made) {
  for (size_t r = 0; r < kPieceRows; r += kPieceWidth)
    store_piece(made + r, load_piece(values + r));
  return made;
}

template <class How, class Value, size_t... R>
inline void sum_block(const JointBatchArgs& args, size_t lane, std::index_sequence<R...>) {
  const Value* const values = static_cast<const Value*>(args.values);
  const float* const inputs = args.inputs + lane;
  const BatchPiece* const pieces = args.pieces;
  const size_t piece_count = args.piece_count;
  alignas(32) float made[kPieceRows];
  Vec a[] = {(static_cast<void>(R), broadcast(0.0f))...};
  Vec b[] = {(static_cast<void>(R), broadcast(0.0f))...};
  for (size_t i = 0; i < piece_count; ++i) {
    const float* const v = piece_values(values + size_t{pieces[i].piece} * kPieceRows, made);
    const float* const x = inputs + size_t{pieces[i].input} * kBatchLanes;
    const Vec xa = load(x);
    const Vec xb = load(x + (kBatchVecs - 1) * kWidth);
    ((a[R] = How::mul_add(broadcast(v[R]), xa, a[R])), ...);
    if constexpr (kBatchVecs == 2) ((b[R] = How::mul_add(broadcast(v[R]), xb, b[R])), ...);
  }
  if (args.scales) {
    ((a[R] = a[R] * broadcast(args.scales[R])), ...);
    ((b[R] = b[R] * broadcast(args.scales[R])), ...);
  }
  float* const sums = args.sums + lane;
  (store(sums + R * kBatchLanes, saturate(a[R])), ...);
  if constexpr (kBatchVecs == 2) (store(sums + R * kBatchLanes + kWidth, saturate(b[R])), ...);
}

template <class How, class Value>
inline void sum_block(const JointBatchArgs& args) {
  for (size_t lane = 0; lane < args.lane_count; lane += kBatchStep) {
    sum_block<How, Value>(args, lane, std::make_index_sequence<kPieceRows>());
  }
}

template <class Value>
void sum_block(const JointBatchArgs& args) {
  args.portable ? sum_block<AsPortable, Value>(args) : sum_block<AsFast, Value>(args);
}

void joint_batch(const JointBatchArgs& args) { sum_block<float>(args); }
void joint_batch_fixed(const JointBatchArgs& args) { sum_block<int16_t>(args); }

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
