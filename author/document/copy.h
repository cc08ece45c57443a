// SPDX-License-Identifier: MIT
// Parts of another document: layers, meshes, joints.
#pragma once

#include "author/document/document.h"

namespace mien::author {

/// Copies the layers of `layers` (dna::LayerMask) from another document, whole. The status of the first field that
/// does not fit the other layers.
Status copy_layers(Document& document, const Document& from, uint32_t layers, Error& error);

/// Copies a mesh of another document: over the mesh of the same name, or as a new one at the LODs where it is there
/// and that this document has. Joints and channels are found by name; a joint that is not here hands its influence to
/// its nearest ancestor that is, targets of other channels are left out. kMismatch if the two documents differ in
/// coordinate system, or no joint of a position is here. `out_mesh` gets its number.
Status copy_mesh(Document& document, const Document& from, uint32_t mesh, uint32_t& out_mesh,
                 Error& error);

/// Adds the joints of another document whose names this one lacks: below the joints of the same names, at the LODs
/// that list them there. Joints that both have stay, but a root that has a parent there becomes its child.
/// kMismatch if the coordinate systems differ, or a joint that both have stands in another place by more than
/// `tolerance`, in the unit of the file.
Status merge_joints(Document& document, const Document& from, double tolerance, Error& error);

/// Removes the joints that another document does not have by name.
Status split_joints(Document& document, const Document& from, Error& error);

// For other operations ------------------------------------------------------------------------------

/// kMismatch unless both have the same axes, units and rotation conventions.
Status check_same_system(const dna::DnaView& a, const dna::DnaView& b, Error& error);

/// For each name of `from` the number in `to`, or kGone.
bool find_names(const dna::List<dna::String>& from, const dna::List<dna::String>& to, Arena& arena,
                Span<uint32_t>& out);

}  // namespace mien::author
