// SPDX-License-Identifier: MIT
// Measures guards on a rig. They need no tables made by hand, only the landmarks of the rig.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/status.h"
#include "runtime/mix/guard.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// The distance is the height of `upper` above `lower`, along the axis of the rig that points up.
struct GuardDesc {
  Landmark upper, lower;
  uint16_t closed_by = kNoControl;  // raw control that closes it at 1; none: closed at rest
  float tolerance = 0.3f;           // of the Guard
  float f_on = 12;
  bool needs_speech = true;
  uint32_t kind = kStandardGuardCount;  // of the Guard: a StandardGuard, or any other number
};

/// Measures guards: evaluates and deforms the rig at LOD 0, with each raw control alone and with pairs that
/// share a corrective. Coefficients are rounded to multiples of 1/1024 mm, so that they differ between
/// instruction sets only in very rare cases. kInvalidArgument, kIndex, kMemory.
Status probe_guards(const Deformer& deformer, Span<const GuardDesc> descs,
                    const Allocator& allocator, Span<Guard> out, Error& error);

struct StandardGuards {
  GuardDesc descs[kStandardGuardCount];
  StandardGuard kinds[kStandardGuardCount];  // of each desc
  uint32_t count;
};

/// Finds the landmarks of a rig. If possible by geometry: edges of a mesh that touch in one pose and part in
/// another (lips: at rest, and with the jaw open; lids: shut, and at rest). Otherwise by the joint names of
/// MetaHuman rigs. `out` gets the guards whose landmarks were found; their points are in `arena`. kMemory.
Status find_standard_guards(const Deformer& deformer, const Allocator& allocator, Arena& arena,
                            StandardGuards& out, Error& error);

/// A set of standard guards: bit k is the StandardGuard k.
using GuardKinds = uint32_t;

/// The guards of some GuardGroups.
GuardKinds guard_kinds(uint32_t groups);

/// Measures the guards of a mix: those of `kinds` whose landmarks are found, then `own`. kInvalidArgument for
/// more than kMaxGuards; errors of find_standard_guards() and probe_guards().
Status plan_guards(const Deformer& deformer, GuardKinds kinds, Span<const GuardDesc> own,
                   const Allocator& allocator, Guard (&out)[kMaxGuards], uint32_t& count,
                   Error& error);

}  // namespace mien
