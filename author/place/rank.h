// SPDX-License-Identifier: MIT
// Chooses the bones of each LOD: they are among those of the LOD before it.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"

namespace mien::author {

/// Ranks the means: the last one to remain comes first. One after the other is removed, always the one whose loss per
/// joint is least: the rise of the weighted sum of squared distances when its points go to the nearest mean that is left.
/// Where a LOD begins, means that remain are exchanged for those that it drops as long as the sum falls.
/// `joints[i]` is 2 for a mirrored pair, else 1. `counts`: how many joints each LOD may have, falling; becomes how many
/// it has. `objectives`: the sum of each LOD. False if memory ran out.
bool rank_means(Span<const Vec3> points, Span<const double> weights, Span<const Vec3> means,
                Span<const uint32_t> joints, Arena& scratch, Span<uint32_t> order,
                Span<uint32_t> counts, Span<double> objectives);

/// How many facial joints each LOD asks for: 240, 160, 110, 75, 50, 32, 20 and 12, scaled to `top`;
/// falling by one at least down to 1, and 6 or more where `top` allows it.
void joint_ladder(uint32_t top, Span<uint32_t> out);

/// The caller's numbers if there are any, at most the number of joints; LOD 0 has all.
void joint_ladder(uint32_t top, Span<const uint32_t> own, Span<uint32_t> out);

}  // namespace mien::author
