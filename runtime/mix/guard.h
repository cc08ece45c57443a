// SPDX-License-Identifier: MIT
// Guards keep later layers from opening what speech or a blink closes.
//
// A guard knows a distance, such as the gap between the inner edges of the lips, as a measured function of
// a few raw controls. It holds back changes that would make the distance larger than it is in the protected
// row.
#pragma once

#include <cstdint>

#include "runtime/base/arena.h"
#include "simd/kernels.h"
#include "simd/mix_kernels.h"

namespace mien {

constexpr uint32_t kMaxGuards = kGuardVector;
constexpr uint32_t kMaxGuardCurves = 24;
constexpr uint32_t kMaxGuardPairs = 24;

/// Two curves, as indices into Guard::curves, whose product adds to the distance.
struct GuardPair {
  uint16_t first, second;
  float gain;  // millimeters
};

/// The guards whose landmarks are searched for on a rig (runtime/probe/find_landmarks.cpp).
enum class StandardGuard : uint8_t {
  kLipsLeft,
  kLipsCenter,
  kLipsRight,
  kLipToTeeth,
  kLidsLeft,
  kLidsRight,
  kTeeth
};
constexpr uint32_t kStandardGuardCount = 7;

/// Groups of standard guards; bits.
enum GuardGroups : uint32_t { kGuardsOfLips = 1, kGuardsOfLids = 2, kGuardsOfTeeth = 4 };

/// The group of a guard by Guard::kind; 0 if it is not a standard guard.
uint32_t guard_group(uint32_t kind);

/// "lips left", or "custom" if it is not a standard guard.
const char* guard_name(uint32_t kind);

/// A distance in millimeters; at 0 both sides touch, below 0 they overlap:
///     f(row) = rest + sum of gain * curve + sum of gain * curve * curve over the pairs
/// runtime/probe/probe_guards.h measures the gains on a rig.
struct Guard {
  uint32_t count;  // of curves
  uint32_t pair_count;
  uint32_t needs_speech;  // 1: at most as active as the speech layers, as lips touch at rest too
  float rest;             // f of a row of zeros
  float f_on;             // active if f(protected row) is less than this, fully at 0; above 0
  float tolerance;        // by which later layers may open the distance
  float fit_error;        // of this function: root mean square over the measured rows
  uint16_t curves[kMaxGuardCurves];  // raw controls, by descending absolute gain
  float gains[kMaxGuardCurves];      // beside curves
  /// Bit i: curves i - 1 and i are the same control in both halves of the face; they go back by the same
  /// share.
  uint32_t together;
  GuardPair pairs[kMaxGuardPairs];
  uint32_t kind;  // a StandardGuard, or any other number
};

/// f(row)
float guard_distance(const Guard& guard, const float* row);

/// 1 if the distance in the protected row is 0 or less, 0 if it is f_on or more, smooth between;
/// `distance` is f(protected row).
float guard_activation(const Guard& guard, float distance);

constexpr uint32_t kMaxGuardedCurves = kMaxGuards * kMaxGuardCurves;

/// A guard in the form that steps use. Its rows hold only the curves of all guards, then zeros up to a
/// multiple of kGuardStep; a place is an index into such a row.
constexpr uint32_t kGuardStep = 8;
struct PlacedGuard {
  struct Partner {
    uint16_t place;
    float gain;
  };
  uint32_t count, together;
  float tolerance;
  uint16_t places[kMaxGuardCurves];              // by descending absolute gain
  float gains[kMaxGuardCurves];                  // of places
  float both_gains[kMaxGuardCurves];             // of the pair with the place before
  uint16_t partner_begins[kMaxGuardCurves + 1];  // of places, into partners
  Partner partners[2 * kMaxGuardPairs];  // in pairs with the first of places, then the second, ...
};

/// All guards of a mix.
struct GuardTable {
  Span<uint16_t> curves;  // that they have, ascending
  uint32_t width = 0;     // of rows
  Span<PlacedGuard> guards;
  GuardGains gains = {};
  const KernelTable* kernels = nullptr;
};

/// Call it twice, as Placer describes.
void place_guards(Placer& placer, Span<const Guard> guards, const KernelTable* kernels,
                  GuardTable& out);

/// f(row) of each guard, summed in a different order; `out` has room for kMaxGuards and is aligned to
/// kBlockAlignment.
inline void guard_distances(const GuardTable& guards, const float* row, float* out) {
  guards.kernels->guard_distances(guards.gains, row, out);
}

/// Computes how far guards take back each curve of the free row: `back`. The limit of a guard is
/// f(protected row), or 0 if that is less, plus the tolerance. A guard with activation 1 brings f(row) down
/// to its limit; with a smaller activation, that share of the way. `distances` are f(protected row), one
/// per guard, as are `activations`. Rows have the curves that PlacedGuard describes.
///
/// All guards look at the same row. If several take back the same curve, the largest amount counts. So
/// their order makes no difference, and mirrored rows give mirrored results. Curves with the largest gains
/// go first, so that as little as possible of the row is lost; both halves of a face go together
/// (Guard::together). Curves that do not open the distance stay. The amounts are in closed form, because f
/// is linear in each curve. A curve that one guard took back may have helped another, so all guards then
/// look at the row again.
void hold_guards(const GuardTable& guards, const float* protected_row, const float* distances,
                 const float* activations, const float* free_row, float* back, float* row);
constexpr uint32_t kGuardSweeps = 2;

/// How fast the amount that guards take off a curve may change, per second. Without this limit it would
/// jump in speech of 8 phonemes per second.
constexpr float kGuardSpeed = 12;

/// To be called after hold_guards(): writes to `row` what is left of the free row. `held` is how far curves
/// were taken back in the last step, initially zeros. It moves to `back`, by at most `max_change`, which is
/// kGuardSpeed times the seconds of the step. A curve never goes beyond its value in the protected row.
/// Curves that are not held keep their bits.
void ease_guards(const float* free_row, const float* protected_row, const float* back,
                 uint32_t count, float max_change, float* held, float* row);

}  // namespace mien
