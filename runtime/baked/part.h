// SPDX-License-Identifier: MIT
// One part of a baked file. An object lists its members for a visitor in one place:
//
//     template <class Visitor> void visit(Object& object, Visitor& visitor) {
//       visitor.number(object.count);
//       visitor.array(object.indices);
//
// and three visitors measure, write and read it.
#pragma once

#include "runtime/baked/baked_file.h"
#include "runtime/base/index_list.h"
#include "runtime/base/span.h"

namespace mien {

/// How large a part is, and where its arrays begin.
class PartMeasure {
 public:
  template <class T>
  void number(const T&) {
    ++number_count_;
  }
  template <class T>
  void array(const Span<T>& span) {
    ++array_count_;
    array_bytes_ = align_up(array_bytes_, kBlockAlignment) + span.count * sizeof(T);
  }
  void array(const IndexList& list) {
    list.wide ? array(list.wide_span()) : array(list.narrow_span());
  }

  uint32_t number_count() const { return number_count_; }
  uint32_t array_count() const { return array_count_; }
  size_t table_size() const {
    return align_up(number_count_ * sizeof(uint64_t) + array_count_ * sizeof(BakedArray),
                    kBlockAlignment);
  }
  size_t size() const { return table_size() + align_up(array_bytes_, kBlockAlignment); }
  /// Its entry in the table of parts, except for the offset.
  BakedPart entry(PartKind kind, uint32_t version) const {
    return {static_cast<uint32_t>(kind), version, 0, size(), number_count_, array_count_, {}};
  }

 private:
  uint32_t number_count_ = 0, array_count_ = 0;
  size_t array_bytes_ = 0;
};

/// Writes into zeroed memory, with the tables where `measure` of the same object puts them.
class PartWriter {
 public:
  PartWriter(const PartMeasure& measure, uint8_t* part)
      : part_(part), number_(part), entry_(part + measure.number_count() * sizeof(uint64_t)),
        at_(measure.table_size()) {}

  template <class T>
  void number(const T& field) {
    static_assert(sizeof(T) <= sizeof(uint64_t), "a slot of the table");
    memcpy(number_, &field, sizeof(T));
    number_ += sizeof(uint64_t);
  }
  template <class T>
  void array(const Span<T>& span) {
    put_array(span.data, span.count, sizeof(T));
  }
  void array(const IndexList& list) {
    list.wide ? array(list.wide_span()) : array(list.narrow_span());
  }

 private:
  void put_array(const void* data, size_t count, uint32_t element_size);

  uint8_t* part_;
  uint8_t* number_;
  uint8_t* entry_;
  size_t at_;
};

/// Makes an object a view of a part: arrays point into it. Use the object only if finish() returns true,
/// and check it even then, because it may hold any numbers.
class PartReader {
 public:
  /// `expected` is the measure of an object of this kind, with or without its arrays.
  PartReader(const Baked& baked, const BakedPart& part, uint32_t version,
             const PartMeasure& expected, Error& error);

  void number(bool& field);
  template <class T>
  void number(T& field) {
    if (const uint8_t* from = take_number()) memcpy(&field, from, sizeof(T));
  }
  template <class T>
  void array(Span<T>& span) {
    // Baked objects are never written to.
    size_t count = 0;
    void* data = const_cast<uint8_t*>(take_array(sizeof(T), count));
    span = {static_cast<T*>(data), count};
  }
  void array(IndexList& list) {
    Span<uint16_t> narrow;
    Span<uint32_t> wide;
    if (next_has_elements_of(sizeof(uint16_t))) {
      array(narrow);
      list = IndexList(narrow);
    } else {
      array(wide);
      list = IndexList(wide);
    }
  }

  Status finish();

 private:
  bool next_has_elements_of(uint32_t size) const;
  const uint8_t* take_number();
  const uint8_t* take_array(uint32_t element_size, size_t& count);
  void damaged(uint64_t offset, const char* what);

  const uint8_t* part_;
  size_t offset_, size_;  // of the part
  const uint8_t* number_;
  const uint8_t* entry_;
  size_t at_;
  Error& error_;
  Status status_ = Status::kOk;
};

}  // namespace mien
