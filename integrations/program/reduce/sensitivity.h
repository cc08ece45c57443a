// SPDX-License-Identifier: MIT
// How far single numbers of a rig move its positions, in shares of the tolerance.
#pragma once

#include "integrations/program/reduce/tolerances.h"

namespace mien::cli {

/// What a joint does to the position that it moves farthest, by itself or through its descendants.
struct JointReach {
  double shift = 0;  // of a translation by one unit
  double turn = 0;   // of a turn by one radian, or of a scale by 1
};

/// Bounds over all positions: a position counts with its tolerance, the smallest of its LODs. Infinite for joints
/// that move no position.
std::vector<JointReach> joint_reaches(const Character& character, const Tolerances& tolerances);

/// For each influence of each position of a mesh, in order: how far the position moves at most if the other
/// influences take over its weight, over the poses with one raw control or the inputs of one corrective at 1,
/// at LOD 0. Infinite where the influences hang on different joints that no control moves: those, such as the joints
/// of a neck, are moved by others.
std::vector<std::vector<float>> influence_importance(Character& character,
                                                     const Tolerances& tolerances);

}  // namespace mien::cli
