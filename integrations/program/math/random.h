// SPDX-License-Identifier: MIT
// Pseudo-random numbers that are the same everywhere: splitmix64.
#pragma once

#include <cstdint>

namespace mien::math {

class Random {
 public:
  /// From 0 to below 1.
  double unit() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_ = 0;
};

}  // namespace mien::math
