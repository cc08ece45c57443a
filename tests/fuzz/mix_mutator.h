// SPDX-License-Identifier: MIT
// Changes mixes field by field. The fields are visited as the reader visits them (runtime/mix/mix_fields.h), and
// elements of lists, curves, names and rows come and go together with their counts, so most results open.
#pragma once

#include <algorithm>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "runtime/mix/mix_fields.h"
#include "tests/support/bytes.h"

namespace mien {

/// Where the fields of a mix are in its bytes. Bytes that are not a mix have the fields up to the first that
/// does not fit.
struct MixPlaces {
  struct Field {
    size_t at;
    uint32_t size, choices;  // choices: number of valid values; 0: any number
  };
  struct List {
    std::string name;
    size_t count_at;
    std::vector<size_t> starts;  // of the elements, and the end of the last one
  };
  /// A list of curves; with `has_values`, followed by as many floats.
  struct Curves {
    size_t count_at;
    uint32_t count;
    bool has_values;
  };
  /// A number for each curve, if there is a row.
  struct Row {
    size_t flag_at;
    uint32_t count, size;
    bool exists;
  };

  Span<const uint8_t> bytes;
  size_t at = kMixHeaderSize;
  bool ended = false;
  uint32_t curve_count = 0;
  std::vector<Field> fields;
  std::vector<List> lists;
  std::vector<Curves> curve_lists;
  std::vector<Row> rows;

  explicit MixPlaces(Span<const uint8_t> mix) : bytes(mix) {
    MixDesc desc;
    visit_mix(*this, desc);
  }

  bool skip(size_t size) {
    ended = ended || at > bytes.count || size > bytes.count - at;
    if (!ended) at += size;
    return !ended;
  }
  template <class T>
  T number(uint32_t choices) {
    if (!skip(sizeof(T))) return T{};
    fields.push_back({at - sizeof(T), sizeof(T), choices});
    return load_little_endian<T>(bytes.data + at - sizeof(T));
  }
  /// No more than there are bytes for.
  uint32_t count_of(size_t size) {
    const auto count = number<uint32_t>(0);
    ended = ended || size_t{count} * size > bytes.count - at;
    return ended ? 0 : count;
  }

  template <class T>
  void value(mien::Field field, const Limits&, T& to) {
    value(field.name, to);
  }
  template <class T>
  void value(const char*, T& to) {
    to = number<T>(0);
  }
  void value(const char*, bool& to) { to = number<uint8_t>(2) == 1; }
  void place(const char*, uint16_t& to) { to = number<uint16_t>(0); }
  template <class T, class Names>
  void choice(mien::Field, const Names& names, T& to) {
    to = static_cast<T>(number<uint8_t>(static_cast<uint32_t>(std::size(names))));
  }
  void count(const char*, uint32_t& to, uint32_t most) { to = std::min(count_of(1), most); }
  void pair(const char* name, uint16_t& curve, float& to) {
    value(name, curve);
    value(name, to);
  }
  void add_curves(bool has_values) {
    const size_t count_at = at;
    const uint32_t count = count_of(has_values ? 6 : 2);
    if (ended) return;
    curve_lists.push_back({count_at, count, has_values});
    uint16_t curve;
    float number;
    for (uint32_t i = 0; i < count; ++i) value("", curve);
    for (uint32_t i = 0; i < count && has_values; ++i) value("", number);
  }
  void curves(const char*, Span<const uint16_t>&) { add_curves(false); }
  void pairs(const char*, Span<const uint16_t>&, Span<const float>&) { add_curves(true); }
  void mask(const char* name, Span<const float>& to) {
    row(name, to, [](size_t) { return 0.0f; });
  }
  template <class T, class Otherwise>
  void row(const char* name, Span<const T>&, Otherwise) {
    const size_t flag_at = at;
    bool exists = false;
    value(name, exists);
    T number;
    for (uint32_t i = 0; i < curve_count && exists && !ended; ++i) value(name, number);
    if (!ended) rows.push_back({flag_at, curve_count, sizeof(T), exists});
  }
  template <class T, class Fields>
  void list(const char* name, Span<const T>&, uint32_t, Fields visit) {
    List found = {name, at, {}};
    const uint32_t count = count_of(1);
    found.starts.push_back(at);
    for (uint32_t i = 0; i < count && !ended; ++i) {
      T element = {};
      visit(element);
      found.starts.push_back(at);
    }
    if (!ended) lists.push_back(found);
  }
  void keep(const GazeTable&, const GazeTable*&) {}
  void names(const char* name, uint32_t variable_count) {
    List found = {name, at, {}};
    const uint32_t count = count_of(sizeof(uint32_t));
    found.starts.push_back(at);
    for (uint32_t i = 0; i < count && !ended; ++i) {
      skip(number<uint32_t>(0));
      found.starts.push_back(at);
    }
    if (!ended) lists.push_back(found);
    // Rows of more curves than there are bytes do not fit anyway.
    curve_count = std::min<uint32_t>(count + std::min(variable_count, kMaxCurves), kMaxCurves);
  }
};

class MixMutator {
 public:
  MixMutator(Bytes& mix, uint32_t seed) : mix_(mix), random_(seed) {
    for (int i = 0; i < 3; ++i) random_();  // the first numbers of near seeds are near
  }

