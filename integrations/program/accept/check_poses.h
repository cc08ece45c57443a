// SPDX-License-Identifier: MIT
// Compares joints baked in an engine with those of the rig (docs/engine-poses.md):
//
//     {"unit": "cm", "system": "unreal", "poses": [
//       {"controls": {"CTRL_expressions.jawOpen": 1}, "lod": 0,
//        "joints": {"FACIAL_C_Jaw": {"translation": [x, y, z], "rotation": [x, y, z, w]}}}]}
#pragma once

#include "integrations/program/accept/check.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

struct PoseOptions {
  std::string rig, poses;
  double length = 0.01;  // in the unit of the poses
  double degrees = 0.1;
  bool names = false;  // in the detail
};

/// A check for each pose. Fails with exit code 2 and the place in the file if the poses are malformed or
/// name something that the rig lacks.
std::vector<Check> check_poses(const PoseOptions& options, const Session& session);

}  // namespace mien::cli
