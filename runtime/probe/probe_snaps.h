// SPDX-License-Identifier: MIT
// Measures how coarsely a clip can be rounded without a visible effect on a rig.
#pragma once

#include "runtime/anim/binding.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// Finds for each channel of a clip the coarsest step 1 / 2^n, n within kMinSnap ... kMaxSnap, of which half
/// moves no position of a mesh by more than `tolerance` millimeters; without meshes, no joint. Each channel
/// is tried at quarters of 0 ... 1, and of -1 ... 0 if the binding drives GUI controls, with all other
/// channels at 0. kNoSnap if even the finest step moves more, kDefaultSnap for channels that drive nothing.
/// kMemory.
Status probe_snaps(const Deformer& deformer, const Binding& binding, float tolerance,
                   const Allocator& allocator, Span<uint8_t> snaps, Error& error);

}  // namespace mien
