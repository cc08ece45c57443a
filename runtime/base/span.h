// SPDX-License-Identifier: MIT
// Pointer and count: elements owned elsewhere.
#pragma once

#include <cassert>
#include <cstddef>

namespace mien {

template <class T>
struct Span {
  T* data = nullptr;
  size_t count = 0;

  T& operator[](size_t i) const {
    assert(i < count);
    return data[i];
  }
  T* begin() const { return data; }
  T* end() const { return data + count; }
  bool empty() const { return count == 0; }
  Span first(size_t n) const {
    assert(n <= count);
    return {data, n};
  }
  Span slice(size_t from, size_t n) const {
    assert(from <= count && n <= count - from);
    return {data + from, n};
  }
  operator Span<const T>() const { return {data, count}; }
};

}  // namespace mien
