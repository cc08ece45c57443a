// SPDX-License-Identifier: MIT
// How far apart two rigs put the positions of one character.
#pragma once

#include "runtime/base/allocator.h"
#include "runtime/base/span.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

/// The largest distance between positions of two documents whose controls act differently.
struct PoseDifference {
  double distance = 0;   // in the unit of the file
  uint32_t control = 0;  // of the pose: a raw control, or a corrective
  uint32_t mesh = 0, position = 0;
};

/// The worst position of LOD 0 over all poses of ControlPoses in which a control with changed[control] != 0 is not
/// 0. Both views passed the checks and differ in the joint matrix only. Positions are computed only where a bound
/// by the joints that differ exceeds the worst distance so far.
Status measure_difference(const dna::DnaView& before, const dna::DnaView& after,
                          Span<const uint8_t> changed, const Allocator& allocator,
                          PoseDifference& out, Error& error);

}  // namespace mien::author
