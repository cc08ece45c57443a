// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mien::math {

/// Without a branch for each number, so that compilers use SIMD.
inline bool is_finite_block(const float* numbers, size_t count) {
  uint32_t all = 0;
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits;
    std::memcpy(&bits, &numbers[i], 4);
    // An exponent of ones, infinite or not a number, carries into the sign.
    all |= (bits & 0x7fffffff) + 0x00800000;
  }
  return all >> 31 == 0;
}

/// The index of the first number that is not finite, or `count`.
inline size_t finite_count(const float* numbers, size_t count) {
  constexpr size_t kBlock = 64;
  for (size_t first = 0; first < count; first += kBlock) {
    const size_t end = std::min(count, first + kBlock);
    const bool is_whole = end - first == kBlock;  // unrolled then
    if (is_whole ? is_finite_block(numbers + first, kBlock)
                 : is_finite_block(numbers + first, end - first)) {
      continue;
    }
    const float* const found =
        std::find_if(numbers + first, numbers + end, [](float x) { return !std::isfinite(x); });
    return static_cast<size_t>(found - numbers);
  }
  return count;
}

}  // namespace mien::math
