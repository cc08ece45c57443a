// SPDX-License-Identifier: MIT
// Networks in another coordinate system: their weights take up what becomes of the controls that
// they read and write.
#pragma once

#include "runtime/dna/convert/converted_arrays.h"
#include "runtime/dna/convert/rotation_controls.h"
#include "runtime/dna/format/dna_view.h"

namespace mien::dna {

/// Signs of inputs go into the first layer, units of outputs into the last one, which has to let
/// factors through: linear, ReLU or leaky ReLU. MIEN_ERROR_DNA_VALUE if it does not, or if a
/// network serves operations that need different weights.
Status convert_networks(DnaView& view, const RotationControls& controls, ConvertedArrays& arrays,
                        Arena& arena, Error& error);

}  // namespace mien::dna
