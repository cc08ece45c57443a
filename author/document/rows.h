// SPDX-License-Identifier: MIT
// Lists of different lengths in two arrays.
#pragma once

#include "author/base/dna_making.h"

namespace mien::author {

/// Rows of numbers: row r has items[starts[r]] ... items[starts[r + 1] - 1].
struct Rows {
  Span<uint32_t> starts, items;

  Span<const uint32_t> operator[](uint32_t row) const {
    return {items.data + starts[row], starts[row + 1] - starts[row]};
  }
};

/// Builds rows from visit(put), which calls put(row, item) for each item, the same ones each time.
template <class Visit>
bool make_rows(Arena& arena, uint32_t rows, const Visit& visit, Rows& out) {
  if (!make(arena, size_t{rows} + 2, out.starts)) return false;
  visit([&](uint32_t row, uint32_t) { ++out.starts[row + 2]; });
  for (uint32_t r = 0; r < rows; ++r) out.starts[r + 2] += out.starts[r + 1];
  if (!make(arena, out.starts[rows + 1], out.items)) return false;
  visit([&](uint32_t row, uint32_t item) { out.items[out.starts[row + 1]++] = item; });
  return true;
}

}  // namespace mien::author
