// SPDX-License-Identifier: MIT
#include "runtime/mix/guard.h"

#include <algorithm>
#include <cmath>

namespace mien {
namespace {

void gather(const Guard& guard, const float* row, float* values) {
  for (uint32_t i = 0; i < guard.count; ++i) values[i] = row[guard.lanes[i]];
}

float distance(const Guard& guard, const float* values) {
  float sum = guard.rest;
  for (uint32_t i = 0; i < guard.count; ++i) sum += guard.gains[i] * values[i];
  for (uint32_t i = 0; i < guard.pair_count; ++i) {
    const GuardPair& pair = guard.pairs[i];
    sum += pair.gain * values[pair.first] * values[pair.second];
  }
  return sum;
}

/// By how much the distance grows with each lane while the others stay.
void find_slopes(const Guard& guard, const float* values, float* slopes) {
  std::copy(guard.gains, guard.gains + guard.count, slopes);
  for (uint32_t i = 0; i < guard.pair_count; ++i) {
    const GuardPair& pair = guard.pairs[i];
    slopes[pair.first] += pair.gain * values[pair.second];
    slopes[pair.second] += pair.gain * values[pair.first];
  }
}

}  // namespace

float guard_distance(const Guard& guard, const float* row) {
  float values[kMaxGuardLanes];
  gather(guard, row, values);
  return distance(guard, values);
}

float guard_activation(const Guard& guard, const float* protected_row) {
  const float open = guard_distance(guard, protected_row) / guard.f_on;
  const float u = 1 - std::min(std::max(open, 0.0f), 1.0f);
  return u * u * (3 - 2 * u);
}

void hold_guard(const Guard& guard, const float* protected_row, float activation, float* row) {
  if (!(activation > 0)) return;
  float before[kMaxGuardLanes], values[kMaxGuardLanes];
  gather(guard, protected_row, before);
  gather(guard, row, values);
  const float limit = std::max(distance(guard, before), 0.0f) + guard.tolerance;
  float excess = distance(guard, values) - limit;
  if (!(excess > 0)) return;
  float slopes[kMaxGuardLanes];
  find_slopes(guard, values, slopes);
  for (uint32_t i = 0; i < guard.count && excess > 0; ++i) {
    const float change = values[i] - before[i];
    if (change == 0) continue;
    const float opens = slopes[i] * change;
    if (!(opens > 0)) continue;
    const float back = opens > excess ? excess / slopes[i] : change;
    excess -= std::min(opens, excess);
    row[guard.lanes[i]] -= activation * back;
    for (uint32_t p = 0; p < guard.pair_count; ++p) {
      const GuardPair& pair = guard.pairs[p];
      if (pair.first == i) slopes[pair.second] -= pair.gain * back;
      if (pair.second == i) slopes[pair.first] -= pair.gain * back;
    }
  }
}

void ease_guards(const float* free_row, const float* protected_row, uint32_t count,
                 float max_change, float* held, float* row) {
  for (uint32_t i = 0; i < count; ++i) {
    const float wanted = free_row[i] - row[i];
    if (wanted == 0 && held[i] == 0) continue;
    const float eased = held[i] + std::min(std::max(wanted - held[i], -max_change), max_change);
    const float change = free_row[i] - protected_row[i];
    held[i] = std::min(std::max(eased, std::min(change, 0.0f)), std::max(change, 0.0f));
    if (held[i] != wanted) row[i] = free_row[i] - held[i];
  }
}

}  // namespace mien
