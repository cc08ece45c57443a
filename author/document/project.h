// SPDX-License-Identifier: MIT
// Skin weights and targets of a mesh from those of another one at the same place.
#pragma once

#include "author/document/document.h"
#include "author/document/surface_match.h"
#include "author/document/warp.h"

namespace mien::author {

struct Projection {
  Match match = Match::kSurface;
  uint32_t influences = 8;  // per position, at most
  bool weights = true, targets = true;
};

/// The position that is farthest from its place on the other mesh.
struct ProjectionResult {
  double farthest = 0;
  uint32_t position = 0;
};

/// Gives `mesh` the weights and targets of `source`, interpolated at the nearest place: a coarser LOD from
/// a finer one. The influence of joints that no LOD of `mesh` lists goes to the nearest ancestor that one
/// of them lists, and channels that none lists are left out (if these LODs list none at all, all are kept).
/// kInvalidArgument if the source has no triangles or weights, or if texture coordinates are missing.
Status project_mesh(Document& document, uint32_t mesh, uint32_t source, const Projection& how,
                    ProjectionResult& out, Error& error);

/// The same for all meshes of a LOD, each from the mesh of another one whose name differs only in the number of the
/// LOD. A LOD without joints or channels gets those of the other. kLod, kName if a mesh has no counterpart.
Status make_lod(Document& document, uint32_t lod, uint32_t source_lod, const Projection& how,
                ProjectionResult& out, Error& error);

// For other operations ------------------------------------------------------------------------------

/// The weights of `source` at the places of a match. `heirs[joint]` takes the influence of a joint.
bool project_weights(const dna::Mesh& source, const SurfaceMatch& match, Span<const uint32_t> heirs,
                     uint32_t joint_count, uint32_t influences, Arena& arena,
                     dna::List<dna::VertexSkinWeights>& out);

/// The targets of `source` at the places of a match, of channels with new_channels[channel] != kGone,
/// rotated and scaled by turns[position] if there are any.
bool project_targets(const dna::Mesh& source, const SurfaceMatch& match,
                     Span<const uint32_t> new_channels, Span<const Similarity> turns,
                     const Allocator& allocator, Arena& arena,
                     dna::List<dna::BlendShapeTarget>& out);

}  // namespace mien::author
