// SPDX-License-Identifier: MIT
// Chosen LODs -> a smaller view. Everything that no kept LOD uses is dropped; the rest is
// renumbered everywhere (docs/dna-format.md, 10 "Choosing LODs").
//
//   - All references are renumbered, including outputs of blend shape channels and animated maps,
//     channels of blend shape targets, networks, and row limits of ML operations.
//   - Elements that the kept LODs write or depend on survive even if no LOD list names them: joints,
//     channels and maps that remaining rows write, operations that remaining operations depend on,
//     and the networks that those run.
//   - Quaternion joints keep the order in which columns rotate them. Where it is not the order of
//     the file, their rotation rows move to a group of their own after the others.
#pragma once

#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// Sets marks[i] = 1 for every element i that a LOD in `lods` (bit l for LOD l) lists.
void mark_lod_elements(const LodMap& map, uint64_t lods, Span<uint8_t> marks);

/// Expects a view that passed the checks, at least one bit of `lods` below its LOD count, and meshes
/// that no kept LOD lists left unread. New arrays and lists are in `arena`. False if memory ran out;
/// the view must then not be used.
bool select_lods(DnaView& view, uint64_t lods, Arena& arena);

}  // namespace mien::dna
