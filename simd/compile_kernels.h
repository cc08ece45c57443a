// SPDX-License-Identifier: MIT
// Bulk operations of compiling a rig: big-endian floats of files, blocks of the joint matrix.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/joint_kernels.h"

namespace mien {

/// Rows of a file, which are big-endian floats at any address, to blocks of a joint matrix:
///
///     blocks[c][r] = rows[r][c]    for c < count
///
/// Infinities become the largest float of their sign, NaN the lowest. Reads nothing past the rows. Columns
/// may share a block; the last of them is kept.
struct BlockRowsArgs {
  const uint8_t* rows[kJointBlockRows];
  float* const* blocks;  // [column] 32-byte aligned
  size_t count;
};
using ReadBlockRowsKernel = void(const BlockRowsArgs& args);

/// mark_nonzeros: of consecutive rows of big-endian floats at any address: bit c % 64 of word c / 64 of each
/// row is set if the number in column c is neither 0 nor -0. Bits past the last column are 0.
using MarkNonzerosKernel = void(const uint8_t* values, size_t rows, size_t columns,
                                uint64_t* words);

/// largest_magnitude: the largest magnitude up to 3.4e38 of big-endian floats; larger ones, infinities and NaN
/// do not count.
using LargestMagnitudeKernel = float(const uint8_t* values, size_t count);

/// fix_blocks: blocks of a joint matrix in units of the scales of their rows, rounded to the nearest, at most
/// 32767 in magnitude; 0 where the scale is not positive. `count` is even; `blocks` and `fixed` are 64-byte
/// aligned.
using FixBlocksKernel = void(const float* blocks, const float* scales, size_t count,
                             int16_t* fixed);

}  // namespace mien
