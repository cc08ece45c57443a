// SPDX-License-Identifier: MIT
// Guards measured on a rig: no tables by hand, so they serve every rig whose landmarks are known.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/status.h"
#include "runtime/mix/guard.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// The distance is that of `upper` above `lower`, along the rig's axis that points up.
struct GuardDesc {
  Landmark upper, lower;
  uint16_t closed_by = kNoControl;  // raw control that makes both touch at 1; else they do at rest
  float tolerance = 0.3f;           // see Guard
  float f_on = 12;
  bool needs_speech = true;
  uint32_t kind = kStandardGuardCount;  // of the Guard: a StandardGuard, or none of them
};

/// Evaluates and deforms the rig at LOD 0, with each raw control by itself, and with pairs of them
/// that share a corrective. Coefficients are multiples of 1/1024 mm, so that instruction sets agree on
/// all but the rarest. kInvalidArgument, kIndex, kMemory.
Status probe_guards(const Deformer& deformer, Span<const GuardDesc> descs,
                    const Allocator& allocator, Span<Guard> out, Error& error);

struct StandardGuards {
  GuardDesc descs[kStandardGuardCount];
  StandardGuard kinds[kStandardGuardCount];  // beside descs
  uint32_t count;
};

/// Finds the landmarks of a rig. By geometry where it can: edges of a mesh that touch in one pose and
/// part in another (of lips: at rest, and with the jaw open; of lids: shut, and at rest). Else by the
/// names that joints of MetaHuman rigs have. `out` gets the guards whose landmarks were found; their
/// points lie in `arena`. kMemory.
Status find_standard_guards(const Deformer& deformer, const Allocator& allocator, Arena& arena,
                            StandardGuards& out, Error& error);

}  // namespace mien
