// SPDX-License-Identifier: MIT
#include "runtime/load/dna/format/dna_path.h"

#include <type_traits>

namespace mien::dna {
namespace {

template <class T>
constexpr FieldType number_type() {
  if (std::is_same<T, uint8_t>::value) return FieldType::kU8;
  if (std::is_same<T, uint16_t>::value) return FieldType::kU16;
  if (std::is_same<T, uint32_t>::value) return FieldType::kU32;
  if (std::is_same<T, int32_t>::value) return FieldType::kI32;
  return FieldType::kF32;
}

/// Counts the fields of a record and keeps the name of one.
struct FieldNames {
  bool face_winding;
  uint32_t wanted = ~uint32_t{0};
  uint32_t count = 0;
  const char* name = nullptr;

  bool has_face_winding() const { return face_winding; }
  template <class T>
  void operator()(const char* field, const T&) {
    if (count++ == wanted) name = field;
  }
};

/// Follows a path, one step per call; `rest` is the part that is left.
class FieldFinder {
 public:
  FieldFinder(const DnaView& view, const char* path, Error& error)
      : view_(view), path_(path), rest_(path), error_(error) {}

  FieldRef found;
  uint32_t wanted_name = ~uint32_t{0};  // of the record that the path ends at
  const char* name = nullptr;

  Status run() {
    if (*rest_ == 0) {
      found.type = FieldType::kRecord;
      found.count = kLayerIdCount;
      if (wanted_name < kLayerIdCount) name = kLayerKinds[wanted_name].name;
      return Status::kOk;
    }
    const size_t length = token();
    for (const LayerKind& kind : kLayerKinds) {
      if (!is(kind.name, length)) continue;
      rest_ += length;
      with_layer(view_, kind.id, [&](const auto& record) { resolve(record); });
      return status_;
    }
    return missing("is not a layer: see mien_dna_child_name() with an empty path");
  }

 private:
  size_t token() const { return strcspn(rest_, ".["); }
  bool is(const char* field, size_t length) const {
    return strlen(field) == length && memcmp(field, rest_, length) == 0;
  }

  Status missing(const char* what) {
    return status_ =
               fail(error_, Status::kName, kNoOffset, "%.120s: \"%.60s\" %s", path_, rest_, what);
  }

  // Records: a field of it, or itself.
  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void resolve(const Record& record) {
    if (*rest_ == 0) {
      FieldNames names{version_has_face_winding(view_.version), wanted_name};
      Record::fields(record, names);
      found = {FieldType::kRecord, names.count};
      name = names.name;
      return;
    }
    if (*rest_ != '.') {
      missing("does not exist: a record has fields, not elements");
      return;
    }
    ++rest_;
    Matcher matcher{*this, token()};
    Record::fields(record, matcher);
    if (!matcher.matched)
      missing("is not a field of this record: mien_dna_child_name() lists them");
  }

  template <class T>
  void resolve(const List<T>& list) {
    if (*rest_ == 0) {
      found = {FieldType::kList, list.count};
      return;
    }
    uint32_t index;
    if (read_index(list.count, index)) resolve(list[index]);
  }

  template <class T>
  void resolve(const Array<T>& array) {
    if (*rest_ == 0) {
      found = {number_type<T>(), array.count, array.data};
      found.is_array = true;
      return;
    }
    uint32_t index;
    if (!read_index(array.count, index)) return;
    if (*rest_ != 0) {
      missing("does not exist: a number has no fields or elements");
      return;
    }
    found = {number_type<T>(), 1, array.data + index * sizeof(T)};
  }

  void resolve(const String& string) {
    if (*rest_ != 0) {
      missing("does not exist: a string has no fields or elements");
      return;
    }
    found = {FieldType::kString, string.count, string.data};
  }

  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void resolve(T value) {
    if (*rest_ != 0) {
      missing("does not exist: a number has no fields or elements");
      return;
    }
    found = {number_type<T>(), 1};
    store_big_endian(found.number, value);
  }

  bool read_index(uint32_t count, uint32_t& index) {
    const char* at = rest_;
    uint64_t value = 0;
    if (*at++ != '[' || *at < '0' || *at > '9') {
      missing("does not exist: elements of a list are named [index]");
      return false;
    }
    while (*at >= '0' && *at <= '9') {
      value = value * 10 + static_cast<uint64_t>(*at++ - '0');
      if (value > ~uint32_t{0}) value = ~uint32_t{0};
    }
    if (*at != ']') {
      missing("lacks its closing bracket");
      return false;
    }
    if (value >= count) {
      status_ =
          fail(error_, Status::kIndex, kNoOffset,
               "%.120s: \"%.60s\" is past the end: the list has %u elements", path_, rest_, count);
      return false;
    }
    rest_ = at + 1;
    index = static_cast<uint32_t>(value);
    return true;
  }

  struct Matcher {
    FieldFinder& finder;
    size_t length;
    bool matched = false;

    bool has_face_winding() const { return version_has_face_winding(finder.view_.version); }
    template <class T>
    void operator()(const char* field, const T& member) {
      if (matched || !finder.is(field, length)) return;
      matched = true;
      finder.rest_ += length;
      finder.resolve(member);
    }
  };

  const DnaView& view_;
  const char* path_;
  const char* rest_;
  Error& error_;
  Status status_ = Status::kOk;
};

}  // namespace

Status find_field(const DnaView& view, const char* path, FieldRef& out, Error& error) {
  FieldFinder finder(view, path, error);
  const Status status = finder.run();
  if (status == Status::kOk) out = finder.found;
  return status;
}

Status find_field_name(const DnaView& view, const char* path, uint32_t index, const char*& out,
                       Error& error) {
  FieldFinder finder(view, path, error);
  finder.wanted_name = index;
  const Status status = finder.run();
  if (status != Status::kOk) return status;
  if (finder.found.type != FieldType::kRecord) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%.160s: is not a record, so it has no field names", path);
  }
  if (!finder.name) {
    return fail(error, Status::kIndex, kNoOffset, "%.160s: has %u fields; %u is past the end", path,
                static_cast<unsigned>(finder.found.count), index);
  }
  out = finder.name;
  return Status::kOk;
}

}  // namespace mien::dna
