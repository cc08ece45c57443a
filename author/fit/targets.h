// SPDX-License-Identifier: MIT
// Deltas as the joint matrix holds them, blend shape targets for motion that joints cannot produce, and the
// remaining error of the rig.
#pragma once

#include "author/fit/fit_shapes.h"

namespace mien::author {

/// In the file's frame.
JointDelta delta_of_motion(const Bone& bone, const Frame& frame, const Affine& motion);

/// Deltas in the file's frame, rounded as they are written, and the motions that they give.
void deltas_of_motions(const Placement& placement, const Frame& frame, Motions& motions,
                       const JointDeltas& out);

/// How bones move where these deltas add up. In the internal frame; bones whose parent moves are
/// not supported.
void pose_bones(const Placement& placement, const Frame& frame, const JointDeltas& deltas,
                Span<const uint32_t> controls, Span<Affine> out);

/// Offsets of one control, added before skinning. Vertices ascend.
struct Target {
  Span<uint32_t> vertices;
  Span<Vec3f> offsets;  // internal frame
  double energy = 0;    // sum of squares
};

/// One target for each shape, empty where joints alone come within `threshold`. False if memory
/// ran out.
bool make_targets(const AuthorMesh& mesh, const SkinWeights& weights, const Motions& motions,
                  double threshold, const ParallelFor& parallel, Arena& arena, Span<Target>& out);

struct ShapeError {
  double error = 0;    // root of the squared residuals over that of the squared displacements
  double squares = 0;  // sum of squared residuals
  double energy = 0;   // sum of squared displacements
  double max = 0;      // longest residual
};

struct FitError {
  double error = 0;              // of all shapes together
  double median = 0, worst = 0;  // of single shapes
  uint32_t worst_shape = kNone;
  double rms = 0, max = 0;  // of residuals, relative to the diagonal
  Span<ShapeError> shapes;
};

/// Compares the rig, with each control alone at 1, with the shapes. `targets` may be empty. False
/// if memory ran out.
bool measure_fit(const AuthorMesh& mesh, const SkinWeights& weights, const Motions& motions,
                 Span<const Target> targets, const ParallelFor& parallel, Arena& arena,
                 FitError& out);

}  // namespace mien::author
