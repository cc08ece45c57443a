// SPDX-License-Identifier: MIT
// Measures how the controls of a rig turn its eyes.
#pragma once

#include "runtime/base/status.h"
#include "runtime/mix/gaze.h"
#include "runtime/probe/rig_probe.h"

namespace mien {

/// Measures the gaze of two eye joints; find_eyes() finds them on rigs with the usual names. For each
/// direction, takes the raw control that turns the eye farthest that way and little sideways of it. kIndex;
/// kInvalidArgument if a direction has no such control, or if the control does not turn the eye
/// monotonically; kMemory.
Status probe_gaze(const Deformer& deformer, const uint32_t (&eyes)[2], const Allocator& allocator,
                  GazeTable& out, Error& error);

/// The same as an object, to be given back with release().
Status create_gaze(const Deformer& deformer, const uint32_t (&eyes)[2], const Allocator& allocator,
                   Gaze*& out, Error& error);

/// Finds the left and right eye: joints L_Eye and R_Eye, with or without the prefix FACIAL_. False if there
/// are none.
bool find_eyes(const Rig& rig, uint32_t (&eyes)[2]);

}  // namespace mien
