// SPDX-License-Identifier: MIT
#include "runtime/mix/guard.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/bits.h"

namespace mien {
namespace {

constexpr float kEnough = 5e-5f;  // millimeters beyond a limit that need no other pass

// By value and without branches, so that compilers vectorize them.
float higher(float a, float b) { return a > b ? a : b; }
float lower(float a, float b) { return a < b ? a : b; }

/// How far a curve may be taken back, and by how much that closes the distance while the others stay as
/// they are; zeros if it opens nothing.
struct Opening {
  float change, closes;
};

/// Takes curves back to close `excess` millimeters: `most` keeps the largest amount that any guard takes.
void hold_guard(const PlacedGuard& guard, uint32_t width, const float* protected_row, float excess,
                const float* row, float* most) {
  float values[kMaxGuardedCurves];
  memcpy(values, row, width * sizeof(float));
  // Other conditions on values are computed without branches, which would be mispredicted.
  const auto opening = [&](uint32_t i) {
    const uint32_t at = guard.places[i];
    const float change = row[at] - protected_row[at];
    if (change == 0) return Opening{};
    float slope = guard.gains[i];
    for (uint32_t p = guard.partner_begins[i]; p < guard.partner_begins[i + 1]; ++p) {
      slope += guard.partners[p].gain * values[guard.partners[p].place];
    }
    const float closes = higher(slope * change, 0.0f);
    return Opening{closes > 0 ? change : 0.0f, closes};
  };
  const auto take_back = [&](uint32_t i, float moved) {
    const uint32_t at = guard.places[i];
    values[at] -= moved;
    const uint32_t size = bits_of(moved) << 1, before = bits_of(most[at]) << 1;
    most[at] = float_of(size > before ? bits_of(moved) : bits_of(most[at]));
  };
  for (uint32_t i = 0; i < guard.count; ++i) {
    const Opening one = opening(i);
    if ((guard.together >> (i + 1) & 1) == 0) {
      if (one.change == 0) continue;
      if (one.closes > excess) return take_back(i, excess / one.closes * one.change);
      excess -= one.closes;
      take_back(i, one.change);
      continue;
    }
    const Opening two = opening(++i);
    const float opens = one.closes + two.closes;
    if (!(opens > 0)) continue;
    // The effect of the product of the two, counted in full, so that the share is never too small.
    const float both = guard.both_gains[i] * one.change * two.change;
    const float closes = opens - higher(both, 0.0f);
    const float share = closes > excess ? excess / closes : 1;
    excess -= share * (opens - share * both);
    take_back(i - 1, share * one.change);
    take_back(i, share * two.change);
    if (!(excess > 0)) return;
  }
}

/// The rest of a row after more was taken off.
void take_off(const float* __restrict free_row, const float* __restrict more, uint32_t width,
              float* __restrict back, float* __restrict row) {
  for (uint32_t i = 0; i < width; ++i) {
    const float all = back[i] + more[i];
    back[i] = all;
    row[i] = free_row[i] - all;
  }
}

}  // namespace

uint32_t guard_group(uint32_t kind) {
  if (kind >= kStandardGuardCount) return 0;
  switch (static_cast<StandardGuard>(kind)) {
    case StandardGuard::kLidsLeft:
    case StandardGuard::kLidsRight: return kGuardsOfLids;
    case StandardGuard::kTeeth: return kGuardsOfTeeth;
    default: return kGuardsOfLips;
  }
}

const char* guard_name(uint32_t kind) {
  constexpr const char* kNames[kStandardGuardCount] = {
      "lips left", "lips center", "lips right", "lower lip to teeth",
      "left lids", "right lids",  "teeth"};
  return kind < kStandardGuardCount ? kNames[kind] : "custom";
}

float guard_distance(const Guard& guard, const float* row) {
  float sum = guard.rest;
  for (uint32_t i = 0; i < guard.count; ++i) sum += guard.gains[i] * row[guard.curves[i]];
  for (uint32_t i = 0; i < guard.pair_count; ++i) {
    const GuardPair& pair = guard.pairs[i];
    sum += pair.gain * row[guard.curves[pair.first]] * row[guard.curves[pair.second]];
  }
  return sum;
}

float guard_activation(const Guard& guard, float distance) {
  const float u = 1 - std::min(std::max(distance / guard.f_on, 0.0f), 1.0f);
  return u * u * (3 - 2 * u);
}

namespace {

/// Lists the curves of all guards in ascending order; returns their number.
size_t list_curves(Span<const Guard> guards, uint16_t* curves) {
  uint16_t* end = curves;
  for (const Guard& guard : guards) end = std::copy(guard.curves, guard.curves + guard.count, end);
  std::sort(curves, end);
  return static_cast<size_t>(std::unique(curves, end) - curves);
}

/// The index of a product in the list, which it is added to if it is new.
uint32_t find_product(uint16_t a, uint16_t b, uint16_t* products, uint32_t& count) {
  if (a > b) std::swap(a, b);
  uint32_t i = 0;
  while (i < count && (products[2 * i] != a || products[2 * i + 1] != b)) ++i;
  if (i == count) {
    products[2 * i] = a;
    products[2 * i + 1] = b;
    ++count;
  }
  return i;
}

void place_guard(const Guard& guard, Span<const uint16_t> curves, PlacedGuard& out) {
  out.count = guard.count;
  out.together = guard.together;
  out.tolerance = guard.tolerance;
  for (uint32_t i = 0; i < guard.count; ++i) {
    const uint16_t* const end = curves.data + curves.count;
    out.places[i] =
        static_cast<uint16_t>(std::lower_bound(curves.data, end, guard.curves[i]) - curves.data);
    out.gains[i] = guard.gains[i];
  }
  uint16_t partners = 0;
  for (uint32_t i = 0; i < guard.count; ++i) {
    for (uint32_t p = 0; p < guard.pair_count; ++p) {
      const GuardPair& pair = guard.pairs[p];
      if (pair.first != i && pair.second != i) continue;
      const uint32_t other = pair.first == i ? pair.second : pair.first;
      out.partners[partners++] = {out.places[other], pair.gain};
      if (other + 1 == i) out.both_gains[i] += pair.gain;
    }
    out.partner_begins[i + 1] = partners;
  }
}

constexpr uint32_t round_up(size_t count, uint32_t step) {
  return static_cast<uint32_t>((count + step - 1) / step * step);
}

}  // namespace

void place_guards(Placer& placer, Span<const Guard> guards, const KernelTable* kernels,
                  GuardTable& out) {
  size_t max_curves = 0, max_products = 0;
  for (const Guard& guard : guards) {
    max_curves += guard.count;
    max_products += guard.pair_count;
  }
  max_products = round_up(max_products, 4);
  out.curves = placer.array<uint16_t>(max_curves);
  out.guards = placer.array<PlacedGuard>(guards.count);
  const Span<uint16_t> products = placer.array<uint16_t>(2 * max_products);
  const Span<float> gains = placer.array<float>(
      (1 + round_up(max_curves, kGuardStep) + max_products) * kGuardVector, kBlockAlignment);
  out.kernels = kernels;
  if (placer.measuring()) return;
  out.curves.count = list_curves(guards, out.curves.data);
  out.width = round_up(out.curves.count, kGuardStep);
  uint32_t product_count = 0;
  for (size_t g = 0; g < guards.count; ++g) {
    const Guard& guard = guards[g];
    PlacedGuard& placed = out.guards[g];
    place_guard(guard, out.curves, placed);
    gains[g] = guard.rest;
    for (uint32_t i = 0; i < guard.count; ++i) {
      gains[(1 + placed.places[i]) * kGuardVector + g] += guard.gains[i];
    }
    for (uint32_t p = 0; p < guard.pair_count; ++p) {
      const GuardPair& pair = guard.pairs[p];
      const uint32_t row = 1 + out.width +
                           find_product(placed.places[pair.first], placed.places[pair.second],
                                        products.data, product_count);
      gains[row * kGuardVector + g] += pair.gain;
    }
  }
  out.gains.gains = gains.data;
  out.gains.products = products.data;
  out.gains.place_count = out.width;
  out.gains.product_count = round_up(product_count, 4);
}

void hold_guards(const GuardTable& table, const float* protected_row, const float* distances,
                 const float* activations, const float* free_row, float* back, float* row) {
  const uint32_t width = table.width;
  memset(back, 0, width * sizeof(float));
  memcpy(row, free_row, width * sizeof(float));
  float more[kMaxGuardedCurves];
  float limits[kMaxGuards];
  alignas(kBlockAlignment) float open[kMaxGuards];
  uint32_t limited = 0;  // bit g: the limit of guard g is known
  bool moved = false;
  for (uint32_t g = 0; g < table.guards.count; ++g) moved = moved || activations[g] > 0;
  for (uint32_t sweep = 0; moved && sweep < kGuardSweeps; ++sweep) {
    moved = false;
    guard_distances(table, row, open);
    for (uint32_t g = 0; g < table.guards.count; ++g) {
      if (!(activations[g] > 0)) continue;
      const PlacedGuard& guard = table.guards[g];
      if ((limited >> g & 1) == 0) {
        const float excess = open[g] - higher(distances[g], 0.0f) - guard.tolerance;
        if (!(excess > 0)) continue;
        limits[g] = open[g] - activations[g] * excess;
        limited |= 1u << g;
      } else if (!(open[g] > limits[g] + kEnough)) {
        continue;
      }
      if (!moved) memset(more, 0, width * sizeof(float));
      moved = true;
      hold_guard(guard, width, protected_row, open[g] - limits[g], row, more);
    }
    if (moved) take_off(free_row, more, width, back, row);
  }
}

void ease_guards(const float* free_row, const float* protected_row, const float* back,
                 uint32_t count, float max_change, float* __restrict held, float* __restrict row) {
  for (uint32_t i = 0; i < count; ++i) {
    const float eased = held[i] + lower(higher(back[i] - held[i], -max_change), max_change);
    const float change = free_row[i] - protected_row[i];
    const float now = lower(higher(eased, lower(change, 0.0f)), higher(change, 0.0f));
    held[i] = now;
    // With bits: a branch would keep compilers from vectorizing the loop.
    const uint32_t all = ((now == change) & (now != 0)) ? ~0u : 0;
    row[i] = float_of((bits_of(protected_row[i]) & all) | (bits_of(free_row[i] - now) & ~all));
  }
}

}  // namespace mien
