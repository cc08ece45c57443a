// SPDX-License-Identifier: MIT
// Samples of clips: eight channels at a time, as plain loops that compilers vectorize.

#pragma once

#include "simd/clip_kernels.h"
#include "simd/vec.inl"

// Before loops with a small constant count: g++ would unroll them completely and then not vectorize them.
#if defined(__GNUC__)
#define MIEN_LANES _Pragma("GCC unroll 1")
#else
#define MIEN_LANES
#endif

namespace mien::MIEN_KERNEL_ISA {
namespace {

inline uint64_t load_window(const uint8_t* from) {
  uint64_t bits;
  __builtin_memcpy(&bits, from, sizeof(bits));
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  bits = __builtin_bswap64(bits);
#endif
  return bits;
}

/// Codes of the current residuals.
inline void read_codes(const ClipLanes& lanes, const uint8_t* block, uint32_t* codes) {
  for (uint32_t k = 0; k < kClipLanes; ++k) {
    const uint64_t window = load_window(block + (lanes.bit[k] >> 3));
    codes[k] = static_cast<uint32_t>(window >> (lanes.bit[k] & 7)) & lanes.mask[k];
  }
}

inline void add_residuals(const uint32_t* codes, ClipLanes& lanes) {
  MIEN_LANES
  for (uint32_t k = 0; k < kClipLanes; ++k) {
    const uint32_t residual = (codes[k] >> 1) ^ (0u - (codes[k] & 1));
    const uint32_t change = lanes.slope[k] + residual;
    lanes.bit[k] += lanes.width[k];
    lanes.last[k] += change & lanes.present[k];
    lanes.slope[k] = change & lanes.linear[k];
  }
}

inline float clip_value(uint32_t ordered) {
  const uint32_t above = 0u - (ordered >> 31);
  return float_of(ordered ^ (~above | 1u << 31));
}

/// The integer, truncated to 24 bits, divided by the scale; ordered as floats.
inline uint32_t ordered_of_number(uint32_t number, float scale) {
  const uint32_t negative = 0u - (number >> 31), magnitude = (number ^ negative) - negative;
  uint32_t low = magnitude >> 24;
  low |= low >> 1;
  low |= low >> 2;
  low |= low >> 4;
  const float value = static_cast<float>(static_cast<int32_t>(magnitude & ~low & 0x7FFFFFFF));
  return (bits_of(value / scale) | 1u << 31) ^ negative;
}

/// Orders 2 and 3. Floats are predicted by their values, because differences of ordered bits jump where
/// the exponent changes.
inline void add_to_curves(const uint32_t* codes, ClipLanes& lanes) {
  MIEN_LANES
  for (uint32_t k = 0; k < kClipLanes; ++k) {
    const uint32_t residual = (codes[k] >> 1) ^ (0u - (codes[k] & 1));
    const uint32_t present = lanes.present[k];
    const uint32_t last = lanes.last[k] + ((lanes.slope[k] + residual) & present);
    const int32_t order = lanes.order[k], age = lanes.age[k];
    const uint32_t floats = 0u - static_cast<uint32_t>((order >= 2) & (lanes.unit[k] != 0));

    constexpr float kLimit = 1u << 30;
    float value = clip_value(last) * lanes.scale[k];
    value = value < kLimit ? value : kLimit;  // damaged samples; NaN
    value = value > -kLimit ? value : -kLimit;
    const auto scaled = static_cast<uint32_t>(static_cast<int32_t>(value));
    const uint32_t number = (last & ~floats) | (scaled & floats);

    // The bend needs two differences, its change three.
    const uint32_t second = 0u - static_cast<uint32_t>((order >= 2) & (age >= 2));
    const uint32_t third = 0u - static_cast<uint32_t>((order >= 3) & (age >= 3));
    const uint32_t difference = number - lanes.number[k], bend = difference - lanes.difference[k];
    const uint32_t slope =
        (difference & lanes.linear[k]) + (bend & second) + ((bend - lanes.bend[k]) & third);
    const uint32_t float_slope = ordered_of_number(number + slope, lanes.scale[k]) - last;

    const auto update = [present](uint32_t before, uint32_t now) {
      return (before & ~present) | (now & present);
    };
    lanes.bit[k] += lanes.width[k];
    lanes.last[k] = last;
    lanes.slope[k] = update(lanes.slope[k], (slope & ~floats) | (float_slope & floats));
    lanes.number[k] = update(lanes.number[k], number);
    lanes.difference[k] = update(lanes.difference[k], difference);
    lanes.bend[k] = update(lanes.bend[k], bend);
    lanes.age[k] = age + static_cast<int32_t>(static_cast<uint32_t>(age < 3) & present);
  }
}

void next_samples(const uint8_t* block, ClipLanes* groups, size_t count) {
  // The codes of several groups first, because reading a vector right after its elements were written stalls.
  constexpr size_t kGroups = 8;
  uint32_t codes[kGroups][kClipLanes];
  for (size_t first = 0; first < count; first += kGroups) {
    const size_t some = count - first < kGroups ? count - first : kGroups;
    ClipLanes* const lanes = groups + first;
    for (size_t g = 0; g < some; ++g) {
      if (lanes[g].turns != 0) read_codes(lanes[g], block, codes[g]);
    }
    for (size_t g = 0; g < some; ++g) {
      if (lanes[g].turns == 0) continue;
      if (lanes[g].curved[0] != 0) {
        add_to_curves(codes[g], lanes[g]);
      } else {
        add_residuals(codes[g], lanes[g]);
      }
    }
  }
}

bool sample_values(const ClipLanes* groups, size_t count, float* row) {
  uint32_t damaged = 0;
  for (size_t g = 0; g < count; ++g, row += kClipLanes) {
    const ClipLanes& lanes = groups[g];
    uint32_t bits[kClipLanes], bad = 0;
    MIEN_LANES
    for (uint32_t k = 0; k < kClipLanes; ++k) {
      const uint32_t unit = lanes.unit[k], ordered = lanes.last[k] * unit;
      const uint32_t above = 0u - (ordered >> 31);
      const uint32_t number = (ordered ^ (~above | 1u << 31)) & (0u - unit);
      const float part = static_cast<float>(static_cast<int32_t>(lanes.last[k])) / lanes.scale[k];
      uint32_t part_bits;
      __builtin_memcpy(&part_bits, &part, sizeof(part));
      // With bit operations: compilers would turn conditions into branches and then not vectorize.
      const uint32_t grid = 0u - static_cast<uint32_t>(unit == 0);
      const uint32_t all = (part_bits & grid) | (number & ~grid);
      const uint32_t special = 0u - static_cast<uint32_t>((all & 0x7F800000) == 0x7F800000);
      const uint32_t finite = lanes.present[k] & ~special;
      bits[k] = all & finite;
      bad |= finite ^ lanes.present[k];
    }
    __builtin_memcpy(row, bits, sizeof(bits));
    damaged |= bad;
  }
  return damaged == 0;
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA

#undef MIEN_LANES
