// SPDX-License-Identifier: MIT
// What a solve leaves of each landmark, joint, or region of a mesh, over all frames.
#pragma once

#include <memory>
#include <optional>

#include "integrations/program/commands/moving_mesh.h"
#include "integrations/program/commands/solve_output.h"

namespace mien::cli {

/// Adds up the differences of frames from their targets; what the mask leaves out does not count.
class ResidualTable {
 public:
  ResidualTable(const SolvedRig& rig, const SolveTarget& target);

  /// The last frame of `take`. `row` is what target.read() gives, `surface` what target.read_surface() gives.
  void add(const SolvedTake& take, const float* row, const SurfaceMesh& surface);

  /// Those that had a target in some frame, the worst first.
  std::vector<SolvedDatum> list() const;

 private:
  struct Sum {
    double squares = 0, worst = 0;
    size_t count = 0, worst_frame = 0;
  };

  void name_joints();
  void name_regions();
  void add_joints(const SolvedTake& take, const float* row);
  void add_surface(const SolvedTake& take, const SurfaceMesh& surface);
  void add_one(size_t datum, double distance, size_t frame);

  const SolvedRig& rig_;
  const SolveTarget& target_;
  std::optional<MovingMesh> mesh_;  // without it, joints are the target
  Instance instance_;
  SurfaceMesh solved_;           // of surfaces
  float far_ = 0;                // where a surface is farther, it has no place for the skin
  std::vector<uint32_t> datum_;  // of each point or joint value
  std::vector<std::string> names_;
  std::vector<Sum> sums_;
};

}  // namespace mien::cli
