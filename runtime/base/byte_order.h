// SPDX-License-Identifier: MIT
// Numbers at any address: big-endian as DNA files hold them, little-endian as clips do.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(_MSC_VER)
#include <stdlib.h>
#endif

namespace mien {

inline uint8_t to_big_endian(uint8_t v) { return v; }

#if defined(_MSC_VER)
inline uint16_t to_big_endian(uint16_t v) { return _byteswap_ushort(v); }
inline uint32_t to_big_endian(uint32_t v) { return _byteswap_ulong(v); }
#elif defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
inline uint16_t to_big_endian(uint16_t v) { return v; }
inline uint32_t to_big_endian(uint32_t v) { return v; }
#else
inline uint16_t to_big_endian(uint16_t v) { return __builtin_bswap16(v); }
inline uint32_t to_big_endian(uint32_t v) { return __builtin_bswap32(v); }
#endif

template <size_t Size>
struct UnsignedOfSize;
template <>
struct UnsignedOfSize<1> {
  using Type = uint8_t;
};
template <>
struct UnsignedOfSize<2> {
  using Type = uint16_t;
};
template <>
struct UnsignedOfSize<4> {
  using Type = uint32_t;
};

/// Moves bit patterns only, so NaN payloads survive.
template <class T>
inline T load_big_endian(const uint8_t* at) {
  typename UnsignedOfSize<sizeof(T)>::Type bits;
  memcpy(&bits, at, sizeof(bits));
  bits = to_big_endian(bits);
  T value;
  memcpy(&value, &bits, sizeof(value));
  return value;
}

template <class T>
inline void store_big_endian(uint8_t* at, T value) {
  typename UnsignedOfSize<sizeof(T)>::Type bits;
  memcpy(&bits, &value, sizeof(bits));
  bits = to_big_endian(bits);
  memcpy(at, &bits, sizeof(bits));
}

#if defined(__BYTE_ORDER__) && defined(__ORDER_BIG_ENDIAN__)
constexpr bool kBigEndianHost = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
#else
constexpr bool kBigEndianHost = false;
#endif

template <class T>
inline T to_little_endian(T value) {
  if (!kBigEndianHost) return value;
  uint8_t bytes[sizeof(T)], reversed[sizeof(T)];
  memcpy(bytes, &value, sizeof(T));
  for (size_t i = 0; i < sizeof(T); ++i) reversed[i] = bytes[sizeof(T) - 1 - i];
  memcpy(&value, reversed, sizeof(T));
  return value;
}

template <class T>
inline T load_little_endian(const uint8_t* at) {
  T value;
  memcpy(&value, at, sizeof(T));
  return to_little_endian(value);
}

template <class T>
inline void store_little_endian(uint8_t* at, T value) {
  value = to_little_endian(value);
  memcpy(at, &value, sizeof(T));
}

}  // namespace mien
