// SPDX-License-Identifier: MIT
// Changes a DNA view the way a careless or hostile exporter would: one field, one element, one row
// of parallel arrays, one record, one layer at a time. The view goes back through the writer, so
// offsets, sizes and counts stay right and the change reaches what lies behind the container.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

using Random = std::minstd_rand;

inline uint32_t below(Random& random, size_t end) {
  return end ? static_cast<uint32_t>(random() % end) : 0;
}

// Single values ----------------------------------------------------------------------------------

inline void change(Random& random, float& value) {
  using Limits = std::numeric_limits<float>;
  const float odd[] = {0,
                       -0.0f,
                       1,
                       -1,
                       2,
                       0.5f,
                       1e-30f,
                       1e30f,
                       -1e30f,
                       Limits::quiet_NaN(),
                       Limits::infinity(),
                       -Limits::infinity(),
                       Limits::max(),
                       Limits::lowest(),
                       Limits::denorm_min(),
                       Limits::epsilon()};
  value = odd[below(random, sizeof(odd) / sizeof(odd[0]))];
}

/// How many of each list there are: numbers next to these are where references end.
inline std::vector<uint32_t>& known_counts() {
  static std::vector<uint32_t> counts;
  return counts;
}

/// Mostly small numbers: those are the ones that refer to something.
template <class T>
void change(Random& random, T& value) {
  switch (below(random, 10)) {
    case 8:
    case 9: {
      const std::vector<uint32_t>& counts = known_counts();
      if (!counts.empty()) {
        value = static_cast<T>(counts[below(random, counts.size())] + below(random, 3) - 1);
      }
      break;
    }
    case 0: value = static_cast<T>(~T{0}); break;
    case 1: value = static_cast<T>(value + 1); break;
    case 2: value = static_cast<T>(value - 1); break;
    case 3: value = static_cast<T>(T{1} << below(random, 8 * sizeof(T) - 1)); break;
    case 4: value = static_cast<T>(value ^ (T{1} << below(random, 8 * sizeof(T) - 1))); break;
    default: value = static_cast<T>(below(random, 14)); break;
  }
}

// Arrays and lists --------------------------------------------------------------------------------

/// What happens to the elements of an array, decided once and done to all that are parallel.
struct Edit {
  enum Kind {
    kChange,
    kSwap,
    kDuplicate,
    kRemove,
    kRepeat,
    kCut,
    kClear,
    kReverse,
    kRotate,
    kShuffle,
    kKeepOne,
    kKinds
  };
  Kind kind;
  uint32_t at, other, times;

  static Edit any(Random& random, size_t count) {
    Edit edit;
    edit.kind = static_cast<Kind>(below(random, kKinds));
    edit.at = below(random, count);
    edit.other = below(random, count);
    edit.times = 1 + below(random, below(random, 8) == 0 ? 300 : 6);
    // Seldom, for it makes files large: to where a count no longer fits into a byte, or two.
    constexpr uint32_t kEdges[] = {255, 256, 257, 65535, 65536, 65537};
    if (edit.kind == kRepeat && below(random, 32) == 0) {
      const uint32_t edge = kEdges[below(random, below(random, 4) ? 3 : 6)];
      if (edge > count) edit.times = edge - static_cast<uint32_t>(count);
    }
    return edit;
  }

  /// Numbers of the old elements in their new order.
  uint32_t new_count(uint32_t count) const {
    if (count == 0) return kind == kDuplicate || kind == kRepeat ? times : 0;
    switch (kind) {
      case kDuplicate: return count + 1;
      case kRepeat: return count + times;
      case kRemove: return count - 1;
      case kCut: return at;
      case kClear: return 0;
      case kKeepOne: return 1;
      default: return count;
    }
  }
  uint32_t old_index(uint32_t i, uint32_t count) const {
    switch (kind) {
      case kReverse: return count - 1 - i;
      case kRotate: return (i + at) % count;
      // A permutation of a prime number of places, else nearly one.
      case kShuffle: return static_cast<uint32_t>(uint64_t{i} * (2 * other + 3) % count);
      case kKeepOne: return at;
      case kSwap: return i == at ? other : i == other ? at : i;
      case kDuplicate: return i > at ? i - 1 : i;
      case kRepeat: return i <= at ? i : i <= at + times ? at : i - times;
      case kRemove: return i < at ? i : i + 1;
      default: return i;
    }
  }
};