  void change() {
    const MixPlaces places({mix_.data(), mix_.size()});
    switch (below(8)) {
      case 0: return change_list(places);
      case 1: return change_curves(places);
      case 2: return change_row(places);
      case 3: return copy_field(places);
      default: return change_field(places);
    }
  }

  /// An element of the same list of another mix.
  void take_element(Span<const uint8_t> other) {
    const MixPlaces to({mix_.data(), mix_.size()}), from(other);
    if (to.lists.empty()) return;
    const MixPlaces::List& into = to.lists[below(to.lists.size())];
    for (const MixPlaces::List& list : from.lists) {
      const size_t count = list.starts.size() - 1;
      if (list.name != into.name || count == 0) continue;
      const size_t e = below(count);
      insert(into.starts[below(into.starts.size())],
             Bytes(other.data + list.starts[e], other.data + list.starts[e + 1]));
      return add(into.count_at, 1);
    }
  }

  /// Size and checksum as they have to be.
  void seal() {
    if (mix_.size() < kMixHeaderSize) return;
    store_little_endian(mix_.data() + kAtSize, uint64_t{mix_.size()});
    store_little_endian(mix_.data() + kAtChecksum, clip_checksum(mix_.data(), mix_.size()));
  }

 private:
  uint32_t below(size_t end) { return static_cast<uint32_t>(random_() % end); }
  void insert(size_t at, const Bytes& bytes) {
    mix_.insert(mix_.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin(), bytes.end());
  }
  Bytes copy(size_t from, size_t to) const { return Bytes(mix_.data() + from, mix_.data() + to); }
  void erase(size_t from, size_t to) {
    mix_.erase(mix_.begin() + static_cast<std::ptrdiff_t>(from),
               mix_.begin() + static_cast<std::ptrdiff_t>(to));
  }
  void add(size_t count_at, uint32_t n) {
    const auto count = load_little_endian<uint32_t>(mix_.data() + count_at);
    store_little_endian(mix_.data() + count_at, count + n);
  }

  void change_list(const MixPlaces& places) {
    if (places.lists.empty()) return;
    const MixPlaces::List& list = places.lists[below(places.lists.size())];
    const size_t count = list.starts.size() - 1;
    if (count == 0) return;
    const size_t e = below(count), begin = list.starts[e], end = list.starts[e + 1];
    const Bytes element = copy(begin, end);
    // Later bytes first, so that places before them stay where they are.
    switch (below(3)) {
      case 0: erase(begin, end); return add(list.count_at, ~uint32_t{0});
      case 1: {
        const uint32_t times = below(16) == 0 ? 64 : 1;
        for (uint32_t i = 0; i < times; ++i) insert(end, element);
        return add(list.count_at, times);
      }
      default:  // to another place
        insert(list.starts[below(e + 1)], element);
        erase(begin + element.size(), end + element.size());
    }
  }

