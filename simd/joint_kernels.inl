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
template <class Value, size_t... P>
inline void add_pieces(const Value* values, const uint16_t* blocks, PieceVec input, float* sums_in,
                       std::index_sequence<P...>) {
  float* const sums[] = {sums_in + size_t{blocks[P]} * (kPieceRows / kBlockUnit)...};
  for (size_t r = 0; r < kPieceRows; r += kPieceWidth) {
    const PieceVec added[] = {
        mul_add(load_piece(values + P * kPieceRows + r), input, load_piece(sums[P] + r))...};
    (store_piece(sums[P] + r, added[P]), ...);
  }
}

template <size_t kCount, class Value>
inline void add_pieces(const Value* values, const uint16_t* blocks, PieceVec input, float* sums) {
  add_pieces(values, blocks, input, sums, std::make_index_sequence<kCount>());
}

template <class Value>
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
      add_pieces<4>(values + p * kPieceRows, blocks + p, input, sums);
    }
    for (; p < count; ++p) add_pieces<1>(values + p * kPieceRows, blocks + p, input, sums);
  }
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

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
