// SPDX-License-Identifier: MIT
// Chosen LODs -> a smaller view: what no kept LOD uses is dropped, what is left is numbered anew
// everywhere (dna-format section 10).
//
// Where this differs from the reference, on purpose:
//   - every number is renewed: outputs of blend shape channels and animated maps, channels of blend
//     shape targets, networks and row limits of ML operations;
//   - what the kept LODs still drive or need survives even if no LOD list names it: joints,
//   channels
//     and maps that remaining rows write, operations that remaining operations depend on, and
//     networks that those run;
//   - joints represented by quaternions keep the order in which columns turn them: where it is not
//   the
//     order of the file, the rows that turn move to a group of their own behind the others.
#pragma once

#include "runtime/dna/format/dna_view.h"

namespace mien::dna {

/// Sets marks[i] = 1 for every element i that a LOD in `lods` (bit l for LOD l) lists.
void mark_lod_elements(const LodMap& map, uint64_t lods, Span<uint8_t> marks);

/// Expects a view that passed the checks, with at least one bit of `lods` below its LOD count, and
/// meshes that no kept LOD lists unread. New arrays and lists lie in `arena`.
/// False if memory ran out; the view is then not to be used.
bool select_lods(DnaView& view, uint64_t lods, Arena& arena);

}  // namespace mien::dna
