// SPDX-License-Identifier: MIT
// Indices of 16 bits, or of 32 where 16 are too few: elements owned elsewhere.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "runtime/base/span.h"

namespace mien {

struct IndexList {
  void* data = nullptr;
  size_t count : sizeof(size_t) * 8 - 1;
  size_t wide : 1;  // 32 bits

  IndexList() : count(0), wide(0) {}
  explicit IndexList(const Span<uint16_t>& indices)
      : data(indices.data), count(indices.count), wide(0) {}
  explicit IndexList(const Span<uint32_t>& indices)
      : data(indices.data), count(indices.count), wide(1) {}

  /// One of the two has the indices, the other is empty.
  Span<uint16_t> narrow_span() const {
    return wide ? Span<uint16_t>{} : Span<uint16_t>{static_cast<uint16_t*>(data), count};
  }
  Span<uint32_t> wide_span() const {
    return wide ? Span<uint32_t>{static_cast<uint32_t*>(data), count} : Span<uint32_t>{};
  }
  uint32_t operator[](size_t i) const {
    assert(i < count);
    return wide ? static_cast<const uint32_t*>(data)[i] : static_cast<const uint16_t*>(data)[i];
  }
  void set(size_t i, uint32_t index) {
    assert(i < count);
    if (wide) {
      static_cast<uint32_t*>(data)[i] = index;
    } else {
      static_cast<uint16_t*>(data)[i] = static_cast<uint16_t>(index);
    }
  }
  /// As kernels take them.
  const void* from(size_t i) const {
    if (wide) return static_cast<const uint32_t*>(data) + i;
    return static_cast<const uint16_t*>(data) + i;
  }
};

}  // namespace mien
