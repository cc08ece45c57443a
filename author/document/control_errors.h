// SPDX-License-Identifier: MIT
// How differently the controls of two rigs move one character.
#pragma once

#include "runtime/base/allocator.h"
#include "runtime/base/span.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

/// How differently a control of both rigs acts.
struct ControlError {
  uint32_t control = 0;  // number of the raw control in the new rig
  double worst = 0;      // distance of a position of LOD 0, in the unit of the file
  double rms = 0;
  double moved = 0;  // the farthest that it moved a position before
};

/// Compares raw controls of the same name on meshes of the same name, at 1 each. Both views passed the checks.
/// The meshes of LOD 0 that have the same number of positions in both have the same positions. `out_count` gets
/// the number of controls that both have, at most out.count.
Status measure_controls(const dna::DnaView& before, const dna::DnaView& after,
                        const Allocator& allocator, Span<ControlError> out, uint32_t& out_count,
                        Error& error);

}  // namespace mien::author
