// SPDX-License-Identifier: MIT
// An image of what `mien bake --tolerance` moved.
#pragma once

#include "integrations/program/reduce/reduce.h"

namespace mien::cli {

/// LOD 0 as PNG: the original in its worst pose, the distances there, and the largest distances in all poses. `path` is
/// the DNA file. Fails if the rig has no meshes to draw.
std::string draw_reduction(const Reduced& reduced, const std::string& path, const Session& session);

}  // namespace mien::cli
