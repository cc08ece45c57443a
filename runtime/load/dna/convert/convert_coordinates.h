// SPDX-License-Identifier: MIT
// A view in one coordinate system -> the same rig in another (docs/dna-format.md, 11 "Coordinate
// systems").
//
// The converted rig evaluates to the converted results of the original: the same joint transforms,
// expressed in other axes, units and angles. Axes and signs are exact, so converting back gives the
// same numbers. Units round once. A rig that cannot be converted exactly is refused.
//
//   - Rows of joint matrices stay in place; only the attribute they write, their sign and their unit
//     change. So LODs, column order and single entries stay as they were.
//   - Units are converted. Scale deltas keep their sign. Twist axes, ML joints and everything that
//     reads part of a quaternion input are converted too.
//   - The rotation sequence follows the axes unless another one is requested: sums of Euler angles
//     have no exact equivalent in another sequence.
//   - Reversed faces keep their first corner, and so their triangles.
//   - The file version is raised only if the old one cannot state the system.
#pragma once

#include "runtime/base/coordinate_system.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// Expects a view that passed the checks. Lists change in place; arrays that change are copied to
/// `arena`. Does nothing if the view already states `to`. On failure the view must not be used.
Status convert_coordinates(DnaView& view, const CoordinateSystem& to, Arena& arena, Error& error);

/// The system that the view states.
CoordinateSystem system_of(const DnaView& view);

}  // namespace mien::dna
