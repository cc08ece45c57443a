// SPDX-License-Identifier: MIT
// Checks of the geometry.
#pragma once

#include "integrations/program/accept/accepted_rig.h"
#include "integrations/program/accept/check.h"
#include "integrations/program/math/transform.h"

namespace mien::cli {

/// Each mesh in some poses, at each LOD that shows it, against linear blend skinning in double precision.
Check check_deform(const AcceptedRig& rig, const Session& session);

/// Model-space transforms of all joints in double precision, in the axes and units of the file.
/// `pose` was updated.
std::vector<math::Matrix> joint_matrices(const MienRig* rig, const MienDeformerInstance* pose);

}  // namespace mien::cli
