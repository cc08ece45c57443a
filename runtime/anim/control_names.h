// SPDX-License-Identifier: MIT
// How names of controls match: without regard to case, `.` matches `_`, and the prefix `CTRL_expressions.`
// may be missing. If several names match, one of them must be equal.
#pragma once

#include <algorithm>

#include "runtime/anim/clip.h"
#include "runtime/rig/rig.h"

namespace mien {

constexpr uint32_t kNoName = ~uint32_t{0};

inline char folded(char c) {
  return c == '.' ? '_' : c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
}

inline int compare_folded(Span<const char> a, Span<const char> b) {
  for (size_t i = 0; i < a.count && i < b.count; ++i) {
    const char x = folded(a[i]), y = folded(b[i]);
    if (x != y) return x < y ? -1 : 1;
  }
  return a.count < b.count ? -1 : a.count > b.count ? 1 : 0;
}

inline Span<const char> without_prefix(Span<const char> name) {
  constexpr char kPrefix[] = "ctrl_expressions_";
  constexpr size_t kLength = sizeof(kPrefix) - 1;
  if (name.count <= kLength || compare_folded(name.first(kLength), {kPrefix, kLength}) != 0) {
    return name;
  }
  return name.slice(kLength, name.count - kLength);
}

/// Names in the order of their folded form. `Names` gives the i-th one by name(i).
template <class Names>
struct NameIndex {
  const Names& names;
  Span<uint16_t> order;

  int compare(uint16_t i, Span<const char> key) const {
    return compare_folded(without_prefix(names.name(i)), key);
  }
  void sort() {
    for (size_t i = 0; i < order.count; ++i) order[i] = static_cast<uint16_t>(i);
    std::sort(order.begin(), order.end(), [&](uint16_t a, uint16_t b) {
      const int order_of_names = compare(a, without_prefix(names.name(b)));
      return order_of_names != 0 ? order_of_names < 0 : a < b;
    });
  }
  /// kNoName if none matches, or several do and none is equal.
  uint32_t find(Span<const char> name) const {
    bool several;
    return find(name, several);
  }
  uint32_t find(Span<const char> name, bool& several) const {
    several = false;
    const Span<const char> key = without_prefix(name);
    const uint16_t* at =
        std::lower_bound(order.begin(), order.end(), key,
                         [&](uint16_t i, Span<const char> k) { return compare(i, k) < 0; });
    uint32_t matches = 0, found = kNoName;
    for (; at != order.end() && compare(*at, key) == 0; ++at, ++matches) {
      if (compare_names(names.name(*at), name) == 0) return *at;
      found = *at;
    }
    several = matches > 1;
    return matches == 1 ? found : kNoName;
  }
};

/// The element whose name has these bytes; kNoName if there is none.
inline uint32_t find_name(const NameList& names, Span<const char> name) {
  const uint32_t* at = std::lower_bound(
      names.sorted.begin(), names.sorted.end(), name,
      [&](uint32_t i, Span<const char> wanted) { return compare_names(names[i], wanted) < 0; });
  return at != names.sorted.end() && compare_names(names[*at], name) == 0 ? *at : kNoName;
}

struct RigNames {
  const NameList& list;
  Span<const char> name(uint32_t i) const { return list[i]; }
};

}  // namespace mien
