// SPDX-License-Identifier: MIT
#include "runtime/derive/jacobian.h"

#include "runtime/derive/dependencies.h"
#include "runtime/derive/derive_stages.h"

namespace mien {
namespace {

constexpr size_t kSetSize = 64;      // columns at a time
constexpr uint64_t kMostLooks = 64;  // at each entry while coloring

size_t column_count(const Derivatives& d, const JacobianArgs& args) {
  return args.inputs.data ? args.inputs.count : point_size(d, args.from, args.mesh);
}
size_t row_count(const Derivatives& d, const JacobianArgs& args) {
  return args.outputs.data ? args.outputs.count : point_size(d, args.to, args.mesh);
}
size_t input_place(const JacobianArgs& args, size_t column) {
  return place_in_buffer(args.from, args.inputs.data ? args.inputs[column] : column);
}
size_t output_place(const JacobianArgs& args, size_t row) {
  return place_in_buffer(args.to, args.outputs.data ? args.outputs[row] : row);
}

/// Calls f(row, column) for all entries: 64 columns after the other, by row in each.
template <class F>
void for_each_entry(const Derivatives& d, const JacobianArgs& args, const Dependencies& s, F&& f) {
  const size_t columns = column_count(d, args), rows = row_count(d, args);
  for (size_t first = 0; first < columns; first += kSetSize) {
    std::fill(s.sets.begin(), s.sets.end(), uint64_t{0});
    for (size_t k = 0; k < std::min(kSetSize, columns - first); ++k) {
      const size_t at = input_place(args, first + k);
      if (at != kNoPlace) s.at(args.from)[at] |= uint64_t{1} << k;
    }
    find_dependencies(s, args.from, args.to);
    for (size_t r = 0; r < rows; ++r) {
      const size_t at = output_place(args, r);
      uint64_t set = at == kNoPlace ? 0 : s.at(args.to)[at];
      for (size_t k = 0; set != 0; ++k, set >>= 1) {
        if (set & 1) f(r, first + k);
      }
    }
  }
}

void place_jacobian(size_t rows, size_t columns, size_t used, size_t entries, Placer& placer,
                    Jacobian& j) {
  j.first_entry = placer.array<uint64_t>(columns + 1);
  j.rows = placer.unwritten_array<uint32_t>(entries);
  j.columns = placer.unwritten_array<uint32_t>(entries);
  j.row_places = placer.array<uint32_t>(rows);
  j.column_places = placer.array<uint32_t>(columns);
  j.by_color = placer.array<uint32_t>(used);
  j.first_of_color = placer.array<uint32_t>(used + 1);
}

/// Greedy coloring, fullest columns first: a color takes each column that fits those it has. So every column gets the
/// first color that fits. `left` are the columns; `taken` is memory for a number per row.
void color_columns(Jacobian& j, const Span<uint32_t>& left, const Span<uint32_t>& taken) {
  const auto size = [&](uint32_t c) { return j.first_entry[c + 1] - j.first_entry[c]; };
  std::sort(left.begin(), left.end(),
            [&](uint32_t a, uint32_t b) { return size(a) != size(b) ? size(a) > size(b) : a < b; });
  std::fill(taken.begin(), taken.end(), 0u);
  uint64_t looks = 0;
  uint32_t color = 0, colored = 0;
  size_t count = left.count;
  while (count != 0 && looks < kMostLooks * j.rows.count) {
    j.first_of_color[color++] = colored;
    size_t kept = 0;
    for (const uint32_t c : left.first(count)) {
      bool fits = true;
      for (uint64_t e = j.first_entry[c]; fits && e < j.first_entry[c + 1]; ++e) {
        fits = taken[j.rows[e]] != color;
        ++looks;
      }
      if (!fits) {
        left[kept++] = c;
        continue;
      }
      for (uint64_t e = j.first_entry[c]; e < j.first_entry[c + 1]; ++e) taken[j.rows[e]] = color;
      j.by_color[colored++] = c;
    }
    count = kept;
  }
  // That would take too long: the other columns get a color each.
  for (const uint32_t c : left.first(count)) {
    j.first_of_color[color++] = colored;
    j.by_color[colored++] = c;
  }
  j.first_of_color[color] = colored;
  j.first_of_color = j.first_of_color.first(color + 1);
}

}  // namespace

Jacobian* create_jacobian(const Derivatives& d, const JacobianArgs& args,
                          const Allocator& allocator) {
  const size_t columns = column_count(d, args), rows = row_count(d, args);
  Arena arena(allocator);
  Dependencies dependencies;
  const Span<uint64_t> counts = arena.array<uint64_t>(columns + 1);
  const Span<uint32_t> left = arena.array<uint32_t>(columns + 1);
  const Span<uint32_t> taken = arena.array<uint32_t>(rows + 1);
  if (!counts.data || !left.data || !taken.data ||
      !place_dependencies(d, args.to, args.mesh, args.lod, arena, dependencies)) {
    return nullptr;
  }
  uint64_t entries = 0;
  size_t used = 0;
  for_each_entry(d, args, dependencies, [&](size_t, size_t column) {
    used += counts[column]++ == 0;
    ++entries;
  });
  if (entries > SIZE_MAX / 16) return nullptr;
  auto* const j = create_object<Jacobian>(allocator, [&](Placer& placer, Jacobian& placed) {
    place_jacobian(rows, columns, used, static_cast<size_t>(entries), placer, placed);
  });
  if (!j) return nullptr;
  j->rig = share(*d.rig);
  if (d.deformer) j->deformer = share(*d.deformer);
  j->from = args.from;
  j->to = args.to;
  j->mesh = args.mesh;
  j->lod = args.lod;
  used = 0;
  for (size_t c = 0; c < columns; ++c) {
    j->first_entry[c + 1] = j->first_entry[c] + counts[c];
    if (counts[c] != 0) left[used++] = static_cast<uint32_t>(c);
    counts[c] = j->first_entry[c];
    const size_t place = input_place(args, c);
    j->column_places[c] = place == kNoPlace ? 0 : static_cast<uint32_t>(place);
  }
  for (size_t r = 0; r < rows; ++r) {
    const size_t place = output_place(args, r);
    j->row_places[r] = place == kNoPlace ? 0 : static_cast<uint32_t>(place);
  }
  for_each_entry(d, args, dependencies, [&](size_t row, size_t column) {
    const auto at = static_cast<size_t>(counts[column]++);
    j->rows[at] = static_cast<uint32_t>(row);
    j->columns[at] = static_cast<uint32_t>(column);
  });
  color_columns(*j, left.first(used), taken);
  return j;
}

}  // namespace mien
