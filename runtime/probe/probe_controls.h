// SPDX-License-Identifier: MIT
// What a mix has to know about the raw controls of a rig, found on the rig itself.
#pragma once

#include "runtime/base/status.h"
#include "runtime/mix/mix.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// Pairs of raw controls that the two halves of one GUI control drive, and nothing else does. Writes
/// as many as there is room for and returns how many there are. Stiffness 1. Of controls below kMaxLanes,
/// which a mix has.
uint32_t find_antagonists(const Rig& rig, Span<AntagonistPair> out);

/// [raw control] The one of the same size on the other side of the face, or itself: the control of the
/// mirrored name (Left and Right, or L and R, exchanged), and if there is none, or it moves otherwise,
/// the one whose motion is the mirror image. A control that has neither stays by itself. kMemory;
/// kDnaLimit if there are too many controls and joints.
Status find_mirror(const Deformer& deformer, const Allocator& allocator, Span<uint16_t> out,
                   Error& error);

/// [raw control] 0 ... 1: the share of what the control does to joints, at 1 and LOD 0, that these
/// joint groups do. A millimeter counts as much as a degree. Controls that move no joint get
/// `otherwise`. kIndex, kMemory.
Status mask_of_groups(const Rig& rig, Span<const uint32_t> groups, float otherwise,
                      const Allocator& allocator, Span<float> out, Error& error);

}  // namespace mien
