// SPDX-License-Identifier: MIT
#include "runtime/load/dna/format/quaternion_columns.h"

#include <algorithm>
#include <cmath>

namespace mien::dna {
namespace {

constexpr uint32_t kNone = ~uint32_t{0};

/// [column]: the first turning row with an entry, or kNone.
void find_first_rows(const DnaView& view, const JointGroup& group,
                     const Span<uint32_t>& first_rows) {
  const uint32_t columns = group.input_indices.count;
  std::fill(first_rows.begin(), first_rows.begin() + columns, kNone);
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    if (!is_quaternion_row(view, group.output_indices[r])) continue;
    for (uint32_t c = 0; c < columns; ++c) {
      if (first_rows[c] != kNone) continue;
      if (std::fabs(group.values[size_t{r} * columns + c]) > 0.0f) first_rows[c] = r;
    }
  }
}

}  // namespace

uint32_t order_quaternion_columns(const DnaView& view, const JointGroup& group,
                                  const Span<uint32_t>& first_rows, const Span<uint32_t>& order,
                                  uint32_t* columns_at_lod) {
  find_first_rows(view, group, first_rows);
  const auto rows_at = [&](uint32_t lod) -> uint32_t {
    return lod < group.lods.count ? group.lods[lod] : 0;
  };
  uint32_t count = 0;
  for (uint32_t c = 0; c < group.input_indices.count; ++c) {
    if (first_rows[c] < rows_at(0)) order[count++] = c;
  }
  // A column that a LOD does not need is exchanged with the last one that it may use.
  uint32_t used = count;
  for (uint32_t l = 0; l < view.desc.lod_count; ++l) {
    // All behind i are needed, so the one that comes to i by the exchange is, too.
    for (uint32_t i = used; i-- > 0;) {
      if (first_rows[order[i]] >= rows_at(l)) std::swap(order[i], order[--used]);
    }
    if (columns_at_lod) columns_at_lod[l] = used;
  }
  return count;
}

}  // namespace mien::dna
