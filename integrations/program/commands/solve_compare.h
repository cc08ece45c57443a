// SPDX-License-Identifier: MIT
// How far what was solved is from its target: landmarks, and meshes from surfaces of another topology.
#pragma once

#include <functional>
#include <vector>

#include "integrations/program/commands/solve_output.h"
#include "integrations/program/math/vector.h"

namespace mien::cli {

/// A landmark of a frame, in the space of the rig.
struct SolvedMark {
  uint32_t point = 0;  // of the target
  math::Vec3
      target;  // of landmarks in images, the place on their ray that is as far from the camera as `solved`
  math::Vec3 solved;
  float distance = 0;   // in images, in pixels
  bool hidden = false;  // the skin there faces away from the viewer
};

/// Of the size of the rig: where a surface is farther, it has no place for the skin.
constexpr float kFarShare = 0.05f;

/// A place of the target in the space of the rig.
math::Vec3 place_target(const SolvedFrame& frame, math::Vec3 place);

/// Positions of a mesh in the solved pose.
using PosedMesh = std::function<const float*(uint32_t mesh)>;

/// The points of frame `f` that are not missing. `row` is what target.read() gives.
std::vector<SolvedMark> compare_landmarks(const SolvedTake& take, const SolveTarget& target,
                                          size_t f, const float* row, const PosedMesh& posed);

/// Of each position, the weighted mean distance of the landmarks around it; NaN where there are none.
std::vector<float> spread_distances(const std::vector<SolvedMark>& marks, const float* positions,
                                    size_t count);

/// Of each position of a mesh, the distance to the nearest place of a surface that faces the same way, within 60
/// degrees; NaN where none is within `reach`, or that place is at a border of the surface.
std::vector<float> find_surface_distances(const SurfaceMesh& mesh, const SurfaceMesh& surface,
                                          float reach);

/// Unit normals of positions, outward if the mesh is closed.
std::vector<math::Vec3> outward_normals(const SurfaceMesh& mesh);

}  // namespace mien::cli
