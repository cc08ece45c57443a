// SPDX-License-Identifier: MIT
// Random numbers that are the same on every platform and compiler: PCG32, seeded by SplitMix64. The engines
// of the standard library would do, but its distributions differ between libraries.
#pragma once

#include <cassert>
#include <cstdint>

namespace mien {

/// Steps `state` and returns a number that depends on all of its bits.
constexpr uint64_t split_mix(uint64_t& state) {
  state += 0x9E3779B97F4A7C15u;
  uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

class Random {
 public:
  /// Each stage of a computation uses its own stream, so that a change in one does not affect the others.
  static constexpr Random from_seed(uint64_t seed, uint64_t stream) {
    uint64_t state = seed;
    uint64_t mixed = split_mix(state) ^ stream;
    uint64_t start = split_mix(mixed);
    return Random(start, split_mix(mixed));
  }

  constexpr Random(uint64_t start, uint64_t sequence) : increment_(sequence << 1 | 1) {
    bits();
    state_ += start;
    bits();
  }

  constexpr uint32_t bits() {
    uint64_t old = state_;
    state_ = old * 6364136223846793005u + increment_;
    uint32_t mixed = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    uint32_t turn = static_cast<uint32_t>(old >> 59);
    return mixed >> turn | mixed << ((32 - turn) & 31);
  }

  /// 0 ... limit - 1, each equally likely: numbers beyond the last multiple of `limit` are drawn again.
  uint32_t below(uint32_t limit) {
    assert(limit > 0);
    uint32_t rejected = (0u - limit) % limit;
    for (;;) {
      uint32_t drawn = bits();
      if (drawn >= rejected) return drawn % limit;
    }
  }

  /// [0, 1)
  double real() { return bits() * (1.0 / 4294967296.0); }
  double between(double low, double high) { return low + (high - low) * real(); }
  bool chance(double probability) { return real() < probability; }

  /// Mean 0, deviation 1, within +-6: a sum of twelve, because log and cos round differently from library to
  /// library and a sum of integers does not.
  double normal() {
    uint64_t sum = 0;
    for (int i = 0; i < 12; ++i) sum += bits();
    return static_cast<double>(sum) * (1.0 / 4294967296.0) - 6.0;
  }

 private:
  uint64_t state_ = 0;
  uint64_t increment_;
};

}  // namespace mien
