// SPDX-License-Identifier: MIT
// Guards: what speech or a blink needs stays, whatever later layers want.
//
// A guard knows a measured distance, say between the inner edges of the lips, as a function of a few
// raw controls, and holds back what would make it larger than it is in the protected row.
#pragma once

#include <cstdint>

#include "runtime/base/span.h"

namespace mien {

constexpr uint32_t kMaxGuards = 8;
constexpr uint32_t kMaxGuardLanes = 24;
constexpr uint32_t kMaxGuardPairs = 24;

/// Two lanes, as numbers into Guard::lanes, that together do something else than each alone.
struct GuardPair {
  uint16_t first, second;
  float gain;  // millimeters
};

/// Guards that a rig is searched for (runtime/probe/find_landmarks.cpp).
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

/// A distance in millimeters; at 0 both sides touch, below they overlap:
///     f(row) = rest + sum of gain * lane + sum of gain * lane * lane over the pairs
/// runtime/probe/probe_guards.h measures the gains on a rig.
struct Guard {
  uint32_t count;  // of lanes
  uint32_t pair_count;
  uint32_t needs_speech;  // 1: no more active than the layers of speech are; lips touch at rest too
  float rest;             // f of a row of zeros
  float f_on;             // active where f(protected row) is below, fully so at 0; above 0
  float tolerance;        // by so much later layers may open
  float fit_error;        // of this function: root mean square over rows that were tried
  uint16_t lanes[kMaxGuardLanes];  // raw controls, by falling size of the gain: see hold_guard()
  float gains[kMaxGuardLanes];     // beside lanes
  /// Bit i: lanes i - 1 and i, the same control of both halves of the face, go back by the same share.
  uint32_t together;
  GuardPair pairs[kMaxGuardPairs];
  uint32_t kind;  // a StandardGuard, or none of them
};

/// f(row)
float guard_distance(const Guard& guard, const float* row);

/// 1 where the protected row closes, 0 where it is open by f_on or more, smooth between; `distance` is
/// f(protected row).
float guard_activation(const Guard& guard, float distance);

/// The lanes of all guards, ascending; returns how many: at most kMaxGuardedLanes.
constexpr uint32_t kMaxGuardedLanes = kMaxGuards * kMaxGuardLanes;
uint32_t list_guarded_lanes(Span<const Guard> guards, uint16_t* lanes);

/// A guard as steps need it: for rows of the lanes of all guards, with zeros up to a multiple of
/// kGuardStep.
constexpr uint32_t kGuardStep = 8;
struct PlacedGuard {
  struct Product {
    uint16_t place, other;
    float gain;
  };
  uint32_t count, pair_count, width;
  uint32_t together;
  float rest, tolerance;
  uint16_t places[kMaxGuardLanes];              // by falling size of the gain
  float gains[kMaxGuardLanes];                  // beside places
  float both_gains[kMaxGuardLanes];             // of pairs with the place before
  uint16_t partner_begins[kMaxGuardLanes + 1];  // beside places, into partners
  Product partners[2 * kMaxGuardPairs];  // pairs of the first of places, then of the second, ...
  Product pairs[kMaxGuardPairs];
  float row_gains[kMaxGuardedLanes];  // by place, to `width`; 0 where the guard has no lane
};
void place_guard(const Guard& guard, Span<const uint16_t> guarded_lanes, PlacedGuard& out);

/// f(row), summed in another order.
float guard_distance(const PlacedGuard& guard, const float* row);

/// What guards take off each lane of the free row: `back`. With the activation 1, f(row) becomes
/// f(protected row), or 0 if that is less, plus the tolerance; with less, it goes that share of the
/// way. `distances` are f(protected row), [guard] as `activations`. Rows are as PlacedGuard says.
///
/// Each guard looks at the same row and of what several of them want of a lane the most counts; so
/// their order makes no difference, and mirrored rows give mirrored results. Lanes with the largest
/// gains go first, so that the least of the row is lost; both halves of a face go together
/// (Guard::together). Lanes that open nothing stay. A guard is in closed form, as f is linear in each
/// lane. What one took off may have helped another: then they look at the row once more.
void hold_guards(Span<const PlacedGuard> guards, const float* protected_row, const float* distances,
                 const float* activations, const float* free_row, float* back, float* row);
constexpr uint32_t kGuardSweeps = 2;

/// The fastest that guards take hold of a lane or let go of it, per second. With speech at 8 phonemes
/// a second what they hold back would jump otherwise.
constexpr float kGuardSpeed = 12;

/// After hold_guards(): writes to `row` what is left of the free row. `held` is how far lanes were
/// taken back in the last step, zeros at the beginning; it becomes `back`, but changes by `max_change`
/// at most, kGuardSpeed times the seconds of the step. A lane never passes the protected row. Where
/// nothing is held, bits stay.
void ease_guards(const float* free_row, const float* protected_row, const float* back,
                 uint32_t count, float max_change, float* held, float* row);

}  // namespace mien
