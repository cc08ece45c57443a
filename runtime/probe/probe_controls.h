// SPDX-License-Identifier: MIT
// Properties of raw controls that a mix needs, measured on the rig.
#pragma once

#include "runtime/base/status.h"
#include "runtime/mix/mix.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// Finds pairs of raw controls that only the two halves of one GUI control drive. Writes as many as fit,
/// with stiffness 1, and returns the total number. Leaves out raw controls from kMaxCurves on, which no mix
/// has.
uint32_t find_antagonists(const Rig& rig, Span<AntagonistPair> out);

/// Finds for each raw control its counterpart in the other half of the face: the control with the mirrored
/// name (Left and Right, or L and R, exchanged). If there is none, or its motion does not agree, it is the
/// control whose motion is the mirror image. Controls with neither map to themselves. kMemory; kDnaLimit
/// if there are too many controls and joints.
Status find_mirror(const Deformer& deformer, const Allocator& allocator, Span<uint16_t> out,
                   Error& error);

/// Computes for each raw control the share of its joint motion, at value 1 and LOD 0, that belongs to these
/// joint groups: 0 ... 1. A millimeter counts as much as a degree. Controls that move no joint get
/// `otherwise`. kIndex, kMemory.
Status mask_of_groups(const Rig& rig, Span<const uint32_t> groups, float otherwise,
                      const Allocator& allocator, Span<float> out, Error& error);

}  // namespace mien
