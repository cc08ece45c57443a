// SPDX-License-Identifier: MIT
// Results of stages that the caller supplies: checked, and converted from the indices, frame and
// unit of the source to those of the mesh. author/mesh/own_lods.h does this for meshes of LODs.
#pragma once

#include "author/base/joint_motion.h"
#include "author/rigging/rigging.h"

namespace mien::author {

/// Names, positions, order and kinds of `options.bones`. `moves`: there are expressions to fit.
Status check_bones(const RiggingOptions& options, bool moves, Error& error);

/// Landmarks in the internal frame. Fails with kAuthorMesh for unknown names, those given twice, and numbers that
/// are not finite.
Status read_landmarks(const MeshSource& source, const RiggingOptions& options, Landmarks& out,
                      Error& error);

/// Puts the caller's bones, which were checked, in place of the computed ones; the mask stays.
Status take_bones(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                  Placement& out, Error& error);

/// Converts weights of the source's positions to weights of vertices, the largest first, with sum
/// one.
Status take_weights(const ReadMesh& read, const RiggingOptions& options, size_t sources,
                    Arena& arena, SkinWeights& out, Error& error);

/// Converts values of the source's positions to values of vertices.
Status take_bytes(const ReadMesh& read, Span<const uint8_t> own, Arena& arena,
                  Span<const uint8_t>& out, Error& error);

/// The joint group of each of the caller's bones.
Status take_groups(const RiggingOptions& options, Arena& arena, Span<const uint8_t>& out,
                   Error& error);

/// The caller's motions, by shape and bone.
Status take_motions(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                    Span<const JointDelta>& out, Error& error);

}  // namespace mien::author
