// SPDX-License-Identifier: MIT
// The rig of a template for another character.
#pragma once

#include "author/document/control_errors.h"
#include "author/document/document.h"
#include "author/document/surface_match.h"

namespace mien::author {

struct Transplant {
  Match match =
      Match::kUv;  // of meshes of the same name with different faces; positions of the same faces
                   // correspond by number
  uint32_t influences = 8;
};

/// Replaces the rig of the document by that of `rig`: definition, behavior and everything that belongs to
/// it, with its LODs. The character keeps its shape. Meshes of the same name keep the character's topology
/// and positions, and get the template's weights and targets at corresponding places; other meshes are
/// those of the template, moved with the surface. Joints with names of joints of the character keep the
/// places of those, others move with the surface, as in conform(). `out_errors` has room for the raw
/// controls of the template; `out_count` gets the number of those that both rigs have. kMismatch if the
/// systems differ, kInvalidArgument if no mesh of LOD 0 has the name of one of the template, or one cannot
/// be matched.
Status transplant(Document& document, const Document& rig, const Transplant& how,
                  Span<ControlError> out_errors, uint32_t& out_count, Error& error);

}  // namespace mien::author
