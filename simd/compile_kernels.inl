// SPDX-License-Identifier: MIT
// What compiling a rig does to many numbers.

#pragma once

#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

inline Quad saturate4(const Quad& q) {
  constexpr float kLargest = 3.40282347e38f;
  return lower4(higher4(q, broadcast4(-kLargest)), broadcast4(kLargest));
}

/// Four columns of the rows, `offset` bytes behind their beginnings.
inline void read_four_columns(const uint8_t* const* rows, size_t offset, float* blocks) {
  for (size_t r = 0; r < kJointBlockRows; r += 4) {
    Quad a = saturate4(load_big_endian4(rows[r] + offset));
    Quad b = saturate4(load_big_endian4(rows[r + 1] + offset));
    Quad c = saturate4(load_big_endian4(rows[r + 2] + offset));
    Quad d = saturate4(load_big_endian4(rows[r + 3] + offset));
    transpose4(a, b, c, d);
    store4(blocks + r, a);
    store4(blocks + kJointBlockRows + r, b);
    store4(blocks + 2 * kJointBlockRows + r, c);
    store4(blocks + 3 * kJointBlockRows + r, d);
  }
}

void read_block_rows(const BlockRowsArgs& given) {
  const BlockRowsArgs args = given;  // a local copy: no store can alias it
  constexpr size_t kBytes = sizeof(float);
  size_t c = 0;
  for (; c + 4 <= args.count; c += 4) {
    read_four_columns(args.rows, c * kBytes, args.blocks + c * kJointBlockRows);
  }
  if (c == args.count) return;
  uint8_t ends[kJointBlockRows][4 * kBytes] = {};
  const uint8_t* rows[kJointBlockRows];
  float blocks[4 * kJointBlockRows];
  const size_t rest = args.count - c;
  for (size_t r = 0; r < kJointBlockRows; ++r) {
    __builtin_memcpy(ends[r], args.rows[r] + c * kBytes, rest * kBytes);
    rows[r] = ends[r];
  }
  read_four_columns(rows, 0, blocks);
  __builtin_memcpy(args.blocks + c * kJointBlockRows, blocks, rest * kJointBlockRows * kBytes);
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
