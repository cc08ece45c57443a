// SPDX-License-Identifier: MIT
// Neural networks in another coordinate system: the changes of the controls that they read and
// write are folded into their weights.
#pragma once

#include "runtime/load/dna/convert/converted_arrays.h"
#include "runtime/load/dna/convert/rotation_controls.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// Input signs go into the first layer, output units into the last. The last layer must commute with
/// a positive factor: linear, ReLU or leaky ReLU. MIEN_ERROR_DNA_VALUE if it does not, or if a network
/// is used by operations that need different weights.
Status convert_networks(DnaView& view, const RotationControls& controls, ConvertedArrays& arrays,
                        Arena& arena, Error& error);

}  // namespace mien::dna
