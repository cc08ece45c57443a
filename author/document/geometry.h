// SPDX-License-Identifier: MIT
// Operations on places: neutral joints, vertex positions, targets, and the whole character.
#pragma once

#include "author/document/document.h"

namespace mien::author {

/// Neutral transforms of `count` joints from `first` on, relative to their parents, 3 numbers each in the
/// units of the file. A null array leaves its values unchanged. kInvalidArgument for numbers that are not
/// finite.
Status set_neutral(Document& document, uint32_t first, uint32_t count, const float* translations,
                   const float* rotations, Error& error);

/// All positions of a mesh, 3 numbers each; as many as it has. Normals do not change.
Status set_positions(Document& document, uint32_t mesh, const float* positions, size_t count,
                     Error& error);

/// The target of a channel on a mesh: `count` deltas, 3 numbers each, of `vertices` (null: 0 ... count -
/// 1). Zero deltas are left out. Replaces the existing one, or adds one, with its pair in
/// meshBlendShapeChannelMapping; a target without deltas is removed, with its pair.
Status set_target(Document& document, uint32_t mesh, uint32_t channel, const uint32_t* vertices,
                  const float* deltas, size_t count, Error& error);

/// Removes deltas that are not longer than `epsilon`, and targets that have none left. `out_deltas` and
/// `out_targets` get their numbers.
Status prune_targets(Document& document, float epsilon, uint64_t& out_deltas, uint64_t& out_targets,
                     Error& error);

/// Scaled about the origin, then turned about it by x, then y, then z, then moved.
struct CharacterPlacement {
  double scale = 1;
  double rotation[3] = {};  // right-handed degrees about the file's axes
  double translation[3] = {};
};

/// Moves the character as a whole: neutral joints, positions, normals, targets, and the translations that
/// controls add to joints. kDnaValue if a root joint is moved by controls and the rotation is not 0, or if
/// networks translate joints and the scale is not 1.
Status place_character(Document& document, const CharacterPlacement& placement, Error& error);

}  // namespace mien::author