template <class T>
void apply(const Edit& edit, Random& random, Arena& arena, Array<T>& array) {
  const uint32_t count = edit.new_count(array.count);
  const NewArray<T> made = new_array<T>(arena, count);
  for (uint32_t i = 0; i < count; ++i) {
    T value = array.count ? array[edit.old_index(i, array.count)] : T{};
    if (edit.kind == Edit::kChange && i == edit.at) change(random, value);
    made.set(i, value);
  }
  array = made;
}

template <class T>
void apply(const Edit& edit, Random&, Arena& arena, List<T>& list) {
  const uint32_t count = edit.new_count(list.count);
  const Span<T> made = arena.array<T>(count);
  for (uint32_t i = 0; i < count; ++i) {
    if (list.count) made[i] = list[edit.old_index(i, list.count)];
  }
  list = {made.data, count};
}

// Records ----------------------------------------------------------------------------------------

/// Does one edit to every array and list of a record that has as many elements as a chosen one.
struct ParallelEditor {
  Random& random;
  Arena& arena;
  Edit edit;
  uint32_t count;

  static bool has_face_winding() { return true; }
  template <class T>
  void operator()(const char*, Array<T>& array) {
    if (array.count == count) apply(edit, random, arena, array);
  }
  template <class T>
  void operator()(const char*, List<T>& list) {
    if (list.count == count) apply(edit, random, arena, list);
  }
  template <class T>
  void operator()(const char*, T& other) {
    descend(other);
  }
  // The three arrays of neutral translations belong to the joint names beside them.
  void descend(Vec3Array& v) { Vec3Array::fields(v, *this); }
  template <class T>
  void descend(T&) {}
};

/// Walks a layer, counting places where something can be changed, and changes the wanted one.
class FieldMutator {
 public:
  FieldMutator(Random& random, Arena& arena, uint32_t wanted)
      : random_(random), arena_(arena), wanted_(wanted) {}

  uint32_t places() const { return place_; }
  static bool has_face_winding() { return true; }

  template <class T>
  void operator()(const char*, T& member) {
    visit(member);
  }

  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void visit(T& value) {
    if (here()) change(random_, value);
  }

  template <class T>
  void visit(Array<T>& array) {
    // Long arrays are as interesting as their first few elements.
    const uint32_t chances = 1 + std::min<uint32_t>(array.count, 4);
    for (uint32_t i = 0; i < chances; ++i) {
      if (!here()) continue;
      apply(i == 0 ? Edit::any(random_, array.count)
                   : Edit{Edit::kChange, below(random_, array.count), 0, 0},
            random_, arena_, array);
    }
  }

  void visit(String& string) {
    if (!here()) return;
    Array<uint8_t> bytes = {string.data, string.count};
    apply(Edit::any(random_, bytes.count), random_, arena_, bytes);
    string = {bytes.data, bytes.count};
  }

  template <class T>
  void visit(List<T>& list) {
    if (here()) apply(Edit::any(random_, list.count), random_, arena_, list);
    for (T& element : list) visit(element);
  }

  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void visit(Record& record) {
    if (here()) {
      Counts counts;
      Record::fields(record, counts);
      const uint32_t count = counts.values[below(random_, counts.used)];
      ParallelEditor editor{random_, arena_, Edit::any(random_, count), count};
      Record::fields(record, editor);
    }
    Record::fields(record, *this);
  }

 private:
  /// Lengths that occur in a record.
  struct Counts {
    uint32_t values[16] = {};
    uint32_t used = 1;

    static bool has_face_winding() { return true; }
    template <class T>
    void operator()(const char*, const Array<T>& array) {
      if (used < 16) values[used++] = array.count;
    }
    template <class T>
    void operator()(const char*, const List<T>& list) {
      if (used < 16) values[used++] = list.count;
    }
    template <class T>
    void operator()(const char*, const T&) {}
  };

