// SPDX-License-Identifier: MIT
#include "author/document/field_edit.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <type_traits>

#include "runtime/load/dna/format/dna_path.h"

namespace mien::author {

using dna::Array;
using dna::FieldType;
using dna::List;
using dna::String;

/// Where the results of field writes go.
class FieldEdit {
 public:
  /// Null if memory ran out. The newest edit if it is of field writes and no mark has seen it.
  static EditMemory* memory_of(Document& document) {
    EditMemory* newest = document.edits_;
    document.checked_ = false;
    const EditMemory* marked = document.marks_ ? document.marks_->edits : nullptr;
    if (newest && newest != marked && newest->for_fields) return newest;
    EditMemory* memory = EditMemory::create(document.allocator_);
    if (!memory) return nullptr;
    memory->for_fields = true;
    memory->older = newest;
    document.edits_ = memory;
    return memory;
  }

  static dna::DnaView& view_of(Document& document) { return document.view_; }
};

namespace {

/// Follows a path that find_field() has accepted, and makes copies of the lists on its way that only the
/// current state has. `Action` gets what the path leads to:
///
///     bool number(T& value)                    false: memory ran out
///     bool array(Array<T>& array, element)     element of it, or kAll
///     bool string(String& string)
///     bool list(List<T>& list)
///     bool take(String& string, const List<String>& names, uint32_t index)   a name among others
template <class Action>
class Walk {
 public:
  Walk(const char* path, uint16_t version, EditMemory& memory, Action& action)
      : rest_(path), version_(version), memory_(memory), action_(action) {}

  bool run(dna::DnaView& view) {
    const size_t length = token();
    for (const dna::LayerKind& kind : dna::kLayerKinds) {
      if (!is(kind.name, length)) continue;
      rest_ += length;
      dna::with_layer(view, kind.id, [&](auto& record) { walk(record); });
      return ok_;
    }
    return false;
  }

  bool has_face_winding() const { return dna::version_has_face_winding(version_); }

  // A field of a record.
  template <class T>
  void operator()(const char* name, T& member) {
    if (found_ || !is(name, length_)) return;
    found_ = true;
    rest_ += length_;
    walk(member);
  }

 private:
  size_t token() const { return strcspn(rest_, ".["); }
  bool is(const char* name, size_t length) const {
    return strlen(name) == length && memcmp(name, rest_, length) == 0;
  }
  uint32_t index() {
    char* end = nullptr;
    const unsigned long value = strtoul(rest_ + 1, &end, 10);
    rest_ = end + 1;  // the bracket
    return static_cast<uint32_t>(value);
  }

  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void walk(Record& record) {
    if (*rest_ == 0) return;  // a record as a whole: nothing to write
    ++rest_;
    length_ = token();
    found_ = false;
    Record::fields(record, *this);
  }

  template <class T>
  void walk(List<T>& list) {
    if (*rest_ == 0) return keep(action_.list(list));
    if (!own(list)) return keep(false);
    walk(list[index()]);
  }
  void walk(List<String>& names) {
    if (*rest_ == 0) return keep(action_.list(names));
    if (!own(names)) return keep(false);
    const uint32_t i = index();
    keep(action_.take(names[i], names, i));
  }

  template <class T>
  void walk(Array<T>& array) {
    const bool whole = *rest_ == 0;
    keep(action_.array(array, whole ? Action::kAll : index()));
  }
  void walk(String& string) { keep(action_.string(string)); }
  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void walk(T& value) {
    keep(action_.number(value));
  }

  template <class T>
  bool own(List<T>& list) {
    if (memory_.holds(list.items)) return true;
    const Span<T> copy = memory_.arena.template unwritten_array<T>(list.count);
    if (!copy.data) return false;
    std::copy(list.begin(), list.end(), copy.data);
    list.items = copy.data;
    return true;
  }

  void keep(bool done) { ok_ = ok_ && done; }

  const char* rest_;
  uint16_t version_;
  EditMemory& memory_;
  Action& action_;
  size_t length_ = 0;  // of the name that is looked for
  bool found_ = false;
  bool ok_ = true;
};

/// An action does nothing but what it redefines.
struct Nothing {
  static constexpr uint32_t kAll = ~uint32_t{0};

  template <class T>
  bool number(T&) {
    return true;
  }
  template <class T>
  bool array(Array<T>&, uint32_t) {
    return true;
  }
  bool string(String&) { return true; }
  template <class T>
  bool list(List<T>&) {
    return true;
  }
  bool take(String&, const List<String>&, uint32_t) { return true; }
};

/// Copies `array` unless it is of this memory. False if memory ran out.
template <class T>
bool own(Array<T>& array, EditMemory& memory) {
  if (array.count == 0 || memory.holds(array.data)) return true;
  const dna::NewArray<T> copy = dna::new_array<T>(memory.arena, array.count);
  if (!copy.data) return false;
  memcpy(copy.data, array.data, array.byte_count());
  array = copy;
  return true;
}

template <class Value>
struct WriteNumbers : Nothing {
  EditMemory& memory;
  uint64_t first, count;
  const Value* values;

