// SPDX-License-Identifier: MIT
// From shapes to joint motions: designed turns of jaw, lids, eyes and tongue, translations of the skin joints
// by least squares, and blend shapes for the rest.
#pragma once

#include "author/base/joint_motion.h"
#include "author/generate/head/joints.h"

namespace mien::head {

using author::Affine;
using author::JointDelta;
using author::JointDeltas;

inline author::Influences influences(const Weights& w) { return {w.joints, w.values, w.count}; }

/// Translations are fitted on `mesh`, whose weights are those of LOD 0. False if memory ran out.
bool fit_joints(const Shapes& shapes, const Skeleton& skeleton, const HalfMesh& mesh,
                Displacements& displacements, Arena& scratch, JointDeltas& out);

/// How each joint moves points when these shapes are fully active together.
void pose_joints(const Skeleton& skeleton, const JointDeltas& deltas, const uint32_t* active,
                 uint32_t active_count, Affine* out);

}  // namespace mien::head
