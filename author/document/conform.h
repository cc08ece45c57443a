// SPDX-License-Identifier: MIT
// Moves the rig with a head that was reshaped.
#pragma once

#include "author/document/document.h"
#include "runtime/base/vector.h"

namespace mien::author {

struct ConformResult {
  double farthest_joint = 0;  // how far a joint moved
  uint32_t joint = 0;
};

/// Gives `mesh` new positions, and moves joints, other meshes (if `others`), targets and the translations
/// that controls add, as the surface around them moved: by the similarity that fits the nearest positions
/// best (Warp). Joints keep their orientation; targets turn and scale with the surface, translations of
/// joints scale. Normals of the meshes that move turn.
Status conform(Document& document, uint32_t mesh, const float* positions, size_t count, bool others,
               ConformResult& out, Error& error);

// For other operations ------------------------------------------------------------------------------

/// Neutral translations for joints whose places in the model are `places`; rotations stay.
bool place_joints(dna::DnaView& view, Span<const Vec3> places, Arena& arena);

/// Multiplies the rows that translate joint j by scales[j].
bool scale_translations(dna::DnaView& view, Span<const double> scales, Arena& arena);

}  // namespace mien::author
