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

void gather_lanes(const float* const* from, uint32_t lane_count, size_t count, float* to) {
  constexpr size_t kColumns = 64;  // at a time: their lanes stay in the first-level cache
  for (size_t first = 0; first < count; first += kColumns) {
    const size_t end = first + kColumns < count ? first + kColumns : count;
    size_t k = 0;
    for (; k + 4 <= lane_count; k += 4) gather_four(from + k, first, end, to + k);
    for (; k < kBatchLanes; ++k) {
      for (size_t i = first; i < end; ++i) {
        to[i * kBatchLanes + k] = k < lane_count ? from[k][i] : 0.0f;
      }
    }
  }
}

void scatter_lanes(const float* from, size_t count, size_t lane_count, float* const* to,
                   size_t first) {
  size_t k = 0;
  for (; k + 4 <= lane_count; k += 4) {
    size_t i = 0;
    for (; i + 4 <= count; i += 4) {
      const float* rows = from + i * kBatchLanes + k;
      Quad a = load4(rows), b = load4(rows + kBatchLanes);
      Quad c = load4(rows + 2 * kBatchLanes), d = load4(rows + 3 * kBatchLanes);
      transpose4(a, b, c, d);
      store4(to[k] + first + i, a);
      store4(to[k + 1] + first + i, b);
      store4(to[k + 2] + first + i, c);
      store4(to[k + 3] + first + i, d);
    }
    for (; i < count; ++i) {
      for (size_t j = 0; j < 4; ++j) to[k + j][first + i] = from[i * kBatchLanes + k + j];
    }
  }
  for (; k < lane_count; ++k) {
    for (size_t i = 0; i < count; ++i) to[k][first + i] = from[i * kBatchLanes + k];
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
