// SPDX-License-Identifier: MIT
// A view in one coordinate system -> the same rig in another (dna-format 11).
//
// Evaluating the converted rig gives what converting the results of evaluation would: the same
// joint transforms, told in other axes, units and angles. Axes and signs are exact, so that
// converting back gives the same numbers; units round once. What cannot follow is refused, never
// bent.
//
// Where this differs from the reference, on purpose:
//   - rows of joint matrices stay where they are: only which attribute they write, and their sign
//     and unit, change. So LODs, the order of columns and single entries stay as they were;
//   - units are converted; a scale delta keeps its sign; twist axes, ML joints, and everything that
//     reads part of a quaternion input follow;
//   - the order in which Euler angles turn is carried along with the axes unless another is asked
//     for, because sums of angles mean nothing in another order;
//   - faces keep their first corner when they are reversed, and with it their triangles;
//   - the version is raised only if the file could not state the system otherwise.
#pragma once

#include "runtime/base/coordinate_system.h"
#include "runtime/base/status.h"
#include "runtime/dna/format/dna_view.h"

namespace mien::dna {

/// Expects a view that passed the checks. New arrays lie in `arena`, lists are changed in place;
/// only numbers that change are copied. If the view states `to` already, nothing happens. On
/// failure the view is not to be used.
Status convert_coordinates(DnaView& view, const CoordinateSystem& to, Arena& arena, Error& error);

/// The system that the view states.
CoordinateSystem system_of(const DnaView& view);

}  // namespace mien::dna