  WriteNumbers(EditMemory& m, uint64_t f, uint64_t n, const Value* v)
      : memory(m), first(f), count(n), values(v) {}

  template <class T>
  static constexpr bool fits() {
    return std::is_floating_point<T>::value == std::is_floating_point<Value>::value;
  }

  template <class T>
  bool number(T& value) {
    if (fits<T>() && count != 0) value = static_cast<T>(*values);
    return true;
  }
  template <class T>
  bool array(Array<T>& array, uint32_t element) {
    if (!fits<T>() || count == 0) return true;
    if (!own(array, memory)) return false;
    const dna::NewArray<T> out{const_cast<uint8_t*>(array.data), array.count};
    const uint64_t from = element == kAll ? first : element;
    for (uint64_t i = 0; i < count; ++i) out.set(from + i, static_cast<T>(values[i]));
    return true;
  }
};

struct WriteString : Nothing {
  EditMemory& memory;
  const char* bytes;
  size_t count;
  uint32_t taken = kAll;  // the element that has this name

  WriteString(EditMemory& m, const char* b, size_t n) : memory(m), bytes(b), count(n) {}

  bool string(String& string) {
    if (count == 0) {
      string = {};
      return true;
    }
    uint8_t* copy = static_cast<uint8_t*>(memory.arena.allocate(count, 1));
    if (!copy) return false;
    memcpy(copy, bytes, count);
    string = {copy, static_cast<uint32_t>(count)};
    return true;
  }
  bool take(String& name, const List<String>& names, uint32_t index) {
    for (uint32_t i = 0; i < names.count && count != 0; ++i) {
      if (i != index && names[i].count == count && memcmp(names[i].data, bytes, count) == 0) {
        taken = i;
        return true;
      }
    }
    return string(name);
  }
};

struct Splice : Nothing {
  EditMemory& memory;
  uint64_t first, removed, inserted;

  Splice(EditMemory& m, uint64_t f, uint64_t r, uint64_t i)
      : memory(m), first(f), removed(r), inserted(i) {}

