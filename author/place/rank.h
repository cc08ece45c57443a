// SPDX-License-Identifier: MIT
// Which bones stay when LODs keep fewer: each LOD's bones are among those of the one before it.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"

namespace mien::author {

/// Removes one mean after the other, always the one whose loss per joint is least: the rise of the
/// weighted sum of squared distances when its points go to the nearest mean that is left.
/// `joints[i]` is 2 for a mirrored pair, else 1. `order`: the last one to remain comes first;
/// `objectives[i]` is the sum when order[0] ... order[i] remain. False if memory ran out.
bool rank_by_deletion(Span<const Vec3> points, Span<const double> weights, Span<const Vec3> means,
                      Span<const uint32_t> joints, Arena& scratch, Span<uint32_t> order,
                      Span<double> objectives);

/// How many facial joints each LOD asks for: 240, 160, 110, 75, 50, 32, 20 and 12, scaled to `top`;
/// falling by one at least down to 1, and 6 or more where `top` allows it.
void joint_ladder(uint32_t top, Span<uint32_t> out);

/// The caller's ladder if there is one, without more joints than there are; the first LOD has all.
void joint_ladder(uint32_t top, Span<const uint32_t> own, Span<uint32_t> out);

}  // namespace mien::author
