// SPDX-License-Identifier: MIT
#pragma once

#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// RBF poses without an extension, as in files older than 2.5, get one pose control each, of the same
/// name (docs/dna-format.md, 6.7 "rbfe 1.0: RBF behavior extension"). Expects the number of ML controls
/// in the view. False if memory ran out.
bool synthesize_pose_controls(DnaView& view, Arena& arena);

}  // namespace mien::dna
