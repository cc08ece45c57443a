// SPDX-License-Identifier: MIT
// Fewer morph targets, for engines that have a limit.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/gltf/scene.h"

namespace mien::gltf {

struct MorphLoss {
  std::vector<std::string> names;  // of dropped targets, the largest move first
  double max = 0;                  // move of a vertex by one of them, meters
  double rms = 0;                  // of the moves of all of them
};

/// Leaves each mesh the `most` targets, by name, whose largest moves are the largest in any mesh.
/// Animations are adapted, and correctives of dropped targets are dropped.
MorphLoss limit_morphs(size_t most, Scene& scene);

}  // namespace mien::gltf
