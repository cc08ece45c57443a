// SPDX-License-Identifier: MIT
// What the fields of a DNA view are made of.
//
//     Array<T>   numbers in the file, big-endian and unaligned
//     String     bytes in the file
//     List<T>    records, arrays or strings, one view each, in the arena of the DNA
//
// So only lists cost memory, and numbers are decoded where they are used. Arrays keep their address
// in the file, so each can tell its byte offset.
#pragma once

#include <cstdint>

#include "runtime/base/arena.h"
#include "runtime/base/byte_order.h"
#include "runtime/base/span.h"

namespace mien::dna {

template <class T>
struct Array {
  using Element = T;
  const uint8_t* data = nullptr;
  uint32_t count = 0;

  constexpr size_t byte_count() const { return size_t{count} * sizeof(T); }
  T operator[](size_t i) const {
    assert(i < count);
    return load_big_endian<T>(data + i * sizeof(T));
  }
  Array first(size_t n) const {
    assert(n <= count);
    return {data, static_cast<uint32_t>(n)};
  }
};

struct String {
  const uint8_t* data = nullptr;
  uint32_t count = 0;

  const char* chars() const { return reinterpret_cast<const char*>(data); }
};

template <class T>
struct List {
  using Element = T;
  T* items = nullptr;
  uint32_t count = 0;

  T& operator[](size_t i) const {
    assert(i < count);
    return items[i];
  }
  T* begin() const { return items; }
  T* end() const { return items + count; }
};

/// Room for an array that is being made here instead of read; its numbers go in with set().
template <class T>
struct NewArray {
  uint8_t* data = nullptr;
  uint32_t count = 0;

  void set(size_t i, T value) const {
    assert(i < count);
    store_big_endian(data + i * sizeof(T), value);
  }
  operator Array<T>() const { return {data, count}; }
};

/// `data` is null if memory ran out; an empty array needs none.
template <class T>
NewArray<T> new_array(Arena& arena, size_t count) {
  if (count == 0) return {};
  return {static_cast<uint8_t*>(arena.allocate(count * sizeof(T), 1)),
          static_cast<uint32_t>(count)};
}

}  // namespace mien::dna
