// SPDX-License-Identifier: MIT
// Which precision of a clip can be seen on a rig.
#pragma once

#include "runtime/anim/binding.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// Gives each channel of a clip the coarsest step 1 / 2^n, n within kMinSnap ... kMaxSnap, of which half
/// moves no position of a mesh, or no joint if there are no meshes, by more than `tolerance` millimeters:
/// tried at quarters of 0 ... 1, and of -1 ... 0 where the binding drives GUI controls, with all other
/// channels at 0. kNoSnap where the finest step moves more, kDefaultSnap for channels that drive
/// nothing. kMemory.
Status probe_snaps(const Deformer& deformer, const Binding& binding, float tolerance,
                   const Allocator& allocator, Span<uint8_t> snaps, Error& error);

}  // namespace mien
