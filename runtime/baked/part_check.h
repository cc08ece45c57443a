// SPDX-License-Identifier: MIT
// Helpers for the checks of parts. Index arrays are long, so each is checked in one pass that compilers
// vectorize.
#pragma once

#include <cstring>

#include "runtime/base/span.h"
#include "runtime/base/status.h"
#include "simd/lanes.h"

namespace mien {

struct Checker {
  Error& error;

  bool ok(bool good, const char* what) const {
    if (good) return true;
    fail(error, Status::kBakedStructure, kNoOffset,
         "%s: counts or indices contradict each other, the baked file is damaged; bake it again",
         what);
    return false;
  }
};

/// The largest of some numbers, and the union of their bits.
template <class T>
struct Extent {
  T max = 0, bits = 0;

  void add(T number) {
    max = number > max ? number : max;
    bits |= number;
  }
};

/// Of all numbers, relative to `zero`. Most are processed in strips of a fixed length, which compilers
/// vectorize with several accumulators.
template <class T>
Extent<T> extent_of(const Span<T>& values, T zero = 0) {
  constexpr size_t kStrip = 64 / sizeof(T);
  Extent<T> extent;
  const T* at = values.begin();
  if (values.count >= kStrip) {
    T max[kStrip] = {}, bits[kStrip] = {};
    for (; static_cast<size_t>(values.end() - at) >= kStrip; at += kStrip) {
      for (size_t i = 0; i < kStrip; ++i) {
        const auto number = static_cast<T>(at[i] - zero);
        max[i] = number > max[i] ? number : max[i];
        bits[i] |= number;
      }
    }
    for (size_t i = 0; i < kStrip; ++i) {
      extent.add(max[i]);
      extent.bits |= bits[i];
    }
  }
  for (; at != values.end(); ++at) extent.add(static_cast<T>(*at - zero));
  return extent;
}

template <class T>
bool below(const Span<T>& values, uint64_t limit) {
  return values.empty() || extent_of(values).max < limit;
}

/// `first` holds the beginnings of `count` runs, then the end of the last one.
inline bool is_runs(const Span<uint32_t>& first, size_t count, size_t limit) {
  if (first.count <= count || first[0] != 0) return false;
  const uint32_t* at = first.data;
  uint32_t falls = 0;
  for (size_t i = 0; i < count; ++i) falls |= static_cast<uint32_t>(at[i] > at[i + 1]);
  return falls == 0 && first[count] <= limit;
}

/// `count` elements from `first` on, of `limit`.
inline bool fits(uint64_t first, uint64_t count, uint64_t limit) {
  return first <= limit && count <= limit - first;
}

/// A bool from a file may be any byte, and must not be read as a bool before it is checked.
inline bool is_flag(const bool& flag) {
  uint8_t byte;
  memcpy(&byte, &flag, 1);
  return byte <= 1;
}

}  // namespace mien