  bool here() { return place_++ == wanted_; }

  Random& random_;
  Arena& arena_;
  uint32_t wanted_;
  uint32_t place_ = 0;
};

/// Where the arrays of a layer lie, as the file has them.
struct ArrayCollector {
  std::vector<const uint8_t*> data;

  static bool has_face_winding() { return true; }
  template <class T>
  void operator()(const char*, T& member) {
    visit(member);
  }
  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void visit(T&) {}
  template <class T>
  void visit(Array<T>& array) {
    if (array.count) data.push_back(reinterpret_cast<const uint8_t*>(array.data));
  }
  void visit(String& string) {
    if (string.count) data.push_back(reinterpret_cast<const uint8_t*>(string.data));
  }
  template <class T>
  void visit(List<T>& list) {
    for (T& element : list) visit(element);
  }
  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void visit(Record& record) {
    Record::fields(record, *this);
  }
};

/// All arrays of one type, and how many elements each list and array has.
template <class Wanted>
struct SameArrays {
  std::vector<Array<Wanted>*> arrays;
  std::vector<uint32_t> counts;

  static bool has_face_winding() { return true; }
  template <class T>
  void operator()(const char*, T& member) {
    visit(member);
  }
  template <class T, std::enable_if_t<std::is_arithmetic<T>::value, int> = 0>
  void visit(T&) {}
  template <class T>
  void visit(Array<T>& array) {
    if constexpr (std::is_same<T, Wanted>::value) arrays.push_back(&array);
    if (array.count) counts.push_back(array.count);
  }
  void visit(String&) {}
  template <class T>
  void visit(List<T>& list) {
    if (list.count) counts.push_back(list.count);
    for (T& element : list) visit(element);
  }
  template <class Record, std::enable_if_t<std::is_class<Record>::value, int> = 0>
  void visit(Record& record) {
    Record::fields(record, *this);
  }
};

/// Every array called `lods` gets an entry more or less, and so does the descriptor.
class LodEditor {
 public:
  LodEditor(Random& random, Arena& arena, uint32_t old_count, uint32_t new_count)
      : random_(random), arena_(arena), old_count_(old_count), new_count_(new_count) {}

  static bool has_face_winding() { return true; }
  template <class T>
  void operator()(const char* name, T& member) {
    visit(name, member);
  }

 private:
  void visit(const char* name, Array<uint16_t>& array) {
    if (strcmp(name, "lods") != 0 || array.count != old_count_) return;
    Edit edit = {Edit::kCut, new_count_, 0, 0};
    if (new_count_ > old_count_) {
      edit = {Edit::kRepeat, old_count_ ? old_count_ - 1 : 0, 0, new_count_ - old_count_};
    }
    apply(edit, random_, arena_, array);
  }
  template <class T>
  void visit(const char*, Array<T>&) {}
  void visit(const char*, String&) {}
  template <class T>
  void visit(const char* name, List<T>& list) {
    for (T& element : list) visit(name, element);
  }
  template <class Record>
  void visit(const char*, Record& record) {
    if constexpr (std::is_class<Record>::value) Record::fields(record, *this);
  }

  Random& random_;
  Arena& arena_;
  uint32_t old_count_, new_count_;
};

// Views -------------------------------------------------------------------------------------------

inline void change_layer(Random& random, Arena& arena, DnaView& view, LayerId id) {
  with_layer(view, id, [&](auto& record) {
    FieldMutator counter(random, arena, ~uint32_t{0});
    counter.visit(record);
    FieldMutator mutator(random, arena, below(random, counter.places()));
    mutator.visit(record);
  });
}

/// Two index arrays trade places, or one takes the place of the other.
template <class T>
void swap_arrays(Random& random, DnaView& view, LayerId id) {
  SameArrays<T> found;
  with_layer(view, id, [&](auto& record) { found.visit(record); });
  if (found.arrays.size() < 2) return;
  const uint32_t i = below(random, found.arrays.size());
  const uint32_t near = below(random, 2) ? (i + 1) % static_cast<uint32_t>(found.arrays.size())
                                         : below(random, found.arrays.size());
  if (below(random, 2)) {
    std::swap(*found.arrays[i], *found.arrays[near]);
  } else {
    *found.arrays[i] = *found.arrays[near];
  }
}

