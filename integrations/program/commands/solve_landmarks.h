// SPDX-License-Identifier: MIT
// Landmarks to solve: a CSV of their positions, and JSON that says where they are on the mesh.
#pragma once

#include <map>

#include "integrations/program/commands/solve_target.h"
#include "integrations/program/io/take.h"

namespace mien::cli {

/// What --landmarks says: places of names on meshes, and a camera. `mesh` is that of names that do not say theirs.
struct PlacedLandmarks {
  std::string shown;
  uint32_t mesh = 0, position_count = 0;
  std::map<std::string, MienSolvePoint> points;
  std::optional<MienFitCamera> camera;  // its rotation is 0 if the file has none
};
/// Without a file, the mesh alone.
PlacedLandmarks read_places(const TargetOptions& options, const SolvedRig& rig);

/// A CSV of landmarks: their names, in the order of the columns.
struct LandmarkTable {
  Take take;
  std::vector<std::string> names;
};
LandmarkTable read_landmark_table(const std::string& path, bool images);

bool knows_rotation(const MienFitCamera& camera);

/// `images`: two coordinates each, as the camera of the JSON sees them.
SolveTarget read_landmarks(const TargetOptions& options, bool images, const SolvedRig& rig);

}  // namespace mien::cli
