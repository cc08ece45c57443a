// SPDX-License-Identifier: MIT
// Guards for rows of all lanes, as tests have them.
#pragma once

#include <vector>

#include "runtime/mix/guard.h"

namespace mien {

struct PlacedGuards {
  using Row = std::vector<float>;
  std::vector<Guard> as_given;
  std::vector<uint16_t> lanes;
  std::vector<PlacedGuard> placed;

  explicit PlacedGuards(const std::vector<Guard>& guards)
      : as_given(guards), lanes(kMaxGuardedLanes), placed(guards.size()) {
    lanes.resize(list_guarded_lanes({guards.data(), guards.size()}, lanes.data()));
    for (size_t g = 0; g < guards.size(); ++g) {
      place_guard(guards[g], {lanes.data(), lanes.size()}, placed[g]);
    }
  }

  Row row_of(const Row& row) const {
    Row some(placed[0].width);
    for (size_t i = 0; i < lanes.size(); ++i) some[i] = row[lanes[i]];
    return some;
  }

  /// How far they want each lane back; with a negative activation as active as they find themselves.
  Row back(const Row& protected_row, const Row& free_row, float activation) const {
    const Row before = row_of(protected_row), free = row_of(free_row);
    Row some(before.size()), left(before.size());
    std::vector<float> distances, activations;
    for (size_t g = 0; g < placed.size(); ++g) {
      distances.push_back(guard_distance(placed[g], before.data()));
      const float own = guard_activation(as_given[g], distances.back());
      activations.push_back(activation < 0 ? own : activation);
    }
    hold_guards({placed.data(), placed.size()}, before.data(), distances.data(), activations.data(),
                free.data(), some.data(), left.data());
    Row all(free_row.size());
    for (size_t i = 0; i < lanes.size(); ++i) all[lanes[i]] = some[i];
    return all;
  }
};

}  // namespace mien
