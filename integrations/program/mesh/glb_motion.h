// SPDX-License-Identifier: MIT
// The animation of a GLB: transforms of its nodes over time.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace mien::cli {

/// Of a node, relative to its parent: translation in meters, rotation x y z w, scale.
using NodeTransform = std::array<double, 10>;

struct GlbTrack {
  uint32_t node = 0;
  uint32_t first = 0, width = 0;                     // numbers of the transform
  bool is_step = false;                              // else straight lines
  std::shared_ptr<const std::vector<double>> times;  // in seconds, ascending
  std::vector<double> values;                        // [time][width]
};

struct GlbMotion {
  std::vector<std::string> names;   // of nodes
  std::vector<NodeTransform> rest;  // of nodes, as the file opens
  std::vector<GlbTrack> tracks;     // of the first animation
  std::vector<double> times;        // of frames: those of the longest track. 0 if there is none
};

/// Tracks of weights are left out. Fails with kInvalid, also for cubic splines.
GlbMotion read_glb_motion(const std::string& bytes, const std::string& path);

/// Transforms of all nodes at a time; before the first key and after the last one, theirs.
std::vector<NodeTransform> sample_motion(const GlbMotion& motion, double time);

}  // namespace mien::cli