  template <class T>
  bool array(Array<T>& array, uint32_t) {
    const uint64_t left = array.count - removed;
    const dna::NewArray<T> out = dna::new_array<T>(memory.arena, size_t(left + inserted));
    if (out.count != 0 && !out.data) return false;
    const size_t before = size_t(first) * sizeof(T), middle = size_t(inserted) * sizeof(T);
    const size_t after = size_t(left - first) * sizeof(T);
    if (before != 0) memcpy(out.data, array.data, before);
    if (middle != 0) memset(out.data + before, 0, middle);
    if (after != 0) {
      memcpy(out.data + before + middle, array.data + size_t(first + removed) * sizeof(T), after);
    }
    array = out;
    return true;
  }
  template <class T>
  bool list(List<T>& list) {
    const uint64_t left = list.count - removed;
    const Span<T> out = memory.arena.array<T>(size_t(left + inserted));
    if (left + inserted != 0 && !out.data) return false;
    std::copy(list.begin(), list.begin() + first, out.begin());
    std::copy(list.begin() + first + removed, list.end(), out.begin() + first + inserted);
    list = {out.data, static_cast<uint32_t>(out.count)};
    return true;
  }
};

// Arguments -----------------------------------------------------------------------------------------

const char* content_of(FieldType type) {
  switch (type) {
    case FieldType::kRecord: return "a record";
    case FieldType::kList: return "a list";
    case FieldType::kString: return "a string";
    case FieldType::kF32: return "floats";
    default: return "integers";
  }
}

bool is_integer(FieldType type) { return type >= FieldType::kU8 && type <= FieldType::kI32; }

Status wrong_type(const char* path, const dna::FieldRef& field, const char* wanted, Error& error) {
  return fail(error, Status::kInvalidArgument, kNoOffset, "%.120s holds %s, not %s", path,
              content_of(field.type), wanted);
}

Status check_range(const char* path, const dna::FieldRef& field, uint64_t first, uint64_t count,
                   Error& error) {
  if (first <= field.count && count <= field.count - first) return Status::kOk;
  return fail(error, Status::kIndex, kNoOffset, "%.120s has %llu elements, not %llu from %llu on",
              path, static_cast<unsigned long long>(field.count),
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(first));
}

struct Limits {
  int64_t least, most;
};
Limits limits_of(FieldType type) {
  switch (type) {
    case FieldType::kU8: return {0, UINT8_MAX};
    case FieldType::kU16: return {0, UINT16_MAX};
    case FieldType::kU32: return {0, UINT32_MAX};
    default: return {INT32_MIN, INT32_MAX};
  }
}

template <class Action, class... Given>
Status run(Document& document, const char* path, EditMemory* memory, Action& action, Error& error) {
  dna::DnaView& view = FieldEdit::view_of(document);
  if (!Walk<Action>(path, view.version, *memory, action).run(view)) {
    return no_memory(error, "a new value of a field");
  }
  view.ml_control_count = view.mlbh.control_names.count;
  return Status::kOk;
}

}  // namespace

Status write_floats(Document& document, const char* path, uint64_t first, uint64_t count,
                    const float* values, Error& error) {
  dna::FieldRef field;
  if (Status s = dna::find_field(document.view(), path, field, error); s != Status::kOk) return s;
  if (field.type != FieldType::kF32) return wrong_type(path, field, "floats", error);
  if (Status s = check_range(path, field, first, count, error); s != Status::kOk) return s;
  EditMemory* memory = FieldEdit::memory_of(document);
  if (!memory) return no_memory(error, "a new value of a field");
  WriteNumbers<float> action(*memory, first, count, values);
  return run(document, path, memory, action, error);
}

Status write_integers(Document& document, const char* path, uint64_t first, uint64_t count,
                      const int64_t* values, Error& error) {
  dna::FieldRef field;
  if (Status s = dna::find_field(document.view(), path, field, error); s != Status::kOk) return s;
  if (!is_integer(field.type)) return wrong_type(path, field, "integers", error);
  if (Status s = check_range(path, field, first, count, error); s != Status::kOk) return s;
  const Limits limits = limits_of(field.type);
  for (uint64_t i = 0; i < count; ++i) {
    if (values[i] >= limits.least && values[i] <= limits.most) continue;
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%.120s holds integers from %lld to %lld, not %lld, the value for element %llu",
                path, static_cast<long long>(limits.least), static_cast<long long>(limits.most),
                static_cast<long long>(values[i]), static_cast<unsigned long long>(first + i));
  }
  EditMemory* memory = FieldEdit::memory_of(document);
  if (!memory) return no_memory(error, "a new value of a field");
  WriteNumbers<int64_t> action(*memory, first, count, values);
  return run(document, path, memory, action, error);
}

Status write_string(Document& document, const char* path, const char* bytes, size_t count,
                    Error& error) {
  dna::FieldRef field;
  if (Status s = dna::find_field(document.view(), path, field, error); s != Status::kOk) return s;
  if (field.type != FieldType::kString) return wrong_type(path, field, "a string", error);
  if (count > UINT32_MAX) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%.120s: a string has at most 4 GiB, not %zu bytes", path, count);
  }
  EditMemory* memory = FieldEdit::memory_of(document);
  if (!memory) return no_memory(error, "a new value of a field");
  WriteString action(*memory, bytes, count);
  const Status status = run(document, path, memory, action, error);
  if (status != Status::kOk || action.taken == WriteString::kAll) return status;
  return fail(error, Status::kInvalidArgument, kNoOffset,
              "%.120s: element %u is already named \"%.*s\": names of a list differ", path,
              action.taken, static_cast<int>(std::min<size_t>(count, 60)), bytes);
}

Status splice(Document& document, const char* path, uint64_t first, uint64_t removed,
              uint64_t inserted, Error& error) {
  dna::FieldRef field;
  if (Status s = dna::find_field(document.view(), path, field, error); s != Status::kOk) return s;
  if (field.type != FieldType::kList && !field.is_array) {
    return wrong_type(path, field, "a list or an array, which can be resized", error);
  }
  if (Status s = check_range(path, field, first, removed, error); s != Status::kOk) return s;
  if (inserted > UINT32_MAX - (field.count - removed)) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "%.120s: a list or array has at most 2^32 - 1 elements", path);
  }
  EditMemory* memory = FieldEdit::memory_of(document);
  if (!memory) return no_memory(error, "the new elements of a list");
  Splice action(*memory, first, removed, inserted);
  return run(document, path, memory, action, error);
}

Status resize(Document& document, const char* path, uint64_t count, Error& error) {
  dna::FieldRef field;
  if (Status s = dna::find_field(document.view(), path, field, error); s != Status::kOk) return s;
  const uint64_t removed = count < field.count ? field.count - count : 0;
  return splice(document, path, field.count - removed, removed, count + removed - field.count,
                error);
}

}  // namespace mien::author
