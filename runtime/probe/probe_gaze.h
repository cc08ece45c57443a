// SPDX-License-Identifier: MIT
// How the controls of a rig turn its eyes, measured.
#pragma once

#include "runtime/base/status.h"
#include "runtime/mix/gaze.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// Of two joints, the eyes; find_eyes() knows them on rigs with common names. Takes for each direction
/// the raw control that turns the eye farthest that way and little across. kIndex; kInvalidArgument
/// if a direction has no such control, or one that turns back on its way; kMemory.
Status probe_gaze(const Deformer& deformer, const uint32_t (&eyes)[2], const Allocator& allocator,
                  GazeTable& out, Error& error);

/// Left and right eye: joints L_Eye and R_Eye, with FACIAL_ before or not. False if there are none.
bool find_eyes(const Rig& rig, uint32_t (&eyes)[2]);

}  // namespace mien