  void change_curves(const MixPlaces& places) {
    if (places.curve_lists.empty()) return;
    const MixPlaces::Curves& list = places.curve_lists[below(places.curve_lists.size())];
    const size_t first = list.count_at + sizeof(uint32_t),
                 values = first + list.count * sizeof(uint16_t);
    const uint32_t i = below(size_t{list.count} + 1);
    if (below(2) == 0 && i < list.count) {
      if (list.has_values) erase(values + i * sizeof(float), values + (i + 1) * sizeof(float));
      erase(first + i * sizeof(uint16_t), first + (i + 1) * sizeof(uint16_t));
      return add(list.count_at, ~uint32_t{0});
    }
    if (list.has_values) insert(values + i * sizeof(float), {0, 0, 0, 0x3F});
    insert(first + i * sizeof(uint16_t), {static_cast<uint8_t>(below(12)), 0});
    add(list.count_at, 1);
  }

  void change_row(const MixPlaces& places) {
    if (places.rows.empty()) return;
    const MixPlaces::Row& row = places.rows[below(places.rows.size())];
    const size_t begin = row.flag_at + 1, size = size_t{row.count} * row.size;
    mix_[row.flag_at] = !row.exists;
    if (row.exists) {
      erase(begin, begin + size);
    } else {
      insert(begin, Bytes(size, 0));
    }
  }

  void copy_field(const MixPlaces& places) {
    if (places.fields.empty()) return;
    const MixPlaces::Field& to = places.fields[below(places.fields.size())];
    const MixPlaces::Field& from = places.fields[below(places.fields.size())];
    const size_t size = std::min(to.size, from.size);
    const Bytes value = copy(from.at, from.at + size);
    std::copy(value.begin(), value.end(), mix_.begin() + static_cast<std::ptrdiff_t>(to.at));
  }

  void change_field(const MixPlaces& places) {
    if (places.fields.empty()) return;
    const MixPlaces::Field& field = places.fields[below(places.fields.size())];
    uint8_t* const at = mix_.data() + field.at;
    if (field.choices != 0) {
      *at = static_cast<uint8_t>(below(field.choices + (below(8) == 0)));
    } else if (field.size == 2) {
      const auto old = load_little_endian<uint16_t>(at);
      const uint32_t values[] = {0, 1, old + 1u, old - 1u, 0xFFFF, below(12)};
      store_little_endian(at, static_cast<uint16_t>(values[below(std::size(values))]));
    } else if (field.size == 4) {
      const auto old = load_little_endian<uint32_t>(at);
      // Small counts, and floats: 1, -1, 1/2, the largest, the smallest, infinity, no number.
      const uint32_t values[] = {
          0,          1,          old + 1,    old - 1,    ~0u,
          64,         below(12),  0x3F800000, 0xBF800000, 0x3F000000,
          0x7F7FFFFF, 0x00000001, 0x7F800000, 0x7FC00000, old ^ 1u << below(32)};
      store_little_endian(at, values[below(std::size(values))]);
    } else if (field.size == 8) {
      const auto old = load_little_endian<uint64_t>(at);
      const uint64_t values[] = {
          0,       1,       ~uint64_t{0}, uint64_t{kTicksPerSecond},      old * 2,
          old / 2, old + 1, old - 1,      old ^ uint64_t{1} << below(64), ~uint64_t{0} >> 1};
      store_little_endian(at, values[below(std::size(values))]);
    } else {
      *at = static_cast<uint8_t>(below(256));
    }
  }

  Bytes& mix_;
  std::minstd_rand random_;
};

}  // namespace mien
