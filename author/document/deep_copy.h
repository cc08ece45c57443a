// SPDX-License-Identifier: MIT
// Copies the data that the fields of a record point to, using the descriptions of the format.
#pragma once

#include <new>
#include <type_traits>

#include "runtime/base/arena.h"
#include "runtime/load/dna/format/dna_schema.h"

namespace mien::author {

/// Lists always; arrays and strings only if `Numbers`.
template <bool Numbers>
class FieldCopier {
 public:
  explicit FieldCopier(Arena& arena) : arena_(arena) {}

  static constexpr bool has_face_winding() { return true; }
  template <class T>
  void operator()(const char*, T& member) {
    copy(member);
  }

  template <class T>
  void copy(dna::List<T>& list) {
    if (!ok || list.count == 0) return;
    const Span<T> out = arena_.unwritten_array<T>(list.count);
    if (!out.data) return void(ok = false);
    for (uint32_t i = 0; i < list.count; ++i) new (out.data + i) T(list.items[i]);
    list.items = out.data;
    for (T& element : list) copy(element);
  }
  template <class T>
  void copy(dna::Array<T>& array) {
    copy_bytes(array.data, array.byte_count());
  }
  void copy(dna::String& string) { copy_bytes(string.data, string.count); }
  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void copy(Record& record) {
    Record::fields(record, *this);
  }
  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void copy(T&) {}

  bool ok = true;  // false: memory ran out

 private:
  void copy_bytes(const uint8_t*& bytes, size_t count) {
    if (!Numbers || !ok || count == 0) return;
    void* out = arena_.allocate(count, 1);
    if (!out) return void(ok = false);
    memcpy(out, bytes, count);
    bytes = static_cast<const uint8_t*>(out);
  }

  Arena& arena_;
};

/// False if memory ran out.
template <class Field>
bool copy_deeply(Arena& arena, Field& field) {
  FieldCopier<true> copier(arena);
  copier.copy(field);
  return copier.ok;
}

}  // namespace mien::author
