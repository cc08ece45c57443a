// SPDX-License-Identifier: MIT
// Shared by the generators: arrays, lists and names in an arena, and LOD maps.
#pragma once

#include <algorithm>
#include <cstring>
#include <iterator>

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

// Allocation in an arena; false if memory ran out -----------------------------------------------

template <class T>
bool make(Arena& arena, size_t count, dna::NewArray<T>& out) {
  out = dna::new_array<T>(arena, count);
  return count == 0 || out.data;
}

template <class T>
bool make(Arena& arena, size_t count, Span<T>& out) {
  out = arena.array<T>(count);
  return out.count == count;
}

template <class T>
bool make(Arena& arena, size_t count, dna::List<T>& out) {
  Span<T> items;
  if (!make(arena, count, items)) return false;
  out = {items.data, static_cast<uint32_t>(count)};
  return true;
}

/// A name that is being built.
struct Text {
  char chars[256];
  uint32_t count = 0;

  Text& add(const char* from, size_t n) {
    assert(n <= sizeof(chars) - count);
    memcpy(chars + count, from, n);
    count += static_cast<uint32_t>(n);
    return *this;
  }
  Text& add(const char* terminated) { return add(terminated, strlen(terminated)); }
  Text& add(dna::String s) { return add(s.chars(), s.count); }
  Text& add(uint64_t number) {
    char digits[20];
    size_t n = sizeof(digits);
    do digits[--n] = static_cast<char>('0' + number % 10);
    while (number /= 10);
    return add(digits + n, sizeof(digits) - n);
  }
};

inline bool copy_text(Arena& arena, const Text& text, dna::String& out) {
  uint8_t* chars = static_cast<uint8_t*>(arena.allocate(text.count, 1));
  if (!chars) return false;
  memcpy(chars, text.chars, text.count);
  out = {chars, text.count};
  return true;
}

/// An array of vectors that is being filled.
struct NewVec3s {
  dna::NewArray<float> xs, ys, zs;

  bool allocate(Arena& arena, size_t count) {
    return make(arena, count, xs) && make(arena, count, ys) && make(arena, count, zs);
  }
  void set(size_t i, Vec3 v) const {
    xs.set(i, static_cast<float>(v.x));
    ys.set(i, static_cast<float>(v.y));
    zs.set(i, static_cast<float>(v.z));
  }
  operator dna::Vec3Array() const { return {xs, ys, zs}; }
};

/// An index of the layers that files of version 2.version have.
inline bool fill_index(uint16_t version, Arena& arena, dna::DnaView& out) {
  const auto known = [version](const dna::LayerKind& kind) { return kind.since <= version; };
  const auto& kinds = dna::kLayerKinds;
  const auto count = std::count_if(std::begin(kinds), std::end(kinds), known);
  if (!make(arena, static_cast<size_t>(count), out.index)) return false;
  size_t i = 0;
  for (const dna::LayerKind& kind : kinds) {
    if (!known(kind)) continue;
    out.index[i].code = kind.code;
    out.index[i++].layer_version = kind.layer_version;
  }
  out.version = version;
  out.loaded = dna::kLayersAll;
  return true;
}

/// `in_lod(lod, element)` tells which elements a LOD has. Equal neighboring lists are stored once.
template <class InLod>
bool make_lod_map(Arena& arena, size_t lod_count, size_t element_count, const InLod& in_lod,
                  dna::LodMap& out) {
  dna::NewArray<uint16_t> lods;
  dna::List<dna::Array<uint16_t>> lists;
  if (!make(arena, lod_count, lods) || !make(arena, lod_count, lists)) return false;
  uint32_t used = 0;
  for (size_t lod = 0; lod < lod_count; ++lod) {
    bool same = lod > 0;
    size_t count = 0;
    for (size_t i = 0; i < element_count; ++i) {
      bool in = in_lod(lod, i);
      count += in;
      same = same && in == in_lod(lod - 1, i);
    }
    if (!same) {
      dna::NewArray<uint16_t> list;
      if (!make(arena, count, list)) return false;
      for (size_t i = 0, n = 0; i < element_count; ++i) {
        if (in_lod(lod, i)) list.set(n++, static_cast<uint16_t>(i));
      }
      lists[used++] = list;
    }
    lods.set(lod, static_cast<uint16_t>(used - 1));
  }
  out = {lods, {lists.items, used}};
  return true;
}

/// A group of `rows` (9 * joint + attribute, with the rows of a joint in sequence) and `columns`, with the
/// values value(column, row).
template <class Value>
bool make_joint_group(Arena& arena, dna::Array<uint16_t> lod_rows, Span<const uint16_t> rows,
                      Span<const uint16_t> columns, const Value& value, dna::JointGroup& out) {
  size_t joints = 0;
  const auto begins = [&rows](size_t r) { return r == 0 || rows[r] / 9 != rows[r - 1] / 9; };
  for (size_t r = 0; r < rows.count; ++r) joints += begins(r);
  dna::NewArray<uint16_t> inputs, outputs, members;
  dna::NewArray<float> values;
  if (!make(arena, columns.count, inputs) || !make(arena, rows.count, outputs) ||
      !make(arena, rows.count * columns.count, values) || !make(arena, joints, members)) {
    return false;
  }
  for (size_t c = 0; c < columns.count; ++c) inputs.set(c, columns[c]);
  size_t member = 0;
  for (size_t r = 0; r < rows.count; ++r) {
    outputs.set(r, rows[r]);
    if (begins(r)) members.set(member++, static_cast<uint16_t>(rows[r] / 9));
    for (size_t c = 0; c < columns.count; ++c) {
      values.set(r * columns.count + c, value(columns[c], rows[r]));
    }
  }
  out = {lod_rows, inputs, outputs, values, members};
  return true;
}

}  // namespace mien::author
