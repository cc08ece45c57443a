// SPDX-License-Identifier: MIT
#include "runtime/mix/guard.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/bits.h"
#include "runtime/base/vectors.h"

namespace mien {
namespace {

constexpr uint32_t kQuad = 4;

/// The guard's lanes of a row, then zeros up to a multiple of four.
struct Values {
  float of[kMaxGuardLanes];

  Values(const Guard& guard, const float* row) {
    const uint16_t* const at = guard.lanes;
    uint32_t i = 0;
    for (; i + kQuad <= guard.count; i += kQuad) {
      store_four(of + i, row[at[i]], row[at[i + 1]], row[at[i + 2]], row[at[i + 3]]);
    }
    if (i == guard.count) return;
    const auto value = [&](uint32_t k) { return i + k < guard.count ? row[at[i + k]] : 0.0f; };
    store_four(of + i, value(0), value(1), value(2), value(3));
  }
};

// By value and without branches, so that compilers make vectors of them.
float higher(float a, float b) { return a > b ? a : b; }
float lower(float a, float b) { return a < b ? a : b; }

float distance(const Guard& guard, const Values& values) {
  // Four sums at a time, which compilers make a vector.
  float sums[kQuad] = {};
  for (uint32_t i = 0; i < guard.count; i += kQuad) {
    for (uint32_t k = 0; k < kQuad; ++k) sums[k] += guard.gains[i + k] * values.of[i + k];
  }
  float pairs = guard.rest;
  for (uint32_t i = 0; i < guard.pair_count; ++i) {
    const GuardPair& pair = guard.pairs[i];
    pairs += pair.gain * values.of[pair.first] * values.of[pair.second];
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]) + pairs;
}

}  // namespace

float guard_distance(const Guard& guard, const float* row) {
  return distance(guard, Values(guard, row));
}

float guard_activation(const Guard& guard, float distance) {
  const float u = 1 - std::min(std::max(distance / guard.f_on, 0.0f), 1.0f);
  return u * u * (3 - 2 * u);
}

void hold_guard(const Guard& guard, const float* protected_row, float closed, float activation,
                float* row) {
  if (!(activation > 0)) return;
  Values values(guard, row);
  float excess = distance(guard, values) - std::max(closed, 0.0f) - guard.tolerance;
  if (!(excess > 0)) return;
  uint32_t pairs_of[kMaxGuardLanes];  // bit p: pair p has the lane
  for (uint32_t i = 0; i < guard.count; ++i) pairs_of[i] = 0;
  for (uint32_t p = 0; p < guard.pair_count; ++p) {
    pairs_of[guard.pairs[p].first] |= 1u << p;
    pairs_of[guard.pairs[p].second] |= 1u << p;
  }
  for (uint32_t i = 0; i < guard.count && excess > 0; ++i) {
    const float change = values.of[i] - protected_row[guard.lanes[i]];
    if (change == 0) continue;
    // By how much the distance grows with the lane while the others are as they have become.
    float slope = guard.gains[i];
    for (uint32_t left = pairs_of[i]; left != 0; left &= left - 1) {
      const GuardPair& pair = guard.pairs[lowest_bit(left)];
      slope += pair.gain * values.of[pair.first == i ? pair.second : pair.first];
    }
    const float opens = slope * change;
    if (!(opens > 0)) continue;
    const float back = opens > excess ? excess / slope : change;
    excess -= std::min(opens, excess);
    values.of[i] -= back;
    row[guard.lanes[i]] -= activation * back;
  }
}

void ease_guards(const float* free_row, const float* protected_row, uint32_t count,
                 float max_change, float* __restrict held, float* __restrict row) {
  for (uint32_t i = 0; i < count; ++i) {
    const float kept = row[i], wanted = free_row[i] - kept;
    const float eased = held[i] + lower(higher(wanted - held[i], -max_change), max_change);
    const float change = free_row[i] - protected_row[i];
    const float now = lower(higher(eased, lower(change, 0.0f)), higher(change, 0.0f));
    held[i] = now;
    // By bits: a branch would keep compilers from making vectors of the loop.
    const uint32_t same = now == wanted ? ~0u : 0;
    row[i] = float_of((bits_of(kept) & same) | (bits_of(free_row[i] - now) & ~same));
  }
}

}  // namespace mien
