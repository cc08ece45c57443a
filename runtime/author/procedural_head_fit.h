// SPDX-License-Identifier: MIT
// From shapes to joint motions: designed turns of jaw, lids, eyes and tongue, translations of the
// skin joints by least squares, and what is left over as blend shapes.
#pragma once

#include "runtime/author/procedural_head_joints.h"

namespace mien::head {

/// Delta of a joint at full value: centimeters, degrees.
struct JointDelta {
  float translation[3] = {};
  float rotation[3] = {};

  bool is_zero() const {
    for (int k = 0; k < 3; ++k) {
      if (translation[k] != 0 || rotation[k] != 0) return false;
    }
    return true;
  }
};

/// Rows of all shapes: [shape * joint count + joint].
struct JointDeltas {
  Span<JointDelta> items;
  uint32_t joint_count = 0;

  JointDelta& at(uint32_t shape, uint32_t joint) const {
    return items[size_t{shape} * joint_count + joint];
  }
};

/// Translations are fitted on `mesh`, whose weights are those of LOD 0. False if memory ran out.
bool fit_joints(const Form& form, const Shapes& shapes, const Skeleton& skeleton,
                const HalfMesh& mesh, Arena& scratch, JointDeltas& out);

/// x -> linear * x + shift, rows of `linear`.
struct Affine {
  Vec3 rows[3];
  Vec3 shift;

  Vec3 operator()(Vec3 p) const {
    return Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + shift;
  }
};

/// How each joint moves points when these shapes are fully active together.
void pose_joints(const Skeleton& skeleton, const JointDeltas& deltas, const uint32_t* active,
                 uint32_t active_count, Affine* out);

/// The offset to add to `p` before skinning so that it ends at `target`.
Vec3 residual(const Affine* pose, const Weights& weights, Vec3 p, Vec3 target);

}  // namespace mien::head
