// SPDX-License-Identifier: MIT
// Widths of arrays in lanes: the same on every instruction set.
#pragma once

#include <stdint.h>

namespace mien {

/// Rows per block of a dense layer, and lanes per block of other arrays.
constexpr uint32_t kBlockLanes = 16;

/// The least multiple of kBlockLanes that is not less than `count`.
template <class Count>
constexpr Count padded(Count count) {
  return (count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
}

/// Characters that a batch evaluates together, one lane each.
constexpr uint32_t kBatchLanes = 32;

}  // namespace mien
