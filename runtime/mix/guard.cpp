// SPDX-License-Identifier: MIT
#include "runtime/mix/guard.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/base/bits.h"
#include "runtime/base/vectors.h"

namespace mien {
namespace {

constexpr uint32_t kQuad = 4;
constexpr float kEnough = 5e-5f;  // millimeters beyond a limit that are not worth another sweep

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

/// Takes lanes back by what closes `excess` millimeters: `most` keeps the most that any guard wants.
void hold_guard(const Guard& guard, const float* protected_row, float excess, Values& values,
                float* most) {
  uint32_t pairs_of[kMaxGuardLanes];  // bit p: pair p has the lane
  for (uint32_t i = 0; i < guard.count; ++i) pairs_of[i] = 0;
  for (uint32_t p = 0; p < guard.pair_count; ++p) {
    pairs_of[guard.pairs[p].first] |= 1u << p;
    pairs_of[guard.pairs[p].second] |= 1u << p;
  }
  float move[kMaxGuardLanes];
  for (uint32_t begin = 0, end; begin < guard.count && excess > 0; begin = end) {
    end = begin + 1 + (guard.together >> (begin + 1) & 1);
    float opens = 0;
    for (uint32_t i = begin; i < end; ++i) {
      move[i] = 0;
      const float change = values.of[i] - protected_row[guard.lanes[i]];
      if (change == 0) continue;
      // By how much the distance grows with the lane while the others are as they have become.
      float slope = guard.gains[i];
      for (uint32_t left = pairs_of[i]; left != 0; left &= left - 1) {
        const GuardPair& pair = guard.pairs[lowest_bit(left)];
        slope += pair.gain * values.of[pair.first == i ? pair.second : pair.first];
      }
      if (!(slope * change > 0)) continue;
      opens += slope * change;
      move[i] = change;
    }
    if (!(opens > 0)) continue;
    // What a pair of the two makes of it: counted in full, so that the share is never too small.
    float both = 0;
    if (end - begin == 2) {
      for (uint32_t left = pairs_of[begin] & pairs_of[begin + 1]; left != 0; left &= left - 1) {
        both += guard.pairs[lowest_bit(left)].gain * move[begin] * move[begin + 1];
      }
    }
    const float closes = opens - higher(both, 0.0f);
    const float share = closes > excess ? excess / closes : 1;
    excess -= share * (opens - share * both);
    for (uint32_t i = begin; i < end; ++i) {
      const float moved = share * move[i];
      values.of[i] -= moved;
      float& of_lane = most[guard.lanes[i]];
      if (std::fabs(moved) > std::fabs(of_lane)) of_lane = moved;
    }
  }
}

}  // namespace

float guard_distance(const Guard& guard, const float* row) {
  return distance(guard, Values(guard, row));
}

float guard_activation(const Guard& guard, float distance) {
  const float u = 1 - std::min(std::max(distance / guard.f_on, 0.0f), 1.0f);
  return u * u * (3 - 2 * u);
}

void hold_guards(Span<const Guard> guards, const float* protected_row, const float* distances,
                 const float* activations, const float* free_row, uint32_t count, float* back,
                 float* row) {
  memset(back, 0, count * sizeof(float));
  memcpy(row, free_row, count * sizeof(float));
  float more[kMaxGuards * kMaxGuardLanes];
  float limits[kMaxGuards];
  uint32_t limited = 0;  // bit g: the limit of guard g is known
  bool moved = true;
  for (uint32_t sweep = 0; moved && sweep < kGuardSweeps; ++sweep) {
    moved = false;
    for (uint32_t g = 0; g < guards.count; ++g) {
      if (!(activations[g] > 0)) continue;
      const Guard& guard = guards[g];
      Values values(guard, row);
      const float open = distance(guard, values);
      if ((limited >> g & 1) == 0) {
        const float excess = open - higher(distances[g], 0.0f) - guard.tolerance;
        if (!(excess > 0)) continue;
        limits[g] = open - activations[g] * excess;
        limited |= 1u << g;
      } else if (!(open > limits[g] + kEnough)) {
        continue;
      }
      if (!moved) memset(more, 0, count * sizeof(float));
      moved = true;
      hold_guard(guard, protected_row, open - limits[g], values, more);
    }
    for (uint32_t i = 0; moved && i < count; ++i) {
      back[i] += more[i];
      row[i] = free_row[i] - back[i];
    }
  }
}

void ease_guards(const float* free_row, const float* protected_row, const float* back,
                 uint32_t count, float max_change, float* __restrict held, float* __restrict row) {
  for (uint32_t i = 0; i < count; ++i) {
    const float eased = held[i] + lower(higher(back[i] - held[i], -max_change), max_change);
    const float change = free_row[i] - protected_row[i];
    const float now = lower(higher(eased, lower(change, 0.0f)), higher(change, 0.0f));
    held[i] = now;
    // By bits: a branch would keep compilers from making vectors of the loop.
    const uint32_t all = ((now == change) & (now != 0)) ? ~0u : 0;
    row[i] = float_of((bits_of(protected_row[i]) & all) | (bits_of(free_row[i] - now) & ~all));
  }
}

}  // namespace mien
