// SPDX-License-Identifier: MIT
// How many bytes the smallest possible record of a type takes in a file: all arrays empty. A list
// cannot have more elements than the remaining bytes divided by this, which bounds the memory that
// a count in a file can claim.
#pragma once

#include <type_traits>

#include "runtime/load/dna/format/dna_schema.h"

namespace mien::dna {

template <class T, class = void>
struct IsBlock : std::false_type {};
template <class T>
struct IsBlock<T, std::void_t<decltype(T::kIsBlock)>> : std::true_type {};

class SmallestSize {
 public:
  static constexpr bool has_face_winding() { return false; }

  template <class T>
  constexpr void operator()(const char*, const T& member) {
    add(member);
  }

  constexpr void add(uint8_t) { bytes += 1; }
  constexpr void add(uint16_t) { bytes += 2; }
  constexpr void add(uint32_t) { bytes += 4; }
  constexpr void add(int32_t) { bytes += 4; }
  constexpr void add(float) { bytes += 4; }
  constexpr void add(const String&) { bytes += 4; }
  template <class T>
  constexpr void add(const Array<T>&) {
    bytes += 4;
  }
  template <class T>
  constexpr void add(const List<T>&) {
    bytes += 4;
  }
  template <class Record>
  constexpr void add(const Record& record) {
    if (IsBlock<Record>::value) bytes += 4;
    Record::fields(record, *this);
  }

  uint32_t bytes = 0;
};

template <class T>
constexpr uint32_t smallest_size() {
  SmallestSize size;
  size.add(T{});
  return size.bytes;
}

}  // namespace mien::dna
