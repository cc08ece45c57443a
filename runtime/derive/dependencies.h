// SPDX-License-Identifier: MIT
// Which numbers of a rig may depend on which earlier ones, in any pose: found by sending sets of columns through
// the stages as push() sends directions. A set holds 64 columns, one bit each.
//
//     gui 010 -> controls 010 -> joint values 011 -> ... -> positions 011
//
// A factor that no pose makes other than 0 stops a column: entries of 0 in the joint matrix and in tables, other
// joints, other influences. All outputs of a network depend on all its inputs, and so do those of an RBF solver.
#pragma once

#include "runtime/derive/derivatives.h"

namespace mien {

struct Dependencies {
  const Rig* rig = nullptr;
  const Deformer* deformer = nullptr;  // or null
  uint32_t lod = 0, mesh = 0;
  Span<uint32_t> value_rows;  // [joint value, angle], as in Derivatives

  // One set per number, in the order of the buffers of Derivatives. All are parts of `sets`.
  Span<uint64_t> sets;
  Span<uint64_t> gui, controls, weights, maps, ml_values, packed_rows, joints;
  Span<uint64_t> locals, models, skins, positions, shaped;  // shaped: of a block

  const Span<uint64_t>& at(Point point) const;
};

/// Room for the way to `to`. False if memory ran out.
bool place_dependencies(const Derivatives& derivatives, Point to, uint32_t mesh, uint32_t lod,
                        Arena& arena, Dependencies& dependencies);

/// Fills the sets at `to` from those at `from`. All others must be empty.
void find_dependencies(const Dependencies& dependencies, Point from, Point to);

}  // namespace mien
