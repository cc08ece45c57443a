// SPDX-License-Identifier: MIT
// Euler angles in another coordinate system. If the order of turning is carried along with the
// axes, angles only change places, signs and unit. In another order each triple of angles is
// converted as the rotation that it describes.
#pragma once

#include "runtime/dna/convert/converted_arrays.h"
#include "runtime/dna/format/dna_view.h"

namespace mien::dna {

// `to` is what `change` leads to: its sequence and signs are those that the rig will have.

/// One triple of angles per joint. Empty if memory ran out.
Vec3Array convert_neutral_rotations(const Vec3Array& old, const CoordinateSystem& from,
                                    const CoordinateSystem& to, const CoordinateChange& change,
                                    ConvertedArrays& arrays);

/// Rotation rows of all joint groups, where the order of turning changes: the three angles that a
/// column gives a joint become three others, and rows that were missing are added behind the first
/// one of the joint. Exact for joints represented by quaternions, and for angles about one axis
/// only; `to.rotation_rule` says what becomes of others. Other rows stay as they are.
/// MIEN_ERROR_DNA_VALUE if it cannot be done.
Status convert_rotation_rows(DnaView& view, const CoordinateSystem& from,
                             const CoordinateSystem& to, const CoordinateChange& change,
                             ConvertedArrays& arrays, Arena& arena, Error& error);

}  // namespace mien::dna