inline void collect_counts(DnaView& view) {
  SameArrays<uint16_t> found;
  found.visit(view.defn);
  found.visit(view.bhvr);
  found.counts.push_back(view.desc.lod_count);
  std::sort(found.counts.begin(), found.counts.end());
  found.counts.erase(std::unique(found.counts.begin(), found.counts.end()), found.counts.end());
  known_counts() = found.counts;
}

/// A row more or less in a joint group, with its values.
inline void change_joint_rows(Random& random, Arena& arena, DnaView& view) {
  const List<JointGroup>& groups = view.bhvr.joints.groups;
  if (groups.count == 0) return;
  JointGroup& group = groups[below(random, groups.count)];
  const uint32_t columns = group.input_indices.count;
  if (group.values.count != uint64_t{columns} * group.output_indices.count) return;
  Edit edit = Edit::any(random, group.output_indices.count);
  apply(edit, random, arena, group.output_indices);
  const uint32_t rows = group.output_indices.count;
  const Edit resize = {rows * columns > group.values.count ? Edit::kRepeat : Edit::kCut,
                       rows * columns > group.values.count ? 0 : rows * columns, 0,
                       rows * columns - group.values.count};
  if (rows * columns != group.values.count) apply(resize, random, arena, group.values);
  const NewArray<uint16_t> lods = new_array<uint16_t>(arena, group.lods.count);
  for (uint32_t l = 0; l < lods.count; ++l) {
    lods.set(l, static_cast<uint16_t>(std::min<uint32_t>(group.lods[l], rows)));
  }
  group.lods = lods;
}

inline void change_lod_count(Random& random, Arena& arena, DnaView& view) {
  const uint32_t old_count = view.desc.lod_count;
  const uint32_t new_count = below(random, 8) == 0 ? below(random, 35) : below(random, 5);
  LodEditor editor(random, arena, old_count, new_count);
  for (const LayerKind& kind : kLayerKinds) {
    with_layer(view, kind.id, [&](auto& record) { editor("", record); });
  }
  view.desc.lod_count = static_cast<uint16_t>(new_count);
}

inline void change_index(Random& random, Arena& arena, DnaView& view) {
  List<IndexEntry>& index = view.index;
  Edit edit = Edit::any(random, index.count);
  if (edit.kind == Edit::kClear && below(random, 8) != 0) edit.kind = Edit::kSwap;
  const uint32_t old_count = index.count;
  apply(edit, random, arena, index);
  // Copies become layers that nobody knows.
  for (uint32_t i = 0; i < index.count && index.count > old_count; ++i) {
    if (i <= edit.at || i > edit.at + edit.times) continue;
    index[i].layer_version = 0x20000 + i;
    if (!index[i].data) index[i].size = 0;
  }
}

inline void change_view(Random& random, Arena& arena, DnaView& view) {
  collect_counts(view);
  switch (below(random, 18)) {
    case 3:
      swap_arrays<uint16_t>(random, view, static_cast<LayerId>(below(random, kLayerIdCount)));
      break;
    case 4:
      swap_arrays<uint32_t>(random, view, static_cast<LayerId>(below(random, kLayerIdCount)));
      break;
    case 0: change_index(random, arena, view); break;
    case 1: change_lod_count(random, arena, view); break;
    case 2: change_joint_rows(random, arena, view); break;
    default: change_layer(random, arena, view, static_cast<LayerId>(below(random, kLayerIdCount)));
  }
  // Two bytes that ask for 65535 correctives make an input a hundred times slower: rarely.
  uint16_t& psds = view.bhvr.controls.psd_count;
  if (psds > 100 && below(random, 64) != 0) psds = static_cast<uint16_t>(below(random, 14));
}

}  // namespace mien::dna
