// SPDX-License-Identifier: MIT
// Sets of bits, and the bits of floats.
#pragma once

#include <cstdint>
#include <cstring>

namespace mien {

/// The number of the lowest bit that is set; there must be one.
inline uint32_t lowest_bit(uint64_t bits) {
#if defined(__GNUC__)
  return static_cast<uint32_t>(__builtin_ctzll(bits));
#else
  uint32_t at = 0;
  while (!(bits >> at & 1)) ++at;
  return at;
#endif
}

/// The number of the highest bit that is set; there must be one.
inline uint32_t highest_bit(uint64_t bits) {
#if defined(__GNUC__)
  return 63 - static_cast<uint32_t>(__builtin_clzll(bits));
#else
  uint32_t at = 63;
  while (!(bits >> at & 1)) --at;
  return at;
#endif
}

inline uint32_t bit_count(uint64_t bits) {
#if defined(__POPCNT__) || defined(__aarch64__)
  return static_cast<uint32_t>(__builtin_popcountll(bits));
#else
  // Sums of 2, 4 and 8 neighbors; the product adds all bytes in the highest one.
  bits -= bits >> 1 & 0x5555555555555555u;
  bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
  bits = (bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0Fu;
  return static_cast<uint32_t>(bits * 0x0101010101010101u >> 56);
#endif
}

inline uint32_t bits_of(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof(bits));
  return bits;
}
inline float float_of(uint32_t bits) {
  float value;
  memcpy(&value, &bits, sizeof(value));
  return value;
}

}  // namespace mien
