// SPDX-License-Identifier: MIT
// Bulk operations of compiling a rig.

#pragma once

#include "simd/compile_kernels.h"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

// Blocks of a joint matrix ------------------------------------------------------------------------

/// Four columns of the rows, starting `offset` bytes into each row.
[[gnu::always_inline]] inline void read_four_columns(const uint8_t* const* rows, size_t offset,
                                                     float* const* blocks) {
  const auto read = [=](size_t r) {
    return saturate_pair4(load_big_endian_pair4(rows[r] + offset, rows[r + 4] + offset));
  };
  QuadPair a = read(0), b = read(1), c = read(2), d = read(3);
  transpose_pair4(a, b, c, d);
  store_pair4(blocks[0], a);
  store_pair4(blocks[1], b);
  store_pair4(blocks[2], c);
  store_pair4(blocks[3], d);
}

void read_block_rows(const BlockRowsArgs& given) {
  static_assert(kJointBlockRows == 8, "two quads");
  const BlockRowsArgs args = given;  // a local copy: no store can alias it
  constexpr size_t kBytes = sizeof(float);
  size_t c = 0;
  for (; c + 4 <= args.count; c += 4) {
    read_four_columns(args.rows, c * kBytes, args.blocks + c);
  }
  if (c == args.count) return;
  if (c != 0) {  // some columns twice
    c = args.count - 4;
    return read_four_columns(args.rows, c * kBytes, args.blocks + c);
  }
  uint8_t ends[kJointBlockRows][4 * kBytes] = {};
  const uint8_t* rows[kJointBlockRows];
  alignas(32) float unused[kJointBlockRows];
  float* blocks[4] = {unused, unused, unused, unused};
  for (size_t i = 0; i < args.count; ++i) blocks[i] = args.blocks[i];
  for (size_t r = 0; r < kJointBlockRows; ++r) {
    __builtin_memcpy(ends[r], args.rows[r], args.count * kBytes);
    rows[r] = ends[r];
  }
  read_four_columns(rows, 0, blocks);
}

void fix_blocks(const float* blocks, const float* scales, size_t count, int16_t* fixed) {
  constexpr size_t kPeriod = kWidth > kJointBlockRows ? kWidth : kJointBlockRows;
  alignas(64) float repeated[kPeriod];
  for (size_t i = 0; i < kPeriod; ++i) repeated[i] = scales[i % kJointBlockRows];
  for (size_t i = 0; i < count * kJointBlockRows; i += kPeriod) {
    for (size_t k = 0; k < kPeriod; k += kWidth) {
      const Vec scale = load(repeated + k);
      const Vec steps = divide(load(blocks + i + k), scale);
      const Vec within = at_most(at_least(steps, broadcast(-32767.0f)), broadcast(32767.0f));
      store_fixed(fixed + i + k, keep(less(broadcast(0.0f), scale), nearest_whole(within)));
    }
  }
}

// Numbers of a file -------------------------------------------------------------------------------

void mark_nonzeros(const uint8_t* values, size_t rows, size_t columns, uint64_t* words) {
  constexpr size_t kBytes = sizeof(float), kHalf = 32;
  const uint8_t* const begin = values;
  // Reads `count` numbers at `values` and advances past them.
  const auto take = [&](size_t count) -> uint64_t {
    const uint8_t* const from = values;
    values += count * kBytes;
    if (count == kHalf) return nonzero_of_file(from);
    const size_t missing = kHalf - count;
    // Together with the numbers before them, if there are enough.
    if (static_cast<size_t>(from - begin) >= missing * kBytes) {
      return nonzero_of_file(from - missing * kBytes) >> missing;
    }
    uint8_t copy[kHalf * kBytes] = {};
    __builtin_memcpy(copy, from, count * kBytes);
    return nonzero_of_file(copy);
  };
  for (size_t r = 0; r < rows; ++r) {
    size_t left = columns;
    for (; left >= 2 * kHalf; left -= 2 * kHalf) {
      const uint64_t low = take(kHalf);
      *words++ = low | take(kHalf) << kHalf;
    }
    if (left == 0) continue;
    uint64_t word = take(left < kHalf ? left : kHalf);
    if (left > kHalf) word |= take(left - kHalf) << kHalf;
    *words++ = word;
  }
}

float largest_magnitude(const uint8_t* values, size_t count) {
  constexpr size_t kBytes = sizeof(float);
  constexpr float kTooLarge = 0x1.ff933ep+127f;  // the float after 3.4e38
  Vec largest = broadcast(0.0f);
  const auto look = [&](const uint8_t* from) {
    const Vec size = absolute(load_big_endian(from));
    largest = at_least(keep(less(size, broadcast(kTooLarge)), size), largest);
  };
  size_t i = 0;
  for (; i + kWidth <= count; i += kWidth) look(values + i * kBytes);
  if (i < count) {
    uint8_t end[kWidth * kBytes] = {};
    __builtin_memcpy(end, values + i * kBytes, (count - i) * kBytes);
    look(end);
  }
  alignas(64) float lanes[kWidth];
  store(lanes, largest);
  for (float lane : lanes) lanes[0] = higher_of(lane, lanes[0]);
  return lanes[0];
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
