// SPDX-License-Identifier: MIT
// Half precision (IEEE binary16) for storage.
#pragma once

#include <cstdint>
#include <cstring>

namespace mien {

constexpr float kLargestHalf = 65504;

/// The nearest half, ties to even. Values out of range become the largest half, NaN becomes 0: a
/// compiled rig holds no infinities, so kernels need not handle them.
inline uint16_t half_from_float(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof(bits));
  const uint32_t sign = bits >> 16 & 0x8000;
  float magnitude = value < 0 ? -value : value;
  if (!(magnitude > 0)) return static_cast<uint16_t>(magnitude == 0 ? sign : 0);
  if (magnitude > kLargestHalf) magnitude = kLargestHalf;
  constexpr float kSmallestNormal = 1.0f / 16384, kSubnormalSpacing = 1.0f / 16777216;
  if (magnitude < kSmallestNormal) {
    // Adding 2^23 spacings leaves as many in the last bits, rounded by the addition.
    constexpr float kRounder = 8388608 * kSubnormalSpacing;
    const float rounded = magnitude + kRounder;
    uint32_t rounded_bits, base;
    memcpy(&rounded_bits, &rounded, sizeof(rounded_bits));
    memcpy(&base, &kRounder, sizeof(base));
    return static_cast<uint16_t>(sign | (rounded_bits - base));
  }
  memcpy(&bits, &magnitude, sizeof(bits));
  bits += 0xFFF + (bits >> 13 & 1);  // half of the last place kept, a little less if that is even
  return static_cast<uint16_t>(sign | ((bits - (112u << 23)) >> 13));
}

inline float float_from_half(uint16_t half) {
  const uint32_t exponent = half >> 10 & 31, fraction = half & 1023u;
  float value;
  if (exponent == 0) {
    value = static_cast<float>(fraction) / 16777216;
  } else {
    const uint32_t bits = (exponent + 112) << 23 | fraction << 13;
    memcpy(&value, &bits, sizeof(value));
  }
  return half & 0x8000 ? -value : value;
}

}  // namespace mien
