// SPDX-License-Identifier: MIT
// The columns of a joint group rotate its quaternion joints one after another, in an order that depends on
// all of its rows (docs/rig-evaluation.md, 4.3 "Rows, columns and LODs"). When rows are removed, the
// remaining columns must keep their order.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

/// `after` has the groups and columns of `before`, and some of their rows. Where its columns would rotate in another
/// order, each quaternion joint of the group gets a group of its own, behind the others, with its columns in
/// the order that they had. False if memory ran out.
bool keep_turn_order(const dna::DnaView& before, dna::DnaView& after, Arena& arena);

}  // namespace mien::author
