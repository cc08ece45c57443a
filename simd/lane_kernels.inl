// SPDX-License-Identifier: MIT
// Arrays of many characters, to and from lanes: blocks of four by four, transposed.

#pragma once

#include "simd/lane_kernels.h"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

/// Columns of four rows into four lanes.
inline void gather_four(const float* const* from, size_t first, size_t end, float* to) {
  size_t i = first;
  for (; i + 4 <= end; i += 4) {
    Quad a = load4(from[0] + i), b = load4(from[1] + i);
    Quad c = load4(from[2] + i), d = load4(from[3] + i);
    transpose4(a, b, c, d);
    store4(to + i * kBatchLanes, a);
    store4(to + (i + 1) * kBatchLanes, b);
    store4(to + (i + 2) * kBatchLanes, c);
    store4(to + (i + 3) * kBatchLanes, d);
  }
  for (; i < end; ++i) {
    for (size_t k = 0; k < 4; ++k) to[i * kBatchLanes + k] = from[k][i];
  }
}

// Rows that are done at a time: their lanes stay in the first-level cache.
constexpr size_t kRowsAtOnce = 64;

void gather_lanes(const float* const* from, uint32_t lane_count, size_t count, float* to) {
  for (size_t first = 0; first < count; first += kRowsAtOnce) {
    const size_t end = first + kRowsAtOnce < count ? first + kRowsAtOnce : count;
    size_t k = 0;
    for (; k + 4 <= lane_count; k += 4) gather_four(from + k, first, end, to + k);
    for (; k < kBatchLanes; ++k) {
      for (size_t i = first; i < end; ++i) {
        to[i * kBatchLanes + k] = k < lane_count ? from[k][i] : 0.0f;
      }
    }
  }
}

/// Four lanes of rows into four arrays.
inline void scatter_four(const float* from, size_t first, size_t end, float* const* to,
                         size_t offset) {
  size_t i = first;
  for (; i + 4 <= end; i += 4) {
    const float* const rows = from + i * kBatchLanes;
    Quad a = load4(rows), b = load4(rows + kBatchLanes);
    Quad c = load4(rows + 2 * kBatchLanes), d = load4(rows + 3 * kBatchLanes);
    transpose4(a, b, c, d);
    store4(to[0] + offset + i, a);
    store4(to[1] + offset + i, b);
    store4(to[2] + offset + i, c);
    store4(to[3] + offset + i, d);
  }
  for (; i < end; ++i) {
    for (size_t k = 0; k < 4; ++k) to[k][offset + i] = from[i * kBatchLanes + k];
  }
}

void scatter_lanes(const float* from, size_t count, size_t lane_count, float* const* to,
                   size_t offset) {
  for (size_t first = 0; first < count; first += kRowsAtOnce) {
    const size_t end = first + kRowsAtOnce < count ? first + kRowsAtOnce : count;
    size_t k = 0;
    for (; k + 4 <= lane_count; k += 4) scatter_four(from + k, first, end, to + k, offset);
    for (; k < lane_count; ++k) {
      for (size_t i = first; i < end; ++i) to[k][offset + i] = from[i * kBatchLanes + k];
    }
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
