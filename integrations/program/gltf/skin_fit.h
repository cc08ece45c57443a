// SPDX-License-Identifier: MIT
// Fewer joints per position: those, and weights for them, that move the position as all its joints
// do in the rig's own expressions.
#pragma once

#include <functional>

#include "integrations/program/gltf/rig_source.h"

namespace mien::gltf {

struct Influence {
  uint16_t joint;
  double weight;
};

/// A position with more influences than there is room for.
struct CrowdedPosition {
  uint32_t rig_mesh, position;
  std::vector<Influence> influences;  // the heaviest first, of sum 1, all above 0, each joint once
};

struct SkinLoss {
  Residual residual;       // over all positions and expressions that move one of their joints
  std::string expression;  // with the largest distance; empty if nothing is lost
};

/// Leaves each position `most` influences. Expressions are the raw controls, one at a time at 1, at
/// the finest LOD. The weights minimize the sum of squared distances from where all influences put
/// the position, with sum 1 and none below 0; the joints are found by dropping one after the other,
/// each time the one whose loss costs least. Positions that no expression moves keep the heaviest.
///
/// `positions` ascend by mesh. `progress` is called now and then, with 0 to 1.
SkinLoss fit_influences(const RigSource& source, size_t most,
                        std::vector<CrowdedPosition>& positions,
                        const std::function<void(double share)>& progress = {});

}  // namespace mien::gltf
