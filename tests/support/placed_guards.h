// SPDX-License-Identifier: MIT
// Guards for rows of all curves, as tests have them.
#pragma once

#include <vector>

#include "runtime/mix/guard.h"

namespace mien {

struct PlacedGuards {
  using Row = std::vector<float>;
  struct alignas(kBlockAlignment) Line {
    uint8_t bytes[kBlockAlignment];
  };
  std::vector<Guard> as_given;
  std::vector<Line> block;
  GuardTable table;

  explicit PlacedGuards(const std::vector<Guard>& guards) : as_given(guards) {
    const Span<const Guard> all = {as_given.data(), as_given.size()};
    const KernelTable* const kernels = kernels_for(Isa::kBest);
    Placer measure(nullptr);
    place_guards(measure, all, kernels, table);
    block.resize(measure.size() / sizeof(Line));
    Placer placer(block.data());
    place_guards(placer, all, kernels, table);
  }
  PlacedGuards(const PlacedGuards&) = delete;

  Row row_of(const Row& row) const {
    Row some(table.width);
    for (size_t i = 0; i < table.curves.count; ++i) some[i] = row[table.curves[i]];
    return some;
  }
  Row distances(const Row& row) const {
    alignas(kBlockAlignment) float all[kMaxGuards];
    guard_distances(table, row_of(row).data(), all);
    return Row(all, all + as_given.size());
  }

  /// How far they want each curve back; with a negative activation as active as they find themselves.
  Row back(const Row& protected_row, const Row& free_row, float activation) const {
    const Row before = row_of(protected_row), free = row_of(free_row);
    const Row open = distances(protected_row);
    Row some(before.size()), left(before.size()), activations;
    for (size_t g = 0; g < as_given.size(); ++g) {
      const float own = guard_activation(as_given[g], open[g]);
      activations.push_back(activation < 0 ? own : activation);
    }
    hold_guards(table, before.data(), open.data(), activations.data(), free.data(), some.data(),
                left.data());
    Row all(free_row.size());
    for (size_t i = 0; i < table.curves.count; ++i) all[table.curves[i]] = some[i];
    return all;
  }
};

}  // namespace mien
