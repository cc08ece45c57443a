// SPDX-License-Identifier: MIT
// Landmarks of live packets -> controls, within the time of a frame.
#pragma once

#include <string>

#include "integrations/program/live/live_input.h"

namespace mien::cli {

/// As they were typed; empty: none.
struct LandmarkOptions {
  std::string file, neutral, focal, smooth, sparse, robust, seconds;

  /// The first that was given, or null.
  const char* named() const {
    if (!file.empty()) return "--landmarks";
    if (!neutral.empty()) return "--neutral";
    if (!focal.empty()) return "--focal";
    if (!smooth.empty()) return "--smooth";
    if (!sparse.empty()) return "--sparse";
    if (!robust.empty()) return "--robust";
    return seconds.empty() ? nullptr : "--solve-time";
  }
};

/// Wrong usage before anything is opened.
void check_landmark_options(const LandmarkOptions& options, bool images);

/// Solves the landmarks that the file of `options` places on the rig; `images`: x and y in pictures. The head may move
/// as a whole, in pictures the camera, which is found. Fails if the rig has no meshes, or the file does not fit it.
/// `deformer` may be null. `rig` and `session` outlive the solver.
live::LandmarkSolver open_landmark_solver(const LandmarkOptions& options, bool images,
                                          const MienRig* rig, const MienDeformer* deformer,
                                          const std::string& shown, const Session& session);

}  // namespace mien::cli
