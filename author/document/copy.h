// SPDX-License-Identifier: MIT
// Parts of another document: layers, meshes, joints.
#pragma once

#include "author/document/document.h"

namespace mien::author {

/// Copies the layers of `layers` (dna::LayerMask) from another document, whole. Fails with the status of
/// the first field that does not fit the other layers.
Status copy_layers(Document& document, const Document& from, uint32_t layers, Error& error);

/// Copies a mesh of another document. It replaces the mesh of the same name, or becomes a new one, at its
/// LODs in the other document as far as this document has them. Joints and channels are found by name; the
/// influence of a missing joint goes to its nearest ancestor that exists here, and targets of missing
/// channels are left out. kMismatch if the two documents differ in coordinate system, or this one has no
/// joint of a position. `out_mesh` gets its number.
Status copy_mesh(Document& document, const Document& from, uint32_t mesh, uint32_t& out_mesh,
                 Error& error);

/// Adds the joints of another document whose names this one lacks: below the joints with the names of their
/// parents, at the LODs that list them in the other document. Joints of both documents stay, but a root
/// that has a parent in the other one becomes its child. kMismatch if the coordinate systems differ, or the
/// places of a joint of both differ by more than `tolerance`, in the unit of the file.
Status merge_joints(Document& document, const Document& from, double tolerance, Error& error);

/// Removes the joints whose names another document lacks.
Status split_joints(Document& document, const Document& from, Error& error);

// For other operations ------------------------------------------------------------------------------

/// kMismatch unless both have the same axes, units and rotation conventions.
Status check_same_system(const dna::DnaView& a, const dna::DnaView& b, Error& error);

/// For each name of `from` the number in `to`, or kGone.
bool find_names(const dna::List<dna::String>& from, const dna::List<dna::String>& to, Arena& arena,
                Span<uint32_t>& out);

}  // namespace mien::author
