// SPDX-License-Identifier: MIT
// Euler angles in another coordinate system. If the rotation sequence follows the axes, angles only
// swap places and change sign and unit. With another sequence each triple of angles is converted as
// the rotation it describes.
#pragma once

#include "runtime/load/dna/convert/converted_arrays.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

// `to` is what `change` leads to: its sequence and signs are those that the rig will have.

/// One triple of angles per joint. Empty if memory ran out.
Vec3Array convert_neutral_rotations(const Vec3Array& old, const CoordinateSystem& from,
                                    const CoordinateSystem& to, const CoordinateChange& change,
                                    ConvertedArrays& arrays);

/// Converts the rotation rows of all joint groups to another sequence. The three angles of a column
/// become three others; missing rows are added after the first one of the joint. Exact for
/// quaternion joints and for angles about a single axis; `to.rotation_rule` decides about others.
/// MIEN_ERROR_DNA_VALUE if the rule cannot be met.
Status convert_rotation_rows(DnaView& view, const CoordinateSystem& from,
                             const CoordinateSystem& to, const CoordinateChange& change,
                             ConvertedArrays& arrays, Arena& arena, Error& error);

}  // namespace mien::dna
